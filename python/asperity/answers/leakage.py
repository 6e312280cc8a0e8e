"""Percolation and leakage of the gap, and conductance of the contact, after a solve."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _asperity
from ..common.summary import summary
from ..common.types import Boundary, Lengths, Quantity
from ..common.units import in_si, number
from ..common.warnings import ConvergenceWarning, warn
from ..common.words import suggests
from ..maps.arrays import read_field
from ..maps.heights import Heights, convert_heights
from ..maps.topography import Topography
from .findings import Constriction
from .solution import Solution


class Flow(NamedTuple):
    """Flow along one axis.

    Attributes
    ----------
    lower, upper : float
        Bounds of the transmissivity Qη/Δp, a length cubed. Q is the flow, a volume per time, Δp is the difference of
        pressure between the two sides, and η is the viscosity. A slot of width g in a square cell has g³/12. Both
        bounds are zero where the gap is closed.
    grid_error : float or None
        Estimated relative error of the grid: the largest difference from the transmissivity of every second node, the
        even ones alone or the odd ones. Where the grid resolves the gap this is about three times the error. It is not
        a bound. None where there is no passage, and where a side has an odd number of nodes.
    reached : bool
        Whether the distance of the bounds is within the tolerance.
    constriction : Constriction or None
        Narrowest place of the widest passage. None where the gap is closed.
    pressure : ndarray
        Pressure of the fluid over Δp, at the nodes through which it flows. NaN at the others.
    flow : ndarray, shape (2, Nx, Ny)
        Flow per width along x and along y at the nodes, times η/Δp: a length squared.
    """

    lower: float
    upper: float
    grid_error: float | None
    reached: bool
    constriction: Constriction | None
    pressure: NDArray[np.float64]
    flow: NDArray[np.float64]

    def __repr__(self) -> str:
        return summary(self)


class Leakage(NamedTuple):
    """Leakage through a gap.

    Attributes
    ----------
    x, y : Flow
        Flow along x and along y.
    report : dict
        Report with the keys of ``asperity leak --json``.
    unit : str or None
        Unit of length.
    """

    x: Flow
    y: Flow
    report: dict[str, Any]
    unit: str | None = None

    def __repr__(self) -> str:
        lines = []
        for axis, flow in (("x", self.x), ("y", self.y)):
            ends = (_asperity.shown(end, None if self.unit is None else f"{self.unit}³") for end in (flow.lower, flow.upper))
            grid = "" if flow.grid_error is None else f", error of the grid {100 * flow.grid_error:.2g} %"
            lines.append(f"along {axis}  transmissivity {' to '.join(ends)}{grid}")
        return "\n".join(lines)


@suggests
def leakage(
    gap: Solution | Heights,
    lengths: Lengths | None = None,
    *,
    boundary: Boundary | None = None,
    absent_gap: Quantity | None = None,
    viscosity: Quantity | None = None,
    tolerance: float = 1e-6,
    max_iterations: int = 1000,
) -> Leakage:
    """Transmissivity of a gap by Reynolds' equation, between two bounds.

    The nodes are a network of channels. Any field of pressures gives an upper bound of its transmissivity, and any
    conserved flow a lower one. Both bounds hold at every tolerance. The transmissivity is zero along an axis where the
    gap is closed.

    Parameters
    ----------
    gap : Solution, array_like, Topography, SurfaceTopography, DataArray, DataFrame or path of a file
        Solution, or gaps, shape (Nx, Ny). The gap is open at nodes where it is positive, and a node is absent where it
        is not finite. Gaps with negative values are refused, as heights are.
    lengths : float or (float, float), optional
        Side lengths; Lx alone means square cells. By default the side lengths of the gaps, or 1 by 1 if they bring
        none. A solution has its own.
    boundary : {"periodic", "free"}, optional
        What is beyond the map. With a free boundary the fluid enters along one side and leaves along the opposite one,
        and the two other sides are tight. By default the boundary of the solution, and periodic for an array.
        The original of a mirrored map has a free boundary, by which it leaks as the whole map does.
    absent_gap : float or str, optional
        Gap of absent nodes. They are closed by default.
    viscosity : float or str, optional
        Dynamic viscosity, for example "1mPas". The report then has ``flow_per_pressure``. With units all results are in
        SI units, and the gaps are converted to metres.
    tolerance : float
        Distance of the bounds, relative to the upper one, at which the iteration ends.
    max_iterations : int
        Greatest number of iterations along each axis.

    Returns
    -------
    Leakage
        Flow along both axes. A `ConvergenceWarning` is given where the bounds are further apart than the tolerance.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> x = 2 * np.pi * np.arange(64) / 64
    >>> wave = 1 + 0.5 * np.cos(x)[:, None] * np.ones(64)
    >>> found = asperity.leakage(wave)
    >>> round(12 * found.y.upper, 5), round(12 * found.x.upper, 5)  # 1 + 3ε²/2, and 2(1 − ε²)^(5/2)/(2 + ε²)
    (1.375, 0.43301)
    >>> found.y.grid_error < 1e-3
    True
    """
    lengths, absent_gap, viscosity, is_si = in_si(lengths=lengths, absent_gap=absent_gap, viscosity=viscosity)
    absent = None if absent_gap is None else number("absent_gap", absent_gap)
    viscous = None if viscosity is None else number("viscosity", viscosity)
    solved = isinstance(gap, Solution)
    own: Boundary = "periodic"
    if isinstance(gap, Solution):
        if lengths is not None:
            raise ValueError("the solution has its side lengths: leave lengths out")
        name, value = ("absent_gap", absent) if viscous is None else ("viscosity", viscous)
        unit, own = gap._check_units(name, value, is_si), gap.flow_boundary
        gap = Topography(read_field(gap.gap, "gaps"), gap.lengths, unit)
    topography = convert_heights(gap, lengths, is_si=is_si, name="gaps")
    field, sides = topography.heights, topography.lengths or (1.0, 1.0)
    found = _asperity.leakage(field, solved, sides, boundary or own, absent, viscous, tolerance, max_iterations)
    if found["shortfall"] is not None:
        warn(found["shortfall"], ConvergenceWarning)
    report = found["report"]
    flows = [_flow(report["transmissivity"][axis], *found[axis]) for axis in ("x", "y")]
    return Leakage(flows[0], flows[1], report, topography.unit)


def _flow(bounds: dict[str, Any], fields: tuple[Any, Any, Any], narrowest: tuple[Any, Any, Any] | None) -> Flow:
    pressure, x, y = fields
    constriction = None if narrowest is None else Constriction(*narrowest)
    lower, upper, grid_error, reached = (bounds[key] for key in ("lower", "upper", "grid_error", "reached"))
    return Flow(lower, upper, grid_error, reached, constriction, pressure, np.stack((x, y)))
