"""The keywords of solves, by the keys of scenes. Written by `UPDATE=1 cargo test -p asperity-scene --test keys`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypedDict

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import ArrayLike

    from ..bodies.wall import Penalty, Uzawa
    from ..common.types import OwnLaw, Quantity


class SurfaceKeywords(TypedDict, total=False):
    """The surface, the bodies, and the boundary."""

    modulus: Quantity | None
    boundary: Literal["periodic", "free"] | None
    absent_missing: bool | None
    layer: Quantity | None
    base: Literal["bonded", "sliding"] | None
    coating: Quantity | None
    coating_modulus: Quantity | None
    coating_poisson: float | None
    plate: Quantity | None
    poisson: float | None
    against_modulus: Quantity | None
    shift: Quantity | tuple[Quantity, Quantity] | None
    whole: bool | None


class AdhesionKeywords(TypedDict, total=False):
    """The adhesion between the surfaces, the wall, and the hardness."""

    law: Literal["none", "jkr", "maugis-dugdale", "exponential", "lennard-jones", "morse", "power", "van-der-waals"] | OwnLaw | None
    work_of_adhesion: Quantity | None
    range: Quantity | None
    exponent: float | None
    hamaker: Quantity | None
    cut_off: Quantity | None
    wall: Literal["hard", "none", "penalty", "uzawa"] | Penalty | Uzawa | None
    wall_stiffness: Quantity | None
    hardness: Quantity | ArrayLike | None


class SolverKeywords(TypedDict, total=False):
    """The method and the accuracy of a solve."""

    method: Literal["default", "rey2017"] | None
    tolerance: float | None
    max_iterations: int | None
    precision: Literal["f64", "f32"] | None
    threads: int | None
    branch: Literal["loading", "unloading", "both"] | None


class LoadKeywords(TypedDict, total=False):
    """The load of a solve, of which one is given."""

    mean_gap: Quantity | None
    mean_pressure: Quantity | None
    normal_force: Quantity | None
    approach: Quantity | None
    spring_stiffness: Quantity | None
    spring_position: Quantity | None
    reduced_pressure: float | None
    contact_fraction: float | None


class LoadsKeywords(TypedDict, total=False):
    """The loads of a table, a list of one kind."""

    mean_gaps: Iterable[Quantity] | None
    mean_pressures: Iterable[Quantity] | None
    normal_forces: Iterable[Quantity] | None
    approaches: Iterable[Quantity] | None
    spring_stiffness: Quantity | None
    spring_positions: Iterable[Quantity] | None
    reduced_pressures: Iterable[float] | None


class FractionsKeywords(TypedDict, total=False):
    """The contact fractions of a table."""

    contact_fractions: Iterable[float] | None


class NestedKeywords(TypedDict, total=False):
    """The grids of a solve."""

    nested: bool | None


class FindingsKeywords(TypedDict, total=False):
    """The findings after a solution."""

    stability: bool | None
    leave: bool | None
    stiffness: bool | None


class StiffnessKeywords(TypedDict, total=False):
    """The contact stiffness of each row of a table."""

    stiffness: bool | None


class ConductorKeywords(TypedDict, total=False):
    """The conductors, of which the contact stiffness tells the conductance."""

    resistivities: tuple[Quantity, Quantity] | None
    conductivities: tuple[Quantity, Quantity] | None


class LeakageKeywords(TypedDict, total=False):
    """The leakage of a table."""

    leakage: float | None


class AccuracyKeywords(TypedDict, total=False):
    """The accuracy that is asked for."""

    accuracy: float | None
    accuracy_of: Literal["area", "gap", "approach", "pressure"] | None
    memory: float | None


class PathKeywords(TypedDict, total=False):
    """The steps of a cycle."""

    steps: int | None
    smallest_step: float | None
    imbalance: float | None


class PullOffKeywords(TypedDict, total=False):
    """The pull-off that is asked for."""

    preload: Quantity | None
    rtol: float | None
    accuracy: float | None
    memory: float | None
