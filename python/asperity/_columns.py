"""A table of loads that is solved row by row."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ._solution import Solution

T = TypeVar("T")
R = TypeVar("R", bound="Rows[Any]")

#: The columns of a state, and of how its solve ended, as in the tool's tables.
STATE = (
    "control",
    "control_value",
    "mean_pressure",
    "mean_contact_pressure",
    "mean_gap",
    "normal_force",
    "approach",
    "edge_traction",
    "contact_fraction",
    "corrected_contact_fraction",
    "perimeter",
    "clusters",
    "largest_cluster",
    "repulsive_fraction",
    "attractive_fraction",
    "elastic_energy",
    "adhesive_energy",
    "min_gap",
)
#: The columns of the inputs, the same in all rows, so that tables can be put together.
INPUTS = ("modulus", "law", "work_of_adhesion", "range", "heights", "part", "seed")
#: The columns of a search for the load of a contact fraction.
SEARCH = ("wanted_contact_fraction", "reached")
OUTCOME = ("relative_error", "load_error", "iterations", "operator_applications", "status")

#: The columns of a contact stiffness, where it is asked for.
STIFFNESS = ("contact_stiffness", "normal_stiffness")


def state(solution: Solution) -> dict[str, Any]:
    """The numbers of a solution by the names of columns."""
    statistics = solution.statistics
    sizes = statistics.cluster_sizes
    largest = int(sizes[0]) if len(sizes) else 0
    searched = solution.report["search"]
    search = {} if searched is None else dict(zip(SEARCH, (searched["wanted"], searched["reached"]), strict=True))
    counted = {**statistics._asdict(), "clusters": len(sizes), "largest_cluster": largest}
    source = solution.report["heights"]
    file = None if source is None else os.path.basename(source)
    return {**solution.report, **counted, **search, "heights": file, "seed": solution.topography.seed}


class Rows(Iterator[T]):
    """An iterator over states, of which the numbers are kept, and not the fields."""

    #: the names of the columns, as in the tool's table
    names: tuple[str, ...] = ()

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []

    def append(self, numbers: dict[str, Any]) -> None:
        """Keeps the numbers that have a column."""
        self.rows.append({name: numbers[name] for name in self.names})

    def run(self: R) -> R:
        """Solves what is left, and returns itself."""
        for _ in self:
            pass
        return self

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns of the tool's table by name, as ``pandas.DataFrame`` takes them; solves what is left.

        Numbers that do not apply are NaN. An event that did not happen is None, and so is the part of a map that was not
        mirrored.
        """
        self.run()
        return {name: np.array([_cell(name, row[name]) for row in self.rows]) for name in self.names}


def _cell(name: str, value: Any) -> Any:
    return np.nan if value is None and name not in ("event", "part") else value
