"""The greatest tension under which surfaces that adhere stay together."""

from __future__ import annotations

from typing import NamedTuple

from ..common.summary import summary
from ..common.types import Branch
from .solution import Solution


class PullOff(NamedTuple):
    """A pull-off: a tension that surfaces bear, and a slightly larger one that they do not.

    Attributes
    ----------
    pressure : float or None
        Greatest tension that the surfaces bore, over the area of the map; None if no state under a tension was found.
    force : float or None
        The force of that tension.
    limit_pressure, limit_force : float or None
        Pull-off in the limit of zero range, with `JKR`: of the tension and the tension less the share of the process
        zone at the edges of the contacts the one that changed less from a grid of half as many nodes along the sides. None
        where its error is unknown.
    limit_error : float or None
        Estimated relative error of the limit, by a grid of half as many nodes along the sides.
    limit_reason : str or None
        Reason why there is no error.
    to_report : {"limit_pressure", "pull_off_pressure"} or None
        Pull-off to report: the limit if it has an error; None where a few nodes bear the tension.
    accuracy : float or None
        Relative error that was asked for.
    lost_pressure : float or None
        Least tension under which the surfaces came apart.
    reached : bool
        Whether the two are as close as the tolerance, so that the pull-off is between them, and the accuracy is met.
    rtol : float
        Relative tolerance.
    preload : float or None
        Mean pressure to which the surfaces were pressed before; without one they were pressed flat, or were as the
        branch says.
    branch : str or None
        Branch of the first solve; None if its start was given.
    solves, operator_applications : int
        Numbers of solves, and of operator applications of all of them.
    solution : Solution
        State under the greatest tension that was borne.
    """

    pressure: float | None
    force: float | None
    limit_pressure: float | None
    limit_force: float | None
    limit_error: float | None
    limit_reason: str | None
    to_report: str | None
    accuracy: float | None
    lost_pressure: float | None
    reached: bool
    rtol: float
    preload: float | None
    branch: Branch | None
    solves: int
    operator_applications: int
    solution: Solution

    def __repr__(self) -> str:
        report = self.solution.report
        names = {"pressure": ("pressure", "limit_pressure", "lost_pressure", "preload"), "force": ("force", "limit_force")}
        force = "N" if report["pressure_unit"] == "Pa" else None
        units = {"pressure": report["pressure_unit"], "force": force}
        return summary(self, {name: units[kind] for kind, of in names.items() for name in of})
