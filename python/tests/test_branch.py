"""The branch of equilibria that a solve with adhesion finds."""

import numpy as np
import pytest

import asperity

WAVE = 0.02 * np.cos(2 * np.pi * np.arange(128) / 128)
LAW = asperity.Exponential(work_of_adhesion=4e-4, range=4e-3)


def test_loading_is_the_default_and_both_are_compared():
    both = asperity.solve(WAVE, 1.0, modulus=1.0, law=LAW, mean_pressure=1e-3, branch="both")
    other = both.report["other_branch"]
    assert both.report["branch"] == "loading" and other["branch"] == "unloading"
    assert not other["same"] and other["distance"] > 0.1 and other["contact_fraction"] == 1.0
    default = asperity.solve(WAVE, 1.0, modulus=1.0, law=LAW, mean_pressure=1e-3)
    assert default.contact_fraction == both.contact_fraction < 0.9 and default.report["other_branch"] is None
    flat = asperity.solve(WAVE, 1.0, modulus=1.0, law=LAW, mean_pressure=1e-3, branch="unloading")
    assert flat.contact_fraction == 1.0 and flat.report["branch"] == "unloading"
    weak = asperity.Exponential(work_of_adhesion=1e-5, range=4e-3)
    one = asperity.solve(WAVE, 1.0, modulus=1.0, law=weak, mean_pressure=0.01, branch="both")
    assert one.report["other_branch"]["same"]


def test_branches_that_are_none_are_refused():
    scene = {"modulus": 1.0, "law": LAW}
    with pytest.raises(ValueError, match="branch is down: it must be loading, unloading or both"):
        asperity.solve(WAVE, 1.0, **scene, mean_pressure=1e-3, branch="down")
    with pytest.raises(ValueError, match="there is but one equilibrium"):
        asperity.solve(WAVE, 1.0, modulus=1.0, mean_pressure=1e-3, branch="both")
    with pytest.raises(ValueError, match="start chooses the branch"):
        asperity.solve(WAVE, 1.0, **scene, mean_pressure=1e-3, branch="loading", start=np.ones(128))
    with pytest.raises(ValueError, match="use solve"):
        asperity.sweep(WAVE, 1.0, **scene, mean_pressures=[1e-3], branch="both")
