"""Quantities with a unit, such as "70GPa": the numbers of a call in SI units."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _asperity

#: Keys of the dimensions of units, with an example.
_DIMENSIONS = {"length": ("approach", "nm"), "pressure": ("mean_pressure", "MPa"), "force": ("normal_force", "nN")}


def in_si(**quantities: Any) -> tuple[Any, ...]:
    """The numbers of quantities by their names, and whether they are in SI units: all are texts with a unit, or none."""
    numbers, is_si = _asperity.in_si([*quantities.items()])
    return (*numbers, is_si)


def in_unit(name: str, unit: str | None) -> float:
    """A unit in SI units, by its name: ``length_unit``, ``pressure_unit`` or ``force_unit``."""
    kind = name.removesuffix("_unit")
    key, example = _DIMENSIONS[kind]
    try:
        return _asperity.quantity(key, f"1{unit}")
    except ValueError:
        raise ValueError(f"{name} is {unit!r}: it must be a unit of a {kind}, as {example!r}") from None


def shown(value: Any) -> str:
    """What a message says of a value: of an array its shape."""
    shape = getattr(value, "shape", ())
    return f"an array of shape {shape}" if shape else repr(value)


def number(name: str, value: Any) -> float:
    """A number that a parameter has to be."""
    try:
        if not isinstance(value, str | bytes | bool | np.bool_):
            return float(value)
    except (TypeError, ValueError):
        pass
    units = "in units that fit the others, such as 70e9 for 70 GPa in Pa"
    raise TypeError(f"{name} is {shown(value)}: it must be a number, {units}")


def plain(keys: dict[str, Any]) -> dict[str, Any]:
    """Keys with their values as the compiled core reads them: numbers, texts and lists of Python, none of numpy."""
    return {key: np.asarray(value).tolist() for key, value in keys.items() if value is not None}
