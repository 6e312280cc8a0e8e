"""The equilibria of a smooth tip, in tables."""

from __future__ import annotations

import importlib
from functools import lru_cache
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import exact

Array: TypeAlias = NDArray[np.float64]

#: Tabor parameters between the ends of the tables, beside DMT and JKR, which are the limits.
TABOR = np.geomspace(0.01, 50.0, 13)
#: Knots of the tables over the Tabor parameter.
_KNOTS = np.geomspace(0.008, 60.0, 61)
#: Contact radii of the tables for R = E* = w = 1: approaches up to two hundred thousand Tabor lengths.
_RADII = 0.5 * np.sinh(np.linspace(0.0, 7.5, 1250))


def scipy(module: str) -> Any:
    """A module of SciPy, which is only asked for when a curve is fitted."""
    try:
        return importlib.import_module(f"scipy.{module}")
    except ImportError as error:
        raise ImportError("fits need SciPy: pip install 'asperity[fit]'") from error


def _maugis(tabor: float) -> Array:
    """Approaches and loads of all equilibria, from those apart, for R = E* = w = 1.

    Before contact the traction σ₀ acts within a circle of radius c, and lifts its centre by 2σ₀c/E* and its edge, where
    the gap is the range, by 4σ₀c/(πE*).
    """
    contact = exact.MaugisDugdale(1.0, 1.0, 1.0, 1.0 / tabor).at_contact_radius(_RADII)
    c = contact.adhesion_radius[0] * np.linspace(0.0, 1.0, 200, endpoint=False)
    apart = np.stack([0.5 * c**2 - 4.0 / np.pi * tabor * c - 1.0 / tabor, -np.pi * tabor * c**2])
    return np.concatenate([apart, [contact.approach, contact.load]], axis=1)


@lru_cache(maxsize=1)
def tables() -> Any:
    """The equilibria of Maugis as a spline over the logarithm of the Tabor parameter."""
    return scipy("interpolate").CubicSpline(np.log(_KNOTS), [_maugis(tabor) for tabor in _KNOTS])


@lru_cache(maxsize=1)
def limits() -> dict[str, Array]:
    """The equilibria of Hertz, DMT and JKR, the first two apart without a force."""
    hertz = exact.Hertz(1.0, 1.0).at_contact_radius(_RADII)
    dmt = [np.append(0.0, hertz.approach), np.append(0.0, hertz.load - 2.0 * np.pi)]
    jkr = exact.Jkr(1.0, 1.0, 1.0).at_contact_radius(_RADII)
    return {
        "Hertz": np.stack([hertz.approach, hertz.load]),
        "DMT": np.stack(dmt),
        "JKR": np.stack([jkr.approach, jkr.load]),
    }


def fold(where: Array, load: Array) -> tuple[int, int]:
    """The ends of the greatest fall of the load at which equilibria go back, or the place at which it is steepest."""
    steps, falls = np.diff(where), np.maximum(-np.diff(load), 0.0)
    back = np.concatenate([[0], (steps <= 0.0).astype(int), [0]])
    begins, ends = np.flatnonzero(np.diff(back) == 1), np.flatnonzero(np.diff(back) == -1)
    if begins.size == 0:
        steep = int(np.argmax(falls / np.maximum(steps, 1e-300)))
        return steep, steep + 1
    greatest = int(np.argmax([abs(load[end] - load[begin]) for begin, end in zip(begins, ends)]))
    return int(begins[greatest]), int(ends[greatest])
