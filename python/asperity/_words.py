"""Keywords that are not those of a function, and the ones that they may mean."""

from __future__ import annotations

import difflib
import functools
import inspect
from collections.abc import Callable, Iterable, Sequence
from typing import Any, ParamSpec, TypeVar

from . import _control
from ._units import Quantities, given

P = ParamSpec("P")
R = TypeVar("R")

#: Other words for keywords, in lower case.
_MEANT = {
    "pressure": "mean_pressure",
    "p": "mean_pressure",
    "load": "mean_pressure",
    "gap": "mean_gap",
    "force": "normal_force",
    "displacement": "approach",
    "indentation": "approach",
    "area": "contact_fraction",
    "e": "modulus",
    "e_star": "modulus",
    "youngs_modulus": "modulus",
    "adhesion": "law",
    "w": "work_of_adhesion",
    "work": "work_of_adhesion",
    "gamma": "work_of_adhesion",
    "surface_energy": "work_of_adhesion",
    "rho": "range",
    "z0": "range",
    "d0": "range",
    "n": "exponent",
    "a": "hamaker",
    "length": "lengths",
    "size": "lengths",
    "tol": "tolerance",
    "maxiter": "max_iterations",
    "periodic": "boundary",
}


def check(function: str, given: Iterable[str], known: Sequence[str]) -> None:
    """Refuses keywords that a function does not have, with those that they may mean."""
    for word in given:
        if word not in known:
            raise TypeError(f"{function}() has no keyword {word}: {_meant(word, known)}")


def _meant(word: str, known: Sequence[str]) -> str:
    one = _control.PLURALS.get(word)
    many = next((plural for plural, single in _control.PLURALS.items() if single == word), None)
    if one in known:
        return f"give {one}, or many loads to asperity.sweep, as {word}=[...]"
    if many in known:
        return f"give {many}=[...], or one load to asperity.solve, as {word}"
    meant = _MEANT.get(word.lower(), "")
    plural = next((plural for plural, single in _control.PLURALS.items() if single == meant), meant)
    right = next((name for name in (meant, plural) if name in known), None)
    if right is None:
        right = next(iter(difflib.get_close_matches(word, known, 1)), None)
    return f"did you mean {right}?" if right else f"it has {', '.join(known)}"


def checked(function: Callable[P, R], module: str = "asperity") -> Callable[P, R]:
    """A function of the package, as users see it.

    It reads quantities with units, and tells what a keyword may mean that it does not have.
    """
    known = tuple(inspect.signature(function).parameters)

    @functools.wraps(function)
    def call(*args: P.args, **kwargs: P.kwargs) -> R:
        check(function.__name__, kwargs, known)
        quantities = Quantities()
        values: Any = [quantities.read(key, value) for key, value in zip(known, args)] + [*args[len(known) :]]
        keywords: Any = {key: quantities.read(key, value) for key, value in kwargs.items()}
        token = given.set(quantities.texts())
        try:
            return function(*values, **keywords)
        finally:
            given.reset(token)

    # by this name it is found in other processes
    call.__module__ = module
    return call
