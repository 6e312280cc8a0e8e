"""The free half-space next to the periodic cell: its loads, and nodes at which nothing faces it."""

import numpy as np
import pytest

import asperity

RADIUS, SIDE, FORCE = 2.0, 0.4, 1e-3


@pytest.fixture(scope="module")
def tip():
    """A paraboloid on 64 by 64 nodes, larger than its contact with a free half-space."""
    x = SIDE * (np.arange(64) / 64 - 0.5)
    return asperity.prepare(-(x[:, None] ** 2 + x**2) / (2 * RADIUS), SIDE)


def pressed(heights, **given):
    return asperity.solve(heights, **{"modulus": 1.0, "boundary": "free", **given})


def test_missing_points_may_be_absent_nodes():
    x = np.arange(48) / 48 - 0.5
    approach, outside = 0.01, np.hypot(x[:, None], x) >= 0.45
    flat = np.ma.masked_array(np.zeros((48, 48)), outside)
    found = pressed(flat, lengths=1.0, approach=approach, absent_missing=True)
    assert found.absent_nodes == outside.sum() and found.contact_fraction == 1.0
    assert np.isinf(found.gap[outside]).all() and not found.pressure[outside].any() and found.contact[~outside].all()
    again = pressed(np.where(outside, np.nan, 0.0), lengths=1.0, approach=approach, absent_missing=True, start=found)
    assert np.isclose(again.normal_force, found.normal_force, rtol=1e-4)
    statistics = found.statistics
    assert statistics.contact_fraction == 1.0 and statistics.contact_nodes == found.report["contact_nodes"]
    assert statistics.perimeter == found.report["perimeter"]


def test_the_loop_of_a_tip_is_drawn_with_its_jumps():
    x = 0.24 * (np.arange(24) / 24 - 0.5)
    tip = -(x[:, None] ** 2 + x**2) / (2 * RADIUS)
    given = {"law": asperity.Exponential(2e-5, 2e-3), "springs": [(0.01, rest) for rest in (-0.02, 0.0, -0.03)]}
    # before the jump-in what little attraction there is spans the window
    with pytest.warns(asperity.InputWarning, match="window-edge"):
        cycle = asperity.cycle(tip, 0.24, modulus=1.0, boundary="free", steps=10, smallest_step=1e-3, tolerance=1e-7, **given).run()
    assert [event["event"] for event in cycle.events if event["energy_drop"]] == ["jump-in", "pull-off"]
    axes = cycle.plot(force_unit="N")
    assert [line.get_color() for line in axes.lines if line.get_linestyle() == "--"] == ["k", "k"]
    assert axes.get_xlabel() == "approach" and axes.get_ylabel() == "normal force (µN)"
    axes = cycle.plot(length_unit="m", pressure_unit="Pa")
    assert axes.get_xlabel() == "approach (mm)" and axes.get_ylabel() == "normal force (µN)"


@pytest.mark.filterwarnings("ignore:ends")
def test_bodies_start_apart_where_that_is_asked_for(tip):
    law = asperity.Exponential(2e-5, 2e-3)
    strong = asperity.Exponential(1e-4, 2e-3)
    adhesive = {"law": strong, "approach": -0.0045, "tolerance": 1e-5}
    with pytest.warns(asperity.InputWarning, match="window-edge"):
        apart, sticking = pressed(tip, start="apart", **adhesive), pressed(tip, **adhesive)
    assert apart.contact_fraction == 0 < sticking.contact_fraction
    assert apart.report["initial_gap"] == "apart" and sticking.report["initial_gap"] is None
    periodic = {"modulus": 1.0, "law": law, "mean_gap": 0.02}
    assert asperity.solve(tip, start="apart", **periodic).contact_fraction == 0
    for given, message in [
        ({"start": "afar", "approach": -0.01}, "start is 'afar': it must be 'apart'"),
        ({"start": "apart", "normal_force": 1.0}, "a normal force does not say how far: give an approach or a spring"),
        ({"start": "apart", "approach": 0.01}, "undeformed bodies overlap where the approach is 0.01"),
    ]:
        with pytest.raises(ValueError, match=message):
            pressed(tip, **given)


def test_what_the_boundary_does_not_have_is_refused(tip, rough):
    with pytest.raises(ValueError, match="normal_force is NaN"):
        pressed(tip, normal_force=np.nan)
    with pytest.raises(TypeError, match=r"spring is 1.0: it must be \(stiffness, rest\)"):
        pressed(tip, spring=1.0)
    with pytest.raises(ValueError, match="loaded on an area, not on a line"):
        pressed(np.zeros(8), lengths=1.0, normal_force=1.0)
    holes = np.where(rough.heights > rough.heights.mean(), np.nan, rough.heights)
    with pytest.raises(ValueError, match="absent nodes is not what the load works on"):
        asperity.solve(holes, 1.0, modulus=1.0, mean_gap=0.01, absent_missing=True)
    with pytest.raises(ValueError, match="all nodes are absent"):
        pressed(np.full((8, 8), np.nan), lengths=1.0, normal_force=1.0, absent_missing=True)
