"""Adhesion laws of the library, as users see them."""

from __future__ import annotations

import inspect
import os
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _asperity
from .._asperity import Law
from ..common.types import AxisOrder
from ..common.words import check
from ..maps.arrays import array_of

__all__ = ["Exponential", "JKR", "LennardJones", "MaugisDugdale", "Morse", "PowerLaw", "VanDerWaals"]


class _Described(Law):
    """A law of a few parameters, whose names are those by which it matches."""

    __match_args__: ClassVar[tuple[str, ...]] = ()
    _values: tuple[Any, ...]

    def __init_subclass__(cls) -> None:
        cls.__module__ = "asperity"
        for index, name in enumerate(cls.__match_args__):
            setattr(cls, name, property(lambda self, index=index: self._values[index]))

    @classmethod
    def _of(cls, law: Law, values: tuple[Any, ...]) -> Any:
        own: Any = Law.__new__(cls, law)
        for value in values:
            if isinstance(value, np.ndarray):
                value.flags.writeable = False
        own._values = values
        return own

    def __getnewargs__(self) -> tuple[Any, ...]:
        texts, _ = self.given
        keys = ("cut_off" if name == "distance" else name for name in self.__match_args__)
        return tuple(texts.get(key, value) for key, value in zip(keys, self._values))

    def __getstate__(self) -> None:
        return None

    def __repr__(self) -> str:
        values = zip(self.__match_args__, self.__getnewargs__())
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in values)})"


class _Formula(_Described):
    """A law that is a formula of a few numbers, with its name in reports; one of them leaves repulsion to a wall."""

    _name: ClassVar[str]

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        kind, none = inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.empty
        names = cls.__match_args__
        known = [inspect.Parameter(name, kind, default=False if name == "cut" else none) for name in names]
        cls.__signature__ = inspect.Signature(known)

    def __new__(cls, *values: Any, **keywords: Any) -> Any:
        check(cls.__name__, keywords, cls.__match_args__)
        given = cls.__signature__.bind_partial(*values, **keywords).arguments
        cut = given.pop("cut", False) if "cut" in cls.__match_args__ else None
        for name in cls.__match_args__:
            if name != "cut" and given.get(name) is None:
                raise TypeError(f"{cls.__name__}() is without {name}: give a number")
        law, numbers = _asperity.law(cls._name, given, cut)
        return cls._of(law, tuple(numbers) if cut is None else (*numbers, bool(cut)))


class Exponential(_Formula):
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

    __match_args__ = ("work_of_adhesion", "range")
    _name = "exponential"


class JKR(_Formula):
    """The law without a range, the limit of Johnson, Kendall and Roberts, as short on each grid as its nodes can follow.

    For contacts of which the work of adhesion is known, and no range. `Report.range` is that of the grid,
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

    __match_args__ = ("work_of_adhesion",)
    _name = "jkr"


class MaugisDugdale(_Formula):
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

    __match_args__ = ("work_of_adhesion", "range")
    _name = "maugis-dugdale"


class LennardJones(_Formula):
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

    __match_args__ = ("work_of_adhesion", "range", "cut")
    _name = "lennard-jones"


class Morse(_Formula):
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

    __match_args__ = ("work_of_adhesion", "range")
    _name = "morse"


class PowerLaw(_Formula):
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

    __match_args__ = ("work_of_adhesion", "range", "exponent")
    _name = "power"


class VanDerWaals(_Formula):
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

    __match_args__ = ("hamaker", "range")
    _name = "van-der-waals"


#: The names of the laws that are formulas, whose numbers are all in a report.
FORMULAS = tuple(kind._name for kind in _Formula.__subclasses__())


class Tabulated(_Described):
    """A law of which the traction is a monotone cubic through the points of a table.

    Parameters
    ----------
    gaps : array_like, shape (N,)
        Gaps, lengths that rise from zero.
    tractions : array_like, shape (N,)
        Tractions, attraction positive; the last one is zero.
    source : str, optional
        File that they come from, as `read` sets it.

    Examples
    --------
    >>> import asperity
    >>> law = asperity.Tabulated([0.0, 1e-9, 2e-9], [50e6, 25e6, 0.0])
    >>> f"{-law.energy(0.0):.3f}"
    '0.050'
    """

    __match_args__ = ("gaps", "tractions", "source")

    def __new__(cls, gaps: ArrayLike, tractions: ArrayLike, source: str | None = None) -> Any:
        return cls._of(*_asperity.tabulated(gaps, tractions, source))

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Any:
        """The law of a file with a gap and a traction on each line.

        Parameters
        ----------
        path : str or path
            A text of two columns, or ``.npy``.
        """
        return Tabulated._of(*_asperity.read_law(path))


class CutOff(_Described):
    """A law that ends at a gap, smoothly: zero from there on, with energy, traction and slope continuous.

    It keeps its work of adhesion, its equilibrium separation, and its traction in contact; the energy that the tail had
    is given back before the end.

    Parameters
    ----------
    law : Law or an object of your own
        Law that reaches further.
    distance : float
        Gap at which it ends, a length: at least a range of the law beyond contact, or beyond its equilibrium
        separation.

    Examples
    --------
    >>> import asperity
    >>> law = asperity.CutOff(asperity.VanDerWaals(hamaker=6e-20, range=0.165e-9), distance=5e-9)
    >>> law.traction(5e-9)
    0.0
    """

    __match_args__ = ("law", "distance")

    def __new__(cls, law: Any, distance: Any) -> Any:
        cut, found = _asperity.cut_off(law, distance)
        return cls._of(cut, (law, found))


class Varying(_Described):
    """A law of which the work of adhesion differs from node to node: energy, traction and slope in proportion to it.

    Parameters
    ----------
    law : Law or an object of your own
        Law that varies; its own work of adhesion > 0 is replaced.
    work_of_adhesion : array_like, shape (Nx, Ny) or (N,)
        Works of adhesion ≥ 0 at the nodes of the heights, energies per area; x along the first axis, unless ``axes`` or
        the dimensions of a DataArray say otherwise.
    axes : {"xy", "yx"}, optional
        Order of the axes of an array; "yx" is that of images. Heights with y along their first axis ask for it.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wetted = np.where(np.arange(64)[:, None] < 32, 0.07, 0.02) * np.ones((64, 64))
    >>> law = asperity.Varying(asperity.Exponential(work_of_adhesion=0.07, range=2e-9), wetted)
    >>> law.energy(0.0)[[0, 63], 0]
    array([-0.07, -0.02])
    """

    __match_args__ = ("law", "work_of_adhesion")

    def __new__(cls, law: Any, work_of_adhesion: ArrayLike, axes: AxisOrder | None = None) -> Any:
        works, is_line = array_of(work_of_adhesion, "works of adhesion", axes)
        own = cls._of(_asperity.varied(law, works), (law, (works[:, 0] if is_line else works).copy()))
        #: whether it is known which axis is x
        own.knows_axes = axes is not None or hasattr(work_of_adhesion, "dims") or is_line
        return own

    def __getnewargs__(self) -> tuple[Any, ...]:
        return (*super().__getnewargs__(), "xy" if self.knows_axes else None)
