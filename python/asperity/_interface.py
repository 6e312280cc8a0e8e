"""The law of an interface over the load, for codes of finite elements."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from os import PathLike
from typing import TYPE_CHECKING, Any

from . import _asperity, _control
from ._asperity import Iteration
from ._body import Body
from ._columns import following
from ._pair import Shift
from ._scene import Scene
from ._solution import Start
from ._sweep import Sweep
from ._topography import Heights
from ._types import AxisOrder, Branch, Code, Lengths, Method, OwnLaw, Precision, Quantity
from ._wall import Wall

if TYPE_CHECKING:
    from pathlib import Path


class Interface(Sweep):
    """A sweep whose columns are the law of an interface."""

    def write(self, name: str | PathLike[str], code: Code) -> list[Path]:
        """Writes the files that a code of finite elements reads; solves what is left.

        Pressure over closure, and conductance and transmissivity over pressure, from no pressure on: with adhesion a
        row needs a pressure of zero, or less.

        Parameters
        ----------
        name : str or path
            Name of the interface, with a folder before it: ``steel`` becomes ``steel.inp``, or ``steel.pressure.txt``
            and ``steel.conductance.txt``.
        code : {"abaqus", "comsol", "moose"}
            Surface interaction of Abaqus, interpolation functions of COMSOL Multiphysics, or data files of
            PiecewiseLinear in MOOSE.

        Returns
        -------
        list of Path
        """
        self.run()
        failed = [k for k, row in enumerate(self.rows, 1) if row["status"] != "converged"]
        if failed:
            remedy = "solve it again with more max_iterations or finer loads"
            raise ValueError(f"row {failed[0]} has not converged: {remedy}")
        from pathlib import Path

        path, adhesive = Path(name), self._scene.adhesion is not None
        units = (self._scene.topography.unit, self._scene.pressure_unit)
        files = _asperity.interface_files(code, self.rows, adhesive, path.name, units)
        written = [path.with_name(path.name + ending) for ending, _ in files]
        for file, (_, text) in zip(written, files, strict=True):
            file.write_text(text, encoding="utf-8")
        return written


def interface(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    modulus: Quantity,
    mean_pressures: Iterable[Quantity] | None = None,
    mean_gaps: Iterable[Quantity] | None = None,
    reduced_pressures: Iterable[float] | None = None,
    body: Body | None = None,
    against: Heights | None = None,
    against_modulus: Quantity | None = None,
    shift: Shift | None = None,
    absent_missing: bool = False,
    law: OwnLaw | None = None,
    wall: Wall = "hard",
    tolerance: float | None = None,
    max_iterations: int | None = None,
    method: Method = "default",
    branch: Branch | None = None,
    precision: Precision = "f64",
    start: Start = None,
    observe: Callable[[Iteration], object] | None = None,
    resistivities: tuple[Quantity, Quantity] | None = None,
    conductivities: tuple[Quantity, Quantity] | None = None,
    leakage: float | None = None,
    threads: int | None = None,
    whole: bool = False,
    out: str | PathLike[str] | None = None,
    force: bool = False,
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
    given: dict[str, Any] = {**locals(), "stiffness": True, "boundary": "periodic"}
    loads = _control.many(given)
    scene = Scene.of({**given, "branch": _control.only(branch)})
    return Interface(scene, loads, start, observe, following(given), interface=True, file=(out, None, force))
