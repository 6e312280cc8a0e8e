"""Exact solutions, at many loads at once, to compare solves with.

A solution gives states at given loads, contact radii, approaches or mean gaps, of any shape; a state gives its numbers
in that shape, and its fields at any places. Numbers beyond the range of a solution are a ``ValueError``.

>>> import numpy as np
>>> from asperity import exact
>>> spheres = exact.Jkr(radius=2.0, modulus=1.0, work_of_adhesion=1e-5).at_load([0.0, 1e-4])
>>> spheres.contact_radius.shape, spheres.pressure(np.linspace(0, 0.01, 5)).shape
((2,), (2, 5))
"""

from __future__ import annotations

from ._asperity import (
    AdhesiveWavyLine,
    Contact,
    Hertz,
    Jkr,
    MaugisDugdale,
    WaveContact,
    WavyLine,
    closing_pressure_2d,
)

__all__ = [
    "AdhesiveWavyLine",
    "Contact",
    "Hertz",
    "Jkr",
    "MaugisDugdale",
    "WaveContact",
    "WavyLine",
    "closing_pressure_2d",
]
