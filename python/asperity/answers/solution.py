"""The solution of a contact problem: its fields, its numbers, and how good they are."""

from __future__ import annotations

import json
import os
from functools import cached_property
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _asperity
from ..common.optional import package
from ..common.types import Boundary, Quantity
from ..common.units import in_si, in_unit
from ..common.words import suggests
from ..maps.arrays import read_field
from ..maps.topography import Topography
from ..plot import figures
from .findings import Conductance, Constriction, ContactStatistics, Percolation, Plan, PressureDistribution
from .numbers import Numbers, Report

if TYPE_CHECKING:
    from xarray import Dataset

#: The fields of a folder that every solve leaves, and those that some do.
FIELDS = ("gap", "pressure", "contact_pressure")
OTHERS = ("plastic_depth", "mode", "displacement", "against_displacement", "heights")


class Solution(Numbers):
    """An equilibrium: fields of the shape of the heights, and the account of the solve.

    All numbers are in the units of the input; energies are per area, compression is positive. Gap and pressures are
    read-only: copy one to change it. What is found of them, contact, statistics and the rest of the report, is computed
    when it is first asked for.

    Attributes
    ----------
    gap : ndarray
        Gap g ≥ 0 between the surfaces, a length; infinite at absent nodes.
    pressure : ndarray
        Elastic pressure p + p̄ on the half-space: the contact pressure less the adhesive traction. Zero at absent
        nodes.
    contact_pressure : ndarray
        Contact pressure λ ≥ 0, zero wherever the gap is not; at most the hardness, if there is one.
    plastic_depth : ndarray or None
        Depth by which the surface has yielded, with a hardness. The gap is that to the surface as it is now.
    mode : ndarray or None
        Change of the gap along which the energy is softest, of mean square 1, where stability was asked for.
    whole_gap : ndarray
        Gap on all nodes that were solved. On a mirrored map these include the mirror images, while the other fields are
        on the original, unless the solve was asked for the whole. ``report["part"]`` says which it is.
    topography : Topography
        Map of the heights that were solved. Where an accuracy was asked for, it is on the grid of the solution. A
        solution that was loaded without them has none.
    body : Layer, Coating, Symbol or None
        Body that deforms, unless it is a half-space.
    law : object, str or None
        Adhesion law, or the word for it.
    plan : Plan or None
        What the accuracy was likely to take, where one was asked for.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(128, 1.0, rms_slope=0.1, k_s=16, seed=1)
    >>> solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    >>> solution.status, solution.gap.shape
    ('converged', (128, 128))
    >>> bool(((solution.gap > 0) & (solution.contact_pressure > 0)).any())
    False
    """

    gap: NDArray[np.floating[Any]]
    whole_gap: NDArray[np.floating[Any]]
    pressure: NDArray[np.floating[Any]]
    contact_pressure: NDArray[np.floating[Any]]
    plastic_depth: NDArray[np.floating[Any]] | None
    mode: NDArray[np.floating[Any]] | None
    plan: Plan | None

    def __init__(
        self, topography: Topography | tuple[int, ...], of: tuple[Any, Any], told: Report, found: dict[str, Any]
    ) -> None:
        # of a map that is not known there is the shape
        shape = topography if isinstance(topography, tuple) else topography.shape
        self._topography = None if isinstance(topography, tuple) else topography
        self.body, self.law = of
        self.plan = found.get("plan")
        self.whole_gap = found["gap"].reshape(shape)
        self._part = tuple(slice(nodes) for nodes in told["shape"][: len(shape)])
        for name in ("gap", "pressure", "contact_pressure"):
            setattr(self, name, self.part_of(found[name]))
        for name in ("plastic_depth", "mode"):
            setattr(self, name, None if found[name] is None else self.part_of(found[name]))
        # the numbers of the report as they are, without what is found of the fields, and what finds that
        self._told, self._look, self._tell, self._displace = told, found["look"], found["tell"], found["displacements"]

    def part_of(self, field: NDArray[Any]) -> NDArray[Any]:
        """The part of a field on the whole map that the solution is of."""
        return field.reshape(self.whole_gap.shape)[self._part]

    @property
    def topography(self) -> Topography:
        """Map of the heights that were solved."""
        if self._topography is None:
            raise ValueError("the folder of this solution has no heights: give asperity.load heights=...")
        return self._topography

    @cached_property
    def _looked(self) -> tuple[ContactStatistics, Report]:
        counted, report = self._look()
        counted["cluster_sizes"] = np.array(counted["cluster_sizes"], np.int64)
        return ContactStatistics(*(counted[name] for name in ContactStatistics._fields)), report

    @cached_property
    def _rows(self) -> list[tuple[str, str]]:
        return list(self._tell())

    def __getstate__(self) -> dict[str, Any]:
        # a solution travels complete, and without its view of the memory of this process
        complete = {"_looked": self._looked, "_rows": self._rows, "_displacements": self._displacements}
        return {**self.__dict__, **complete, "_look": None, "_tell": None, "_displace": None}

    @cached_property
    def contact(self) -> NDArray[np.bool_]:
        """Contact map: where there is no gap, or a contact pressure."""
        return (self.gap <= 0) | (self.contact_pressure > 0)

    @property
    def statistics(self) -> ContactStatistics:
        """Areas, perimeter and clusters of the contact."""
        return self._looked[0]

    def pressure_distribution(self, bins: int = 50) -> PressureDistribution:
        """Distribution of the contact pressure over the nodes in contact.

        Nodes that are apart are in no bin, whether they attract or not, and absent nodes are not counted at all.

        Parameters
        ----------
        bins : int
            Number of bins, equally wide but for the last one where a few pressures are far above all others.

        Returns
        -------
        PressureDistribution
            ``density`` and ``edges``, as ``matplotlib.pyplot.stairs`` takes them.

        Examples
        --------
        >>> import asperity
        >>> rough = asperity.surface.self_affine(128, 1.0, rms_slope=0.1, k_s=16, seed=1)
        >>> solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
        >>> density, edges = solution.pressure_distribution(20)
        >>> bool(abs(sum(density) * edges[1] - solution.contact_fraction) < 1e-12)
        True
        """
        gap, pressure = read_field(self.gap, "gaps"), read_field(self.contact_pressure, "pressures")
        return PressureDistribution(*_asperity.pressure_distribution(gap, pressure, bins))

    @property
    def flow_boundary(self) -> Boundary:
        """Boundary of a flow through the gap: free at the sides of the original of a mirrored map."""
        return "free" if self.boundary == "free" or self._told["part"] == "original" else "periodic"

    def percolation(self) -> Percolation:
        """Percolation of the gap: whether open nodes connect the sides, and where the constriction is.

        A periodic gap percolates along x if a cluster of open nodes winds around the cell along x, alone or along y as
        well. Neighbours are nodes with cells that share a side. Absent nodes are closed.

        Examples
        --------
        >>> import asperity
        >>> rough = asperity.surface.self_affine(128, 1.0, rms_slope=0.1, k_s=16, seed=1)
        >>> light, heavy = (asperity.solve(rough, modulus=1.0, mean_pressure=p).percolation() for p in (0.005, 0.05))
        >>> light.x is not None, heavy.x is None
        (True, True)
        """
        found = _asperity.percolation(read_field(self.gap, "gaps"), self.lengths, self.flow_boundary)
        x, y = (None if along is None else Constriction(*along) for along in found)
        return Percolation(x, y)

    @suggests
    def conductance(self, resistivities: tuple[Quantity, Quantity]) -> Conductance:
        """Conductance of the contact between two half-spaces, by its stiffness at fixed spots (Barber's identity).

        1/R = 2 (dF/dδ)/(E* (ρ₁ + ρ₂)), whatever the shape and number of the spots; a circle of radius a has 4a/(ρ₁ +
        ρ₂). The spots conduct perfectly, the gap not at all. Adhesion makes other spots, but conducts nothing itself.

        Parameters
        ----------
        resistivities : (float, float) or (str, str)
            Resistivities ρ of both bodies; for heat, reciprocal conductivities. With units, such as "17nOhm m", the
            conductance is in SI units.

        Returns
        -------
        Conductance

        Examples
        --------
        >>> import asperity
        >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
        >>> solution = asperity.solve(rough, modulus=2.0, mean_pressure=0.02, stiffness=True)
        >>> found = solution.conductance(resistivities=(1.0, 3.0))
        >>> abs(found.per_area / (2 * solution.contact_stiffness / (2.0 * 4.0)) - 1) < 1e-4
        True
        """
        body = next((key for key in ("layer", "coating", "plate", "symbol") if self._told[key] is not None), None)
        if body is not None:
            raise ValueError(f"the body is a {body}: conductance is that between half-spaces")
        if self._told["wall"] != "hard":
            raise ValueError(f"the wall is {self._told['wall']}: only a hard wall says where the surfaces conduct")
        resistivities, is_si = in_si(resistivities=resistivities)
        first, second = (float(one) for one in resistivities)
        gap = read_field(self.whole_gap, "gaps")
        shares = zip(self.lengths, gap.shape, self._told["shape"], strict=True)
        unit = self._check_units("resistivities", (first, second), is_si)
        metre = in_unit("length_unit", unit) if is_si else 1.0
        lx, ly = (metre * (length if nodes == part else length / part * nodes) for length, nodes, part in shares)
        per_area, _, error = _asperity.conductance(gap <= 0, (lx, ly), self.boundary, (first, second))
        of_grid = self._told["stiffness_error"] if self._told["law"] == "none" else None
        lx, ly = self.lengths
        return Conductance(per_area, per_area * lx * ly * metre**2, None if of_grid is None else error + of_grid)

    @cached_property
    def report(self) -> Report:
        """Account of the solve, with the keys of the tool's ``report.json``.

        ``"heights"`` is the file that they came from, if they came from one.
        """
        return self._looked[1]

    def save(self, folder: str | os.PathLike[str]) -> None:
        """Writes the fields, the heights and the report into a folder; `asperity.load` reads it.

        Fields and report are as ``asperity solve --out`` writes them, for ``asperity contact`` and the other commands
        that read results. The program writes no heights, but the scene, ``scene.toml``, and pictures.

        Parameters
        ----------
        folder : str or path
            Folder, which is made if it is not there: ``gap.npy`` and so on, ``heights.npy`` and ``report.json``.
        """
        os.makedirs(folder, exist_ok=True)
        # absent nodes have no gap
        gap = np.where(np.isfinite(self.gap), self.gap, np.nan)
        displacement, against = self._displacements or (None, None)
        heights = None if self._topography is None else self.heights
        others = (self.plastic_depth, self.mode, displacement, against, heights)
        values = (gap, self.pressure, self.contact_pressure, *others)
        for name, field in zip((*FIELDS, *OTHERS), values, strict=True):
            if field is not None:
                np.save(os.path.join(folder, f"{name}.npy"), field.reshape(field.shape[0], -1))
        with open(os.path.join(folder, "report.json"), "w", encoding="utf-8") as file:
            json.dump(self.report, file, indent=2, ensure_ascii=False)

    def to_xarray(self) -> Dataset:
        """The fields over the coordinates of the nodes, with the numbers of the report as attributes; needs xarray.

        Returns
        -------
        xarray.Dataset
        """
        xarray = package("xarray", "to_xarray needs xarray: python -m pip install xarray")
        dims = ("x", "y")[: self.gap.ndim]
        coords = {
            dim: np.arange(nodes) * (side / nodes) for dim, nodes, side in zip(dims, self.gap.shape, self.lengths)
        }
        fields = {"gap": self.gap, "pressure": self.pressure, "contact_pressure": self.contact_pressure}
        heights = {} if self._topography is None else {"heights": self.heights}
        data = {name: (dims, field) for name, field in {**fields, **heights}.items()}
        numbers = {k: v for k, v in self.report.items() if isinstance(v, int | float | str)}
        found: Dataset = xarray.Dataset(data, coords, numbers)
        return found

    @property
    def heights(self) -> NDArray[np.float64]:
        """Heights of the surface as it was made; between two surfaces their sum, the second as it faces the first."""
        return self.part_of(self.topography.heights)

    @property
    def _flattened(self) -> NDArray[np.floating[Any]]:
        """Heights of the surface as it is now."""
        return self.heights if self.plastic_depth is None else self.heights - self.plastic_depth

    @property
    def lengths(self) -> tuple[float, float]:
        """Side lengths (Lx, Ly)."""
        lx, ly = self._told["lengths"]
        return (lx, ly)

    def _check_units(self, name: str, value: Any, is_si: bool) -> str | None:
        """The unit of lengths, without which a solution refuses a quantity with a unit."""
        unit = self._told["length_unit"]
        if unit is None and is_si:
            raise ValueError(
                f"{name} is {value} in SI units, but the lengths of the solution have no unit: give a number in the units of "
                "the solution"
            )
        return unit

    @cached_property
    def _displacements(self) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        found = None if self._displace is None else self._displace()
        return None if found is None else (self.part_of(found[0]), self.part_of(found[1]))

    @property
    def displacement(self) -> NDArray[np.floating[Any]]:
        """Displacement of the body that is pressed: u = g + h, h less the plastic depth, if the other body is rigid.

        If both are elastic, ``displacement + against_displacement`` is g + h up to a constant. Each of the two is û =
        p̂/k for each wave, with the stiffness k of its own body. With a free boundary they vanish far away. With a
        periodic one their mean is zero, or the compression of a layer or a coating as a whole.
        """
        return self.gap + self._flattened if self._displacements is None else self._displacements[0]

    @property
    def against_displacement(self) -> NDArray[np.float64] | None:
        """Displacement of the body on the other side, positive away from the contact; None if it is rigid."""
        return None if self._displacements is None else self._displacements[1]

    @property
    def converged(self) -> bool:
        """Whether the tolerance was met, on the very fields that are here."""
        return self.status == "converged"

    def __repr__(self) -> str:
        width = max(len(name) for name, _ in self._rows)
        return "\n".join(f"{name:<{width}}  {value}" for name, value in self._rows)

    def _repr_html_(self) -> str:
        contact = self.contact.reshape(self.contact.shape[0], -1)
        return figures.html(self._rows, _asperity.contact_picture(contact, self.lengths, self._told["length_unit"]))

    def plot(
        self,
        ax: Any = None,
        *,
        length_unit: str | None = None,
        pressure_unit: str | None = None,
        colour_limits: tuple[float, float] | None = None,
        colour_clusters: bool = False,
    ) -> Any:
        """Draws contact and pressure side by side, as the tool draws them; needs matplotlib.

        With adhesion, compression and tension have a scale each. A scale ends where most of the load is carried: where
        a few nodes press far harder, its bar has an arrow, and says how much of the load stands on them. A line has its
        profile and its pressure, one above the other.

        Parameters
        ----------
        ax : sequence of two matplotlib Axes, optional
            Axes to draw on; new ones by default.
        length_unit, pressure_unit : str, optional
            Units for the axes and the scales, into which numbers are converted where the solve has units; others stay
            as they are. ``"m"`` and ``"Pa"`` get prefixes.
        colour_limits : (float, float), optional
            Pressures at the ends of the scales, in the units of the result, for figures that are to be compared: the
            largest tension, zero or negative, and the largest compression.
        colour_clusters : bool
            Each cluster of contact gets a colour of its own, nine in turn, the largest clusters first.

        Returns
        -------
        ndarray of two matplotlib Axes
            ``ax[0].figure.savefig`` writes the figure as PDF or SVG.
        """
        # without adhesion the elastic pressure is the contact pressure but for the tolerance of the solve, of either sign
        adhesive = self.report["law"] != "none"
        pressure = np.asarray(self.pressure if adhesive else self.contact_pressure, dtype=float)
        length = figures.axis_unit("length_unit", self.report["length_unit"], length_unit)
        units = length, figures.axis_unit("pressure_unit", self.report["pressure_unit"], pressure_unit)
        figures.check_limits(colour_limits)
        if self.gap.ndim == 1:
            sides = (self._flattened, self.displacement)
            return figures.profiles(sides, pressure, self.lengths[0], *units, ax)
        title, names = f"contact {100 * self.contact_fraction:.3g} %", figures.CLASSES
        if colour_clusters:
            sizes, classes = _asperity.clusters(self.contact, self.flow_boundary == "periodic")
            title, names = f"{title}, {len(sizes)} cluster{'' if len(sizes) == 1 else 's'}", ()
        else:
            # absent nodes have no gap
            attractive = round(self.statistics.attractive_fraction * np.count_nonzero(np.isfinite(self.gap)))
            classes = figures.classes(self.contact, self.pressure, self.plastic_depth, attractive)
        ax = left, right = figures.two(ax, ncols=2, figsize=(8.2, 3.8), sharey=True, layout="compressed")
        figures.contact(left, classes, names, self.lengths, length)
        figures.pressure(right, pressure, self.lengths, adhesive, colour_limits, *units)
        left.set_title(title)
        right.set_ylabel("")
        return ax


#: A start as functions take it.
Start: TypeAlias = ArrayLike | Solution | Literal["apart"] | None
