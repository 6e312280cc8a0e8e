"""What the fits of a force curve tell together: intervals, a covariance, and which models are ruled out."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .calibration import FAR, likeness, orthonormal, probability
from .curve import Curve
from .search import Fits
from .tips import Array, Paraboloid, scipy

#: A probability below this rules a model out, and intervals have the complement.
LEVEL = 0.05
#: A simpler model stays in the intervals down to this probability.
DOUBTFUL = 0.02
#: Below this probability neighbouring residuals are alike: no model fits.
UNLIKELY = 1e-4
#: Columns of the spread of a fit.
LOG_MODULUS, ROOT_WORK, POINT, LOG_TABOR, OFFSET, SLOPE, DRIFT = range(7)
#: The least force of adhesion that is looked for, over the noise, the greatest one over the span of the forces, and how many.
_LEAST, _MOST, _WORKS = 0.03, 2.0, 12


class Estimate(NamedTuple):
    """A number that a fit has found.

    Attributes
    ----------
    value : float
        Most likely value; NaN where the curve does not tell one.
    lower, upper : float
        Ends of the 95 % interval.
    """

    value: float
    lower: float
    upper: float


class ModelFit(NamedTuple):
    """The fit of one model to a force curve.

    Attributes
    ----------
    modulus, work_of_adhesion, contact_point : float
        Parameters with which the model fits best.
    rms : float
        Root mean square of its residuals.
    aic : float
        Information criterion of Akaike, less the one of the best model.
    p_value : float
        Probability of what is seen, or more, if the model was true: of another model that fits as much better, or,
        where none does, of residuals of neighbouring points that are as alike. Below 0.05 the model is ruled out.
    """

    modulus: float
    work_of_adhesion: float
    contact_point: float
    rms: float
    aic: float
    p_value: float


Estimate.__module__ = ModelFit.__module__ = "asperity"


class Likelihood:
    """The fits of a curve, and what they tell together."""

    def __init__(self, curve: Curve, fits: Fits) -> None:
        self.curve, self.fits, tip = curve, fits, curve.tip
        self.special = scipy("special")
        self._likeness: dict[int, tuple[float, float]] = {}
        self.names = [name for name in tip.fewer if (fits.model == name).any()]
        self.bare = np.array([not tip.adheres(name) for name in fits.model])
        full = np.array([tip.fewer[name] == 0 for name in fits.model])
        #: fits of the fullest model with a range that ends before contact, or else the one with the shortest range
        self.inner = np.flatnonzero(full & self._holds())
        if not self.inner.size and full.any():
            self.inner = np.flatnonzero(full)[[int(np.argmax(fits.tabor[full]))]]
        kept = ~full
        kept[self.inner] = True
        self.family = np.flatnonzero(kept)
        self.best = int(self.family[np.argmin(fits.squares[self.family])])
        points, columns = curve.columns.shape
        fewest = min(tip.fewer[name] for name in self.names)
        self.freedom = max(points - columns - 4 + fewest, 1)
        self.least = float(fits.squares[self.best])
        self.variance = max(self.least / self.freedom, curve.least**2)
        # the square of Student's t is F with one degree of freedom
        self.most = self.least + self.variance * float(self.special.fdtri(1, self.freedom, 1.0 - LEVEL))
        self.spread = self._spread()
        self.probabilities = {name: self._probability(name) for name in self.names}
        #: whether adhesion is not seen
        self.is_bare = any(not tip.adheres(name) and self.probabilities[name] >= LEVEL for name in self.names)
        bare = np.flatnonzero(self.bare)
        #: the fit with the values that are given: where adhesion is not seen the one without it
        self.given = int(bare[0]) if self.is_bare else self.best
        #: fits with which intervals are made, and by how much the squares of each may grow
        room = self.most - fits.squares
        for name in self.names:
            # a simpler model that is true is ruled out as often as intervals may miss: it stays in them for longer
            if tip.fewer[name] and self.probabilities[name] >= DOUBTFUL:
                room[self.best_of(name)] = self.most - self.least
            elif not tip.adheres(name):
                room[self.best_of(name)] = -1.0
        room[self.best] = self.most - self.least
        self.likely = self.family[room[self.family] >= 0.0]
        self.room = np.maximum(room, 0.0)

    def _holds(self) -> NDArray[np.bool_]:
        """The fits for which the tip has equilibria."""
        fits, first = self.fits, float(self.curve.z.min())
        rows = zip(fits.modulus, fits.work, fits.tabor, fits.point - first)
        return np.array([self.curve.tip.holds(*map(float, row)) for row in rows])

    def best_of(self, name: str) -> int:
        """The best fit of a model."""
        rows = self.family[self.fits.model[self.family] == name]
        return int(rows[np.argmin(self.fits.squares[rows])])

    def _spread(self) -> Array:
        """Inverses of the normal matrices of all fits, by what varies and the columns of the baseline."""
        points, count = self.curve.columns.shape
        by = np.zeros((len(self.fits), points + 2, 4 + count))
        by[..., :4] = self.fits.load_by
        by[:, :points, 4:] = self.curve.columns
        # the Tabor parameter is one of several
        by[..., LOG_TABOR] = 0.0
        normal = by.transpose(0, 2, 1) @ by
        norms = np.sqrt(np.einsum("rii->ri", normal))
        norms[norms == 0.0] = 1.0
        scale = norms[:, :, None] * norms[:, None, :]
        return np.asarray(np.linalg.pinv(normal / scale, rcond=1e-13, hermitian=True) / scale)

    def _basis(self, row: int) -> Array:
        """What the parameters of a fit change, orthonormal, over the points and the jumps."""
        points, count = self.curve.columns.shape
        by = np.zeros((points + 2, 3 + count))
        by[:, :3] = self.fits.load_by[row][:, :3]
        by[:points, 3:] = self.curve.columns / np.abs(self.curve.columns).max(axis=0)
        return orthonormal(by)

    def residuals(self, row: int) -> Array:
        """The residuals of a fit, without a baseline."""
        return self.curve.clear_baseline(self.curve.force - self.fits.load[row, : self.curve.z.size])

    def likeness(self, row: int) -> tuple[float, float]:
        """The correlation of neighbouring residuals of a fit, and its probability."""
        if row in self._likeness:
            return self._likeness[row]
        rest = self.residuals(row)
        # what is left of a curve without noise is the error of interpolation
        if np.sqrt(np.mean(rest**2)) < 1e-4 * np.ptp(self.curve.force):
            return 0.0, 1.0
        basis = orthonormal(self._basis(row)[: rest.size])
        self._likeness[row] = likeness(rest - basis @ (basis.T @ rest), basis)
        return self._likeness[row]

    def _probability(self, name: str) -> float:
        """The probability of what is seen if a model was true."""
        fits, row = self.fits, self.best_of(name)
        others = [one for one in self.family if fits.model[one] != name]
        if self.inner.size and name == fits.model[self.inner[0]]:
            # which the others are limits of, but for DMT without a force before contact
            others = [one for one in others if fits.model[one] == "DMT"]
        least = min((float(fits.squares[one]) for one in others), default=np.inf)
        fall = max(float(fits.squares[row]) - least, 0.0) / self.variance
        basis = self._basis(row)
        paths: list[Array] = []
        if others and fall <= FAR:
            if self.bare[row]:
                differences = self._adhesions(row)
            else:
                along = [one for one in others if not self.bare[one]]
                # from the model itself on
                along = along[::-1] if name == "JKR" else along
                differences = [fits.load[along] - fits.load[row]] if along else []
            for path in differences:
                path = path - (path @ basis) @ basis.T
                path = path / np.sqrt(self.variance)
                # differences that are always seen are none by chance
                path = path[np.sum(path**2, axis=1) < FAR]
                # a limit of the others begins with no difference
                if len(path) > 1 and np.sum(path[0] ** 2) < 4.0:
                    path = np.concatenate([np.zeros((1, path.shape[1])), path])
                if len(path):
                    paths.append(path)
        return probability(fall, paths, self.freedom, lambda: self.likeness(row)[1])

    def _adhesions(self, row: int) -> list[Array]:
        """How loads would change with adhesion, for works of adhesion that grow from none, by each of some models."""
        curve, fits = self.curve, self.fits
        names = list(curve.tip.fewer)
        rows = self.family[~self.bare[self.family]]
        rows = rows[:: max(rows.size // 7, 1)]
        kinds = [(names.index(str(fits.model[one])), float(np.log(fits.tabor[one]))) for one in rows]
        forces = np.geomspace(_LEAST * max(curve.noise, curve.least), _MOST * float(np.ptp(curve.force)), _WORKS)
        works = forces / (1.75 * np.pi * curve.tip.radius)
        roots = np.sqrt(np.maximum(works / curve.work - curve.floor, 0.0))
        roots = np.append(0.0, roots[roots > 0.0])
        parameters = np.zeros((len(kinds), roots.size, 4))
        parameters[..., 0] = np.log(fits.modulus[row] / curve.modulus)
        parameters[..., 1] = roots
        parameters[..., 2] = (fits.point[row] - curve.point) / curve.length
        parameters[..., 3] = np.array([log_tabor for _, log_tabor in kinds])[:, None]
        models = np.repeat([model for model, _ in kinds], roots.size).tolist()
        loads = curve.core.loads(curve.tip.equilibria, models, parameters.reshape(-1, 4))
        loads = loads.reshape(len(kinds), roots.size, -1) - fits.load[row, : curve.z.size]
        # without adhesion there is no difference
        loads[:, 0] = 0.0
        return [np.pad(path, ((0, 0), (0, 2))) for path in loads]

    def _span(self, column: int, at: Array) -> tuple[float, float]:
        """The ends of a number over all likely fits that have it."""
        rows = self.likely if column != ROOT_WORK else self.likely[~self.bare[self.likely]]
        half = np.sqrt(self.room[rows] * self.spread[rows, column, column])
        found = at[rows]
        return float((found - half).min()), float((found + half).max())

    def modulus(self) -> Estimate:
        """The contact modulus."""
        lower, upper = self._span(LOG_MODULUS, np.log(self.fits.modulus))
        return Estimate(float(self.fits.modulus[self.given]), *np.exp(np.clip([lower, upper], -700.0, 700.0)).tolist())

    def point(self) -> Estimate:
        """The contact point, with its spread in its scale."""
        half = self._span(POINT, self.fits.point / self.curve.length)
        return Estimate(float(self.fits.point[self.given]), *(self.curve.length * end for end in half))

    def line(self) -> list[Estimate]:
        """Offset, slope and, where there is one, drift of the baseline."""
        lines = self.curve.baselines(self.fits.load[:, : self.curve.z.size])
        found = []
        for number in range(self.curve.columns.shape[1]):
            ends = self._span(OFFSET + number, lines[:, number])
            found.append(Estimate(float(lines[self.given, number]), *ends))
        return found

    def work(self) -> Estimate | None:
        """The work of adhesion; one that may be none has its likelihood followed up to its end."""
        if not any(self.curve.tip.adheres(name) for name in self.names):
            return None
        curve, fits = self.curve, self.fits
        if self.is_bare:
            return Estimate(0.0, 0.0, self._greatest_work())
        lower, upper = self._span(ROOT_WORK, fits.root_work)
        scaled = (float(curve.work * (max(root, 0.0) ** 2 + curve.floor)) for root in (lower, upper))
        return Estimate(float(fits.work[self.best]), *scaled)

    def _greatest_work(self) -> float:
        """The greatest work of adhesion of a likely fit."""
        curve, fits = self.curve, self.fits
        rows = self.likely[~self.bare[self.likely]]
        rows = rows[:: max(rows.size // 3, 1)]
        names, reach = list(curve.tip.fewer), float("inf")
        found = 0.0
        for row in rows:
            parameters = (
                float(np.log(fits.modulus[row] / curve.modulus)),
                float(fits.root_work[row]),
                float((fits.point[row] - curve.point) / curve.length),
                float(np.log(fits.tabor[row])),
            )
            model = names.index(str(fits.model[row]))
            root = curve.core.greatest_root(curve.tip.equilibria, model, parameters, self.most, curve.least)
            if fits.model[row] == "Maugis":
                before = float(fits.point[row]) - float(curve.z.min())
                reach = curve.tip.greatest_work(float(fits.modulus[row]), float(fits.tabor[row]), before)
            found = max(found, min(curve.work * (root**2 + curve.floor), reach))
        return found

    def tabor(self) -> Estimate | None:
        """The Tabor parameter, between the places at which the squares pass what is likely."""
        if not isinstance(self.curve.tip, Paraboloid) or not {"DMT", "Maugis", "JKR"} <= set(self.names):
            return None
        if self.is_bare:
            return Estimate(np.nan, 0.0, np.inf)
        fits, inner = self.fits, self.inner
        ends = {"DMT": 0.0, "JKR": np.inf}
        least = int(np.argmin(fits.squares[inner]))
        value = ends.get(str(fits.model[self.best]), float(fits.tabor[self.best]))
        if fits.squares[inner[least]] > self.most:
            # only limits are likely
            likely = [ends[str(fits.model[row])] for row in self.likely if fits.model[row] in ends]
            return Estimate(value, min(likely, default=value), max(likely, default=value))
        # the ends are no places between others: the likelihood goes to one side alone
        lower = 0.0 if self.probabilities["DMT"] >= LEVEL else self._passes(inner[least::-1])
        upper = np.inf if self.probabilities["JKR"] >= LEVEL else self._passes(inner[least:])
        return Estimate(value, lower, upper)

    def _passes(self, rows: NDArray[np.int64]) -> float:
        # the root is almost linear in the logarithm of the Tabor parameter
        roots = np.sqrt(np.maximum(self.fits.squares[rows] - self.least, 0.0))
        limit = np.sqrt(self.most - self.least)
        last = int(np.argmax(roots > limit)) if (roots > limit).any() else rows.size - 1
        part = slice(max(last - 1, 0), last + 1)
        return float(np.exp(np.interp(limit, roots[part], np.log(self.fits.tabor[rows[part]]))))

    def range(self) -> Estimate | None:
        """The range of adhesion, none with JKR and of any length with DMT."""
        tip, fits = self.curve.tip, self.fits
        if not isinstance(tip, Paraboloid) or not {"DMT", "Maugis", "JKR"} <= set(self.names):
            return None
        if self.is_bare:
            return Estimate(np.nan, 0.0, np.inf)
        ends = {"JKR": (0.0, 0.0, 0.0), "DMT": (np.inf, np.inf, np.inf)}

        def span(row: int) -> tuple[float, float, float]:
            if (name := str(fits.model[row])) in ends:
                return ends[name]
            tangent = np.array([-2.0, 4.0 / max(fits.root_work[row], 1e-9)]) / 3.0
            spread = float(tangent @ self.spread[row, :2, :2] @ tangent)
            half = np.sqrt(self.room[row] * spread)
            length = tip.length(fits.modulus[row], fits.work[row]) / float(fits.tabor[row])
            return length, length * float(np.exp(-half)), length * float(np.exp(min(half, 99.0)))

        spans = [span(row) for row in self.likely if not self.bare[row]]
        return Estimate(span(self.best)[0], min(lower for _, lower, _ in spans), max(upper for _, _, upper in spans))

    def covariance(self) -> Array:
        """The covariance over all Tabor parameters: that within fits, and that between them."""
        rows, curve, fits = self.inner if self.inner.size else self.family, self.curve, self.fits
        weights = np.gradient(np.log(fits.tabor[rows])) if rows.size > 1 else np.ones(1)
        weights = weights * np.exp(-0.5 * (fits.squares[rows] - fits.squares[rows].min()) / self.variance)
        weights /= weights.sum()
        lines = curve.baselines(fits.load[rows, : curve.z.size])[:, : curve.columns.shape[1]]
        values = np.column_stack([fits.modulus[rows], fits.work[rows], fits.point[rows], lines])
        off = values - weights @ values
        kept = [LOG_MODULUS, ROOT_WORK, POINT, *range(OFFSET, OFFSET + lines.shape[1])]
        scales = np.ones((rows.size, len(kept)))
        scales[:, 0], scales[:, 1], scales[:, 2] = fits.modulus[rows], 2.0 * curve.work * fits.root_work[rows], curve.length
        within = self.spread[np.ix_(rows, kept, kept)] * scales[:, :, None] * scales[:, None, :]
        return np.asarray(self.variance * np.einsum("r,rij->ij", weights, within) + (weights * off.T) @ off)

    def model(self, name: str) -> ModelFit:
        """A row of the models."""
        row, points = self.best_of(name), self.curve.z.size
        squares, fewer = float(self.fits.squares[row]), self.curve.tip.fewer[name]
        aic = points * np.log(max(squares, 1e-300) / points) - 2.0 * fewer
        work = 0.0 if self.bare[row] else float(self.fits.work[row])
        rms, modulus, point = np.sqrt(squares / points), self.fits.modulus[row], self.fits.point[row]
        return ModelFit(float(modulus), work, float(point), float(rms), float(aic), self.probabilities[name])
