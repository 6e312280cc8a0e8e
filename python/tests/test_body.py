"""Layers and coatings in the place of the half-space."""

import pickle

import numpy as np
import pytest

import asperity

COATING = asperity.Coating(0.1, modulus=5.0, poisson=0.2, substrate_poisson=0.3)


@pytest.fixture(scope="module")
def rough():
    return asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_l=2, k_s=16, seed=1)


def pressed(rough, **given):
    return asperity.solve(rough, **{"modulus": 1.0, "mean_pressure": 0.02, **given})


def test_sweeps_cycles_and_stability_have_bodies(rough):
    law = asperity.Exponential(1e-4, 4e-3)
    sweep = asperity.sweep(rough, modulus=1.0, mean_gaps=[0.03, 0.02], body=COATING)
    alone = pressed(rough, mean_pressure=None, mean_gap=0.02, body=COATING)
    assert sweep.columns["mean_pressure"][1] == pytest.approx(alone.mean_pressure, rel=1e-5)
    asperity.cycle(rough, modulus=1.0, mean_gaps=[0.03, 0.02], law=law, body=COATING, steps=3)
    held = pressed(rough, mean_pressure=None, mean_gap=0.03, law=law, body=COATING, stability=True)
    again = asperity.stability(held)
    assert again.verdict == held.report["stability"]["verdict"]
    assert again.eigenvalue == pytest.approx(held.report["stability"]["eigenvalue"], rel=1e-6)


BODIES = [asperity.Layer(0.1, 0.3), asperity.Layer(0.1, 0.3, base="sliding"), COATING, asperity.Symbol(lambda q: 1 + 0.5 * q)]


@pytest.mark.parametrize("body", BODIES)
def test_all_walls_stand_before_all_bodies(rough, body):
    walls = ["hard", asperity.Penalty(1000.0), asperity.Uzawa(1000.0)]
    hard, springs, rounds = (pressed(rough, body=body, wall=wall) for wall in walls)
    assert hard.converged and springs.converged and rounds.converged
    assert springs.report["min_gap"] == pytest.approx(-springs.contact_pressure.max() / 1000.0, rel=1e-9)
    # both to a certified 1e-6 in the energy norm
    np.testing.assert_allclose(rounds.gap, hard.gap, atol=1e-5 * hard.gap.max())
    swept = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.02], body=body, wall=walls[1])
    assert swept.columns["contact_fraction"][0] == springs.contact_fraction


def test_numbers_have_units_or_none(rough):
    in_metres = asperity.prepare(rough, unit="um")
    body = asperity.Coating("100nm", modulus="350GPa", poisson=0.2, substrate_poisson=0.3)
    solution = asperity.solve(in_metres, modulus="70GPa", mean_pressure="1.4GPa", body=body)
    assert solution.report["coating"] == pytest.approx(100e-9, rel=1e-15) and solution.report["given"]["coating_modulus"] == "350GPa"
    assert solution.contact_fraction == pressed(rough, body=COATING).contact_fraction
    with pytest.raises(ValueError, match="coating is 0.1, without a unit, but modulus 70GPa has one"):
        asperity.solve(in_metres, modulus="70GPa", mean_pressure="1GPa", body=COATING)


def test_bodies_can_be_copied_and_compared():
    assert pickle.loads(pickle.dumps(COATING)) == COATING != asperity.Layer(0.02, 0.3)
