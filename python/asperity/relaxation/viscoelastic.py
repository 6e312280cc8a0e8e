"""Contact of a viscoelastic body over time.

The relaxation modulus is E(t) = E₀ (g∞ + Σ gₖ exp(−t/τₖ)), with g∞ = 1 − Σ gₖ, and the operator of the stiffness K has
the modulus E₀. Then the pressure is K (g∞ u + Σ qₖ), where qₖ' + qₖ/τₖ = gₖ u' at each node. In a step Δt along which u
is linear qₖ becomes dₖ qₖ + gₖ cₖ Δu, with aₖ = Δt/τₖ, dₖ = exp(−aₖ) and cₖ = (1 − dₖ)/aₖ. So the pressure at its end
is s K (u − v), with s = g∞ + Σ gₖ cₖ and s v = Σ (gₖ cₖ u − dₖ qₖ) of its start, as in an elastic body of the modulus s
E₀ under heights that are lower by v. The error of a step is of the third order, and the error of a time of the second.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..answers.posed import Posed
from ..answers.rows import Rows
from ..answers.solution import Solution, Start
from ..bodies.body import Symbol
from ..common.units import in_si, number
from ..common.words import PLURALS
from ..laws.formulas import JKR
from ..laws.identity import unwrap
from ..maps.arrays import mirror_field, read_field
from ..plot import figures

if TYPE_CHECKING:
    from matplotlib.axes import Axes


#: The loads of moments by the keywords of their lists.
LOADS = {many: PLURALS[many] for many in ("mean_pressures", "mean_gaps", "normal_forces", "approaches")}

#: The columns that are numbers of the solutions.
_OF_SOLUTIONS = ("status", "relative_error", "mean_pressure", "normal_force", "mean_gap", "contact_fraction")

#: The columns that are numbers of the moments.
_OF_MOMENTS = ("approach", "stored", "dissipated", "work", "imbalance")

#: Keywords of what does not relax with the half-space.
ELASTIC = ("coating", "coating_modulus", "coating_poisson", "plate", "against_modulus", "hardness")


class Moment(NamedTuple):
    """A state of a viscoelastic contact at one time; energies are per area of the map.

    Attributes
    ----------
    time : float
        Its time.
    solution : Solution
        Gap, pressures and contact at that time. They belong to an elastic body with the modulus of the step, under
        heights that the memory of the body has lowered, and so do heights, displacement, approach and elastic energy of
        the solution.
    displacement : ndarray
        Displacement of the viscoelastic body, of the shape of the heights; with a periodic boundary up to a constant,
        and zero at absent nodes.
    approach : float or None
        Approach, with a free boundary.
    stored : float
        Elastic energy that the body would give back, and the adhesive energy.
    dissipated : float
        Energy that the body has dissipated so far.
    work : float
        Work that the load has done so far.
    imbalance : float
        Stored and dissipated energy less the work: zero up to the steps and the tolerance, and less than that by what
        jumps of the contact have dropped.
    """

    time: float
    solution: Solution
    displacement: NDArray[np.float64]
    approach: float | None
    stored: float
    dissipated: float
    work: float
    imbalance: float

    def __repr__(self) -> str:
        pressure, share = self.solution.mean_pressure, self.solution.contact_fraction
        return f"Moment(time={self.time:.7g}: mean_pressure={pressure:.7g}, contact_fraction={share:.7g})"


class _Body:
    """The memory of a body: displacements u and pressures K u, of the whole and of its branches."""

    def __init__(self, series: list[tuple[float, float]], shape: tuple[int, ...]) -> None:
        self._shares, self._times = np.array(series).reshape(-1, 2).T.reshape(2, -1, 1, 1, 1)
        self._rests = 1.0 - float(self._shares.sum())
        self._whole = np.zeros((2, *shape))
        self._branches = np.zeros((len(series), *self._whole.shape))

    def begin(self, duration: float) -> tuple[float, NDArray[np.float64]]:
        """The share s of the modulus in a step, and the depth v by which heights are lower."""
        steps = duration / self._times
        self._decays = np.exp(-steps)
        # at once a branch follows and does not decay
        self._linear = np.divide(-np.expm1(-steps), steps, out=np.ones_like(steps), where=steps > 0)
        self._halves = np.divide(1 - self._linear, steps, out=np.full_like(steps, 0.5), where=steps > 1e-6)
        follows = self._shares * self._linear
        self._share = self._rests + float(follows.sum())
        self._memory = (follows * self._whole - self._decays * self._branches).sum(0) / self._share
        return self._share, self._memory[0]

    def end(self, displacement: NDArray[np.float64], pressure: NDArray[np.float64]) -> tuple[float, float]:
        """The elastic energy at the end of a step, and the energy that is dissipated along it."""
        whole = np.stack([displacement, pressure / self._share + self._memory[1]])
        change, before = whole - self._whole, self._elastic()
        means = self._linear * self._branches + self._shares * self._halves * change
        # the work of the displacement, linear in time, on the pressures of all branches
        taken_up = self._rests * (_work(whole, whole) - _work(self._whole, self._whole)) / 2
        taken_up += sum(_work(mean, change) for mean in means)
        self._branches = self._decays * self._branches + self._shares * self._linear * change
        self._whole = whole
        return self._elastic(), taken_up - (self._elastic() - before)

    def _elastic(self) -> float:
        branches = sum(_work(branch, branch) / float(share) for branch, share in zip(self._branches, self._shares.flat))
        return (self._rests * _work(self._whole, self._whole) + branches) / 2


class Viscoelastic(Rows[Moment]):
    """The moments of a viscoelastic contact, each found when it is asked for, and the columns of their numbers.

    Only the numbers and the memory of the body are kept.
    """

    def __init__(self, contact: Posed, keys: dict[str, Any], start: Start, observe: Any) -> None:
        _refuse(contact)
        self._contact, self._observe, self._start = contact, observe, start
        self._ended, self._seconds_left = False, None
        self._moment: Moment | None = None
        self._body = _Body(_series(keys.get("prony")), contact.topography.heights.shape)
        self._load, self._path = _path(keys, contact._given.is_si)
        self.names = ("time", *_OF_SOLUTIONS, "corrected_contact_fraction", *_OF_MOMENTS)
        self.rows: list[dict[str, Any]] = []

    def __len__(self) -> int:
        """The number of times."""
        return len(self.rows) if self._ended else len(self._path)

    def __next__(self) -> Moment:
        if self._ended or len(self.rows) == len(self._path):
            self._ended = True
            raise StopIteration
        contact, before = self._contact, self._moment
        time, load = self._path[len(self.rows)]
        share, memory = self._body.begin(0.0 if before is None else time - before.time)
        heights = contact.topography.heights
        lowered = heights - memory
        # by how much sooner bodies touch that move towards each other
        sooner = float(np.nanmax(lowered) - np.nanmax(heights))
        solution = contact._relaxed(lowered, share, self._shift(load, sooner), self._start, self._observe)
        gap = np.asarray(solution.whole_gap, np.float64).reshape(heights.shape)
        pressure, displacement = mirror_field(read_field(solution.pressure, "pressures"), heights.shape), gap + heights
        approach, way = solution.approach, 0.0
        if approach is None:
            # a periodic body has a displacement but for its mean, on which pressures of no mean do no work
            pressure = pressure - pressure.mean()
            if before is not None:
                way = before.solution.mean_gap - solution.mean_gap
        else:
            approach -= sooner
            displacement = np.where(np.isfinite(gap), displacement - np.nanmax(heights) + approach, 0.0)
            if before is not None and before.approach is not None:
                way = approach - before.approach

        elastic, dissipated = self._body.end(displacement, pressure)
        (wall_stiffness,) = contact._given.numbers("wall_stiffness") or [0.0]
        springs = wall_stiffness * float(np.mean(np.minimum(gap, 0.0) ** 2)) / 2
        stored = elastic + springs + solution.adhesive_energy
        # the first load comes at once, from afar
        work = stored
        if before is not None:
            dissipated += before.dissipated
            work = before.work + way * (before.solution.mean_pressure + solution.mean_pressure) / 2
        self._moment = Moment(
            time, solution, solution.part_of(displacement), approach, stored, dissipated, work, stored + dissipated - work
        )
        row = {name: getattr(solution, name) for name in _OF_SOLUTIONS}
        row["corrected_contact_fraction"] = solution.statistics.corrected_contact_fraction
        self.rows.append(self._row({**row, **self._moment._asdict()}))
        self._start = solution
        # bodies that came apart under a force, or an observer that ended it, leave no state to continue from
        self._ended = solution.status in ("detached", "stopped")
        return self._moment

    def _shift(self, load: float, by: float) -> dict[str, float]:
        """The load of the lowered heights, with an approach that counts from another first touch."""
        if self._load == "approach":
            load += by
        return {self._load: load}

    def __repr__(self) -> str:
        return f"Viscoelastic({len(self.rows)} of {len(self)} times solved)"

    def plot(self, ax: Axes | None = None, *, of: str = "contact_fraction") -> Axes:
        """Draws a column over the time; needs matplotlib, and solves what is left.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; new ones by default.
        of : str
            Column to draw, as "contact_fraction", "mean_pressure", "mean_gap" or "approach".

        Returns
        -------
        matplotlib Axes
        """
        if of not in self.names:
            raise ValueError(f"of is {of!r}: it must be one of the columns {', '.join(self.names)}")
        units = {"mean_pressure": self._contact.pressure_unit} | dict.fromkeys(
            ("mean_gap", "approach"), self._contact.topography.unit
        )
        return figures.over_time(self.columns, of, ax, (1.0, units.get(of)))


def _work(one: NDArray[np.float64], other: NDArray[np.float64]) -> float:
    """The mean over the map of the displacement of one with the pressure of the other."""
    return float(np.mean(one[0] * other[1]))


def _series(prony: Any) -> list[tuple[float, float]]:
    """The shares and the relaxation times of a Prony series."""
    try:
        pairs = [(number("share", share), number("relaxation time", time)) for share, time in prony]
    except (TypeError, ValueError):
        raise TypeError(f"prony is {prony!r}: give pairs (share, relaxation time), as prony=[(0.5, 1.0), (0.3, 10.0)]") from None
    for share, time in pairs:
        if not (0.0 < share <= 1.0 and 0.0 < time < math.inf):
            raise ValueError(
                f"prony has ({share:g}, {time:g}): a share of the modulus is positive and at most 1, and its relaxation "
                "time positive and finite"
            )
    total = sum(share for share, _ in pairs)
    if total > 1.0 + 1e-12:
        raise ValueError(
            f"shares of prony add up to {total:g}, more than 1: they are parts of the instantaneous modulus; divide moduli by it"
        )
    # shares that add up to 1 but for rounding leave nothing
    return [(share / max(total, 1.0), time) for share, time in pairs]


def _path(keys: dict[str, Any], is_si: bool) -> tuple[str, list[tuple[float, float]]]:
    """The kind of the loads, and the moments with a load each."""
    given = [name for name in LOADS if name in keys]
    if len(given) != 1:
        known = ", ".join(LOADS)
        raise ValueError(f"loads are {' and '.join(given) or 'missing'}: give one list of {known}, a load at each of the times")
    times, loads = (_read_list(name, keys.get(name)) for name in ("times", given[0]))
    key = LOADS[given[0]]
    loads, have_units = in_si(**{given[0]: [load if isinstance(load, str) else number(key, load) for load in loads]})
    if have_units != is_si and any(loads):
        kind, other = ("with", "none") if have_units else ("without", "one")
        raise ValueError(f"{given[0]} are {kind} a unit, and modulus has {other}: give both units, or neither")
    moments = [number("time", time) for time in times]
    if len(moments) != len(loads) or not moments:
        raise ValueError(f"there are {len(moments)} times and {len(loads)} {given[0]}: give a load at each time, one at least")
    if not np.isfinite(moments).all():
        raise ValueError(f"times are {moments}: they must be finite")
    for before, time in zip(moments, moments[1:]):
        if time < before:
            raise ValueError(f"time {time:g} follows {before:g}: times must not fall; the same time twice is a step at once")
    return key, list(zip(moments, loads))


def _read_list(name: str, values: Any) -> list[Any]:
    if isinstance(values, str) or not isinstance(values, Iterable):
        raise TypeError(f"{name} is {values!r}: it must be a list of numbers")
    return list(values)


def _refuse(contact: Posed) -> None:
    """Refuses what does not relax as the half-space does."""
    law, _ = unwrap(contact.own_law)
    if isinstance(law, JKR) or contact.law == "jkr":
        raise ValueError(
            "law is jkr, whose range is that of the grid: the speed of an edge depends on the range: give a law that has one, "
            "as asperity.Exponential(work_of_adhesion, range)"
        )
    given = [key for key in ELASTIC if contact._keys.get(key) is not None]
    given += ["hardness"] * (contact._hardness is not None)
    for name in [*given, *["symbol"] * isinstance(contact.body, Symbol)]:
        raise ValueError(
            f"{name} is given: it does not relax as the modulus does; a viscoelastic body is a half-space or a Layer, and the "
            "other body is rigid"
        )
    if contact._keys.get("absent_missing") and contact._keys.get("boundary") != "free":
        raise ValueError("absent nodes of a periodic body have no displacement to remember: give boundary='free'")
