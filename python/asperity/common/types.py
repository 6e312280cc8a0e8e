"""The types of keywords, and of what reports have."""

from __future__ import annotations

from typing import Any, Literal, Protocol, TypeAlias, TypedDict

from numpy.typing import ArrayLike, NDArray

Boundary: TypeAlias = Literal["periodic", "free"]
WallName: TypeAlias = Literal["hard", "none", "penalty", "uzawa"]
Base: TypeAlias = Literal["bonded", "sliding"]
LawName: TypeAlias = Literal[
    "none", "jkr", "maugis-dugdale", "exponential", "lennard-jones", "morse", "power", "van-der-waals"
]
Method: TypeAlias = Literal["default", "rey2017"]
Precision: TypeAlias = Literal["f64", "f32"]
Branch: TypeAlias = Literal["loading", "unloading"]
Branches: TypeAlias = Literal["loading", "unloading", "both"]
AccuracyOf: TypeAlias = Literal["area", "gap", "approach", "pressure"]
AccuracyOfCycle: TypeAlias = Literal["work", "tension"]
Code: TypeAlias = Literal["abaqus", "comsol", "moose"]
AxisOrder: TypeAlias = Literal["xy", "yx"]
ScanAxis: TypeAlias = Literal["x", "y"]
RowAlignment: TypeAlias = Literal["median", "median-difference"]
Trend: TypeAlias = Literal["mean", "plane", "quadric"]
RemovedForm: TypeAlias = Literal["sphere", "cylinder"]

Criterion: TypeAlias = Literal["energy-norm", "complementarity"]
Verdict: TypeAlias = Literal["stable", "unstable", "undecided"]
Status: TypeAlias = Literal["converged", "iteration-limit", "stalled", "detached", "stopped"]

Shape: TypeAlias = int | tuple[int] | tuple[int, int]
#: A number, or a string with a unit, such as "70GPa".
Quantity: TypeAlias = float | str
Lengths: TypeAlias = Quantity | tuple[Quantity, Quantity]
Tilt: TypeAlias = float | tuple[float, float] | None


class HeightMap(Protocol):
    """A map of another package, such as SurfaceTopography."""

    @property
    def physical_sizes(self) -> Any:
        """Side lengths, None if they are unknown."""

    def heights(self) -> Any:
        """Heights, x along the first axis; masked ones are missing."""


class OwnLaw(Protocol):
    """An adhesion law of one's own: functions of an array of gaps g ≥ 0, as every `Law` has them."""

    def energy(self, gap: NDArray[Any], /) -> ArrayLike:
        """Energy per area γ(g), zero far away and negative near."""

    def traction(self, gap: NDArray[Any], /) -> ArrayLike:
        """Traction γ′(g), positive if it attracts."""

    def slope(self, gap: NDArray[Any], /) -> ArrayLike:
        """Slope γ″(g) of the traction."""


class GridError(TypedDict):
    """The estimated error of a quantity by the grid: relative, its order, and whether it is a rough estimate."""

    relative: float | None
    order: float | None
    rough: bool


class Patch(TypedDict):
    """The contact on the nodes of one work of adhesion."""

    work_of_adhesion: float
    area_fraction: float
    contact_fraction: float
    attractive_fraction: float


class Notice(TypedDict):
    """A warning."""

    code: str
    message: str
