"""Texts with the columns of a force curve."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..tips import Array
from .columns import Column, factor, leg

#: The name of a column, and its unit in parentheses, brackets, or behind a slash.
_HEADING = re.compile(r"^(.*?)[\s_]*(?:\(([^()]*)\)|\[([^\[\]]*)\]|/\s*(\S+))$")
#: A name with a unit, of headings between which there are but spaces.
_SPACED = re.compile(r"[^()\[\]]+(?:\([^()]*\)|\[[^\[\]]*\])")
#: A cell that is a word.
_WORD = re.compile(r"[^\W\d]")
#: A comment that names the part of the curve that follows.
_PART = re.compile(r"^#\s*(?:segment|segmentname|part)\s*:?\s+(\S.*)$", re.IGNORECASE)


def read(path: Any, content: bytes) -> tuple[list[Column], NDArray[np.str_] | Array | None]:
    """The columns of a text, and the part of the curve to which each line belongs, if it tells."""
    lines = _decode(content)
    first, separator = next(
        ((at, mark) for at, line in enumerate(lines) for mark in "\t;, " if _begins(lines, at, mark)), (0, "")
    )
    if not separator:
        raise ValueError(f"{path}: has no line of at least two numbers")
    count = len(_split(lines[first], separator))
    rows: list[list[str]] = []
    parts, part = [], next((found[1] for line in lines[first::-1] if (found := _PART.match(line.strip()))), "")
    for at, line in enumerate(lines[first:], first):
        if not line.strip(" #\t") or line.startswith("#"):
            part = found[1] if (found := _PART.match(line.strip())) else part
            if not _numbers(line, separator):
                continue
        cells = _split(line, separator)
        cells = cells[:-1] if len(cells) == count + 1 and not cells[-1] else cells
        if len(cells) != count or not any(_number(cell, separator) is not None for cell in cells):
            raise ValueError(f"{path}: line {at + 1} is no row of {count} numbers: {line.strip()[:40]!r}")
        rows.append(cells)
        parts.append(part)
    names, units, headings = _name_columns(lines[:first], separator, count)
    columns, words = [], None
    for name, unit, heading, column in zip(names, units, headings, zip(*rows)):
        values = [np.nan if not cell else _number(cell, separator) for cell in column]
        if all(value is not None for value in values):
            columns.append(Column(name, unit, np.array(values, np.float64), heading))
        elif sum(value is None for value in values) == 1 and not any(leg(cell) for cell in column):
            at = first + next(k for k, value in enumerate(values) if value is None)
            raise ValueError(f"{path}: line {at + 1} is no row of {count} numbers: {lines[at].strip()[:40]!r}")
        elif any(leg(cell) for cell in column):
            words = np.array(column)
    numbered = next((column.values for column in columns if column.name.strip().lower() in ("segment", "part")), None)
    if words is None and any(parts):
        words = np.array(parts)
    return columns, words if words is not None else numbered


def _decode(content: bytes) -> list[str]:
    encoding = "utf-16" if content.startswith((b"\xff\xfe", b"\xfe\xff")) else "utf-8-sig"
    try:
        return content.decode(encoding).splitlines()
    except UnicodeDecodeError:
        # as of instruments on Windows
        return content.decode("cp1252", errors="replace").splitlines()


def _name_columns(lines: list[str], separator: str, count: int) -> tuple[list[str], list[str], list[str]]:
    """Names, units and headings of the columns, by the lines above."""
    known = [cells for line in lines for cells in _headings(line, separator) if len(cells) == count]
    headings = known[-1] if known else [""] * count
    found = [_HEADING.match(name) for name in headings]
    units = ["" if one is None else next(filter(None, one.groups()[1:]), "") for one in found]
    names = [name if one is None else one[1] for name, one in zip(headings, found)]
    if len(known) > 1 and any(factor("normal_force", name) for name in names):
        return known[-2], names, known[-2]
    for at, name in enumerate(names):
        ending = name.rpartition("_")[2]
        if not units[at] and ending != name and any(factor(key, ending) for key in ("approach", "normal_force")):
            names[at], units[at] = name[: -len(ending) - 1], ending
    return names, units, headings


def _begins(lines: list[str], at: int, separator: str) -> bool:
    """Whether the numbers begin with a line: it has numbers alone, or the next has numbers and words in the same places."""
    if _numbers(lines[at], separator):
        return True
    cells = [_split(line, separator) for line in lines[at : at + 2]]
    kinds = [[_number(cell, separator) is not None for cell in row] for row in cells]
    words = all(kind or _WORD.match(cell) for row, kinds in zip(cells, kinds) for cell, kind in zip(row, kinds))
    return len(kinds) == 2 and kinds[0] == kinds[1] and sum(kinds[0]) > 1 and words and not lines[at].startswith("#")


def _split(line: str, separator: str) -> list[str]:
    cells = line.split() if separator == " " else line.rstrip("\r\n").split(separator)
    return [cell.strip(' "') for cell in cells]


def _number(cell: str, separator: str) -> float | None:
    """A number, with a comma for a point where that does not separate."""
    try:
        return float(cell if separator == "," else cell.replace(",", "."))
    except ValueError:
        return None


def _numbers(line: str, separator: str) -> list[float] | None:
    """The numbers of a line that has at least two, and nothing else."""
    cells = _split(line, separator)
    cells = cells[:-1] if not cells[-1:] or not cells[-1] else cells
    numbers = [number for cell in cells if (number := _number(cell, separator)) is not None]
    return numbers if len(numbers) == len(cells) > 1 else None


def _headings(line: str, separator: str) -> list[list[str]]:
    """What the headings of a line may be."""
    line = re.sub(r"^#?\s*(columns:|units:)?", "", line)
    cells = _split(line, separator)
    return [[cell.strip() for cell in _SPACED.findall(line)], cells[:-1] if len(cells) > 1 and not cells[-1] else cells]
