"""Named tuples on one screen."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _asperity


def summary(found: Any, units: dict[str, str | None] | None = None) -> str:
    """A named tuple in a line for each field: numbers to seven digits or with units, and of arrays their shape and range."""
    width = max(map(len, found._fields))
    fields = zip(found._fields, found)
    told = ((name, _asperity.shown(value, units[name]) if units and name in units and value is not None else _text(value)) for name, value in fields)
    return "\n".join(f"{name.replace('_', ' '):<{width}}  {text}" for name, text in told)


def _text(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.7g}"
    if isinstance(value, np.ndarray):
        finite = value[np.isfinite(value)]
        span = f", {finite.min():.4g} to {finite.max():.4g}" if finite.size and value.dtype != bool else ""
        return f"array of {' x '.join(map(str, value.shape))}{span}"
    if isinstance(value, tuple) and hasattr(value, "_fields"):
        return ", ".join(f"{name.replace('_', ' ')} {_text(one)}" for name, one in zip(value._fields, value))
    if isinstance(value, tuple):
        return f"({', '.join(map(_text, value))})"
    # a solution has a screen of its own
    gap = getattr(value, "gap", None)
    return str(value) if gap is None else f"solution of {' x '.join(map(str, gap.shape))} nodes, {value.status}"
