"""A force curve, and the least squares of equilibria for it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ._branches import noise_of
from ._equilibria import TABOR, Array, Equilibria, Tip, fold, scipy

Direction: TypeAlias = Literal["approach", "withdrawal"]

#: The bounds of the parameters of a fit, in their scales.
_BOUNDS = np.array([[-12.0, 0.0, -200.0, np.log(TABOR[0])], [12.0, 30.0, 200.0, np.log(TABOR[-1])]])
#: The step of differences by parameters, in their scales.
_STEP = 1e-3


class Fitted(NamedTuple):
    """A fit of one model.

    The parameters are those of `Curve`, the logarithm of the Tabor parameter, and the baseline; their spread is the inverse
    of the normal matrix. Without equilibria the Tabor parameter was free.
    """

    squares: float
    at: Array
    spread: Array
    tabor: float
    equilibria: Equilibria | None


class Curve:
    """A force curve, and how well a model fits it.

    The baseline is linear, and eliminated. Others vary as p: ln E* = ln E₀ + p₀, w = w₀ (p₁² + a floor), and contact
    point z₀ + p₂ times a length.
    """

    def __init__(
        self, z: Array, force: Array, direction: Direction | None, tip: Tip, compliance: float, jumps: bool
    ) -> None:
        self.z, self.force, self.tip, self.compliance = z, force, tip, compliance
        self.turn = {None: int(np.argmax(z)) + 1, "approach": z.size, "withdrawal": 0}[direction]
        if direction is None:
            self.turn = 0 if self.turn == 1 else self.turn
        self.approaching = np.arange(z.size) < self.turn
        columns = [np.ones(z.size), z] + [np.linspace(0.0, 1.0, z.size)] * (0 < self.turn < z.size)
        self.noise = noise_of(force)
        self._least = 1e-9 * float(np.ptp(force))
        # of each jump its direction, its place, and the force that a shift by a length weighs as much as
        self.jumps: list[tuple[bool, float, float]] = []
        self.fits_jumps = jumps
        self.columns = np.column_stack(columns)
        self._set_jumps([])
        self._start()
        self._set_jumps(self._steps())

    def _set_jumps(self, found: list[tuple[NDArray[np.int64], int, float, float]]) -> None:
        """Takes jumps of parts of the curve: the point before, the place, and its standard deviation."""
        points = np.arange(self.z.size)
        self.contact, self.apart, self.jumps = np.zeros(points.size, bool), np.zeros(points.size, bool), []
        for part, before, place, deviation in found:
            approaching = bool(self.approaching[part[0]])
            self.contact[part], self.apart[part] = (part > before) == approaching, (part > before) != approaching
            deviation = max(deviation, 1e-6 * float(np.ptp(self.z)))
            if self.fits_jumps:
                self.jumps.append((approaching, place, max(self.noise, self._least) / deviation))
        # a place of a jump is a row next to those of the forces
        rows = len(self.jumps)
        self.data = np.append(self.force, np.zeros(rows))
        self.baseline = np.vstack([self.columns, np.zeros((rows, self.columns.shape[1]))])
        self.orthogonal: Array = np.linalg.qr(self.baseline)[0]

    def _parts(self) -> list[NDArray[np.int64]]:
        """The points of each direction."""
        points = np.arange(self.z.size)
        return [part for part in (points[: self.turn], points[self.turn :]) if part.size > 1]

    def _steps(self) -> list[tuple[NDArray[np.int64], int, float, float]]:
        """Steps that stand out of the noise and of those around them, on whose sides points are at first."""
        found = []
        for part in self._parts():
            falls = np.diff(self.force[part]) * (-1.0 if self.approaching[part[0]] else 1.0)
            falls -= np.median(np.lib.stride_tricks.sliding_window_view(np.pad(falls, 3, "edge"), 7), axis=1)
            if falls.max() > 8.0 * self.noise:
                before = int(part[np.argmax(falls)])
                found.append((part, before, float(self.z[before]), np.inf))
        return found

    def find_jumps(self, fit: Fitted) -> bool:
        """Takes the jumps of a fit, where the points of both its sides are most likely to meet; whether any is new."""
        _, lower, upper = self._sides_of(fit.at[:4], self.equilibria(fit))
        found = []
        for part in self._parts():
            force = (self.force - self.columns @ fit.at[4:])[part]
            sides = (lower, upper) if self.approaching[part[0]] else (upper, lower)
            early, late = ((force - side[part]) ** 2 for side in sides)
            # the jump is between a point and the next
            squares = np.cumsum(early)[:-1] + (np.sum(late) - np.cumsum(late))[:-1]
            squares -= squares.min()
            before = int(np.argmin(squares))
            if abs(lower - upper)[part[before : before + 2]].max() < self.noise:
                continue
            weights = np.exp(-0.5 * squares / max(self.noise, self._least) ** 2)
            weights /= weights.sum()
            middles = 0.5 * (self.z[part][1:] + self.z[part][:-1])
            place = float(weights @ middles)
            spacings = np.diff(self.z[part]) ** 2 / 12.0
            deviation = float(np.sqrt(weights @ ((middles - place) ** 2 + spacings)))
            found.append((part, int(part[before]), place, deviation))
        labels = self._labels()
        self._set_jumps(found)
        return self._labels() != labels

    def _labels(self) -> tuple[bytes, bytes, list[bool]]:
        """What tells jumps from others: the points on their sides, and which have a place."""
        return self.contact.tobytes(), self.apart.tobytes(), [weight > 0.0 for _, _, weight in self.jumps]

    def _start(self) -> None:
        """Scales of the parameters, and contacts to begin with, by the approaches of one without adhesion."""
        z, force = self.z, self.force - self.force.min()
        base = float(np.median(force[z <= np.quantile(z, 0.25)]))
        self.work = max(base, self.noise, 1e-6 * float(force.max())) / (1.75 * np.pi * self.tip.radius)
        pressed = force > base + 0.3 * (force.max() - base)
        approach = z[pressed] - self.compliance * force[pressed]
        if self._slope() <= 0.0:
            self._refuse_falling()
        # which no noise makes of a right one; it is infinite where one point has the greatest force
        if -np.inf < self._share() < -1.0:
            self._refuse_steep()
        self.length = float(np.ptp(z)) / 100.0

        moduli = force.max() / self.tip.load(np.ptp(z) * np.geomspace(1.0, 1e-3, 25))
        points = approach.mean() - np.array([self.tip.approach(force[pressed] / modulus).mean() for modulus in moduli])
        middle = moduli.size // 2
        self.modulus, self.point = float(moduli[middle]), float(points[middle])
        # more than the greatest approach, of which these points have more than a half; below it is adhesion that is none
        self.floor = self.tip.least_work(self.modulus, 3.0 * float(np.ptp(approach))) / self.work
        ones = np.ones(moduli.size)
        self.begins = np.stack([np.log(moduli / self.modulus), ones, (points - self.point) / self.length, 0.0 * ones], 1)

    def begin(self, equilibria: Equilibria) -> Array:
        """The parameters to begin with for these equilibria."""
        squares = np.array([np.sum(self.cleared(self.data - self.forces(p, equilibria)) ** 2) for p in self.begins])
        # the softest of those that fit about as well: a soft spring hardly tells a hard contact from a rigid one
        return np.asarray(self.begins[np.argmax(squares < 2.0 * squares.min())])

    def _slope(self) -> float:
        """How the force grows with z where it is greatest."""
        top = self.force > 0.7 * self.force.max() + 0.3 * np.median(self.force)
        far = np.ptp(self.z[top]) > 0.0
        return float(np.polyfit(self.z[top], self.force[top], 1)[0]) if far else np.inf

    def _share(self) -> float:
        """The share of the motion that is of the contact, where the force is greatest: below zero the spring is wrong."""
        return float(1.0 - self.compliance * self._slope())

    def _refuse_noise(self) -> None:
        """Refuses a curve that is hardly more than its noise."""
        if np.std(self.cleared(self.data)) < 1.5 * self.noise:
            self.refuse_empty()

    def _refuse_falling(self) -> None:
        """Refuses a curve whose force does not grow with z where it is greatest."""
        self._refuse_noise()
        raise ValueError(
            f"force grows with z by {self._slope():.4g} where it is greatest: z must grow as the surfaces approach, and "
            "compression be positive"
        )

    def _refuse_steep(self) -> None:
        """Refuses a curve whose force grows by more than the spring allows."""
        self._refuse_noise()
        raise ValueError(
            f"force grows with z by {self._slope():.4g} where it is greatest, and spring_stiffness is only "
            f"{1.0 / self.compliance:.4g}: one of these is wrong, or z is not the position of the piezo"
        )

    def refuse_empty(self) -> None:
        """Refuses a curve that is its baseline."""
        rest = self.cleared(self.data)
        raise ValueError(
            f"force departs by at most {np.abs(rest).max():.3g} from a straight line over z, and its noise is "
            f"{self.noise:.3g}: there is no contact in the data"
        )

    def refuse_vague(self, lower: float, upper: float) -> None:
        """Refuses a curve whose interval of the modulus spans a decade."""
        told = f"the force tells a contact modulus only between {lower:.3g} and {upper:.3g}"
        if self.compliance == 0.0:
            raise ValueError(f"{told}: record more points in contact, or press harder")
        share = self._share()
        # by more than noise makes of a soft spring
        if share < -0.2:
            self._refuse_steep()
        raise ValueError(
            f"{told}: where it is greatest, {100.0 * max(share, 0.0):.2g} % of the motion are of the contact, and the rest "
            f"of the spring of stiffness {1.0 / self.compliance:.4g}; take a stiffer cantilever, or record more points"
        )

    def modulus_at(self, p: float) -> float:
        """Contact modulus of its parameter."""
        return float(self.modulus * np.exp(np.clip(p, -99.0, 99.0)))

    def work_at(self, p: float) -> float:
        """Work of adhesion of its parameter."""
        return float(self.work * (p**2 + self.floor))

    def point_at(self, p: float) -> float:
        """Contact point of its parameter."""
        return float(self.point + self.length * p)

    def values(self, p: Array) -> tuple[float, float, float]:
        """Contact modulus, work of adhesion and contact point."""
        return self.modulus_at(p[0]), self.work_at(p[1]), self.point_at(p[2])

    def numbers(self, fit: Fitted) -> Array:
        """All numbers of a fit but the Tabor parameter."""
        return np.concatenate([self.values(fit.at), fit.at[4:]])

    def spread(self, fit: Fitted) -> Array:
        """The inverse of the normal matrix for these numbers."""
        modulus = self.modulus_at(fit.at[0])
        scales = np.array([modulus, 2.0 * self.work * fit.at[1], self.length, *np.ones(fit.at.size - 4)])
        kept = np.delete(np.delete(fit.spread, 3, 0), 3, 1)
        return np.asarray(kept * np.outer(scales, scales))

    def holds(self, fit: Fitted) -> bool:
        """Whether the tip has equilibria for a fit."""
        modulus, work, point = self.values(fit.at)
        return self.tip.holds(modulus, work, fit.tabor, point - float(self.z.min()))

    def equilibria(self, fit: Fitted) -> Equilibria:
        """The equilibria of a fit."""
        return fit.equilibria or self.tip.at(float(np.log(fit.tabor)))

    def fitted(self, fit: Fitted) -> tuple[Array, float]:
        """The forces of a fit at the points, with the baseline, and its greatest approach."""
        load = self.forces(fit.at[:4], self.equilibria(fit))[: self.z.size]
        approach = self.z - self.point_at(fit.at[2]) - self.compliance * load
        return load + self.columns @ fit.at[4:], float(approach.max())

    def greatest_work(self, fit: Fitted, most: float) -> float:
        """The greatest work of adhesion with which a model has squares of at most `most`."""
        last = fit

        def is_beyond(root: float) -> bool:
            nonlocal last
            last = self.fit(self.equilibria(fit), np.array([last.at[0], root, *last.at[2:4]]), [0, 2])
            return last.squares >= most or not self.holds(last)

        low = float(fit.at[1])
        high = max(1.5 * low, 0.05)
        while not is_beyond(high):
            low, high = high, 1.5 * high
        for _ in range(8):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if is_beyond(middle) else (middle, high)
        return self.work_at(high)

    def forces(self, p: Array, equilibria: Equilibria) -> Array:
        """The forces of the contact at the points, each on its side of a jump, and how far jumps are off."""
        return self._sides_of(p, equilibria)[0]

    def _sides_of(self, p: Array, equilibria: Equilibria) -> tuple[Array, Array, Array]:
        """These, and the forces of all points apart and in contact."""
        modulus, work, point = self.values(p)
        ways = equilibria(modulus, work)
        (where, load), (where_back, load_back) = ((way[0] + self.compliance * way[1], way[1]) for way in ways)
        there, back = np.maximum.accumulate(where), np.minimum.accumulate(where_back[::-1])[::-1]
        first = fold(where, there, load)
        last = back.size - 1 - fold(-where_back[::-1], -back[::-1], -load_back[::-1])
        z = self.z - point
        found = np.where(self.approaching, np.interp(z, there, load), np.interp(z, back, load_back))
        # a side ends at its fold
        upper = np.interp(z, back[last:], load_back[last:])
        lower = np.interp(z, there[: first + 1], load[: first + 1])
        found = np.where(self.contact, upper, np.where(self.apart, lower, found))
        places = point + where_back[last], point + where[first]
        off = [(places[approaching] - place) * weight for approaching, place, weight in self.jumps]
        return np.append(found, off), lower, upper

    def cleared(self, values: Array) -> Array:
        """Values without what a baseline explains."""
        return np.asarray(values - self.orthogonal @ (self.orthogonal.T @ values))

    def tangents(self, of: Callable[[Array], Array], p: Array, free: list[int]) -> Array:
        """The derivatives of a function of the parameters by the free ones."""
        steps = _STEP * np.eye(p.size)[free]
        return np.column_stack([(of(p + step) - of(p - step)) / (2.0 * _STEP) for step in steps])

    def fit(self, equilibria: Equilibria | None, start: Array, free: list[int]) -> Fitted:
        """The least squares of these equilibria, or of all with a Tabor parameter that is free."""
        def forces(p: Array) -> Array:
            return self.forces(p, equilibria or self.tip.at(p[3]))

        def full(part: Array) -> Array:
            p = start.copy()
            p[free] = part
            return p

        scale = max(self.noise, self._least)
        found = scipy("optimize").least_squares(
            lambda part: self.cleared(self.data - forces(full(part))) / scale,
            np.clip(start, 0.999 * _BOUNDS[0], 0.999 * _BOUNDS[1])[free],
            lambda part: -self.cleared(self.tangents(forces, full(part), free)) / scale,
            bounds=_BOUNDS[:, free],
            max_nfev=60,
        )
        p = full(found.x)
        all_columns = np.column_stack([self.tangents(forces, p, free), self.baseline])
        norms = np.linalg.norm(all_columns, axis=0)
        norms[norms == 0.0] = 1.0
        inverse = np.linalg.pinv(all_columns / norms)
        spread = (inverse @ inverse.T) / np.outer(norms, norms)
        rest = self.data - forces(p)
        baseline = np.linalg.lstsq(self.baseline, rest, rcond=None)[0]
        at, places = np.concatenate([p, baseline]), [*free, *range(4, 4 + baseline.size)]
        wide = np.zeros((at.size, at.size))
        wide[np.ix_(places, places)] = spread
        squares = float(np.sum(self.cleared(rest) ** 2))
        return Fitted(squares, at, wide, float(np.exp(p[3])), equilibria)


def all_fits(curve: Curve) -> dict[str, Fitted]:
    """Fits of the limits by their names, and of all others at Tabor parameters by these, with the jumps of the best."""
    fits = _fits(curve, {})
    for _ in range(3):
        if not curve.find_jumps(min(fits.values(), key=lambda fit: fit.squares)):
            break
        fits = _fits(curve, fits)
    return fits


def _fits(curve: Curve, before: dict[str, Fitted]) -> dict[str, Fitted]:
    """These with the jumps of the curve, from the limits, and from fits before."""
    fits: dict[str, Fitted] = {}
    tip, order = curve.tip, curve.tip.tabor
    for name in filter(tip.fewer.get, tip.fewer):
        begin = before[name].at[:4] if before else curve.begin(tip.limit(name))
        fits[name] = curve.fit(tip.limit(name), begin, [0, 1, 2] if fits else [0, 2])

    def at(log_tabor: float, near: Array | None) -> Fitted:
        equilibria = tip.at(log_tabor)
        begin = curve.begin(equilibria) if near is None else near
        return curve.fit(equilibria, np.append(begin[:3], log_tabor), [0, 1, 2])

    # along the Tabor parameter from both of its limits, and each from its own begin
    limits = [fit.at for fit in fits.values()]
    for near, along in (*zip(limits[:-3:-1], (order[::-1], order)), (None, order)):
        for tabor in along:
            found, key = at(np.log(tabor), near), f"{tabor:.6g}"
            near = None if near is None else found.at
            if key not in fits or found.squares < fits[key].squares:
                fits[key] = found
    inner = [fits[f"{tabor:.6g}"] for tabor in order]
    if len(inner) < 2:
        return fits
    starts = [*inner, *(fit for fit in before.values() if fit.equilibria is None)]
    free = min((curve.fit(None, near.at[:4], [0, 1, 2, 3]) for near in starts), key=lambda fit: fit.squares)
    if free.squares < min(near.squares for near in inner):
        fits[f"{free.tabor:.6g}"] = free
        width = float(np.sqrt(free.spread[3, 3] * free.squares / curve.z.size))
        for shift in width * np.array([0.5, 1.0, 1.5, 2.0, 2.5, 3.0]):
            for log_tabor in (np.log(free.tabor) - shift, np.log(free.tabor) + shift):
                if np.log(TABOR[0]) < log_tabor < np.log(TABOR[-1]):
                    fits[f"{np.exp(log_tabor):.6g}"] = at(log_tabor, free.at)
    return fits
