"""Contact problems under many loads: sweeps, cycles, and laws of interfaces."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from os import PathLike

from numpy.typing import ArrayLike

from .._asperity import Iteration
from ..answers.cycle import Cycle
from ..answers.interface import Interface
from ..answers.solution import Start
from ..answers.sweep import Sweep
from ..bodies.body import Body
from ..bodies.wall import Penalty, Uzawa
from ..common.types import (
    AccuracyOfCycle,
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
from .contact import Contact, solve_once


@suggests
def sweep(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity | None = None,
    mean_pressures: Iterable[Quantity] | None = None,
    mean_gaps: Iterable[Quantity] | None = None,
    normal_forces: Iterable[Quantity] | None = None,
    approaches: Iterable[Quantity] | None = None,
    springs: Iterable[tuple[Quantity, Quantity]] | None = None,
    spring_stiffness: Quantity | None = None,
    spring_positions: Iterable[Quantity] | None = None,
    reduced_pressures: Iterable[float] | None = None,
    contact_fractions: Iterable[float] | None = None,
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
    tolerance: float | None = None,
    method: Method | None = "default",
    max_iterations: int | None = None,
    precision: Precision | None = "f64",
    threads: int | None = None,
    stiffness: bool | None = False,
    resistivities: tuple[Quantity, Quantity] | None = None,
    conductivities: tuple[Quantity, Quantity] | None = None,
    leakage: float | None = None,
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
    out: str | PathLike[str] | None = None,
    force: bool | None = False,
    fields: str | PathLike[str] | None = None,
) -> Sweep:
    """Solves under many loads, one after the other, each from where the ones before lead.

    `solve` has the parameters besides the loads. Along approaches or springs that grow from a negative one, and
    with a free boundary, it begins with the bodies apart.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as `solve` takes
        them.
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
    spring_stiffness, spring_positions : float, sequence of float
        One stiffness with many positions at rest, in the place of ``springs``.
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
        Relative distance of two bounds of the transmissivity of the gap, as `leakage` finds them: columns
        ``transmissivity_x_lower``, ``transmissivity_x_upper`` and the same along y.
    out : str or path, optional
        File for the rows, ``.csv`` or ``.jsonl``, as the program writes it from the same inputs. A row is appended as
        soon as it is solved. The same call continues a file that is there, also with loads added to the end of the
        list, and ends with the same bytes as one that was not interrupted; for that it keeps ``.state`` next to the
        file. Rows that the file has are in ``columns`` and are not solved again: iterating gives the states after them.
    force : bool
        Starts over, and replaces the files that are there.
    fields : str or path, optional
        Folder for gap, pressure and contact pressure of the rows, ``gap-0001.npy`` and so on; with ``out``.

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
    return solve_once(Contact.sweep, locals())


@suggests
def cycle(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity | None = None,
    mean_pressures: Iterable[Quantity] | None = None,
    mean_gaps: Iterable[Quantity] | None = None,
    normal_forces: Iterable[Quantity] | None = None,
    approaches: Iterable[Quantity] | None = None,
    springs: Iterable[tuple[Quantity, Quantity]] | None = None,
    spring_stiffness: Quantity | None = None,
    spring_positions: Iterable[Quantity] | None = None,
    reduced_pressures: Iterable[float] | None = None,
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
    accuracy_of: AccuracyOfCycle | None = None,
    memory: float | None = None,
    tolerance: float | None = None,
    method: Method | None = "default",
    max_iterations: int | None = None,
    precision: Precision | None = "f64",
    threads: int | None = None,
    steps: int | None = 50,
    smallest_step: float | None = None,
    imbalance: float | None = 0.0001,
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
    out: str | PathLike[str] | None = None,
    force: bool | None = False,
    smooth: bool | None = True,
    fields: str | PathLike[str] | None = None,
) -> Cycle:
    """Follows a branch of equilibria through turning points, in steps that adapt themselves, and locates its jumps.

    A withdrawal ends once the surfaces do not touch, and hardly attract each other: below a thousandth of the greatest
    tension. `solve` has the other parameters.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the rigid surface, with x along the first axis, or the second if ``axes`` is "yx", as `solve` takes
        them.
    mean_pressures : sequence of float
        The same in mean pressures.
    mean_gaps : sequence of float
        Mean gaps at which the cycle starts, turns and ends: two at least.
    normal_forces : sequence of float
        The same in normal forces.
    approaches : sequence of float
        The same in approaches, with a free boundary.
    springs : sequence of (float, float)
        The same in the positions at rest of a spring: its stiffness, and the position.
    spring_stiffness, spring_positions : float, sequence of float
        One stiffness with many positions at rest, in the place of ``springs``.
    reduced_pressures : sequence of float
        The same in mean pressures over E* h'rms, with h'rms the rms slope of the surface.
    accuracy : float, optional
        Relative error of the limit of no range to reach, such as 0.1, with `JKR`. The cycle is followed on coarser grids
        first, and the heights are interpolated on finer ones until the error that is to be expected is small enough: the
        states are on that grid, which the logger ``asperity`` says, and ``limit`` has what was reached.
    accuracy_of : {"work", "tension"}, optional
        Quantity that has the accuracy: the work done by the load, by default, or the greatest tension.
    memory : float, optional
        Memory that an accuracy may take, in GiB; all that is free by default.
    steps : int
        Least number of steps in a leg.
    smallest_step : float, optional
        Step to which a jump is located, as a share of the leg; if not given, until the work of the step is known to a
        fifth of the energy that the jump dissipates.
    imbalance : float
        Imbalance of energy that a step may have without being a jump, as a share of how much the energy has changed,
        and of twenty times what jumps have dissipated so far: jumps that are smaller are not located one by one.
    out : str or path, optional
        File for the rows, ``.csv`` or ``.jsonl``, as the program writes it from the same inputs. A row is appended as
        soon as it is solved. The same call continues a file that is there, and ends with the same bytes as one that was
        not interrupted; for that it keeps ``.state`` next to the file. Rows that the file has are in ``columns`` and
        are not solved again: iterating gives the states after them.
    force : bool
        Starts over, and replaces the files that are there.
    smooth : bool
        Whether jumps of the law's traction are smoothed by what the grid resolves.
    fields : str or path, optional
        Folder for gap, pressure and contact pressure at the jumps and of the last row, ``gap-0001.npy`` and so on; with
        ``out``.

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
    return solve_once(Contact.cycle, locals())


@suggests
def interface(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity | None = None,
    mean_pressures: Iterable[Quantity] | None = None,
    mean_gaps: Iterable[Quantity] | None = None,
    reduced_pressures: Iterable[float] | None = None,
    law: LawName | OwnLaw | None = None,
    work_of_adhesion: Quantity | None = None,
    range: Quantity | None = None,
    exponent: float | None = None,
    hamaker: Quantity | None = None,
    cut_off: Quantity | None = None,
    branch: Branches | None = None,
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
    wall: WallName | Penalty | Uzawa | None = "hard",
    wall_stiffness: Quantity | None = None,
    tolerance: float | None = None,
    method: Method | None = "default",
    max_iterations: int | None = None,
    precision: Precision | None = "f64",
    threads: int | None = None,
    resistivities: tuple[Quantity, Quantity] | None = None,
    conductivities: tuple[Quantity, Quantity] | None = None,
    leakage: float | None = None,
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
    out: str | PathLike[str] | None = None,
    force: bool | None = False,
) -> Interface:
    """Tabulates the law of an interface over the load, for finite elements.

    Columns are the mean pressure, the mean gap, the closure, which is the approach of the mean planes since the
    undeformed surfaces first touched, the contact area, the contact stiffness, which is the slope of the pressure over
    the closure, with its relative error, and conductance and transmissivity where they are asked for. `sweep` has the
    parameters.

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
    return solve_once(Contact.interface, locals())
