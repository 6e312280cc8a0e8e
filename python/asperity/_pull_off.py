"""The greatest tension under which surfaces that adhere stay together."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from ._asperity import Iteration
from ._body import Body
from ._control import number, only
from ._pair import Shift
from ._scene import Scene
from ._solution import Solution, Start
from ._topography import Heights
from ._types import AxisOrder, Boundary, Branch, Lengths, Method, OwnLaw, Precision, Quantity
from ._wall import Wall
from ._warnings import ConvergenceWarning, warn


class PullOff(NamedTuple):
    """A pull-off: a tension that surfaces bear, and a slightly larger one that they do not.

    Attributes
    ----------
    pressure : float or None
        Greatest tension that was borne, over the area of the map; None if no state under a tension was found.
    force : float or None
        The force of that tension.
    limit_pressure, limit_force : float or None
        Pull-off in the limit of no range that the state tells, with `JKR`: the tension less the share of the process zone
        at the edges of the contacts, which the nodes make too wide.
    limit_error : float or None
        Estimated relative error of the limit, by a grid of half as many nodes along the sides.
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
    accuracy: float | None
    lost_pressure: float | None
    reached: bool
    rtol: float
    preload: float | None
    branch: Branch | None
    solves: int
    operator_applications: int
    solution: Solution


def pull_off(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity,
    law: OwnLaw | None,
    preload: Quantity | None = None,
    rtol: float = 0.02,
    accuracy: float | None = None,
    memory: float | None = None,
    body: Body | None = None,
    against: Heights | None = None,
    against_modulus: Quantity | None = None,
    shift: Shift | None = None,
    boundary: Boundary = "periodic",
    absent_missing: bool = False,
    wall: Wall = "hard",
    tolerance: float | None = None,
    max_iterations: int | None = None,
    method: Method = "default",
    branch: Branch | None = None,
    precision: Precision = "f64",
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
    threads: int | None = None,
    whole: bool = False,
) -> PullOff:
    """Finds the pull-off: the greatest tension under which surfaces that adhere stay together.

    The tension grows, each solve from the gap of the one before, until the surfaces come apart; then the pull-off is
    between the two, and the bracket is narrowed. Contacts that are lost on the way are lost under the load, as on a soft
    spring; `cycle` draws the surfaces apart and shows each of them. Parameters that are not here are those of `solve`.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as those of `solve`.
    law : Law or an object of your own
        Adhesion law.
    preload : float, optional
        Mean pressure to which surfaces that come from afar were pressed before. Without it they were pressed flat, or
        were as ``branch`` or ``start`` says.
    rtol : float
        Relative tolerance: width of the bracket over the pull-off.
    accuracy : float, optional
        Relative error of the pull-off that is wanted, as 0.05, with `JKR`. The heights are interpolated on finer grids
        until the estimated error is as small.
    memory : float, optional
        Memory that an accuracy may take, in GiB; all that is free by default.

    Returns
    -------
    PullOff
        Also where it was not found to the tolerance: then with a `ConvergenceWarning`.

    Examples
    --------
    >>> import asperity
    >>> tip = asperity.surface.paraboloid(64, 16e-9, radius=20e-9)
    >>> law = asperity.MaugisDugdale(work_of_adhesion=0.05, range=0.5e-9)
    >>> found = asperity.pull_off(tip, modulus=2e9, law=law, boundary="free")
    >>> exact = -asperity.exact.MaugisDugdale(20e-9, 2e9, 0.05, 0.5e-9).pull_off().load
    >>> abs(found.force / exact - 1) < 0.02
    True
    """
    given = locals()
    if branch is not None and start is not None:
        raise ValueError("start chooses the branch: leave out branch, or start")
    if accuracy is not None and start is not None:
        raise ValueError("an accuracy takes finer grids, which have no start: leave out start, or accuracy")
    scene = Scene.of({**given, "branch": only(branch)})
    of_preload = None if preload is None else number("preload", preload)
    found = scene.problem.pull_off(number("rtol", rtol), of_preload, scene.start(start), observe, (accuracy, None, memory))
    solution = scene.solution(found)
    if found["shortfall"] is not None:
        warn(found["shortfall"], ConvergenceWarning)
    entries = found["pull_off"]
    pressure, force = entries.pop("pull_off_pressure"), entries.pop("pull_off_force")
    return PullOff(pressure, force, **entries, solution=solution)
