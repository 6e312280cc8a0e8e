"""The contact map: clusters of nodes that hang together, and the contact in tables."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _asperity
from .answers.findings import ContactStatistics
from .answers.solution import Solution
from .common.summary import summary
from .maps.arrays import read_field

__all__ = ["Clusters", "ContactStatistics", "ContactTables", "Density", "clusters", "tables"]


def __dir__() -> list[str]:
    """The names that are meant, and no modules that are used here."""
    return __all__


class Clusters(NamedTuple):
    """The pieces of a periodic map that hang together.

    Attributes
    ----------
    sizes : ndarray of int64
        Number of nodes of each cluster, the largest first.
    labels : ndarray of int64
        Number of the cluster of each node, from 1 on; 0 for none.
    """

    sizes: NDArray[np.int64]
    labels: NDArray[np.int64]

    def __repr__(self) -> str:
        return summary(self)


def clusters(contact: Any) -> Clusters:
    """Finds the clusters of a map with opposite sides that meet.

    Parameters
    ----------
    contact : array_like of bool, shape (Nx, Ny)
        Contact map, as a `Solution` has it.

    Returns
    -------
    Clusters

    Examples
    --------
    >>> from asperity import contact
    >>> contact.clusters([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 0, 0]]).sizes
    array([2, 1])
    """
    given = np.asarray(contact)
    if given.ndim not in (1, 2):
        raise ValueError(f"contact has shape {given.shape}: it must be (Nx, Ny), or (N,) on a line")
    sizes, labels = _asperity.clusters(given.astype(bool).reshape(given.shape[0], -1), True)
    return Clusters(sizes, labels.reshape(given.shape))


class Density(NamedTuple):
    """Probability density of a gap or a pressure over the nodes, in bins that are equally wide in its logarithm.

    Attributes
    ----------
    density : ndarray
        Share of the nodes in each bin over its width.
    edges : ndarray
        Edges of the bins: one more than there are bins.
    exponent : dict or None
        Power as which the density grows near the edge of the contact: ``exponent``, the window ``from`` and ``to``, and
        the ``nodes`` in it. At a hard wall without adhesion it is −1/3 for the gap and 1 for the contact pressure. None
        where the nodes do not reach that near.
    """

    density: NDArray[np.float64]
    edges: NDArray[np.float64]
    exponent: dict[str, Any] | None

    def __repr__(self) -> str:
        return summary(self)


class ContactTables(NamedTuple):
    """The contact of a solution in tables.

    Attributes
    ----------
    gap, pressure : Density
        Distributions of the gap, where it is open, and of the contact pressure, where there is one.
    autocorrelation : ndarray, shape (n, 2)
        Distance, and the autocorrelation of the contact pressure about its mean over its variance, averaged over
        directions; empty where opposite sides do not meet.
    clusters : ndarray, shape (n, 4)
        Nodes, area, perimeter and force of each cluster of contact, the largest first.
    figures : dict
        Numbers of the tables, with the keys of ``asperity contact --json``.
    """

    gap: Density
    pressure: Density
    autocorrelation: NDArray[np.float64]
    clusters: NDArray[np.float64]
    figures: dict[str, Any]

    def __repr__(self) -> str:
        return summary(self)


def tables(solution: Solution) -> ContactTables:
    """Tabulates the contact of a solution, as ``asperity contact`` does.

    Parameters
    ----------
    solution : Solution

    Returns
    -------
    ContactTables

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(128, 1.0, rms_slope=0.1, k_s=16, seed=1)
    >>> solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    >>> found = asperity.contact.tables(solution)
    >>> bool(abs(found.clusters[:, 3].sum() / 0.01 - 1) < 1e-5)  # the clusters carry the load
    True
    """
    gap, pressure = read_field(solution.gap, "gaps"), read_field(solution.contact_pressure, "pressures")
    boundary = "original" if solution.report["part"] == "original" else solution.boundary
    found = _asperity.contact_tables(gap, pressure, solution.lengths, boundary)
    figures = found["figures"]
    densities = [Density(*(*found[name], figures[f"{name}_exponent"])) for name in ("gap", "pressure")]
    return ContactTables(densities[0], densities[1], found["autocorrelation"], found["clusters"], figures)
