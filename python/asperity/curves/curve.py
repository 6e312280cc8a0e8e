"""A force curve: its points in the order of time, its noise, its baseline, and the scales of a fit."""

from __future__ import annotations

from typing import Literal, NoReturn, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .. import _asperity
from .branches import noise_of
from .tips import Array, Tip

Direction: TypeAlias = Literal["approach", "withdrawal"]


class Curve:
    """Points of a force curve of a tip, with the scales in which fits have their parameters.

    The baseline is linear, and `orthogonal` has an orthonormal basis of it.

    Attributes
    ----------
    turn : int
        The first point of the withdrawal.
    modulus, work, point, length, floor : float
        Scales: contact modulus, work of adhesion, contact point and its unit, and the least work over its scale.
    """

    def __init__(self, z: Array, force: Array, direction: Direction | None, tip: Tip, compliance: float) -> None:
        self.z, self.force, self.tip, self.compliance = z, force, tip, compliance
        self.turn = {None: int(np.argmax(z)) + 1, "approach": z.size, "withdrawal": 0}[direction]
        if direction is None:
            self.turn = 0 if self.turn == 1 else self.turn
        self.drifts = 0 < self.turn < z.size
        self.columns = np.column_stack([np.ones(z.size), z] + [np.linspace(0.0, 1.0, z.size)] * self.drifts)
        # of a scaled position, so that both columns are alike
        scaled = self.columns.copy()
        scaled[:, 1] = (z - z.mean()) / np.ptp(z)
        self.orthogonal: Array = np.linalg.qr(scaled)[0]
        norms = np.abs(self.columns).max(axis=0)
        self._inverse: Array = np.linalg.pinv(self.columns / norms, rcond=1e-13) / norms[:, None]
        self.noise = noise_of(force)
        self.least = 1e-9 * float(np.ptp(force))
        self._scale()
        scales = self.modulus, self.work, self.floor, self.point, self.length
        #: the points for the compiled core
        self.core = _asperity.Curve(
            z, force, self.turn, compliance, self.orthogonal, self.noise, scales, tip.size, tip.is_smooth
        )

    def _scale(self) -> None:
        """Scales of the parameters, by the approaches of a contact without adhesion."""
        z, force = self.z, self.force - self.force.min()
        base = float(np.median(force[z <= np.quantile(z, 0.25)]))
        self.work = max(base, self.noise, 1e-6 * float(force.max())) / (1.75 * np.pi * self.tip.radius)
        pressed = force > base + 0.3 * (force.max() - base)
        approach = z[pressed] - self.compliance * force[pressed]
        order = np.argsort(z)
        quarter = max(z.size // 4, 2)
        far, near = force[order[:quarter]], force[order[-quarter:]]
        if far.std() > 4.0 * near.std() and far.mean() > near.mean():
            self._refuse_falling(order[:quarter])
        # which no noise makes of a right one; it is infinite where one point has the greatest force
        if -np.inf < self._share() < -1.0:
            self._refuse_steep()
        self.length = float(np.ptp(z)) / 100.0
        #: moduli to begin with, and contact points that fit each
        self.moduli = force.max() / self.tip.load(np.ptp(z) * np.geomspace(1.0, 1e-3, 16))
        self.points = approach.mean() - np.array([self.tip.approach(force[pressed] / modulus).mean() for modulus in self.moduli])
        middle = self.moduli.size // 2
        self.modulus, self.point = float(self.moduli[middle]), float(self.points[middle])
        # more than the greatest approach, of which these points have more than a half; below it is adhesion that is none
        self.floor = self.tip.least_work(self.modulus, 3.0 * float(np.ptp(approach))) / self.work

    def clear_baseline(self, values: Array) -> Array:
        """Values of the points along the last axis, without what a baseline explains."""
        return np.asarray(values - (values @ self.orthogonal) @ self.orthogonal.T)

    def baselines(self, loads: Array) -> Array:
        """Offset, slope and drift of the baselines that are left of the forces without loads, along the last axis."""
        found = (self.force - loads) @ self._inverse.T
        return np.concatenate([found, np.zeros((*found.shape[:-1], 3 - found.shape[-1]))], axis=-1)

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
        if np.std(self.clear_baseline(self.force)) < 1.5 * self.noise:
            self.refuse_empty()

    def _refuse_falling(self, far: NDArray[np.int64]) -> NoReturn:
        """Refuses a curve with a force that falls with z where it changes most, at the least z."""
        self._refuse_noise()
        slope = float(np.polyfit(self.z[far], self.force[far], 1)[0])
        raise ValueError(
            f"force grows with z by {slope:.4g} where it is greatest: z must grow as the surfaces approach, and compression "
            "be positive"
        )

    def _refuse_steep(self) -> NoReturn:
        """Refuses a curve with a force that grows by more than the spring allows."""
        self._refuse_noise()
        raise ValueError(
            f"force grows with z by {self._slope():.4g} where it is greatest, and spring_stiffness is only "
            f"{1.0 / self.compliance:.4g}: one of these is wrong, or z is not the position of the piezo"
        )

    def refuse_empty(self) -> NoReturn:
        """Refuses a curve that is its baseline."""
        rest = self.clear_baseline(self.force)
        raise ValueError(
            f"force departs by at most {np.abs(rest).max():.3g} from a straight line over z, and its noise is "
            f"{self.noise:.3g}: there is no contact in the data"
        )

    def refuse_vague(self, lower: float, upper: float) -> NoReturn:
        """Refuses a curve with an interval of the modulus of a decade."""
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
