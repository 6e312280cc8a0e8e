"""Adhesion laws that are formulas of a few numbers."""

from __future__ import annotations

from typing import Any, ClassVar, TypeVar

from .. import _asperity
from ..common.types import Quantity
from ..common.words import suggests
from .law import ParameterLaw

__all__ = ["Exponential", "JKR", "LennardJones", "MaugisDugdale", "Morse", "PowerLaw", "VanDerWaals"]

F = TypeVar("F", bound="Formula")


class Formula(ParameterLaw):
    """A law that is a formula of numbers, by its name in reports."""

    _name: ClassVar[str]

    @classmethod
    def _with(cls: type[F], numbers: dict[str, Any], cut: bool | None = None) -> F:
        """The law with numbers by their names; one that is cut leaves the repulsion to a wall."""
        for name, number in numbers.items():
            if number is None:
                raise TypeError(f"{cls.__name__}() is without {name}: give a number")
        law, values = _asperity.law(cls._name, numbers, cut)
        return cls._from(law, tuple(values) if cut is None else (*values, bool(cut)))


class Exponential(Formula):
    """The exponential law, φ(g) = −w exp(−g/ρ).

    Parameters
    ----------
    work_of_adhesion : float
        Work of adhesion w ≥ 0, an energy per area.
    range : float
        Range ρ > 0, a length.

    Examples
    --------
    >>> import asperity
    >>> law = asperity.Exponential(work_of_adhesion=0.05, range=2e-9)
    >>> law.energy(0.0)
    -0.05
    """

    __module__ = "asperity"
    __match_args__ = ("work_of_adhesion", "range")
    _name = "exponential"

    @suggests
    def __new__(cls, work_of_adhesion: Quantity, range: Quantity) -> Exponential:
        return cls._with({"work_of_adhesion": work_of_adhesion, "range": range})

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion w, an energy per area."""
        return float(self._values[0])

    @property
    def range(self) -> float:
        """Range ρ, a length."""
        return float(self._values[1])


class JKR(Formula):
    """The law without a range, the limit of Johnson, Kendall and Roberts, as short on each grid as its nodes can follow.

    For contacts with a known work of adhesion, and no known range. `Report.range` is the range on the grid,
    √(13wΔx/E*). By itself the law attracts in contact alone.

    Parameters
    ----------
    work_of_adhesion : float
        Work of adhesion w ≥ 0, an energy per area.

    Examples
    --------
    >>> import asperity
    >>> tip = asperity.surface.paraboloid(64, 0.36, radius=2.0)
    >>> law = asperity.JKR(work_of_adhesion=2e-5)
    >>> found = asperity.pull_off(tip, modulus=1.0, boundary="free", law=law)
    >>> exact = -asperity.exact.Jkr(2.0, 1.0, 2e-5).pull_off().load
    >>> abs(found.limit_force / exact - 1) < found.limit_error < 0.07
    True
    """

    __module__ = "asperity"
    __match_args__ = ("work_of_adhesion",)
    _name = "jkr"

    @suggests
    def __new__(cls, work_of_adhesion: Quantity) -> JKR:
        return cls._with({"work_of_adhesion": work_of_adhesion})

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion w, an energy per area."""
        return float(self._values[0])


class MaugisDugdale(Formula):
    """The law of Maugis and Dugdale: a constant traction w/ρ where the gap is below ρ.

    Parameters
    ----------
    work_of_adhesion : float
        Work of adhesion w ≥ 0, an energy per area.
    range : float
        Range ρ > 0, a length.

    Examples
    --------
    >>> import asperity
    >>> asperity.MaugisDugdale(work_of_adhesion=1e-4, range=2e-3).traction([0.0, 3e-3])
    array([0.05, 0.  ])
    """

    __module__ = "asperity"
    __match_args__ = ("work_of_adhesion", "range")
    _name = "maugis-dugdale"

    @suggests
    def __new__(cls, work_of_adhesion: Quantity, range: Quantity) -> MaugisDugdale:
        return cls._with({"work_of_adhesion": work_of_adhesion, "range": range})

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion w, an energy per area."""
        return float(self._values[0])

    @property
    def range(self) -> float:
        """Range ρ, a length."""
        return float(self._values[1])


class LennardJones(Formula):
    """The law of Lennard-Jones between two half-spaces, φ'(g) = 8w/3z₀ (x³ − x⁹) with x = z₀/g.

    It attracts beyond the equilibrium separation z₀, and repels below: for a solve with ``wall="none"``, where
    contact is where it repels. For one with ``wall="hard"`` it has to be cut at z₀, from which the gap counts then.

    Parameters
    ----------
    work_of_adhesion : float
        Work of adhesion w > 0, an energy per area.
    range : float
        Distance of rest z₀ > 0, a length.
    cut : bool
        Leaves the repulsion to a wall at z₀: x = z₀/(z₀ + g).

    Examples
    --------
    >>> import asperity
    >>> law = asperity.LennardJones(work_of_adhesion=0.05, range=3e-10)
    >>> law.traction(3e-10), bool(law.traction(2.9e-10) < 0)
    (0.0, True)
    """

    __module__ = "asperity"
    __match_args__ = ("work_of_adhesion", "range", "cut")
    _name = "lennard-jones"

    @suggests
    def __new__(cls, work_of_adhesion: Quantity, range: Quantity, cut: bool = False) -> LennardJones:
        return cls._with({"work_of_adhesion": work_of_adhesion, "range": range}, cut)

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion w, an energy per area."""
        return float(self._values[0])

    @property
    def range(self) -> float:
        """Distance of rest z₀, a length."""
        return float(self._values[1])

    @property
    def cut(self) -> bool:
        """Whether a wall at z₀ has the repulsion."""
        return bool(self._values[2])


class Morse(Formula):
    """The law of Morse, φ(g) = w (e² − 2e) with e = exp(−g/ρ): it attracts at g > 0, and repels at g < 0.

    With ``wall="none"`` it keeps the surfaces apart by itself; with a wall at g = 0 the attraction is what counts.

    Parameters
    ----------
    work_of_adhesion : float
        Work of adhesion w > 0, an energy per area.
    range : float
        Range ρ > 0, a length.

    Examples
    --------
    >>> import asperity
    >>> asperity.Morse(work_of_adhesion=0.05, range=5e-10).energy(0.0)
    -0.05
    """

    __module__ = "asperity"
    __match_args__ = ("work_of_adhesion", "range")
    _name = "morse"

    @suggests
    def __new__(cls, work_of_adhesion: Quantity, range: Quantity) -> Morse:
        return cls._with({"work_of_adhesion": work_of_adhesion, "range": range})

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion w, an energy per area."""
        return float(self._values[0])

    @property
    def range(self) -> float:
        """Range ρ, a length."""
        return float(self._values[1])


class PowerLaw(Formula):
    """A power law, φ(g) = −w (1 + g/nρ)⁻ⁿ. Its tail reaches far: `CutOff` ends it.

    Parameters
    ----------
    work_of_adhesion : float
        Work of adhesion w ≥ 0, an energy per area.
    range : float
        Range ρ > 0, a length.
    exponent : float
        Exponent n > 0 of the energy.

    Examples
    --------
    >>> import asperity
    >>> asperity.PowerLaw(work_of_adhesion=0.05, range=2e-9, exponent=3).traction(0.0)
    25000000.0
    """

    __module__ = "asperity"
    __match_args__ = ("work_of_adhesion", "range", "exponent")
    _name = "power"

    @suggests
    def __new__(cls, work_of_adhesion: Quantity, range: Quantity, exponent: float) -> PowerLaw:
        return cls._with({"work_of_adhesion": work_of_adhesion, "range": range, "exponent": exponent})

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion w, an energy per area."""
        return float(self._values[0])

    @property
    def range(self) -> float:
        """Range ρ, a length."""
        return float(self._values[1])

    @property
    def exponent(self) -> float:
        """Exponent n of the energy."""
        return float(self._values[2])


class VanDerWaals(Formula):
    """The van der Waals attraction of two half-spaces, φ(g) = −A/12π(D₀ + g)². Its tail reaches far: `CutOff` ends it.

    Parameters
    ----------
    hamaker : float
        Hamaker's constant A ≥ 0, an energy.
    range : float
        Distance D₀ > 0 between the surfaces in contact, a length, often taken to be 0.165 nm.

    Examples
    --------
    >>> import asperity
    >>> law = asperity.VanDerWaals(hamaker=6e-20, range=0.165e-9)
    >>> f"work of adhesion {-law.energy(0.0):.4f} J/m²"
    'work of adhesion 0.0585 J/m²'
    """

    __module__ = "asperity"
    __match_args__ = ("hamaker", "range")
    _name = "van-der-waals"

    @suggests
    def __new__(cls, hamaker: Quantity, range: Quantity) -> VanDerWaals:
        return cls._with({"hamaker": hamaker, "range": range})

    @property
    def hamaker(self) -> float:
        """Hamaker's constant A, an energy."""
        return float(self._values[0])

    @property
    def range(self) -> float:
        """Distance D₀ between the surfaces in contact, a length."""
        return float(self._values[1])


#: The names of the laws that are formulas, whose numbers are all in a report.
FORMULAS = tuple(
    kind._name for kind in (Exponential, JKR, MaugisDugdale, LennardJones, Morse, PowerLaw, VanDerWaals)
)
