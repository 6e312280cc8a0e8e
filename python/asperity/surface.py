"""Surfaces: rough ones, bodies of simple forms, and the statistics of any.

A rough body has the heights of both: ``asperity.Topography(tip.heights + rough.heights, tip.lengths)``.

>>> from asperity import surface
>>> rough = surface.self_affine(128, 1.0, rms_slope=0.1, hurst=0.8, k_l=4, k_s=32, seed=7)
>>> f"{surface.statistics(rough).rms_slope:.3f}"
'0.100'
"""

from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _asperity
from .common.summary import summary
from .common.types import AxisOrder, Lengths, Quantity, Shape, Tilt
from .common.units import in_si, plain
from .common.words import suggests
from .maps.arrays import side_lengths
from .maps.heights import Heights, convert_heights
from .maps.topography import Topography, require_lengths

__all__ = [
    "PowerSpectralDensity",
    "SurfaceStatistics",
    "cone",
    "flat_punch",
    "fourier",
    "knee_wavelength",
    "paraboloid",
    "self_affine",
    "spectrum",
    "sphere",
    "statistics",
    "wave",
]


def __dir__() -> list[str]:
    """The names that are meant, and no modules that are used here."""
    return __all__


class SurfaceStatistics(NamedTuple):
    """Moments of heights, slopes and curvatures; lengths in the unit of the heights.

    Attributes
    ----------
    mean, lowest, highest, rms_height : float
        Mean, least and greatest height, and the root mean square about the mean.
    skewness, kurtosis : float
        0 and 3 for Gaussian heights; NaN for a flat surface.
    rms_slope, rms_curvature : float
        √⟨|∇h|²⟩, and the root mean square of ½∇²h (on a line of h''), spectral: of the waves through the nodes.
    rms_slope_differences, rms_curvature_differences : float
        The same from differences between neighbours.
    nayak : float
        Nayak's parameter m₀m₄/m₂².

    Slopes, curvatures and Nayak's parameter are NaN where the side lengths are unknown.
    """

    mean: float
    lowest: float
    highest: float
    rms_height: float
    skewness: float
    kurtosis: float
    rms_slope: float
    rms_slope_differences: float
    rms_curvature: float
    rms_curvature_differences: float
    nayak: float

    def __repr__(self) -> str:
        return summary(self)


class PowerSpectralDensity(NamedTuple):
    """A power spectral density over wave numbers of both signs.

    Attributes
    ----------
    wave_numbers : ndarray
        Wave numbers |q|, ascending, in radians per length.
    densities : ndarray
        Density at each: a length⁴, or a length³ of profiles.
    waves : ndarray of int64
        Number of waves in the mean of each entry.
    cell : float
        Area of one wave in the space of wave numbers: the sum of densities × waves × cell is ⟨h²⟩.
    """

    wave_numbers: NDArray[np.float64]
    densities: NDArray[np.float64]
    waves: NDArray[np.int64]
    cell: float

    def __repr__(self) -> str:
        return summary(self)


@suggests
def self_affine(
    shape: Shape,
    lengths: Lengths,
    *,
    rms_height: Quantity | None = None,
    rms_slope: float | None = None,
    hurst: float = 0.8,
    k_l: float = 4.0,
    k_r: float | None = None,
    k_s: float = 64.0,
    random_phase: bool = False,
    seed: int = 0,
    tilt: Tilt = None,
) -> Topography:
    """Draws a periodic, isotropic, self-affine rough surface.

    The same seed gives the same surface on every grid of one aspect ratio that resolves it.

    Parameters
    ----------
    shape : int or (int, int) or (int,)
        Numbers of nodes (Nx, Ny); one alone for a square, and (N,) for a line.
    lengths : float or (float, float)
        Side lengths; one alone for square cells.
    rms_height, rms_slope : float
        Root mean square of the heights or of the slope: give one.
    hurst : float
        Hurst exponent, from 0 to 1.
    k_l, k_r, k_s : float
        Wave numbers, in units of 2π/Lx, of the longest waves, the end of the plateau (k_l by default), and the shortest
        waves; the grid must have more than 2 k_s nodes along x.
    random_phase : bool
        Whether only the phases of the waves are random, with the amplitudes of the spectrum.
    seed : int
        Seed of the random numbers, from 0: each makes another surface.
    tilt : float or (float, float), optional
        Slope of a plane that is added, along x and along y.

    Returns
    -------
    Topography
    """
    lengths, rms_height, is_si = in_si(lengths=lengths, rms_height=rms_height)
    roughness = {
        "rms_height": rms_height,
        "rms_slope": rms_slope,
        "hurst": hurst,
        "k_l": k_l,
        "k_r": k_r,
        "k_s": k_s,
        "random_phase": random_phase,
        "seed": seed,
    }
    return _make(shape, lengths, roughness, tilt=tilt, periodic=None if tilt else True, seed=seed, is_si=is_si)


@suggests
def sphere(
    shape: Shape, lengths: Lengths, *, radius: Quantity, tilt: Tilt = None
) -> Topography:
    """Makes a sphere, √(R² − r²) − R with its apex on the node in the middle.

    Parameters
    ----------
    shape, lengths
        Numbers of nodes and side lengths, as `self_affine` takes them.
    radius : float
        Radius R, a length. Beyond it points are missing: `asperity.solve` takes them by ``absent_missing``.
    tilt : float or (float, float), optional
        Slope of a plane that is added, along x and along y.

    Returns
    -------
    Topography

    Examples
    --------
    >>> import asperity
    >>> tip = asperity.surface.sphere(64, 1.0, radius=2.0)
    >>> pressed = asperity.solve(tip, modulus=1.0, normal_force=0.01, boundary="free")
    >>> f"{pressed.approach / asperity.exact.Hertz(2.0, 1.0).at_load(0.01).approach:.2f}"
    '1.00'
    """
    lengths, radius, is_si = in_si(lengths=lengths, radius=radius)
    return _make(shape, lengths, form="sphere", radius=radius, tilt=tilt, is_si=is_si)


@suggests
def paraboloid(shape: Shape, lengths: Lengths, *, radius: Quantity, tilt: Tilt = None) -> Topography:
    """Makes a paraboloid, −r²/2R with the radius of curvature R; see `sphere`."""
    lengths, radius, is_si = in_si(lengths=lengths, radius=radius)
    return _make(shape, lengths, form="paraboloid", radius=radius, tilt=tilt, is_si=is_si)


@suggests
def cone(shape: Shape, lengths: Lengths, *, angle: float, tilt: Tilt = None) -> Topography:
    """Makes a cone, −r tan(angle), with the angle in degrees between its side and the half-space; see `sphere`."""
    lengths, is_si = in_si(lengths=lengths)
    return _make(shape, lengths, form="cone", angle=angle, tilt=tilt, is_si=is_si)


@suggests
def flat_punch(shape: Shape, lengths: Lengths, *, radius: Quantity, tilt: Tilt = None) -> Topography:
    """Makes a flat punch: 0 up to its radius, missing points beyond; see `sphere`."""
    lengths, radius, is_si = in_si(lengths=lengths, radius=radius)
    return _make(shape, lengths, form="flat-punch", radius=radius, tilt=tilt, is_si=is_si)


@suggests
def wave(
    shape: Shape,
    lengths: Lengths,
    *,
    amplitude: Quantity,
    periods: int | tuple[int, int] = (1, 0),
    tilt: Tilt = None,
) -> Topography:
    """Makes a wave, A cos(2πmₓx/Lx) cos(2πmᵧy/Ly) with its amplitude A and the periods (mₓ, mᵧ); see `sphere`."""
    lengths, amplitude, is_si = in_si(lengths=lengths, amplitude=amplitude)
    body: dict[str, Any] = {"form": "wave", "amplitude": amplitude, "periods": np.ravel(periods)}
    return _make(shape, lengths, tilt=tilt, periodic=None if tilt else True, is_si=is_si, **body)


def _make(
    shape: Shape,
    lengths: Lengths,
    roughness: dict[str, Any] | None = None,
    *,
    tilt: Tilt,
    periodic: bool | None = None,
    seed: int | None = None,
    is_si: bool,
    **body: Any,
) -> Topography:
    nodes, is_line = _read_shape(shape)
    both = side_lengths(lengths, nodes)
    body["tilt"] = None if tilt is None else np.ravel(tilt)
    heights = _asperity.made(nodes, both, plain(body), None if roughness is None else plain(roughness))
    unit = "m" if is_si else None
    return Topography(heights, both, unit, periodic, seed=seed, _is_line=is_line)


def _read_shape(shape: Shape) -> tuple[Any, bool]:
    """Numbers of nodes along both sides, and whether they are of a line."""
    nodes = (shape, shape) if isinstance(shape, int) else tuple(shape)
    return (nodes[0], 1) if len(nodes) == 1 else nodes, len(nodes) == 1


@suggests
def fourier(
    coefficients: ArrayLike | str | os.PathLike[str],
    shape: Shape,
    lengths: Lengths,
    *,
    fourier_unit: Quantity | None = None,
) -> Topography:
    """Makes a periodic surface of its Fourier coefficients, Σ h(q) exp(2πi(qX x/Lx + qY y/Ly)).

    The coefficients are as FFTW's inverse transform takes them: ``numpy.fft.rfft2(heights)`` over the number of
    heights. A wave stands for its opposite too, with the complex conjugate; where both are given, they count once. The
    file is as in the contact-mechanics challenge (Müser et al. 2017), a text file of lines ``qX, qY, Re, Im``.

    Parameters
    ----------
    coefficients : array_like of shape (n, 4), or path of a file
        The whole numbers qX and qY of periods along the sides, of either sign, and the real and the imaginary part.
    shape, lengths
        Numbers of nodes and side lengths, as `self_affine` takes them; the grid must have more than twice as many nodes
        along a side as a wave has periods.
    fourier_unit : float, optional
        Length that the coefficients are multiples of; needed if the side lengths have a unit.

    Returns
    -------
    Topography

    Examples
    --------
    >>> from asperity import surface
    >>> wave = surface.fourier([[3, -1, 0.5, 0.0]], 16, 1.0)
    >>> f"{wave.heights.max():.3f}"
    '1.000'
    """
    lengths, fourier_unit, is_si = in_si(lengths=lengths, fourier_unit=fourier_unit)
    if is_si and fourier_unit is None:
        raise ValueError("the side lengths have a unit, but the coefficients have none: give fourier_unit, as '0.1mm'")
    nodes, is_line = _read_shape(shape)
    both = side_lengths(lengths, nodes)
    source = os.fspath(coefficients) if isinstance(coefficients, str | os.PathLike) else None
    rows: Any = source or np.atleast_2d(np.asarray(coefficients, dtype=np.float64))
    if source is None and rows.shape[1] != 4:
        columns = "they must be qX, qY, and the real and the imaginary part"
        raise ValueError(f"coefficients have {rows.shape[1]} columns: {columns}")
    heights = _asperity.fourier(rows, nodes, both, 1.0 if fourier_unit is None else float(fourier_unit))
    unit = "m" if is_si else None
    return Topography(heights, both, unit, periodic=True, source=source, _is_line=is_line)


@suggests
def statistics(heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None) -> SurfaceStatistics:
    """Computes the statistics of heights, slopes and curvatures.

    Parameters
    ----------
    heights : array_like, Topography, SurfaceTopography, DataArray, DataFrame or path of a file
        Heights of a periodic surface, shape (Nx, Ny).
    lengths : float or (float, float), optional
        Side lengths; slopes, curvatures and Nayak's parameter are NaN if the heights do not bring them either.
    axes : {"xy", "yx"}, optional
        Axes of an array, as `asperity.solve` takes them: "xy" by default, the first is x.

    Returns
    -------
    SurfaceStatistics
    """
    lengths, is_si = in_si(lengths=lengths)
    topography = convert_heights(heights, lengths, axes, is_si)
    return SurfaceStatistics(*_asperity.statistics(topography.heights, topography.lengths).values())


@suggests
def spectrum(heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None) -> PowerSpectralDensity:
    """Computes the power spectral density, averaged over directions.

    Parameters
    ----------
    heights, lengths, axes
        As `statistics` takes them; the side lengths are needed, unless the heights bring them.

    Returns
    -------
    PowerSpectralDensity

    Examples
    --------
    >>> import numpy as np
    >>> from asperity import surface
    >>> rough = surface.self_affine(64, 1.0, rms_height=0.01, k_s=16)
    >>> q, densities, waves, cell = surface.spectrum(rough)
    >>> f"{np.sqrt((densities * waves).sum() * cell):.4f}"
    '0.0100'
    """
    lengths, is_si = in_si(lengths=lengths)
    topography = convert_heights(heights, lengths, axes, is_si)
    return PowerSpectralDensity(*_asperity.spectrum(topography.heights, require_lengths(topography)))


@suggests
def knee_wavelength(heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None) -> float | None:
    """Finds the wavelength at which the power spectral density flattens to a floor of noise.

    Surface and noise have the same density there, and shorter waves are mostly noise. `asperity.prepare` leaves them
    out by ``cut_off_wavelength``.

    Parameters
    ----------
    heights, lengths, axes
        As `statistics` takes them; the side lengths are needed, unless the heights bring them.

    Returns
    -------
    float or None
        None where there is no floor, or less than some 90 x 90 nodes.

    Examples
    --------
    >>> import numpy as np
    >>> from asperity import surface
    >>> rough = surface.self_affine(128, 1.0, rms_height=0.01, k_l=2, k_s=60)
    >>> surface.knee_wavelength(rough) is None
    True
    >>> noisy = rough.heights + np.random.default_rng(0).normal(scale=0.004, size=rough.shape)
    >>> 2 / 128 < surface.knee_wavelength(noisy, 1.0) < 0.2
    True
    """
    lengths, is_si = in_si(lengths=lengths)
    topography = convert_heights(heights, lengths, axes, is_si)
    return _asperity.knee_wavelength(topography.heights, require_lengths(topography))
