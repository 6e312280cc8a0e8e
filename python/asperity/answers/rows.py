"""A table of loads that is solved row by row."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any, TypeVar
from weakref import WeakValueDictionary

import numpy as np
from numpy.typing import NDArray

from ..common.optional import package
from ..common.progress import progress
from ..laws import identity as _law
from .posed import Posed
from .solution import Solution

#: A file for the rows, a folder for fields, and whether to start over.
File = tuple[str | os.PathLike[str] | None, str | os.PathLike[str] | None, bool]

T = TypeVar("T")
R = TypeVar("R", bound="Rows[Any]")

#: The last tables of this process by their files.
_TABLES: WeakValueDictionary[str, Rows[Any]] = WeakValueDictionary()


class Rows(Iterator[T]):
    """An iterator over states that keeps their numbers, and not their fields."""

    def __init__(
        self, contact: Posed, way: str, keys: list[dict[str, Any]], start: Any, observe: Any, file: File
    ) -> None:
        out, fields, force = file
        if out is None and (fields is not None or force):
            raise ValueError("fields and force are of the table in a file: give out, too")
        self._contact, self._observe, self._ended = contact, observe, False
        kept = fields if fields is None else os.path.abspath(fields)
        path = None if out is None else os.path.abspath(out)
        table = None if path is None else (path, kept, force, *_law.fields(contact.own_law))
        seed, first = contact.topography.seed, contact._start(start)
        try:
            (names, rows), self._loads = contact.problem.begin(way, keys, first, (seed, table), observe)
        except BlockingIOError:
            own = _TABLES.get(path or "")
            if own is None:
                raise
            raise ValueError(f"{path} is held by a table of this process, {own!s}: run() that, or delete it by del") from None
        if path is not None:
            _TABLES[path] = self
        #: the names of the columns, as in the tool's table
        self.names = tuple(names)
        self.rows: list[dict[str, Any]] = [self._row(row) for row in rows]
        self._seconds_left: float | None = None
        self._keep(contact.problem.pace())

    def __getstate__(self) -> dict[str, Any]:
        # a table travels complete, and without its view of the memory of this process
        return {**self.run().__dict__, "_observe": None}

    def _solve(self) -> tuple[Solution, dict[str, Any]]:
        """The next solution, and its row, which is kept."""
        with self._contact.turns:
            found = None if self._ended else self._contact.problem.next(self._observe)
            if found is None:
                self._ended, self._seconds_left, self._observe = True, None, None
                raise StopIteration
            row = self._row(found["row"]) if found["raised"] is None else {}
            if row:
                self.rows.append(row)
                # ended by the observer: it goes no further
                self._ended = row["status"] == "stopped"
            self._keep(found["pace"])
            return self._contact._solution(found), row

    def _row(self, found: dict[str, Any]) -> dict[str, Any]:
        """The columns of a row."""
        return {name: found.get(name) for name in self.names}

    def _keep(self, pace: tuple[float | None, str] | None) -> None:
        """Keeps the time that is left of a cycle, and shows its pace."""
        if pace is not None:
            self._seconds_left, told = pace
            if isinstance(self._observe, progress):
                self._observe._show_pace(told)

    def run(self: R) -> R:
        """Solves what is left, and returns itself."""
        for _ in self:
            pass
        return self

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns of the tool's table by name, as ``pandas.DataFrame`` takes them; solves what is left.

        The rows that a file had come first; what is not finite in them is NaN.

        Numbers that do not apply are NaN. An event that did not happen is None, and so are the part of a map that was
        not mirrored, and the branch of an equilibrium that has none.
        """
        self.run()
        return {name: np.array([_cell(name, row[name]) for row in self.rows]) for name in self.names}

    def to_dataframe(self) -> Any:
        """The columns as a table of pandas; solves what is left.

        Returns
        -------
        pandas.DataFrame
        """
        pandas = package("pandas", "to_dataframe needs pandas: python -m pip install pandas")
        return pandas.DataFrame(self.columns)


def _cell(name: str, value: Any) -> Any:
    return np.nan if value is None and name not in ("branch", "event", "part") else value
