"""Rough surfaces: random ones, and the statistics of any.

>>> from asperity import surface
>>> rough = surface.self_affine(128, 1.0, rms_slope=0.1, hurst=0.8, k_l=4, k_s=32, seed=7)
>>> f"{surface.statistics(rough).rms_slope:.3f}"
'0.100'
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _asperity
from ._topography import Topography, _lengths, sides, taken

__all__ = ["PowerSpectralDensity", "SurfaceStatistics", "self_affine", "spectrum", "statistics"]


class SurfaceStatistics(NamedTuple):
    """Moments of heights, slopes and curvatures; lengths in the unit of the heights.

    Attributes
    ----------
    mean, lowest, highest, rms_height : float
        Mean, least and greatest height, and the root mean square about the mean.
    skewness, kurtosis : float
        0 and 3 for Gaussian heights; NaN for a flat surface.
    rms_slope, rms_curvature : float
        √⟨|∇h|²⟩, and the root mean square of ½∇²h (on a line of h''), from the spectrum.
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


def self_affine(
    shape: int | tuple[int, int],
    lengths: float | tuple[float, float],
    *,
    rms_height: float | None = None,
    rms_slope: float | None = None,
    hurst: float = 0.8,
    k_l: float = 4.0,
    k_r: float | None = None,
    k_s: float = 64.0,
    random_phase: bool = False,
    seed: int = 0,
) -> Topography:
    """Draws a periodic, isotropic, self-affine rough surface.

    The same seed gives the same surface on every grid of one aspect ratio that resolves it.

    Parameters
    ----------
    shape : int or (int, int)
        Numbers of nodes (Nx, Ny); one alone for a square.
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
        Whether only the phases of the waves are random, and their amplitudes those of the spectrum.
    seed : int
        Seed of the random numbers, from 0: each makes another surface.

    Returns
    -------
    Topography
    """
    nodes = (shape, shape) if isinstance(shape, int) else shape
    both = _lengths(lengths, nodes)
    heights = _asperity.self_affine(nodes, both, rms_height, rms_slope, hurst, k_l, k_r, k_s, random_phase, seed)
    return Topography(heights, both, periodic=True, seed=seed)


def statistics(
    heights: Any, lengths: float | tuple[float, float] | None = None, *, axes: str | None = None
) -> SurfaceStatistics:
    """Heights, slopes and curvatures in numbers.

    Parameters
    ----------
    heights : array_like, Topography, SurfaceTopography, DataArray or path of a file
        Heights of a periodic surface, shape (Nx, Ny).
    lengths : float or (float, float), optional
        Side lengths, of which slopes, curvatures and Nayak's parameter are NaN if the heights do not bring them either.
    axes : {"xy", "yx"}, optional
        Axes of an array, as of `asperity.solve`: "xy" by default, the first is x.

    Returns
    -------
    SurfaceStatistics
    """
    given = taken(heights, lengths, axes)
    return SurfaceStatistics(*_asperity.statistics(given.heights, given.lengths))


def spectrum(
    heights: Any,
    lengths: float | tuple[float, float] | None = None,
    *,
    axes: str | None = None,
) -> PowerSpectralDensity:
    """The power spectral density, averaged over directions.

    Parameters
    ----------
    heights : array_like, Topography, SurfaceTopography, DataArray or path of a file
        Heights of a periodic surface, shape (Nx, Ny).
    lengths : float or (float, float), optional
        Side lengths; needed unless the heights bring them.
    axes : {"xy", "yx"}, optional
        Axes of an array, as of `asperity.solve`: "xy" by default, the first is x.

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
    given = taken(heights, lengths, axes)
    return PowerSpectralDensity(*_asperity.spectrum(given.heights, sides(given)))
