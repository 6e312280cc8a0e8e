"""The greatest tension under which surfaces stay together."""

import json
import subprocess

import numpy as np
import pytest

import asperity

LAW = asperity.Exponential(1e-4, 4e-3)


@pytest.fixture(scope="module")
def rough():
    return asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_l=2, k_s=8, seed=1)


def test_a_pull_off_has_its_bracket_its_last_state_and_its_cost(rough):
    found = asperity.pull_off(rough, modulus=1.0, law=LAW, rtol=1e-3)
    assert found.reached and found.lost_pressure - found.pressure <= 1e-3 * found.lost_pressure
    assert found.pressure == -found.solution.mean_pressure == found.force and found.solution.converged
    assert (found.branch, found.preload, found.rtol) == ("unloading", None, 1e-3)
    assert found.operator_applications > found.solution.operator_applications and found.solves > 5


def test_units_a_start_and_what_is_refused(rough):
    in_metres = asperity.prepare(rough, unit="um")
    law = asperity.Exponential("7uJ/m2", "4nm")
    given = asperity.pull_off(in_metres, modulus="70GPa", law=law, preload="1MPa")
    assert given.preload == 1e6 and given.solution.report["given"]["preload"] == "1MPa"
    held = asperity.solve(rough, modulus=1.0, law=LAW, mean_pressure=0.02)
    assert asperity.pull_off(rough, modulus=1.0, law=LAW, start=held).branch is None
    with pytest.raises(ValueError, match="leave out branch, or start"):
        asperity.pull_off(rough, modulus=1.0, law=LAW, start=held, branch="loading")
    with pytest.warns(asperity.ConvergenceWarning, match="not converged"):
        short = asperity.pull_off(rough, modulus=1.0, law=LAW, max_iterations=2)
    assert (short.reached, short.pressure) == (False, None)


@pytest.mark.parametrize("law", [LAW, asperity.JKR(1e-4)])
def test_the_program_finds_the_same(law, rough, tool, tmp_path):
    np.save(tmp_path / "heights.npy", rough.heights)
    given = ["--law", "jkr"] if law is not LAW else ["--law", "exponential", "--range", "4e-3"]
    command = [tool, "pull-off", "--heights", "heights.npy", "--work-of-adhesion", "1e-4", *given, "--json"]
    report = json.loads(subprocess.run(command, cwd=tmp_path, check=True, capture_output=True).stdout)
    ours = asperity.pull_off(rough, modulus=1.0, law=law)
    assert (report["pull_off_pressure"], report["lost_pressure"]) == (ours.pressure, ours.lost_pressure)
    assert (report["limit_pressure"], report["limit_reason"]) == (ours.limit_pressure, ours.limit_reason)
    assert report["last"]["mean_gap"] == ours.solution.mean_gap and report["solves"] == ours.solves
