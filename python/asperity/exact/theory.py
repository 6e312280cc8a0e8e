"""Theories of rough surfaces on an elastic half-space, without adhesion: approximations by a few statistics."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, ClassVar, TypeVar

from numpy.typing import ArrayLike

from .. import _asperity, surface
from ..common.types import AxisOrder, Lengths, Quantity
from ..common.units import in_si
from ..maps.heights import Heights, convert_heights
from ..maps.topography import Topography
from ..surface import PowerSpectralDensity
from .formula import Formula

T = TypeVar("T", bound="_Theory")


class _Theory(Formula):
    """A theory of a rough surface, over the mean pressure, with its title in figures."""

    title: ClassVar[str]

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
            As `asperity.surface.statistics` takes them; the side lengths are needed, unless the heights bring them.
        modulus : float
            Contact modulus E*, a pressure.
        """
        sides, number, is_si = in_si(lengths=lengths, modulus=modulus)
        theory = cls._by(convert_heights(heights, sides, axes, is_si), number)
        return theory._in_si({"modulus": str(modulus)}) if is_si else theory

    @classmethod
    def _by(cls: type[T], topography: Topography, modulus: float) -> T:
        raise NotImplementedError

    def contact_fraction(self, mean_pressure: ArrayLike) -> Any:
        """Contact fraction at mean pressures p̄ ≥ 0."""
        return self._of.contact_fraction(self._read("mean_pressure", mean_pressure))


@dataclass(frozen=True, repr=False)
class Persson(_Theory):
    """Persson's theory of the contact area, and of the mean gap by the spectrum of a surface.

    The contact fraction is erf(√2 p̄/(E*h')), with the rms slope h' of the whole gradient. At light loads its slope is
    √(8/π) = 1.6, and the slope of solved surfaces is about 2. The mean gap is ∫ (dU/dp) dp/p from p̄ on, with the
    elastic energy per area U = ½πE* ∫ q²C P (γ + (1 − γ)P²) dq, where P is the contact fraction by the waves up to q,
    and γ = 0.45. Mean gaps of solves are some 5 % from it up to a contact fraction of a half, and larger near to full
    contact.

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
    _core = _asperity.Persson

    @classmethod
    def _by(cls, topography: Topography, modulus: float) -> Persson:
        return cls(surface.statistics(topography).rms_slope, modulus, surface.spectrum(topography))

    def mean_gap(self, mean_pressure: ArrayLike) -> Any:
        """Mean gap at mean pressures p̄ > 0, a length; without a load it is infinite."""
        if self.spectrum is None:
            raise ValueError(
                "the mean gap needs the spectrum of the surface: give spectrum, or make the theory by "
                "asperity.exact.Persson.of(heights, modulus=...)"
            )
        return self._of.mean_gap(self._read("mean_pressure", mean_pressure))


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
    _core = _asperity.GreenwoodWilliamson

    @classmethod
    def _by(cls, topography: Topography, modulus: float) -> GreenwoodWilliamson:
        found = surface.statistics(topography)
        return cls(found.rms_height, found.rms_slope, found.rms_curvature, modulus)

    @property
    def asperity_density(self) -> float:
        """Number η of asperities per area, m₄/(6π√3 m₂)."""
        return float(self._of.asperities[0])

    @property
    def asperity_radius(self) -> float:
        """Radius R of their curvature, 3√π/(8√m₄)."""
        return float(self._of.asperities[1])

    @property
    def rms_asperity_height(self) -> float:
        """Root mean square σ of their heights, √((1 − 0.8968/α) m₀) with Nayak's parameter α."""
        return float(self._of.asperities[2])
