"""The branch of equilibria that a solve with adhesion finds."""

import numpy as np
import pytest

import asperity

WAVE = 0.02 * np.cos(2 * np.pi * np.arange(128) / 128)
LAW = asperity.Exponential(work_of_adhesion=4e-4, range=4e-3)


def test_branches_that_are_none_are_refused():
    scene = {"modulus": 1.0, "law": LAW}
    with pytest.raises(ValueError, match="start chooses the branch"):
        asperity.solve(WAVE, 1.0, **scene, mean_pressure=1e-3, branch="loading", start=np.ones(128))
    with pytest.raises(ValueError, match="use solve"):
        asperity.sweep(WAVE, 1.0, **scene, mean_pressures=[1e-3], branch="both")
