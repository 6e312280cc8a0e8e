"""The warnings of the package."""

from __future__ import annotations

import sys
import warnings
from typing import Any

#: The warnings that were given in pools of threads.
_REGISTRY: dict[str | tuple[Any, ...], int] = {}


class ConvergenceWarning(UserWarning):
    """A solve that has not converged, or not to what was asked: its ``status`` and ``report`` say how it ended.

    It is also given for an unstable equilibrium, if its stability was asked for.
    """


class AccuracyWarning(UserWarning):
    """An accuracy that was asked for and not reached: ``report["grid_error"]`` has the estimated error.

    It is also given for a cycle with a balance of energy that misses more than 5 % of the greatest work.
    """


class InputWarning(UserWarning):
    """A probable mistake in the heights, the units or the range of adhesion; the answer may still be right.

    The message begins with a code, which the page ``docs/program/warnings.md`` explains.
    """


def warn_input(found: dict[str, str]) -> None:
    """Gives a warning of the compiled core, its code and its message."""
    warn(f"{found['code']}: {found['message']}", InputWarning)


def warn(text: str, category: type[Warning]) -> None:
    """Gives a warning at the first caller outside of this package, or in a pool of threads at the package itself."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("asperity."):
        level, frame = level + 1, frame.f_back
    if frame.f_globals.get("__name__", "").partition(".")[0] in ("concurrent", "threading", "multiprocessing", "joblib"):
        warnings.warn_explicit(text, category, "asperity", 0, registry=_REGISTRY)
    else:
        warnings.warn(text, category, stacklevel=level + 1)
