"""A table of loads that is solved row by row."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T")
R = TypeVar("R", bound="Rows[Any]")


class Rows(Iterator[T]):
    """An iterator over states, of which the numbers are kept, and not the fields."""

    #: the names of the columns, as in the tool's table
    names: tuple[str, ...] = ()

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []

    def run(self: R) -> R:
        """Solves what is left, and returns itself."""
        for _ in self:
            pass
        return self

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns of the tool's table by name, as ``pandas.DataFrame`` takes them; solves what is left."""
        self.run()
        return {name: np.array([row[name] for row in self.rows]) for name in self.names}
