"""Figures, by matplotlib, which is only asked for when one is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _asperity

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The colour of nodes that have yielded, as in the pictures of the tool.
_YIELDED = "#d55e00"

_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}


def _pyplot() -> Any:
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("plots need matplotlib: pip install 'asperity[plot]'") from error
    return plt


def _scaled(values: Any, unit: str | None) -> tuple[float, str]:
    """The factor for an axis with these values, and its unit: SI units get prefixes."""
    if unit not in ("m", "Pa", "N", "J/m²", "N/m"):
        return 1.0, unit or ""
    finite = np.abs(np.asarray(values, dtype=float))
    largest = float(finite[np.isfinite(finite)].max(initial=0.0))
    power = 0 if largest == 0.0 else int(np.clip(3 * np.floor(np.log10(largest) / 3 + 1e-9), -12, 12))
    return 10.0**-power, _PREFIXES[power] + unit


def _is_wide(values: NDArray[Any]) -> bool:
    """Whether values are positive and span more than a decade, but for rounding, as for a logarithmic axis."""
    return bool(values.size and values.min() > 0 and values.max() > 9.99 * values.min())


def _is_geometric(values: NDArray[Any]) -> bool:
    """Whether the median is nearer to the geometric mean of the ends than to their arithmetic mean."""
    low, high = values.min(), values.max()
    return bool(np.median(values) ** 2 < np.sqrt(low * high) * 0.5 * (low + high))


def _label(name: str, unit: str) -> str:
    return f"{name} ({unit})" if unit else name


def _edges(nodes: int, length: float) -> tuple[float, float]:
    """The outer edges of the cells along an axis, about the node at the origin."""
    spacing = length / nodes
    return (-(nodes // 2 + 0.5) * spacing, (nodes - nodes // 2 - 0.5) * spacing)


def _map(ax: Axes, field: NDArray[Any], lengths: tuple[float, float], length_unit: str | None, **options: Any) -> Any:
    """A field, of numbers or of colours, with x to the right and y up."""
    factor, unit = _scaled(lengths, length_unit)
    options.setdefault("interpolation", "nearest")
    (left, right), (bottom, top) = (_edges(nodes, factor * length) for nodes, length in zip(field.shape, lengths))
    image = ax.imshow(np.swapaxes(field, 0, 1), origin="lower", extent=(left, right, bottom, top), **options)
    ax.set_xlabel(_label("x", unit))
    ax.set_ylabel(_label("y", unit))
    return image


def heights(field: NDArray[Any], lengths: tuple[float, float], length_unit: str | None, ax: Axes | None) -> Axes:
    """The heights of a map."""
    plt = _pyplot()
    if ax is None:
        _, ax = plt.subplots(figsize=(4.6, 3.8), layout="constrained")
    factor, unit = _scaled(field, length_unit)
    if field.ndim == 1:
        _profile(ax, factor * field, lengths[0], length_unit, color="0.2")
        ax.set_ylabel(_label("height", unit))
        return ax
    image = _map(ax, factor * field, lengths, length_unit, cmap="cividis")
    ax.figure.colorbar(image, ax=ax, label=_label("height", unit))
    return ax


def _profile(ax: Axes, values: NDArray[Any], length: float, length_unit: str | None, **options: Any) -> None:
    factor, unit = _scaled(length, length_unit)
    x = factor * (np.arange(values.size) - values.size // 2) * length / values.size
    ax.plot(x, values, **options)
    ax.set_xlabel(_label("x", unit))


def _from_white(name: str) -> Any:
    """The colours of a scale, from white on: pressures of nothing but rounding, of either sign, look alike."""
    from matplotlib.colors import LinearSegmentedColormap

    colours = _pyplot().get_cmap(name)(np.linspace(0.0, 1.0, 33))
    colours[0] = 1.0
    return LinearSegmentedColormap.from_list(f"{name} from white", colours)


def _yielded(ax: Axes, yielded: NDArray[np.bool_], lengths: tuple[float, float], length_unit: str | None) -> None:
    """The nodes that have yielded, over those in contact, with a legend."""
    from matplotlib.colors import ListedColormap
    from matplotlib.patches import Patch

    nodes = np.ma.masked_equal(yielded.astype(float), 0.0)
    _map(ax, nodes, lengths, length_unit, cmap=ListedColormap([_YIELDED]), vmin=0, vmax=1)
    legend = [Patch(color=_YIELDED, label="yielded")]
    ax.figure.legend(handles=legend, loc="outside lower left", fontsize="small", frameon=False)


def contact_and_pressure(
    contact: NDArray[np.bool_],
    pressure: NDArray[Any],
    lengths: tuple[float, float],
    adhesive: bool,
    title: str,
    clusters: NDArray[np.int64] | None,
    yielded: NDArray[np.bool_] | None,
    limits: tuple[float, float] | None,
    length_unit: str | None,
    pressure_unit: str | None,
) -> Figure:
    """Contact, or its clusters, and pressure of a solution, side by side."""
    plt = _pyplot()
    figure, (left, right) = plt.subplots(
        1, 2, figsize=(8.6 if adhesive else 7.8, 3.4), sharey=True, layout="compressed"
    )
    if clusters is None:
        _map(left, contact.astype(float), lengths, length_unit, cmap="Greys", vmin=0, vmax=1.15)
        if yielded is not None:
            _yielded(left, yielded, lengths, length_unit)
    else:
        _map(left, _asperity.cluster_colours(clusters), lengths, length_unit)
    left.set_title(title)
    # compression and tension differ by orders of magnitude: each has a scale of its own
    low, high = limits or (None, None)
    sides = [(pressure, "compression" if adhesive else "pressure", high, _from_white("YlOrRd"))]
    if adhesive and low != 0.0:
        sides.append((-pressure, "tension", None if low is None else -low, _from_white("Blues")))
    bars = []
    for side, name, end, colours in sides:
        end, greatest, beyond = _asperity.load_scale(side, end)
        factor, unit = _scaled(end, pressure_unit)
        positive = np.ma.masked_less_equal(factor * side, 0.0)
        image = _map(right, positive, lengths, length_unit, cmap=colours, vmin=0.0, vmax=factor * end or 1.0)
        label = _label(name, unit)
        if beyond > 0.0:
            load = "the load" if len(sides) == 1 else name
            above = f"{100 * beyond:.2g} % of {load}" if beyond > 1e-3 else f"less than 0.1 % of {load}"
            label += f"\n{above} above, up to {factor * greatest:.3g}"
        bars.append((image, label, "max" if beyond > 0.0 else "neither"))
    # the last bar is drawn next to the map
    for image, label, extend in reversed(bars):
        figure.colorbar(image, ax=right, label=label, pad=0.03, extend=extend)
    right.set_title("elastic pressure" if adhesive else "contact pressure")
    right.set_ylabel("")
    return figure  # type: ignore[no-any-return]


def profiles(
    sides: tuple[NDArray[Any], NDArray[Any]],
    pressure: NDArray[Any],
    length: float,
    length_unit: str | None,
    pressure_unit: str | None,
) -> Figure:
    """Surface and half-space of a solution on a line, and the pressure between them."""
    plt = _pyplot()
    figure, (upper, lower) = plt.subplots(2, 1, sharex=True, figsize=(5.2, 4.2), layout="constrained")
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
    return figure  # type: ignore[no-any-return]


def sweep(
    columns: dict[str, NDArray[Any]],
    name: str,
    theories: tuple[Any, ...],
    ax: Axes | None,
    length_unit: str | None,
    pressure_unit: str | None,
) -> Axes:
    """Contact fraction or mean gap over mean pressure, with theories that have it."""
    if ax is None:
        _, ax = _pyplot().subplots(figsize=(4.6, 3.4), layout="constrained")
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
    ax.set_xlabel(_label("mean pressure", unit))
    ax.set_ylabel(_label(name.replace("_", " "), up_unit))
    return ax


def over_time(columns: dict[str, NDArray[Any]], name: str, ax: Axes | None, unit: str | None) -> Axes:
    """A column over the time."""
    if ax is None:
        _, ax = _pyplot().subplots(figsize=(4.6, 3.4), layout="constrained")
    factor, unit = _scaled(columns[name], unit)
    ax.plot(columns["time"], factor * columns[name], "o-", markersize=3.5)
    ax.set_xlabel("time")
    ax.set_ylabel(_label(name.replace("_", " "), unit))
    return ax


def cycle(
    columns: dict[str, NDArray[Any]],
    ax: Axes | None,
    length_unit: str | None,
    pressure_unit: str | None,
    force_unit: str | None,
) -> Axes:
    """Mean pressure over mean gap, or normal force over approach, a line for each leg, with the jumps dashed."""
    free = bool(np.isfinite(columns["approach"]).any())
    if (length_unit, pressure_unit) == ("m", "Pa"):
        force_unit = force_unit or "N"
    x, y = ("approach", "normal_force") if free else ("mean_gap", "mean_pressure")
    if ax is None:
        _, ax = _pyplot().subplots(figsize=(4.6, 3.4), layout="constrained")
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
    ax.set_xlabel(_label(x.replace("_", " "), across_unit))
    ax.set_ylabel(_label(y.replace("_", " "), up_unit))
    ax.legend(frameon=False)
    return ax


def force_curve(
    z: NDArray[Any],
    force: NDArray[Any],
    fitted: NDArray[Any],
    turn: int,
    length_unit: str | None,
    force_unit: str | None,
) -> Figure:
    """A force curve with its fit over the position, and the residuals below; the withdrawal begins at the point `turn`."""
    plt = _pyplot()
    figure, (upper, lower) = plt.subplots(
        2, 1, sharex=True, figsize=(5.2, 4.6), height_ratios=[3, 1], layout="constrained"
    )
    across, length = _scaled(z, length_unit)
    up, unit = _scaled(force, force_unit)
    rest, small = _scaled(force - fitted, force_unit)
    for color, name, part in (("C0", "approach", slice(turn)), ("C3", "withdrawal", slice(turn, None))):
        if z[part].size:
            upper.plot(across * z[part], up * force[part], ".", color=color, alpha=0.4, markersize=3, label=name)
            upper.plot(across * z[part], up * fitted[part], color=color, linewidth=1, label=f"{name}, fit")
            lower.plot(across * z[part], rest * (force - fitted)[part], ".", color=color, alpha=0.4, markersize=3)
    lower.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
    upper.set_ylabel(_label("force", unit))
    lower.set_ylabel(_label("residual", small))
    lower.set_xlabel(_label("z", length))
    upper.legend(frameon=False)
    return figure  # type: ignore[no-any-return]
