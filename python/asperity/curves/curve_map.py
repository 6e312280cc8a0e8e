"""Maps of force curves: fits of many curves, on all cores."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Any, NamedTuple, TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..common.optional import package
from ..common.progress import show_progress
from ..common.types import Lengths, Quantity
from ..common.units import in_si, in_unit
from ..common.warnings import InputWarning, warn
from ..common.words import suggests
from ..plot import figures
from .request import Request, read_request
from .curve import Direction
from .files.read import Reader, metres_and_newtons
from .fit import CurveFit, fit_one
from .pictures import number_map
from .tip_table import TipTable
from .tips import Array

#: Curves: the path of a file, pairs of positions and forces, or an array of shape (..., 2, N).
Curves: TypeAlias = str | os.PathLike[str] | Sequence[tuple[ArrayLike, ArrayLike]] | NDArray[np.float64]

#: Numbers of a map with intervals, and their units in SI units.
_NUMBERS = {
    "modulus": "Pa",
    "young": "Pa",
    "work_of_adhesion": "J/m²",
    "tabor_parameter": None,
    "contact_point": "m",
}


class Estimates(NamedTuple):
    """A number of each curve, and the ends of its 95 % interval."""

    value: Array
    lower: Array
    upper: Array


class CurveMap:
    """What the force curves of a map tell, with 95 % intervals: arrays of the shape of the map.

    Attributes
    ----------
    modulus, young, work_of_adhesion, tabor_parameter, contact_point : tuple of ndarray
        Arrays ``value``, ``lower`` and ``upper`` of these numbers of `CurveFit`; NaN where a curve has none.
    contact_height : ndarray
        Height of the surface at the contact points, −`contact_point`: z grows as the tip comes down.
    noise : ndarray
        Standard deviation of the residuals.
    best : ndarray of str
        Model that fits best, or the one without adhesion where that is not ruled out.
    p_values : dict
        Probability of each model, as arrays, by its name.
    reason : ndarray of str
        Why a curve has no numbers; empty where it has.
    warning : ndarray of str
        What speaks against the numbers of a curve; empty where nothing does.
    shape : tuple of int
        Shape of the map.
    lengths : tuple of float or None
        Side lengths of the map, if they are known.
    """

    modulus: Estimates
    young: Estimates
    work_of_adhesion: Estimates
    tabor_parameter: Estimates
    contact_point: Estimates
    noise: Array
    best: NDArray[np.str_]
    p_values: dict[str, Array]
    reason: NDArray[np.str_]
    warning: NDArray[np.str_]
    shape: tuple[int, ...]
    lengths: tuple[float, float] | None
    _is_si: bool

    def __init__(self, **found: Any) -> None:
        self.__dict__.update(found)

    @property
    def contact_height(self) -> Array:
        return -np.asarray(self.contact_point.value)

    def __repr__(self) -> str:
        count, fits = self.reason.size, self.reason == ""
        lines = [f"{count} force curves, {int(fits.sum())} of them fitted", f"{'':<18}{'median':>12}   quartiles"]
        for name, unit in _NUMBERS.items():
            values = getattr(self, name).value[np.isfinite(getattr(self, name).value)]
            if values.size:
                ends = np.quantile(values, [0.5, 0.25, 0.75])
                factor, unit = figures._scaled(ends, (1.0, unit if self._is_si else None))
                middle, low, high = (f"{factor * end:.4g}" for end in ends)
                lines.append(f"{name.replace('_', ' '):<18}{middle:>12}   {low} to {high} {unit}".rstrip())
        if not fits.all():
            reasons, counts = np.unique(np.array([_kind(text) for text in self.reason[~fits]]), return_counts=True)
            lines += [f"{number} without: {reason}" for reason, number in zip(reasons, counts)]
        return "\n".join(lines)

    def plot(
        self,
        of: str = "modulus",
        ax: Any = None,
        *,
        length_unit: str | None = None,
        unit: str | None = None,
    ) -> Any:
        """Draws a number over the map; needs matplotlib. Curves without it are grey.

        Parameters
        ----------
        of : str
            The number: an attribute of the map, as "modulus" or "contact_height".
        ax : matplotlib Axes, optional
            Axes to draw on; new ones by default.
        length_unit : str, optional
            Unit of the side lengths.
        unit : str, optional
            Unit of the number, for numbers without units.

        Returns
        -------
        matplotlib Axes
        """
        known = [*_NUMBERS, "contact_height", "noise"]
        if of not in known:
            raise ValueError(f"of is {of!r}: it must be one of {', '.join(known)}")
        if len(self.shape) != 2:
            raise ValueError(f"the curves have the shape {self.shape}: give fit_curves shape=(NX, NY), as a map has it")
        found = getattr(self, of)
        values = np.asarray(found.value if isinstance(found, Estimates) else found)
        own = {**_NUMBERS, "contact_height": "m", "noise": "N"}[of] if self._is_si else unit
        lengths = self.lengths or cast(tuple[float, float], tuple(map(float, self.shape)))
        length = "m" if self._is_si and self.lengths else length_unit
        units = figures.axis_unit("length_unit", length if self.lengths else None, length_unit), (1.0, own)
        return number_map(values, lengths, of.replace("_", " "), units, ax)

    def to_xarray(self) -> Any:
        """All arrays over the places of the map, with side lengths in metres or those that were given; needs xarray.

        Returns
        -------
        xarray.Dataset
        """
        xarray = package("xarray", "to_xarray needs xarray: python -m pip install xarray")
        dims = ("x", "y")[: len(self.shape)]
        sides = self.lengths or tuple(map(float, self.shape))
        coords = {dim: (np.arange(n) + 0.5) * side / n for dim, n, side in zip(dims, self.shape, sides)}
        return xarray.Dataset({name: (dims, values) for name, values in self._columns().items()}, coords)

    def to_dataframe(self) -> Any:
        """A row for each curve, with its place in the map; needs pandas.

        Returns
        -------
        pandas.DataFrame
        """
        pandas = package("pandas", "to_dataframe needs pandas: python -m pip install pandas")
        places = dict(zip(("row", "column"), np.indices(self.shape))) if len(self.shape) == 2 else {}
        columns = {**places, **self._columns()}
        return pandas.DataFrame({name: np.ravel(values) for name, values in columns.items()})

    def _columns(self) -> dict[str, NDArray[Any]]:
        """All arrays by their names."""
        found: dict[str, NDArray[Any]] = {}
        for name in _NUMBERS:
            for end, values in getattr(self, name)._asdict().items():
                found[name if end == "value" else f"{name}_{end}"] = np.asarray(values)
        found |= {"contact_height": self.contact_height, "noise": self.noise, "best": self.best}
        found |= {f"p_{name.replace(' ', '_')}": values for name, values in self.p_values.items()}
        return {**found, "reason": self.reason, "warning": self.warning}


CurveMap.__module__ = "asperity"


def _kind(text: str) -> str:
    """A message without its numbers, to be counted."""
    return text.partition(": ")[2].partition(";")[0] or text


@suggests
def fit_curves(
    curves: Curves,
    *,
    radius: Quantity | None = None,
    tip: TipTable | None = None,
    spring_stiffness: Quantity | None = None,
    sensitivity: Quantity | None = None,
    poisson: float | None = None,
    direction: Direction | None = None,
    model: str | None = None,
    jumps: bool = True,
    length_unit: str | None = None,
    force_unit: str | None = None,
    shape: tuple[int, ...] | None = None,
    lengths: Lengths | None = None,
    threads: int | None = None,
) -> CurveMap:
    """Fits the force curves of a map, as `fit_curve` fits each of them, on all cores.

    A curve that cannot be fitted costs no other: its numbers are NaN, and `CurveMap.reason` has the reason. A bar shows
    the progress on a terminal or in a notebook.

    Parameters
    ----------
    curves : str or path, sequence of (z, force), or array_like
        File of a map, such as ``.jpk-qi-data`` and ``.jpk-force-map``, read by afmformats; pairs of positions and
        forces, of any number of points each; or an array of shape (..., 2, N) of these.
    radius, tip, spring_stiffness, poisson, direction, model, jumps, length_unit, force_unit
        As `fit_curve` takes them. A file is in SI units, and its own stiffness of the spring is taken by default.
    sensitivity : float or str, optional
        Deflection over the voltage of the detector, for a file that does not tell it, as `read_curve` takes it.
    shape : tuple of int, optional
        Shape of the map, of curves without one: all in a row by default.
    lengths : float, str or pair of them, optional
        Side lengths of the map; by default the side lengths of a file.
    threads : int, optional
        Number of threads; by default as many as there are cores.

    Returns
    -------
    CurveMap

    Raises
    ------
    ValueError, TypeError
        For keywords that `fit_curve` refuses, and files that `read_curve` refuses.

    Warns
    -----
    InputWarning
        If residuals of neighbouring points are alike, or another warning of `fit_curve` holds, in one curve of ten or
        more.

    Examples
    --------
    >>> import asperity, numpy as np
    >>> rng = np.random.default_rng(1)
    >>> z = np.linspace(-20e-9, 5e-9, 100)
    >>> def curve(modulus):
    ...     force = asperity.exact.Hertz(20e-9, modulus).at_approach(z.clip(0)).load
    ...     return z, force + rng.normal(scale=0.2e-9, size=100)
    >>> found = asperity.fit_curves([curve(1e9), curve(2e9), (z, np.zeros(100))], radius=20e-9)
    >>> np.round(found.modulus.value[:2] / 1e9).tolist(), str(found.reason[2])
    ([1.0, 2.0], 'force is 0.0 at all points: a curve has it change from point to point')
    """
    radius, spring_stiffness, lengths, is_si = in_si(radius=radius, spring_stiffness=spring_stiffness, lengths=lengths)
    sides: Any = None
    if isinstance(curves, str | os.PathLike):
        found = Reader(curves, None, None, None, None, metres_and_newtons(spring_stiffness, sensitivity)).map()
        pairs: Sequence[Any] = found.pairs
        shape, sides = found.shape, found.lengths
        stiffness = found.stiffness if spring_stiffness is None else spring_stiffness
        if tip is not None and not tip._solved.is_si:
            raise ValueError(f"{curves} is in SI units, and the table is {tip!r}: make it with units")
        keywords = read_request(radius, tip, stiffness, poisson, direction, model, jumps, "m", "N", True)
    else:
        pairs, shape = _pair_curves(curves, shape)
        units = length_unit, force_unit
        keywords = read_request(radius, tip, spring_stiffness, poisson, direction, model, jumps, *units, is_si)
        if keywords.is_si:
            for name, unit in (("length_unit", length_unit), ("force_unit", force_unit)):
                in_unit(name, unit)
    if lengths is not None:
        sides = np.broadcast_to(np.asarray(lengths, np.float64), 2)
    if int(np.prod(shape)) != len(pairs):
        raise ValueError(f"shape is {shape}, of {int(np.prod(shape))} places, and there are {len(pairs)} curves")
    return _fit_map(pairs, keywords, shape, None if sides is None else tuple(map(float, sides)), threads)


def _pair_curves(curves: Any, shape: tuple[int, ...] | None) -> tuple[Sequence[Any], tuple[int, ...]]:
    """Pairs of positions and forces, and the shape of their map."""
    if isinstance(curves, np.ndarray) and curves.dtype != object:
        if curves.ndim < 3 or curves.shape[-2] != 2:
            raise ValueError(f"curves has shape {curves.shape}: it must be (..., 2, N), z and force of each curve")
        return list(curves.reshape(-1, *curves.shape[-2:])), shape or curves.shape[:-2]
    pairs = list(curves)
    if not pairs:
        raise ValueError("curves has none: give pairs of z and force")
    for k, pair in enumerate(pairs):
        if not isinstance(pair, Iterable) or isinstance(pair, str) or len(cast(Any, pair)) != 2:
            raise TypeError(f"curves[{k}] is a {type(pair).__name__}: it must be a pair of z and force")
    return pairs, shape or (len(pairs),)


def _fit_map(
    pairs: Sequence[Any], keywords: Request, shape: tuple[int, ...], lengths: Any, threads: int | None
) -> CurveMap:
    """The fits of pairs."""

    def one(pair: Any) -> tuple[CurveFit | None, str]:
        try:
            if isinstance(pair, ValueError):
                raise pair
            z, force = pair
            fit, told = fit_one(z, force, keywords)
        except (ValueError, TypeError) as refused:
            return None, str(refused)
        return fit, "; ".join(told)

    count = len(pairs)
    numbers = {name: np.full((3, count), np.nan) for name in _NUMBERS}
    noise, p_values = np.full(count, np.nan), {name: np.full(count, np.nan) for name in keywords.models}
    best, reason, warning = [""] * count, [""] * count, [""] * count
    with ThreadPoolExecutor(threads or os.cpu_count()) as pool:
        for k, (fit, told) in enumerate(show_progress(pool.map(one, pairs), count, " curves")):
            if fit is None:
                reason[k] = told
                continue
            warning[k], noise[k] = told, fit.noise
            for name, values in numbers.items():
                if (found := getattr(fit, name)) is not None:
                    values[:, k] = found
            for name, model in fit.models.items():
                p_values[name][k] = model.p_value
            best[k] = fit._best
    doubtful = [text for text in warning if text]
    if len(doubtful) >= 0.1 * count:
        warn(f"{len(doubtful)} of {count} curves: {doubtful[0]}", InputWarning)
    return CurveMap(
        **{name: Estimates(*(end.reshape(shape) for end in values)) for name, values in numbers.items()},
        noise=noise.reshape(shape),
        best=np.array(best).reshape(shape),
        p_values={name: values.reshape(shape) for name, values in p_values.items()},
        reason=np.array(reason).reshape(shape),
        warning=np.array(warning).reshape(shape),
        shape=shape,
        lengths=lengths,
        _is_si=keywords.is_si,
    )
