"""The numbers of answers. Written by `UPDATE=1 cargo test -p asperity-scene --test numbers`."""

from __future__ import annotations

from typing import TypedDict, cast

from ..common.types import AccuracyOf, Boundary, Branch, Criterion, GridError, Method, Notice, Patch, Precision, Status, Verdict, WallName


class OtherBranch(TypedDict):
    """The entries of ``other_branch``."""

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
    """The entries of ``levels``."""

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


class GridErrors(TypedDict):
    """The entries of ``grid_error``."""

    area: GridError | None
    gap: GridError | None
    approach: GridError | None
    pressure: GridError | None


class Refinement(TypedDict):
    """The entries of ``accuracy``."""

    wanted: float
    of: AccuracyOf
    reached: bool


class Search(TypedDict):
    """The entries of ``search``."""

    wanted: float
    reached: bool
    below: float | None
    above: float | None
    solves: int
    operator_applications: int


class Steadiness(TypedDict):
    """The entries of ``stability``."""

    verdict: Verdict
    eigenvalue: float | None
    residual: float
    lower_bound: float | None
    error_bound: float | None
    smoothed: bool
    operator_applications: int


class Conducted(TypedDict):
    """The entries of ``conductance``."""

    value: float
    whole: float
    relative_error: float | None
    resistivities: list[float] | None
    conductivities: list[float] | None


class Narrowest(TypedDict):
    """The entries of ``constriction``."""

    gap: float
    node: list[int]
    path_nodes: int


class Transmissivity(TypedDict):
    """The entries of ``transmissivity``."""

    lower: float
    upper: float
    grid_error: float | None
    reached: bool
    iterations: int
    nodes: int


class Left(TypedDict):
    """The entries of ``departures``."""

    eigenvalue: float | None
    energy_drop: float
    distance: float | None


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
    criterion: Criterion
    iterations: int
    operator_applications: int
    levels: list[GridLevel] | None
    equivalent_applications: float | None
    grid_error: GridErrors | None
    grid_error_reason: str | None
    accuracy: Refinement | None
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
    constriction: dict[str, Narrowest | None] | None
    transmissivity: dict[str, Transmissivity] | None
    departures: list[Left] | None
    peak_traction: float | None
    mu_rho: float
    mu_rho_node: list[int] | None
    under_resolved: bool
    warnings: list[Notice]
    seconds: float
    control: str
    control_value: float
    heights: str | None
    against: str | None
    shift: list[float] | None
    initial_gap: str | None
    part: str | None
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


class Numbers:
    """The numbers of a solution that are known without a look at its fields."""

    _told: Report

    @property
    def status(self) -> Status:
        """End of the solve: ``converged``, ``stalled``, ``iteration-limit``, ``detached`` or ``stopped``."""
        return self._told["status"]

    @property
    def relative_error(self) -> float:
        """Certified relative error in the energy norm."""
        return cast("float", self._told["relative_error"])

    @property
    def iterations(self) -> int:
        """Iterations, on the finest of nested grids."""
        return self._told["iterations"]

    @property
    def operator_applications(self) -> int:
        """Operator applications, each a forward and an inverse transform, on the finest of nested grids."""
        return self._told["operator_applications"]

    @property
    def mean_gap(self) -> float:
        """Mean gap."""
        return self._told["mean_gap"]

    @property
    def mean_pressure(self) -> float:
        """Mean external pressure p̄, the normal force over the nominal area, compression positive."""
        return self._told["mean_pressure"]

    @property
    def normal_force(self) -> float:
        """Normal force F = p̄·Lx·Ly, compression positive."""
        return self._told["normal_force"]

    @property
    def approach(self) -> float | None:
        """With a free boundary, or a given approach of a layer or a coating, the way of the bodies towards
        each other since first touch without deformation. None where it does not apply."""
        return self._told["approach"]

    @property
    def mean_contact_pressure(self) -> float:
        """Mean contact pressure."""
        return self._told["mean_contact_pressure"]

    @property
    def contact_fraction(self) -> float:
        """Share of the nodes in contact, without absent nodes."""
        return self._told["contact_fraction"]

    @property
    def absent_nodes(self) -> int:
        """Absent nodes, at which nothing faces the half-space."""
        return self._told["absent_nodes"]

    @property
    def edge_traction(self) -> float | None:
        """With a free boundary, the largest traction on the outermost nodes over the largest anywhere: above
        0.001 the map is too small, unless the body ends there. None where it does not apply."""
        return self._told["edge_traction"]

    @property
    def elastic_energy(self) -> float:
        """Elastic energy per area."""
        return self._told["elastic_energy"]

    @property
    def adhesive_energy(self) -> float:
        """Adhesive energy per area."""
        return self._told["adhesive_energy"]

    @property
    def contact_stiffness(self) -> float | None:
        """Contact stiffness dp̄/dδ, the slope of the mean pressure over the approach, or over minus the mean
        gap: the stiffness of a flat punch with the outline of the contact. Infinite in full contact; with
        adhesion it may be negative. None where it does not apply."""
        return self._told["contact_stiffness"]

    @property
    def normal_stiffness(self) -> float | None:
        """Normal stiffness dF/dδ, with the contact stiffness. None where it does not apply."""
        return self._told["normal_stiffness"]

    @property
    def boundary(self) -> Boundary:
        """The boundary."""
        return self._told["boundary"]
