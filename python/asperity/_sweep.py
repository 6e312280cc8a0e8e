"""Equilibria under one load after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import _plot
from ._columns import Rows
from ._solution import Solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Sweep(Rows[Solution]):
    """The solutions of a sweep, each found when it is asked for, and the columns of their numbers.

    Iterating gives a `Solution` for each load. Only the numbers are kept, so that a sweep needs the memory of one
    solve.
    """

    def __len__(self) -> int:
        """The number of loads."""
        return len(self.rows) if self._ended else self._loads

    def __next__(self) -> Solution:
        return self._solve()

    def __repr__(self) -> str:
        return f"Sweep({len(self.rows)} of {len(self)} loads solved)"

    def plot(self, ax: Axes | None = None, *, pressure_unit: str | None = None) -> Axes:
        """Draws the contact fraction over the mean pressure; needs matplotlib, and solves what is left.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; new ones by default.
        pressure_unit : str, optional
            Unit for the axis.

        Returns
        -------
        matplotlib Axes
        """
        return _plot.sweep(self.columns, ax, pressure_unit or self._contact.pressure_unit)
