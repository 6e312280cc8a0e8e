"""Arrays of numbers as matrices: of NumPy, pandas and xarray, with the order of their axes."""

from __future__ import annotations

import re
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..common.types import AxisOrder, Lengths


def read_field(values: Any, name: str, axes: AxisOrder | None = None) -> NDArray[np.float64]:
    """A field as the compiled core takes it: two-dimensional, float64; dimensions with names are known without axes."""
    return read_array(values, name, None if is_data_array(values) else axes)[0]


def read_array(values: Any, name: str = "heights", axes: AxisOrder | None = None) -> tuple[NDArray[np.float64], bool]:
    """Values as a matrix of float64 with x along its first axis, and whether they are one line.

    Masked points become NaN, and coordinates rise.
    """
    values = label_axes(values, axes, name)
    order = axis_order(values, axes)
    if is_data_array(values):
        values = np.ma.masked_invalid(values.values[tuple(map(_ascending, map(values.coords.get, values.dims)))])
    masked = isinstance(values, np.ma.MaskedArray)
    try:
        # pandas has numbers with a sign for missing ones
        is_frame = hasattr(values, "to_numpy") and not is_data_array(values)
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


def axis_order(values: Any, axes: AxisOrder | None) -> AxisOrder:
    """The order of the axes of an array: by the names of its dimensions, or as it is given."""
    if axes not in (None, "xy", "yx"):
        raise ValueError(f"axes is {axes!r}: it must be 'xy', x along the first axis, or 'yx', as of an image")
    dims = [str(dim).lower() for dim in values.dims] if is_data_array(values) else []
    if len(dims) != 2 or not {"x", "y"} & set(dims):
        return axes or "xy"
    named: AxisOrder = "yx" if dims[0] == "y" or dims[1] == "x" else "xy"
    if axes not in (None, named):
        raise ValueError(f"axes is {axes!r}, but the dimensions are {tuple(values.dims)}: leave axes out, or rename them")
    return named


def _ascending(coordinate: Any) -> slice:
    """The part of an axis that is all of it, with its coordinate rising."""
    falls = coordinate is not None and coordinate.values.size > 1 and coordinate.values[-1] < coordinate.values[0]
    return slice(None, None, -1 if falls else None)


def label_axes(values: Any, axes: AxisOrder | None, name: str = "heights") -> Any:
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


def is_data_array(values: Any) -> bool:
    return hasattr(values, "dims") and hasattr(values, "coords")


def side_lengths(lengths: Lengths, shape: tuple[int, ...]) -> tuple[float, float]:
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


def mirror_field(field: NDArray[Any], shape: tuple[int, ...]) -> NDArray[Any]:
    """A field of the original of a mirrored map, continued by its mirror images to a shape."""
    return np.pad(field, [(0, nodes - own) for nodes, own in zip(shape, field.shape)], mode="symmetric")
