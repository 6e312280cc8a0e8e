"""The keywords of contact problems: values that were given, and objects that stand for several keywords."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Iterable
from itertools import groupby
from operator import itemgetter
from typing import Any

from ..common.units import shown

#: The parameters of laws, which are no keywords next to an object that has its own.
OF_LAWS = ("work_of_adhesion", "range", "exponent", "hamaker", "cut_off")


@functools.cache
def defaults(function: Callable[..., Any]) -> dict[str, Any]:
    """The keywords of a function with their defaults, without the axes of its heights."""
    own: Any = inspect.unwrap(function)
    return {name: default for name, default in own.__kwdefaults__.items() if name != "axes"}


def pick(function: Callable[..., Any], values: dict[str, Any]) -> dict[str, Any]:
    """The values of a call for the keywords of a function, but for None and defaults."""
    chosen = {}
    for name, default in defaults(function).items():
        value = values.get(name)
        if value is not None and not (type(value) is type(default) and value == default):
            chosen[name] = value
    return chosen


def refuse_both(name: str, own: Iterable[str], keys: dict[str, Any]) -> None:
    """Refuses keywords next to an object that has them."""
    for key in own:
        if key in keys:
            raise TypeError(f"{key} is given with {name}, an object that has its own: leave one of them out")


def split_spring(name: str, spring: Any) -> tuple[Any, Any]:
    """The stiffness and the position at rest of a spring."""
    try:
        stiffness, position = spring
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {shown(spring)}: it must be (stiffness, rest)") from None
    return stiffness, position


def replace_spring(keys: dict[str, Any]) -> None:
    """Replaces a spring by its two keywords."""
    spring = keys.pop("spring", None)
    if spring is not None:
        refuse_both("spring", ("spring_stiffness", "spring_position"), keys)
        keys["spring_stiffness"], keys["spring_position"] = split_spring("spring", spring)


def split_springs(keys: dict[str, Any]) -> list[dict[str, Any]]:
    """The keywords of a table in parts, one for each run of springs of one stiffness."""
    springs = keys.pop("springs", None)
    if springs is None:
        return [keys]
    refuse_both("springs", ("spring_stiffness", "spring_positions"), keys)
    parts: list[dict[str, Any]] = [
        {"spring_stiffness": stiffness, "spring_positions": [position for _, position in group]}
        for stiffness, group in groupby((split_spring("springs", spring) for spring in springs), key=itemgetter(0))
    ]
    if not parts:
        raise ValueError("springs is empty: give at least one pair (stiffness, rest)")
    parts[0].update(keys)
    return parts
