"""Equilibria under one load after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from .. import _asperity
from ..exact.theory import GreenwoodWilliamson, Persson
from ..plot import figures
from .posed import Posed
from .rows import Rows
from .solution import Solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes


#: The most rows on the screen of a sweep.
_MOST_ROWS = 20


class Sweep(Rows[Solution]):
    """The solutions of a sweep, each found when it is asked for, and the columns of their numbers.

    Iterating gives a `Solution` for each load. Only the numbers are kept, so that a sweep needs the memory of one
    solve.
    """

    def __len__(self) -> int:
        """The number of loads."""
        return len(self.rows) if self._ended else self._loads

    def __next__(self) -> Solution:
        return self._solve()[0]

    def __str__(self) -> str:
        return f"{type(self).__name__}({len(self.rows)} of {len(self)} loads solved)"

    def __repr__(self) -> str:
        units = self._contact.pressure_unit, self._contact.topography.unit
        lines = [("mean pressure", "mean gap", "contact", "status")]
        for row in self.rows[:_MOST_ROWS]:
            pressure, gap = (_asperity.shown(row[f"mean_{name}"], unit) for name, unit in zip(("pressure", "gap"), units))
            lines.append((pressure, gap, f"{100 * row['contact_fraction']:.2f} %", row["status"]))
        table = ["  ".join(f"{cell:>13}" for cell in line) for line in lines if self.rows]
        return "\n".join([str(self), *table, *["..."] * (len(self.rows) > _MOST_ROWS)])

    def plot(
        self,
        ax: Axes | None = None,
        *,
        of: Literal["area", "gap"] = "area",
        theory: bool = False,
        length_unit: str | None = None,
        pressure_unit: str | None = None,
    ) -> Axes:
        """Draws the contact fraction or the mean gap over the mean pressure; needs matplotlib, and solves what is left.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; new ones by default.
        of : {"area", "gap"}
            Whether to draw the contact fraction, or the mean gap.
        theory : bool
            Draws theories of the surface as well: `asperity.exact.Persson`, and `asperity.exact.GreenwoodWilliamson`
            for the area. The area has then also the points of the ``corrected_contact_fraction``, which compares with
            theories better than the fraction of the nodes. Without adhesion, on a half-space, with a periodic boundary.
        length_unit, pressure_unit : str, optional
            Units for the axes, into which numbers are converted where the sweep has units; others stay as they are.
            ``"m"`` and ``"Pa"`` get prefixes.

        Returns
        -------
        matplotlib Axes
        """
        name = {"area": "contact_fraction", "gap": "mean_gap"}.get(of)
        if name is None:
            raise ValueError(f"of is {of!r}: it must be 'area' or 'gap'")
        theories = _theories(self._contact) if theory else ()
        length = figures.axis_unit("length_unit", self._contact.topography.unit, length_unit)
        pressure = figures.axis_unit("pressure_unit", self._contact.pressure_unit, pressure_unit)
        return figures.sweep(self.columns, name, theories, ax, length, pressure)


def _theories(contact: Posed) -> tuple[Persson | GreenwoodWilliamson, ...]:
    """The theories of a contact problem that has no more than they have."""
    if contact.beyond_theory is not None:
        raise ValueError(contact.beyond_theory)
    return tuple(theory._by(contact.topography, contact.modulus) for theory in (Persson, GreenwoodWilliamson))
