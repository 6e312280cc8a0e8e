"""The height map: heights with their side lengths and unit, from arrays, files and the objects of other packages."""

from __future__ import annotations

import os
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _asperity
from ..plot import figures
from .arrays import read_array, side_lengths

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, repr=False)
class Topography:
    """A map of heights with its side lengths, its unit and its source.

    Every function that takes heights takes a ``Topography`` too, and needs no ``lengths`` then.

    Parameters
    ----------
    heights : array_like, shape (Nx, Ny) or (N,)
        Heights, x along the first axis, peaks up; as an attribute of shape (Nx, Ny), (N, 1) on a line. NaN is a missing
        point. An array of float64 is not copied: do not change it afterwards.
    lengths : (float, float), optional
        Side lengths (Lx, Ly) = (Nx Δx, Ny Δy), in the unit of the heights; Lx alone for square cells.
    unit : str, optional
        Unit of heights and side lengths.
    periodic : bool, optional
        Whether opposite edges meet, if that is known.
    source : str, optional
        File that the heights come from.
    original : (int, int), optional
        Nodes of the original, from the first on, if the others are its mirror images.
    seed : int, optional
        Seed of the random surface that the map was made from.
    scars_removed : float, optional
        Threshold of the scars that `prepare` removed, if it did.
    log : tuple of str
        Steps that `prepare` took to make the map, each with its effect in numbers.

    Examples
    --------
    >>> import asperity
    >>> asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=16)
    Topography(64 x 64 heights, 1 x 1)
    """

    heights: NDArray[np.float64]
    lengths: tuple[float, float] | None = None
    unit: str | None = None
    periodic: bool | None = None
    source: str | None = None
    original: tuple[int, int] | None = None
    seed: int | None = None
    log: tuple[str, ...] = ()
    scars_removed: float | None = None
    _unread: tuple[str, ...] = ()
    _is_line: bool = field(default=False, compare=False)

    def __post_init__(self) -> None:
        heights, is_line = read_array(self.heights)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "_is_line", self._is_line or is_line)
        if self.lengths is not None:
            object.__setattr__(self, "lengths", side_lengths(self.lengths, self.heights.shape))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the heights, as they were given."""
        return (self.heights.shape[0],) if self._is_line else self.heights.shape

    @property
    def missing(self) -> int:
        """Number of missing points: NaN or infinite."""
        return int(self.heights.size - np.count_nonzero(np.isfinite(self.heights)))

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        heights = self.heights.reshape(self.shape)
        if dtype is not None and heights.dtype != dtype:
            return heights.astype(dtype)
        return heights.copy() if copy else heights

    def __repr__(self) -> str:
        parts = [" x ".join(map(str, self.shape)) + " heights"]
        if self.missing:
            parts.append(f"{self.missing} missing")
        if self.original is not None:
            parts.append("mirror images of " + " x ".join(map(str, self.original[: len(self.shape)])))
        if self.lengths is None:
            parts.append("unknown side lengths")
        else:
            parts.append(" x ".join(_asperity.shown(length, self.unit) for length in self.lengths))
        return f"Topography({', '.join(parts)})"

    def __add__(self, other: Topography | ArrayLike) -> Topography:
        """The map with heights added to its own; of another map they have the same unit and side lengths."""
        if isinstance(other, Topography) and (other.lengths, other.unit) != (self.lengths, self.unit):
            raise ValueError(f"maps differ in their sides or units, {self!r} and {other!r}: prepare one as the other")
        heights = np.asarray(other)
        if heights.shape not in ((), self.shape):
            raise ValueError(f"heights of shape {heights.shape} are added to those of {self.shape}: give equal shapes")
        added = self.heights + (heights if heights.ndim == 0 else heights.reshape(self.heights.shape))
        return replace(self, heights=added, original=None, seed=None, source=None, log=(*self.log, "add: heights added"))

    def save(self, path: str | os.PathLike[str], *, force: bool = False) -> None:
        """Writes the map for the program: ``.npz`` with all that it has, ``.gsf``, or ``.npy`` with heights alone.

        Parameters
        ----------
        path : str or path
            File; its ending decides on the format.
        force : bool
            Replaces a file that is there.
        """
        _asperity.write(self, os.path.abspath(path), force)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draws the heights; needs matplotlib.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; new ones by default.

        Returns
        -------
        matplotlib Axes
        """
        lengths = self.lengths or (float(self.heights.shape[0]), float(self.heights.shape[1]))
        return figures.heights(np.asarray(self), lengths, (1.0, self.unit), ax)


def in_metres(topography: Topography) -> Topography:
    """The map in metres, in which one without a unit is already."""
    if topography.unit in (None, "m"):
        return replace(topography, unit="m")
    return replace(topography, **_asperity.in_metres(topography))


def require_lengths(topography: Topography) -> tuple[float, float]:
    """The side lengths of a map that needs them."""
    if topography.lengths is None:
        raise ValueError("side lengths are unknown: give lengths=(Lx, Ly), in the unit of the heights")
    return topography.lengths


def refine(topography: Topography, heights: NDArray[np.float64]) -> Topography:
    """The map on a finer grid."""
    if topography.original is None:
        return replace(topography, heights=heights)
    shapes = zip(topography.original, topography.heights.shape, heights.shape)
    nx, ny = (-(-nodes * now // before) for nodes, before, now in shapes)
    return replace(topography, heights=heights, original=(nx, ny))
