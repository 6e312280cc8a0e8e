"""The equilibria of tips: what a fit asks of a tip, and that of a paraboloid, in tables."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from . import exact
from ._optional import package
from ._warnings import InputWarning, warn

Array: TypeAlias = NDArray[np.float64]
#: Approaches and loads from bodies apart on, those of the approach and those of the withdrawal, over modulus and work of
#: adhesion.
Equilibria: TypeAlias = Callable[[float, float], tuple[Array, Array]]

#: Tabor parameters between the ends of the tables, which are DMT and JKR.
TABOR = np.geomspace(0.01, 50.0, 13)
#: Knots of the tables over the Tabor parameter.
_KNOTS = np.geomspace(0.008, 60.0, 61)
#: Contact radii of the tables for R = E* = w = 1: approaches up to two hundred thousand Tabor lengths.
_RADII = 0.5 * np.sinh(np.linspace(0.0, 7.5, 1250))


def scipy(module: str) -> Any:
    """A module of SciPy, which is only asked for when a curve is fitted."""
    return package(f"scipy.{module}", "fits need SciPy: pip install 'asperity[fit]'")


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
def _tables() -> Any:
    """The equilibria of Maugis as a spline over the logarithm of the Tabor parameter."""
    return scipy("interpolate").CubicSpline(np.log(_KNOTS), [_maugis(tabor) for tabor in _KNOTS])


@lru_cache(maxsize=1)
def _limits() -> dict[str, Array]:
    """The equilibria of Hertz, DMT and JKR, the first two apart without a force."""
    hertz = exact.Hertz(1.0, 1.0).at_contact_radius(_RADII)
    dmt = [np.append(0.0, hertz.approach), np.append(0.0, hertz.load - 2.0 * np.pi)]
    jkr = exact.Jkr(1.0, 1.0, 1.0).at_contact_radius(_RADII)
    return {
        "Hertz": np.stack([hertz.approach, hertz.load]),
        "DMT": np.stack(dmt),
        "JKR": np.stack([jkr.approach, jkr.load]),
    }


class Tip(Protocol):
    """What a fit asks of a tip."""

    #: the radius of a sphere of the same pull-off
    radius: float
    #: models, first that without adhesion, and how many parameters they have less than the fullest
    fewer: dict[str, int]
    #: Tabor parameters of the fullest; a single one where they are not told, none without adhesion
    tabor: Array

    @property
    def what(self) -> str:
        """What a curve of another tip is not of."""

    def limit(self, name: str) -> Equilibria:
        """The equilibria of a model with fewer parameters."""

    def at(self, log_tabor: float) -> Equilibria:
        """The equilibria of the fullest model."""

    def load(self, approach: Array) -> Array:
        """Loads without adhesion, for a modulus of one."""

    def approach(self, load: Array) -> Array:
        """Approaches under these loads."""

    def least_work(self, modulus: float, approach: float) -> float:
        """The work of adhesion below which this approach is beyond all equilibria."""

    def holds(self, modulus: float, work: float, tabor: float, before: float) -> bool:
        """Whether there are equilibria, with a range that ends at this distance before contact."""

    def check_reach(self, modulus: float, work: float, approach: float) -> None:
        """Refuses what a fit found beyond all equilibria, or warns of it."""


class Paraboloid:
    """A smooth tip on a half-space, with the adhesion of Maugis and Dugdale."""

    fewer = {"Hertz": 2, "DMT": 1, "Maugis": 0, "JKR": 1}
    tabor, what = TABOR, "a smooth paraboloid on an elastic half-space"

    def __init__(self, radius: float) -> None:
        self.radius = radius

    def limit(self, name: str) -> Equilibria:
        return partial(self._scaled, _limits()[name])

    def at(self, log_tabor: float) -> Equilibria:
        return partial(self._scaled, np.asarray(_tables()(log_tabor)))

    def _scaled(self, table: Array, modulus: float, work: float) -> tuple[Array, Array]:
        found = table * np.array([[self.length(modulus, work)], [work * self.radius]])
        return found, found

    def length(self, modulus: float, work: float) -> float:
        """The length (w²R/E*²)^(1/3), over the range the Tabor parameter."""
        return float((work**2 * self.radius / modulus**2) ** (1.0 / 3.0))

    def load(self, approach: Array) -> Array:
        return np.asarray(4.0 / 3.0 * np.sqrt(self.radius) * approach**1.5)

    def approach(self, load: Array) -> Array:
        return np.asarray((0.75 / np.sqrt(self.radius) * load) ** (2.0 / 3.0))

    def least_work(self, modulus: float, approach: float) -> float:
        return float((approach / 1.5e5) ** 1.5 * modulus / np.sqrt(self.radius))

    def holds(self, modulus: float, work: float, tabor: float, before: float) -> bool:
        # a longer range would be a part of the baseline
        return self.length(modulus, work) / tabor < before

    def check_reach(self, modulus: float, work: float, approach: float) -> None:
        """Warns of an approach that no tip has; there are equilibria of all."""
        if approach > self.radius:
            warn(
                f"the greatest indentation is {approach / self.radius:.3g} times the radius of the tip: give z, force "
                "and radius in one system of units, as m and N, or length_unit='nm', force_unit='nN' and radius='20nm'",
                InputWarning,
            )


def fold(where: Array, reached: Array, load: Array) -> int:
    """The point before the greatest jump on the way along equilibria, or the steepest fall of the load.

    What was reached before is the greatest place so far; places behind it are skipped.
    """
    skipped = where[1:] <= reached[:-1]
    if not skipped.any():
        return int(np.argmin(np.diff(load) / np.diff(where)))
    changes = np.flatnonzero(np.diff(skipped, prepend=False, append=False))
    begins, ends = changes[::2], changes[1::2]
    return int(begins[np.argmax(np.abs(load[ends] - load[begins]))])
