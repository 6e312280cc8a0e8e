"""Exact solutions and theories, at many loads at once, for comparison with solves.

A solution gives states at given loads, contact radii, approaches or mean gaps, of any shape; a state gives its numbers
in that shape, and its fields at any places. Numbers beyond the range of a solution are a ``ValueError``. A theory of
rough surfaces gives numbers over the mean pressure; it is an approximation.

Parameters are numbers in any consistent units, or strings with units. With units all results are in SI units, and loads
and places are strings, or numbers in SI units.

>>> import numpy as np
>>> from asperity import exact
>>> spheres = exact.Jkr(radius=2.0, modulus=1.0, work_of_adhesion=1e-5).at_load([0.0, 1e-4])
>>> spheres.contact_radius.shape, spheres.pressure(np.linspace(0, 0.01, 5)).shape
((2,), (2, 5))
>>> tip = exact.Hertz(radius="20nm", modulus="70GPa")
>>> tip
Hertz(radius='20nm', modulus='70GPa')
  sphere without adhesion: P = 4E*a³/(3R), δ = a²/R; Hertz (1881)
>>> tip.at_load("10nN")
Contact(contact_radius=1.28923e-09, load=1e-08, approach=8.3106e-11) of Hertz(radius='20nm', modulus='70GPa')
"""

from .solutions import AdhesiveWavyLine, Contact, Hertz, Jkr, MaugisDugdale, WaveContact, WavyLine, closing_pressure_2d
from .theory import GreenwoodWilliamson, Persson

__all__ = [
    "AdhesiveWavyLine",
    "Contact",
    "GreenwoodWilliamson",
    "Hertz",
    "Jkr",
    "MaugisDugdale",
    "Persson",
    "WaveContact",
    "WavyLine",
    "closing_pressure_2d",
]


def __dir__() -> list[str]:
    """The names that are meant, and no modules that are used here."""
    return __all__
