"""Columns of files with force curves, and the parts that belong to approach, withdrawal and pauses."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from ... import _asperity
from ...common.warnings import InputWarning, warn
from ..tips import Array

#: Words of makers for the parts of a curve.
_APPROACH = re.compile(r"(?<![a-z])(extend|extension|approach|appr|trace|loading|forward|advance)(?![a-z])", re.IGNORECASE)
_WITHDRAWAL = re.compile(
    r"(?<![a-z])(retract|retraction|retr|withdraw|withdrawal|retrace|unloading|backward)(?![a-z])", re.IGNORECASE
)
_PAUSE = re.compile(r"(?<![a-z])(pause|hold|dwell|wait|creep|relax|relaxation|intermediate|intr)(?![a-z])", re.IGNORECASE)
#: A part whose position changes by less than this share of all is a pause.
_STILL = 0.3

Leg = Literal["approach", "withdrawal", "pause"]


@dataclass(frozen=True)
class Column:
    """A column of numbers, with its name, its heading as the file has it, and its unit, which may be empty."""

    name: str
    unit: str
    values: Array
    heading: str

    def factor(self, key: str) -> float | None:
        """The factor of its unit into SI units, or None of another dimension."""
        return factor(key, self.unit)

    @property
    def leg(self) -> Leg | None:
        """The part of a curve that the heading names."""
        return leg(self.heading)


def factor(key: str, unit: str) -> float | None:
    """What a unit is in SI units, or None of another dimension."""
    try:
        return _asperity.quantity(key, f"1{unit}") if unit else None
    except ValueError:
        return None


def leg(word: str) -> Leg | None:
    """The part of a curve that a word names."""
    kinds: tuple[tuple[re.Pattern[str], Leg], ...] = (
        (_WITHDRAWAL, "withdrawal"),
        (_PAUSE, "pause"),
        (_APPROACH, "approach"),
    )
    return next((kind for pattern, kind in kinds if pattern.search(word.replace("_", " "))), None)


def moving(path: object, z: Array, parts: NDArray[np.str_] | Array | None) -> NDArray[np.bool_]:
    """The points of approach and withdrawal, by the parts that a file names; pauses are left out with a warning."""
    kept = np.ones(z.size, bool)
    if parts is not None:
        for part in np.unique(parts):
            at = parts == part
            kind = leg(str(part))
            where = z[at][np.isfinite(z[at])]
            still = where.size < 2 or abs(where[-1] - where[0]) < _STILL * np.nanmax(z) - _STILL * np.nanmin(z)
            # numbers do not tell what they are of
            if kind == "pause" or kind is None and still and np.unique(parts).size > 2:
                kept[at] = False
    kept[kept] = ~_dwells(z[kept])
    left_out = int(np.sum(~kept))
    if left_out:
        warn(f"pause: {left_out} of {z.size} points of {path} are of a pause, and are left out", InputWarning)
    return kept


def _dwells(z: Array) -> NDArray[np.bool_]:
    """The points that stay where approach and withdrawal meet, if they are more than some."""
    still = np.zeros(z.size, bool)
    if z.size < 20 or not np.isfinite(z).all():
        return still
    # in the middle of a curve that turns at its greatest or its least position
    turn = min((int(np.argmax(z)), int(np.argmin(z))), key=lambda k: abs(k - z.size // 2))
    step = float(np.median(np.abs(np.diff(z))))
    near = np.abs(z - z[turn]) <= 0.5 * step
    first = turn - int(np.argmin(near[turn::-1])) + 1
    last = turn + int(np.argmin(near[turn:]))
    if not near[turn::-1].all() and not near[turn:].all() and last - first > 10:
        # one point of each side belongs to the motion
        still[first + 1 : last - 1] = True
    return still
