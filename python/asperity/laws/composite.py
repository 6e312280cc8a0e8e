"""Adhesion laws that are made of another law: one that ends, and one that varies from node to node."""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _asperity
from ..common.types import AxisOrder, Quantity
from ..maps.arrays import read_array
from .law import ParameterLaw


class CutOff(ParameterLaw):
    """A law that ends at a gap, smoothly: zero from there on, with energy, traction and slope continuous.

    It keeps its work of adhesion, its equilibrium separation, and its traction in contact; the energy that the tail had
    is given back before the end.

    Parameters
    ----------
    law : Law or an object of your own
        Law that reaches further.
    distance : float
        Gap at which it ends, a length: at least a range of the law beyond contact, or beyond its equilibrium
        separation.

    Examples
    --------
    >>> import asperity
    >>> law = asperity.CutOff(asperity.VanDerWaals(hamaker=6e-20, range=0.165e-9), distance=5e-9)
    >>> law.traction(5e-9)
    0.0
    """

    __module__ = "asperity"
    __match_args__ = ("law", "distance")

    def __new__(cls, law: Any, distance: Quantity) -> CutOff:
        cut, end = _asperity.cut_off(law, distance)
        return cls._from(cut, (law, end))

    @property
    def law(self) -> Any:
        """Law that reaches further."""
        return self._values[0]

    @property
    def distance(self) -> float:
        """Gap at which the law ends, a length."""
        return float(self._values[1])


class Varying(ParameterLaw):
    """A law with a work of adhesion that differs from node to node: energy, traction and slope in proportion to it.

    Parameters
    ----------
    law : Law or an object of your own
        Law that varies; its own work of adhesion > 0 is replaced.
    work_of_adhesion : array_like, shape (Nx, Ny) or (N,)
        Works of adhesion ≥ 0 at the nodes of the heights, energies per area; x along the first axis, unless ``axes`` or
        the dimensions of a DataArray say otherwise.
    axes : {"xy", "yx"}, optional
        Order of the axes of an array; "yx" for images. Heights with y along their first axis ask for it.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wetted = np.where(np.arange(64)[:, None] < 32, 0.07, 0.02) * np.ones((64, 64))
    >>> law = asperity.Varying(asperity.Exponential(work_of_adhesion=0.07, range=2e-9), wetted)
    >>> law.energy(0.0)[[0, 63], 0]
    array([-0.07, -0.02])
    """

    __module__ = "asperity"
    __match_args__ = ("law", "work_of_adhesion")

    #: whether it is known which axis is x
    knows_axes: bool

    def __new__(cls, law: Any, work_of_adhesion: ArrayLike, axes: AxisOrder | None = None) -> Varying:
        works, is_line = read_array(work_of_adhesion, "works of adhesion", axes)
        own = cls._from(_asperity.varied(law, works), (law, (works[:, 0] if is_line else works).copy()))
        own.knows_axes = axes is not None or hasattr(work_of_adhesion, "dims") or is_line
        return own

    @property
    def law(self) -> Any:
        """Law that varies."""
        return self._values[0]

    @property
    def work_of_adhesion(self) -> NDArray[np.float64]:
        """Works of adhesion at the nodes, shape (Nx, Ny) or (N,), energies per area."""
        return cast("NDArray[np.float64]", self._values[1])

    def __getnewargs__(self) -> tuple[Any, ...]:
        return (*super().__getnewargs__(), "xy" if self.knows_axes else None)
