"""The accuracy that is asked for, and its plan."""

from __future__ import annotations

import logging
from typing import NamedTuple

from . import _asperity
from ._control import Load

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


#: An accuracy as the compiled core takes it: the relative error, the name of the quantity, and the memory in GiB.
Goal = tuple[float, str, float | None]


def plan(problem: _asperity.Problem, load: Load, goal: Goal) -> Plan:
    """The plan of a solve to an accuracy, which the logger ``asperity`` says before it begins."""
    numbers, text = problem.plan(load, goal)
    _log.info(text)
    return Plan(*numbers)


def goal(accuracy: float | None, of: str | None, memory: float | None, **choices: bool) -> Goal | None:
    """The accuracy that is asked for, if one is; refused beside choices that it makes itself."""
    if accuracy is None:
        if of is not None or memory is not None:
            raise ValueError("accuracy_of and memory are of an accuracy: give accuracy, as 0.01 for 1 %")
        return None
    made = [name for name, is_made in choices.items() if is_made]
    if made:
        raise ValueError(f"an accuracy makes its own start and chooses the grids: leave out {' and '.join(made)}")
    return (float(accuracy), of or "area", None if memory is None else float(memory))
