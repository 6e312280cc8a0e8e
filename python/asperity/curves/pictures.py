"""Figures of force curves and of maps of them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..plot import figures
from .tips import Array


def force_curve(
    z: NDArray[Any],
    force: NDArray[Any],
    fitted: NDArray[Any],
    turn: int,
    length_unit: figures.Unit,
    force_unit: figures.Unit,
    ax: Any,
) -> Any:
    """A force curve with its fit over the position, and the residuals below; the withdrawal begins at the point `turn`."""
    ax = upper, lower = figures.two(ax, nrows=2, sharex=True, figsize=(5.2, 4.6), height_ratios=[3, 1], layout="constrained")
    across, length = figures._scaled(z, length_unit)
    up, unit = figures._scaled(force, force_unit)
    rest, small = figures._scaled(force - fitted, force_unit)
    for color, name, part in (("C0", "approach", slice(turn)), ("C3", "withdrawal", slice(turn, None))):
        if z[part].size:
            upper.plot(across * z[part], up * force[part], ".", color=color, alpha=0.4, markersize=3, label=name)
            upper.plot(across * z[part], up * fitted[part], color=color, linewidth=1, label=f"{name}, fit")
            lower.plot(across * z[part], rest * (force - fitted)[part], ".", color=color, alpha=0.4, markersize=3)
    lower.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
    upper.set_ylabel(figures._label("force", unit))
    lower.set(xlabel=figures._label("z", length), ylabel=figures._label("residual", small))
    upper.legend(frameon=False)
    return ax


def number_map(values: Array, lengths: tuple[float, float], label: str, units: tuple[figures.Unit, figures.Unit], ax: Any) -> Any:
    """A number of the curves of a map, without colour where a curve has none."""
    ax = figures._one(ax, 3.8)
    factor, unit = figures._scaled(values, units[1])
    finite = np.isfinite(values)
    shown = np.ma.masked_where(~finite, factor * values)
    low, high = np.quantile(factor * values[finite], [0.02, 0.98]) if finite.any() else (0.0, 1.0)
    outside = [bool((shown < low).any()), bool((shown > high).any())]
    extend = {(True, True): "both", (True, False): "min", (False, True): "max"}.get((outside[0], outside[1]), "neither")
    limits = {"vmin": low, "vmax": high if high > low else low + (abs(low) or 1.0)}
    ax.set_facecolor("0.85")
    image = figures._map(ax, shown, lengths, units[0], cmap=figures._colours(figures._palette("sequential")), **limits)
    figures._bar(ax, image, figures._label(label, unit), extend=extend)
    return ax
