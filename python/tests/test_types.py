"""The types of keywords and reports say what the compiled core takes and gives."""

import json
import pickle
from types import NoneType, UnionType
from typing import Literal, Union, get_args, get_origin, get_type_hints, is_typeddict

import numpy as np
import pytest

import asperity
from asperity.common import types


def check(kind, value, where):
    """Holds a value against a type: all keys of a dictionary in their order, and what they hold."""
    if is_typeddict(kind):
        hints = get_type_hints(kind)
        assert list(value) == list(hints), where
        for key, inner in hints.items():
            check(inner, value[key], f"{where}.{key}")
    elif get_origin(kind) in (Union, UnionType):
        kinds = [inner for inner in get_args(kind) if inner is not NoneType]
        if value is not None:
            assert any(holds(inner, value, where) for inner in kinds), (where, value)
        else:
            assert NoneType in get_args(kind), where
    elif get_origin(kind) is Literal:
        assert value in get_args(kind), (where, value)
    elif get_origin(kind) is list:
        assert type(value) is list, where
        for item in value:
            check(get_args(kind)[0], item, where)
    elif get_origin(kind) is dict:
        assert type(value) is dict, where
    else:
        assert type(value) is kind, (where, value)


def holds(kind, value, where):
    try:
        check(kind, value, where)
    except AssertionError:
        # the keys of a dictionary tell more than that it is none of several types
        if is_typeddict(kind):
            raise
        return False
    return True


def test_the_type_of_a_report_has_the_keys_and_values_of_the_account(rough, sphere, law):
    works = 1e-5 * np.where(np.arange(rough.shape[1]) < 16, 1.0, 2.0) * np.ones(rough.shape)
    reports = [
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law, branch="both", stability=True, stiffness=True),
        asperity.solve(rough, modulus=1.0, mean_gap=0.01, law=asperity.Varying(law, works), leave=True),
        asperity.solve(rough, modulus=1.0, mean_pressure=5e-3, accuracy=0.05),
        asperity.solve(rough, modulus=1.0, contact_fraction=0.1),
        asperity.solve(sphere, 1.0, modulus=1.0, spring=(0.1, 0.05), boundary="free"),
        asperity.solve(asperity.prepare(rough, mirror=True), modulus=1.0, mean_pressure=0.01),
        asperity.solve(rough, modulus="1GPa", mean_pressure="10MPa"),
    ]
    for k, solution in enumerate(reports):
        check(asperity.Report, solution.report, f"report {k}")
    # each entry with keys of its own was there
    for key in ("other_branch", "levels", "grid_error", "accuracy", "search", "patches", "stability", "given"):
        assert any(solution.report[key] for solution in reports), key


@pytest.mark.filterwarnings("ignore")
def test_reports_and_rows_are_what_json_reads_of_them(rough):
    yielded = {"modulus": 1.0, "hardness": 0.02}
    flat = asperity.solve(np.zeros((8, 8)), 1.0, modulus=1.0, mean_pressure=0.01, stiffness=True, stability=True)
    cut = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, max_iterations=1, method="rey2017")
    soft = asperity.solve(rough, mean_pressure=0.01, **yielded)
    sweep = asperity.sweep(rough, mean_pressures=[0.01], **yielded)
    assert flat.report["contact_stiffness"] is flat.report["stability"]["eigenvalue"] is None
    assert np.isinf(flat.contact_stiffness) and np.isnan(soft.statistics.corrected_contact_fraction)
    assert np.isnan(sweep.columns["corrected_contact_fraction"][0])
    assert (cut.report["relative_error"] is None) == np.isinf(cut.relative_error)
    found = [solution.report for solution in (flat, cut, soft)]
    for report in [*found, sweep.rows, asperity.leakage(soft).report, asperity.contact.tables(soft).figures]:
        assert json.loads(json.dumps(report, allow_nan=False)) == report
        assert pickle.loads(pickle.dumps(report)) == report
    for report in found:
        check(asperity.Report, report, "report")


@pytest.mark.parametrize(
    ("keyword", "kind"),
    [
        ("boundary", types.Boundary),
        ("wall", types.WallName),
        ("method", types.Method),
        ("precision", types.Precision),
        ("branch", types.Branches),
        ("accuracy_of", types.AccuracyOf),
    ],
)
def test_names_are_those_of_the_core(rough, keyword, kind):
    accuracy = {"accuracy": 0.1} if keyword == "accuracy_of" else {}
    with pytest.raises(ValueError, match=f"{keyword} is nothing: it must be") as refused:
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, **{keyword: "nothing"}, **accuracy)
    expected = str(refused.value).split("it must be ")[1]
    assert set(expected.replace(" or ", ", ").split(", ")) == set(get_args(kind))


@pytest.mark.parametrize(
    ("keyword", "kind"),
    [
        ("align_rows", types.RowAlignment),
        ("scan_axis", types.ScanAxis),
        ("remove_form", types.RemovedForm),
        ("detrend", types.Trend),
    ],
)
def test_names_of_preparation_are_those_of_the_core(rough, keyword, kind):
    with pytest.raises(ValueError, match=f"{keyword} is nothing: it must be") as refused:
        asperity.prepare(rough, **{keyword: "nothing"})
    assert all(name in str(refused.value) for name in get_args(kind))
    for name in get_args(kind):
        assert len(asperity.prepare(rough, **{keyword: name}).log) == (1 if keyword == "scan_axis" else 2)
