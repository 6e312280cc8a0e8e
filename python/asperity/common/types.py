"""The types of keywords and of the report of a solve."""

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
Code: TypeAlias = Literal["abaqus", "comsol", "moose"]
AxisOrder: TypeAlias = Literal["xy", "yx"]
ScanAxis: TypeAlias = Literal["x", "y"]
RowAlignment: TypeAlias = Literal["median", "median-difference"]
Trend: TypeAlias = Literal["mean", "plane", "quadric"]
RemovedForm: TypeAlias = Literal["sphere", "cylinder"]

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


class OtherBranch(TypedDict):
    """The equilibrium on the other branch."""

    branch: Branch | None
    status: Status
    relative_error: float | None
    load_error: float | None
    operator_applications: int
    contact_fraction: float
    mean_gap: float
    mean_pressure: float
    elastic_energy: float
    adhesive_energy: float
    distance: float | None
    same: bool


class GridLevel(TypedDict):
    """One of the nested grids."""

    shape: list[int]
    status: Status
    iterations: int
    operator_applications: int
    relative_error: float | None
    mean_gap: float
    mean_pressure: float
    mean_contact_pressure: float
    elastic_energy: float
    contact_fraction: float
    corrected_contact_fraction: float | None
    jkr_contact_fraction: float | None
    contact_stiffness: float | None


class GridError(TypedDict):
    """The estimated error of a quantity by the grid: relative, its order, and whether it is a rough estimate."""

    relative: float | None
    order: float | None
    rough: bool


class GridErrors(TypedDict):
    """The estimated errors of the grid; None where one is unknown, or its quantity is given."""

    area: GridError | None
    gap: GridError | None
    approach: GridError | None
    pressure: GridError | None


class Reached(TypedDict):
    """The end of a solve to an accuracy."""

    wanted: float
    of: AccuracyOf
    reached: bool


class Search(TypedDict):
    """The search for the load of a contact fraction."""

    wanted: float
    reached: bool
    below: float | None
    above: float | None
    solves: int
    operator_applications: int


class Patch(TypedDict):
    """The contact on the nodes of one work of adhesion."""

    work_of_adhesion: float
    area_fraction: float
    contact_fraction: float
    attractive_fraction: float


class Steadiness(TypedDict):
    """The stability of an equilibrium."""

    verdict: Literal["stable", "unstable", "undecided"]
    eigenvalue: float | None
    residual: float
    lower_bound: float | None
    error_bound: float | None
    smoothed: bool
    operator_applications: int


class Conducted(TypedDict):
    """The conductance of a contact per area and of the whole; no relative error where the error of the grid is unknown."""

    value: float
    whole: float
    relative_error: float | None
    resistivities: list[float] | None
    conductivities: list[float] | None


class Departure(TypedDict):
    """An unstable equilibrium that was left."""

    eigenvalue: float
    energy_drop: float
    distance: float


class Told(TypedDict):
    """A warning."""

    code: str
    message: str


class Report(TypedDict):
    """The report of a solve, with the keys of the tool's report.json: its outcome, then its inputs.

    Numbers are in the units of the input, energies per area; None where a key does not apply, or where a number is
    not finite, as an error that is not known yet: the report is what ``json.loads`` reads from that file. Attributes of
    a solution, as ``relative_error``, are infinite there.
    """

    command: str
    status: Status
    branch: Branch | None
    other_branch: OtherBranch | None
    relative_error: float | None
    load_error: float | None
    criterion: Literal["energy-norm", "complementarity"]
    iterations: int
    operator_applications: int
    levels: list[GridLevel] | None
    equivalent_applications: float | None
    grid_error: GridErrors | None
    grid_error_reason: str | None
    accuracy: Reached | None
    search: Search | None
    mean_gap: float
    mean_pressure: float
    normal_force: float
    approach: float | None
    spring_stiffness: float | None
    net_pressure: float
    mean_contact_pressure: float
    contact_fraction: float
    contact_nodes: int
    absent_nodes: int
    edge_traction: float | None
    adhesive_contact_fraction: float | None
    jkr_contact_fraction: float | None
    corrected_contact_fraction: float | None
    perimeter: float
    repulsive_fraction: float
    attractive_fraction: float
    patches: list[Patch] | None
    min_gap: float
    min_pressure: float
    max_pressure: float
    elastic_energy: float
    adhesive_energy: float
    plastic_fraction: float | None
    plastic_depth_max: float | None
    plastic_depth_mean: float | None
    plastic_energy: float | None
    stability: Steadiness | None
    contact_stiffness: float | None
    stiffness_error: float | None
    normal_stiffness: float | None
    conductance: Conducted | None
    percolates: dict[str, bool] | None
    constriction: dict[str, Any] | None
    transmissivity: dict[str, Any] | None
    departures: list[Departure] | None
    peak_traction: float | None
    mu_rho: float
    mu_rho_node: list[int] | None
    under_resolved: bool
    warnings: list[Told]
    seconds: float
    control: Literal["mean-pressure", "mean-gap", "normal-force", "approach", "spring"]
    control_value: float
    heights: str | None
    against: str | None
    shift: list[float] | None
    initial_gap: str | None
    part: Literal["original", "whole"] | None
    solved_shape: list[int] | None
    shape: list[int]
    lengths: list[float]
    rms_slope: float | None
    rms_slope_differences: float | None
    length_unit: str | None
    pressure_unit: str | None
    given: dict[str, str | list[str]] | None
    boundary: Boundary
    modulus: float
    poisson: float | None
    layer: float | None
    base: str | None
    coating: float | None
    coating_modulus: float | None
    coating_poisson: float | None
    plate: float | None
    symbol: str | None
    against_modulus: float | None
    law: str
    work_of_adhesion: float | None
    range: float | None
    exponent: float | None
    hamaker: float | None
    law_table: str | None
    cut_off: float | None
    work_of_adhesion_map: str | None
    wall: WallName
    wall_stiffness: float | None
    hardness: float | None
    hardness_map: str | None
    method: Method
    precision: Precision
    tolerance: float
    max_iterations: int
    threads: int
    version: str
