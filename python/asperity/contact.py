"""The contact map: clusters of nodes that hang together."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _asperity
from ._solution import ContactStatistics

__all__ = ["Clusters", "ContactStatistics", "clusters"]


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


def clusters(contact: Any) -> Clusters:
    """Finds the clusters of a map whose opposite sides meet.

    Parameters
    ----------
    contact : array_like of bool, shape (Nx, Ny)
        Contact map, as that of a `Solution`.

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
