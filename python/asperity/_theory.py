"""Theories of rough surfaces on an elastic half-space, without adhesion: approximations by a few statistics."""

from __future__ import annotations

import functools
import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _surface
from ._formula import Formula
from ._surface import PowerSpectralDensity
from ._topography import Heights, Topography, taken
from ._types import AxisOrder, Lengths, Quantity
from ._units import Quantities

if TYPE_CHECKING:
    from ._contact import Contact

#: Persson's factor γ of the elastic energy; Almqvist, Campañá, Prodanov and Persson (2011).
_ENERGY = 0.45

_erf = np.vectorize(math.erf, otypes=[float])


T = TypeVar("T", bound="_Theory")


class _Theory(Formula):
    """A theory of a rough surface, over the mean pressure, with its title in figures."""

    title: ClassVar[str]

    def __post_init__(self) -> None:
        super().__post_init__()
        for name in self._names():
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise ValueError(f"{name} is {value:g}: it must be positive and finite")

    @classmethod
    def of(
        cls: type[T],
        heights: Heights,
        lengths: Lengths | None = None,
        *,
        modulus: Quantity,
        axes: AxisOrder | None = None,
    ) -> T:
        """The theory of a surface, by its `asperity.surface.statistics` and its spectrum.

        Parameters
        ----------
        heights, lengths, axes
            Those of `asperity.surface.statistics`; the side lengths are needed, unless the heights bring them.
        modulus : float
            Contact modulus E*, a pressure.
        """
        return cls._of(_surface_of(heights, lengths, axes, modulus), modulus)

    @classmethod
    def _of(cls: type[T], surface: Topography, modulus: Quantity) -> T:
        raise NotImplementedError

    def _pressures(self, mean_pressure: ArrayLike) -> NDArray[np.float64]:
        pressures = np.asarray(self._read("mean_pressure", mean_pressure), dtype=np.float64)
        if not np.all(pressures >= 0):
            raise ValueError(f"mean_pressure is {pressures.min():g}: without adhesion it must be zero or more")
        return pressures


@dataclass(frozen=True, repr=False)
class Persson(_Theory):
    """Persson's theory of the contact area, and of the mean gap by the spectrum of a surface.

    The contact fraction is erf(√2 p̄/(E*h')), with the rms slope h' of the whole gradient. At light loads its slope is
    √(8/π) = 1.6, and that of solved surfaces is about 2. The mean gap is ∫ (dU/dp) dp/p from p̄ on, with the elastic
    energy per area U = ½πE* ∫ q²C P (γ + (1 − γ)P²) dq, where P is the contact fraction by the waves up to q, and γ =
    0.45. Mean gaps of solves are some 5 % from it up to a contact fraction of a half, and larger near to full contact.

    Persson (2001); Yang and Persson (2008); Almqvist, Campañá, Prodanov and Persson (2011).

    Parameters
    ----------
    rms_slope : float
        Root mean square h' of the slope, √⟨|∇h|²⟩.
    modulus : float
        Contact modulus E*, a pressure.
    spectrum : PowerSpectralDensity, optional
        Power spectral density of the surface, which the mean gap needs; in SI units if the modulus has a unit.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(128, "1um", rms_slope=0.1, k_s=16, seed=1)
    >>> theory = asperity.exact.Persson.of(rough, modulus="1GPa")
    >>> found = asperity.solve(rough, modulus="1GPa", mean_pressure="50MPa")
    >>> area = theory.contact_fraction("50MPa")
    >>> f"{area:.2f} and {found.statistics.corrected_contact_fraction:.2f} of the area"
    '0.68 and 0.75 of the area'
    """

    rms_slope: float
    modulus: Quantity
    spectrum: PowerSpectralDensity | None = field(default=None, compare=False)

    title = "Persson"
    about = (
        "rough surface without adhesion: contact fraction erf(√2 p̄/(E*h')), Persson (2001), and mean gap ∫ (dU/dp) dp/p "
        "by the elastic energy U of the spectrum, Yang and Persson (2008)"
    )

    @classmethod
    def _of(cls, surface: Topography, modulus: Quantity) -> Persson:
        return cls(_surface.statistics(surface).rms_slope, modulus, _surface.spectrum(surface))

    def contact_fraction(self, mean_pressure: ArrayLike) -> Any:
        """Contact fraction at mean pressures p̄ ≥ 0."""
        reduced = self._pressures(mean_pressure) / (float(self.modulus) * self.rms_slope)
        return _erf(math.sqrt(2) * reduced)[()]

    def mean_gap(self, mean_pressure: ArrayLike) -> Any:
        """Mean gap at mean pressures p̄ > 0, a length; without a load it is infinite."""
        if self.spectrum is None:
            raise ValueError(
                "the mean gap needs the spectrum of the surface: give spectrum, or make the theory by "
                "asperity.exact.Persson.of(heights, modulus=...)"
            )
        q, densities, waves, cell = self.spectrum
        kept = densities * q > 0
        q, shares = q[kept], (densities * waves * cell)[kept]
        # the waves of an entry are, in the mean, on top of half of themselves and of all that are longer
        slopes = np.cumsum(q**2 * shares) - 0.5 * q**2 * shares
        inverse = np.sqrt(2 / slopes)
        reduced = self._pressures(mean_pressure)[..., None] * inverse / float(self.modulus)
        return np.sum(q * shares * inverse * _separation(reduced), axis=-1)[()] / (2 * math.sqrt(math.pi))


@functools.cache
def _separations() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Logarithms of x, and the integrals of (γ + 3(1 − γ) erf²y) e^(−y²)/y from x on, by the trapezoidal rule."""
    logs = np.linspace(math.log(1e-6), math.log(8.0), 8001)
    x = np.exp(logs)
    slopes = (_ENERGY + 3 * (1 - _ENERGY) * _erf(x) ** 2) * np.exp(-(x**2))
    steps = 0.5 * (slopes[1:] + slopes[:-1]) * np.diff(logs)
    return logs, np.append(np.cumsum(steps[::-1])[::-1], 0.0)


def _separation(x: NDArray[np.float64]) -> NDArray[np.float64]:
    logs, integrals = _separations()
    with np.errstate(divide="ignore"):
        log = np.log(x)
    # below the table the integrand is γ/y
    return np.asarray(np.interp(log, logs, integrals) + _ENERGY * np.maximum(logs[0] - log, 0.0))


@dataclass(frozen=True, repr=False)
class GreenwoodWilliamson(_Theory):
    """The theory of Greenwood and Williamson: spheres of one radius, with heights of a normal distribution.

    Each asperity is a sphere of Hertz, and does not feel the others. So the theory is for light loads alone, and even
    there its area grows slower than the load. Density, radius and rms height of the asperities are those that McCool
    found for a random surface by Nayak's theory, and depend on the shortest waves of the map. Areas larger than the
    nominal one are NaN.

    Greenwood and Williamson (1966); McCool (1986).

    Parameters
    ----------
    rms_height : float
        Root mean square of the heights, a length: m₀ = ⟨h²⟩.
    rms_slope : float
        Root mean square of the slope, √⟨|∇h|²⟩: m₂ is half of its square.
    rms_curvature : float
        Root mean square of ½∇²h, one over a length: m₄ is 3/2 of its square.
    modulus : float
        Contact modulus E*, a pressure.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(128, "1um", rms_slope=0.1, k_s=16, seed=1)
    >>> theory = asperity.exact.GreenwoodWilliamson.of(rough, modulus="1GPa")
    >>> f"{1e-12 * theory.asperity_density:.0f} asperities of the radius {1e9 * theory.asperity_radius:.0f} nm"
    '83 asperities of the radius 180 nm'
    """

    rms_height: Quantity
    rms_slope: float
    rms_curvature: Quantity
    modulus: Quantity

    title = "Greenwood and Williamson"
    about = (
        "rough surface of spheres that do not feel each other: contact fraction πηRσ F₁(d/σ) at "
        "p̄ = 4/3 E*η√R σ^(3/2) F₁.₅(d/σ), Fₙ(x) = ∫ (s − x)ⁿ φ(s) ds from x on; Greenwood and Williamson (1966)"
    )

    def __post_init__(self) -> None:
        super().__post_init__()
        if not self._nayak > 0.8968:
            raise ValueError(
                f"Nayak's parameter by rms_height, rms_slope and rms_curvature is {self._nayak:.3g}: it must be more than "
                "0.8968, and of a random surface it is 1.5 at least"
            )

    @classmethod
    def _of(cls, surface: Topography, modulus: Quantity) -> GreenwoodWilliamson:
        found = _surface.statistics(surface)
        unit = "m" if isinstance(modulus, str) else None
        return cls(
            f"{found.rms_height:.8g}m" if unit else found.rms_height,
            found.rms_slope,
            f"{found.rms_curvature:.8g}m-1" if unit else found.rms_curvature,
            modulus,
        )

    @property
    def _moments(self) -> tuple[float, float, float]:
        """Spectral moments m₀, m₂ and m₄ along a direction."""
        return float(self.rms_height) ** 2, 0.5 * self.rms_slope**2, 1.5 * float(self.rms_curvature) ** 2

    @property
    def _nayak(self) -> float:
        m0, m2, m4 = self._moments
        return m0 * m4 / m2**2

    @property
    def asperity_density(self) -> float:
        """Number η of asperities per area, m₄/(6π√3 m₂)."""
        _, m2, m4 = self._moments
        return m4 / (6 * math.pi * math.sqrt(3) * m2)

    @property
    def asperity_radius(self) -> float:
        """Radius R of their curvature, 3√π/(8√m₄)."""
        return 3 * math.sqrt(math.pi / self._moments[2]) / 8

    @property
    def rms_asperity_height(self) -> float:
        """Root mean square σ of their heights, √((1 − 0.8968/α) m₀) with Nayak's parameter α."""
        return math.sqrt((1 - 0.8968 / self._nayak) * self._moments[0])

    def contact_fraction(self, mean_pressure: ArrayLike) -> Any:
        """Contact fraction at mean pressures p̄ ≥ 0."""
        density, radius, height = self.asperity_density, self.asperity_radius, self.rms_asperity_height
        scale = 4 / 3 * float(self.modulus) * density * math.sqrt(radius) * height**1.5
        loads, areas = _of_normal_heights()
        with np.errstate(divide="ignore"):
            log = np.log(self._pressures(mean_pressure) / scale)
        found = math.pi * density * radius * height * np.exp(np.interp(log, loads, areas, left=-np.inf, right=np.nan))
        return np.where(found <= 1, found, np.nan)[()]


@functools.cache
def _of_normal_heights() -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Logarithms of F₁.₅ and F₁ of a standard normal distribution, at separations from far to near."""
    separations = np.linspace(12.0, -60.0, 1441)
    # with s = x + u² the integrands are smooth, and the trapezoidal rule has the integrals to rounding
    step = 0.01
    u = np.arange(0.0, 8.4, step)
    densities = np.exp(-0.5 * (separations[:, None] + u**2) ** 2) * (2 * step / math.sqrt(2 * math.pi))
    return np.log(densities @ u**4), np.log(densities @ u**3)


def _surface_of(heights: Heights, lengths: Lengths | None, axes: AxisOrder | None, modulus: Quantity) -> Topography:
    """The surface of a theory, in metres where the numbers of the call have units."""
    quantities = Quantities()
    sides = quantities.read("lengths", lengths)
    quantities.read("modulus", modulus)
    return taken(heights, sides, axes, quantities.are_si())


def beside(contact: Contact) -> tuple[Persson, GreenwoodWilliamson]:
    """The theories of a contact problem that has no more than they have."""
    beyond = [*contact.beyond_theory, *["a line"] * (contact.topography.heights.shape[1] == 1)]
    if beyond:
        raise ValueError(
            "theories are of a rough half-space without adhesion at a hard wall, with a periodic boundary, and this is of "
            f"{', '.join(beyond)}: leave theory out"
        )
    modulus = f"{contact.modulus!r}Pa" if contact.pressure_unit else contact.modulus
    surface = contact.topography
    return Persson.of(surface, modulus=modulus), GreenwoodWilliamson.of(surface, modulus=modulus)
