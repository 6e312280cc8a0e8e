"""Force curves of files: columns of text with their units, and the files of instruments by the package afmformats."""

from __future__ import annotations

import importlib
import os
import re
from typing import Any, NamedTuple

import numpy as np

from .. import _asperity
from .._instruments import told
from .._words import checked
from .branches import ordered
from .tips import Array

#: The name of a column, and its unit in parentheses, brackets, or behind a slash.
_HEADING = re.compile(r"^(.*?)[\s_]*(?:\(([^()]*)\)|\[([^\[\]]*)\]|/\s*(\S+))$")
#: A name with a unit, of headings between which there are but spaces.
_SPACED = re.compile(r"[^()\[\]]+(?:\([^()]*\)|\[[^\[\]]*\])")


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


@checked
def read_curve(
    path: str | os.PathLike[str],
    *,
    z: int | str | None = None,
    force: int | str | None = None,
    length_unit: str | None = None,
    force_unit: str | None = None,
    number: int = 0,
) -> ForceCurve:
    """Reads the force curve of a file.

    A text has columns between tabs, semicolons, commas or spaces, with decimal points or commas, under headings with
    units, such as ``Height (nm)`` and ``Force [nN]``, or a line of names and one of units. Binary files, such as
    ``.jpk-force`` and ``.ibw``, are read by afmformats, which ``pip install 'asperity[curves]'`` brings. Positions that
    fall towards contact are turned round, and the approach comes before the withdrawal, whatever their order in the file.
    Points that are not finite are left out.

    Parameters
    ----------
    path : str or path
        File; its content decides.
    z, force : int or str, optional
        Columns of positions and forces, by number, from 0 on, or name; needed where several have a unit of length, or
        of force. Without headings they are the first and the second.
    length_unit, force_unit : str, optional
        Units of a text that does not tell them.
    number : int
        Number of the curve in a binary file of several.

    Returns
    -------
    ForceCurve

    Raises
    ------
    FileNotFoundError, ValueError
        For a file that is not there, or not understood.

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
    if b"\0" in content[:4096] and not content.startswith((b"\xff\xfe", b"\xfe\xff")):
        columns = _instrument(path, number)
        z = "height (measured)" if z is None else z
    else:
        columns = _text(path, content)
    found = []
    for key, given, chosen, unit in (("approach", "z", z, length_unit), ("normal_force", "force", force, force_unit)):
        name, own, values = _chosen(path, columns, key, given, chosen)
        factor = _factor(key, own or unit or "")
        kind = "length" if given == "z" else "force"
        if own and (factor is None or unit and factor != _factor(key, unit)):
            remedy = f"leave {kind}_unit out" if factor else f"give another {given}"
            if factor is None and given == "force":
                remedy += ", or multiply the deflection, as a length, by the stiffness of the cantilever"
            raise ValueError(f"{path}: column {name!r} is in {own}, and not in {unit or f'a unit of {kind}'}: {remedy}")
        if factor is None:
            raise ValueError(f"{path}: column {name!r} has no unit of {kind}: give {kind}_unit, or another {given}")
        found.append(factor * values)
    where, load = np.array(found)[:, np.isfinite(found).all(axis=0)]
    if not load.size:
        raise ValueError(f"{path}: has no point with a finite position and force")
    falls = where[load >= 0.5 * (load.max() + np.median(load))].mean() < where.mean()
    return ForceCurve(*ordered(-where if falls else where, load)[:2])


def _instrument(path: Any, number: int) -> list[tuple[str, str, Array]]:
    """The columns of a binary file."""
    try:
        formats = importlib.import_module("afmformats")
    except ImportError:
        raise ValueError(f"{path}: is binary: pip install 'asperity[curves]', with which it may be read") from None
    try:
        curves = formats.load_data(path)
        if not 0 <= number < len(curves):
            raise ValueError(f"it finds {len(curves)} curves, and none of number {number}")
        curve = curves[number]
        names = [name for name in curve.columns if name not in ("segment", "time", "index")]
        return [(name, "N" if name == "force" else "m", np.asarray(curve[name], np.float64)) for name in names]
    except (Exception, formats.errors.AFMFileFormatError, formats.errors.MissingMetaDataError) as raised:
        raise ValueError(f"{path}: is not read by afmformats: {told(raised)}") from raised


def _text(path: Any, content: bytes) -> list[tuple[str, str, Array]]:
    """The columns of a text: names, units, which may be empty, and values."""
    encoding = "utf-16" if content.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8-sig"
    try:
        lines = content.decode(encoding).splitlines()
    except UnicodeDecodeError:
        # as of instruments on Windows
        lines = content.decode("cp1252", errors="replace").splitlines()
    begins = ((at, separator) for at, line in enumerate(lines) for separator in "\t;, " if _numbers(line, separator))
    first, separator = next(begins, (0, ""))
    rows = [(at, _numbers(line, separator)) for at, line in enumerate(lines[first:], first) if line.strip(" #\t")[:1]]
    rows = [(at, row) for at, row in rows if row or not lines[at].startswith("#")]
    if not separator:
        raise ValueError(f"{path}: has no line of at least two numbers")
    count = len(rows[0][1] or ())
    for at, row in rows:
        if not row or len(row) != count:
            raise ValueError(f"{path}: line {at + 1} is no row of {count} numbers: {lines[at].strip()[:40]!r}")
    known = [cells for line in lines[:first] for cells in _headings(line, separator) if len(cells) == count]
    names = known[-1] if known else [""] * count
    found = [_HEADING.match(name) for name in names]
    units = ["" if one is None else next(filter(None, one.groups()[1:]), "") for one in found]
    names = [name if one is None else one[1] for name, one in zip(names, found)]
    if len(known) > 1 and any(_factor("normal_force", name) for name in names):
        names, units = known[-2], names
    return list(zip(names, units, np.array([row for _, row in rows], np.float64).T))


def _split(line: str, separator: str) -> list[str]:
    cells = line.split() if separator == " " else line.rstrip(f"{separator}\r\n").split(separator)
    return [cell.strip(' "') for cell in cells]


def _numbers(line: str, separator: str) -> list[float] | None:
    """The numbers of a line of at least two, with commas for points where these do not separate."""
    try:
        numbers = [float(cell) for cell in _split(line if separator == "," else line.replace(",", "."), separator)]
    except ValueError:
        return None
    return numbers if len(numbers) > 1 else None


def _headings(line: str, separator: str) -> list[list[str]]:
    """What the headings of a line may be."""
    line = re.sub(r"^#?\s*(columns:|units:)?", "", line)
    return [[cell.strip() for cell in _SPACED.findall(line)], _split(line, separator)]


def _chosen(path: Any, columns: list[tuple[str, str, Array]], key: str, given: str, chosen: int | str | None) -> Any:
    """The column of a number or name, or the only one of its unit."""
    if isinstance(chosen, int) and -len(columns) <= chosen < len(columns):
        return columns[chosen]
    fits = [column for column in columns if column[0] == chosen]
    if chosen is None:
        fits = [column for column in columns if _factor(key, column[1])]
        if not any(unit for _, unit, _ in columns):
            fits = [columns["z force".split().index(given)]]
    if len(fits) != 1:
        names = ", ".join(f"{name!r} in {unit}" if unit else f"{name!r}" for name, unit, _ in columns)
        asked = "it is not clear which" if chosen is None else f"none of them alone is {chosen!r}"
        raise ValueError(f"{path}: has the columns {names}: {asked} is {given}; give {given}=NAME or its number")
    return fits[0]


def _factor(key: str, unit: str) -> float | None:
    """What a unit is in SI units, or None of another dimension."""
    try:
        return _asperity.quantity(key, f"1{unit}") if unit else None
    except ValueError:
        return None
