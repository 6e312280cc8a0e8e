"""Descriptions of walls and bodies by numbers, which may be strings with a unit."""

from __future__ import annotations

from typing import Any, ClassVar

from .. import _asperity
from ..common.units import number


class Parameters:
    """A frozen dataclass of numbers, with the keys that scenes have for them: all with units, or none."""

    _keys: ClassVar[dict[str, str]]

    def __post_init__(self) -> None:
        texts: dict[str, str] = {}
        for name, key in self._keys.items():
            value = getattr(self, name)
            if isinstance(value, str):
                texts[key] = value
                value = _asperity.quantity(key, value)
            object.__setattr__(self, name, number(name, value))
        object.__setattr__(self, "_texts", texts)
        _asperity.in_si(list(self.keys.items()))

    @property
    def keys(self) -> dict[str, Any]:
        """Its keys, with their values as they were typed."""
        texts: dict[str, str] = self.__dict__["_texts"]
        return {key: texts.get(key, getattr(self, name)) for name, key in self._keys.items()}
