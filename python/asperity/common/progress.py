"""The progress of a solve, on a terminal or in a notebook."""

from __future__ import annotations

import importlib
import os
import sys
import time
import weakref
from collections.abc import Iterable, Iterator
from typing import Any, TypeVar

from .._asperity import Iteration

T = TypeVar("T")

#: The seconds between two texts.
_PAUSE = 0.1

#: The seconds after which a call shows its progress by default.
_PATIENCE = 2.0


def default_progress() -> progress | None:
    """The progress of a call that takes long, on a terminal or in a notebook; None elsewhere."""
    is_seen = "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())
    return progress(_PATIENCE) if is_seen and "TQDM_DISABLE" not in os.environ else None


def show_progress(found: Iterable[T], total: int, unit: str) -> Iterator[T]:
    """What is found, one by one, with a bar where a call that takes long has one by default."""
    observer, bar, begin, pending = default_progress(), None, time.monotonic() + _PATIENCE, 0
    for one in found:
        yield one
        pending += 1
        if observer is None or bar is None and time.monotonic() < begin:
            continue
        if bar is None:
            try:
                bar = importlib.import_module("tqdm.auto").tqdm(total=total, unit=unit, mininterval=_PAUSE)
            except ImportError:
                bar = _Line(unit)
        bar.update(pending)
        pending = 0
    if bar is not None:
        bar.close()


class progress:
    """An observer that shows the iteration and the error of a solve while it runs.

    On a terminal and in a notebook, calls that take longer than two seconds have one by default, unless the environment
    has ``TQDM_DISABLE``. Elsewhere, pass it as ``observe`` of `solve`, `sweep` or `cycle`. It draws with tqdm if that is
    installed, in a notebook as its widget, and writes a line of text to the standard error otherwise. Of a cycle it has
    the states, the events, and the time that is left.

    Parameters
    ----------
    after : float
        Seconds before it is shown.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=asperity.progress()).status
    'converged'
    """

    def __init__(self, after: float = 0.0) -> None:
        self._begin = time.monotonic() + after
        self._bar: Any = None
        self._last, self._pace = 0, ""

    @property
    def _after(self) -> float:
        """The seconds for which the core need not call this observer."""
        return self._begin - time.monotonic()

    def _open(self) -> Any:
        try:
            bar = importlib.import_module("tqdm.auto").tqdm(unit=" iterations", mininterval=_PAUSE)
        except ImportError:
            bar = _Line()
        # with the observer the solve has ended
        weakref.finalize(self, bar.close)
        return bar

    def __call__(self, state: Iteration) -> None:
        if self._bar is None:
            self._bar = self._open()
        self._bar.set_postfix_str(f"{self._pace}error {state.relative_error:.1e}", refresh=False)
        # the count begins again on the next grid, and under the next load
        self._bar.update(state.iteration - (self._last if state.iteration >= self._last else 0))
        self._last = state.iteration

    def _show_pace(self, pace: str) -> None:
        """Shows the pace of a cycle from now on, in words."""
        self._pace = f"{pace}; "


class _Line:
    """A line of text in the place of a bar of tqdm."""

    def __init__(self, unit: str = " iterations") -> None:
        self._iterations, self._text, self._written, self._width, self._unit = 0, "", 0.0, 0, unit

    def set_postfix_str(self, text: str, refresh: bool) -> None:
        self._text = text

    def update(self, iterations: int) -> None:
        self._iterations += iterations
        if time.monotonic() - self._written >= _PAUSE:
            self._write("")

    def close(self) -> None:
        if self._iterations:
            self._write("\n")

    def _write(self, end: str) -> None:
        line = ", ".join(filter(None, [f"{self._iterations}{self._unit}", self._text]))
        # what is longer before it is written over
        print(f"\r{line.ljust(self._width)}", end=end, file=sys.stderr, flush=True)
        self._width = len(line)
        self._written = time.monotonic()
