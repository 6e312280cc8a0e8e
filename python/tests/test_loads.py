"""Many loads: sweeps and cycles, and their columns."""

import logging
import pickle

import numpy as np
import pandas as pd
import pytest

import asperity


def test_a_sweep_gives_its_solutions_one_by_one(rough):
    loads = [0.005, 0.01, 0.02]
    sweep = asperity.sweep(rough, modulus=1.0, mean_pressures=loads)
    assert len(sweep) == 3 and repr(sweep) == "Sweep(0 of 3 loads solved)"
    shares = [solution.contact_fraction for solution in sweep]
    assert shares == sorted(shares) and list(sweep.columns["contact_fraction"]) == shares
    alone = asperity.solve(rough, modulus=1.0, mean_pressure=0.02)
    assert shares[-1] == alone.contact_fraction


def test_columns_are_a_table_of_pandas(rough, law):
    table = pd.DataFrame(asperity.sweep(rough, modulus=1.0, mean_gaps=np.array([0.02, 0.015]), law=law).columns)
    assert len(table) == 2 and np.allclose(table.mean_gap, [0.02, 0.015], rtol=1e-14)
    assert (table.status == "converged").all() and table.dtypes["iterations"] == np.int64


@pytest.mark.parametrize("given", [{}, {"hardness": 0.08}], ids=str)
def test_an_interrupted_sweep_goes_on_with_the_same_bits(rough, given):
    loads = np.geomspace(0.002, 0.02, 4)
    whole = asperity.sweep(rough, modulus=1.0, mean_pressures=loads, **given).columns
    interrupted = []

    def observe(state):
        if state.iteration == 2 and len(sweep.rows) == 2 and not interrupted:
            interrupted.append(state)
            raise KeyboardInterrupt

    sweep = asperity.sweep(rough, modulus=1.0, mean_pressures=loads, observe=observe, **given)
    with pytest.raises(KeyboardInterrupt):
        sweep.run()
    assert len(sweep.rows) == 2
    for name, column in sweep.columns.items():
        assert repr(column.tolist()) == repr(whole[name].tolist()), name  # NaN is itself


def test_a_sweep_warns_for_each_load_that_has_not_converged(rough):
    with pytest.warns(asperity.ConvergenceWarning) as caught:
        asperity.sweep(rough, modulus=1.0, mean_pressures=[0.01, 0.05], max_iterations=1).run()
    assert len(caught) == 2


def test_a_cycle_finds_the_jumps_and_keeps_the_balance_of_energy():
    wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    law = asperity.Exponential(1e-3, 8e-3)
    cycle = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.08, 0.01, 0.08], steps=10)
    first = next(cycle)
    assert first.leg == 0 and first.solution.gap.shape == (64,) and "start, leg 0" in repr(first)
    names = [event["event"] for event in cycle.events]
    assert names == ["jump-in", "pull-off"]
    table = pd.DataFrame(cycle.columns)
    last = table.iloc[-1]
    assert last.dissipated > 0 and abs(last.imbalance) < 0.05 * last.dissipated
    assert np.isclose(last.dissipated, sum(event["energy_drop"] or 0.0 for event in cycle.events))
    # jumps that are not looked for are in no energy
    with pytest.warns(asperity.AccuracyWarning, match=r"misses \d+\.\d % of the greatest work on the way: take more steps"):
        asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.08, 0.01, 0.08], steps=3, imbalance=1.0).run()


def test_a_cycle_without_a_range_has_its_limits_and_the_accuracy_that_is_asked_for(caplog):
    tip = asperity.surface.paraboloid(32, 0.7, radius=2.0)
    keys = {"modulus": 1.0, "law": asperity.JKR(5e-5), "boundary": "free", "approaches": [-8e-3, 6e-3, -20e-3]}
    with caplog.at_level(logging.INFO, "asperity"):
        cycle = asperity.cycle(tip, accuracy=0.02, accuracy_of="tension", **keys)
    nodes = next(cycle).solution.heights.shape[0]
    assert nodes > 32 and f"accuracy 0.02 of the tension: {nodes} x {nodes} nodes" in caplog.text
    limit = cycle.limit
    assert limit.accuracy == {"wanted": 0.02, "of": "tension", "reached": True}
    assert limit.tension_error < 0.02 * limit.tension
    assert [level["shape"][0] for level in limit.levels] == [2**k for k in range(4, nodes.bit_length())]
    assert limit.levels[-1]["work"] == cycle.columns["work"][-1]
    assert [event["event"] for event in cycle.events] == ["touch", "pull-off"]
    assert pickle.loads(pickle.dumps(cycle)).limit == limit
    with pytest.raises(ValueError, match="an accuracy makes its own start"):
        asperity.cycle(tip, accuracy=0.1, start=np.full((32, 32), 0.1), **keys)
    wave, law = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64), asperity.Exponential(1e-3, 8e-3)
    assert asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.08, 0.07], steps=1).limit is None


def test_loads_that_are_refused(rough):
    with pytest.raises(ValueError, match="there are no loads: give a list"):
        asperity.sweep(rough, modulus=1.0)
    with pytest.raises(ValueError, match="two turning points"):
        asperity.cycle(rough, modulus=1.0, mean_gaps=[0.1])
    with pytest.raises(ValueError, match="mean_gaps is 0.01,-1.0: .* it must be a number, zero or positive"):
        asperity.sweep(rough, modulus=1.0, mean_gaps=[0.01, -1.0]).run()
    with pytest.raises(ValueError, match="number of steps is 0"):
        asperity.cycle(rough, modulus=1.0, mean_gaps=[0.02, 0.01], steps=0).run()


def test_a_contact_that_jumps_past_the_fraction_is_told():
    x = np.arange(32) / 32
    ridge = np.repeat(0.02 * np.cos(2 * np.pi * x)[:, None], 16, axis=1)
    with pytest.warns(asperity.ConvergenceWarning, match=r"25\.0 % contact: it jumps from 21\.9 % to 28\.1 %"):
        solution = asperity.solve(ridge, (1.0, 0.5), modulus=1.0, contact_fraction=0.25)
    assert solution.converged and not solution.report["search"]["reached"]
