"""Whether an equilibrium lasts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _control
from ._scene import Scene
from ._solution import Solution
from ._wall import Penalty


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


def stability(
    solution: Solution,
    *,
    mean_pressure: float | None = None,
    mean_gap: float | None = None,
    normal_force: float | None = None,
    approach: float | None = None,
    spring: tuple[float, float] | None = None,
) -> Stability:
    """Finds out whether a solution is stable: under its own load, or under another one that would hold it.

    Parameters
    ----------
    solution : Solution
        Solution of `solve`, or of a sweep or a cycle.
    mean_pressure, mean_gap, normal_force, approach, spring : optional
        Load that takes the place of the solution's own, as those of `solve`: an equilibrium that is stable at a given
        mean gap may not be under the pressure that it has there.

    Returns
    -------
    Stability

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> law = asperity.Exponential(1e-3, 8e-3)
    >>> held = asperity.solve(wave, 1.0, modulus=1.0, mean_gap=0.04, law=law)
    >>> asperity.stability(held).verdict, asperity.stability(held, mean_pressure=held.mean_pressure).verdict
    ('stable', 'unstable')
    """
    report = solution.report
    if report["wall"] == "uzawa":
        raise ValueError(
            "the solution was found with asperity.Uzawa, whose multipliers it does not have: give stability=True to its solve"
        )
    if report["hardness"] is not None:
        raise ValueError(
            "the solution was found with a hardness: a surface that yields does not come back, as the test takes for granted"
        )
    given: dict[str, Any] = {
        "mean_pressure": mean_pressure,
        "mean_gap": mean_gap,
        "normal_force": normal_force,
        "approach": approach,
        "spring": spring,
    }
    if all(load is None for load in given.values()):
        name, value = report["control"].replace("-", "_"), report["control_value"]
        given[name] = value if name != "spring" else (report["spring_stiffness"], value)
    scene = Scene(
        solution.topography,
        None,
        absent_missing=report["absent_nodes"] > 0,
        law=solution.law,
        modulus=report["modulus"],
        body=solution.body,
        against_modulus=report["against_modulus"],
        boundary=report["boundary"],
        wall=report["wall"] if report["wall"] != "penalty" else Penalty(report["wall_stiffness"] or 0.0),
        precision=report["precision"],
        method=report["method"],
        threads=report["threads"],
        tolerance=report["tolerance"],
        max_iterations=report["max_iterations"],
        branch=None,
        whole=report["part"] == "whole",
    )
    gap = np.asarray(solution.whole_gap, dtype=np.float64).reshape(solution.topography.heights.shape)
    found = scene.problem.stability(_control.one(given), gap, solution.relative_error)
    return Stability(**{**found, "mode": solution.part_of(found["mode"])})
