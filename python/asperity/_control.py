"""The control of a solve: the one load that is given, by the name of its keyword."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ._types import Branch, Branches

#: A load as the compiled core takes it: the name of its keyword, and its numbers.
Load = tuple[str, list[float]]

#: The numbers of two bodies.
Pair = tuple[float, float] | None

#: The names of loads by the keywords of their sequences.
PLURALS = {
    "mean_pressures": "mean_pressure",
    "mean_gaps": "mean_gap",
    "normal_forces": "normal_force",
    "approaches": "approach",
    "springs": "spring",
    "reduced_pressures": "reduced_pressure",
    "contact_fractions": "contact_fraction",
}


def number(name: str, value: Any) -> float:
    """A number that a parameter has to be."""
    try:
        if not isinstance(value, str | bytes | bool | np.bool_):
            return float(value)
    except (TypeError, ValueError):
        pass
    raise TypeError(f"{name} is {value!r}: it must be a number, in units that fit the others, as 70e9 for 70 GPa in Pa")


def pair(name: str, value: Any) -> Pair:
    """The numbers of two bodies."""
    if value is None:
        return None
    try:
        first, second = value
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {value!r}: it must be two numbers, one of each body") from None
    return (number(name, first), number(name, second))


def one(given: dict[str, Any]) -> Load:
    """The one load among the keywords of a function."""
    name, value = _only("load", given, PLURALS.values())
    if name != "spring" and np.ndim(value) > 0:
        plural = next(plural for plural, one in PLURALS.items() if one == name)
        raise TypeError(f"{name} is {value!r}: it must be one number; asperity.sweep takes many, as {plural}=[...]")
    return _load(name, value)


def many(given: dict[str, Any]) -> list[Load]:
    """The sequence of loads among the keywords of a function, by the plural of their names."""
    name, values = _only("sequence of loads", given, PLURALS)
    if np.ndim(values) == 0 and not isinstance(values, Iterable):
        raise TypeError(f"{name} is {values!r}: it must be a sequence, as [{values!r}], or one load of asperity.solve")
    return [_load(PLURALS[name], value) for value in values]


def _only(what: str, given: dict[str, Any], loads: Iterable[str]) -> tuple[str, Any]:
    known = [name for name in loads if name in given]
    found = [(name, given[name]) for name in known if given[name] is not None]
    if len(found) != 1:
        names = " and ".join(name for name, _ in found) or "none"
        raise TypeError(f"give one {what}, {' or '.join(known)}: {names} given")
    return found[0]


def _load(name: str, value: Any) -> Load:
    if name != "spring":
        return (name, [number(name, value)])
    try:
        stiffness, rest = value
    except (TypeError, ValueError):
        raise TypeError(f"spring is {value!r}: it must be (stiffness, rest)") from None
    return (name, [number("stiffness of the spring", stiffness), number("rest of the spring", rest)])


def only(branch: Branches | None) -> Branch | None:
    """The branch of equilibria on which loads begin, one after the other."""
    if branch == "both":
        raise ValueError("branch is both: that compares two solves under one load: use solve, or give one branch")
    return branch
