"""The scene of a solve: surface, body, law and settings, checked and handed to the compiled core."""

from __future__ import annotations

import contextlib
import sys
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _asperity
from ._solution import Solution
from ._topography import Topography, field_of, sides, taken
from ._warnings import ConvergenceWarning, InputWarning


class Scene:
    """A contact problem in the compiled core, and what its reports say of the input."""

    def __init__(
        self,
        heights: Any,
        lengths: float | tuple[float, float] | None,
        absent_missing: bool,
        boundary: str,
        modulus: float,
        law: Any,
        precision: str,
        tolerance: float | None,
        max_iterations: int | None,
        method: str,
        threads: int | None,
    ) -> None:
        self.topography: Topography = taken(heights, lengths)
        lengths = sides(self.topography)
        self.problem = _asperity.Problem(
            self.topography.heights,
            lengths,
            absent_missing,
            boundary,
            modulus,
            law,
            precision,
            tolerance,
            max_iterations,
            method,
            threads,
        )
        tolerance, max_iterations, threads = self.problem.inputs()
        self.inputs: dict[str, Any] = {
            "heights": self.topography.source,
            "initial_gap": None,
            "shape": list(self.topography.heights.shape),
            "lengths": list(lengths),
            "length_unit": self.topography.unit,
            "modulus": float(modulus),
            "law": _law_name(law),
            "work_of_adhesion": _number(law, "work_of_adhesion"),
            "range": _number(law, "range"),
            "method": method,
            "precision": precision,
            "tolerance": tolerance,
            "max_iterations": max_iterations,
            "threads": threads,
            "version": _asperity.VERSION,
        }
        self._law = law
        self._warned: set[str] = set()
        if self.topography.periodic is False and boundary == "periodic":
            warnings.warn(
                "the map is not periodic, and the solve takes it for periodic: use asperity.prepare(heights, "
                "mirror=True) or window=0.1, or boundary='free' if the body ends there",
                InputWarning,
                stacklevel=_outside(),
            )

    def start(self, start: Solution | NDArray[np.floating[Any]] | None) -> NDArray[np.float64] | None:
        """The gap from which to start."""
        if start is None:
            return None
        self.inputs["initial_gap"] = "array"
        return field_of(start.gap if isinstance(start, Solution) else start, "start gaps")

    def solution(self, command: str, found: dict[str, Any]) -> Solution:
        """The solution of what the compiled core found, with its warnings given; raises what ended it early."""
        report = {"command": command, **found["report"], **self.inputs}
        solution = Solution(self.topography, self._law, report, found)
        raised = found["raised"]
        if raised is not None:
            # an exception with slots has no room for it
            with contextlib.suppress(AttributeError):
                raised.solution = solution
            raise raised
        for warning in report["warnings"]:
            if warning["code"] not in self._warned:
                self._warned.add(warning["code"])
                text = f"{warning['code']}: {warning['message']}"
                warnings.warn(text, InputWarning, stacklevel=_outside())
        if not solution.converged:
            warnings.warn(
                _not_converged(report, solution.boundary == "periodic"), ConvergenceWarning, stacklevel=_outside()
            )
        return solution


def _not_converged(report: dict[str, Any], periodic: bool) -> str:
    text = f"the solve ended as {report['status']} after {report['iterations']} iterations, "
    text += f"with a certified error of {report['relative_error']:.1e} for a tolerance of {report['tolerance']:.1e}"
    held = "a mean gap" if periodic else "an approach"
    remedy = {
        "iteration-limit": "raise max_iterations, or start from a solution nearby",
        "stalled": "raise the tolerance" + (", or use precision='f64'" if report["precision"] == "f32" else ""),
        "detached": f"no equilibrium holds this tension: press more, or give {held}",
    }.get(report["status"])
    return f"{text}: {remedy}" if remedy else text


def _law_name(law: Any) -> str:
    names = {_asperity.Exponential: "exponential", _asperity.MaugisDugdale: "maugis-dugdale"}
    return "none" if law is None else names.get(type(law), type(law).__name__)


def _number(law: Any, name: str) -> float | None:
    value = getattr(law, name, None)
    return None if value is None else float(value)


def _outside() -> int:
    """The level of the first caller outside of this package, for warnings."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").startswith("asperity."):
        level, frame = level + 1, frame.f_back
    return level
