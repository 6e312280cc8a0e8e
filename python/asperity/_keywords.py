"""The keywords of functions: those of the keys of scenes, and those that Python alone has."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterable
from os import PathLike
from typing import Any, TypedDict, TypeVar

from . import _keys
from ._asperity import Iteration
from ._body import Body
from ._keys import (
    AccuracyKeywords,
    AdhesionKeywords,
    ConductorKeywords,
    FindingsKeywords,
    FractionsKeywords,
    LeakageKeywords,
    LoadKeywords,
    LoadsKeywords,
    NestedKeywords,
    PathKeywords,
    PullOffKeywords,
    SolverKeywords,
    StiffnessKeywords,
    SurfaceKeywords,
)
from ._solution import Start
from ._topography import Heights
from ._types import Quantity

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


#: The defaults and meanings of the keys, of one that several lists have those of the first.
_MEANINGS = {name: known for keys in reversed(_keys.KEYS.values()) for name, known in keys.items()}

#: The meanings of the keywords that Python alone has, and their defaults.
_OTHERS: dict[str, tuple[object, str]] = {
    "body": (None, "Body that deforms, a half-space by default: Layer, Coating or Symbol, in the place of its keys"),
    "against": (None, "Heights of the surface on the other side, peaks up as they were measured"),
    "spring": (None, "Stiffness and position of a spring, (spring_stiffness, spring_position)"),
    "springs": (None, "Springs, each its stiffness and position"),
    "start": (None, "Gap from which to start, a solution, or 'apart' for undeformed bodies"),
    "observe": (None, "Called with an `Iteration` in every iteration"),
    "smooth": (True, "Whether jumps of the law's traction are smoothed by what the grid resolves"),
    "out": (None, "File for the rows, .csv or .jsonl, as the tool writes it"),
    "fields": (None, "Folder for gap, pressure and contact pressure of the rows"),
    "force": (False, "Starts over, and replaces the files that are there"),
}


def names(kind: Any) -> tuple[str, ...]:
    """The names of keywords."""
    return tuple(kind.__annotations__)


def described(kind: Any, *, without: tuple[str, ...] = ()) -> Callable[[F], F]:
    """Gives a function the signature of its keywords, and its docstring those that it leaves out."""

    def describe(function: F) -> F:
        signature = inspect.signature(function)
        own = [one for one in signature.parameters.values() if one.kind is not inspect.Parameter.VAR_KEYWORD]
        known = [name for name in names(kind) if name not in without]
        meanings = {**_MEANINGS, **_OTHERS, **(_keys.KEYS["PullOff"] if "rtol" in known else {})}
        more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=meanings[name][0]) for name in known]
        setattr(function, "__signature__", signature.replace(parameters=[*own, *more]))
        text = inspect.cleandoc(function.__doc__ or "")
        head, returns, tail = text.partition("\nReturns\n-------\n")
        if "Parameters\n----------\n" not in head:
            head = f"{head.rstrip()}\n\nParameters\n----------\n"
        documented = {name.strip() for line in head.splitlines() for name in line.partition(" :")[0].split(",")}
        types = {name: str(getattr(one, "__forward_arg__", one)) for name, one in kind.__annotations__.items()}
        lines = [
            f"{name} : {types[name].removesuffix(' | None')}, optional\n{_filled(meanings[name][1])}\n"
            for name in known
            if name not in documented
        ]
        setattr(function, "__doc__", f"{head.rstrip()}\n{''.join(lines)}{returns}{tail}")
        return function

    return describe


def _filled(text: str) -> str:
    return textwrap.fill(f"{text}.", 120, initial_indent="    ", subsequent_indent="    ")
