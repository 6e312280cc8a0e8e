"""Solutions and theories by formulas: what they are, and their numbers, which may be strings with a unit."""

from __future__ import annotations

from dataclasses import fields
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _asperity
from ..common.units import number


class Formula:
    """A frozen dataclass of numbers, all with units or none: with units they, and all that follows, are in SI units."""

    #: What it is of, its formula, and its source.
    about: ClassVar[str]
    #: Its class of the compiled core.
    _core: ClassVar[Any]

    _of: Any
    _texts: dict[str, str]

    def __post_init__(self) -> None:
        given = {name: getattr(self, name) for name in self._names()}
        for name, found in zip(given, _asperity.in_si([*given.items()])[0]):
            # a text that is left is one of a number without a dimension, and is refused
            found = _asperity.quantity(name, found) if isinstance(found, str) else found
            object.__setattr__(self, name, number(name, found))
        object.__setattr__(self, "_texts", {name: text for name, text in given.items() if isinstance(text, str)})
        object.__setattr__(self, "_of", self._core(*(getattr(self, field.name) for field in fields(self))))  # type: ignore[arg-type]

    def __reduce__(self) -> tuple[Any, ...]:
        given = (self._texts.get(field.name, getattr(self, field.name)) for field in fields(self))  # type: ignore[arg-type]
        return type(self), tuple(given)

    def __repr__(self) -> str:
        return f"{self._called()}\n  {self.about}"

    @classmethod
    def _names(cls) -> list[str]:
        return [field.name for field in fields(cls) if field.compare]  # type: ignore[arg-type]

    def _called(self) -> str:
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
        if not self._texts:
            first = typed.flat[0]
            raise ValueError(f"{name} is {first}, with a unit, but {self._called()} has none: give both units, or neither")
        return found
