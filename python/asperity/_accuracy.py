"""The plan of an accuracy that is asked for."""

from __future__ import annotations

from typing import NamedTuple


class Plan(NamedTuple):
    """The cost of a solve to an accuracy, as an estimate from other surfaces.

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
