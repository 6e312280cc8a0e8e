"""The equilibria of a tip of any shape, by solves that are made once, as fits ask for them."""

from __future__ import annotations

import os
import warnings
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any, TypeAlias, cast

import numpy as np

from .. import _asperity
from ..api.contact import Contact
from ..bodies.body import Coating, Layer
from ..common.types import AxisOrder, Lengths, OwnLaw, Quantity
from ..common.units import number
from ..common.warnings import InputWarning, warn
from ..maps.heights import Heights
from .tips import Array, scipy

#: Distances and forces.
Pair: TypeAlias = tuple[Array, Array]

#: Approaches, which rise, forces over the modulus, and whether they have jumped since the approach before.
Way: TypeAlias = tuple[Array, Array, Array]

#: Points between the ends of each piece of a branch, dense near the jump, where the force goes as a root.
_ROOTS = np.linspace(0.0, 1.0, 120)


class SolvedTip:
    """The equilibria of a `TipTable`, as a fit asks for them."""

    def __init__(
        self,
        heights: Heights,
        lengths: Lengths | None = None,
        *,
        axes: AxisOrder | None = None,
        approaches: tuple[Quantity, Quantity],
        modulus: Quantity,
        law: str | OwnLaw | None = None,
        work_of_adhesion: Quantity | None = None,
        range: Quantity | None = None,
        body: Layer | Coating | None = None,
        works: int = 12,
        steps: int = 40,
    ) -> None:
        if not isinstance(body, Layer | Coating | None):
            raise TypeError(f"body is {body!r}: it must be a Layer or a Coating, or left out for a half-space")
        self._body, self._steps, si = body, steps, isinstance(modulus, str)
        if any(isinstance(end, str) != si for end in approaches):
            raise ValueError(f"approaches are {approaches!r}, and modulus is {modulus!r}: give all units, or none")
        if works < 4 or works % 2:
            raise ValueError(f"works is {works!r}: it must be even, and at least 4")
        low, high = (_asperity.quantity("approach", end) if isinstance(end, str) else number("approaches", end) for end in approaches)
        if not low < 0.0 < high:
            raise ValueError(f"approaches are {approaches!r}: they must be a negative one, before contact, and a greatest one")
        self.is_si, self.low, self.high = si, low, high
        elastic: dict[str, Any] = {"boundary": "free" if body is None else "periodic", "body": body}
        adhesion: dict[str, Any] = {"law": law, "work_of_adhesion": work_of_adhesion, "range": range}
        contact = Contact(heights, lengths, axes=axes, modulus=modulus, **elastic, **adhesion)
        self.topography, softest = contact.topography, contact.modulus
        if isinstance(body, Coating):
            self._hardness = float(body.modulus) / softest
        #: what an approach has beside the mean gap, over the mean pressure and times E*
        self._compliance = self._far(softest) if body is not None else 0.0
        #: the cubic roots of w/E* over the greatest: displacements by adhesion go as powers of it
        roots = np.linspace(0.0, 1.0, works + 1) if contact.adheres else np.zeros(1)

        def ways(root: float) -> tuple[Way, Way]:
            keys = {**elastic, **adhesion} if root else {**elastic}
            return self._states(float(softest / (root or 1.0) ** 3), keys)

        with ThreadPoolExecutor(os.cpu_count()) as pool, warnings.catch_warnings():
            # of moduli that are not those of the body
            warnings.filterwarnings("ignore", "hardness", InputWarning)
            found = self._table([*pool.map(ways, roots)])
        self._bare, self._core = found[0], cast(Any, None)
        self.fewer, self.tabor = {"no adhesion": 1}, np.ones(0)
        self.ratio, self.error, self.radius, self.is_smooth = 0.0, 0.0, high, False
        if contact.adheres:
            self.fewer, self.tabor = {"no adhesion": 1, "adhesion": 0}, np.ones(1)
            numbers = Contact.from_numbers(self.topography, {**elastic, **adhesion, "modulus": softest}, si)
            row = numbers.sweep(**self._loads([low])).run().rows[0]
            work, own = row["work_of_adhesion"], cast(Any, contact.own_law)
            if work is None:
                # of a law that does not tell it, the mean at contact
                work = -np.mean(own.energy(np.zeros(contact.topography.heights.shape)))
            self.ratio, self._law = float(work) / softest, row["law"]
            between = scipy("interpolate").PchipInterpolator
            self._roots, self._rows = roots, found
            self._slopes = between(roots, found).derivative()(roots)
            pull, far = -found[-1, :-2].min(), -found[-1, 0]
            self.radius = float(pull / (1.75 * np.pi * self.ratio))
            self.error = _error(between(roots[::2], found[::2]), roots[1::2], found[1::2])
            if far > 0.02 * pull:
                raise ValueError(
                    f"approaches begin at {approaches[0]!r}, where the attraction is {100.0 * far / pull:.2g} % of the "
                    "pull-off: begin further from contact"
                )
            if self.error > 0.02:
                warn(
                    f"the table has an error of about {100.0 * self.error:.2g} %: give more works or steps, or an adhesion that "
                    "the grid resolves",
                    InputWarning,
                )

    def __repr__(self) -> str:
        metre = " m" * self.is_si
        law = f", {self._law}, w/E* up to {self.ratio:.3g}{metre}, error {100.0 * self.error:.2g} %" if self.ratio else ""
        return f"TipTable({self.topography!r}, approaches from {self.low:.3g} to {self.high:.3g}{metre}{law})"

    @property
    def what(self) -> str:
        return repr(self)

    def _top(self) -> float:
        """How far the peak of the tip is above its mean."""
        heights = self.topography.heights
        return float(heights.max() - heights.mean())

    def _far(self, modulus: float) -> float:
        """The compliance of the body beside its waves, by a solve at an approach, times E*."""
        keys = {"modulus": modulus, "body": self._body, "tolerance": 1e-8}
        solved = Contact.from_numbers(self.topography, keys, self.is_si).solve(approach=self.high)
        return (self.high - self._top() + solved.mean_gap) / solved.mean_pressure * modulus

    def _loads(self, approaches: list[float]) -> dict[str, Any]:
        """Approaches as loads, over a layer as mean gaps."""
        if self._body is not None:
            approaches = [self._top() - approach for approach in approaches]
        return {"approaches": approaches} if self._body is None else {"mean_gaps": approaches, "start": "apart"}

    def _states(self, modulus: float, keys: dict[str, Any]) -> tuple[Way, Way]:
        """The approach and the withdrawal."""
        # with more of the steps about contact
        ends = [self.low, 0.25 * self.low, 0.25 * self.high, self.high]
        loads = self._loads([*ends, *ends[-2::-1]])
        # a fit asks for more than a loop
        keys = {"tolerance": 1e-6, **keys, "modulus": modulus, "threads": 1}
        if isinstance(self._body, Coating):
            keys["body"] = replace(self._body, modulus=self._hardness * modulus)
        contact = Contact.from_numbers(self.topography, keys, self.is_si)
        columns = contact.cycle(steps=self._steps, **loads).columns
        approach, load = columns["approach"], columns["normal_force"] / modulus
        if self._body is not None:
            yielded = self._compliance / modulus * columns["mean_pressure"]
            approach = self._top() - columns["mean_gap"] + yielded
        back = columns["direction"] == "withdrawal"
        jumps = np.array([drop is not None and drop > 0.0 for drop in columns["energy_drop"]])
        withdrawal = approach[back][::-1], load[back][::-1], np.roll(jumps[back][::-1], 1)
        return (approach[~back], load[~back], jumps[~back]), withdrawal

    def _table(self, ways: list[tuple[Way, Way]]) -> Array:
        """Forces before the jump, and behind it on the approach and the withdrawal, and both places, for each modulus."""
        places = np.array([[_jump(*way) for way in both] for both in ways])
        # an adhesion too weak for a jump has its places where the weakest one jumps that does
        for weaker in range(len(ways) - 2, 0, -1):
            places[weaker] = np.where(np.isnan(places[weaker]), places[weaker + 1], places[weaker])
        places[0] = 0.0
        places = np.nan_to_num(places)

        def row(both: tuple[Way, Way], place: float, off: float) -> Array:
            (before, behind), (_, drawn) = _part(both[0], place), _part(both[1], off)
            pieces = ((before, place - self.low), (behind, self.high - place), (drawn, self.high - off))
            tail, *others = (_sample(*piece, span) for piece, span in pieces)
            return np.concatenate([tail[::-1], *others, [place, off]])

        return np.array([row(both, *pair) for both, pair in zip(ways, places)])

    def __getstate__(self) -> dict[str, Any]:
        # the compiled core makes its equilibria anew
        return {**self.__dict__, "_core": None}

    @property
    def size(self) -> float:
        """The greatest w/E*."""
        return self.ratio or 1.0

    @property
    def equilibria(self) -> Any:
        """The equilibria without adhesion, and those over the cubic root of w/E* over the greatest."""
        if self._core is None:
            zero = np.zeros_like(self._bare)
            there, back = (np.concatenate(pair, 1) for pair in zip(self._ways(self._bare), self._ways(zero, is_slope=True)))
            models: list[Any] = [(np.zeros(1), there[None], back[None])]
            if self.ratio:
                pairs = [
                    [np.concatenate(pair, 1) for pair in zip(self._ways(row), self._ways(slope, is_slope=True))]
                    for row, slope in zip(self._rows, self._slopes)
                ]
                models.append((self._roots, *(np.array(way) for way in zip(*pairs))))
            self._core = _asperity.Equilibria(models)
        return self._core

    def _ways(self, pieces: Array, is_slope: bool = False) -> tuple[Array, Array]:
        """Approaches and loads over E* of both ways, or how they change with the root."""
        low, high = (0.0, 0.0) if is_slope else (self.low, self.high)
        tail, behind, drawn, (place, off) = np.split(pieces, np.arange(1, 4) * _ROOTS.size)
        far = -_ROOTS[::-1] ** 2

        def way(start: float, before: Array, force: Array, then: Array) -> Array:
            where = np.append(before, start + (high - start) * _ROOTS**2)
            return np.stack([where, np.append(force, then)], 1)

        before = place + (place - low) * far
        return way(place, before, tail, behind), way(off, off + (off - low) * far, tail, drawn)

    def adheres(self, name: str) -> bool:
        return name == "adhesion"

    def _loading(self) -> tuple[Array, Array]:
        """Approaches and loads over E* of the approach without adhesion, in contact."""
        where, load = self._ways(self._bare)[0][_ROOTS.size :].T
        return where, load

    def load(self, approach: Array) -> Array:
        return np.asarray(np.interp(approach, *self._loading()))

    def approach(self, load: Array) -> Array:
        where, loads = self._loading()
        return np.asarray(np.interp(load, loads, where))

    def least_work(self, modulus: float, approach: float) -> float:
        return 0.0

    def holds(self, modulus: float, work: float, tabor: float, before: float) -> bool:
        return work <= 1.001 * self.ratio * modulus

    def greatest_work(self, modulus: float, tabor: float, before: float) -> float:
        return np.inf

    def check_reach(self, modulus: float, work: float, approach: float) -> str:
        if work > 1.001 * self.ratio * modulus:
            raise ValueError(
                f"the curve asks for w/E* of {work / modulus:.3g} or more, and the table ends at {self.ratio:.3g}: make one of a "
                "smaller modulus, or of a greater work of adhesion"
            )
        if approach > 1.001 * self.high:
            raise ValueError(
                f"the curve goes to an approach of {approach:.3g}, and the table to {self.high:.3g}: make one that goes "
                "further, or leave out points"
            )
        return ""


def _jump(approach: Array, load: Array, jumps: Array) -> float:
    """The place of the largest jump to a smaller force, if that is a tenth of the greatest tension or more."""
    falls = np.where(jumps[1:], -np.diff(load), 0.0)
    at = int(falls.argmax())
    return 0.5 * float(approach[at] + approach[at + 1]) if falls[at] > max(-0.1 * load.min(), 0.0) else np.nan


def _part(way: Way, place: float) -> tuple[Pair, Pair]:
    """Distances and forces before a place and behind it, and there, unless the force jumps."""
    approach, load, jumps = way
    at = int(np.searchsorted(approach[:-1], place))
    smooth = not jumps[at]
    if smooth:
        approach, load = np.insert(approach, at, place), np.insert(load, at, np.interp(place, approach, load))
    before, behind = slice(None, at + smooth), slice(at, None)
    return (place - approach[before][::-1], load[before][::-1]), (approach[behind] - place, load[behind])


def _sample(distance: Array, load: Array, span: float) -> Array:
    """Forces at distances from a jump that are dense near it."""
    roots = np.sqrt(np.maximum(distance, 0.0) / span)
    rising = np.append(True, np.diff(np.maximum.accumulate(roots)) > 0.0)
    found = scipy("interpolate").PchipInterpolator(roots[rising], load[rising], extrapolate=False)
    return np.asarray(found(np.clip(_ROOTS, roots[0], roots[rising][-1])))


def _error(coarse: Any, roots: Array, rows: Array) -> float:
    """A quarter of the largest relative error of pull-offs and greatest forces by every second work."""
    drawn = slice(2 * _ROOTS.size, -2)
    pairs = [(coarse(root)[drawn], row[drawn]) for root, row in zip(roots, rows) if root > 1.0 / 3.0]
    return 0.25 * float(max(abs(of(found) / of(true) - 1.0) for found, true in pairs for of in (np.min, np.max)))
