"""What follows a solve: percolation and leakage of the gap, and conductance of the contact."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _asperity
from ._control import number
from ._solution import Conductance, Constriction, Percolation, Solution
from ._topography import _lengths, field_of
from ._types import Boundary, Lengths, Quantity
from ._warnings import ConvergenceWarning, warn

__all__ = ["Conductance", "Constriction", "Flow", "Leakage", "Percolation", "leakage"]


class Flow(NamedTuple):
    """Flow along one axis.

    Attributes
    ----------
    lower, upper : float
        Bounds of the transmissivity Qη/Δp, a length cubed: the flow Q, a volume per time, over the pressure Δp that falls
        from side to side, times the viscosity η; g³/12 for a slot of a square cell. Zero where the gap is closed.
    grid_error : float or None
        Estimated relative error of the grid: the largest difference from the transmissivity on the even nodes alone,
        and on the odd ones. Three times the error where the gap is resolved, and no bound. None without a passage, and
        where a side has an odd number of nodes.
    reached : bool
        Whether the bounds are as close as the tolerance.
    constriction : Constriction or None
        Narrowest place of the widest passage; None where the gap is closed.
    pressure : ndarray
        Pressure over Δp at the nodes through which the fluid flows; NaN elsewhere.
    flow : ndarray, shape (2, Nx, Ny)
        Flow at the nodes along x and along y, per width, times η/Δp: a length squared.
    """

    lower: float
    upper: float
    grid_error: float | None
    reached: bool
    constriction: Constriction | None
    pressure: NDArray[np.float64]
    flow: NDArray[np.float64]


class Leakage(NamedTuple):
    """Leakage through a gap.

    Attributes
    ----------
    x, y : Flow
        Flow along x and along y.
    report : dict
        Report with the keys of the program's, ``asperity leak --json``.
    """

    x: Flow
    y: Flow
    report: dict[str, Any]


def leakage(
    gap: Solution | ArrayLike,
    lengths: Lengths | None = None,
    *,
    boundary: Boundary | None = None,
    absent_gap: Quantity | None = None,
    viscosity: Quantity | None = None,
    tolerance: float = 1e-6,
    max_iterations: int = 1000,
) -> Leakage:
    """Finds what leaks through a gap by Reynolds' equation, between two bounds.

    The transmissivity of the network of the nodes is no more than any pressure says, and no less than any flow that is
    conserved says; both bounds hold whatever the tolerance. A gap that is closed along an axis has none.

    Parameters
    ----------
    gap : Solution or array_like, shape (Nx, Ny)
        Solution, or gaps: open where they are positive. Nodes that are not finite are absent.
    lengths : float or (float, float), optional
        Side lengths, Lx alone for square cells; of a solution they are known, and otherwise 1 by 1 by default.
    boundary : {"periodic", "free"}, optional
        What is beyond the map. Of a free one each axis is fed at one side and drained at the other, and the two other sides
        are tight. By default that of the solution, or periodic; of the original of a mirrored map free, which is the same.
    absent_gap : float or str, optional
        Gap of absent nodes, which are closed without it.
    viscosity : float or str, optional
        Dynamic viscosity, as "1mPas", for ``report["flow_per_pressure"]``.
    tolerance : float
        Distance of the bounds at which to stop, relative to the upper one.
    max_iterations : int
        The most iterations along each axis.

    Returns
    -------
    Leakage
        Also where the bounds are further apart than the tolerance: then with a `ConvergenceWarning`.

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
    if isinstance(gap, Solution):
        if lengths is not None:
            raise ValueError("the solution has its side lengths: leave lengths out")
        values: ArrayLike = gap.gap
        sides, own = gap.lengths, gap.flow_boundary
    else:
        values, own = gap, "periodic"
        shape = np.shape(gap)
        sides = (1.0, 1.0) if lengths is None else _lengths(lengths, shape if len(shape) == 2 else (*shape, 1))
    field = field_of(values, "gaps")
    absent = None if absent_gap is None else number("absent_gap", absent_gap)
    viscous = None if viscosity is None else number("viscosity", viscosity)
    found = _asperity.leakage(field, sides, boundary or own, absent, viscous, tolerance, max_iterations)
    if found["shortfall"] is not None:
        warn(found["shortfall"], ConvergenceWarning)
    report = found["report"]
    flows = [_flow(report["transmissivity"][axis], *found[axis]) for axis in ("x", "y")]
    return Leakage(flows[0], flows[1], report)


def _flow(bounds: dict[str, Any], fields: tuple[Any, Any, Any], narrowest: tuple[Any, Any, Any] | None) -> Flow:
    pressure, x, y = fields
    constriction = None if narrowest is None else Constriction(*narrowest)
    lower, upper, grid_error, reached = (bounds[key] for key in ("lower", "upper", "grid_error", "reached"))
    return Flow(lower, upper, grid_error, reached, constriction, pressure, np.stack((x, y)))
