"""Numbers that follow from a solution, or come with it."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..common.summary import summary


class ContactStatistics(NamedTuple):
    """Contact area and clusters, and the area that attracts without contact; fractions of nodes not absent.

    With a periodic boundary opposite sides meet.

    Attributes
    ----------
    contact_nodes : int
        Number of nodes in contact.
    contact_fraction : float
        Share of the nodes in contact.
    corrected_contact_fraction : float
        Contact area within the contact edge, which gap and contact pressure locate between the nodes; NaN where a
        surface has yielded, for which they cannot.
    perimeter : float
        Length of the edge of the contact along the sides of the cells.
    cluster_sizes : ndarray of int64
        Numbers of nodes of the clusters of contact, the largest first.
    repulsive_fraction, attractive_fraction, apart_fraction : float
        Shares of the nodes with a contact pressure, with a noticeable attraction but no contact, and of the others.
    """

    contact_nodes: int
    contact_fraction: float
    corrected_contact_fraction: float
    perimeter: float
    cluster_sizes: NDArray[np.int64]
    repulsive_fraction: float
    attractive_fraction: float
    apart_fraction: float

    def __repr__(self) -> str:
        return summary(self)


class PressureDistribution(NamedTuple):
    """The distribution of the contact pressure over the nodes: a histogram, as a probability density.

    Attributes
    ----------
    density : ndarray
        Share of the nodes in each bin over its width, per unit of pressure. Its integral is the contact fraction.
    edges : ndarray
        Edges of the bins, from zero to the largest contact pressure: one more than there are bins. Where a few
        pressures, as on spikes, are far above all others, the last bin is wider than the others and has these.
    """

    density: NDArray[np.float64]
    edges: NDArray[np.float64]

    def __repr__(self) -> str:
        return summary(self)


class Constriction(NamedTuple):
    """The narrowest place of the widest passage through a gap.

    Attributes
    ----------
    gap : float
        Gap there: every way through has one of at most this somewhere.
    node : (int, int)
        Its node.
    path : ndarray of int64, shape (N, 2)
        Nodes of the shortest passage that is nowhere narrower, from neighbour to neighbour.
    """

    gap: float
    node: tuple[int, int]
    path: NDArray[np.int64]

    def __repr__(self) -> str:
        return summary(self)


class Percolation(NamedTuple):
    """Whether a gap is open from side to side, or around a periodic cell.

    Attributes
    ----------
    x, y : Constriction or None
        Constriction along x and along y; None where the gap is closed.
    """

    x: Constriction | None
    y: Constriction | None

    def __repr__(self) -> str:
        return summary(self)


class Conductance(NamedTuple):
    """Conductance of a contact, for electric current or for heat.

    Attributes
    ----------
    per_area : float
        Conductance over the area of the map.
    whole : float
        Conductance 1/R of the whole map.
    relative_error : float or None
        Relative error, including the estimated error of the grid; None where nested grids do not give it.
    """

    per_area: float
    whole: float
    relative_error: float | None


class Stability(NamedTuple):
    """Stability of an equilibrium; eigenvalues are pressures per length.

    Attributes
    ----------
    verdict : str
        ``"stable"``, ``"unstable"`` or ``"undecided"``.
    eigenvalue : float
        Rayleigh quotient of the mode: no smaller than the smallest eigenvalue.
    residual : float
        Norm of the residual of the mode: some eigenvalue is within this distance.
    lower_bound : float
        Lower bound of the smallest eigenvalue.
    error_bound : float or None
        With a positive lower bound, bound of the relative error of the solution in the energy norm.
    smoothed : bool
        Whether jumps of the law were smoothed: then all this is about the smoothed law.
    operator_applications : int
        Number of operator applications.
    mode : ndarray
        Change of the gap along which the energy is softest, of the shape of the heights and of mean square 1.
    """

    verdict: str
    eigenvalue: float
    residual: float
    lower_bound: float
    error_bound: float | None
    smoothed: bool
    operator_applications: int
    mode: NDArray[np.floating[Any]]

    def __repr__(self) -> str:
        return summary(self)


class Plan(NamedTuple):
    """The cost of a solve to an accuracy, as an estimate from other surfaces.

    Attributes
    ----------
    nodes_per_wave : float
        Nodes along a side that the shortest wave of the heights has; infinite for flat ones.
    tolerance : float
        Certified relative error at which the solver stops.
    shape : (int, int)
        Shape of the grid that is likely to be fine enough.
    bytes : float
        Memory that it takes.
    seconds : float
        Time that it takes, estimated by an operator application on the grid of the heights.
    """

    nodes_per_wave: float
    tolerance: float
    shape: tuple[int, int]
    bytes: float
    seconds: float
