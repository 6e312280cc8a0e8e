"""Functions of users, which are asked for arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray


def read_scales(law: Any) -> tuple[Any, Any]:
    """Work of adhesion and range of an object with the functions of a law, as far as it has them."""
    for method in ("energy", "traction", "slope"):
        if not callable(getattr(law, method, None)):
            raise TypeError(
                f"law is of type {type(law).__name__}, without a method {method}(gap): it must have energy, traction and slope, "
                "each of an array of gaps, or be a law of asperity, as asperity.Exponential(work_of_adhesion, range), or None"
            )
    return getattr(law, "work_of_adhesion", None), getattr(law, "range", None)


def evaluate(function: Callable[..., Any], name: str, of: str, arrays: list[NDArray[np.float64]], one_of_all: bool) -> Any:
    """A function of arrays by its name, at many of what it is a function `of`, in one call."""
    try:
        # what is not finite is refused by its place
        with np.errstate(all="ignore"):
            found = function(*arrays)
    except (ValueError, TypeError) as raised:
        if arrays[0].size == 0 or not _accepts(function, [float(array[0]) for array in arrays]):
            raise
        raise TypeError(
            f"{name} takes one {of} alone, and is given arrays of {of}s: write numpy.where(...) in the place of if, and "
            f"functions of numpy in the place of those of math ({type(raised).__name__}: {raised})"
        ) from raised
    if np.iscomplexobj(found):
        raise TypeError(f"{name} returned complex numbers: it must return real ones")
    values, count = np.asanyarray(found, dtype=np.float64), arrays[0].size
    if one_of_all and values.size == 1:
        return values.repeat(count)
    if values.size != count:
        shape = f"shape {list(values.shape)} for {of}s of shape [{count}]"
        raise ValueError(f"{name} returned an array of {shape}: it must return one value for each {of}")
    return values


def _accepts(function: Callable[..., Any], numbers: list[float]) -> bool:
    """Whether a function takes numbers."""
    try:
        function(*numbers)
    except Exception:
        return False
    return True
