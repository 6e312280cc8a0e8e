"""A problem that is posed, and the solutions that the compiled core finds of it."""

from __future__ import annotations

import contextlib
import copy
import threading
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from .. import _asperity
from ..bodies.body import symbol
from ..common.warnings import AccuracyWarning, ConvergenceWarning, warn, warn_input
from ..maps.arrays import read_field
from ..maps.topography import Topography, refine
from .solution import Solution, Start

P = TypeVar("P", bound="Posed")


class Turns:
    """Calls of a problem one at a time: calls of other threads wait, and one from within another is refused."""

    def __init__(self) -> None:
        self._lock, self._is_within = threading.RLock(), False

    def __enter__(self) -> None:
        self._lock.acquire()
        if self._is_within:
            self._lock.release()
            raise RuntimeError(
                "the contact is being solved, and its observer cannot solve it in between: make another asperity.Contact"
            )
        self._is_within = True

    def __exit__(self, *_: object) -> None:
        self._is_within = False
        self._lock.release()

    def __reduce__(self) -> tuple[type[Turns], tuple[()]]:
        # a lock does not travel between processes
        return Turns, ()


class Posed:
    """A contact problem that is posed, as results of many solves hold it."""

    topography: Topography
    #: the unit of pressures
    pressure_unit: str | None
    #: the law as an object
    own_law: Any
    #: why theories do not know of it
    beyond_theory: str | None
    #: the contact modulus of both bodies
    modulus: float
    turns: Turns
    body: Any
    law: Any
    _keys: dict[str, Any]
    _is_si: bool
    _is_kept: bool
    _given: _asperity.Keywords
    _facing: str | None
    _hardness: NDArray[np.float64] | None
    _posed: _asperity.Problem | None
    _warned: set[str]

    @property
    def adheres(self) -> bool:
        """Whether there is an adhesion law."""
        return self.law not in (None, "none")

    def __copy__(self: P) -> P:
        # one that stays in this process has all of it
        contact = type(self).__new__(type(self))
        contact.__dict__.update(self.__dict__)
        return contact

    def __getstate__(self) -> dict[str, Any]:
        # what the compiled core holds is made again where it is needed
        return {**self.__dict__, "_posed": None, "_given": None}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._given = _asperity.Keywords(self._keys, self.own_law, self._is_si)

    @property
    def problem(self) -> _asperity.Problem:
        """The problem, as the compiled core has it."""
        if self._posed is None:
            self._posed = self._problem(self.topography, self._given, self._is_kept)
        return self._posed

    def _problem(
        self, topography: Topography, given: _asperity.Keywords, is_kept: bool, against: Topography | None = None
    ) -> _asperity.Problem:
        """The problem of a map, as the compiled core has it."""
        other, own = (against, self._facing), symbol(self.body)
        return _asperity.Problem(topography, other, self._hardness, given, own, is_kept)

    def _start(self, start: Start) -> str | NDArray[np.float64] | None:
        """The gap from which to start, as the compiled core takes it."""
        if start is None or isinstance(start, str):
            return start
        return read_field(start.whole_gap if isinstance(start, Solution) else start, "start gaps")

    def _relaxed(
        self, heights: NDArray[np.float64], share: float, load: dict[str, Any], start: Start, observe: Any
    ) -> Solution:
        """The solution of other heights and a share of the modulus; a solution to start from chooses the branch."""
        (modulus,) = self._given.numbers("modulus") or [0.0]
        keys = {**self._keys, "modulus": share * modulus}
        if isinstance(start, Solution):
            keys.pop("branch", None)
        contact, given = copy.copy(self), _asperity.Keywords(keys, self.own_law, self._given.is_si)
        contact.topography = replace(self.topography, heights=heights)
        found = self._problem(contact.topography, given, False).solve(load, self._start(start), observe)
        for warning in found["told"]["warnings"]:
            # that law has no range, on which the speed of an edge depends
            warning["message"] = warning["message"].replace("use jkr", "refine the grid")
        return contact._solution(found)

    def _solution(self, found: dict[str, Any]) -> Solution:
        """The solution of what the compiled core found, with its warnings given; raises what ended it early."""
        told, topography = found["told"], self.topography
        if "heights" in found:
            # those of an accuracy
            topography = refine(topography, found["heights"])
        solution = Solution(topography, (self.body, self.law), told, found)
        raised = found["raised"]
        if raised is not None:
            # an exception with slots has no room for it
            with contextlib.suppress(AttributeError):
                raised.solution = solution
            raise raised
        for warning in told["warnings"]:
            if warning["code"] not in self._warned:
                self._warned.add(warning["code"])
                warn_input(warning)
        for what, text in found["shortfalls"]:
            warn(text, AccuracyWarning if what == "accuracy" else ConvergenceWarning)
        return solution
