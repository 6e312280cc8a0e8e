"""Loading and unloading along a branch of equilibria, with its jumps located."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from os import PathLike
from typing import TYPE_CHECKING, Any

from . import _control, _plot
from ._asperity import Iteration
from ._body import Body
from ._columns import Rows
from ._pair import Shift
from ._scene import Scene
from ._solution import Solution, Start
from ._topography import Heights
from ._types import AxisOrder, Boundary, Branch, Lengths, Method, OwnLaw, Precision, Quantity
from ._wall import Hardness, Wall

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
    event : str or None
        Event before this state: ``"jump-in"``, ``"jump-out"``, ``"pull-off"``, ``"bifurcation"``, ``"limit-point"``.
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
        self.event: str | None = found["event"]
        self.energy_drop: float | None = found["energy_drop"]

    def __repr__(self) -> str:
        event = f", {self.event}" if self.event else ""
        gap, pressure = self.solution.mean_gap, self.solution.mean_pressure
        return f"Step({self.direction}, leg {self.leg}: mean_gap={gap:.7g}, mean_pressure={pressure:.7g}{event})"


class Cycle(Rows[Step]):
    """The states of a cycle, each found when it is asked for, and the columns of their numbers."""

    def __next__(self) -> Step:
        return Step(self._solve(), self.rows[-1])

    @property
    def events(self) -> list[dict[str, Any]]:
        """The rows at which something happened; solves what is left."""
        self.run()
        return [row for row in self.rows if row["event"] is not None]

    @property
    def seconds_left(self) -> float | None:
        """An estimate of the time until the end, in seconds; None at the end.

        At first it is that of the least number of states, and jumps take further ones. Before the first state it comes
        from the time of one application of the elastic operator, and is right as to the order of magnitude. After a
        twentieth of the way it is that of the rest at the speed so far.
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
            Units for the axes; forces are in N where lengths are in m and pressures in Pa.

        Returns
        -------
        matplotlib Axes
        """
        length_unit, pressure_unit = length_unit or self._scene.topography.unit, pressure_unit or self._scene.pressure_unit
        return _plot.cycle(self.columns, ax, length_unit, pressure_unit, force_unit)


def cycle(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity,
    mean_gaps: Iterable[Quantity] | None = None,
    mean_pressures: Iterable[Quantity] | None = None,
    normal_forces: Iterable[Quantity] | None = None,
    approaches: Iterable[Quantity] | None = None,
    springs: Iterable[tuple[Quantity, Quantity]] | None = None,
    reduced_pressures: Iterable[float] | None = None,
    body: Body | None = None,
    against: Heights | None = None,
    against_modulus: Quantity | None = None,
    shift: Shift | None = None,
    boundary: Boundary = "periodic",
    absent_missing: bool = False,
    law: OwnLaw | None = None,
    wall: Wall = "hard",
    hardness: Hardness | None = None,
    steps: int = 50,
    smallest_step: float = 1e-4,
    imbalance: float = 1e-4,
    smooth: bool = True,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    method: Method = "default",
    branch: Branch | None = None,
    precision: Precision = "f64",
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
    threads: int | None = None,
    whole: bool = False,
    out: str | PathLike[str] | None = None,
    fields: str | PathLike[str] | None = None,
    force: bool = False,
) -> Cycle:
    """Follows a branch of equilibria through turning points, in steps that adapt themselves, and locates its jumps.

    A withdrawal ends once the surfaces are apart. Parameters that are not here are those of `solve`.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as those of `solve`.
    mean_gaps : sequence of float
        Mean gaps at which the cycle starts, turns and ends: two at least.
    mean_pressures : sequence of float
        The same in mean pressures.
    normal_forces : sequence of float
        The same in normal forces.
    approaches : sequence of float
        The same in approaches, with a free boundary.
    springs : sequence of (float, float)
        The same in the positions at rest of a spring: its stiffness, and the position.
    reduced_pressures : sequence of float
        The same in mean pressures over E* h'rms, with h'rms the rms slope of the surface.
    steps : int
        Least number of steps in a leg.
    smallest_step : float
        Step to which a jump is located, as a share of the leg.
    imbalance : float
        Imbalance of energy that a step may have without being a jump, as a share of how much the energy has changed,
        and of twenty times what jumps have dissipated so far: jumps that are smaller are not located one by one.
    smooth : bool
        Whether jumps of the law's traction are smoothed by what the grid resolves.
    out : str or path, optional
        File for the rows, ``.csv`` or ``.jsonl``, as the tool writes it from the same inputs. A row is appended as it
        comes. The same call goes on with a file that is there, and ends with the same bytes as one that was not
        interrupted; for that it keeps ``.state`` beside the file. Rows that the file has are in ``columns`` and are
        not solved again: iterating gives the states behind them.
    fields : str or path, optional
        Folder for gap, pressure and contact pressure at the jumps and of the last row, ``gap-0001.npy`` and so on; with
        ``out``.
    force : bool
        Starts over, and replaces the files that are there.

    Returns
    -------
    Cycle
        An iterator over `Step`; ``columns`` has the numbers of all, ``events`` the jumps.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> law = asperity.Exponential(2e-4, 4e-3)
    >>> found = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.05, 0.012, 0.05], steps=10)
    >>> bool(found.columns["mean_pressure"].min() < 0)  # the pull-off stress
    True
    """
    given = locals()
    loads = _control.many(given)
    if len(loads) < 2:
        raise ValueError("a cycle needs two turning points at least: give more loads")
    scene = Scene.of({**given, "branch": _control.only(branch)})
    path = (steps, smallest_step, imbalance, smooth)
    return Cycle(scene, loads, start, observe, path=path, file=(out, fields, force))
