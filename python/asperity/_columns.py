"""A table of loads that is solved row by row."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

T = TypeVar("T")


class Rows(Generic[T]):
    """An iterator over states, of which the numbers are kept, and not the fields."""

    #: the names of the columns, as in the tool's table
    names: tuple[str, ...] = ()

    def __init__(self) -> None:
        self.rows: list[dict[str, Any]] = []

    def __iter__(self) -> Iterator[T]:
        return self

    def __next__(self) -> T:
        raise StopIteration

    def run(self) -> Any:
        """Solves what is left, and returns itself."""
        for _ in self:
            pass
        return self

    @property
    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns of the tool's table by name, as ``pandas.DataFrame`` takes them; solves what is left."""
        self.run()
        return {name: np.array([row[name] for row in self.rows]) for name in self.names}
