"""The height map: heights with their side lengths and unit, from arrays, files and the objects of other packages."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, TypeAlias, TypeGuard

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _asperity, _plot
from ._types import AxisOrder, HeightMap, Lengths
from ._units import given as units

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: The share of a spacing by which coordinates may differ from equidistant ones.
_EQUIDISTANT = 1e-3


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
    _is_line: bool = field(default=False, compare=False)

    def __post_init__(self) -> None:
        heights, is_line = array_of(self.heights)
        object.__setattr__(self, "heights", heights)
        object.__setattr__(self, "_is_line", self._is_line or is_line)
        if self.lengths is not None:
            object.__setattr__(self, "lengths", _lengths(self.lengths, self.heights.shape))

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
        return _plot.heights(np.asarray(self), lengths, (1.0, self.unit), ax)


#: A map as functions take it.
Heights: TypeAlias = ArrayLike | Topography | HeightMap | str | os.PathLike[str]


def read(
    path: str | os.PathLike[str],
    channel: int | str | None = None,
    *,
    skip_lines: int = 0,
    missing_words: str | Sequence[str] = (),
    masked: bool = False,
) -> Topography:
    """Reads a file of heights.

    Files of instruments are read by SurfaceTopography, which ``pip install 'asperity[instruments]'`` brings: Nanoscope,
    JPK, NT-MDT, Igor, Park, ISO 25178-72 (.x3p), Digital Surf, Keyence, Zygo, Wyko, Sensofar, Alicona, NetCDF, HDF5 and
    others. Only asperity reads text files.

    Parameters
    ----------
    path : str or path
        ``.npy``, ``.npz``, Gwyddion's ``.gwy``, ``.gsf`` or text, ``.xyz``, or a plain text matrix; the content decides.
        Or the file of an instrument, with that package.
    channel : int or str, optional
        Channel of a ``.gwy`` file, of a text file with several blocks of numbers, or of the file of an instrument, by
        number or title; needed only if several have heights.
    skip_lines : int
        Number of lines to skip at the start of a text file, such as a heading.
    missing_words : str or list of str
        Words of a text file that stand for missing points, besides nan, NA, Bad, #N/A and the like.
    masked : bool
        Whether the points under the mask of a ``.gwy`` file are missing.

    Returns
    -------
    Topography
        In metres where the file has a unit of length; missing points are NaN. The first line of an image is that of the
        largest y. The ``log`` names what else the file contains: other channels, a mask, and lines that may give a size
        but are not understood.

    Raises
    ------
    FileNotFoundError, ValueError
        If there is no such file or channel, or it cannot be understood.

    Examples
    --------
    >>> import asperity, numpy, os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "scan.npz")
    ...     numpy.savez(path, heights=numpy.eye(3), lengths=(2.0, 2.0), unit="m")
    ...     asperity.read(path)
    Topography(3 x 3 heights, 2 m x 2 m)
    """
    source = os.fspath(path)
    try:
        words = [missing_words] if isinstance(missing_words, str) else list(missing_words)
        of = None if channel is None else str(channel)
        made, beside = _asperity.read(source, of, skip_lines, words, masked)
    except ValueError as refused:
        from . import _instruments

        return _instruments.read(source, channel, refused)
    log = (f"also in the file: {', '.join(beside)}".replace("--masked", "masked=True"),) if beside else ()
    return Topography(**made, source=source, log=log)


def from_topography(topography: HeightMap) -> Topography:
    """Takes a map of SurfaceTopography, or anything else with its three properties.

    Parameters
    ----------
    topography : object
        With ``heights()``, an array of which masked points are missing, ``physical_sizes``, and ``is_periodic``;
        ``unit`` comes along where it is there.

    Returns
    -------
    Topography
    """
    if not _is_topography(topography):
        name = type(topography).__name__
        raise TypeError(f"topography is of type {name}: it must have heights() and physical_sizes")
    if not getattr(topography, "is_uniform", True):
        raise ValueError("topography is not on a uniform grid: interpolate it first, for example by its to_uniform()")
    heights, is_line = array_of(topography.heights())
    sizes = topography.physical_sizes
    lengths = None if sizes is None else _lengths(sizes[0] if is_line else tuple(sizes), heights.shape)
    periodic = getattr(topography, "is_periodic", None)
    return Topography(heights, lengths, getattr(topography, "unit", None), periodic, _is_line=is_line)


def plain(keys: dict[str, Any]) -> dict[str, Any]:
    """Keys with their values as the compiled core reads them: numbers, texts and lists, without those of numpy."""
    return {key: np.asarray(value).tolist() for key, value in keys.items() if value is not None}


def taken(
    heights: Heights, lengths: Any = None, axes: AxisOrder | None = None, si: bool | None = None, name: str = "heights"
) -> Topography:
    """The map of whatever holds heights, with the side lengths that are given for it; in metres with units."""
    topography = found(heights, axes, name)
    if units.get() if si is None else si:
        topography = _in_metres(topography)
    return topography if lengths is None else replace(topography, lengths=_lengths(lengths, topography.heights.shape))


def _in_metres(topography: Topography) -> Topography:
    """The map in metres, in which one without a unit is already."""
    if topography.unit in (None, "m"):
        return replace(topography, unit="m")
    return replace(topography, **_asperity.in_metres(topography))


def found(heights: Heights, axes: AxisOrder | None, name: str = "heights") -> Topography:
    """The map of whatever holds heights, in float64; the data are not copied where they are that already."""
    if axes is not None and knows_axes(heights):
        raise ValueError(f"axes is {axes!r}, but a file or a map knows its axes: leave it out, or give an array")
    if isinstance(heights, Topography):
        return heights
    if isinstance(heights, str | os.PathLike):
        return read(heights)
    if _is_topography(heights):
        return from_topography(heights)
    heights = _labelled(heights, axes, name)
    if _is_data_array(heights):
        return _from_data_array(heights, axes)
    array, is_line = array_of(heights, name, axes)
    return Topography(array, _is_line=is_line)


def knows_axes(heights: Heights) -> bool:
    """Whether heights are a map or a file, whose axes are known."""
    return isinstance(heights, Topography | str | os.PathLike) or _is_topography(heights)


def axes_of(heights: Heights, axes: AxisOrder | None) -> AxisOrder:
    """The order of the axes of heights: that of a map, of the names of dimensions, or the one that is given."""
    return "xy" if knows_axes(heights) else _order(_labelled(heights, axes), axes)


def sides(topography: Topography) -> tuple[float, float]:
    """The side lengths of a map that needs them."""
    if topography.lengths is None:
        raise ValueError("side lengths are unknown: give lengths=(Lx, Ly), in the unit of the heights")
    return topography.lengths


def mirrored(field: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """A field of the original of a mirrored map, continued by its mirror images to a shape."""
    return np.pad(field, [(0, nodes - own) for nodes, own in zip(shape, field.shape)], mode="symmetric")


def refined(topography: Topography, heights: NDArray[np.float64]) -> Topography:
    """The map on a finer grid."""
    if topography.original is None:
        return replace(topography, heights=heights)
    shapes = zip(topography.original, topography.heights.shape, heights.shape)
    nx, ny = (-(-nodes * now // before) for nodes, before, now in shapes)
    return replace(topography, heights=heights, original=(nx, ny))


def field_of(values: Any, name: str, axes: AxisOrder | None = None) -> NDArray[np.float64]:
    """A field as the compiled core takes it: two-dimensional, float64; dimensions with names are known without axes."""
    return array_of(values, name, None if _is_data_array(values) else axes)[0]


def array_of(values: Any, name: str = "heights", axes: AxisOrder | None = None) -> tuple[NDArray[np.float64], bool]:
    """Values as a matrix of float64 with x along its first axis, and whether they are one line.

    Masked points become NaN, and coordinates rise.
    """
    values = _labelled(values, axes, name)
    order = _order(values, axes)
    if _is_data_array(values):
        values = np.ma.masked_invalid(values.values[tuple(map(_rising, map(values.coords.get, values.dims)))])
    masked = isinstance(values, np.ma.MaskedArray)
    try:
        # pandas has numbers with a sign for missing ones
        is_frame = hasattr(values, "to_numpy") and not _is_data_array(values)
        array: Any = values if masked else values.to_numpy(float, na_value=np.nan) if is_frame else np.asarray(values)
    except (TypeError, ValueError) as error:
        raise TypeError(f"{name} are no array of real numbers: {error}") from None
    if array.dtype.names is not None:
        columns = ", ".join(array.dtype.names)
        raise TypeError(f'{name} are a record array of {columns}: give one column, such as a["{array.dtype.names[0]}"]')
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} are an array of {array.dtype}: they must be real numbers")
    if array.ndim == 3 and array.size > 0:
        channel = ("array[..., 0]", "array[:, 0]", "array[0]")[int(np.argmin(array.shape[::-1]))]
        raise ValueError(f"{name} have shape {array.shape}, as channels on each other: give one of them, as {channel}")
    if array.ndim not in (1, 2) or array.size == 0:
        raise ValueError(f"{name} have shape {array.shape}: they must be (Nx, Ny), or (N,) on a line")
    if masked:
        array = array.astype(np.float64).filled(np.nan)
    # the compiled core counts strides in items
    array = np.require(array, np.float64, ["ALIGNED"])
    if array.ndim == 1:
        return array[:, None], True
    return (array.T if order == "yx" else array), False


def _order(values: Any, axes: AxisOrder | None) -> AxisOrder:
    """The order of the axes of an array: that of the names of its dimensions, or the one that is given."""
    if axes not in (None, "xy", "yx"):
        raise ValueError(f"axes is {axes!r}: it must be 'xy', x along the first axis, or 'yx', as of an image")
    dims = [str(dim).lower() for dim in values.dims] if _is_data_array(values) else []
    if len(dims) != 2 or not {"x", "y"} & set(dims):
        return axes or "xy"
    named: AxisOrder = "yx" if dims[0] == "y" or dims[1] == "x" else "xy"
    if axes not in (None, named):
        raise ValueError(f"axes is {axes!r}, but the dimensions are {tuple(values.dims)}: leave axes out, or rename them")
    return named


def _rising(coordinate: Any) -> slice:
    """The part of an axis that is all of it, with its coordinate rising."""
    falls = coordinate is not None and coordinate.values.size > 1 and coordinate.values[-1] < coordinate.values[0]
    return slice(None, None, -1 if falls else None)


def _labelled(values: Any, axes: AxisOrder | None, name: str = "heights") -> Any:
    """A pandas.DataFrame with coordinates as a DataArray; all else as it is."""
    if hasattr(values, "data_vars"):
        raise TypeError(f"{name} are an xarray.Dataset: give one of its variables, {', '.join(values.data_vars)}")
    if not (hasattr(values, "to_numpy") and hasattr(values, "index") and hasattr(values, "columns")):
        return values
    names = {str(column).lower(): column for column in values.columns}
    if {"x", "y", "z"} <= set(names):
        x, y, z = (names[axis] for axis in "xyz")
        raise ValueError(f"{name} are a DataFrame of points: give frame.pivot(index={x!r}, columns={y!r}, values={z!r})")
    labels = [values.index, values.columns]
    known = [_are_coordinates(np.asarray(label)) for label in labels]
    if not any(known):
        return values
    if not all(known):
        has, lacks = ("index", "columns") if known[0] else ("columns", "index")
        raise ValueError(
            f"{name} are a DataFrame with coordinates as its {has} and none as its {lacks}: give both as numbers, by "
            f"frame.{lacks} = frame.{lacks}.astype(float), or the array alone, by frame.to_numpy()"
        )
    # without a unit in brackets
    dims = [re.split(r"\s*[\[(]", str(label.name))[0] for label in labels]
    if dims[0] == dims[1] or not {"x", "y"} & {dim.lower() for dim in dims}:
        dims = list(axes or "yx")
    coords = {dim: SimpleNamespace(values=label.to_numpy(), attrs={}) for dim, label in zip(dims, labels)}
    return SimpleNamespace(values=values.to_numpy(), dims=dims, coords=coords, attrs={})


def _are_coordinates(labels: NDArray[Any]) -> bool:
    """Whether labels are coordinates: numbers that do not just count rows or columns."""
    return labels.dtype.kind == "f" or (labels.dtype.kind in "iu" and bool(np.any(np.diff(labels) != 1)))


def _is_data_array(values: Any) -> bool:
    return hasattr(values, "dims") and hasattr(values, "coords")


def _is_topography(values: Any) -> TypeGuard[HeightMap]:
    return callable(getattr(values, "heights", None)) and hasattr(values, "physical_sizes")


def _lengths(lengths: Lengths, shape: tuple[int, ...]) -> tuple[float, float]:
    """Side lengths; one alone means square cells."""
    try:
        pair = tuple(float(length) for length in np.ravel(lengths))
    except (TypeError, ValueError):
        raise TypeError(f"lengths are {lengths!r}: they must be (Lx, Ly), or Lx alone for square cells") from None
    if len(pair) == 1:
        # on a line Ly is the distance of nothing
        return (pair[0], pair[0] if shape[1:] in ((), (1,)) else pair[0] * shape[1] / shape[0])
    if len(pair) != 2:
        raise ValueError(f"lengths are {lengths!r}: they must be (Lx, Ly), or Lx alone for square cells")
    return (pair[0], pair[1])


def _from_data_array(data: Any, axes: AxisOrder | None) -> Topography:
    """The heights of an xarray.DataArray, with the side lengths of its coordinates."""
    heights, is_line = array_of(data, axes=axes)
    units = {data.attrs.get("units")}
    lengths = []
    dims = data.dims[::-1] if _order(data, axes) == "yx" else data.dims
    lacking = [dim for dim in dims if dim not in data.coords]
    if 0 < len(lacking) < len(dims):
        raise ValueError(f"heights have coordinates, but none along {lacking[0]}: give both, or drop_vars the others")
    for dim in dims if not lacking else ():
        coordinate = np.asarray(data.coords[dim].values)
        if coordinate.dtype.kind not in "fiu":
            raise TypeError(f"coordinate {dim} is an array of {coordinate.dtype}: it must be of real numbers")
        coordinate = coordinate.astype(np.float64)
        units.add(data.coords[dim].attrs.get("units"))
        steps = np.diff(coordinate)
        if steps.size == 0 or not np.ptp(steps) <= _EQUIDISTANT * abs(steps[0]) or steps[0] == 0:
            raise ValueError(f"coordinate {dim} is not equidistant: interpolate the heights on a uniform grid first")
        lengths.append(abs(coordinate[-1] - coordinate[0]) * coordinate.size / (coordinate.size - 1))
    units.discard(None)
    if len(units) > 1:
        raise ValueError(f"heights and coordinates are in different units ({', '.join(sorted(units))}): convert one")
    known = len(lengths) == len(dims)
    both = _lengths(lengths[0] if is_line else tuple(lengths), heights.shape) if known else None
    return Topography(heights, both, next(iter(units), None), _is_line=is_line)
