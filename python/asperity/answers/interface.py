"""The law of an interface over the load, for codes of finite elements."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING

from .. import _asperity
from ..common.types import Code
from .sweep import Sweep

if TYPE_CHECKING:
    from pathlib import Path


class Interface(Sweep):
    """A sweep with the law of an interface as its columns."""

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

        path, adhesive = Path(name), self._contact.adheres
        units = (self._contact.topography.unit, self._contact.pressure_unit)
        files = _asperity.interface_files(code, self.rows, adhesive, path.name, units)
        written = [path.with_name(path.name + ending) for ending, _ in files]
        for file, (_, text) in zip(written, files, strict=True):
            file.write_text(text, encoding="utf-8")
        return written
