"""Figures, by matplotlib, which is only asked for when one is drawn."""

from __future__ import annotations

from base64 import b64encode
from html import escape
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from .. import _asperity
from ..common.optional import package
from ..common.units import in_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: The factor of numbers into the unit of an axis, and that unit.
Unit: TypeAlias = tuple[float, str | None]

#: Pressures of one sign that are all weaker than this share of the other sign's greatest are not shown.
_NOISE = 1e-6

#: The classes of nodes, in the order of the colours of the palette.
CLASSES: tuple[str, ...] = ("apart", "contact", "attractive", "yielded")

_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}


def _axes(**options: Any) -> Any:
    """New axes, one or several."""
    return package("matplotlib.pyplot", "plots need matplotlib: pip install 'asperity[plot]'").subplots(**options)[1]


def axis_unit(name: str, own: str | None, wanted: str | None) -> Unit:
    """The unit of an axis: the one that is wanted, into which numbers of a known unit are converted, or their own."""
    if own is None or wanted in (None, own):
        return 1.0, wanted or own
    return in_unit(name, own) / in_unit(name, wanted), wanted


def _scaled(values: Any, shown: Unit) -> tuple[float, str]:
    """The factor for an axis with these values, and its unit: SI units get prefixes."""
    into, unit = shown
    if unit not in ("m", "Pa", "N", "J/m²", "N/m"):
        return into, unit or ""
    finite = np.abs(into * np.asarray(values, dtype=float))
    largest = float(finite[np.isfinite(finite)].max(initial=0.0))
    power = 0 if largest == 0.0 else int(np.clip(3 * np.floor(np.log10(largest) / 3 + 1e-9), -12, 12))
    return into * 10.0**-power, _PREFIXES[power] + unit


def _is_wide(values: NDArray[Any]) -> bool:
    """Whether values are positive and span more than a decade, but for rounding, as for a logarithmic axis."""
    return bool(values.size and values.min() > 0 and values.max() > 9.99 * values.min())


def _is_geometric(values: NDArray[Any]) -> bool:
    """Whether the median is nearer to the geometric mean of the ends than to their arithmetic mean."""
    low, high = values.min(), values.max()
    return bool(np.median(values) ** 2 < np.sqrt(low * high) * 0.5 * (low + high))


def _label(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def _map(ax: Axes, field: NDArray[Any], lengths: tuple[float, float], length_unit: Unit, **options: Any) -> Any:
    """A field with x to the right and y up, both from zero to the side length."""
    factor, unit = _scaled(lengths, length_unit)
    extent = (0.0, factor * lengths[0], 0.0, factor * lengths[1])
    image = ax.imshow(field.T, origin="lower", extent=extent, interpolation="nearest", **options)
    ax.set(xlabel=_label("x", unit), ylabel=_label("y", unit))
    return image


def _one(ax: Axes | None, height: float) -> Axes:
    """Axes that are given, or new ones."""
    return _axes(figsize=(4.6, height), layout="constrained") if ax is None else ax


def heights(field: NDArray[Any], lengths: tuple[float, float], length_unit: Unit, ax: Axes | None) -> Axes:
    """The heights of a map."""
    ax = _one(ax, 3.8)
    factor, unit = _scaled(field, length_unit)
    if field.ndim == 1:
        _profile(ax, factor * field, lengths[0], length_unit, color="0.2")
        ax.set_ylabel(_label("height", unit))
        return ax
    image = _map(ax, factor * field, lengths, length_unit, cmap=_colours(_palette("sequential")))
    _bar(ax, image, _label("height", unit))
    return ax


def _profile(ax: Axes, values: NDArray[Any], length: float, length_unit: Unit, **options: Any) -> None:
    factor, unit = _scaled(length, length_unit)
    x = factor * (np.arange(values.size) + 0.5) * length / values.size
    ax.plot(x, values, **options)
    ax.set_xlabel(_label("x", unit))


def _palette(name: str) -> NDArray[Any]:
    """The colours of the tool's pictures."""
    return _asperity.palette(name) / 255.0


def _colours(steps: NDArray[Any]) -> Any:
    from matplotlib.colors import ListedColormap

    return ListedColormap(steps)


def _bar(ax: Axes, image: Any, label: str, place: tuple[float, float] = (0.0, 1.0), extend: str = "neither") -> None:
    """A colour bar on the right of a map, from one share of its height to another, and further down than a low map for
    labels that are longer than the bars."""
    from matplotlib.transforms import Bbox, TransformedBbox

    figure: Any = ax.figure
    bar = ax.inset_axes((1.04, 0.0, 0.05, 1.0))

    def located(_: Any, renderer: Any) -> Any:
        longest = max(other.yaxis.label.get_window_extent(renderer).height for other in ax.child_axes)
        # a tenth beyond a bar does not reach the label of the other one
        stretch = max(1.0, 0.9 * longest / ((place[1] - place[0]) * ax.bbox.height))
        low, high = (1.0 - stretch * (1.0 - end) for end in place)
        # beside the last number of the axis below the map
        left = 1.04 if stretch == 1.0 else 1.09
        return TransformedBbox(Bbox.from_extents(left, low, left + 0.05, high), ax.transAxes - figure.transSubfigure)

    bar.set_axes_locator(located)
    figure.colorbar(image, cax=bar, label=label, extend=extend)


def classes(
    contact: NDArray[np.bool_], pressure: NDArray[Any], plastic_depth: NDArray[Any] | None, attractive: int
) -> NDArray[np.int64]:
    """The class of each node, by its place in `CLASSES`: the nodes of the greatest tensions attract, so many."""
    found = contact.astype(np.int64)
    tension = np.where(contact, -np.inf, -pressure)
    if attractive > 0:
        found[tension >= np.partition(tension.ravel(), -attractive)[-attractive]] = 2
    if plastic_depth is not None:
        found[plastic_depth > 0] = 3
    return found


def html(rows: list[tuple[str, str]], picture: str) -> str:
    """A table beside a picture, an SVG, for a notebook."""
    cells = "".join(
        f"<tr><td style='text-align:left'>{escape(name)}</td><td>{escape(value)}</td></tr>" for name, value in rows
    )
    source = f"data:image/svg+xml;base64,{b64encode(picture.encode()).decode()}"
    return (
        "<div style='display:flex;flex-wrap:wrap;gap:2em;align-items:center'>"
        f"<table>{cells}</table><img src='{source}' alt='contact map' style='max-width:100%'></div>"
    )


def contact(
    ax: Axes, classes: NDArray[np.int64], names: tuple[str, ...], lengths: tuple[float, float], length_unit: Unit
) -> None:
    """Classes of nodes with a legend of those that there are, or clusters of contact by their labels."""
    from matplotlib.patches import Patch
    from matplotlib.transforms import offset_copy

    steps = _palette("contact" if names else "clusters")
    # nine colours of clusters in turn
    shown = classes if names else np.where(classes > 0, 1 + (classes - 1) % (len(steps) - 1), 0)
    _map(ax, shown, lengths, length_unit, cmap=_colours(steps), vmin=-0.5, vmax=len(steps) - 0.5)
    found = [k for k, _ in enumerate(names) if (classes == k).any()]
    legend = [Patch(facecolor=steps[k], edgecolor="k", linewidth=0.5, label=names[k]) for k in found]
    if legend:
        # below the label of the axis
        figure: Any = ax.figure
        below = offset_copy(ax.transAxes, figure, y=-38.0, units="points")
        place: dict[str, Any] = {"loc": "upper left", "bbox_to_anchor": (0.0, 0.0), "bbox_transform": below}
        place |= {"borderaxespad": 0.0, "handlelength": 1.0, "columnspacing": 1.0}
        ax.legend(handles=legend, ncols=4, frameon=False, fontsize="small", **place)


def check_limits(limits: tuple[float, float] | None) -> None:
    """Refuses ends of the scales of both signs that are no such ends."""
    if limits is not None and not (limits[0] <= 0.0 < limits[1]):
        raise ValueError(f"colour_limits are {limits!r}: they must be (low, high), low zero or negative, and high positive")


def pressure(
    ax: Axes,
    field: NDArray[Any],
    lengths: tuple[float, float],
    adhesive: bool,
    limits: tuple[float, float] | None,
    length_unit: Unit,
    pressure_unit: Unit,
) -> None:
    """A pressure with a scale for each sign, as compression and tension differ by orders of magnitude."""
    steps = _palette("diverging")
    middle = len(steps) // 2
    low, high = limits or (None, None)
    # of each sign its name, the end that is given, and the colours
    signs = [(1.0, "compression" if adhesive else "pressure", high, steps[middle:])]
    if adhesive:
        signs.append((-1.0, "tension", None if low is None else -low, steps[:middle]))
    # without a sign that no node has but for rounding, unless its end is given
    noise = _NOISE * np.nanmax(np.abs(field), initial=0.0)
    signs = [each for each in signs if each[2] or each[2] is None and (each[0] * field > noise).any()] or signs[:1]
    places = [(0.53, 1.0), (0.0, 0.47)] if len(signs) == 2 else [(0.0, 1.0)]
    ax.set_facecolor(steps[middle])
    captions = []
    for (sign, name, given, colours), place in zip(signs, places):
        end, greatest, beyond = _asperity.load_scale(sign * field, given)
        factor, unit = _scaled(end, pressure_unit)
        ends = sorted([0.0, sign * (factor * end or 1.0)])
        there = np.ma.masked_less_equal(sign * field, 0.0)
        image = _map(ax, sign * factor * there, lengths, length_unit, cmap=_colours(colours), vmin=ends[0], vmax=ends[1])
        if beyond > 0.0:
            load = name if adhesive else "load"
            share = f"{100 * beyond:.2g} %" if beyond > 1e-3 else "less than 0.1 %"
            captions.append(f"{share} of the {load} beyond, to {sign * factor * greatest:.3g} {unit}".rstrip())
        _bar(ax, image, _label(name, unit), place, "neither" if beyond == 0.0 else "max" if sign > 0.0 else "min")
    ax.set_title("elastic pressure" if adhesive else "contact pressure", pad=6.0 + 11.0 * len(captions))
    for line, caption in enumerate(reversed(captions)):
        above: dict[str, Any] = {"xytext": (0.0, 4.0 + 11.0 * line), "textcoords": "offset points", "ha": "center"}
        ax.annotate(caption, (0.5, 1.0), xycoords="axes fraction", fontsize="small", **above)


def two(ax: Any, **options: Any) -> Any:
    """Two axes: those that are given, or new ones."""
    if ax is None:
        return _axes(**options)
    if np.size(ax) != 2:
        raise ValueError(f"ax has {np.size(ax)} axes: it must be two of matplotlib, as from subplots(1, 2)")
    return np.asarray(ax).ravel()


def profiles(
    sides: tuple[NDArray[Any], NDArray[Any]],
    pressure: NDArray[Any],
    length: float,
    length_unit: Unit,
    pressure_unit: Unit,
    ax: Any,
) -> Any:
    """Surface and half-space of a solution on a line, and the pressure between them."""
    ax = upper, lower = two(ax, nrows=2, sharex=True, figsize=(5.2, 4.2), layout="constrained")
    factor, unit = _scaled(sides[0], length_unit)
    for side, color, name in zip(sides, ("0.2", "C0"), ("surface", "half-space")):
        _profile(upper, factor * side, length, length_unit, color=color, label=name)
    upper.set_ylabel(_label("height", unit))
    upper.legend(frameon=False)
    factor, unit = _scaled(pressure, pressure_unit)
    _profile(lower, factor * pressure, length, length_unit, color="C3")
    lower.axhline(0.0, color="0.7", linewidth=0.8)
    lower.set_ylabel(_label("pressure", unit))
    upper.set_xlabel("")
    return ax


def sweep(
    columns: dict[str, NDArray[Any]],
    name: str,
    theories: tuple[Any, ...],
    ax: Axes | None,
    length_unit: Unit,
    pressure_unit: Unit,
) -> Axes:
    """Contact fraction or mean gap over mean pressure, with theories that have it."""
    ax = _one(ax, 3.4)
    pressure, found = columns["mean_pressure"], columns[name]
    across, unit = _scaled(pressure, pressure_unit)
    up, up_unit = (1.0, "") if name == "contact_fraction" else _scaled(found, length_unit)
    shown = [("solves", "o" if theories else "o-", "C0", found)]
    if theories and name == "contact_fraction":
        corrected = columns["corrected_contact_fraction"]
        shown = [("corrected area", "o", "C0", corrected), ("nodes in contact", "x", "0.6", found)]
    for label, marks, color, values in shown:
        ax.plot(across * pressure, up * values, marks, color=color, markersize=3.5, label=label)
    is_log = _is_wide(pressure) and _is_geometric(pressure)
    between = (np.geomspace if is_log else np.linspace)(max(pressure.min(), 1e-3 * pressure.max()), pressure.max(), 200)
    for theory, line in zip(theories, ("k-", "k--")):
        if hasattr(theory, name):
            ax.plot(across * between, up * getattr(theory, name)(between), line, linewidth=1, label=theory.title)
    if is_log:
        ax.set_xscale("log")
        if _is_wide(found):
            ax.set_yscale("log")
    if theories:
        ax.legend(frameon=False, fontsize="small")
    ax.set(xlabel=_label("mean pressure", unit), ylabel=_label(name.replace("_", " "), up_unit))
    return ax


def over_time(columns: dict[str, NDArray[Any]], name: str, ax: Axes | None, unit: Unit) -> Axes:
    """A column over the time."""
    ax = _one(ax, 3.4)
    factor, word = _scaled(columns[name], unit)
    ax.plot(columns["time"], factor * columns[name], "o-", markersize=3.5)
    ax.set(xlabel="time", ylabel=_label(name.replace("_", " "), word))
    return ax


def cycle(
    columns: dict[str, NDArray[Any]],
    ax: Axes | None,
    length_unit: Unit,
    pressure_unit: Unit,
    force_unit: Unit,
) -> Axes:
    """Mean pressure over mean gap, or normal force over approach, a line for each leg, with the jumps dashed."""
    free = bool(np.isfinite(columns["approach"]).any())
    x, y = ("approach", "normal_force") if free else ("mean_gap", "mean_pressure")
    ax = _one(ax, 3.4)
    across_factor, across_unit = _scaled(columns[x], length_unit)
    up_factor, up_unit = _scaled(columns[y], force_unit if free else pressure_unit)
    across, up = across_factor * columns[x], up_factor * columns[y]
    legs = columns["leg"]
    jumps = columns["energy_drop"] > 0
    count = int(legs.max(initial=0))
    for leg in range(1, count + 1):
        on = np.flatnonzero(legs == leg)
        if on.size == 0:
            continue
        name = str(columns["direction"][on[0]]) + (f" {(leg + 1) // 2}" if count > 2 else "")
        on = np.concatenate([[on[0] - 1], on]) if on[0] > 0 else on
        # a line ends where the state jumps, and begins anew behind
        pieces = np.split(on, [k for k in range(1, on.size) if jumps[on[k]]])
        for k, piece in enumerate(pieces):
            label = name if k == 0 else None
            ax.plot(across[piece], up[piece], color=f"C{leg - 1}", label=label)
        for k in on[1:][jumps[on[1:]]]:
            ax.plot(across[k - 1 : k + 1], up[k - 1 : k + 1], "--", color="k", linewidth=0.5)
    ax.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
    ax.set(xlabel=_label(x.replace("_", " "), across_unit), ylabel=_label(y.replace("_", " "), up_unit))
    ax.legend(frameon=False)
    return ax
