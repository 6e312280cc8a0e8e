"""The preparation of a measured map."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from .. import _asperity
from ..common.types import AxisOrder, Lengths, Quantity, RemovedForm, RowAlignment, ScanAxis, Trend
from ..common.units import in_si, number, plain
from ..common.warnings import warn_input
from ..common.words import suggests
from .arrays import side_lengths
from .files import read
from .heights import Heights, read_heights
from .topography import Topography

#: The threshold of scars, that of Gwyddion.
_SCARS = 0.667
_SPIKES = 10.0


@suggests
def prepare(
    heights: Heights,
    lengths: Lengths | None = None,
    *,
    axes: AxisOrder | None = None,
    masked: bool = False,
    unit: str | None = None,
    missing: float | list[float] | None = None,
    scale: float | None = None,
    crop: tuple[int, int, int, int] | None = None,
    flip: bool = False,
    clean: bool = False,
    without: str | Sequence[str] = (),
    align_rows: RowAlignment | int | None = None,
    scan_axis: ScanAxis = "x",
    remove_scars: bool | float = False,
    despike: bool | float = False,
    remove_form: RemovedForm | None = None,
    detrend: Trend | int | None = None,
    fill: bool = False,
    window: float | None = None,
    mirror: bool = False,
    cut_off_wavelength: Quantity | None = None,
    resample: tuple[int, int] | None = None,
) -> Topography:
    """Makes a periodic surface of a measured map, in the order of the parameters; nothing is done unasked.

    Parameters
    ----------
    heights : array_like, Topography, SurfaceTopography, DataArray, DataFrame or path of a file
        Heights; NaN, infinite and masked points are missing. A DataFrame with numbers as index and columns has them
        as coordinates, y along its index and x along its columns, unless their names x and y or ``axes`` say otherwise.
        Integers that count, as pandas sets them, and words are no coordinates: it is an array then. Coordinates along
        one of the two alone are refused.
    lengths : float or (float, float), optional
        Side lengths (Lx, Ly); one alone means square cells. By default the side lengths of the map.
    axes : {"xy", "yx"}, optional
        Axes of an array: "xy" by default, the first is x, or "yx" for an image, [row, column]. A DataArray with
        dimensions named x and y, or a DataFrame with coordinates, does not need it. The result has x along the first
        axis.
    masked : bool
        Whether the points under the mask of a ``.gwy`` file are missing.
    unit : str, optional
        Unit of the heights after ``scale``, and of the side lengths.
    missing : float or list of float, optional
        Values that stand for missing points, for example -9999, in the unit of the heights before ``scale``.
    scale : float, optional
        Factor of the heights, for example 1e-9 for heights in nm and side lengths in m.
    crop : (int, int, int, int), optional
        First node along x and y, and numbers of nodes.
    flip : bool
        Peaks become valleys.
    clean : bool
        Cleans the map of an AFM: ``align_rows="median"``, ``remove_scars``, ``despike``, ``detrend="plane"`` and
        ``fill``, but for those that are given otherwise.
    without : {"rows", "scars", "spikes", "plane", "holes"} or list of str
        Parts of ``clean`` to leave out.
    align_rows : {"median", "median-difference"} or int, optional
        Brings the scan lines of an AFM to one height: by the median of each line, by the median of the differences from
        line to line, for large features, or by a polynomial of this order, subtracted from each line.
    scan_axis : {"x", "y"}
        Direction of the scan lines. If lines along the other direction have by far the larger offsets, an
        `InputWarning` says so. The rows of an image are along x if ``axes`` is "yx", and along y if it is not.
    remove_scars : bool or float
        Replaces scars by the heights around them. Scars are pieces of one to four scan lines, at least 16 nodes long,
        that are everywhere higher, or everywhere lower, than both neighbouring lines, by more than this many rms
        differences of neighbouring lines. True is 0.667, at which rough surfaces have none.
    despike : bool or float
        Threshold, in robust standard deviations of all nodes: a node that is farther than this from the median of the
        5 x 5 nodes around it is a spike, and gets that median. True is 10, which leaves the features of most surfaces.
    remove_form : {"sphere", "cylinder"}, optional
        Form that is fitted and removed.
    detrend : {"mean", "plane", "quadric"} or int, optional
        Trend that is fitted and removed; a number is the order of a polynomial.
    fill : bool
        Missing points get values, smoothly from those around them.
    window : float, optional
        Share of the sides that is tapered at each edge, at most 0.5.
    mirror : bool
        Continues the map by its mirror images: twice as many nodes along both axes. The map remembers its ``original``,
        and a solution has results of that part alone, unless it is asked for the ``whole``.
    cut_off_wavelength : float or str, optional
        Removes the waves shorter than this, for example those that are noise: `surface.knee_wavelength` finds where
        noise begins. The map should be periodic by then.
    resample : (int, int), optional
        Numbers of nodes of the grid on which it is interpolated.

    Returns
    -------
    Topography
        With a line in its ``log`` for each step, like those that the program prints. Probable mistakes, such as a code
        for missing points that was left among the heights, give an `InputWarning`.

    Examples
    --------
    >>> import numpy as np, asperity
    >>> measured = 1e-9 * np.random.default_rng(0).normal(size=(32, 24)) + 1e-8 * np.arange(32)[:, None]
    >>> measured[3, 5] = np.nan
    >>> made = asperity.prepare(measured, 1e-6, unit="m", detrend="plane", fill=True, mirror=True)
    >>> made
    Topography(64 x 48 heights, mirror images of 32 x 24, 2 µm x 1.5 µm)
    >>> [line.split(":")[0] for line in made.log]
    ['read', 'lengths', 'unit', 'detrend', 'fill', 'mirror']
    """
    if masked and not isinstance(heights, str | os.PathLike):
        raise TypeError("masked is of the mask of a .gwy file: give its path, or an array of NaN where points are missing")
    given = read(heights, masked=True) if masked else read_heights(heights, axes)  # type: ignore[arg-type]
    keys = {
        "missing": None if missing is None else np.ravel(missing),
        "scale": scale,
        "unit": unit,
        "crop": crop,
        "flip": flip,
        "clean": clean,
        "without": [without] if isinstance(without, str) else list(without) or None,
        "align_rows": align_rows if align_rows is None or isinstance(align_rows, str) else f"polynomial:{align_rows}",
        "scan_axis": scan_axis,
        "remove_scars": _SCARS if remove_scars is True else remove_scars or None,
        "despike": _SPIKES if despike is True else despike or None,
        "remove_form": remove_form,
        "detrend": detrend if detrend is None else str(detrend),
        "fill": fill,
        "window": window,
        "mirror": mirror,
        "resample": resample,
    }
    lengths, cut_off_wavelength, is_si = in_si(lengths=lengths, cut_off_wavelength=cut_off_wavelength)
    both = None if lengths is None else side_lengths(lengths, given.heights.shape)
    cut_off = None if cut_off_wavelength is None else number("cut_off_wavelength", cut_off_wavelength)
    made, log, warnings = _asperity.prepare(given, both, cut_off, is_si, plain(keys))
    for warning in warnings:
        warn_input(warning)
    is_line = given._is_line and made["heights"].shape[1] == 1
    return replace(given, **made, log=(*given.log, *log), _unread=(), _is_line=is_line)
