"""What the fits of a force curve tell together: intervals, a covariance, and which models are ruled out."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from . import _asperity
from ._curve import Curve, Fitted
from ._equilibria import Array, Paraboloid, scipy
from ._units import number
from ._warnings import InputWarning, warn

#: A probability below this rules a model out, and intervals have the complement.
_LEVEL = 0.05


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
        Information criterion of Akaike, less that of the best model.
    p_value : float
        Probability of residuals that are as much larger than those of Maugis, if the model was true. Below 0.05 the model
        is ruled out.
    """

    modulus: float
    work_of_adhesion: float
    contact_point: float
    rms: float
    aic: float
    p_value: float


class Likelihood:
    """The fits of a curve, and what they tell together."""

    def __init__(self, curve: Curve, fits: dict[str, Fitted]) -> None:
        self.curve, self.fits = curve, fits
        self.special = scipy("special")
        self.limits = {name: fits[name] for name, fewer in curve.tip.fewer.items() if fewer}
        self.without, *others = self.limits.values()
        inner = [fit for name, fit in fits.items() if name not in self.limits]
        # at the greatest Tabor parameter the range is that of JKR, none
        last = max(inner or [self.without], key=lambda fit: fit.tabor)
        self.inner = sorted(filter(curve.holds, inner), key=lambda fit: fit.tabor) or [last]
        self.best = min((*self.inner, *others), key=lambda fit: fit.squares)
        self.freedom = curve.z.size - self.best.at.size
        self.variance = self.best.squares / self.freedom
        # the square of Student's t is F with one degree of freedom
        self.most = self.best.squares + self.variance * self.special.fdtri(1, self.freedom, 1.0 - _LEVEL)
        self.bare = self.probability(self.without, next(iter(curve.tip.fewer.values()))) >= _LEVEL
        family = [*self.inner, *others, *[self.without] * self.bare]
        self.likely = [fit for fit in family if fit.squares <= self.most]

    def probability(self, fit: Fitted, fewer: int) -> float:
        """The probability of squares as large as those of a fit with fewer parameters, if it was true."""
        more = max(fit.squares - self.best.squares, 0.0) / self.variance / fewer
        return float(self.special.fdtrc(fewer, self.freedom, more))

    def estimate(self, index: int, of: Callable[[float], float] = float) -> Estimate:
        """A number with the widest ends of all likely fits."""
        spans = [(fit.at[index], np.sqrt((self.most - fit.squares) * fit.spread[index, index])) for fit in self.likely]
        lower, upper = min(at - half for at, half in spans), max(at + half for at, half in spans)
        # the work of adhesion is a square
        lower = max(lower, 0.0) if index == 1 else lower
        return Estimate(of(float(self.best.at[index])), of(float(lower)), of(float(upper)))

    def work(self) -> Estimate | None:
        """The work of adhesion; one that may be none has its likelihood followed up to its end."""
        if not self.curve.tip.tabor.size:
            return None
        found = self.estimate(1, self.curve.work_at)
        if not self.bare:
            return found
        adhesive = [fit for fit in self.likely if fit is not self.without]
        return Estimate(found.value, 0.0, max(self.curve.greatest_work(fit, self.most) for fit in adhesive))

    def tabor(self) -> Estimate | None:
        """The Tabor parameter, between the places at which the squares pass what is likely."""
        if not isinstance(self.curve.tip, Paraboloid):
            return None
        if self.bare:
            return Estimate(np.nan, 0.0, np.inf)
        least = min(range(len(self.inner)), key=lambda k: self.inner[k].squares)
        if self.inner[least].squares > self.most:
            # only limits are likely
            ends = [{"DMT": 0.0, "JKR": np.inf}[self.name(fit)] for fit in self.likely]
            return Estimate(ends[0], min(ends), max(ends))
        lower = 0.0 if self.fits["DMT"].squares <= self.most else self._passes(self.inner[least::-1])
        upper = np.inf if self.fits["JKR"].squares <= self.most else self._passes(self.inner[least:])
        return Estimate({"DMT": 0.0, "JKR": np.inf}.get(self.name(self.best), self.best.tabor), lower, upper)

    def _passes(self, fits: list[Fitted]) -> float:
        # the root is almost linear in the logarithm of the Tabor parameter
        roots = np.sqrt([max(fit.squares - self.best.squares, 0.0) for fit in fits])
        limit = np.sqrt(self.most - self.best.squares)
        last = int(np.argmax(roots > limit)) if (roots > limit).any() else len(fits) - 1
        part = slice(max(last - 1, 0), last + 1)
        return float(np.exp(np.interp(limit, roots[part], np.log([fit.tabor for fit in fits[part]]))))

    def name(self, of: Fitted) -> str:
        """The name of a fit among the limits; that of Maugis for all others."""
        return next((name for name, fit in self.limits.items() if fit is of), "Maugis")

    def range(self) -> Estimate | None:
        """The range of adhesion, none with JKR and of any length with DMT."""
        tip = self.curve.tip
        if not isinstance(tip, Paraboloid):
            return None
        if self.bare:
            return Estimate(np.nan, 0.0, np.inf)
        ends = {"JKR": (0.0, 0.0, 0.0), "DMT": (np.inf, np.inf, np.inf)}

        def of(fit: Fitted) -> tuple[float, float, float]:
            if (name := self.name(fit)) != "Maugis":
                return ends[name]
            tangent = np.array([-2.0, 4.0 / max(fit.at[1], 1e-9)]) / 3.0
            half = np.sqrt((self.most - fit.squares) * (tangent @ fit.spread[:2, :2] @ tangent))
            length = tip.length(*self.curve.values(fit.at)[:2]) / fit.tabor
            return length, length * float(np.exp(-half)), length * float(np.exp(min(half, 99.0)))

        spans = [of(fit) for fit in self.likely]
        return Estimate(of(self.best)[0], min(lower for _, lower, _ in spans), max(upper for _, _, upper in spans))

    def covariance(self) -> Array:
        """The covariance over all Tabor parameters: that within fits, and that between them."""
        fits = self.inner
        weights = np.gradient(np.log([fit.tabor for fit in fits])) if len(fits) > 1 else np.ones(1)
        squares = np.array([fit.squares for fit in fits])
        weights *= np.exp(-0.5 * (squares - squares.min()) / self.variance)
        weights /= weights.sum()
        values = np.array([self.curve.numbers(fit) for fit in fits])
        off = values - weights @ values
        within = sum(weight * self.curve.spread(fit) for weight, fit in zip(weights, fits))
        return np.asarray(self.variance * within + (weights * off.T) @ off)

    def model(self, name: str) -> ModelFit:
        """A row of the models."""
        fit = self.limits.get(name) or min(self.inner, key=lambda fit: fit.squares)
        fewer = self.curve.tip.fewer[name]
        probability = self.probability(fit, fewer) if fewer else 1.0
        points = self.curve.z.size
        aic = points * np.log(fit.squares / points) - 2.0 * fewer
        modulus, work, point = self.curve.values(fit.at)
        rms = float(np.sqrt(fit.squares / points))
        return ModelFit(modulus, 0.0 if fit is self.without else work, point, rms, float(aic), probability)

    def told(self, poisson: float | None, is_si: bool) -> dict[str, Any]:
        """All numbers by their names, or the refusal of a curve that does not tell them."""
        curve, best = self.curve, self.best
        line = float(np.sum(curve.cleared(curve.data) ** 2))
        if self.special.fdtrc(4, self.freedom, max(line - best.squares, 0.0) / self.variance / 4.0) > 1e-4:
            curve.refuse_empty()
        modulus = self.estimate(0, curve.modulus_at)
        if not modulus.upper < 10.0 * modulus.lower:
            curve.refuse_vague(modulus.lower, modulus.upper)
        models = {name: self.model(name) for name in curve.tip.fewer}
        least = min(model.aic for model in models.values())
        ratio = None if poisson is None else _asperity.contact_modulus([(1.0, number("poisson", poisson))])
        fitted, approach = curve.fitted(best)
        residuals = curve.force - fitted
        tabor, work = self.tabor(), self.work()
        curve.tip.check_reach(modulus.value, 0.0 if work is None else work.upper, approach)
        alike = 1.0 - float(np.sum(np.diff(residuals) ** 2)) / (2.0 * best.squares)
        noise = float(np.sqrt(self.variance))
        if alike > 6.0 / np.sqrt(residuals.size) and noise > 1e-4 * np.ptp(curve.force):
            warn(
                f"residuals of neighbouring points have a correlation of {alike:.2f}: the curve is not that of "
                f"{curve.tip.what}, or its noise is slow, and the intervals are too narrow; plot() shows it",
                InputWarning,
            )
        drifts = best.at.size == 7
        return dict(
            modulus=modulus,
            young=None if ratio is None else Estimate(*(end / ratio for end in modulus)),
            work_of_adhesion=work,
            tabor_parameter=tabor,
            range=self.range(),
            contact_point=self.estimate(2, curve.point_at),
            offset=self.estimate(4),
            slope=self.estimate(5),
            drift=self.estimate(6) if drifts else None,
            covariance=self.covariance(),
            names=("modulus", "work_of_adhesion", "contact_point", "offset", "slope") + ("drift",) * drifts,
            models={name: model._replace(aic=model.aic - least) for name, model in models.items()},
            verdict=_verdict(models, tabor, work, curve.tip.what, is_si),
            z=curve.z,
            force=curve.force,
            fitted=fitted,
            residuals=residuals,
            noise=noise,
            _turn=curve.turn,
            _is_si=is_si,
        )


def _verdict(models: dict[str, ModelFit], tabor: Estimate | None, work: Estimate | None, what: str, is_si: bool) -> str:
    """Which models the curve tells apart, in a sentence."""
    without, model = next(iter(models.items()))
    if work is None:
        return f"By {what}, without adhesion."
    if model.p_value >= _LEVEL:
        unit = " J/m²" if is_si else ""
        told = "the tip without it" if tabor is None else without
        return f"No adhesion is seen: {told} fits as well, and the work of adhesion is at most {work.upper:.3g}{unit}."
    if tabor is None:
        return f"Adhesion is seen, by {what}."
    fits = [name for name in ("DMT", "JKR") if models[name].p_value >= _LEVEL]
    if len(fits) == 2:
        return "Adhesion is seen, but the curve cannot tell DMT from JKR: both fit as well as Maugis."
    if fits == ["DMT"]:
        return f"DMT fits as well as Maugis, with a Tabor parameter of at most {tabor.upper:.2g}; JKR is ruled out."
    if fits == ["JKR"]:
        return f"JKR fits as well as Maugis, with a Tabor parameter of at least {tabor.lower:.2g}; DMT is ruled out."
    return f"Maugis, with a Tabor parameter from {tabor.lower:.2g} to {tabor.upper:.2g}; Hertz, DMT and JKR are ruled out."
