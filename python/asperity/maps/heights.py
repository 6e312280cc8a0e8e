"""Heights as functions take them: maps, arrays, files and the objects of other packages."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any, TypeAlias

from numpy.typing import ArrayLike

from ..common.types import AxisOrder, HeightMap
from .arrays import axis_order, is_data_array, label_axes, read_array, side_lengths
from .files import read
from .packages import from_data_array, from_topography, is_topography
from .topography import Topography, in_metres

#: A map as functions take it.
Heights: TypeAlias = ArrayLike | Topography | HeightMap | str | os.PathLike[str]


def convert_heights(
    heights: Heights, lengths: Any = None, axes: AxisOrder | None = None, is_si: bool = False, name: str = "heights"
) -> Topography:
    """The map of whatever holds heights, with the side lengths that are given for it; in metres with units."""
    topography = read_heights(heights, axes, name)
    if is_si:
        topography = in_metres(topography)
    return topography if lengths is None else replace(topography, lengths=side_lengths(lengths, topography.heights.shape))


def read_heights(heights: Heights, axes: AxisOrder | None, name: str = "heights") -> Topography:
    """The map of whatever holds heights, in float64; the data are not copied where they are that already."""
    if axes is not None and knows_axes(heights):
        raise ValueError(f"axes is {axes!r}, but a file or a map knows its axes: leave it out, or give an array")
    if isinstance(heights, Topography):
        return heights
    if isinstance(heights, str | os.PathLike):
        return read(heights)
    if is_topography(heights):
        return from_topography(heights)
    heights = label_axes(heights, axes, name)
    if is_data_array(heights):
        return from_data_array(heights, axes)
    array, is_line = read_array(heights, name, axes)
    return Topography(array, _is_line=is_line)


def knows_axes(heights: Heights) -> bool:
    """Whether heights are a map or a file, with known axes."""
    return isinstance(heights, Topography | str | os.PathLike) or is_topography(heights)


def read_axes(heights: Heights, axes: AxisOrder | None) -> AxisOrder:
    """The order of the axes of heights: of a map, by the names of dimensions, or as it is given."""
    return "xy" if knows_axes(heights) else axis_order(label_axes(heights, axes), axes)
