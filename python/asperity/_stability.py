"""Whether an equilibrium lasts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ._summary import summarised


@summarised
class Stability(NamedTuple):
    """Stability of an equilibrium; eigenvalues are pressures per length.

    Attributes
    ----------
    verdict : str
        ``"stable"``, ``"unstable"`` or ``"undecided"``.
    eigenvalue : float
        Rayleigh quotient of the mode: no smaller than the smallest eigenvalue.
    residual : float
        Norm of the residual of the mode: some eigenvalue is within this distance.
    lower_bound : float
        Lower bound of the smallest eigenvalue.
    error_bound : float or None
        With a positive lower bound, bound of the relative error of the solution in the energy norm.
    smoothed : bool
        Whether jumps of the law were smoothed: then all this is about the smoothed law.
    operator_applications : int
        Number of operator applications.
    mode : ndarray
        Change of the gap along which the energy is softest, of the shape of the heights and of mean square 1.
    """

    verdict: str
    eigenvalue: float
    residual: float
    lower_bound: float
    error_bound: float | None
    smoothed: bool
    operator_applications: int
    mode: NDArray[np.floating[Any]]
