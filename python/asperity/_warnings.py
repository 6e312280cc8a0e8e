"""The warnings of the package."""

from __future__ import annotations


class ConvergenceWarning(UserWarning):
    """A solve that has not converged: its ``status`` says how it ended, its fields how far it got."""


class AccuracyWarning(UserWarning):
    """An accuracy that was asked for and not reached: ``report["grid_error"]`` says how far it got."""


class InputWarning(UserWarning):
    """A probable mistake in the heights, the units or the range of adhesion; the answer may be right all the same."""
