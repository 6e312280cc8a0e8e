"""What version 0.1 promises: names, keywords and attributes of the package, as in `tool/tests/promised.toml`."""

import inspect
import operator
import pathlib
import pickle

import pytest

import asperity

tomllib = pytest.importorskip("tomllib", reason="the standard library has it from Python 3.11 on")

FILE = pathlib.Path(__file__).resolve().parents[2] / "tool" / "tests" / "promised.toml"
PROMISED = tomllib.loads(FILE.read_text())["python"]


def test_names_stay():
    for name in PROMISED["names"].split():
        operator.attrgetter(name)(asperity)


@pytest.mark.parametrize("name", PROMISED["keywords"])
def test_keywords_stay(name):
    known = inspect.signature(operator.attrgetter(name)(asperity)).parameters
    assert set(PROMISED["keywords"][name].split()) <= set(known)


@pytest.mark.parametrize("name", PROMISED["attributes"])
def test_attributes_stay(name):
    kind = getattr(asperity, name)
    known = {*dir(kind), *inspect.get_annotations(kind)}
    assert set(PROMISED["attributes"][name].split()) <= known


@pytest.mark.parametrize(
    ("place", "name"),
    [
        ("_accuracy", "Plan"),
        ("_body", "Coating"),
        ("_cycle", "Cycle"),
        ("_flow", "Leakage"),
        ("_interface", "Interface"),
        ("_pull_off", "PullOff"),
        ("_solution", "Solution"),
        ("_stability", "Stability"),
        ("_sweep", "Sweep"),
        ("_topography", "Topography"),
        ("_viscoelastic", "Moment"),
        ("_wall", "Penalty"),
        ("curves.maps", "CurveMap"),
        ("curves.read", "ForceCurve"),
    ],
)
def test_pickles_of_earlier_versions_find_their_classes(place, name):
    assert pickle.loads(f"casperity.{place}\n{name}\n.".encode()) is getattr(asperity, name)
