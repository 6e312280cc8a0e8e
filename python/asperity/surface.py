"""Surfaces: rough ones, bodies of simple forms, and the statistics of any.

A rough body has the heights of both: ``asperity.Topography(tip.heights + rough.heights, tip.lengths)``.

>>> from asperity import surface
>>> rough = surface.self_affine(128, 1.0, rms_slope=0.1, hurst=0.8, k_l=4, k_s=32, seed=7)
>>> f"{surface.statistics(rough).rms_slope:.3f}"
'0.100'
"""

from __future__ import annotations

from . import _surface
from ._surface import PowerSpectralDensity, SurfaceStatistics
from ._words import checked

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

cone = checked(_surface.cone, __name__)
flat_punch = checked(_surface.flat_punch, __name__)
fourier = checked(_surface.fourier, __name__)
knee_wavelength = checked(_surface.knee_wavelength, __name__)
paraboloid = checked(_surface.paraboloid, __name__)
self_affine = checked(_surface.self_affine, __name__)
spectrum = checked(_surface.spectrum, __name__)
sphere = checked(_surface.sphere, __name__)
statistics = checked(_surface.statistics, __name__)
wave = checked(_surface.wave, __name__)
