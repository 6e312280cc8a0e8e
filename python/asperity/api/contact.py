"""A contact problem, and its solves."""

from __future__ import annotations

import copy
import os
from collections.abc import Callable
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from .. import _asperity
from ..answers.cycle import Cycle
from ..answers.findings import Plan, Stability
from ..answers.interface import Interface
from ..answers.posed import Posed, Turns
from ..answers.pull_off import PullOff
from ..answers.rows import Rows
from ..answers.solution import Solution, Start
from ..answers.sweep import Sweep
from ..bodies.body import Symbol
from ..bodies.measured import Measured
from ..common.progress import by_default
from ..common.types import AxisOrder, Lengths
from ..common.units import shown
from ..common.warnings import ConvergenceWarning, InputWarning, warn
from ..laws.composite import Varying
from ..laws.formulas import FORMULAS
from ..maps.arrays import field_of
from ..maps.heights import Heights, axes_of, taken
from ..maps.pair import along_both, between
from ..maps.topography import Topography, sides
from ..relaxation.viscoelastic import ELASTIC, Viscoelastic
from .keys import AdhesionKeywords
from .keywords import (
    ContactKeywords,
    CycleAll,
    CycleKeywords,
    InterfaceAll,
    InterfaceKeywords,
    OfPullOffKeywords,
    PullOffAll,
    SolveAll,
    SolveKeywords,
    StabilityKeywords,
    SweepAll,
    SweepKeywords,
    ViscoelasticAll,
    ViscoelasticKeywords,
    described,
    names,
)

if TYPE_CHECKING:
    from typing_extensions import Unpack

R = TypeVar("R", bound=Rows[Any])
T = TypeVar("T")

#: The parameters of laws, which are no keywords next to an object that has its own.
_OF_LAWS = tuple(key for key in names(AdhesionKeywords) if key not in ("law", "wall", "wall_stiffness", "hardness"))

#: Keywords that the law of an interface does not have, per area of a periodic cell.
_NOT_OF_INTERFACE = ("boundary", "hardness", "normal_forces", "approaches", "spring_stiffness", "spring_positions")


def _refuse_beside(name: str, own: Any, keys: dict[str, Any]) -> None:
    """Refuses keys given with an object that has them."""
    for key in own:
        if key in keys:
            raise TypeError(f"{key} is given with {name}, an object that has its own: leave one of them out")


def _pair(name: str, spring: Any) -> tuple[Any, Any]:
    try:
        stiffness, position = spring
    except (TypeError, ValueError):
        raise TypeError(f"{name} is {shown(spring)}: it must be (stiffness, rest)") from None
    return stiffness, position


def _springs(keys: dict[str, Any]) -> None:
    """Takes a spring apart into its keys."""
    spring = keys.pop("spring", None)
    if spring is not None:
        _refuse_beside("spring", ("spring_stiffness", "spring_position"), keys)
        keys["spring_stiffness"], keys["spring_position"] = _pair("spring", spring)


def _once(
    way: Callable[..., T], heights: Heights, lengths: Lengths | None, axes: AxisOrder | None, keywords: Any
) -> T:
    """What a method of a contact returns, of one that is solved once."""
    of_contact = names(ContactKeywords)
    contact = Contact.__new__(Contact)
    contact._pose(heights, lengths, axes, {key: keywords[key] for key in keywords if key in of_contact}, False)
    return way(contact, **{key: keywords[key] for key in keywords if key not in of_contact})


@described(SolveAll)
def solve(
    heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None, **keywords: Unpack[SolveAll]
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
        array (N,) a strip as wide as it is long. A force on a line is that on its width. Needed unless the heights bring
        them.
    axes : {"xy", "yx"}, optional
        Axes of an array of heights, of ``against`` and of ``hardness``: "xy" by default, the first is x, or "yx" for an
        image, [row, column]. A DataArray whose dimensions are named x and y does not need it. Results, ``start`` and
        the works of `Varying` have x along the first axis in any case.
    spring : (float, float)
        Stiffness k of a spring in series, a force per length, and its position z at rest, a length: with a free
        boundary F = k (z − δ), with a periodic one and the mean gap ḡ, without absent nodes, F = k (ḡ − z).
    contact_fraction : float
        Share of the nodes that is to be in contact, to one node or 1 %. Its load is searched for by some solves: a mean
        pressure, with adhesion a mean gap, or with a free boundary an approach. ``report["search"]`` says whether it was
        ``reached``; where the contact jumps past it, the nearer side of the jump comes with a `ConvergenceWarning`.
    modulus : float
        Contact modulus E*, a pressure: E/(1 − ν²), with Young's modulus E and Poisson's ratio ν of the body that deforms.
    body : Layer, Coating or Symbol, optional
        Body that deforms, a half-space by default; with a periodic boundary. ``layer`` or ``coating`` with their
        parameters say the same without an object.
    against : array_like, Topography, SurfaceTopography, DataArray, DataFrame or path of a file, optional
        Heights of the surface on the other side, peaks up as they were measured, of the same shape, side lengths and
        unit; flat without it. The other surface is turned over about the y axis, so that it faces this one: the
        heights that are solved are ``heights + against[::-1]``.
    shift : float or (float, float), optional
        Lengths by which the surface on the other side is moved along x and y, with a periodic boundary. They need not
        be whole nodes.
    boundary : {"periodic", "free"}
        What is beyond the heights: the same again, or nothing, so that the half-space is free of traction there. A
        free boundary needs a map that is not a line, and takes four times the memory.
    absent_missing : bool
        Treats missing points as absent nodes, where nothing faces the half-space, for example around a punch or in a
        hole. There the gap is infinite and the pressures are zero; fractions and the mean gap are of the other nodes.
    law : Law, an object of your own, or str, optional
        Adhesion law, or its name with its parameters, such as ``law="exponential", work_of_adhesion=..., range=...``;
        none by default. `JKR` needs only the work of adhesion. `Exponential`, `MaugisDugdale`, `LennardJones`, `Morse`,
        `PowerLaw`, `VanDerWaals` and `Tabulated` have a range, `CutOff` ends one, and with `Varying` its work of
        adhesion differs from node to node. An object with ``energy(gap)``, ``traction(gap)`` and ``slope(gap)`` of
        arrays is a law, too: see `check_law`.
    wall : {"hard", "none", "penalty", "uzawa"}, Penalty or Uzawa
        What keeps the surfaces apart: a rigid wall at zero gap, a law that repels by itself, such as `LennardJones` and
        `Morse`, or springs of a stiffness, as an object or by name with ``wall_stiffness``.
    hardness : float or array_like, optional
        Hardness H, a pressure that caps the contact pressure: the surface yields there, and stays flattened by
        ``Solution.plastic_depth``. An array has it at each node, with the ``axes`` of the heights, in Pa where other
        quantities have units. At a hard wall.
    branch : {"loading", "unloading", "both"}, optional
        Equilibrium to find where adhesion has several: that of surfaces pressed together from afar, or that of surfaces
        pressed flat before; by default loading, and unloading under a tension or at a given mean gap. ``"both"`` finds
        this default one, and ``report["other_branch"]`` has the other one, how far away it is, and whether it is the
        same.
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
        Continues from an unstable equilibrium to a stable one.
    stiffness : bool
        Finds the contact stiffness, how much the load grows as the bodies approach each other: ``contact_stiffness``
        and ``normal_stiffness`` of the solution.
    resistivities : (float, float), optional
        Electrical resistivities of both half-spaces: with ``stiffness`` the conductance of the contact per area, in
        ``report["conductance"]`` with its relative error, that of the grid included as far as it is known.
    accuracy : float, optional
        Relative error to reach, such as 0.01. Chooses the tolerance, solves on coarser grids too, and interpolates the
        heights on finer ones until the estimated error is small enough: the fields, and ``heights`` and ``topography``
        of the solution, are on the finest grid. Before the solve, the logger ``asperity`` says how much time and memory
        this will probably take; ``plan`` of the solution has the same. A tolerance that is given with it may be smaller
        than the one that it chooses.
    accuracy_of : {"area", "gap", "approach", "pressure"}, optional
        Quantity that has the accuracy: the contact area corrected for its edge, by default; the mean gap or the mean
        pressure, if it is not given; or the contact stiffness.
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
    return _once(Contact.solve, heights, lengths, axes, keywords)


@described(SweepAll)
def sweep(
    heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None, **keywords: Unpack[SweepAll]
) -> Sweep:
    """Solves under many loads, one after the other, each from where the ones before lead.

    Parameters are those of `solve`, but for the loads. Along approaches or springs that grow from a negative one, and
    with a free boundary, it begins with the bodies apart.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as those of `solve`.
    mean_pressures : sequence of float
        Mean external pressures, in their order.
    mean_gaps : sequence of float
        Mean gaps, in their order.
    normal_forces : sequence of float
        Normal forces.
    approaches : sequence of float
        Approaches, with a free boundary.
    springs : sequence of (float, float)
        Stiffness and position at rest of a spring.
    reduced_pressures : sequence of float
        Mean pressures over E* h'rms, with h'rms the rms slope of the surface.
    contact_fractions : sequence of float
        Shares of the nodes in contact to search for, like ``contact_fraction`` of `solve`; two more columns are
        ``wanted_contact_fraction`` and ``reached``.
    stiffness : bool
        Finds the contact stiffness under each load: two more columns, ``contact_stiffness`` and ``normal_stiffness``.
    resistivities, conductivities : (float, float), optional
        Electrical resistivities, or thermal conductivities, of both half-spaces: with ``stiffness`` the columns
        ``electrical_conductance`` or ``thermal_conductance``, per area, and ``conductance_error``.
    leakage : float, optional
        Relative distance of two bounds of the transmissivity of the gap, like those of `leakage`: columns
        ``transmissivity_x_lower``, ``transmissivity_x_upper`` and the same along y.
    out : str or path, optional
        File for the rows, ``.csv`` or ``.jsonl``, as the program writes it from the same inputs. A row is appended as
        soon as it is solved. The same call continues a file that is there, also with loads added to the end of the
        list, and ends with the same bytes as one that was not interrupted; for that it keeps ``.state`` next to the
        file. Rows that the file has are in ``columns`` and are not solved again: iterating gives the states after them.
    fields : str or path, optional
        Folder for gap, pressure and contact pressure of the rows, ``gap-0001.npy`` and so on; with ``out``.
    force : bool
        Starts over, and replaces the files that are there.

    Returns
    -------
    Sweep
        An iterator over `Solution`; ``columns`` has the numbers of all.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> found = asperity.sweep(rough, modulus=1.0, mean_pressures=np.geomspace(1e-3, 1e-2, 3))
    >>> [f"{share:.3f}" for share in found.columns["contact_fraction"]]
    ['0.030', '0.081', '0.219']
    >>> found = asperity.sweep(rough, modulus=1.0, contact_fractions=[0.05, 0.1]).columns
    >>> [f"{share:.2f}" for share in found["contact_fraction"]], [f"{p:.4f}" for p in found["mean_pressure"]]
    (['0.05', '0.10'], ['0.0019', '0.0040'])
    """
    return _once(Contact.sweep, heights, lengths, axes, keywords)


@described(CycleAll)
def cycle(
    heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None, **keywords: Unpack[CycleAll]
) -> Cycle:
    """Follows a branch of equilibria through turning points, in steps that adapt themselves, and locates its jumps.

    A withdrawal ends once the surfaces do not touch, and hardly attract each other: below a thousandth of the greatest
    tension. Parameters that are not here are those of `solve`.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as those of `solve`.
    mean_gaps : sequence of float
        Mean gaps at which the cycle starts, turns and ends: two at least.
    mean_pressures : sequence of float
        The same in mean pressures.
    normal_forces : sequence of float
        The same in normal forces.
    approaches : sequence of float
        The same in approaches, with a free boundary.
    springs : sequence of (float, float)
        The same in the positions at rest of a spring: its stiffness, and the position.
    reduced_pressures : sequence of float
        The same in mean pressures over E* h'rms, with h'rms the rms slope of the surface.
    steps : int
        Least number of steps in a leg.
    smallest_step : float, optional
        Step to which a jump is located, as a share of the leg; if not given, until the work of the step is known to a
        fifth of the energy that the jump dissipates.
    imbalance : float
        Imbalance of energy that a step may have without being a jump, as a share of how much the energy has changed,
        and of twenty times what jumps have dissipated so far: jumps that are smaller are not located one by one.
    smooth : bool
        Whether jumps of the law's traction are smoothed by what the grid resolves.
    out : str or path, optional
        File for the rows, ``.csv`` or ``.jsonl``, as the program writes it from the same inputs. A row is appended as
        soon as it is solved. The same call continues a file that is there, and ends with the same bytes as one that was
        not interrupted; for that it keeps ``.state`` next to the file. Rows that the file has are in ``columns`` and
        are not solved again: iterating gives the states after them.
    fields : str or path, optional
        Folder for gap, pressure and contact pressure at the jumps and of the last row, ``gap-0001.npy`` and so on; with
        ``out``.
    force : bool
        Starts over, and replaces the files that are there.

    Returns
    -------
    Cycle
        An iterator over `Step`; ``columns`` has the numbers of all, ``events`` the jumps.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    >>> law = asperity.Exponential(2e-4, 4e-3)
    >>> found = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.05, 0.012, 0.05], steps=10)
    >>> bool(found.columns["mean_pressure"].min() < 0)  # the pull-off stress
    True
    """
    return _once(Contact.cycle, heights, lengths, axes, keywords)


@described(InterfaceAll, without=_NOT_OF_INTERFACE)
def interface(
    heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None, **keywords: Unpack[InterfaceAll]
) -> Interface:
    """Tabulates the law of an interface over the load, for finite elements.

    Columns are the mean pressure, the mean gap, the closure, which is the approach of the mean planes since the
    undeformed surfaces first touched, the contact area, the contact stiffness, which is the slope of the pressure over
    the closure, with its relative error, and conductance and transmissivity where they are asked for. Parameters are
    those of `sweep`.

    Returns
    -------
    Interface
        ``columns`` has the table, and ``write`` writes it for Abaqus, COMSOL Multiphysics or MOOSE.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> joint = asperity.interface(rough, modulus=1.0, mean_pressures=[0.01, 0.0102], conductivities=(1.0, 2.0))
    >>> law = joint.columns
    >>> slope = np.diff(law["mean_pressure"]) / np.diff(law["closure"])
    >>> bool(np.isclose(slope, law["contact_stiffness"].mean(), rtol=law["stiffness_error"].max()).all())
    True
    """
    return _once(Contact.interface, heights, lengths, axes, keywords)


@described(PullOffAll)
def pull_off(
    heights: Heights, lengths: Lengths | None = None, *, axes: AxisOrder | None = None, **keywords: Unpack[PullOffAll]
) -> PullOff:
    """Finds the pull-off: the greatest tension under which surfaces that adhere stay together.

    The tension grows, each solve from the gap of the one before, until the surfaces come apart; then the pull-off is
    between the two, and the bracket is narrowed. The load is given, as if by a soft spring, so that many contacts may
    break at once; `cycle` draws the surfaces apart and shows each break. Parameters that are not here are those of
    `solve`.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as those of `solve`.
    law : Law or an object of your own
        Adhesion law.
    preload : float, optional
        Mean pressure to which surfaces that come from afar were pressed before. Without it they were pressed flat,
        unless ``branch`` or ``start`` says otherwise.
    rtol : float
        Relative tolerance: width of the bracket over the pull-off.
    accuracy : float, optional
        Relative error of the pull-off to reach, such as 0.05, with `JKR`. The heights are interpolated on finer grids
        until the estimated error is small enough.
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
    return _once(Contact.pull_off, heights, lengths, axes, keywords)


@described(ViscoelasticAll, without=ELASTIC)
def viscoelastic(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    **keywords: Unpack[ViscoelasticAll],
) -> Viscoelastic:
    """Follows the contact of a linear viscoelastic body over time, under loads or approaches at given times.

    The relaxation modulus is E(t) = E₀ (1 − Σ gₖ (1 − exp(−t/τₖ))), with the same Poisson's ratio at all times. The first
    load comes at once, on a body at rest. Between two times the displacement is taken as linear in time, and the error of
    that is of the second order in the step. A long hold may be one step, but for its energies. With adhesion each solve
    begins from the gap of the one before. Parameters that are not here are those of `solve`.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as those of `solve`.
    modulus : float
        Instantaneous contact modulus E₀, a pressure: that of a step at once. The relaxed one is E₀ (1 − Σ gₖ).
    body : Layer, optional
        Body that deforms, a half-space by default; work and energies are without the mean compression of a layer.
    law : Law, an object of your own, or str, optional
        Adhesion law, like that of `solve`, with a range. A law whose traction jumps, such as `MaugisDugdale`, holds
        edges on the nodes.
    prony : sequence of (float, float)
        Shares gₖ of the instantaneous modulus that relax, and their relaxation times τₖ. Shares add up to 1 at most.
    times : sequence of float
        Times of the loads, in the unit of the relaxation times. The same time twice is a step at once.
    mean_pressures : sequence of float
        Mean external pressures at the times.
    mean_gaps : sequence of float
        Mean gaps at the times.
    normal_forces : sequence of float
        Normal forces at the times.
    approaches : sequence of float
        Approaches at the times, with a free boundary.

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
    return _once(Contact.viscoelastic, heights, lengths, axes, keywords)


@described(StabilityKeywords)
def stability(solution: Solution, **load: Unpack[StabilityKeywords]) -> Stability:
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
            "the solution was found with a hardness: a surface that yields does not come back, which the test assumes"
        )
    keys: dict[str, Any] = {key: report.get(key) for key in names(ContactKeywords) if key not in ("shift", "against")}
    if not isinstance(solution.law, str | None):
        keys.update(dict.fromkeys(_OF_LAWS), law=solution.law)
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
        keys.update(dict.fromkeys(solution.body.keys if isinstance(solution.body, Measured) else ()), body=solution.body)
    keys["absent_missing"], keys["whole"] = report["absent_nodes"] > 0, report["part"] == "whole"
    keys["branch"] = None
    contact = Contact.__new__(Contact)
    contact._pose(solution.topography, None, None, keys, False, is_si=report["pressure_unit"] is not None)
    return contact.stability(solution, **load)


class Contact(Posed):
    """A contact problem: heights, bodies, adhesion and solver, which is solved under loads.

    It holds the problem, so that a further solve does not read and copy the heights again. `solve`, `sweep`, `cycle`,
    `interface`, `pull_off` and `viscoelastic` are short for a contact and one call of it, with the same results.
    Solves of one contact in several threads wait for each other.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, as those of `solve`.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> contact = asperity.Contact(rough, modulus=1.0, law="exponential", work_of_adhesion=1e-5, range=4e-3)
    >>> light, heavy = (contact.solve(mean_pressure=p) for p in (0.005, 0.02))
    >>> light.contact_fraction < heavy.contact_fraction
    True
    """

    @described(ContactKeywords)
    def __init__(
        self,
        heights: Heights,
        lengths: Lengths | None = None,
        *,
        axes: AxisOrder | None = None,
        **keywords: Unpack[ContactKeywords],
    ) -> None:
        self._pose(heights, lengths, axes, dict(keywords), is_kept=True)

    def _pose(
        self,
        heights: Heights,
        lengths: Lengths | None,
        axes: AxisOrder | None,
        keywords: dict[str, Any],
        is_kept: bool,
        is_si: bool = False,
    ) -> None:
        keys = {key: value for key, value in keywords.items() if value is not None}
        if "modulus" not in keys:
            raise TypeError("modulus is missing: give the contact modulus E*, a pressure, as modulus=1.0 or '70GPa'")
        self.branch = keys.get("branch")
        against, body = keys.pop("against", None), keys.pop("body", None)
        if isinstance(keys.get("law"), str):
            keys["law"] = keys["law"].lower()
        law = keys.pop("law") if not isinstance(keys.get("law"), str | None) else None
        self.own_law = law
        self.body, self.law = body, law if law is not None else keys.get("law")
        if law is not None:
            _refuse_beside("law", _OF_LAWS, keys)
        if not isinstance(body, Measured | Symbol | None):
            raise TypeError(f"body is {shown(body)}: it must be an asperity.Layer, Coating or Symbol")
        order = axes_of(heights, axes)
        if order == "yx" and isinstance(law, Varying) and not law.knows_axes:
            raise ValueError(
                "heights have y along their first axis, and the works of adhesion of law do not say whether they have: "
                "give asperity.Varying(law, work_of_adhesion, axes='yx'), or axes='xy'"
            )
        if keys.get("law") == "table":
            raise ValueError(
                "law is table: give its values, as law=asperity.Tabulated(gaps, tractions), or its file, as "
                "law=asperity.Tabulated.read(path)"
            )
        wall = keys.get("wall")
        for name, described in (("wall", wall), ("body", body)):
            if isinstance(described, Measured):
                keys.pop(name, None)
                _refuse_beside(name, described.keys, keys)
                keys.update(described.keys)
        hardness = keys.pop("hardness") if np.ndim(keys.get("hardness", 0.0)) > 0 else None
        if hardness is not None and np.asarray(hardness).dtype == bool:
            raise TypeError("hardness is an array of truth values: it must be one of pressures")
        if lengths is not None:
            keys["lengths"] = lengths
        self._keys, self._is_si, self._given = keys, is_si, _asperity.Keywords(keys, law, is_si)
        si = self._given.is_si
        self.pressure_unit = "Pa" if si else None
        self.topography = taken(heights, self._given.numbers("lengths"), axes, si=si)
        boundary, absent_missing = keys.get("boundary", "periodic"), bool(keys.get("absent_missing", False))
        facing, shift = None, self._given.numbers("shift")
        if against is not None:
            moved = along_both(shift)
            self.topography, name = between(
                self.topography, against, moved, axes=axes, boundary=boundary, absent_missing=absent_missing, si=si
            )
            facing = (name, moved)
        elif shift is not None:
            raise ValueError(
                f"shift is {keys['shift']!r}, but there is no surface on the other side: give against, or leave it out"
            )
        # refused where they are unknown
        sides(self.topography)
        self._facing, self._is_kept = facing, is_kept
        self._hardness = None if hardness is None else field_of(hardness, "hardness", order).copy()
        self._posed = self._problem(self.topography, self._given, is_kept)
        self.turns = Turns()
        if not isinstance(heights, Topography | str | os.PathLike) and against is None:
            # the array may change before the heights are asked for
            self.topography = replace(self.topography, heights=self.topography.heights.copy())
        self.beyond_theory = self.problem.beyond_theory
        moduli = [self._given.numbers(key) for key in ("modulus", "against_modulus")]
        self.modulus = 1 / sum(1 / modulus[0] for modulus in moduli if modulus is not None)
        self._warned = set()
        if self.topography.periodic is False and boundary == "periodic":
            warn(
                "the map is not periodic, but the solve treats it as periodic: use asperity.prepare(heights, "
                "mirror=True) or window=0.1, or boundary='free' if the body ends there",
                InputWarning,
            )

    def __repr__(self) -> str:
        given = {**self._keys, "law": self.law, "body": None if isinstance(self.body, Measured) else self.body}
        told = [f"{key}={shown(value)}" for key, value in given.items() if value is not None and key != "lengths"]
        return f"Contact({', '.join([repr(self.topography), *told])})"

    @described(SolveKeywords)
    def solve(self, **keywords: Unpack[SolveKeywords]) -> Solution:
        """Finds the equilibrium under a load, as `asperity.solve`."""
        start, observe, keys = self._split(keywords, is_solve=True)
        _springs(keys)
        with self.turns:
            found = self.problem.solve(keys, self._start(start), observe)
            plan = found["plan"]
            # within the turn, so that one of several threads warns
            return self._solution({**found, "plan": None if plan is None else Plan(*plan)})

    @described(SweepKeywords)
    def sweep(self, **keywords: Unpack[SweepKeywords]) -> Sweep:
        """Solves under many loads, as `asperity.sweep`."""
        return self._rows(Sweep, "sweep", keywords)

    @described(CycleKeywords)
    def cycle(self, **keywords: Unpack[CycleKeywords]) -> Cycle:
        """Follows a branch of equilibria through turning points, as `asperity.cycle`."""
        smooth = keywords.pop("smooth", None)
        return self._rows(Cycle, "cycle", {**keywords, "sharp": smooth is not None and not smooth})

    @described(InterfaceKeywords, without=_NOT_OF_INTERFACE)
    def interface(self, **keywords: Unpack[InterfaceKeywords]) -> Interface:
        """Tabulates the law of an interface over the load, as `asperity.interface`."""
        return self._rows(Interface, "interface", keywords)

    @described(OfPullOffKeywords)
    def pull_off(self, **keywords: Unpack[OfPullOffKeywords]) -> PullOff:
        """Finds the pull-off, as `asperity.pull_off`."""
        start, observe, keys = self._split(keywords)
        if "accuracy" in keys and start is not None:
            raise ValueError("an accuracy takes finer grids, which have no start: leave out start, or accuracy")
        with self.turns:
            found = self.problem.pull_off(keys, self._start(start), observe)
        solution = self._solution(found)
        if found["shortfall"] is not None:
            warn(found["shortfall"], ConvergenceWarning)
        entries = found["pull_off"]
        pressure, force = entries.pop("pull_off_pressure"), entries.pop("pull_off_force")
        return PullOff(pressure, force, **entries, solution=solution)

    @described(ViscoelasticKeywords)
    def viscoelastic(self, **keywords: Unpack[ViscoelasticKeywords]) -> Viscoelastic:
        """Follows a viscoelastic body over time, as `asperity.viscoelastic`."""
        start, observe, keys = self._split(keywords)
        return Viscoelastic(self, keys, start, observe)

    @described(StabilityKeywords)
    def stability(self, solution: Solution, **load: Unpack[StabilityKeywords]) -> Stability:
        """Finds out whether a solution is stable, as `asperity.stability`."""
        keys: dict[str, Any] = {key: value for key, value in load.items() if value is not None}
        _springs(keys)
        if not keys:
            name, value = solution.report["control"].replace("-", "_"), solution.report["control_value"]
            stiffness = solution.report["spring_stiffness"]
            spring = {"spring_stiffness": stiffness, "spring_position": value}
            keys = spring if name == "spring" else {name: value}
        gap = np.asarray(solution.whole_gap, dtype=np.float64).reshape(self.topography.heights.shape)
        with self.turns:
            found = self.problem.stability(keys, gap, solution.relative_error)
        return Stability(**{**found, "mode": solution.part_of(found["mode"])})

    def _split(self, keywords: Any, *, is_solve: bool = False) -> tuple[Start, Any, dict[str, Any]]:
        """The start, the observer, and the keys of a call."""
        keys = {key: value for key, value in keywords.items() if value is not None}
        start, observe = keys.pop("start", None), keys.pop("observe", None) or by_default()
        if self.branch is not None and start is not None:
            raise ValueError("start chooses the branch: leave out branch, or start")
        if self.branch == "both" and not is_solve:
            raise ValueError("branch is both: that compares two solves under one load: use solve, or give one branch")
        return start, observe, keys

    def _rows(self, kind: type[R], way: str, keywords: Any) -> R:
        """The rows of a table, with a problem of their own, as they are solved when they are asked for."""
        start, observe, keys = self._split(keywords)
        file = (keys.pop("out", None), keys.pop("fields", None), keys.pop("force", False))
        springs = keys.pop("springs", None)
        parts = [keys]
        if springs is not None:
            _refuse_beside("springs", ("spring_stiffness", "spring_positions"), keys)
            pairs = [_pair("springs", spring) for spring in springs]
            parts = [
                {"spring_stiffness": stiffness, "spring_positions": [position for _, position in group]}
                for stiffness, group in groupby(pairs, key=lambda pair: pair[0])
            ]
            if not parts:
                raise ValueError("springs is empty: give at least one pair (stiffness, rest)")
            parts[0].update(keys)
        contact = self
        if self._is_kept:
            contact = copy.copy(self)
            contact._posed, contact.turns = self._problem(self.topography, self._given, False), Turns()
            contact._is_kept = False
            contact._warned = set()
        return kind(contact, way, parts, start, observe, file)


# by this name it is found in other processes
Contact.__module__ = "asperity"
