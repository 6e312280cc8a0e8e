"""Force curves of tips: contact modulus and work of adhesion by a fit of Hertz, DMT, Maugis and JKR, or of a table."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _asperity
from ..common.types import Quantity
from ..common.units import in_si
from ..common.warnings import InputWarning, warn
from ..common.words import suggests
from ..plot import figures
from .request import Request, read_request
from .curve import Direction
from .likelihood import DOUBTFUL, LEVEL, UNLIKELY, Estimate, Likelihood, ModelFit
from .pictures import force_curve
from .search import search
from .tip_table import TipTable
from .tips import Array


class CurveFit:
    """What a force curve tells of the contact, with 95 % intervals.

    Intervals come from the likelihood over all Tabor parameters: the intervals of modulus and work of adhesion are
    wider where the curve does not tell DMT from JKR. They hold for noise of the force that is independent from point to
    point.

    Attributes
    ----------
    modulus : Estimate
        Contact modulus E*, a pressure.
    young : Estimate or None
        Young's modulus E = E* (1 − ν²) under a rigid tip, if Poisson's ratio was given.
    work_of_adhesion : Estimate or None
        Work of adhesion w, an energy per area. It is zero, as its lower end, where Hertz is not ruled out. None without
        adhesion.
    tabor_parameter : Estimate or None
        Tabor parameter: infinite for JKR, zero for DMT; NaN where Hertz is not ruled out. None with a table or a model
        that was given, as `range`.
    range : Estimate or None
        Range ρ of the adhesion after Maugis and Dugdale, a length.
    contact_point : Estimate
        Position z at which the approach is zero.
    offset, slope : Estimate
        Baseline: force far from the contact at z = 0, and its change with z.
    drift : Estimate or None
        Change of the baseline from the first point to the last; None on one direction alone, where it is the change of
        a slope.
    covariance : ndarray
        Covariance of the numbers in `names`, over all Tabor parameters by their likelihood. Where Hertz is not ruled
        out it tells nothing of the work of adhesion.
    names : tuple of str
        Rows of the covariance: modulus, work_of_adhesion, contact_point, offset, slope, and drift.
    models : dict
        `ModelFit` of Hertz, DMT, Maugis and JKR by these names, with a table of ``"no adhesion"`` and ``"adhesion"``;
        the one that was given alone.
    verdict : str
        Which of these the curve tells apart, in a sentence, with the table, its limits and its error.
    z, force, fitted, residuals : ndarray
        Positions and forces, forces of the best fit, or of Hertz where that is not ruled out, and the difference.
    noise : float
        Standard deviation of the residuals.
    """

    modulus: Estimate
    young: Estimate | None
    work_of_adhesion: Estimate | None
    tabor_parameter: Estimate | None
    range: Estimate | None
    contact_point: Estimate
    offset: Estimate
    slope: Estimate
    drift: Estimate | None
    covariance: Array
    names: tuple[str, ...]
    models: dict[str, ModelFit]
    verdict: str
    z: Array
    force: Array
    fitted: Array
    residuals: Array
    noise: float
    #: the first point of the withdrawal, whether numbers are in SI units, and the model with the values
    _turn: int
    _is_si: bool
    _best: str

    def __init__(self, **found: Any) -> None:
        self.__dict__.update(found)

    def __repr__(self) -> str:
        units = {
            "modulus": "Pa",
            "young": "Pa",
            "work_of_adhesion": "J/m²",
            "tabor_parameter": None,
            "range": "m",
            "contact_point": "m",
            "offset": "N",
            "slope": "N/m",
            "drift": "N",
        }
        lines = [f"{'':<18}{'value':>12}   95 % interval"]
        for name, unit in units.items():
            found: Estimate | None = getattr(self, name)
            if found is not None:
                shown = (1.0, unit if self._is_si else None)
                factor, unit = figures._scaled([end for end in found if np.isfinite(end)], shown)
                value, lower, upper = _digits(factor, found)
                lines.append(f"{name.replace('_', ' '):<18}{value:>12}   {lower} to {upper} {unit}".rstrip())
        lines.append(f"{'':<18}{'rms residual':>12}   AIC   probability")
        for name, model in self.models.items():
            factor, unit = figures._scaled([model.rms], (1.0, "N" if self._is_si else None))
            rms = f"{factor * model.rms:.4g} {unit}".rstrip()
            lines.append(f"{name:<18}{rms:>12}   {model.aic:.1f}   {model.p_value:.2g}")
        return "\n".join([*lines, self.verdict])

    def plot(self, ax: Any = None, *, length_unit: str | None = None, force_unit: str | None = None) -> Any:
        """Draws data and fit, and the residuals below; needs matplotlib.

        Parameters
        ----------
        ax : sequence of two matplotlib Axes, optional
            Axes to draw on; new ones by default.
        length_unit, force_unit : str, optional
            Units for the axes, into which the numbers of a fit with units are converted; numbers of other fits stay as
            they are. ``"m"`` and ``"N"``, the default of a fit with units, get prefixes.

        Returns
        -------
        ndarray of two matplotlib Axes
        """
        own = ("m", "N") if self._is_si else (None, None)
        length, force = figures.axis_unit("length_unit", own[0], length_unit), figures.axis_unit("force_unit", own[1], force_unit)
        return force_curve(self.z, self.force, self.fitted, self._turn, length, force, ax)


def _digits(factor: float, found: Estimate) -> list[str]:
    """The numbers of an estimate with two digits of its interval, at least four of their own."""
    value, lower, upper = (factor * end for end in found)
    half, largest = 0.5 * (upper - lower), max(abs(end) for end in (value, 1e-300) if np.isfinite(end))
    digits = 2 + int(np.log10(largest / half)) if 0.0 < half < largest else 4
    return [f"{end:.{min(max(digits, 4), 12)}g}" for end in (value, lower, upper)]


@suggests
def fit_curve(
    z: ArrayLike,
    force: ArrayLike,
    *,
    radius: Quantity | None = None,
    tip: TipTable | None = None,
    spring_stiffness: Quantity | None = None,
    poisson: float | None = None,
    direction: Direction | None = None,
    model: str | None = None,
    jumps: bool = True,
    length_unit: str | None = None,
    force_unit: str | None = None,
) -> CurveFit:
    """Fits the force curve of a tip: contact modulus, work of adhesion, contact point and baseline.

    By its ``radius`` the tip is a smooth paraboloid on a half-space with the adhesion of Maugis and Dugdale, with the
    limits DMT and JKR, at Tabor parameters from 0.01 to 50. Any other tip is a `TipTable`: a measured or rough one, a
    cone, or one on a layer, with a law of a given range. What is beyond the table is refused, and its ``error`` comes
    from interpolation. Approach and withdrawal are fitted together, with the jumps of the spring where an equilibrium
    ends. Needs SciPy.

    Parameters
    ----------
    z : array_like, shape (N,)
        Positions in the order in which they were recorded, greater as the bodies come closer. With a spring positions
        of the piezo, which moves by the approach and the deflection of the spring. Without one the approach itself, but
        for its zero.
    force : array_like, shape (N,)
        Forces at these positions, compression positive.
    radius : float or str, optional
        Radius of curvature of a smooth tip.
    tip : TipTable, optional
        Equilibria of a tip of another shape, solved once for all of its curves, in place of a radius.
    spring_stiffness : float or str, optional
        Stiffness of the cantilever, a force per length.
    poisson : float, optional
        Poisson's ratio of the sample, for its Young's modulus under a rigid tip.
    direction : {"approach", "withdrawal"}, optional
        The only direction that was recorded. By default points up to the greatest z are the approach, and those behind
        it are the withdrawal. With a direction the order may be either.
    model : {"hertz", "dmt", "maugis", "jkr"}, optional
        The only model to fit, quicker than all; of a table ``"no adhesion"`` or ``"adhesion"``.
    jumps : bool
        Whether to fit the places of jumps, which are where an equilibrium ends. Vibrations may bring a jump early: then
        False takes from a jump only on which side of it a point is.
    length_unit, force_unit : str, optional
        Units of z and force, such as "nm" and "nN", with a radius such as "20nm". Results are in SI units.

    Returns
    -------
    CurveFit

    Raises
    ------
    ValueError, TypeError
        For arrays that are not alike, not finite or too short, a force that is saturated, one without a contact, and a
        spring that is too soft to see the stiffness of the contact. For a curve that leads beyond the table of the tip.
    ImportError
        Without SciPy.

    Warns
    -----
    InputWarning
        If neighbouring residuals are alike: the curve is not from such a tip, and intervals are too narrow. If the
        greatest indentation is greater than the radius, as where z is in nm and the radius in m. If the force falls
        further on approach than on withdrawal.

    See Also
    --------
    read_curve : z and force of a file.

    Examples
    --------
    >>> import asperity, numpy as np
    >>> z = np.linspace(-20e-9, 5e-9, 200)
    >>> force = asperity.exact.Hertz(20e-9, 2e9).at_approach(z.clip(0)).load
    >>> force += np.random.default_rng(1).normal(scale=0.1e-9, size=200)
    >>> fit = asperity.fit_curve(z, force, radius=20e-9)
    >>> fit.modulus.lower < 2e9 < fit.modulus.upper, fit.work_of_adhesion.lower
    (True, 0.0)
    """
    radius, spring_stiffness, is_si = in_si(radius=radius, spring_stiffness=spring_stiffness)
    units = length_unit, force_unit
    keywords = read_request(radius, tip, spring_stiffness, poisson, direction, model, jumps, *units, is_si)
    found, told = fit_one(z, force, keywords)
    for message in told:
        warn(message, InputWarning)
    return found


CurveFit.__module__ = "asperity"


def fit_one(z: ArrayLike, force: ArrayLike, request: Request) -> tuple[CurveFit, list[str]]:
    """The fit of a curve, and what speaks against it."""
    curve, told = request.curve(z, force)
    found = Likelihood(curve, search(curve, request.models, request.jumps))
    fit, more = _conclude(found, request.poisson, request.is_si)
    return fit, told + more


def _conclude(found: Likelihood, poisson: float | None, is_si: bool) -> tuple[CurveFit, list[str]]:
    """All numbers by their names, and what speaks against them, or the refusal of a curve that does not tell them."""
    curve, fits, best = found.curve, found.fits, found.given
    line = float(np.sum(curve.clear_baseline(curve.force) ** 2))
    if found.special.fdtrc(4, found.freedom, max(line - found.least, 0.0) / found.variance / 4.0) > 1e-4:
        curve.refuse_empty()
    modulus = found.modulus()
    if not modulus.upper < 10.0 * modulus.lower:
        curve.refuse_vague(modulus.lower, modulus.upper)
    models = {name: found.model(name) for name in found.names}
    least = min(model.aic for model in models.values())
    ratio = None if poisson is None else _asperity.contact_modulus([(1.0, poisson)])
    load = fits.load[best, : curve.z.size]
    fitted = load + curve.columns @ curve.baselines(load)[: curve.columns.shape[1]]
    approach = float((curve.z - fits.point[best] - curve.compliance * load).max())
    tabor, work = found.tabor(), found.work()
    told = [curve.tip.check_reach(modulus.value, 0.0 if work is None else work.upper, approach)]
    alike, by_chance = found.likeness(found.best)
    if by_chance < UNLIKELY:
        told.append(
            f"residuals of neighbouring points have a correlation of {alike:.2f}: the curve is not that of "
            f"{curve.tip.what}, or its noise is slow, and the intervals are too narrow; plot() shows it"
        )
    offset, slope, *drift = found.line()
    fit = CurveFit(
        modulus=modulus,
        young=None if ratio is None else Estimate(*(end / ratio for end in modulus)),
        work_of_adhesion=work,
        tabor_parameter=tabor,
        range=found.range(),
        contact_point=found.point(),
        offset=offset,
        slope=slope,
        drift=drift[0] if drift else None,
        covariance=found.covariance(),
        names=("modulus", "work_of_adhesion", "contact_point", "offset", "slope") + ("drift",) * len(drift),
        models={name: model._replace(aic=model.aic - least) for name, model in models.items()},
        verdict=_verdict(found, models, tabor, work, by_chance < UNLIKELY, is_si),
        z=curve.z,
        force=curve.force,
        fitted=fitted,
        residuals=curve.force - fitted,
        noise=float(np.sqrt(found.least / found.freedom)),
        _turn=curve.turn,
        _is_si=is_si,
        _best=str(fits.model[best]),
    )
    return fit, list(filter(None, told))


def _verdict(
    found: Likelihood,
    models: dict[str, ModelFit],
    tabor: Estimate | None,
    work: Estimate | None,
    is_unlikely: bool,
    is_si: bool,
) -> str:
    """Which models the curve tells apart, in a sentence."""
    what, nearest = found.curve.tip.what, str(found.fits.model[found.best])
    if is_unlikely:
        count = {1: "This model does not fit", 2: "Neither model fits"}.get(len(models), "None of the four models fits")
        return f"{count}: residuals of neighbouring points are alike. The nearest is {nearest}."
    if len(models) == 1:
        return f"By {what}, without adhesion." if len(found.curve.tip.fewer) == 1 else f"By {nearest} alone, for {what}."
    bare, model = next(iter(models.items()))
    if found.is_bare and work is not None:
        unit = " J/m²" if is_si else ""
        told = "the tip without it" if tabor is None else bare
        return f"No adhesion is seen: {told} fits as well, and the work of adhesion is at most {work.upper:.3g}{unit}."
    if tabor is None:
        return f"Adhesion is seen, by {what}."
    hardly = f"Adhesion is hardly seen: {bare} has a probability of {model.p_value:.2g}. " if model.p_value >= DOUBTFUL else ""
    return hardly + _between(models, nearest, tabor)


def _between(models: dict[str, ModelFit], nearest: str, tabor: Estimate) -> str:
    """Which models with adhesion the curve tells apart."""
    fits = [name for name in ("DMT", "JKR") if models[name].p_value >= LEVEL or name == nearest]
    if len(fits) == 2:
        return "Adhesion is seen, but the curve cannot tell DMT from JKR: both fit as well as Maugis."
    if fits == ["DMT"]:
        return f"DMT fits as well as Maugis, with a Tabor parameter of at most {tabor.upper:.2g}; JKR is ruled out."
    if fits == ["JKR"]:
        return f"JKR fits as well as Maugis, with a Tabor parameter of at least {tabor.lower:.2g}; DMT is ruled out."
    return f"Maugis, with a Tabor parameter from {tabor.lower:.2g} to {tabor.upper:.2g}; Hertz, DMT and JKR are ruled out."
