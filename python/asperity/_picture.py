"""The small picture of a contact map for a notebook, as PNG without any package."""

from __future__ import annotations

import base64
import struct
import zlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

#: The most nodes along a side that are drawn one by one; more are averaged.
_MOST = 512


def data_uri(contact: NDArray[np.bool_]) -> str:
    """A contact map as a PNG in a data URI: contact is dark, x runs to the right and y up."""
    return "data:image/png;base64," + base64.b64encode(png(contact)).decode()


def png(contact: NDArray[np.bool_]) -> bytes:
    """A contact map as a PNG in grey."""
    share = contact.astype(np.float64).reshape(contact.shape[0], -1)
    if share.shape[1] == 1:
        share = np.repeat(share, max(1, share.shape[0] // 8), axis=1)
    for axis in (0, 1):
        share = _averaged(share, axis)
    grey = np.round(255 - 225 * share.T[::-1]).astype(np.uint8)
    rows = b"".join(b"\0" + row.tobytes() for row in grey)
    header = struct.pack(">IIBBBBB", grey.shape[1], grey.shape[0], 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + _chunk(b"IHDR", header) + _chunk(b"IDAT", zlib.compress(rows)) + _chunk(b"IEND", b"")


def _averaged(field: NDArray[Any], axis: int) -> NDArray[Any]:
    size = field.shape[axis]
    if size <= _MOST:
        return field
    edges = np.linspace(0, size, _MOST + 1).astype(int)
    sums = np.add.reduceat(field, edges[:-1], axis=axis)
    counts = np.diff(edges)
    return np.asarray(sums / (counts[:, None] if axis == 0 else counts[None, :]))


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
