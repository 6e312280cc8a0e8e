"""Force curves of files: columns of text with their units, and the files of instruments by the package afmformats."""

from __future__ import annotations

import os
import warnings
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _asperity
from ...common.progress import show_progress
from ...common.types import Quantity
from ...common.warnings import InputWarning
from ...common.words import suggests
from ..branches import order_branches
from ..tips import Array
from . import afm, texts
from .columns import Column, factor, moving


class ForceCurve(NamedTuple):
    """The columns of a force curve, in SI units, as `fit_curve` takes them with the units "m" and "N".

    Attributes
    ----------
    z : ndarray
        Positions, greater as the bodies come closer.
    force : ndarray
        Forces, compression positive.
    """

    z: Array
    force: Array


ForceCurve.__module__ = "asperity"


@suggests
def read_curve(
    path: str | os.PathLike[str],
    *,
    z: int | str | None = None,
    force: int | str | None = None,
    length_unit: str | None = None,
    force_unit: str | None = None,
    spring_stiffness: Quantity | None = None,
    sensitivity: Quantity | None = None,
    number: int = 0,
) -> ForceCurve:
    """Reads the force curve of a file.

    A text has columns between tabs, semicolons, commas or spaces, with decimal points or commas, under headings with
    units, such as ``Height (nm)``, ``Force [nN]`` and ``load_uN``, or a line of names and one of units. Binary files, such
    as ``.jpk-force`` and ``.ibw``, are read by afmformats, which ``pip install 'asperity[curves]'`` brings; so are texts of
    instruments that it knows. Positions that fall towards contact are turned round, and the approach comes before the
    withdrawal, whatever their order in the file. Columns of both beside each other, as ``Extend Z (nm)`` and ``Retract Z
    (nm)``, are joined. Points of pauses and points that are not finite are left out.

    Parameters
    ----------
    path : str or path
        File; its content decides.
    z, force : int or str, optional
        Columns of positions and forces, by number, from 0 on, name, or heading; needed where several have a unit of
        length, or of force. Without headings they are the first and the second.
    length_unit, force_unit : str, optional
        Units of a text that does not tell them.
    spring_stiffness : float or str, optional
        Stiffness of the cantilever, in N/m or with its unit, of a file with deflections in the place of forces.
    sensitivity : float or str, optional
        Deflection over the voltage of the detector, in m/V or as ``"50nm/V"``, of a file with voltages.
    number : int
        Number of the curve in a binary file of several.

    Returns
    -------
    ForceCurve

    Raises
    ------
    FileNotFoundError, ValueError
        For a file that is not there, or not understood.

    Warns
    -----
    InputWarning
        If points of a pause are left out: how many.

    Examples
    --------
    >>> import asperity, os, tempfile
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = os.path.join(folder, "curve.csv")
    ...     with open(path, "w") as file:
    ...         _ = file.write("Height (nm);Force (nN)\\n1,5;0,25\\n2,5;0,75\\n")
    ...     asperity.read_curve(path).force
    array([2.5e-10, 7.5e-10])
    """
    with open(path, "rb") as file:
        content = file.read()
    reader = Reader(path, z, force, length_unit, force_unit, metres_and_newtons(spring_stiffness, sensitivity))
    if afm.knows(content):
        return reader.instrument(afm.choose(path, afm.curves(path, reader.given), number))
    return reader.join(*texts.read(path, content))


def metres_and_newtons(spring_stiffness: Quantity | None, sensitivity: Quantity | None) -> dict[str, float | None]:
    """Stiffness and sensitivity as numbers in SI units."""
    found: dict[str, float | None] = {"spring_stiffness": None, "sensitivity": None}
    given = (("spring_stiffness", spring_stiffness, "spring_stiffness"), ("sensitivity", sensitivity, "approach"))
    for name, value, key in given:
        if value is None:
            continue
        if isinstance(value, str):
            length, slash, volt = value.rpartition("/")
            if name == "sensitivity" and (slash != "/" or volt.strip() != "V"):
                raise ValueError(f"sensitivity is {value!r}: it must be a length per V, as '50nm/V'")
            value = _asperity.quantity(key, length if name == "sensitivity" else value)
        if not 0.0 < value < np.inf:
            raise ValueError(f"{name} is {value!r}: it must be positive and finite")
        found[name] = float(value)
    return found


class CurveFile(NamedTuple):
    """All curves of a file: pairs, or the reason why one is none, with the shape and the side lengths of their map."""

    pairs: list[ForceCurve | ValueError]
    shape: tuple[int, ...]
    lengths: tuple[float, float] | None
    stiffness: float | None


class Reader(NamedTuple):
    """What a file is read by: its path, the columns that are asked for, units, and what its forces may need."""

    path: Any
    z: int | str | None
    force: int | str | None
    length_unit: str | None
    force_unit: str | None
    given: dict[str, float | None]

    def instrument(self, curve: Any) -> ForceCurve:
        """A curve of afmformats."""
        chosen = self._replace(z="height (measured)" if self.z is None else self.z)
        return chosen.join(*afm.columns(self.path, curve))

    def map(self) -> CurveFile:
        """All curves of a file of afmformats, over the grid on which they were taken."""
        with open(self.path, "rb") as file:
            if not afm.knows(file.read(4096)):
                raise ValueError(f"{self.path}: is a text, of one curve: take read_curve and fit_curve")
        found = afm.curves(self.path, self.given)
        pairs: list[ForceCurve | ValueError] = []
        with warnings.catch_warnings():
            # the reader of each curve tells of pauses
            warnings.simplefilter("ignore", InputWarning)
            for curve in show_progress(found, len(found), " curves"):
                try:
                    pairs.append(self.instrument(curve))
                except ValueError as refused:
                    pairs.append(refused)
        first = found[0].metadata
        stiffness = self.given["spring_stiffness"] or first.get("spring constant")
        grid = [int(first.get(f"grid shape {axis}", 0)) for axis in "xy"]
        if grid[0] * grid[1] < len(pairs):
            return CurveFile(pairs, (len(pairs),), None, stiffness)
        missing = ValueError("the file has no curve at this place of the map")
        placed: list[ForceCurve | ValueError] = [missing] * (grid[0] * grid[1])
        for curve, pair in zip(found, pairs):
            placed[int(curve.metadata["grid index x"]) * grid[1] + int(curve.metadata["grid index y"])] = pair
        sides = [float(first.get(f"grid size {axis}", np.nan)) for axis in "xy"]
        return CurveFile(placed, (grid[0], grid[1]), (sides[0], sides[1]) if np.isfinite(sides).all() else None, stiffness)

    def join(self, columns: list[Column], parts: NDArray[np.str_] | Array | None) -> ForceCurve:
        """The curve of columns, with approach and withdrawal behind each other."""
        legs = [[column for column in columns if column.leg == leg] for leg in ("approach", "withdrawal")]
        if self.z is None and self.force is None and all(len(leg) > 1 for leg in legs):
            # of columns beside each other
            where, load = np.concatenate([self._pair(leg) for leg in legs], axis=1)
        else:
            where, load = self._pair(columns)
            kept = moving(self.path, where, parts)
            where, load = where[kept], load[kept]
        finite = np.isfinite(where) & np.isfinite(load)
        where, load = where[finite], load[finite]
        if not load.size:
            raise ValueError(f"{self.path}: has no point with a finite position and force")
        falls = where[load >= 0.5 * (load.max() + np.median(load))].mean() < where.mean()
        return ForceCurve(*order_branches(-where if falls else where, load)[:2])

    def _pair(self, columns: list[Column]) -> Array:
        """Positions and forces of columns, in SI units."""
        z = self._column(columns, "approach", "z", self.z, self.length_unit)
        name, factor = self._deflection(columns)
        if name is not None:
            return np.array([z, factor * name.values])
        return np.array([z, self._column(columns, "normal_force", "force", self.force, self.force_unit)])

    def _deflection(self, columns: list[Column]) -> tuple[Column | None, float]:
        """The column of deflections in the place of forces, with its factor, if stiffness or sensitivity are given."""
        stiffness, sensitivity = self.given["spring_stiffness"], self.given["sensitivity"]
        if stiffness is None and sensitivity is None or "height (measured)" in {column.name for column in columns}:
            return None, 1.0
        fits = [column for column in columns if self.force in (column.name, column.heading, columns.index(column))]
        if self.force is None:
            fits = [column for column in columns if "defl" in column.name.lower() or column.unit in ("V", "mV")]
        if len(fits) != 1 or fits[0].factor("normal_force"):
            names = ", ".join(repr(column.name) for column in columns)
            raise ValueError(
                f"{self.path}: has the columns {names}, and spring_stiffness or sensitivity is given: it is not clear which "
                "is the deflection; give force=NAME, or leave them out where forces are there"
            )
        volts = {"V": 1.0, "mV": 1e-3}.get(fits[0].unit)
        if stiffness is None:
            raise ValueError(f"{self.path}: column {fits[0].name!r} is in {fits[0].unit}: give spring_stiffness, too")
        if volts is not None and sensitivity is None:
            raise ValueError(f"{self.path}: column {fits[0].name!r} is in {fits[0].unit}: give sensitivity, too")
        length = fits[0].factor("approach") if volts is None else volts * float(sensitivity or 0.0)
        if length is None:
            raise ValueError(f"{self.path}: column {fits[0].name!r} has no unit of length: give another force")
        return fits[0], stiffness * length

    def _column(self, columns: list[Column], key: str, given: str, asked: int | str | None, unit: str | None) -> Array:
        """A column in SI units."""
        found = self._choose(columns, key, given, asked)
        name, own = found.name, found.unit
        kind = "length" if given == "z" else "force"
        scale = factor(key, own or unit or "")
        if own and (scale is None or unit and scale != factor(key, unit)):
            remedy = f"leave {kind}_unit out" if scale else f"give another {given}"
            if scale is None and given == "force":
                remedy += ", or spring_stiffness, by which a deflection is multiplied"
            raise ValueError(f"{self.path}: column {name!r} is in {own}, and not in {unit or f'a unit of {kind}'}: {remedy}")
        if scale is None:
            raise ValueError(f"{self.path}: column {name!r} has no unit of {kind}: give {kind}_unit, or another {given}")
        return scale * found.values

    def _choose(self, columns: list[Column], key: str, given: str, asked: int | str | None) -> Column:
        """The column of a number, name or heading, or the only one of its unit."""
        if isinstance(asked, int) and -len(columns) <= asked < len(columns):
            return columns[asked]
        fits = [column for column in columns if asked in (column.name, column.heading)]
        if asked is None:
            fits = [column for column in columns if column.factor(key)]
            if not any(column.unit for column in columns) and len(columns) > 1:
                fits = [columns["z force".split().index(given)]]
        if len(fits) != 1:
            names = ", ".join(f"{one.name!r} in {one.unit}" if one.unit else f"{one.name!r}" for one in columns)
            wrong = "it is not clear which" if asked is None else f"none of them alone is {asked!r}"
            raise ValueError(f"{self.path}: has the columns {names}: {wrong} is {given}; give {given}=NAME or its number")
        return fits[0]
