"""A solve of a contact problem, and the stability of its solution."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numpy.typing import ArrayLike

from .._asperity import Iteration
from ..answers.findings import Stability
from ..answers.solution import Solution, Start
from ..bodies.body import Body
from ..bodies.parameters import Parameters
from ..bodies.wall import Penalty, Uzawa
from ..common.types import (
    AccuracyOf,
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
from ..laws.formulas import FORMULAS
from ..maps.heights import Heights
from .contact import Contact, solve_once
from .keywords import OF_LAWS, defaults, pick


@suggests
def solve(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity | None = None,
    mean_pressure: Quantity | None = None,
    mean_gap: Quantity | None = None,
    normal_force: Quantity | None = None,
    approach: Quantity | None = None,
    spring: tuple[Quantity, Quantity] | None = None,
    spring_stiffness: Quantity | None = None,
    spring_position: Quantity | None = None,
    reduced_pressure: float | None = None,
    contact_fraction: float | None = None,
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
    accuracy_of: AccuracyOf | None = None,
    memory: float | None = None,
    nested: bool | None = None,
    tolerance: float | None = None,
    method: Method | None = "default",
    max_iterations: int | None = None,
    precision: Precision | None = "f64",
    threads: int | None = None,
    stability: bool | None = False,
    leave: bool | None = False,
    stiffness: bool | None = False,
    resistivities: tuple[Quantity, Quantity] | None = None,
    conductivities: tuple[Quantity, Quantity] | None = None,
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
) -> Solution:
    """Presses a rough surface against an elastic half-space.

    Give one load: ``mean_pressure``, ``mean_gap``, ``normal_force``, ``approach``, ``spring``, ``reduced_pressure`` or
    ``contact_fraction``. Quantities are numbers in any consistent units, or all are strings with units, such as
    ``modulus="70GPa"`` and ``law=asperity.Exponential("50mJ/m2", "1nm")``. The map is then converted to metres, and all
    results are in SI units.

    Parameters
    ----------
    heights : array_like, Topography, SurfaceTopography, DataArray, DataFrame or path of a file
        Heights of the rigid surface, shape (Nx, Ny), or (N,) on a line; peaks up. Any float type, order or stride. An
        array is copied, for the solver and for the results, and may change afterwards; a Topography is copied for
        the solver alone. Missing points, NaN or masked, are refused: `prepare` fills them, or ``absent_missing`` takes
        them as they are.
    lengths : float or (float, float), optional
        Side lengths (Lx, Ly) = (Nx Δx, Ny Δy), in the unit of the heights; one alone means square cells, and of an
        array (N,) a strip as wide as it is long. A force on a line is that on its width. Needed unless the heights
        bring them.
    axes : {"xy", "yx"}, optional
        Axes of an array of heights, of ``against`` and of ``hardness``: "xy" by default, the first is x, or "yx" for an
        image, [row, column]. A DataArray with dimensions named x and y does not need it. Results, ``start`` and
        the works of `Varying` have x along the first axis in any case.
    modulus : float
        Contact modulus E*, a pressure: E/(1 − ν²), with Young's modulus E and Poisson's ratio ν of the body that
        deforms.
    mean_pressure : float or str, optional
        Mean external pressure that is held, over the area of the map, compression positive.
    mean_gap : float or str, optional
        Mean gap that is held, a length; with a periodic boundary.
    normal_force : float or str, optional
        Normal force that is held, compression positive: the mean pressure times the area of the map.
    approach : float or str, optional
        Approach that is held, with a free boundary or over a layer or a coating: how far the bodies have moved towards
        each other from the position of first touch without deformation; negative before it.
    spring : (float, float)
        Stiffness k of a spring in series, a force per length, and its position z at rest, a length: with a free
        boundary F = k (z − δ), with a periodic one and the mean gap ḡ, without absent nodes, F = k (ḡ − z).
    spring_stiffness : float or str, optional
        Stiffness of a spring in series, such as a machine or a cantilever, a force per length; needs spring_position.
    spring_position : float or str, optional
        Position Z of the spring's far end, at which the spring is relaxed: with a free boundary an approach, F = K (Z -
        D); with a periodic one a mean gap, F = K (G - Z).
    reduced_pressure : float, optional
        Mean pressure that is held, over the contact modulus and the rms slope of the surface: p/(E* h'rms).
    contact_fraction : float
        Share of the nodes that is to be in contact, to one node or 1 %. Its load is searched for by some solves: a mean
        pressure, with adhesion a mean gap, or with a free boundary an approach. ``report["search"]`` says whether it
        was ``reached``; where the contact jumps past it, the nearer side of the jump comes with a `ConvergenceWarning`.
    law : Law, an object of your own, or str, optional
        Adhesion law, or its name with its parameters, such as ``law="exponential", work_of_adhesion=..., range=...``;
        none by default. `JKR` needs only the work of adhesion. `Exponential`, `MaugisDugdale`, `LennardJones`, `Morse`,
        `PowerLaw`, `VanDerWaals` and `Tabulated` have a range, `CutOff` ends one, and with `Varying` its work of
        adhesion differs from node to node. An object with ``energy(gap)``, ``traction(gap)`` and ``slope(gap)`` of
        arrays is a law, too: see `check_law`.
    work_of_adhesion : float or str, optional
        Work of adhesion, an energy per area; all that jkr needs.
    range : float or str, optional
        Range of adhesion, a length; for lennard-jones and van-der-waals the distance of the surfaces in contact.
    exponent : float, optional
        Exponent of the energy of a power law.
    hamaker : float or str, optional
        Hamaker's constant of van-der-waals, an energy.
    cut_off : float or str, optional
        Gap at which a law that never ends is cut off, smoothly and with all of its work of adhesion.
    branch : {"loading", "unloading", "both"}, optional
        Equilibrium to find where adhesion has several: with surfaces pressed together from afar, or with surfaces
        pressed flat before; by default loading, and unloading under a tension or at a given mean gap. ``"both"`` finds
        this default one, and ``report["other_branch"]`` has the other one, how far away it is, and whether it is the
        same.
    boundary : {"periodic", "free"}
        What is beyond the heights: the same again, or nothing, so that the half-space is free of traction there. A
        free boundary needs a map that is not a line, and takes four times the memory.
    absent_missing : bool
        Treats missing points as absent nodes, where nothing faces the half-space, for example around a punch or in a
        hole. There the gap is infinite and the pressures are zero; fractions and the mean gap are of the other nodes.
    against : array_like, Topography, SurfaceTopography, DataArray, DataFrame or path of a file, optional
        Heights of the surface on the other side, peaks up as they were measured, of the same shape, side lengths and
        unit; flat without it. The other surface is turned over about the y axis, so that it faces this one: the
        heights that are solved are ``heights + against[::-1]``.
    against_modulus : float or str, optional
        Contact modulus E/(1 - nu^2) of the second body, an elastic half-space [default: it is rigid].
    shift : float or (float, float), optional
        Lengths by which the surface on the other side is moved along x and y, with a periodic boundary. They need not
        be whole nodes.
    whole : bool
        Results on all nodes of a map that `prepare` has mirrored: without it fields, contact and force are on its
        original.
    body : Layer, Coating or Symbol, optional
        Body that deforms, a half-space by default; with a periodic boundary. ``layer`` or ``coating`` with their
        parameters say the same without an object.
    layer : float or str, optional
        Thickness of an elastic layer on a rigid base, instead of a half-space; needs poisson.
    base : {"bonded", "sliding"}, optional
        Hold of the base on the layer: bonded, or sliding without friction [default: bonded].
    coating : float or str, optional
        Thickness of an elastic coating on the half-space; modulus is then the modulus of the substrate; needs
        coating_modulus, coating_poisson and poisson.
    coating_modulus : float or str, optional
        Contact modulus E/(1 - nu^2) of the coating, a pressure.
    coating_poisson : float, optional
        Poisson's ratio of the coating.
    plate : float or str, optional
        Bending stiffness D = E t^3/(12 (1 - nu^2)) of a plate on the half-space; modulus is then the modulus of the
        half-space.
    poisson : float, optional
        Poisson's ratio of the layer, or of the substrate under a coating.
    hardness : float or array_like, optional
        Hardness H, a pressure that caps the contact pressure: the surface yields there, and stays flattened by
        ``Solution.plastic_depth``. An array has it at each node, with the ``axes`` of the heights, in Pa where other
        quantities have units. At a hard wall.
    wall : {"hard", "none", "penalty", "uzawa"}, Penalty or Uzawa
        What keeps the surfaces apart: a rigid wall at zero gap, a law that repels by itself, such as `LennardJones` and
        `Morse`, or springs of a stiffness, as an object or by name with ``wall_stiffness``.
    wall_stiffness : float or str, optional
        Stiffness of the springs of a penalty or uzawa wall, a pressure per length.
    accuracy : float, optional
        Relative error to reach, such as 0.01. Chooses the tolerance, solves on coarser grids too, and interpolates the
        heights on finer ones until the estimated error is small enough: the fields, and ``heights`` and ``topography``
        of the solution, are on the finest grid. Before the solve, the logger ``asperity`` says how much time and memory
        this will probably take; ``plan`` of the solution has the same. A tolerance that is given with it may be smaller
        than the one that it chooses.
    accuracy_of : {"area", "gap", "approach", "pressure"}, optional
        Quantity that has the accuracy: the contact area corrected for its edge, by default; or the mean gap, the approach
        or the mean pressure, if it is not given.
    memory : float, optional
        Memory that accuracy may take, in GiB [default: all that is free].
    nested : bool, optional
        Solves on coarser grids first, where these resolve the adhesion; ``report["grid_error"]`` estimates the error of
        the grid then. None leaves it to the library, which does so where it is faster.
    tolerance : float, optional
        Certified relative error at which to stop [default: 1e-6, in f32 and in cycles 1e-4].
    method : {"default", "rey2017"}, optional
        Preconditioned conjugate gradients, or the algorithm of Rey et al. (2017).
    max_iterations : int, optional
        Iterations after which to give up [default: 2000, with rey2017 20000].
    precision : {"f64", "f32"}, optional
        Precision of the solve, and of the fields it writes.
    threads : int, optional
        Threads; the results do not depend on it [default: one per core].
    stability : bool
        Finds out whether the solution is stable: ``report["stability"]`` and ``mode``.
    leave : bool
        Continues from an unstable equilibrium to one that is not.
    stiffness : bool
        Finds the contact stiffness, how much the load grows as the bodies approach each other: ``contact_stiffness``
        and ``normal_stiffness`` of the solution.
    resistivities : (float, float), optional
        Electrical resistivities of both half-spaces: with ``stiffness`` the conductance of the contact per area, in
        ``report["conductance"]`` with its relative error, which includes the error of the grid as far as it is known.
    conductivities : tuple[float or str, float or str], optional
        Thermal conductivities of both half-spaces: the same for heat.
    start : array_like, Solution or "apart", optional
        Gap from which to start, of the shape (Nx, Ny) of the results. With adhesion it chooses the branch. ``"apart"``
        starts from undeformed bodies at the ``mean_gap``, the ``approach`` or the position at rest of the ``spring``.
        Otherwise a solve with adhesion under a pull finds the bodies sticking together.
    observe : callable, optional
        Called with an `Iteration` in every iteration, for example ``asperity.progress()``. ``raise StopIteration`` in
        it ends the solve; any other exception arrives as it was raised, with what was reached as its attribute
        ``solution``.

    Returns
    -------
    Solution
        Also where it has not converged: then with a `ConvergenceWarning`. With an `AccuracyWarning` where it has, and
        an accuracy was not reached.

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

    A sphere, which is a body of its own, compared with Hertz:

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
    return solve_once(Contact.solve, locals())


@suggests
def stability(
    solution: Solution,
    *,
    mean_pressure: Quantity | None = None,
    mean_gap: Quantity | None = None,
    normal_force: Quantity | None = None,
    approach: Quantity | None = None,
    spring: tuple[Quantity, Quantity] | None = None,
    spring_stiffness: Quantity | None = None,
    spring_position: Quantity | None = None,
    reduced_pressure: float | None = None,
    contact_fraction: float | None = None,
) -> Stability:
    """Finds out whether a solution is stable: under its own load, or under another one that would hold it.

    Parameters
    ----------
    solution : Solution
        Solution of `solve`, or of a sweep or a cycle.
    mean_pressure, mean_gap, normal_force, approach, spring : optional
        Load that takes the place of the solution's own, as `solve` takes it: an equilibrium that is stable at a given
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
    load, report = locals(), solution.report
    if report["wall"] == "uzawa":
        raise ValueError(
            "the solution was found with asperity.Uzawa, whose multipliers it does not have: give stability=True to its solve"
        )
    if report["hardness"] is not None:
        raise ValueError(
            "the solution was found with a hardness: a surface that yields does not come back, which the test assumes"
        )
    keys: dict[str, Any] = {
        key: report.get(key) for key in defaults(Contact.__init__) if key not in ("shift", "against")
    }
    if not isinstance(solution.law, str | None):
        keys.update(dict.fromkeys(OF_LAWS), law=solution.law)
    elif report["work_of_adhesion_map"] is not None:
        raise ValueError(
            "the solution was loaded from a folder, which does not keep works of adhesion that vary: give the law anew, as "
            "asperity.load(folder, law=asperity.Varying(law, work_of_adhesion))"
        )
    elif solution.law not in (None, "none", *FORMULAS):
        raise ValueError(
            f"the solution was loaded from a folder, which keeps no values of the law {solution.law}: give it anew, as "
            "asperity.load(folder, law=asperity.Tabulated(gaps, tractions)), or law= and one of your own"
        )
    elif solution.law == "jkr":
        # that of the report is of the grid
        keys["range"] = None
    if solution.body is not None:
        keys.update(
            dict.fromkeys(solution.body.keys if isinstance(solution.body, Parameters) else ()), body=solution.body
        )
    keys["absent_missing"], keys["whole"] = report["absent_nodes"] > 0, report["part"] == "whole"
    keys["branch"] = None
    contact = Contact.from_numbers(solution.topography, keys, report["pressure_unit"] is not None)
    return contact.stability(solution, **pick(Contact.stability, load))
