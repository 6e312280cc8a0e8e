"""The base of adhesion laws that are made of a few parameters."""

from __future__ import annotations

from typing import Any, ClassVar, TypeVar, cast

import numpy as np

from .._asperity import Law

L = TypeVar("L", bound="ParameterLaw")


class ParameterLaw(Law):
    """A law of a few parameters, by the names of which it matches."""

    __match_args__: ClassVar[tuple[str, ...]] = ()
    _values: tuple[Any, ...]

    @classmethod
    def _from(cls: type[L], law: Law, values: tuple[Any, ...]) -> L:
        """The law of this class with the parameters by which it was made."""
        own = cast("L", Law.__new__(cls, law))
        for value in values:
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        own._values = values
        return own

    def __getnewargs__(self) -> tuple[Any, ...]:
        texts, _ = self.given
        keys = ("cut_off" if name == "distance" else name for name in self.__match_args__)
        return tuple(texts.get(key, value) for key, value in zip(keys, self._values))

    def __getstate__(self) -> None:
        return None

    def __repr__(self) -> str:
        values = zip(self.__match_args__, self.__getnewargs__())
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in values)})"
