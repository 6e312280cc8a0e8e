"""Equilibria under one load after the other."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from os import PathLike
from typing import TYPE_CHECKING, Any

from . import _control, _plot
from ._asperity import Iteration
from ._body import Body
from ._columns import Rows, following
from ._pair import Shift
from ._scene import Scene
from ._solution import Solution, Start
from ._topography import Heights
from ._types import AxisOrder, Boundary, Branch, Lengths, Method, OwnLaw, Precision, Quantity
from ._wall import Hardness, Wall

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Sweep(Rows[Solution]):
    """The solutions of a sweep, each found when it is asked for, and the columns of their numbers.

    Iterating gives a `Solution` for each load. Only the numbers are kept, so that a sweep needs the memory of one
    solve.
    """

    def __len__(self) -> int:
        """The number of loads."""
        return len(self.rows) if self._ended else len(self._loads)

    def __next__(self) -> Solution:
        return self._solve()

    def __repr__(self) -> str:
        return f"Sweep({len(self.rows)} of {len(self)} loads solved)"

    def plot(self, ax: Axes | None = None, *, pressure_unit: str | None = None) -> Axes:
        """Draws the contact fraction over the mean pressure; needs matplotlib, and solves what is left.

        Parameters
        ----------
        ax : matplotlib Axes, optional
            Axes to draw on; new ones by default.
        pressure_unit : str, optional
            Unit for the axis.

        Returns
        -------
        matplotlib Axes
        """
        return _plot.sweep(self.columns, ax, pressure_unit or self._scene.pressure_unit)


def sweep(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity,
    mean_pressures: Iterable[Quantity] | None = None,
    mean_gaps: Iterable[Quantity] | None = None,
    normal_forces: Iterable[Quantity] | None = None,
    approaches: Iterable[Quantity] | None = None,
    springs: Iterable[tuple[Quantity, Quantity]] | None = None,
    reduced_pressures: Iterable[float] | None = None,
    contact_fractions: Iterable[float] | None = None,
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
    branch: Branch | None = None,
    precision: Precision = "f64",
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
    stiffness: bool = False,
    resistivities: tuple[Quantity, Quantity] | None = None,
    conductivities: tuple[Quantity, Quantity] | None = None,
    leakage: float | None = None,
    threads: int | None = None,
    whole: bool = False,
    out: str | PathLike[str] | None = None,
    fields: str | PathLike[str] | None = None,
    force: bool = False,
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
        Shares of the nodes that are to be in contact, as ``contact_fraction`` of `solve`; two more columns are
        ``wanted_contact_fraction`` and ``reached``.
    stiffness : bool
        Finds the contact stiffness under each load: two more columns, ``contact_stiffness`` and ``normal_stiffness``.
    resistivities, conductivities : (float, float), optional
        Electrical resistivities, or thermal conductivities, of both half-spaces: with ``stiffness`` the columns
        ``electrical_conductance`` or ``thermal_conductance``, per area, and ``conductance_error``.
    leakage : float, optional
        Relative distance of two bounds between which the transmissivity of the gap is found, as by `leakage`: columns
        ``transmissivity_x_lower``, ``transmissivity_x_upper`` and the same along y.
    out : str or path, optional
        File for the rows, ``.csv`` or ``.jsonl``, as the tool writes it from the same inputs. A row is appended as it
        comes. The same call goes on with a file that is there, also with loads added to the end of the list, and ends
        with the same bytes as one that was not interrupted; for that it keeps ``.state`` beside the file. Rows that
        the file has are in ``columns`` and are not solved again: iterating gives the states behind them.
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
    given = locals()
    loads = _control.many(given)
    scene = Scene.of({**given, "branch": _control.only(branch)})
    return Sweep(scene, loads, start, observe, following(given), file=(out, fields, force))
