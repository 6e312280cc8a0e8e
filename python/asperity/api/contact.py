"""A contact problem that is solved under loads."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable
from dataclasses import replace
from os import PathLike
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _asperity
from .._asperity import Iteration
from ..answers.cycle import Cycle
from ..answers.findings import Plan, Stability
from ..answers.interface import Interface
from ..answers.posed import Posed, Turns
from ..answers.pull_off import PullOff
from ..answers.rows import Rows
from ..answers.solution import Solution, Start
from ..answers.sweep import Sweep
from ..bodies.body import Body, Symbol
from ..bodies.parameters import Parameters
from ..bodies.wall import Penalty, Uzawa
from ..common.progress import default_progress
from ..common.types import (
    AccuracyOf,
    AccuracyOfCycle,
    AxisOrder,
    Base,
    Boundary,
    Branches,
    LawName,
    Lengths,
    Method,
    OwnLaw,
    Precision,
    Quantity,
    WallName,
)
from ..common.units import shown
from ..common.warnings import ConvergenceWarning, warn
from ..common.words import suggests
from ..laws.composite import Varying
from ..maps.arrays import read_field
from ..maps.heights import Heights, knows_axes, read_axes, read_heights
from ..maps.topography import Topography
from ..relaxation.viscoelastic import Viscoelastic
from .keywords import OF_LAWS, pick, refuse_both, replace_spring, split_springs

R = TypeVar("R", bound=Rows[Any])
T = TypeVar("T")


def solve_once(way: Callable[..., T], values: dict[str, Any]) -> T:
    """Poses a contact problem by the values of a call, and solves it once by a method of the contact."""
    contact = Contact.__new__(Contact)
    keys = pick(Contact.__init__, values)
    contact._pose(values["heights"], values["lengths"], values["axes"], keys, is_kept=False)
    return way(contact, **pick(way, values))


class Contact(Posed):
    """A contact problem: heights, bodies, adhesion and solver, which is solved under loads.

    It holds the problem, so that a further solve does not read and copy the heights again. `solve`, `sweep`, `cycle`,
    `interface`, `pull_off` and `viscoelastic` are short for a contact and one call of it, with the same results.
    Solves of one contact in several threads wait for each other.

    Parameters
    ----------
    heights, lengths, axes, modulus, ...
        Parameters of `solve` that pose the problem; its loads, and what a solve finds, are parameters of the methods.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> contact = asperity.Contact(rough, modulus=1.0, law="exponential", work_of_adhesion=1e-5, range=4e-3)
    >>> light, heavy = (contact.solve(mean_pressure=p) for p in (0.005, 0.02))
    >>> light.contact_fraction < heavy.contact_fraction
    True
    """

    # by this name pickles find it
    __module__ = "asperity"

    @suggests
    def __init__(
        self,
        heights: Heights,
        lengths: Lengths | None = None,
        *,
        axes: AxisOrder | None = None,
        modulus: Quantity | None = None,
        law: LawName | OwnLaw | None = None,
        work_of_adhesion: Quantity | None = None,
        range: Quantity | None = None,
        exponent: float | None = None,
        hamaker: Quantity | None = None,
        cut_off: Quantity | None = None,
        branch: Branches | None = None,
        boundary: Boundary | None = "periodic",
        absent_missing: bool | None = False,
        against: Heights | None = None,
        against_modulus: Quantity | None = None,
        shift: Quantity | tuple[Quantity, Quantity] | None = None,
        whole: bool | None = False,
        body: Body | None = None,
        layer: Quantity | None = None,
        base: Base | None = None,
        coating: Quantity | None = None,
        coating_modulus: Quantity | None = None,
        coating_poisson: float | None = None,
        plate: Quantity | None = None,
        poisson: float | None = None,
        hardness: Quantity | ArrayLike | None = None,
        wall: WallName | Penalty | Uzawa | None = "hard",
        wall_stiffness: Quantity | None = None,
        tolerance: float | None = None,
        method: Method | None = "default",
        max_iterations: int | None = None,
        precision: Precision | None = "f64",
        threads: int | None = None,
    ) -> None:
        self._pose(heights, lengths, axes, pick(Contact.__init__, locals()), is_kept=True)

    @classmethod
    def from_numbers(cls, topography: Topography, keys: dict[str, Any], is_si: bool) -> Contact:
        """The problem of numbers, which are in SI units or have no units, to be solved once."""
        contact = cls.__new__(cls)
        contact._pose(topography, None, None, keys, is_kept=False, is_si=is_si)
        return contact

    def _pose(
        self,
        heights: Heights,
        lengths: Lengths | None,
        axes: AxisOrder | None,
        keywords: dict[str, Any],
        is_kept: bool,
        is_si: bool = False,
    ) -> None:
        keys = {key: value for key, value in keywords.items() if value is not None}
        if "modulus" not in keys:
            raise TypeError("modulus is missing: give the contact modulus E*, a pressure, as modulus=1.0 or '70GPa'")
        self.branch = keys.get("branch")
        against, body = keys.pop("against", None), keys.pop("body", None)
        if isinstance(keys.get("law"), str):
            keys["law"] = keys["law"].lower()
        law = keys.pop("law") if not isinstance(keys.get("law"), str | None) else None
        self.own_law = law
        self.body, self.law = body, law if law is not None else keys.get("law")
        if law is not None:
            refuse_both("law", OF_LAWS, keys)
        if not isinstance(body, Parameters | Symbol | None):
            raise TypeError(f"body is {shown(body)}: it must be an asperity.Layer, Coating or Symbol")
        order = read_axes(heights, axes)
        if order == "yx" and isinstance(law, Varying) and not law.knows_axes:
            raise ValueError(
                "heights have y along their first axis, and the works of adhesion of law do not say whether they have: "
                "give asperity.Varying(law, work_of_adhesion, axes='yx'), or axes='xy'"
            )
        if keys.get("law") == "table":
            raise ValueError(
                "law is table: give its values, as law=asperity.Tabulated(gaps, tractions), or its file, as "
                "law=asperity.Tabulated.read(path)"
            )
        wall = keys.get("wall")
        for name, described in (("wall", wall), ("body", body)):
            if isinstance(described, Parameters):
                keys.pop(name, None)
                refuse_both(name, described.keys, keys)
                keys.update(described.keys)
        hardness = keys.pop("hardness") if np.ndim(keys.get("hardness", 0.0)) > 0 else None
        if hardness is not None and np.asarray(hardness).dtype == bool:
            raise TypeError("hardness is an array of truth values: it must be one of pressures")
        if lengths is not None:
            keys["lengths"] = lengths
        self._keys, self._is_si, self._given = keys, is_si, _asperity.Keywords(keys, law, is_si)
        self.pressure_unit = "Pa" if self._given.is_si else None
        self._facing, self._is_kept = None, is_kept
        self._hardness = None if hardness is None else read_field(hardness, "hardness", order).copy()
        given = read_heights(heights, axes)
        other = None if against is None else read_heights(against, None if knows_axes(against) else axes)
        self._posed = self._problem(given, self._given, is_kept, other)
        # an array may change before the heights are asked for
        own = {} if isinstance(heights, Topography | str | PathLike) else {"heights": given.heights.copy()}
        changed = {**own, **self._posed.posed}
        self.topography = replace(given, **changed) if changed else given
        self._facing = self._posed.facing
        self.turns = Turns()
        self.beyond_theory = self.problem.beyond_theory
        moduli = [self._given.numbers(key) for key in ("modulus", "against_modulus")]
        self.modulus = 1 / sum(1 / modulus[0] for modulus in moduli if modulus is not None)
        self._warned = set()

    def __repr__(self) -> str:
        given = {**self._keys, "law": self.law, "body": None if isinstance(self.body, Parameters) else self.body}
        told = [f"{key}={shown(value)}" for key, value in given.items() if value is not None and key != "lengths"]
        return f"Contact({', '.join([repr(self.topography), *told])})"

    @suggests
    def solve(
        self,
        *,
        mean_pressure: Quantity | None = None,
        mean_gap: Quantity | None = None,
        normal_force: Quantity | None = None,
        approach: Quantity | None = None,
        spring: tuple[Quantity, Quantity] | None = None,
        spring_stiffness: Quantity | None = None,
        spring_position: Quantity | None = None,
        reduced_pressure: float | None = None,
        contact_fraction: float | None = None,
        accuracy: float | None = None,
        accuracy_of: AccuracyOf | None = None,
        memory: float | None = None,
        nested: bool | None = None,
        stability: bool | None = False,
        leave: bool | None = False,
        stiffness: bool | None = False,
        resistivities: tuple[Quantity, Quantity] | None = None,
        conductivities: tuple[Quantity, Quantity] | None = None,
        start: Start = None,
        observe: Callable[[Iteration], object] | None = None,
    ) -> Solution:
        """Finds the equilibrium under a load, as `asperity.solve`."""
        start, observe, keys = self._split(pick(Contact.solve, locals()), is_solve=True)
        replace_spring(keys)
        with self.turns:
            found = self.problem.solve(keys, self._start(start), observe)
            plan = found["plan"]
            # within the turn, so that one of several threads warns
            return self._solution({**found, "plan": None if plan is None else Plan(*plan)})

    @suggests
    def sweep(
        self,
        *,
        mean_pressures: Iterable[Quantity] | None = None,
        mean_gaps: Iterable[Quantity] | None = None,
        normal_forces: Iterable[Quantity] | None = None,
        approaches: Iterable[Quantity] | None = None,
        springs: Iterable[tuple[Quantity, Quantity]] | None = None,
        spring_stiffness: Quantity | None = None,
        spring_positions: Iterable[Quantity] | None = None,
        reduced_pressures: Iterable[float] | None = None,
        contact_fractions: Iterable[float] | None = None,
        stiffness: bool | None = False,
        resistivities: tuple[Quantity, Quantity] | None = None,
        conductivities: tuple[Quantity, Quantity] | None = None,
        leakage: float | None = None,
        start: Start = None,
        observe: Callable[[Iteration], object] | None = None,
        out: str | PathLike[str] | None = None,
        force: bool | None = False,
        fields: str | PathLike[str] | None = None,
    ) -> Sweep:
        """Solves under many loads, as `asperity.sweep`."""
        return self._rows(Sweep, "sweep", pick(Contact.sweep, locals()))

    @suggests
    def cycle(
        self,
        *,
        mean_pressures: Iterable[Quantity] | None = None,
        mean_gaps: Iterable[Quantity] | None = None,
        normal_forces: Iterable[Quantity] | None = None,
        approaches: Iterable[Quantity] | None = None,
        springs: Iterable[tuple[Quantity, Quantity]] | None = None,
        spring_stiffness: Quantity | None = None,
        spring_positions: Iterable[Quantity] | None = None,
        reduced_pressures: Iterable[float] | None = None,
        accuracy: float | None = None,
        accuracy_of: AccuracyOfCycle | None = None,
        memory: float | None = None,
        steps: int | None = 50,
        smallest_step: float | None = None,
        imbalance: float | None = 0.0001,
        start: Start = None,
        observe: Callable[[Iteration], object] | None = None,
        out: str | PathLike[str] | None = None,
        force: bool | None = False,
        smooth: bool | None = True,
        fields: str | PathLike[str] | None = None,
    ) -> Cycle:
        """Follows a branch of equilibria through turning points, as `asperity.cycle`."""
        keys = pick(Contact.cycle, locals())
        return self._rows(Cycle, "cycle", {"sharp": not keys.pop("smooth", True), **keys})

    @suggests
    def interface(
        self,
        *,
        mean_pressures: Iterable[Quantity] | None = None,
        mean_gaps: Iterable[Quantity] | None = None,
        reduced_pressures: Iterable[float] | None = None,
        resistivities: tuple[Quantity, Quantity] | None = None,
        conductivities: tuple[Quantity, Quantity] | None = None,
        leakage: float | None = None,
        start: Start = None,
        observe: Callable[[Iteration], object] | None = None,
        out: str | PathLike[str] | None = None,
        force: bool | None = False,
    ) -> Interface:
        """Tabulates the law of an interface over the load, as `asperity.interface`."""
        return self._rows(Interface, "interface", pick(Contact.interface, locals()))

    @suggests
    def pull_off(
        self,
        *,
        preload: Quantity | None = None,
        accuracy: float | None = None,
        memory: float | None = None,
        rtol: float | None = 0.02,
        start: Start = None,
        observe: Callable[[Iteration], object] | None = None,
    ) -> PullOff:
        """Finds the pull-off, as `asperity.pull_off`."""
        start, observe, keys = self._split(pick(Contact.pull_off, locals()))
        if "accuracy" in keys and start is not None:
            raise ValueError("an accuracy takes finer grids, which have no start: leave out start, or accuracy")
        with self.turns:
            found = self.problem.pull_off(keys, self._start(start), observe)
        solution = self._solution(found)
        if found["shortfall"] is not None:
            warn(found["shortfall"], ConvergenceWarning)
        entries = found["pull_off"]
        pressure, force = entries.pop("pull_off_pressure"), entries.pop("pull_off_force")
        return PullOff(pressure, force, **entries, solution=solution)

    @suggests
    def viscoelastic(
        self,
        *,
        mean_pressures: Iterable[Quantity] | None = None,
        mean_gaps: Iterable[Quantity] | None = None,
        normal_forces: Iterable[Quantity] | None = None,
        approaches: Iterable[Quantity] | None = None,
        prony: Iterable[tuple[float, float]] | None = None,
        times: Iterable[float] | None = None,
        start: Start = None,
        observe: Callable[[Iteration], object] | None = None,
    ) -> Viscoelastic:
        """Follows a viscoelastic body over time, as `asperity.viscoelastic`."""
        start, observe, keys = self._split(pick(Contact.viscoelastic, locals()))
        return Viscoelastic(self, keys, start, observe)

    @suggests
    def stability(
        self,
        solution: Solution,
        *,
        mean_pressure: Quantity | None = None,
        mean_gap: Quantity | None = None,
        normal_force: Quantity | None = None,
        approach: Quantity | None = None,
        spring: tuple[Quantity, Quantity] | None = None,
        spring_stiffness: Quantity | None = None,
        spring_position: Quantity | None = None,
        reduced_pressure: float | None = None,
        contact_fraction: float | None = None,
    ) -> Stability:
        """Finds out whether a solution is stable, as `asperity.stability`."""
        keys = pick(Contact.stability, locals())
        replace_spring(keys)
        if not keys:
            name, value = solution.report["control"].replace("-", "_"), solution.report["control_value"]
            stiffness = solution.report["spring_stiffness"]
            held = {"spring_stiffness": stiffness, "spring_position": value}
            keys = held if name == "spring" else {name: value}
        gap = np.asarray(solution.whole_gap, dtype=np.float64).reshape(self.topography.heights.shape)
        with self.turns:
            found = self.problem.stability(keys, gap, solution.relative_error)
        return Stability(**{**found, "mode": solution.part_of(found["mode"])})

    def _split(self, keys: dict[str, Any], *, is_solve: bool = False) -> tuple[Start, Any, dict[str, Any]]:
        """The start, the observer, and the keys of a call."""
        start, observe = keys.pop("start", None), keys.pop("observe", None) or default_progress()
        if self.branch is not None and start is not None:
            raise ValueError("start chooses the branch: leave out branch, or start")
        if self.branch == "both" and not is_solve:
            raise ValueError("branch is both: that compares two solves under one load: use solve, or give one branch")
        return start, observe, keys

    def _rows(self, kind: type[R], way: str, keywords: dict[str, Any]) -> R:
        """The rows of a table, with a problem of their own, as they are solved when they are asked for."""
        start, observe, keys = self._split(keywords)
        file = (keys.pop("out", None), keys.pop("fields", None), keys.pop("force", False))
        contact = self
        if self._is_kept:
            contact = copy.copy(self)
            contact._posed, contact.turns = self._problem(self.topography, self._given, False), Turns()
            contact._is_kept, contact._warned = False, set()
        return kind(contact, way, split_springs(keys), start, observe, file)
