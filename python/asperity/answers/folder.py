"""The folder of a solve: a solution on the disk, and the page of its results."""

from __future__ import annotations

import json
import os
import tempfile
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _asperity
from ..bodies.body import Coating, Layer
from ..common.types import OwnLaw
from ..maps.arrays import mirror_field
from ..maps.heights import Heights, convert_heights
from ..maps.topography import Topography
from .findings import ContactStatistics
from .numbers import Report
from .solution import FIELDS, OTHERS, Solution

#: The numbers without which a report is none of a solve.
NEEDED = (
    "contact_nodes", "absent_nodes", "shape", "lengths", "mean_gap", "mean_pressure", "elastic_energy",
    "repulsive_fraction", "attractive_fraction", "boundary", "law", "wall",
)


def load(folder: str | os.PathLike[str], heights: Heights | None = None, law: OwnLaw | None = None) -> Solution:
    """Reads a solution of the folder in which `Solution.save` or ``asperity solve --out`` has left it.

    The report has its numbers, in which infinite ones are None, and also those that an earlier version did not find. Of a mirrored map the whole gap is the gap of the
    original with its mirror images.

    Parameters
    ----------
    folder : str or path
        Folder with ``report.json``, and the fields as ``.npy`` or in ``fields.npz``.
    heights : array_like, Topography, SurfaceTopography, DataArray, DataFrame or path of a file, optional
        Heights that were solved, of the shape of the fields; those with a unit are converted to metres if the solve was
        in metres. `Solution.save` keeps them; a folder of the program has none, and without them the solution has no
        ``heights``, ``topography`` and ``displacement``.
    law : object, optional
        Adhesion law that was solved, for `stability`. A folder has the numbers of a law, but no works of adhesion of
        `Varying`, no values of `Tabulated`, and no law of your own.

    Returns
    -------
    Solution
        As it was, but for symbols, and for the object of an adhesion law: its name stands there unless the law is
        given.

    Raises
    ------
    ValueError, FileNotFoundError
        If the folder is not from a solve, or its fields and heights do not fit each other.

    Examples
    --------
    >>> import asperity, tempfile
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     asperity.solve(rough, modulus=1.0, mean_pressure=0.01).save(folder)
    ...     again = asperity.load(folder)
    >>> again.status, again.gap.shape
    ('converged', (64, 64))
    """
    told = _report(folder)
    shape = tuple(told["shape"])
    fields: dict[str, Any] = {name: _field(folder, name, shape) for name in (*FIELDS, *OTHERS)}
    for name in FIELDS:
        if fields[name] is None:
            raise ValueError(f"{os.fspath(folder)} has no {name}.npy: solve with --format npy or npz")
    _check_fields(os.fspath(folder), fields, told)
    # absent nodes have no gap
    fields["gap"] = np.where(np.isnan(fields["gap"]), np.inf, fields["gap"])
    if heights is not None:
        fields["heights"] = convert_heights(heights, is_si=told["length_unit"] == "m").heights
        if fields["heights"].shape != shape:
            raise ValueError(f"heights have shape {fields['heights'].shape}: those that were solved have {shape}")
    if fields["heights"] is not None:
        _check_heights(fields, told)
    is_whole = told["solved_shape"] is None
    whole = shape if is_whole else tuple(told["solved_shape"])
    lengths: Any = tuple(told["lengths"])
    if not is_whole:
        lengths = tuple(length / m * n for length, n, m in zip(lengths, whole, shape, strict=True))
    is_line = shape[1] == 1
    of: Any = whole[:1] if is_line else whole
    if fields["heights"] is not None:
        map_of = mirror_field(np.asarray(fields["heights"], np.float64), whole)
        source, unit, nodes = told["heights"], told["length_unit"], None if is_whole else shape
        of = Topography(map_of, lengths, unit, source=source, original=nodes, _is_line=is_line)
    if law is None and told["law"] != "none":
        law = told["law"]
    fields = {name: None if field is None else mirror_field(field, whole) for name, field in fields.items()}
    solution = Solution(of, (_body(told), law), told, {**fields, "look": None, "tell": None, "displacements": None})
    sizes, _ = _asperity.clusters(solution.contact.reshape(shape), solution.flow_boundary == "periodic")
    apart = 1.0 - told["repulsive_fraction"] - told["attractive_fraction"]
    counted = {**told, "cluster_sizes": sizes, "apart_fraction": apart}
    found: list[Any] = [np.nan if counted[name] is None else counted[name] for name in ContactStatistics._fields]
    statistics = ContactStatistics(*found)
    rows = _asperity.figures_of(json.dumps(told))
    both: list[Any] = [fields[name] for name in ("displacement", "against_displacement")]
    parts = None if both[1] is None else tuple(map(solution.part_of, both))
    solution.__dict__.update(_looked=(statistics, told), _rows=rows, _displacements=parts)
    return solution


def report(
    results: Solution | str | os.PathLike[str],
    out: str | os.PathLike[str] = "report.html",
    *,
    force: bool = False,
) -> None:
    """Puts results on one page for a browser, as ``asperity report``: figures, warnings, maps, and how to cite.

    The page is one file, which loads nothing from elsewhere.

    Parameters
    ----------
    results : Solution, str or path
        Solution, or the folder of a solve, or the table of a sweep, a cycle or a study.
    out : str or path
        File for the page.
    force : bool
        Replaces a page that is there.

    Raises
    ------
    ValueError
        If there is such a file, or the results are none.

    Examples
    --------
    >>> import asperity, os, tempfile
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     asperity.report(solution, os.path.join(folder, "pressed.html"))
    ...     os.listdir(folder)
    ['pressed.html']
    """
    if isinstance(results, Solution):
        with tempfile.TemporaryDirectory() as above:
            # the name of the folder is the title of the page
            folder = os.path.join(above, os.path.splitext(os.path.basename(out))[0])
            results.save(folder)
            _asperity.page(folder, os.path.abspath(out), force)
    else:
        _asperity.page(os.fspath(results), os.path.abspath(out), force)


def _report(folder: str | os.PathLike[str]) -> Any:
    """The report of a folder, in which numbers that an earlier version did not find are None."""
    path = os.path.join(folder, "report.json")
    if not os.path.exists(path):
        raise FileNotFoundError(f"{os.fspath(folder)} has no report.json: name the folder of a solve")
    try:
        with open(path, encoding="utf-8") as file:
            told = {**dict.fromkeys(Report.__annotations__), **json.load(file)}
    except (ValueError, TypeError):
        raise ValueError(f"{path} is no report of a solve: name the folder of one") from None
    lacking = [name for name in NEEDED if told[name] is None]
    if lacking:
        raise ValueError(f"{path} is no report of a solve, without {lacking[0]}: name the folder of one, or solve anew")
    return told


def _field(folder: str | os.PathLike[str], name: str, shape: tuple[int, ...]) -> NDArray[Any] | None:
    """A field of a folder, as a file of its own or in the archive, if it is there."""
    path, archive = (os.path.join(folder, file) for file in (f"{name}.npy", "fields.npz"))
    field = np.load(path) if os.path.exists(path) else None
    if field is None and os.path.exists(archive):
        with np.load(archive) as fields:
            field = fields[name] if name in fields else None
    if field is not None and field.shape != shape:
        raise ValueError(f"{name} in {os.fspath(folder)} has shape {field.shape}, the report says {shape}")
    return field


def _check_fields(folder: str, fields: dict[str, Any], told: Any) -> None:
    """Refuses fields that do not belong to the report, by what is missing in them and by their means."""
    missing = np.count_nonzero(np.isnan(fields["gap"]))
    if missing != told["absent_nodes"]:
        raise ValueError(f"gap in {folder} has {missing} missing values, the report says {told['absent_nodes']}")
    for name in ("gap", "pressure"):
        field = np.asarray(fields[name], np.float64)
        mean, expected = np.nanmean(field), told[f"mean_{name}"]
        # sums of single precision, and those that cancel
        if not abs(mean - expected) <= 1e-5 * np.nanmean(abs(field)):
            raise ValueError(f"{name} in {folder} has the mean {mean:.6g}, the report says {expected:.6g}: it is of another solve")


def _check_heights(fields: dict[str, Any], told: Any) -> None:
    """Refuses heights that do not belong to the fields: with the pressures they give another elastic energy."""
    depth, present = fields["plastic_depth"], np.isfinite(fields["gap"])
    # the displacements of absent nodes of a periodic map are not known
    if told["hardness"] is not None and depth is None or told["approach"] is None and not present.all():
        return
    gap, pressure, heights = (np.asarray(fields[name][present], np.float64) for name in ("gap", "pressure", "heights"))
    displacement = gap + heights - (0.0 if depth is None else depth[present])
    if told["approach"] is None:
        pressure -= pressure.mean()
    else:
        displacement += told["approach"] - heights.max()
    energy = present.mean() * np.mean(pressure * displacement) / 2
    scale = present.mean() * np.mean(abs(pressure) * (gap + abs(heights)))
    # where pressures of absent nodes are left out, the energy is that of the fields up to the error of the solve
    error = 0.0 if told["approach"] is None and present.all() else 100.0 * (told["relative_error"] or np.inf)
    if not abs(energy - told["elastic_energy"]) <= (1e-6 + error) * scale:
        raise ValueError(
            f"heights give an elastic energy of {energy:.6g} per area, and the report says {told['elastic_energy']:.6g}: "
            f"give the map that was solved, its axes as they were, in {told['length_unit'] or 'the unit of the solve'}"
        )


def _body(told: Any) -> Layer | Coating | None:
    """The body of a report, if it is one of these."""
    if told["layer"] is not None:
        return Layer(told["layer"], told["poisson"], told["base"])
    if told["coating"] is not None:
        return Coating(**{name: told[key] for name, key in Coating._keys.items()})
    return None
