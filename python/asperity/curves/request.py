"""What a fit of force curves is asked for: tip, spring, models and units, and the points that it takes."""

from __future__ import annotations

from typing import Any, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..common.types import Quantity
from ..common.units import in_unit, number
from .branches import order_branches
from .curve import Curve, Direction
from .tip_table import TipTable
from .tips import Array, Paraboloid, Tip, scipy


class Request(NamedTuple):
    """A tip and its spring, the models, and whether numbers are in SI units."""

    tip: Tip
    compliance: float
    direction: Direction | None
    models: list[str]
    jumps: bool
    poisson: float | None
    is_si: bool
    length_unit: str | None
    force_unit: str | None

    def curve(self, z: ArrayLike, force: ArrayLike) -> tuple[Curve, list[str]]:
        """A curve of these positions and forces, and what speaks against it."""
        where, load = _points(z, force, self.is_si, self.length_unit, self.force_unit)
        told = ""
        if self.direction is None:
            where, load, told = order_branches(where, load)
        elif (where[-1] > where[0]) != (self.direction == "approach"):
            where, load = where[::-1].copy(), load[::-1].copy()
        _refuse_saturated(where, load)
        return Curve(where, load, self.direction, self.tip, self.compliance), [told] * bool(told)


def read_request(
    radius: Quantity | None,
    tip: TipTable | None,
    spring_stiffness: Quantity | None,
    poisson: float | None,
    direction: Direction | None,
    model: str | None,
    jumps: bool,
    length_unit: str | None,
    force_unit: str | None,
    is_si: bool,
) -> Request:
    """Keywords of a fit, checked."""
    if (radius is None) == (tip is None):
        raise TypeError(f"radius is {radius!r}, and tip is {tip!r}: give one of them")
    if not isinstance(tip, TipTable | None):
        raise TypeError(f"tip is a {type(tip).__name__}: make its table first, tip=asperity.TipTable(heights, ...)")
    if tip is not None:
        if spring_stiffness is not None and is_si != tip._solved.is_si:
            raise ValueError(f"spring_stiffness is {spring_stiffness!r}, and the table is {tip!r}: give all units, or none")
        is_si = tip._solved.is_si
    if direction not in (None, "approach", "withdrawal"):
        raise ValueError(f'direction is {direction!r}: it must be "approach" or "withdrawal", or left out for both')
    compliance = 0.0 if spring_stiffness is None else 1.0 / _positive("spring_stiffness", spring_stiffness)
    scipy("special")
    shape = cast(Tip, tip._solved if tip else Paraboloid(_positive("radius", radius)))
    poisson = None if poisson is None else number("poisson", poisson)
    return Request(shape, compliance, direction, _models(shape, model), jumps, poisson, is_si, length_unit, force_unit)


def _models(tip: Tip, model: str | None) -> list[str]:
    """The models to be fitted, in their order."""
    if model is None:
        return list(tip.fewer)
    found = [name for name in tip.fewer if name.lower() == str(model).lower()]
    if not found:
        known = ", ".join(repr(name.lower()) for name in tip.fewer)
        raise ValueError(f"model is {model!r}: it must be one of {known}, or left out for all")
    return found


def _points(z: ArrayLike, force: ArrayLike, si: bool, *units: str | None) -> tuple[Array, Array]:
    """Both columns without masked points, in SI units if their units are given."""
    columns: list[Array] = []
    masks: list[NDArray[np.bool_]] = []
    for name, values in (("z", z), ("force", force)):
        try:
            column = np.asarray(values, dtype=np.float64)
        except (TypeError, ValueError):
            raise TypeError(f"{name} is no array of numbers: give those of a file as numpy.loadtxt reads them") from None
        if column.ndim != 1:
            raise ValueError(f"{name} has shape {column.shape}: it must be (N,), a value for each point")
        masks.append(np.ma.getmaskarray(values) if np.ma.isMaskedArray(values) else np.zeros(column.shape, bool))
        bad = np.flatnonzero(~np.isfinite(column) & ~masks[-1])
        if bad.size:
            raise ValueError(
                f"{name} is {column[bad[0]]} at point {bad[0]}, one of {bad.size} that are not finite: leave them out of z "
                "and force"
            )
        columns.append(column)
    if columns[0].size != columns[1].size:
        raise ValueError(f"z has {columns[0].size} points and force {columns[1].size}: they must be as many")
    # masked points are missing
    columns = [column[~(masks[0] | masks[1])] for column in columns]
    if columns[0].size < 20:
        raise ValueError(f"z has {columns[0].size} points: a fit of up to 7 parameters needs at least 20")
    for name, column in zip(("z", "force"), columns):
        if np.ptp(column) == 0.0:
            raise ValueError(f"{name} is {float(column[0])!r} at all points: a curve has it change from point to point")
    if (units[0] is None) != (units[1] is None) or si != (units[0] is not None):
        raise ValueError(
            f"length_unit is {units[0]!r}, force_unit is {units[1]!r}, and the tip has {'a' if si else 'no'} unit: give "
            "all units, as length_unit='nm', force_unit='nN', radius='20nm', or none"
        )
    if si:
        names = ("length_unit", "force_unit")
        columns = [column * in_unit(name, unit) for name, column, unit in zip(names, columns, units)]
    return columns[0], columns[1]


def _positive(name: str, value: Any) -> float:
    found = number(name, value)
    if not 0.0 < found < np.inf:
        raise ValueError(f"{name} is {value!r}: it must be positive and finite")
    return found


def _refuse_saturated(z: Array, force: Array) -> None:
    """Refuses forces that stay at an extreme while the position changes, away from where most of them are."""
    far = z.min() + 0.02 * np.ptp(z)
    for end, word in ((float(force.max()), "largest"), (float(force.min()), "least")):
        at = np.flatnonzero(force == end)
        runs = np.split(at, np.flatnonzero(np.diff(at) > 1) + 1)
        # a curve without noise is flat far from contact
        runs = [run for run in runs if run.size and np.ptp(z[run]) > 0.0 and z[run].min() > far]
        run = max((piece.size for piece in runs), default=0)
        if run >= 4 and abs(end - np.median(force)) > 0.05 * np.ptp(force):
            raise ValueError(
                f"force is {end:.6g}, its {word} value, at {run} points in a row: the detector is saturated; leave these "
                "points out of z and force"
            )
