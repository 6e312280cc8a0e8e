"""The files of instruments that asperity itself does not read, by the package SurfaceTopography."""

from __future__ import annotations

import importlib
import os
import warnings
from dataclasses import replace
from typing import Any

from ..common.optional import reason
from .packages import from_topography
from .topography import Topography, in_metres

#: The starts of binary files whose refusal is final: those of asperity's own formats, and texts in UTF-16.
_FINAL = (b"\x93NUMPY", b"GWYP", b"Gwyddion Simple Field", b"\xff\xfe", b"\xfe\xff")
#: The formats that are not left to SurfaceTopography: those of asperity, which has refused what is malformed, and
#: NanoFocus, whose side lengths come out a million times too large.
_LEFT_OUT = ("asc", "xyz", "npy", "npz", "gwy", "nms")
#: The formats of arrays, in which y runs upwards; the others are images, with lines from the top.
_ARRAYS = ("nc", "h5", "mat")
#: What the refusal of a format that SurfaceTopography reads names, which may be the format of a text.
_NAMED = "pip install 'asperity[instruments]'; or "
#: The number of bytes by which readers know their formats.
_START = 512


def read(path: str, channel: int | str | None, refused: ValueError) -> Topography:
    """The map in a file that asperity has refused, a binary one or one of a named format; this refusal where nothing else
    reads it."""
    if not (_is_binary(path) or _NAMED in str(refused)):
        raise refused
    try:
        with warnings.catch_warnings():
            # of MPI, which is not needed
            warnings.simplefilter("ignore", ImportWarning)
            formats = importlib.import_module("SurfaceTopography.IO")
        readers, match = formats.readers, formats.MagicMatch
    except (ImportError, AttributeError):
        raise refused from None
    told = str(refused).replace(_NAMED, "")
    why = "the format is unknown to it"
    with open(path, "rb") as file:
        start = file.read(_START)
        for reader in readers:
            if reader.format() in _LEFT_OUT or not _claims(reader, path, start, match):
                continue
            file.seek(0)
            try:
                channels = reader(file).channels
            except Exception as raised:
                why = reason(raised)
                continue
            if channels:
                return _read_map(_choose(channels, channel, path), path, reader.format() in _ARRAYS)
            why = "it finds no channel"
    raise ValueError(f"{told}; SurfaceTopography does not read it either: {why}")


def _is_binary(path: str) -> bool:
    """Whether a file is binary, and of no format of asperity's own: a text is refused for what is in it."""
    if not (os.path.isfile(path) and os.access(path, os.R_OK)):
        return False
    with open(path, "rb") as file:
        start = file.read(2**20)
    return b"\0" in start and not start.startswith(_FINAL) and not path.lower().endswith(".npz")


def _claims(reader: Any, path: str, start: bytes, match: Any) -> bool:
    """Whether a reader claims a file by its start, or by its ending if it claims all starts."""
    if reader.format() == "di":
        return start[1:].startswith(b"*File list")
    if reader.can_read(b"\xff" * _START) == match.MAYBE:
        return os.path.splitext(path)[1][1:].lower() in (reader.file_extensions() or ())
    return bool(reader.can_read(start) != match.NO)


def _choose(channels: Any, asked: int | str | None, path: str) -> Any:
    """The channel of heights of a number or name, or the only one."""
    # heights in another unit than their sides are none: such a channel has two
    heights = [channel for channel in channels if channel.is_height_channel and not isinstance(channel.unit, tuple)]
    fits = heights
    if asked is not None:
        numbered = [channel for channel in heights if str(channel.index) == str(asked)]
        fits = numbered or [channel for channel in heights if channel.name == asked]
    if len(fits) == 1:
        return fits[0]
    if not heights:
        raise ValueError(f"{path}: holds {len(channels)} channels, none of them of heights: save the heights in it")
    names = ", ".join(f'{channel.index} "{channel.name}"' for channel in heights)
    wrong = "" if asked is None else f', and channel "{asked}" is not one of these alone'
    raise ValueError(
        f"{path}: holds {len(channels)} channels, of heights are {names}{wrong}: choose one, by "
        "asperity.read(path, channel=NUMBER)"
    )


def _read_map(channel: Any, path: str, is_array: bool) -> Topography:
    """The map of a channel, in metres if its unit is known."""
    sizes = channel.nb_grid_pts if channel.physical_sizes is None else None
    try:
        found = from_topography(channel.topography(physical_sizes=sizes))
    except Exception as raised:
        raise ValueError(f"{path}: is not read by SurfaceTopography: {reason(raised)}") from raised
    if sizes is not None:
        found = replace(found, lengths=None)
    if not (is_array or found._is_line):
        found = replace(found, heights=found.heights[:, ::-1])
    return replace(found if found.unit is None else in_metres(found), source=path)
