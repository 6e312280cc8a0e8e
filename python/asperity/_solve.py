"""The equilibrium at one load."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from . import _control
from ._accuracy import Plan
from ._asperity import Iteration
from ._body import Body
from ._pair import Shift
from ._scene import Scene
from ._solution import Solution, Start
from ._topography import Heights
from ._types import (
    AccuracyOf,
    AxisOrder,
    Boundary,
    Branches,
    Lengths,
    Method,
    OwnLaw,
    Precision,
    Quantity,
)
from ._wall import Hardness, Wall


def solve(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity,
    mean_pressure: Quantity | None = None,
    mean_gap: Quantity | None = None,
    normal_force: Quantity | None = None,
    approach: Quantity | None = None,
    spring: tuple[Quantity, Quantity] | None = None,
    reduced_pressure: float | None = None,
    contact_fraction: float | None = None,
    body: Body | None = None,
    against: Heights | None = None,
    against_modulus: Quantity | None = None,
    shift: Shift | None = None,
    boundary: Boundary = "periodic",
    absent_missing: bool = False,
    law: OwnLaw | None = None,
    wall: Wall = "hard",
    hardness: Hardness | None = None,
    tolerance: float | None = None,
    max_iterations: int | None = None,
    method: Method = "default",
    branch: Branches | None = None,
    precision: Precision = "f64",
    start: Start = None,
    nested: bool | None = None,
    observe: Callable[[Iteration], object] | None = None,
    stability: bool = False,
    leave: bool = False,
    stiffness: bool = False,
    resistivities: tuple[Quantity, Quantity] | None = None,
    conductivities: tuple[Quantity, Quantity] | None = None,
    accuracy: float | None = None,
    accuracy_of: AccuracyOf | None = None,
    memory: float | None = None,
    threads: int | None = None,
    whole: bool = False,
) -> Solution:
    """Presses a rough surface against an elastic half-space.

    Give one load: ``mean_pressure``, ``mean_gap``, ``normal_force``, ``approach``, ``spring``, ``reduced_pressure`` or
    ``contact_fraction``. Quantities are numbers in any consistent units, or all are texts with units, such as
    ``modulus="70GPa"`` and ``law=asperity.Exponential("50mJ/m2", "1nm")``: then the map is brought to metres, and all
    results are in the SI.

    Parameters
    ----------
    heights : array_like, Topography, SurfaceTopography, DataArray or path of a file
        Heights of the rigid surface, shape (Nx, Ny), or (N,) on a line; peaks up. Any float type, order or stride. A
        C-ordered array of float64 is copied once, as the solver needs it; others are converted first. Missing points,
        NaN or masked, are refused: `prepare` fills them, or ``absent_missing`` takes them as they are.
    lengths : float or (float, float), optional
        Side lengths (Lx, Ly) = (Nx Δx, Ny Δy), in the unit of the heights; one alone means square cells. Needed
        unless the heights bring them.
    axes : {"xy", "yx"}, optional
        Axes of an array of heights: "xy" by default, the first is x, or "yx" for an image, [row, column]. A DataArray
        whose dimensions are named x and y does not need it. Results have x along the first axis in any case.
    modulus : float
        Contact modulus E*, a pressure: E/(1 − ν²), with Young's modulus E and Poisson's ratio ν of the body that deforms.
    mean_pressure : float
        Mean external pressure p̄ that is held, the normal force over the nominal area Lx·Ly, compression positive.
    mean_gap : float
        Mean gap that is held, a length ≥ 0; with a periodic boundary, and without absent nodes.
    normal_force : float
        Normal force F = p̄·Lx·Ly that is held, a pressure times an area, compression positive.
    approach : float
        Approach δ that is held, a length: how far the bodies have moved towards each other since they would first touch
        undeformed, negative before; with a free boundary.
    spring : (float, float)
        Stiffness k of a spring in series, a force per length, and its position z at rest, a length: with a free
        boundary F = k (z − δ), with a periodic one and the mean gap ḡ, without absent nodes, F = k (ḡ − z).
    reduced_pressure : float
        Mean pressure over E* h'rms, with h'rms the rms slope of the surface.
    contact_fraction : float
        Share of the nodes that is to be in contact, to one node or 1 %. Its load is searched for by some solves: a mean
        pressure, with adhesion a mean gap, or with a free boundary an approach. ``report["search"]`` says whether it was
        ``reached``; where the contact jumps past it, the nearer side of the jump comes with a `ConvergenceWarning`.
    body : Layer, Coating or Symbol, optional
        Body that deforms, a half-space by default; with a periodic boundary.
    against : array_like, Topography, SurfaceTopography, DataArray or path of a file, optional
        Heights of the surface on the other side, peaks up as they were measured, of the same shape, side lengths and
        unit; flat without it. The other surface is turned over about the y axis, so that it faces this one: the
        heights that are solved are ``heights + against[::-1]``.
    against_modulus : float, optional
        Contact modulus of the body on the other side, an elastic half-space; it is rigid without it. The compliances of
        both add.
    shift : float or (float, float), optional
        Lengths by which the surface on the other side is moved along x and y, with a periodic boundary. They need not
        be whole nodes.
    boundary : {"periodic", "free"}
        What is beyond the heights: the same again, or nothing, so that the half-space is free of traction there. A
        free boundary needs a map that is not a line, and takes four times the memory.
    absent_missing : bool
        Takes missing points for absent nodes, at which nothing faces the half-space, for example around a punch or in
        a hole. There the gap is infinite and the pressures are zero; fractions and the mean gap are of the other
        nodes.
    law : Law or an object of your own, optional
        Adhesion law; none by default. `JKR` is the one of which the work of adhesion alone is known. `Exponential`,
        `MaugisDugdale`, `LennardJones`, `Morse`, `PowerLaw`, `VanDerWaals` and `Tabulated` have a range, `CutOff` ends
        one, and with `Varying` its work of adhesion differs from node to node. An object with ``energy(gap)``,
        ``traction(gap)`` and ``slope(gap)`` of arrays is a law, too: see `check_law`.
    wall : {"hard", "none"}, Penalty or Uzawa
        What keeps the surfaces apart: a rigid wall at zero gap, a law that repels alone, as `LennardJones` and `Morse`
        do, or springs of a stiffness.
    hardness : float or array_like, optional
        Hardness H, a pressure that caps the contact pressure: the surface yields there, and stays flattened by
        ``Solution.plastic_depth``. An array has it at each node, x along the first axis, in Pa where other quantities
        have units. At a hard wall.
    tolerance : float, optional
        Certified relative error at which to stop; 1e-6 by default, 1e-4 in f32.
    max_iterations : int, optional
        Iterations after which to give up; 2000 by default, 20000 with rey2017.
    method : {"default", "rey2017"}
        Preconditioned conjugate gradients, or Algorithm 3 of Rey, Anciaux and Molinari (2017).
    branch : {"loading", "unloading", "both"}, optional
        Equilibrium to find where adhesion has several: that of surfaces pressed together from afar, or that of surfaces
        pressed flat before; by default loading, and unloading under a tension or at a given mean gap. ``"both"`` finds
        this default one, and ``report["other_branch"]`` has the other one, how far away it is, and whether it is the
        same.
    precision : {"f64", "f32"}
        Precision of the solve, and of the fields that it returns.
    start : array_like, Solution or "apart", optional
        Gap from which to start, of the shape (Nx, Ny) of the results. With adhesion it chooses the branch. ``"apart"``
        starts from undeformed bodies at the ``mean_gap``, the ``approach`` or the position at rest of the ``spring``.
        Otherwise a solve with adhesion under a pull finds the bodies sticking together.
    nested : bool, optional
        Solves on coarser grids first, where these resolve the adhesion; ``report["grid_error"]`` estimates the error of
        the grid then. None leaves it to the library, which does so where it is faster.
    observe : callable, optional
        Called with an `Iteration` in every iteration, for example ``asperity.progress()``. ``raise StopIteration`` in
        it ends the solve; any other exception arrives as it was raised, with what was reached as its attribute
        ``solution``.
    stability : bool
        Finds out whether the solution is stable: ``report["stability"]`` and ``mode``.
    leave : bool
        Goes on from an unstable equilibrium to a stable one.
    stiffness : bool
        Finds the contact stiffness, how much the load grows as the bodies approach each other: ``contact_stiffness``
        and ``normal_stiffness`` of the solution.
    resistivities : (float, float), optional
        Electrical resistivities of both half-spaces: with ``stiffness`` the conductance of the contact per area, in
        ``report["conductance"]`` with its relative error, that of the grid included as far as it is known.
    conductivities : (float, float), optional
        Thermal conductivities of both half-spaces: the same for heat.
    accuracy : float, optional
        Relative error that is wanted, such as 0.01. Chooses the tolerance, solves on coarser grids too, and
        interpolates the heights on finer ones until the estimated error is as small: the fields, and ``heights`` and
        ``topography`` of the solution, are on the finest grid. Before the solve, the logger ``asperity`` says how much
        time and memory that is likely to take; ``plan`` of the solution has the same. A tolerance beside it may be
        smaller than the one that it chooses.
    accuracy_of : {"area", "gap", "approach", "pressure", "stiffness"}, optional
        Quantity that has the accuracy: the contact area corrected for its edge, by default; the mean gap or the mean
        pressure, if it is not given; or the contact stiffness.
    memory : float, optional
        Memory that an accuracy may take, in GiB; all that is free by default.
    threads : int, optional
        Threads of this solve; one per core by default. The results do not depend on it.
    whole : bool
        Results on all nodes of a map that `prepare` has mirrored: without it fields, contact and force are those of its
        original.

    Returns
    -------
    Solution
        Also where it has not converged: then with a `ConvergenceWarning`. With an `AccuracyWarning` where it has, and an
        accuracy was not reached.

    Raises
    ------
    ValueError, TypeError
        For input that is refused, with the reason and the remedy.
    KeyboardInterrupt
        By Ctrl-C, within an iteration, with what was reached as its attribute ``solution``.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> x = np.arange(64) / 64 - 0.5
    >>> wave = np.cos(2 * np.pi * x)
    >>> bumps = (wave[:, None] + wave) / 80
    >>> law = asperity.MaugisDugdale(work_of_adhesion=1e-4, range=4e-3)
    >>> solution = asperity.solve(bumps, 1.0, modulus=1.0, mean_gap=0.0235, law=law)
    >>> solution.status, int(solution.contact.sum())
    ('converged', 185)

    A sphere, which is a body of its own, beside Hertz:

    >>> sphere = -(x[:, None] ** 2 + x**2) / 4
    >>> tip = asperity.solve(sphere, 1.0, modulus=1.0, normal_force=0.01, boundary="free")
    >>> hertz = asperity.exact.Hertz(radius=2.0, modulus=1.0).at_load(0.01)
    >>> f"{tip.approach / hertz.approach:.3f}"
    '1.000'

    A contact area that is right to 1 %, on as fine a grid as that takes:

    >>> rough = asperity.surface.self_affine(32, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> right = asperity.solve(rough, modulus=1.0, mean_pressure=5e-3, accuracy=0.01)
    >>> right.report["accuracy"], right.heights.shape
    ({'wanted': 0.01, 'of': 'area', 'reached': True}, (64, 64))
    """
    given = locals()
    load = _control.one(given)
    if branch is not None and start is not None:
        raise ValueError("start chooses the branch: leave out branch, or start")
    scene = Scene.of(given)
    goal = (accuracy, accuracy_of, memory)
    pairs = (_control.pair("resistivities", resistivities), _control.pair("conductivities", conductivities))
    after = (stiffness, *pairs, None)
    found = scene.problem.solve(load, scene.start(start), observe, stability, leave, after, goal)
    plan = found["plan"]
    return scene.solution({**found, "plan": None if plan is None else Plan(*plan)})
