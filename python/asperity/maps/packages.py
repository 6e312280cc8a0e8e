"""Maps of other packages: of SurfaceTopography, and DataArrays of xarray with their coordinates."""

from __future__ import annotations

from typing import Any, TypeGuard

import numpy as np

from ..common.types import AxisOrder, HeightMap
from .arrays import axis_order, read_array, side_lengths
from .topography import Topography

#: The share of a spacing by which coordinates may differ from equidistant ones.
_EQUIDISTANT = 1e-3


def from_topography(topography: HeightMap) -> Topography:
    """Takes a map of SurfaceTopography, or anything else with its three properties.

    Parameters
    ----------
    topography : object
        With ``heights()``, an array with masked points where some are missing, ``physical_sizes``, and ``is_periodic``;
        ``unit`` comes along where it is there.

    Returns
    -------
    Topography
    """
    if not is_topography(topography):
        name = type(topography).__name__
        raise TypeError(f"topography is of type {name}: it must have heights() and physical_sizes")
    if not getattr(topography, "is_uniform", True):
        raise ValueError("topography is not on a uniform grid: interpolate it first, for example by its to_uniform()")
    heights, is_line = read_array(topography.heights())
    sizes = topography.physical_sizes
    lengths = None if sizes is None else side_lengths(sizes[0] if is_line else tuple(sizes), heights.shape)
    periodic = getattr(topography, "is_periodic", None)
    return Topography(heights, lengths, getattr(topography, "unit", None), periodic, _is_line=is_line)


def is_topography(values: Any) -> TypeGuard[HeightMap]:
    return callable(getattr(values, "heights", None)) and hasattr(values, "physical_sizes")


def from_data_array(data: Any, axes: AxisOrder | None) -> Topography:
    """The heights of an xarray.DataArray, with the side lengths of its coordinates."""
    heights, is_line = read_array(data, axes=axes)
    units = {data.attrs.get("units")}
    lengths = []
    dims = data.dims[::-1] if axis_order(data, axes) == "yx" else data.dims
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
    both = side_lengths(lengths[0] if is_line else tuple(lengths), heights.shape) if known else None
    return Topography(heights, both, next(iter(units), None), _is_line=is_line)
