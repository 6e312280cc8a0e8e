"""Walls of springs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from ..common.types import Quantity
from .parameters import Parameters


@dataclass(frozen=True)
class _Springs(Parameters):
    stiffness: Quantity

    _keys: ClassVar[dict[str, str]] = {"stiffness": "wall_stiffness"}

    @property
    def keys(self) -> dict[str, Any]:
        """Its keys, with their values as they were typed."""
        return {**super().keys, "wall": type(self).__name__.lower()}

    def __post_init__(self) -> None:
        super().__post_init__()
        if not 0 < float(self.stiffness) < float("inf"):
            raise ValueError(f"stiffness is {self.stiffness}: it must be positive and finite, a pressure per length")


class Penalty(_Springs):
    """A wall of springs: the surfaces overlap by the contact pressure over the stiffness.

    A stiffer wall takes more iterations. `cycle` takes no wall of springs.

    Parameters
    ----------
    stiffness : float
        Stiffness k > 0 of the springs, a pressure per length. The contact pressure is k times the overlap.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> solution = asperity.solve(wave, 1.0, modulus=1.0, mean_pressure=0.02, wall=asperity.Penalty(500.0))
    >>> bool(np.isclose(-solution.report["min_gap"], solution.contact_pressure.max() / 500.0))
    True
    """


class Uzawa(_Springs):
    """A wall by Uzawa's method: springs, with multipliers that take over the contact pressure in rounds.

    This is the augmented Lagrangian method. It ends at the same contact as the hard wall, which is faster, and is there
    for comparison. `cycle` takes no wall of springs.

    Parameters
    ----------
    stiffness : float
        Stiffness k > 0 of the springs in the first round, a pressure per length. The result hardly depends on it.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> solution = asperity.solve(wave, 1.0, modulus=1.0, mean_pressure=0.02, wall=asperity.Uzawa(20.0))
    >>> solution.converged, solution.report["min_gap"] > -1e-7
    (True, True)
    """
