"""Walls that are made of springs."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

from . import _asperity
from ._control import number
from ._types import Quantity, RigidWall


@dataclass(frozen=True)
class _Springs:
    stiffness: Quantity
    _text: str | None = field(default=None, init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        if isinstance(self.stiffness, str):
            object.__setattr__(self, "_text", self.stiffness)
            object.__setattr__(self, "stiffness", _asperity.quantity("wall_stiffness", self.stiffness))
        stiffness = number("stiffness", self.stiffness)
        if not 0 < stiffness < float("inf"):
            raise ValueError(f"stiffness is {stiffness}: it must be positive and finite, a pressure per length")
        object.__setattr__(self, "stiffness", stiffness)

    @property
    def given(self) -> tuple[dict[str, str], tuple[str, float] | None]:
        """The stiffness as a text, if it was given with a unit, or as the number that has none."""
        key = "wall_stiffness"
        return ({}, (key, float(self.stiffness))) if self._text is None else ({key: self._text}, None)


class Penalty(_Springs):
    """A wall of springs, into which the surfaces sink by the contact pressure over the stiffness.

    A stiffer wall takes more iterations. `cycle` refuses springs.

    Parameters
    ----------
    stiffness : float
        Stiffness k > 0 of the springs, a pressure per length: contact pressures are k times the depth.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> solution = asperity.solve(wave, 1.0, modulus=1.0, mean_pressure=0.02, wall=asperity.Penalty(500.0))
    >>> bool(np.isclose(-solution.report["min_gap"], solution.contact_pressure.max() / 500.0))
    True
    """


class Uzawa(_Springs):
    """A wall of springs with multipliers, which take over the contact pressure in rounds until the wall is hard.

    The augmented Lagrangian method of Uzawa, for comparison with the hard wall, which is faster. `cycle` refuses springs.

    Parameters
    ----------
    stiffness : float
        Stiffness k > 0 of the springs of the first round, a pressure per length; the result hardly depends on it.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> solution = asperity.solve(wave, 1.0, modulus=1.0, mean_pressure=0.02, wall=asperity.Uzawa(20.0))
    >>> solution.converged, solution.report["min_gap"] > -1e-7
    (True, True)
    """


#: A wall as functions take it.
Wall: TypeAlias = RigidWall | Penalty | Uzawa


def parts(wall: Wall) -> tuple[str, float | None]:
    """The name of a wall, and the stiffness of its springs, if it has some."""
    if isinstance(wall, _Springs):
        return type(wall).__name__.lower(), float(wall.stiffness)
    return wall, None
