"""Files of heights."""

from __future__ import annotations

import os
from collections.abc import Sequence

from .. import _asperity
from . import instruments
from .topography import Topography


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
        ``.npy``, ``.npz``, Gwyddion's ``.gwy``, ``.gsf`` or text, ``.xyz``, or a plain text matrix; the content
        decides. Or the file of an instrument, with that package.
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
        In metres where the file has a unit of length; missing points are NaN. The first line of an image has the
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
        return instruments.read(source, channel, refused)
    log = (f"also in the file: {', '.join(beside)}".replace("--masked", "masked=True"),) if beside else ()
    return Topography(**made, source=source, log=log, _unread=tuple(beside))
