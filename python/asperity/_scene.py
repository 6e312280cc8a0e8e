"""The scene of a solve: surface, body, law and settings, checked and handed to the compiled core."""

from __future__ import annotations

import contextlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _asperity
from ._control import Load, number
from ._solution import Solution
from ._topography import Topography, field_of, original_of, refined, sides, taken
from ._types import AxisOrder, Boundary, Branches, Heights, Lengths, Method, OwnLaw, Precision, Quantity, Start
from ._units import given
from ._wall import Wall, parts
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
        boundary: Boundary,
        absent_missing: bool,
        law: OwnLaw | None,
        wall: Wall,
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
        original = original_of(self.topography)
        # with a free boundary the images belong to the body
        self.original = None if whole or boundary != "periodic" else original
        self.problem = _asperity.Problem(
            self.topography.heights,
            lengths,
            absent_missing,
            boundary,
            modulus,
            law,
            *parts(wall),
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
            given.get(),
        )
        self.boundary, self.pressure_unit = boundary, None if given.get() is None else "Pa"
        self._adhesion = law
        self._unloads = branch == "unloading"
        self._warned: set[str] = set()
        if self.topography.periodic is False and boundary == "periodic":
            warn(
                "the map is not periodic, and the solve takes it for periodic: use asperity.prepare(heights, "
                "mirror=True) or window=0.1, or boundary='free' if the body ends there",
                InputWarning,
            )

    def held(self, loads: list[Load]) -> list[Load]:
        """Loads with reduced pressures as pressures, over the rms slope of the surface."""
        if loads[:1] and loads[0][0] != "reduced_pressure":
            return loads
        full = self.problem.full_pressure()
        return [("mean_pressure", [ratio * full]) for _, (ratio,) in loads]

    def start(self, start: Start, loads: list[Load]) -> NDArray[np.float64] | None:
        """The gap from which to start under the first of some loads."""
        if start is None:
            return None if self._unloads else self._afar(loads)
        if isinstance(start, str):
            if start != "apart":
                raise ValueError(f"start is {start!r}: it must be 'apart', an array of gaps, or a solution")
            self.problem.initial_gap = "apart"
            return self._apart(*loads[0])
        self.problem.initial_gap = "array"
        gap = field_of(start.whole_gap if isinstance(start, Solution) else start, "start gaps")
        original = original_of(self.topography)
        return gap if original is None or gap.shape != original.shape else original.mirrored(gap)

    def _afar(self, loads: list[Load]) -> NDArray[np.float64] | None:
        """The start of bodies that come from afar: under loads that grow from an approach before touch.

        Under a pull the default start of a solve with adhesion would find them sticking.
        """
        if len(loads) < 2 or self.boundary != "free" or loads[0][0] not in ("approach", "spring"):
            return None
        (name, first), (_, second) = loads[:2]
        return self._apart(name, first) if first[-1] < min(0.0, second[-1]) else None

    def _apart(self, name: str, numbers: list[float]) -> NDArray[np.float64]:
        """The gap of undeformed bodies at the approach, the mean gap, or the position at rest of a load."""
        heights, at, free = self.topography.heights, numbers[-1], self.boundary == "free"
        if name not in ("approach", "mean_gap", "spring"):
            remedy = "an approach or a spring" if free else "a mean gap or a spring"
            raise ValueError(f"start is 'apart', but {name} does not say how far: give {remedy}, or a gap to start from")
        gap: NDArray[np.float64] = np.nanmax(heights) - heights - at if free else at + np.nanmean(heights) - heights
        if np.nanmin(gap) < 0:
            raise ValueError(
                f"start is 'apart', but undeformed bodies overlap where {name} is {at}: give one at which they are apart"
            )
        return gap

    def solution(self, found: dict[str, Any]) -> Solution:
        """The solution of what the compiled core found, with its warnings given; raises what ended it early."""
        told, topography = found["report"], self.topography
        if "heights" in found:
            # those of an accuracy
            topography = refined(topography, found["heights"])
        solution = Solution(topography, self._adhesion, told, found)
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
