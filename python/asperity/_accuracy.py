"""The accuracy that is asked for: its plan, and what became of it."""

from __future__ import annotations

import logging
from typing import Any, NamedTuple

from . import _asperity
from ._control import Load

#: The bytes of a GiB.
_GIB = 2.0**30

_log = logging.getLogger("asperity")


class Plan(NamedTuple):
    """What a solve to an accuracy is likely to take, by what other surfaces took; no promise.

    Attributes
    ----------
    nodes_per_wave : float
        Nodes along a side that the shortest wave of the heights has; infinite for flat ones.
    tolerance : float
        Certified relative error at which the solver stops.
    shape : (int, int)
        Shape of the grid that is likely to be fine enough.
    bytes : float
        Memory that it takes.
    seconds : float
        Time that it takes, by that of an operator application on the grid of the heights.
    """

    nodes_per_wave: float
    tolerance: float
    shape: tuple[int, int]
    bytes: float
    seconds: float


class Goal:
    """An accuracy of a quantity, for a solve."""

    def __init__(self, accuracy: float, of: str | None, memory: float | None) -> None:
        self.accuracy, self.of = float(accuracy), of or "area"
        #: as the compiled core takes it
        self.given = (self.accuracy, self.of, None if memory is None else float(memory))

    def plan(self, problem: _asperity.Problem, load: Load) -> Plan:
        """The plan of a solve, which the logger ``asperity`` says before it begins."""
        plan = Plan(*problem.plan(load, self.given))
        waves = f"the shortest wave has {plan.nodes_per_wave:.1f} nodes; " if plan.nodes_per_wave < float("inf") else ""
        _log.info(
            "accuracy %g of the %s: %slikely %d x %d nodes, tolerance %.0e, about %.2g s, %s",
            *(self.accuracy, self.of, waves, *plan.shape, plan.tolerance, plan.seconds, _memory(plan.bytes)),
        )
        return plan


def goal(accuracy: float | None, of: str | None, memory: float | None, **choices: bool) -> Goal | None:
    """The accuracy that is asked for, if one is; refused beside choices that it makes itself."""
    if accuracy is None:
        if of is not None or memory is not None:
            raise ValueError("accuracy_of and memory are of an accuracy: give accuracy, as 0.01 for 1 %")
        return None
    made = [name for name, is_made in choices.items() if is_made]
    if made:
        raise ValueError(f"an accuracy makes its own start and chooses the grids: leave out {' and '.join(made)}")
    return Goal(accuracy, of, memory)


def estimate(report: dict[str, Any]) -> str:
    """The estimated error of the grid in words: of what has the accuracy, or of the area and all that is sure."""
    errors = report["grid_error"]
    if report["accuracy"] is not None:
        of = report["accuracy"]["of"]
        return _told(errors[of], of) if errors[of] is not None else "unknown"
    told = [_told(found, of) for of, found in errors.items() if found and (of == "area" or not found["rough"])]
    return ", ".join(told) or "unknown"


def _told(found: dict[str, Any], of: str) -> str:
    return f"{100 * found['relative']:.2g} % of the {of}{', roughly' if found['rough'] else ''}"


def shortfall(report: dict[str, Any], found: dict[str, Any]) -> str:
    """What keeps a solve from the accuracy that was asked for, with a remedy."""
    wanted, of = report["accuracy"]["wanted"], report["accuracy"]["of"]
    text = f"the accuracy of {wanted:g} of the {of} is not reached: the estimate is {estimate(report)}"
    if found["unaffordable"] is not None:
        (nx, ny), size = found["unaffordable"]
        return f"{text}; {nx} x {ny} nodes would be next, and take {_memory(size)}: raise memory, or ask for less"
    if not found["refinable"]:
        known = "a single node, absent nodes, and a work of adhesion that varies are known on this grid alone"
        return f"{text}; {known}: give a finer one"
    return text


def _memory(size: float) -> str:
    return f"{size / _GIB:.1f} GiB" if size >= _GIB else f"{1024 * size / _GIB:.0f} MiB"
