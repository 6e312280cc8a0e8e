"""Keywords that a function does not have, and the ones that they may mean."""

from __future__ import annotations

import functools
import inspect
import re
from collections.abc import Callable, Iterable, Sequence
from typing import ParamSpec, TypeVar

from .. import _asperity

P = ParamSpec("P")
R = TypeVar("R")

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


def refuse_unknown(function: str, given: Iterable[str], known: Sequence[str]) -> None:
    """Refuses keywords that a function does not have, with those that they may mean."""
    for word in given:
        if word not in known:
            raise TypeError(f"{function}() has no keyword {word}: {_suggest(word, known)}")


def _suggest(word: str, known: Sequence[str]) -> str:
    one = PLURALS.get(word)
    many = next((plural for plural, single in PLURALS.items() if single == word), None)
    if one in known:
        return f"give {one}, or many loads to asperity.sweep, as {word}=[...]"
    if many in known:
        return f"give {many}=[...], or one load to asperity.solve, as {word}"
    right = _asperity.meant(word, known)
    return f"did you mean {right}?" if right else f"it has {', '.join(known)}"


def suggests(function: Callable[P, R]) -> Callable[P, R]:
    """A function that suggests what an unknown keyword may mean."""
    code = inspect.unwrap(function).__code__
    known = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
    own = [name for name in known if name not in ("self", "cls")]
    name = re.sub(r"\.__(new|init)__$", "", function.__qualname__).rpartition(".")[-1]

    @functools.wraps(function)
    def call(*args: P.args, **keywords: P.kwargs) -> R:
        refuse_unknown(name, keywords, own)
        return function(*args, **keywords)

    return call
