"""Quantities with a unit, such as "70GPa": the numbers of a call in SI units."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from contextvars import ContextVar
from typing import Any

import numpy as np

from . import _asperity

#: Whether the numbers of the call that runs have units, and are in SI units.
given: ContextVar[bool] = ContextVar("given", default=False)

#: Numbers of formulas alone, by names of the same dimension that the compiled core knows.
_LIKE = {"load": "normal_force", "half_width": "distance", "wavelength": "distance", "rms_curvature": "gap_density"}


class Quantities:
    """The quantities of a call: numbers of its keywords, which all have units, or none has."""

    def __init__(self) -> None:
        self._texts: dict[str, list[str]] = {}
        self._bare: dict[str, Any] = {}

    def read(self, key: str, value: Any) -> Any:
        """The value of a keyword with numbers in SI units instead of its strings with units."""
        if value is None or isinstance(value, bytes) or not _asperity.has_dimension(_LIKE.get(key, key)):
            return value
        if isinstance(value, str):
            self._texts.setdefault(key, []).append(str(value))
            return in_si(key, value)
        items = _items(value)
        if items is not None:
            return [self.read(key, item) for item in items]
        # zero is zero in all units
        if value != 0:
            self._bare.setdefault(key, value)
        return value

    def are_si(self) -> bool:
        """Whether quantities have units; then all have."""
        if self._bare and self._texts:
            (key, value), (other, texts) = next(zip(self._bare.items(), self._texts.items()))
            raise ValueError(
                f"{key} is {value!r}, without a unit, but {other} {' '.join(texts)} has one: give both units, or neither"
            )
        return bool(self._texts)


def in_si(key: str, text: str) -> float:
    """The number in SI units of a string with a unit."""
    like = _LIKE.get(key, key)
    try:
        return _asperity.quantity(like, text)
    except ValueError as refused:
        raise ValueError(str(refused).replace(like, key, 1)) from None


#: Keys of the dimensions of units, with an example.
_DIMENSIONS = {"length": ("approach", "nm"), "pressure": ("mean_pressure", "MPa"), "force": ("normal_force", "nN")}


def in_unit(name: str, unit: str | None) -> float:
    """A unit in SI units, by its name: ``length_unit``, ``pressure_unit`` or ``force_unit``."""
    kind = name.removesuffix("_unit")
    key, example = _DIMENSIONS[kind]
    try:
        return _asperity.quantity(key, f"1{unit}")
    except ValueError:
        raise ValueError(f"{name} is {unit!r}: it must be a unit of a {kind}, as {example!r}") from None


def _items(value: Any) -> Sequence[Any] | None:
    """The items of a sequence; None of a number."""
    try:
        return list(value) if isinstance(value, Iterable) else None
    except TypeError:
        # an array without axes
        return None


def number(name: str, value: Any) -> float:
    """A number that a parameter has to be."""
    try:
        if not isinstance(value, str | bytes | bool | np.bool_):
            return float(value)
    except (TypeError, ValueError):
        pass
    units = "in units that fit the others, such as 70e9 for 70 GPa in Pa"
    raise TypeError(f"{name} is {value!r}: it must be a number, {units}")
