"""A table of loads that is solved row by row."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from ._control import Load
from ._scene import Scene
from ._solution import Solution

T = TypeVar("T")
R = TypeVar("R", bound="Rows[Any]")


class Rows(Iterator[T]):
    """An iterator over states, of which the numbers are kept, and not the fields."""

    def __init__(
        self,
        scene: Scene,
        loads: list[Load],
        start: Any,
        observe: Any,
        stiffness: bool = False,
        path: tuple[int, float, float, bool] | None = None,
    ) -> None:
        self.rows: list[dict[str, Any]] = []
        self._scene, self._loads, self._observe, self._ended = scene, loads, observe, False
        #: the names of the columns, as in the tool's table
        self.names = tuple(scene.problem.begin(loads, scene.start(start), stiffness, path))

    def _solve(self) -> Solution:
        """The next solution, whose row is kept."""
        found = None if self._ended else self._scene.problem.next(self._observe)
        if found is None:
            self._ended = True
            raise StopIteration
        if found["raised"] is None:
            numbers = {**found["row"], "seed": self._scene.topography.seed}
            self.rows.append({name: numbers[name] for name in self.names})
            # ended by the observer: it goes no further
            self._ended = numbers["status"] == "stopped"
        return self._scene.solution(found)

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
