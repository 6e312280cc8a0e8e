"""Descriptions whose numbers may be texts with a unit, as walls and bodies are."""

from __future__ import annotations

from typing import ClassVar

from . import _asperity
from ._control import number


class Measured:
    """A frozen dataclass of numbers, with the keys that reports have for them: all with units, or none."""

    _keys: ClassVar[dict[str, str]]

    def __post_init__(self) -> None:
        texts: dict[str, str] = {}
        bare: tuple[str, float] | None = None
        for name, key in self._keys.items():
            value = getattr(self, name)
            if isinstance(value, str):
                texts[key] = value
                value = _asperity.quantity(key, value)
            value = number(name, value)
            if key not in texts and value != 0 and _asperity.has_dimension(key):
                bare = bare or (key, value)
            object.__setattr__(self, name, value)
        object.__setattr__(self, "_given", (texts, bare))

    @property
    def given(self) -> tuple[dict[str, str], tuple[str, float] | None]:
        """The texts with units by the keys of reports, and a number that has none, if there is one."""
        given: tuple[dict[str, str], tuple[str, float] | None] = self.__dict__["_given"]
        return given
