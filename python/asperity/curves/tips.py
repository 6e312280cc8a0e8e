"""The equilibria of tips: what a fit asks of a tip, and a paraboloid by the closed forms."""

from __future__ import annotations

from functools import lru_cache
from typing import Any, Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .. import _asperity
from ..common.optional import package
from ..exact import solutions as exact

Array: TypeAlias = NDArray[np.float64]

#: Tabor parameters between the ends of the tables, which are DMT and JKR.
TABOR = np.geomspace(0.01, 50.0, 13)
#: Knots of the tables over the Tabor parameter.
_KNOTS = np.geomspace(0.008, 60.0, 61)
#: Contact radii of the tables for R = E* = w = 1: approaches up to two hundred thousand Tabor lengths.
_RADII = 0.5 * np.sinh(np.linspace(0.0, 7.5, 800))
#: Knots before contact, and the farthest distance.
_APART, _FAR = 100, 1e6


def scipy(module: str) -> Any:
    """A module of SciPy, which is only asked for when a curve is fitted."""
    return package(f"scipy.{module}", "fits need SciPy: pip install 'asperity[fit]'")


class Tip(Protocol):
    """What a fit asks of a tip."""

    #: the radius of a sphere of the same pull-off
    radius: float
    #: models, first the one without adhesion, and how many parameters they have less than the fullest
    fewer: dict[str, int]
    #: Tabor parameters of the fullest; a single one where they are not told, none without adhesion
    tabor: Array
    #: whether lengths and forces go as those of a paraboloid, and its radius, or else the greatest w/E* of the equilibria
    is_smooth: bool
    size: float

    @property
    def what(self) -> str:
        """The tip in words."""

    @property
    def equilibria(self) -> Any:
        """The equilibria of the models, in the order of their names in `fewer`."""

    def adheres(self, name: str) -> bool:
        """Whether a model has a work of adhesion that varies."""

    def load(self, approach: Array) -> Array:
        """Loads without adhesion, for a modulus of one."""

    def approach(self, load: Array) -> Array:
        """Approaches under these loads."""

    def least_work(self, modulus: float, approach: float) -> float:
        """The work of adhesion below which this approach is beyond all equilibria."""

    def holds(self, modulus: float, work: float, tabor: float, before: float) -> bool:
        """Whether there are equilibria, with a range that ends at this distance before contact."""

    def greatest_work(self, modulus: float, tabor: float, before: float) -> float:
        """The greatest work of adhesion that so holds."""

    def check_reach(self, modulus: float, work: float, approach: float) -> str:
        """Refuses what a fit found beyond all equilibria, or tells what speaks against it."""


def even_steps(knots: Array) -> Array:
    """Knots of a curve that lines between them miss as much to one side as to the other: a bias is no noise."""
    found = knots.copy()
    found[1:-1] -= np.diff(knots, 2, axis=0) / 12.0
    return found


def _maugis(tabor: float) -> Array:
    """Approaches and loads of all equilibria, from those apart, for R = E* = w = 1.

    Before contact the traction σ₀ acts within a circle of radius c, and lifts its centre by 2σ₀c/E* and its edge, where
    the gap is the range, by 4σ₀c/(πE*).
    """
    contact = exact.MaugisDugdale(1.0, 1.0, 1.0, 1.0 / tabor).at_contact_radius(_RADII)
    c = contact.adhesion_radius[0] * np.linspace(0.0, 1.0, _APART - 1, endpoint=False)
    apart = np.stack([0.5 * c**2 - 4.0 / np.pi * tabor * c - 1.0 / tabor, -np.pi * tabor * c**2], 1)
    return np.concatenate([[[-_FAR, 0.0]], apart, even_steps(np.stack([contact.approach, contact.load], 1))])


def _limits() -> dict[str, Array]:
    """The equilibria of Hertz, DMT and JKR; the first two are apart without a force."""
    hertz = exact.Hertz(1.0, 1.0).at_contact_radius(_RADII)
    jkr = exact.Jkr(1.0, 1.0, 1.0).at_contact_radius(_RADII)
    apart = np.stack([[-_FAR, -1.0, 0.0], np.zeros(3)], 1)
    loads = {"Hertz": (hertz, 0.0), "DMT": (hertz, 2.0 * np.pi), "JKR": (jkr, 0.0)}
    return {
        name: np.concatenate([apart, even_steps(np.stack([contact.approach, contact.load - pull], 1))])
        for name, (contact, pull) in loads.items()
    }


def flat(knots: Array) -> tuple[Array, Array, None]:
    """Equilibria of one shape."""
    return np.zeros(1), np.concatenate([knots, np.zeros_like(knots)], 1)[None], None


@lru_cache(maxsize=1)
def _smooth() -> Any:
    """The equilibria of a paraboloid, for R = E* = w = 1, by Maugis over the logarithm of the Tabor parameter."""
    shapes = np.log(_KNOTS)
    spline = scipy("interpolate").CubicSpline(shapes, [_maugis(tabor) for tabor in _KNOTS])
    found: dict[str, Any] = {name: flat(knots) for name, knots in _limits().items()}
    found["Maugis"] = shapes, np.concatenate([spline(shapes), spline.derivative()(shapes)], 2), None
    return _asperity.Equilibria([found[name] for name in Paraboloid.fewer])


class Paraboloid:
    """A smooth tip on a half-space, with the adhesion of Maugis and Dugdale."""

    fewer = {"Hertz": 2, "DMT": 1, "Maugis": 0, "JKR": 1}
    tabor, what = TABOR, "a smooth paraboloid on an elastic half-space"
    is_smooth = True

    def __init__(self, radius: float) -> None:
        self.radius = self.size = radius

    @property
    def equilibria(self) -> Any:
        return _smooth()

    def length(self, modulus: float, work: float) -> float:
        """The length (w²R/E*²)^(1/3), over the range the Tabor parameter."""
        return float((work**2 * self.radius / modulus**2) ** (1.0 / 3.0))

    def adheres(self, name: str) -> bool:
        return name != "Hertz"

    def load(self, approach: Array) -> Array:
        return np.asarray(4.0 / 3.0 * np.sqrt(self.radius) * approach**1.5)

    def approach(self, load: Array) -> Array:
        return np.asarray((0.75 / np.sqrt(self.radius) * load) ** (2.0 / 3.0))

    def least_work(self, modulus: float, approach: float) -> float:
        return float((approach / 1.5e5) ** 1.5 * modulus / np.sqrt(self.radius))

    def holds(self, modulus: float, work: float, tabor: float, before: float) -> bool:
        # a longer range would be a part of the baseline
        return self.length(modulus, work) / tabor < before

    def greatest_work(self, modulus: float, tabor: float, before: float) -> float:
        return float(np.sqrt(max(tabor * before, 0.0) ** 3 / self.radius) * modulus)

    def check_reach(self, modulus: float, work: float, approach: float) -> str:
        """Tells of an approach that no tip has; there are equilibria of all."""
        if approach <= self.radius:
            return ""
        return (
            f"the greatest indentation is {approach / self.radius:.3g} times the radius of the tip: give z, force "
            "and radius in one system of units, as m and N, or length_unit='nm', force_unit='nN' and radius='20nm'"
        )
