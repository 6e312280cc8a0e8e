"""Functions of users, which are asked for arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray


def called(function: Callable[..., Any], name: str, of: str, arrays: list[NDArray[np.float64]]) -> Any:
    """A function of arrays by its name, at many of what it is a function `of`, in one call."""
    try:
        # what is not finite is refused by its place
        with np.errstate(all="ignore"):
            found = function(*arrays)
    except (ValueError, TypeError) as raised:
        if arrays[0].size == 0 or not _takes(function, [float(array[0]) for array in arrays]):
            raise
        raise TypeError(
            f"{name} takes one {of} alone, and is given arrays of {of}s: write numpy.where(...) in the place of if, and "
            f"functions of numpy in the place of those of math ({type(raised).__name__}: {raised})"
        ) from raised
    if np.iscomplexobj(found):
        raise TypeError(f"{name} returned complex numbers: it must return real ones")
    return found


def _takes(function: Callable[..., Any], numbers: list[float]) -> bool:
    """Whether a function takes numbers."""
    try:
        function(*numbers)
    except Exception:
        return False
    return True
