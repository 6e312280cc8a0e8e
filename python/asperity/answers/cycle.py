"""Loading and unloading along a branch of equilibria, with its jumps located."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from .. import _asperity
from ..common.summary import summary
from ..common.warnings import AccuracyWarning, warn
from ..plot import figures
from .rows import Rows
from .solution import Solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Step:
    """A state on a cycle.

    Attributes
    ----------
    solution : Solution
        The state itself.
    leg : int
        Leg that it is on: 0 is the start, 1 the way to the second load.
    direction : str
        ``"approach"`` or ``"withdrawal"``, of the start ``"start"``.
    work : float
        Work done by the load since the start, per area.
    dissipated : float
        Energy dropped in jumps since the start, per area.
    imbalance : float
        Change of the energy plus the dissipated energy less the work: zero up to the errors of quadrature and
        tolerance.
    work_error : float
        Standard error of the work, and over a closed cycle of the energy dissipated.
    event : str or None
        Event before this state: ``"touch"``, ``"jump-in"``, ``"jump-out"``, ``"pull-off"``, ``"bifurcation"``,
        ``"limit-point"``.
    energy_drop : float or None
        Energy that the jump dissipates, per area.
    """

    def __init__(self, solution: Solution, found: dict[str, Any]) -> None:
        self.solution = solution
        self.direction: str = found["direction"]
        self.leg: int = found["leg"]
        self.work: float = found["work"]
        self.dissipated: float = found["dissipated"]
        self.imbalance: float = found["imbalance"]
        self.work_error: float = found["work_error"]
        self.event: str | None = found["event"]
        self.energy_drop: float | None = found["energy_drop"]

    def __repr__(self) -> str:
        event = f", {self.event}" if self.event else ""
        gap, pressure = self.solution.mean_gap, self.solution.mean_pressure
        return f"Step({self.direction}, leg {self.leg}: mean_gap={gap:.7g}, mean_pressure={pressure:.7g}{event})"


class CycleLimit(NamedTuple):
    """The limits of no range of a cycle with `JKR`, from the grid and the grid of half as many nodes along the sides.

    Attributes
    ----------
    work : float
        Work done by the load, per area: over a closed cycle, the energy that it dissipates.
    work_error : float
        Estimated error of the limit of the work.
    tension : float
        Greatest tension, over the area of the map.
    tension_error : float
        Estimated error of the limit of the tension.
    levels : list of dict
        Cycle on each grid, the finest last: ``shape``, ``work``, ``work_error`` and ``greatest_tension``.
    accuracy : dict or None
        Accuracy that was asked for: ``wanted``, ``of``, and whether it was ``reached``.
    """

    work: float
    work_error: float
    tension: float
    tension_error: float
    levels: list[dict[str, Any]]
    accuracy: dict[str, Any] | None

    def __repr__(self) -> str:
        return summary(self)


class Cycle(Rows[Step]):
    """The states of a cycle, each found when it is asked for, and the columns of their numbers."""

    _limit: CycleLimit | None = None

    def __next__(self) -> Step:
        has_ended = self._ended
        try:
            return Step(*self._solve())
        except StopIteration:
            most = max((abs(row["work"]) for row in self.rows), default=0.0)
            if not has_ended and most > 0.0:
                # a balance of energy that misses much of the work
                text = _asperity.unbalanced(most, self.rows[-1]["imbalance"])
                if text is not None:
                    warn(text, AccuracyWarning)
            raise

    @property
    def events(self) -> list[dict[str, Any]]:
        """The rows at which something happened; solves what is left."""
        self.run()
        return [row for row in self.rows if row["event"] is not None]

    @property
    def limit(self) -> CycleLimit | None:
        """The limits of no range of the work and of the greatest tension, with `JKR`; solves what is left.

        The same cycle is solved on the grid of half as many nodes along the sides, when the limits are first asked for, and
        for an ``accuracy`` before the first state. None for laws with a range, for a cycle that an observer ended, with a
        start and absent nodes, and where there is no such grid. With an `AccuracyWarning` where an accuracy was not reached.
        """
        self.run()
        if self._limit is None and self.rows and self.rows[-1]["status"] != "stopped":
            with self._contact.turns:
                found = self._contact.problem.cycle_limit(self._observe)
            if found is not None:
                shortfall, limit = found
                keys = ("work_limit", "work_limit_error", "tension_limit", "tension_limit_error", "levels")
                self._limit = CycleLimit._make([*(limit[key] for key in keys), limit.get("accuracy")])
                if shortfall is not None:
                    warn(shortfall, AccuracyWarning)
        return self._limit

    def __getstate__(self) -> dict[str, Any]:
        # found before the problem is gone
        return {"_limit": self.limit, **super().__getstate__()}

    @property
    def seconds_left(self) -> float | None:
        """An estimate of the time until the end, in seconds; None at the end.

        At first the estimate is for the least number of states, and jumps take further ones. Before the first state it
        comes from the time of one application of the elastic operator, and is right to the order of magnitude. After a
        twentieth of the way it is the rest of the way at the speed so far.
        """
        return self._seconds_left

    def __repr__(self) -> str:
        return f"Cycle({len(self.rows)} states{'' if self._ended else ' so far'})"

    def plot(
        self,
        ax: Axes | None = None,
        *,
        length_unit: str | None = None,
        pressure_unit: str | None = None,
        force_unit: str | None = None,
    ) -> Axes:
        """Draws the mean pressure over the mean gap, with a free boundary the normal force over the approach.

        A line for each leg. Needs matplotlib, and solves what is left.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; new ones by default.
        length_unit, pressure_unit, force_unit : str, optional
            Units for the axes, into which numbers are converted where the cycle has units; others stay as they are.
            ``"m"``, ``"Pa"`` and ``"N"`` get prefixes. Forces are in N where lengths are in m and pressures in Pa.

        Returns
        -------
        matplotlib Axes
        """
        own = self._contact.topography.unit, self._contact.pressure_unit
        newtons = "N" if (own[0] or length_unit, own[1] or pressure_unit) == ("m", "Pa") else None
        length = figures.axis_unit("length_unit", own[0], length_unit)
        pressure = figures.axis_unit("pressure_unit", own[1], pressure_unit)
        force = figures.axis_unit("force_unit", newtons, force_unit)
        return figures.cycle(self.columns, ax, length, pressure, force)
