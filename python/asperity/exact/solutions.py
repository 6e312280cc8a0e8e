"""Exact solutions of one contact: spheres and wavy lines."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _asperity
from ..common.types import Quantity
from .formula import Formula


class _States:
    """States of a solution, with their numbers as properties."""

    #: The numbers by which a state is printed.
    _shown: ClassVar[tuple[str, ...]]

    def __init__(self, solution: Formula, way: str, *at: ArrayLike) -> None:
        # another process finds it again by these
        self._made = solution, way, *deepcopy(at)
        self._solution, self._state = solution, getattr(solution._of, way)(*at)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._made

    def __repr__(self) -> str:
        values = {name: getattr(self, name) for name in self._shown}
        shape = np.shape(values[self._shown[0]])
        told = f"{shape}" if shape else f"({', '.join(f'{name}={value:.6g}' for name, value in values.items())})"
        return f"{type(self).__name__}{told} of {self._solution._call_text()}"

    def _field(self, name: str, places: ArrayLike) -> Any:
        return getattr(self._state, name)(self._solution._read("distance", places))

    def pressure(self, places: ArrayLike, /) -> Any:
        """Pressure p, compression positive."""
        return self._field("pressure", places)

    def gap(self, places: ArrayLike, /) -> Any:
        """Gap g."""
        return self._field("gap", places)

    def displacement(self, places: ArrayLike, /) -> Any:
        """Displacement u = h + g."""
        return self._field("displacement", places)


class Contact(_States):
    """Axisymmetric contacts of a paraboloid −r²/2R with a half-space; numbers have the shape of what they were found at.

    Notes
    -----
    Fields are at the distances r ≥ 0 from the axis: the shape of the contacts, then the shape of r.
    """

    _shown = ("contact_radius", "load", "approach")

    @property
    def contact_radius(self) -> Any:
        """Radius a up to which the surfaces touch, a length."""
        return self._state.contact_radius

    @property
    def adhesion_radius(self) -> Any:
        """Radius up to which the surfaces attract each other, a length."""
        return self._state.adhesion_radius

    @property
    def load(self) -> Any:
        """Load P, a force, compression positive."""
        return self._state.load

    @property
    def approach(self) -> Any:
        """Approach δ of the half-space at infinity, a length."""
        return self._state.approach

    @property
    def radius_of_curvature(self) -> Any:
        """Radius of curvature R, a length."""
        return self._state.radius_of_curvature

    @property
    def second_moment(self) -> Any:
        """Integral of r²p over the contact, a force times an area."""
        return self._state.second_moment

    def deflection(self, places: ArrayLike, /) -> Any:
        """Deflection u + δ."""
        return self._field("deflection", places)


class WaveContact(_States):
    """Contacts of a wave h₀ cos(2πx/λ) with a half-space; numbers have the shape of what they were found at.

    Notes
    -----
    Fields are at the distances x from a crest: the shape of the contacts, then the shape of x.
    """

    _shown = ("half_width", "mean_pressure", "mean_gap")

    @property
    def half_width(self) -> Any:
        """Half-width a of the contact about each crest, a length."""
        return self._state.half_width

    @property
    def mean_pressure(self) -> Any:
        """Mean pressure p̄."""
        return self._state.mean_pressure

    @property
    def mean_gap(self) -> Any:
        """Mean gap, a length."""
        return self._state.mean_gap


@dataclass(frozen=True, repr=False)
class _Sphere(Formula):
    radius: Quantity
    modulus: Quantity

    def at_load(self, load: ArrayLike) -> Contact:
        """Stable contacts at loads P, compression positive."""
        return Contact(self, "at_load", self._read("load", load))

    def at_approach(self, approach: ArrayLike) -> Contact:
        """Stable contacts at approaches δ."""
        return Contact(self, "at_approach", self._read("approach", approach))

    def at_contact_radius(self, radius: ArrayLike) -> Contact:
        """Contacts of radii a ≥ 0."""
        return Contact(self, "at_contact_radius", self._read("radius", radius))

    def pull_off(self) -> Contact:
        """Contact of least load: the pull-off force is minus its load."""
        return Contact(self, "pull_off")


class Hertz(_Sphere):
    """Hertz' contact of a sphere, without adhesion: P = 4E*a³/(3R), δ = a²/R.

    Parameters
    ----------
    radius : float
        Radius of curvature R, a length.
    modulus : float
        Contact modulus E*, a pressure.

    Examples
    --------
    >>> from asperity import exact
    >>> f"{exact.Hertz('20nm', '70GPa').at_contact_radius(['1nm', '2nm']).load[1]:.3g} N"
    '3.73e-08 N'
    """

    about = "sphere without adhesion: P = 4E*a³/(3R), δ = a²/R; Hertz (1881)"
    _core = _asperity.Hertz


@dataclass(frozen=True, repr=False)
class Jkr(_Sphere):
    """The contact of Johnson, Kendall and Roberts, with adhesion of no range.

    Parameters
    ----------
    radius, modulus
        Radius and contact modulus, as `Hertz` has them.
    work_of_adhesion : float
        Work of adhesion w, an energy per area.

    Examples
    --------
    >>> from asperity import exact
    >>> f"{-exact.Jkr('20nm', '2GPa', '50mJ/m2').pull_off().load:.3g} N"
    '4.71e-09 N'
    """

    work_of_adhesion: Quantity

    about = (
        "sphere with adhesion of no range: P = 4E*a³/(3R) − √(8πwE*a³), δ = a²/R − √(2πwa/E*); "
        "Johnson, Kendall and Roberts (1971)"
    )
    _core = _asperity.Jkr


@dataclass(frozen=True, repr=False)
class MaugisDugdale(_Sphere):
    """Maugis' contact of a sphere, with a constant traction w/ρ up to a gap ρ.

    Parameters
    ----------
    radius, modulus, work_of_adhesion
        Radius, modulus and work of adhesion, as `Jkr` has them.
    range : float
        Range ρ, a length.

    Examples
    --------
    >>> from asperity import exact
    >>> f"{exact.MaugisDugdale('20nm', '2GPa', '50mJ/m2', '0.3nm').tabor_parameter:.2f}"
    '0.77'
    """

    work_of_adhesion: Quantity
    range: Quantity

    about = (
        "sphere with the traction w/ρ up to the gap ρ, at the radius c: with cos θ = a/c "
        "P = 4E*a³/(3R) − 2wc²/ρ (θ + ½ sin 2θ), δ = a²/R − 2w/(ρE*) √(c² − a²); Maugis (1992)"
    )
    _core = _asperity.MaugisDugdale

    @property
    def tabor_parameter(self) -> float:
        """Tabor parameter: large for JKR, small for DMT."""
        return float(self._of.tabor_parameter)


@dataclass(frozen=True, repr=False)
class _Wave(Formula):
    amplitude: Quantity
    wavelength: Quantity
    modulus: Quantity

    @property
    def closing_pressure(self) -> float:
        """Mean pressure at which the contact closes without adhesion."""
        return float(self._of.closing_pressure)

    def at_half_width(self, half_width: ArrayLike) -> WaveContact:
        """Contacts of half-widths a."""
        return WaveContact(self, "at_half_width", self._read("half_width", half_width))

    def at_mean_pressure(self, mean_pressure: ArrayLike) -> WaveContact:
        """Contacts at mean pressures p̄: the stable ones."""
        return WaveContact(self, "at_mean_pressure", self._read("mean_pressure", mean_pressure))

    def at_mean_gap(self, mean_gap: ArrayLike) -> WaveContact:
        """Contacts at mean gaps: the stable ones."""
        return WaveContact(self, "at_mean_gap", self._read("mean_gap", mean_gap))


class WavyLine(_Wave):
    """Westergaard's contact of a wave on a line, without adhesion.

    Parameters
    ----------
    amplitude, wavelength : float
        Amplitude h₀ and wavelength λ, lengths.
    modulus : float
        Contact modulus E*, a pressure.

    Examples
    --------
    >>> from asperity import exact
    >>> wave = exact.WavyLine("10nm", "1um", "1GPa")
    >>> f"{wave.at_mean_pressure(wave.closing_pressure / 2).half_width:.3g} m"
    '2.5e-07 m'
    """

    about = (
        "wave on a line without adhesion: with s = sin²(πa/λ) p̄ = πE*h₀/λ s, ḡ = h₀ (1 − s + s ln s); "
        "Westergaard (1939)"
    )
    _core = _asperity.WavyLine


@dataclass(frozen=True, repr=False)
class AdhesiveWavyLine(_Wave):
    """Johnson's contact of a wave on a line, with adhesion of no range.

    Parameters
    ----------
    amplitude, wavelength, modulus
        Amplitude, wavelength and modulus, as `WavyLine` has them.
    work_of_adhesion : float
        Work of adhesion w, an energy per area.

    Examples
    --------
    >>> from asperity import exact
    >>> f"{exact.AdhesiveWavyLine('10nm', '1um', '1GPa', '10mJ/m2').alpha:.2f}"
    '0.14'
    """

    work_of_adhesion: Quantity

    about = (
        "wave on a line with adhesion of no range: with s = sin²(πa/λ) "
        "p̄ = πE*h₀/λ s − p₁, ḡ = h₀ (1 − s + s ln s) − λp₁/(πE*) ln s, p₁ = √(2E*w/λ tan(πa/λ)); Johnson (1995)"
    )
    _core = _asperity.AdhesiveWavyLine

    @property
    def alpha(self) -> float:
        """Johnson's parameter √(2wλ/(π²E*h₀²))."""
        return float(self._of.alpha)

    def pull_off(self) -> WaveContact:
        """Partial contact of least mean pressure, from which it opens."""
        return WaveContact(self, "pull_off")

    def jump_to_full_contact(self) -> WaveContact:
        """Partial contact of largest mean pressure, from which it jumps to full contact."""
        return WaveContact(self, "jump_to_full_contact")


def closing_pressure_2d(amplitude: ArrayLike, wavelength: Quantity, modulus: Quantity) -> Any:
    """The mean pressure √2πE*h₀/λ that closes a wave h₀ cos(2πx/λ) cos(2πy/λ), without adhesion.

    Parameters
    ----------
    amplitude : float or array_like
        Amplitudes h₀, lengths.
    wavelength : float
        Wavelength λ, a length.
    modulus : float
        Contact modulus E*, a pressure.

    Examples
    --------
    >>> from asperity import exact
    >>> f"{exact.closing_pressure_2d('10nm', '1um', '1GPa'):.4g} Pa"
    '4.443e+07 Pa'
    """
    numbers, _ = _asperity.in_si([("amplitude", amplitude), ("wavelength", wavelength), ("modulus", modulus)])
    return _asperity.closing_pressure_2d(*numbers)
