"""Files of force curves of instruments, by the package afmformats."""

from __future__ import annotations

import contextlib
import importlib
import logging
from collections.abc import Iterator
from typing import Any

import numpy as np

from ...common.optional import reason
from ..tips import Array
from .columns import Column

#: Metadata of afmformats by the keywords that take their place.
_METADATA = {"spring constant": "spring_stiffness", "sensitivity": "sensitivity"}
#: Texts that are left to afmformats, by what stands at their start: Optics11's, and its own.
_TEXTS = (b"Device:\tChiaro", b"# afmformats")


def knows(content: bytes) -> bool:
    """Whether a file is left to afmformats: a binary one, or a text that it knows."""
    start = content[:4096]
    is_binary = b"\0" in start and not content.startswith((b"\xff\xfe", b"\xfe\xff"))
    return is_binary or any(word in start for word in _TEXTS)


@contextlib.contextmanager
def _silent() -> Iterator[None]:
    """Keeps the tracebacks that afmformats logs from the standard error."""
    logger = logging.getLogger("afmformats")
    before = logger.propagate, logger.handlers
    logger.propagate, logger.handlers = False, [logging.NullHandler()]
    try:
        yield
    finally:
        logger.propagate, logger.handlers = before


def curves(path: Any, given: dict[str, float | None]) -> Any:
    """All force curves of a file."""
    try:
        formats = importlib.import_module("afmformats")
    except ImportError:
        remedy = "pip install 'asperity[curves]', with which it may be read"
        raise ValueError(f"{path}: is binary, or a text of an instrument: {remedy}") from None
    metadata = {key: given[name] for key, name in _METADATA.items() if given.get(name) is not None}
    try:
        with _silent():
            return formats.load_data(path, meta_override=metadata or None)
    except formats.errors.MissingMetaDataError as raised:
        asked = [name for key, name in _METADATA.items() if key in str(raised)]
        remedy = f"; give {' and '.join(f'{name}=' for name in asked)}" if asked else ""
        raise ValueError(f"{path}: is not read by afmformats: {reason(raised)}{remedy}") from None
    except (Exception, formats.errors.AFMFileFormatError) as raised:
        raise ValueError(f"{path}: is not read by afmformats: {reason(raised)}") from None


def choose(path: Any, found: Any, number: int) -> Any:
    """The curve of a number."""
    if not 0 <= number < len(found):
        raise ValueError(f"{path}: is not read by afmformats: it finds {len(found)} curves, and none of number {number}")
    return found[number]


def columns(path: Any, curve: Any) -> tuple[list[Column], Array | None]:
    """The columns of a curve, and the segments of its points, negative in a pause."""
    try:
        with _silent():
            names = [name for name in curve.columns if name not in ("segment", "time", "index")]
            units = ["N" if name == "force" else "m" for name in names]
            found = [Column(name, unit, np.asarray(curve[name], np.float64), name) for name, unit in zip(names, units)]
            if "segment" not in curve.columns:
                return found, None
            segments = np.asarray(curve["segment"], np.int64)
            pause = segments == 1 if curve.modality != "force-distance" else segments > 1
            return found, np.where(pause, "pause", segments.astype(str))
    except Exception as raised:
        raise ValueError(f"{path}: is not read by afmformats: {reason(raised)}") from None
