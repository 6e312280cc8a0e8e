"""Quantities with a unit, as "70GPa": the numbers of a call in the SI."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextvars import ContextVar
from typing import Any

import numpy as np

from . import _asperity
from ._control import PLURALS

#: The quantities of the call that runs, as they were typed; None if its numbers have no units.
given: ContextVar[dict[str, str | list[str]] | None] = ContextVar("given", default=None)


class Quantities:
    """The quantities of a call: numbers of its keywords, which all have units, or none has."""

    def __init__(self) -> None:
        self._texts: dict[str, list[str]] = {}
        self._bare: dict[str, Any] = {}

    def read(self, key: str, value: Any) -> Any:
        """The value of a keyword with numbers in the SI in the place of its texts with units."""
        key = PLURALS.get(key, key)
        if key in ("law", "wall", "body"):
            # these have read theirs
            texts, bare = getattr(value, "given", ({}, None))
            self._texts.update({name: [text] for name, text in texts.items()})
            self._bare.update([bare] if bare else [])
            return value
        if key == "hardness" and np.ndim(value) > 0:
            return value
        if key == "spring":
            return self._spring(value)
        if value is None or isinstance(value, bytes) or not _asperity.has_dimension(key):
            return value
        if isinstance(value, str):
            self._texts.setdefault(key, []).append(str(value))
            return _asperity.quantity(key, value)
        items = _items(value)
        if items is not None:
            return [self.read(key, item) for item in items]
        # zero is zero in all units
        if value != 0:
            self._bare.setdefault(key, value)
        return value

    def _spring(self, value: Any) -> Any:
        """A spring, a stiffness and a position at rest, or several."""
        items = _items(value)
        if items is None or isinstance(value, str):
            return value
        if len(items) == 2 and all(isinstance(item, str) or _items(item) is None for item in items):
            return tuple(self.read(f"spring_{part}", item) for part, item in zip(("stiffness", "position"), items))
        return [self._spring(item) for item in items]

    def texts(self) -> dict[str, str | list[str]] | None:
        """The quantities as they were typed, by the names of reports; None if none has a unit."""
        if not self._texts:
            return None
        for key, value in self._bare.items():
            other, texts = next(iter(self._texts.items()))
            raise ValueError(
                f"{key} is {value!r}, without a unit, but {other} {' '.join(texts)} has one: give both units, or neither"
            )
        return {key: texts[0] if len(texts) == 1 else texts for key, texts in self._texts.items()}


def _items(value: Any) -> Sequence[Any] | None:
    """The items of a sequence; None of a number."""
    try:
        return list(value) if isinstance(value, Iterable) else None
    except TypeError:
        # an array without axes
        return None
