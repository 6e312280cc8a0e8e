"""Accuracies that are asked for, and contact stiffnesses."""

import logging
import pickle

import numpy as np
import pytest

import asperity

PRESSED = {"modulus": 1.0, "mean_pressure": 5e-3}


@pytest.fixture(scope="module")
def coarse():
    """A rough surface whose shortest wave has four nodes."""
    return asperity.surface.self_affine(32, 1.0, rms_slope=0.1, k_l=1, k_r=2, k_s=8, seed=1)


def test_an_accuracy_chooses_grid_and_tolerance(coarse, caplog):
    caplog.set_level(logging.INFO, "asperity")
    found = asperity.solve(coarse, accuracy=0.02, **PRESSED)
    plan = found.plan
    assert "accuracy 0.02 of the area: the shortest wave has 4." in caplog.text
    assert f"likely {plan.shape[0]} x {plan.shape[1]} nodes, tolerance 1e-3" in caplog.text and "MiB" in caplog.text
    assert plan.tolerance == found.report["tolerance"] == 1e-3 and 3.9 < plan.nodes_per_wave < 5
    assert plan.bytes > 8 * np.prod(plan.shape) and plan.seconds > 0
    # the fields are those of the finest grid, on which the old nodes keep their heights
    shape, error = found.gap.shape, found.report["grid_error"]["area"]
    assert shape >= (64, 64) and tuple(found.report["shape"]) == shape == found.topography.shape
    assert [level["shape"][0] for level in found.report["levels"]][-1] == shape[0]
    stride = shape[0] // 32
    assert np.allclose(found.heights[::stride, ::stride], coarse.heights, rtol=0, atol=1e-15)
    assert np.isclose(found.displacement.mean() - found.heights.mean(), found.mean_gap)
    assert 0 < error["relative"] < 0.02 and "error of the grid" in repr(found) and "of the area" in repr(found)
    other = pickle.loads(pickle.dumps(found))
    assert other.plan == plan and other.report == found.report
    # what is done with a solution is done on its grid
    assert asperity.stability(found).verdict == "stable"
    plain = asperity.solve(coarse, **PRESSED)
    assert plain.plan is None and plain.contact_stiffness is None and plain.topography.heights is coarse.heights


def test_a_line_is_refined_along_itself():
    wave = 0.02 * np.cos(2 * np.pi * np.arange(32) / 32)
    found = asperity.solve(wave, 1.0, modulus=1.0, mean_pressure=0.02, accuracy=5e-4)
    assert found.gap.shape == found.heights.shape == (found.report["shape"][0],) and found.gap.size > 32


def test_an_accuracy_that_is_not_reached_is_a_warning_with_the_reason(coarse):
    with pytest.warns(asperity.AccuracyWarning, match=r"0.003 of the area is not reached.*would be next.*raise memory"):
        found = asperity.solve(coarse, accuracy=0.003, memory=1e-3, **PRESSED)
    assert found.converged and found.report["accuracy"]["reached"] is False
    holes = np.where(coarse.heights > np.quantile(coarse.heights, 0.05), coarse.heights, np.nan)
    with pytest.warns(asperity.AccuracyWarning, match="the estimate is .*absent nodes.*give a finer one"):
        found = asperity.solve(holes, 1.0, accuracy=0.01, absent_missing=True, **PRESSED)
    assert found.heights.shape == (32, 32)
    # a solve that has not converged says that, and one that was stopped raises nothing of it
    with pytest.warns(asperity.ConvergenceWarning, match="iteration-limit"):
        found = asperity.solve(coarse, accuracy=0.01, max_iterations=1, **PRESSED)
    assert found.report["accuracy"]["reached"] is False

    def stop(state):
        raise StopIteration

    with pytest.warns(asperity.ConvergenceWarning, match="stopped"):
        found = asperity.solve(coarse, accuracy=0.01, accuracy_of="gap", observe=stop, **PRESSED)
    assert found.gap.shape == (32, 32) and found.contact_stiffness is None
