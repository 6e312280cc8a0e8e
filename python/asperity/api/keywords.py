"""The keywords of functions: those of the keys of scenes, and those that Python alone has."""

from __future__ import annotations

import functools
import inspect
import re
import textwrap
from collections.abc import Callable, Iterable
from os import PathLike
from typing import Any, TypedDict, TypeVar, cast

from .. import _asperity
from .._asperity import Iteration
from ..answers.solution import Start
from ..bodies.body import Body
from ..common.types import Quantity
from ..common.words import check
from ..maps.heights import Heights
from .keys import *

#: What the docstrings of functions say of their parameters.
_ENTRIES: dict[str, dict[str, str]] = {}

F = TypeVar("F", bound=Callable[..., Any])


class ContactKeywords(SurfaceKeywords, AdhesionKeywords, SolverKeywords, total=False):
    """Those of a contact."""

    body: Body | None
    against: Heights | None


class StartKeywords(TypedDict, total=False):
    """The start of a solve, and its observer."""

    start: Start
    observe: Callable[[Iteration], object] | None


class FileKeywords(StartKeywords, total=False):
    """The file of a table."""

    out: str | PathLike[str] | None
    force: bool


class SolveKeywords(
    LoadKeywords, NestedKeywords, FindingsKeywords, ConductorKeywords, AccuracyKeywords, StartKeywords, total=False
):
    """Those of a solve."""

    spring: tuple[Quantity, Quantity] | None


class SweepKeywords(
    LoadsKeywords, FractionsKeywords, StiffnessKeywords, ConductorKeywords, LeakageKeywords, FileKeywords, total=False
):
    """Those of a sweep."""

    springs: Iterable[tuple[Quantity, Quantity]] | None
    fields: str | PathLike[str] | None


class CycleKeywords(LoadsKeywords, PathKeywords, FileKeywords, total=False):
    """Those of a cycle."""

    springs: Iterable[tuple[Quantity, Quantity]] | None
    smooth: bool
    fields: str | PathLike[str] | None


class InterfaceKeywords(LoadsKeywords, ConductorKeywords, LeakageKeywords, FileKeywords, total=False):
    """Those of the law of an interface."""


class OfPullOffKeywords(PullOffKeywords, StartKeywords, total=False):
    """Those of a pull-off."""


class ViscoelasticKeywords(StartKeywords, total=False):
    """Those of a viscoelastic body."""

    prony: Iterable[tuple[float, float]]
    times: Iterable[float]
    mean_pressures: Iterable[Quantity] | None
    mean_gaps: Iterable[Quantity] | None
    normal_forces: Iterable[Quantity] | None
    approaches: Iterable[Quantity] | None


class StabilityKeywords(LoadKeywords, total=False):
    """Those of a stability."""

    spring: tuple[Quantity, Quantity] | None


class SolveAll(ContactKeywords, SolveKeywords, total=False):
    """Those of a contact and its solve."""


class SweepAll(ContactKeywords, SweepKeywords, total=False):
    """Those of a contact and its sweep."""


class CycleAll(ContactKeywords, CycleKeywords, total=False):
    """Those of a contact and its cycle."""


class InterfaceAll(ContactKeywords, InterfaceKeywords, total=False):
    """Those of a contact and its law of an interface."""


class PullOffAll(ContactKeywords, OfPullOffKeywords, total=False):
    """Those of a contact and its pull-off."""


class ViscoelasticAll(ContactKeywords, ViscoelasticKeywords, total=False):
    """Those of a contact and its viscoelastic body."""


#: The defaults and meanings of the keys, by their lists, and of one that several lists have those of the first.
_LISTS = _asperity.meanings()
_MEANINGS = {name: known for keys in reversed(_LISTS) for name, known in keys.items()}

#: The defaults of the keywords that Python alone has, which docstrings explain.
_OTHERS: dict[str, tuple[object, str]] = {
    **dict.fromkeys(("body", "against", "spring", "springs", "start", "observe", "out", "fields", "prony", "times"), (None, "")),
    "smooth": (True, ""),
    "force": (False, ""),
}


def names(kind: Any) -> tuple[str, ...]:
    """The names of keywords."""
    return tuple(kind.__annotations__)


def described(kind: Any, *, without: tuple[str, ...] = ()) -> Callable[[F], F]:
    """Gives a function the signature of its keywords, and its docstring those that it leaves out; refuses all others."""

    def describe(function: F) -> F:
        signature = inspect.signature(function)
        own = [one for one in signature.parameters.values() if one.kind is not inspect.Parameter.VAR_KEYWORD]
        known = [name for name in names(kind) if name not in without]
        meanings = {**_MEANINGS, **_OTHERS}
        # a list that the function has in full says more than one that shares a key with it
        for keys in reversed(_LISTS):
            if keys.keys() <= set(known):
                meanings.update(keys)
        more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=meanings[name][0]) for name in known]
        order = [*(one.name for one in own), *known]
        of = function.__qualname__.removesuffix(".__init__").rpartition(".")[-1]

        @functools.wraps(function)
        def call(*args: Any, **keywords: Any) -> Any:
            check(of, keywords, [one for one in order if one != "self"])
            return function(*args, **keywords)

        setattr(call, "__signature__", signature.replace(parameters=[*own, *more]))
        head, returns, tail = inspect.cleandoc(function.__doc__ or "").partition("\nReturns\n-------\n")
        head, _, documented = head.partition("\nParameters\n----------\n")
        entries = _entries(documented)
        kept = _ENTRIES.setdefault(function.__name__, {})
        for names_of, entry in entries:
            for name in names_of:
                kept.setdefault(name, entry)
        there = {name for names_of, _ in entries for name in names_of}
        for name in order:
            said = kept.get(name) or _ENTRIES.get("solve", {}).get(name)
            if name in known and not said:
                meaning = textwrap.fill(f"{meanings[name][1]}.", 120, initial_indent="    ", subsequent_indent="    ")
                said = f" : {_typed(kind.__annotations__[name])}, optional\n{meaning}"
            if said and name not in there:
                entries.append(((name,), said))
        entries.sort(key=lambda one: order.index(one[0][0]))
        lines = "".join(f"{', '.join(names_of)}{entry.rstrip()}\n" for names_of, entry in entries)
        call.__doc__ = f"{head.rstrip()}\n\nParameters\n----------\n{lines}{returns}{tail}"
        return cast("F", call)

    return describe


def _typed(annotation: Any) -> str:
    """The type of a keyword as docstrings have it."""
    text = str(getattr(annotation, "__forward_arg__", annotation)).removesuffix(" | None")
    text = re.sub(r"Literal\[(.*?)\]", r"{\1}", text).replace("'", '"')
    return text.replace("Quantity", "float | str").replace(" | ", " or ")


def _entries(text: str) -> list[tuple[tuple[str, ...], str]]:
    """The parameters that a docstring has, with what it says of each or of several."""
    entries = re.findall(r"^(\w[\w, ]*)((?: :.*)?(?:\n    .*|\n(?=\n    ))+)", text, re.MULTILINE)
    return [(tuple(name.strip() for name in names.split(",")), entry) for names, entry in entries]
