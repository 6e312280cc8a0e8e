"""Solutions and theories by formulas: what they are, and their numbers, which may be strings with a unit."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _asperity
from ..common.units import in_si, number

F = TypeVar("F", bound="Formula")


class Formula:
    """A frozen dataclass of numbers, all with units or none: with units they, and all that follows, are in SI units."""

    #: What it is of, its formula, and its source.
    about: ClassVar[str]
    #: Its class of the compiled core.
    _core: ClassVar[Any]

    _of: Any
    _texts: dict[str, str]
    _is_si: bool

    def __post_init__(self) -> None:
        typed = {name: getattr(self, name) for name in self._names()}
        *numbers, is_si = in_si(**typed)
        for name, value in zip(typed, numbers):
            # a text that is left is one of a number without a dimension, and is refused
            value = _asperity.quantity(name, value) if isinstance(value, str) else value
            object.__setattr__(self, name, number(name, value))
        object.__setattr__(self, "_texts", {name: text for name, text in typed.items() if isinstance(text, str)})
        object.__setattr__(self, "_is_si", is_si)
        object.__setattr__(self, "_of", self._core(*self._values()))

    def _in_si(self: F, texts: dict[str, str]) -> F:
        """The same with its numbers in SI units, and those that were typed as texts with a unit."""
        object.__setattr__(self, "_texts", texts)
        object.__setattr__(self, "_is_si", True)
        return self

    def _values(self) -> tuple[Any, ...]:
        return tuple(getattr(self, field.name) for field in fields(self))  # type: ignore[arg-type]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._values(), {"_texts": self._texts, "_is_si": self._is_si}

    def __repr__(self) -> str:
        return f"{self._call_text()}\n  {self.about}"

    @classmethod
    def _names(cls) -> list[str]:
        return [field.name for field in fields(cls) if field.compare]  # type: ignore[arg-type]

    def _call_text(self) -> str:
        """The call that makes it, with the numbers as they were typed."""
        shown = {name: f"{getattr(self, name):.8g}" for name in self._names()}
        shown.update({name: repr(text) for name, text in self._texts.items()})
        return f"{type(self).__name__}({', '.join(f'{name}={value}' for name, value in shown.items())})"

    def _read(self, name: str, values: ArrayLike) -> ArrayLike:
        """Numbers, or strings with a unit, in the units of its own."""
        typed = np.asarray(values)
        if typed.dtype.kind != "U":
            return values
        found = np.array([_asperity.quantity(name, str(text)) for text in typed.flat]).reshape(typed.shape)
        if not self._is_si:
            first = typed.flat[0]
            raise ValueError(f"{name} is {first}, with a unit, but {self._call_text()} has none: give both units, or neither")
        return found
