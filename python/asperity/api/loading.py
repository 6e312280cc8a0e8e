"""The pull-off of a contact, and the contact of a viscoelastic body over time."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from numpy.typing import ArrayLike

from .._asperity import Iteration
from ..answers.pull_off import PullOff
from ..answers.solution import Start
from ..bodies.body import Body
from ..bodies.wall import Penalty, Uzawa
from ..common.types import (
    AxisOrder,
    Base,
    Boundary,
    Branches,
    LawName,
    Lengths,
    Method,
    OwnLaw,
    Precision,
    Quantity,
    WallName,
)
from ..common.words import suggests
from ..maps.heights import Heights
from ..relaxation.viscoelastic import Viscoelastic
from .contact import Contact, solve_once


@suggests
def pull_off(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity | None = None,
    preload: Quantity | None = None,
    law: LawName | OwnLaw | None = None,
    work_of_adhesion: Quantity | None = None,
    range: Quantity | None = None,
    exponent: float | None = None,
    hamaker: Quantity | None = None,
    cut_off: Quantity | None = None,
    branch: Branches | None = None,
    boundary: Boundary | None = "periodic",
    absent_missing: bool | None = False,
    against: Heights | None = None,
    against_modulus: Quantity | None = None,
    shift: Quantity | tuple[Quantity, Quantity] | None = None,
    whole: bool | None = False,
    body: Body | None = None,
    layer: Quantity | None = None,
    base: Base | None = None,
    coating: Quantity | None = None,
    coating_modulus: Quantity | None = None,
    coating_poisson: float | None = None,
    plate: Quantity | None = None,
    poisson: float | None = None,
    hardness: Quantity | ArrayLike | None = None,
    wall: WallName | Penalty | Uzawa | None = "hard",
    wall_stiffness: Quantity | None = None,
    accuracy: float | None = None,
    memory: float | None = None,
    tolerance: float | None = None,
    method: Method | None = "default",
    max_iterations: int | None = None,
    precision: Precision | None = "f64",
    threads: int | None = None,
    rtol: float | None = 0.02,
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
) -> PullOff:
    """Finds the pull-off: the greatest tension under which surfaces that adhere stay together.

    The tension grows, each solve from the gap of the one before, until the surfaces come apart; then the pull-off is
    between the two, and the bracket is narrowed. The load is given, as if by a soft spring, so that many contacts may
    break at once; `cycle` draws the surfaces apart and shows each break. `solve` has the other parameters.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as `solve` takes
        them.
    preload : float, optional
        Mean pressure to which surfaces that come from afar were pressed before. Without it they were pressed flat,
        unless ``branch`` or ``start`` says otherwise.
    law : Law or an object of your own
        Adhesion law.
    accuracy : float, optional
        Relative error of the pull-off to reach, such as 0.05, with `JKR`. The heights are interpolated on finer grids
        until the estimated error is small enough.
    memory : float, optional
        Memory that an accuracy may take, in GiB; all that is free by default.
    rtol : float
        Relative tolerance: width of the bracket over the pull-off.

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
    return solve_once(Contact.pull_off, locals())


@suggests
def viscoelastic(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity | None = None,
    mean_pressures: Iterable[Quantity] | None = None,
    mean_gaps: Iterable[Quantity] | None = None,
    normal_forces: Iterable[Quantity] | None = None,
    approaches: Iterable[Quantity] | None = None,
    prony: Iterable[tuple[float, float]] | None = None,
    times: Iterable[float] | None = None,
    law: LawName | OwnLaw | None = None,
    work_of_adhesion: Quantity | None = None,
    range: Quantity | None = None,
    exponent: float | None = None,
    hamaker: Quantity | None = None,
    cut_off: Quantity | None = None,
    branch: Branches | None = None,
    boundary: Boundary | None = "periodic",
    absent_missing: bool | None = False,
    against: Heights | None = None,
    shift: Quantity | tuple[Quantity, Quantity] | None = None,
    whole: bool | None = False,
    body: Body | None = None,
    layer: Quantity | None = None,
    base: Base | None = None,
    poisson: float | None = None,
    wall: WallName | Penalty | Uzawa | None = "hard",
    wall_stiffness: Quantity | None = None,
    tolerance: float | None = None,
    method: Method | None = "default",
    max_iterations: int | None = None,
    precision: Precision | None = "f64",
    threads: int | None = None,
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
) -> Viscoelastic:
    """Follows the contact of a linear viscoelastic body over time, under loads or approaches at given times.

    The relaxation modulus is E(t) = E₀ (1 − Σ gₖ (1 − exp(−t/τₖ))), with the same Poisson's ratio at all times. The
    first load comes at once, on a body at rest. Between two times the displacement is taken as linear in time, and the
    error of that is of the second order in the step. A long hold may be one step, but for its energies. With adhesion
    each solve begins from the gap of the one before. `solve` has the other parameters.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as `solve` takes
        them.
    modulus : float
        Instantaneous contact modulus E₀, a pressure, in a step at once. The relaxed one is E₀ (1 − Σ gₖ).
    mean_pressures : sequence of float
        Mean external pressures at the times.
    mean_gaps : sequence of float
        Mean gaps at the times.
    normal_forces : sequence of float
        Normal forces at the times.
    approaches : sequence of float
        Approaches at the times, with a free boundary.
    prony : sequence of (float, float)
        Shares gₖ of the instantaneous modulus that relax, and their relaxation times τₖ. Shares add up to 1 at most.
    times : sequence of float
        Times of the loads, in the unit of the relaxation times. The same time twice is a step at once.
    law : Law, an object of your own, or str, optional
        Adhesion law, as `solve` takes it, with a range. A law with a traction that jumps, such as `MaugisDugdale`,
        holds edges on the nodes.
    body : Layer, optional
        Body that deforms, a half-space by default; work and energies are without the mean compression of a layer.

    Returns
    -------
    Viscoelastic
        An iterator over `Moment`; ``columns`` has the numbers of all. It ends where the bodies have come apart under a
        force, with the ``status`` "detached".

    Examples
    --------
    A sphere under a force that is held: its contact radius grows as the cube root of the creep compliance.

    >>> import numpy as np, asperity
    >>> tip = asperity.surface.paraboloid(64, 1.0, radius=2.0)
    >>> held = {"times": np.linspace(0, 4, 9), "normal_forces": [0.003] * 9}
    >>> found = asperity.viscoelastic(tip, modulus=1.0, prony=[(0.5, 1.0)], boundary="free", **held)
    >>> creep = 2 - np.exp(-found.columns["time"] / 2)
    >>> hertz = asperity.exact.Hertz(radius=2.0, modulus=1.0).at_load(0.003 * creep).approach
    >>> bool(np.allclose(found.columns["approach"], hertz, rtol=2e-3))
    True
    """
    return solve_once(Contact.viscoelastic, locals())
