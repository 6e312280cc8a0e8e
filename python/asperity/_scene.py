"""The scene of a solve: surface, body, law and settings, checked and handed to the compiled core."""

from __future__ import annotations

import contextlib
import inspect
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _asperity
from ._body import Body, parameters, symbol
from ._control import number
from ._pair import Shift, along_both, between
from ._solution import Solution, Start
from ._topography import Heights, Topography, field_of, original_of, refined, sides, taken
from ._types import AxisOrder, Boundary, Branches, Lengths, Method, OwnLaw, Precision, Quantity
from ._units import given
from ._wall import Hardness, Wall, hardness_of, parts
from ._warnings import AccuracyWarning, ConvergenceWarning, InputWarning, warn, warn_of_input


class Scene:
    """A contact problem in the compiled core, and what its reports say of the input."""

    def __init__(
        self,
        heights: Heights,
        lengths: Lengths | None,
        *,
        axes: AxisOrder | None = None,
        modulus: Quantity,
        body: Body | None = None,
        against: Heights | None = None,
        against_modulus: Quantity | None = None,
        shift: Shift | None = None,
        boundary: Boundary,
        absent_missing: bool,
        law: OwnLaw | None,
        wall: Wall,
        hardness: Hardness | None = None,
        tolerance: float | None,
        max_iterations: int | None,
        method: Method,
        branch: Branches | None,
        precision: Precision,
        threads: int | None,
        nested: bool | None = False,
        whole: bool = False,
    ) -> None:
        self.topography: Topography = taken(heights, lengths, axes)
        lengths, modulus = sides(self.topography), number("modulus", modulus)
        elastic = {"modulus": modulus, **parameters(body)}
        if against_modulus is not None:
            elastic["against_modulus"] = number("against_modulus", against_modulus)
        facing = None
        if against is not None:
            moved = along_both(shift)
            self.topography, name = between(
                self.topography, against, moved, axes=axes, boundary=boundary, absent_missing=absent_missing
            )
            facing = (name, moved)
        elif shift is not None:
            raise ValueError(f"shift is {shift!r}, but there is no surface on the other side: give against, or leave it out")
        original = original_of(self.topography)
        # with a free boundary the images belong to the body
        self.original = None if whole or boundary != "periodic" else original
        self.problem = _asperity.Problem(
            self.topography.heights,
            facing,
            lengths,
            absent_missing,
            boundary,
            elastic,
            symbol(body),
            law,
            *parts(wall),
            hardness_of(hardness),
            precision,
            tolerance,
            max_iterations,
            method,
            branch,
            nested,
            threads,
            self.original,
            None if original is None else "whole" if self.original is None else "original",
            self.topography.unit,
            self.topography.source,
            self.topography.scars_removed,
            given.get(),
        )
        self.pressure_unit = None if given.get() is None else "Pa"
        self.adhesion = law
        self.body = body
        self._warned: set[str] = set()
        if self.topography.periodic is False and boundary == "periodic":
            warn(
                "the map is not periodic, and the solve takes it for periodic: use asperity.prepare(heights, "
                "mirror=True) or window=0.1, or boundary='free' if the body ends there",
                InputWarning,
            )

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "problem": None, "original": None, "body": None}

    @classmethod
    def of(cls, given: dict[str, Any]) -> Scene:
        """The scene among the keywords of a function."""
        return cls(**{name: given[name] for name in _KEYWORDS if name in given})

    def start(self, start: Start) -> str | NDArray[np.float64] | None:
        """The gap from which to start, as the compiled core takes it."""
        if start is None or isinstance(start, str):
            return start
        gap = field_of(start.whole_gap if isinstance(start, Solution) else start, "start gaps")
        original = original_of(self.topography)
        return gap if original is None or gap.shape != original.shape else original.mirrored(gap)

    def solution(self, found: dict[str, Any]) -> Solution:
        """The solution of what the compiled core found, with its warnings given; raises what ended it early."""
        told, topography = found["told"], self.topography
        if "heights" in found:
            # those of an accuracy
            topography = refined(topography, found["heights"])
        solution = Solution(topography, (self.body, self.adhesion), told, found)
        raised = found["raised"]
        if raised is not None:
            # an exception with slots has no room for it
            with contextlib.suppress(AttributeError):
                raised.solution = solution
            raise raised
        for warning in told["warnings"]:
            if warning["code"] not in self._warned:
                self._warned.add(warning["code"])
                warn_of_input(warning)
        for what, text in found["shortfalls"]:
            warn(text, AccuracyWarning if what == "accuracy" else ConvergenceWarning)
        return solution


# once, as a signature takes as long as all else that is done here
_KEYWORDS = tuple(inspect.signature(Scene).parameters)
