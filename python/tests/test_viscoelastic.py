"""Viscoelastic bodies against exact solutions, and against the elastic bodies that they are at once and in the end."""

import pickle

import numpy as np
import pytest

import asperity

RADIUS, SHARE = 2.0, 0.6
PRONY = [(SHARE, 1.0)]
# creep compliance of the contact modulus: from 1 to 1/(1 − SHARE)
COMPLIANCE = 1 / (1 - SHARE)


def compliance(time):
    return COMPLIANCE - (COMPLIANCE - 1) * np.exp(-(1 - SHARE) * np.asarray(time))


@pytest.fixture(scope="module")
def tip():
    return asperity.surface.paraboloid(64, 1.0, radius=RADIUS)


def followed(heights, lengths=None, modulus=1.0, prony=PRONY, **given):
    return asperity.viscoelastic(heights, lengths, modulus=modulus, prony=prony, **given)


@pytest.mark.parametrize("body", [None, asperity.Layer(0.2, poisson=0.4)])
def test_at_once_it_is_the_instantaneous_body_and_in_the_end_the_relaxed_one(rough, body):
    times = [0.0, 1e9]
    found = followed(rough, body=body, times=times, mean_pressures=[0.01, 0.01])
    at_once, in_the_end = found
    elastic = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, body=body)
    relaxed = asperity.solve(rough, modulus=1 - SHARE, mean_pressure=0.01, body=body)
    assert at_once.solution.gap.tobytes() == elastic.gap.tobytes()
    # 1e-9 of the relaxing share is left, and each solve is right to 1e-6
    np.testing.assert_allclose(in_the_end.solution.gap, relaxed.gap, atol=1e-5 * relaxed.gap.max())
    np.testing.assert_allclose(in_the_end.displacement - rough.heights, relaxed.gap, atol=1e-5 * relaxed.gap.max())
    if body is None:
        assert at_once.stored == pytest.approx(elastic.elastic_energy, rel=1e-5)
        assert in_the_end.stored == pytest.approx(relaxed.elastic_energy, rel=1e-5)


def test_without_a_series_it_is_a_sweep(tip):
    forces = [1e-3, 3e-3, 2e-3]
    found = followed(tip, prony=[], boundary="free", times=[0, 1, 2], normal_forces=forces, tolerance=1e-8).columns
    swept = asperity.sweep(tip, modulus=1.0, normal_forces=forces, boundary="free", tolerance=1e-8).columns
    np.testing.assert_allclose(found["approach"], swept["approach"], rtol=1e-6)
    assert np.all(found["dissipated"] == 0)


@pytest.mark.parametrize("prony", [PRONY, [(1.0, 2.0)], [(0.3, 1.0), (0.3, 1.0)]])
def test_a_sphere_creeps_as_lee_and_radok_say(tip, prony):
    force, times = 0.003, np.linspace(0.0, 4.0, 17)
    found = followed(tip, prony=prony, boundary="free", times=times, normal_forces=[force] * times.size)
    # a fluid of Maxwell flows without end
    creep = 1 + times / 2 if prony[0][0] == 1.0 else compliance(times)
    hertz = asperity.exact.Hertz(RADIUS, 1.0).at_load(force * creep)
    # the grid has 5e-4 of the approach, and the steps of a quarter of the relaxation time 1e-3
    np.testing.assert_allclose(found.columns["approach"], hertz.approach, rtol=1.5e-3)
    area = found.columns["corrected_contact_fraction"]
    np.testing.assert_allclose(area, np.pi * hertz.contact_radius**2, rtol=0.01)


def retraction(times, turn, rate):
    """Force and contact radius of a sphere after Ting: pressed at a constant rate, drawn back from the time `turn` on."""

    def passed(time):
        return (1 - SHARE) * time + SHARE * (1 - np.exp(-time))

    forces, radii = [], []
    table = np.linspace(0.0, 2 * times[-1], 100_001)
    for time in times:
        # the contact of the way back is that of an earlier time
        same = time if time <= turn else time - np.interp(2 * passed(time - turn), passed(table), table)
        same = max(same, 0.0)
        root = np.sqrt(same) * (np.arange(2000) + 0.5) / 2000
        relaxing = 1 - SHARE + SHARE * np.exp(-(time - root**2))
        # of s = root²: da³ = 3 (R rate)^(3/2) root² d root
        forces.append(4 / RADIUS * (RADIUS * rate) ** 1.5 * np.sqrt(same) * np.mean(relaxing * root**2))
        radii.append(np.sqrt(RADIUS * rate * same))
    return np.array(forces), np.array(radii)


def test_a_sphere_is_drawn_back_as_ting_says(tip):
    rate, times = 0.01, np.linspace(0.0, 4.0, 41)
    path = rate * np.where(times < 2, times, 4 - times)
    found = followed(tip, boundary="free", times=times, approaches=path).columns
    forces, radii = retraction(times, 2.0, rate)
    np.testing.assert_allclose(found["approach"], path, atol=1e-12)
    # grid and steps have 4e-4 of the largest force each, and 2e-3 of the area of a contact of six nodes or more
    np.testing.assert_allclose(found["normal_force"], forces, atol=1e-3 * forces.max())
    large = radii > 0.1
    np.testing.assert_allclose(found["corrected_contact_fraction"][large], np.pi * radii[large] ** 2, rtol=5e-3)
    # it comes apart before it is back, and what is stored in the free body then decays
    assert abs(found["normal_force"][-3:]).max() < 1e-9 * forces.max() and not found["contact_fraction"][-3:].any()
    assert found["stored"][-1] < 0.1 * found["work"].max()
    assert abs(found["imbalance"]).max() < 2e-3 * found["work"].max()


def wave(steps):
    """Errors of a wave that sinks into springs over time, linear and with an exact solution, and of its balance of energy."""
    nodes, height, stiffness = 16, 0.01, 4.0
    heights = height * np.cos(2 * np.pi * np.arange(nodes) / nodes)
    times = np.linspace(0.0, 2.0, steps + 1)
    given = {"wall": asperity.Penalty(stiffness), "times": times, "mean_pressures": [0.1] * times.size, "tolerance": 1e-10}
    moments = list(followed(heights, 1.0, **given))
    amplitudes = np.array([np.fft.rfft(moment.displacement)[1].real * 2 / nodes for moment in moments])
    elastic = np.pi
    first, last = (stiffness * height / (stiffness + elastic * modulus) for modulus in (1.0, 1 - SHARE))
    delay = (stiffness + elastic) / (stiffness + elastic * (1 - SHARE))
    assert all(moment.solution.contact_fraction == 1.0 for moment in moments)
    error = abs(amplitudes - (last + (first - last) * np.exp(-times / delay))).max() / height
    return error, abs(moments[-1].imbalance / moments[-1].work)


def test_the_error_of_a_linear_contact_is_of_the_second_order_in_the_step():
    errors = np.array([wave(steps) for steps in (4, 8, 16, 32)])
    assert (errors[-1] < 1e-5).all()
    np.testing.assert_allclose(errors[:-1] / errors[1:], 4.0, rtol=0.02)


def test_work_is_stored_or_dissipated(rough):
    def pressed(steps):
        times = np.linspace(0.0, 2.0, 2 * steps + 1)
        pressures = 0.02 * (1 - abs(times - 1.0)) + 1e-3
        return followed(rough, times=times, mean_pressures=pressures, tolerance=1e-8).columns

    coarse, fine = pressed(8), pressed(16)
    for found in (coarse, fine):
        np.testing.assert_allclose(found["stored"] + found["dissipated"] - found["work"], found["imbalance"], atol=1e-18)
        assert (np.diff(found["dissipated"]) > 0).all()
    ends = [abs(found["imbalance"][-1]) / found["work"].max() for found in (coarse, fine)]
    assert ends[1] < 0.6 * ends[0] and ends[1] < 5e-3
    assert fine["dissipated"][-1] > 0.1 * fine["work"].max()


def test_a_punch_relaxes_as_its_modulus_in_steps_of_any_size():
    x = np.arange(32) / 32 - 0.5
    punch = np.where(np.hypot(x[:, None], x) < 0.3, 0.0, np.nan)
    times = np.array([0.0, 0.5, 3.0, 1e6])
    given = {"boundary": "free", "absent_missing": True, "tolerance": 1e-8}
    found = followed(punch, 1.0, times=times, approaches=[0.01] * 4, **given).columns
    relaxed = 1 - SHARE * (1 - np.exp(-times))
    np.testing.assert_allclose(found["normal_force"] / found["normal_force"][0], relaxed, rtol=1e-6)
    # nothing moves, so that no work is done, and what is no longer stored, the square of a branch, is dissipated
    stored = 1 - SHARE * (1 - np.exp(-2 * times))
    np.testing.assert_allclose(found["stored"] / found["work"][0], stored, rtol=1e-6)
    np.testing.assert_allclose(found["dissipated"] / found["work"][0], 1 - stored, atol=1e-6)


def test_the_pull_off_over_the_speed_is_between_those_of_both_plateaus():
    heights = 0.01 * np.cos(2 * np.pi * np.arange(256) / 256)
    law = asperity.Exponential(5e-4, 6e-3)
    steps = np.linspace(0.0, 1.0, 81)

    def pull_off(duration, modulus=1.0, prony=PRONY):
        given = {"law": law, "branch": "unloading", "times": duration * steps, "mean_pressures": -0.08 * steps}
        with pytest.warns(asperity.ConvergenceWarning, match="no equilibrium under this tension"):
            found = followed(heights, 1.0, modulus, prony, **given).run()
        assert found.rows[-1]["status"] == "detached" and len(found) == len(found.rows) < steps.size
        assert all(row["status"] == "converged" for row in found.rows[:-1])
        return -found.rows[-2]["mean_pressure"]

    instantaneous, relaxed = pull_off(1.0, 1.0, []), pull_off(1.0, 1 - SHARE, [])
    found = [pull_off(duration) for duration in (1e-5, 1.0, 3.0, 1e5)]
    assert found == sorted(found) and len(set(found)) == 4
    assert found[0] == instantaneous and found[-1] == relaxed


def test_a_sphere_drawn_off_quickly_holds_more():
    tip = asperity.surface.paraboloid(40, 1.0, radius=1.0)
    law = asperity.Exponential(3e-4, 1e-2)
    way = np.linspace(0.0, -0.025, 21)

    def drawn(duration):
        times, path = [0.0, *(1e4 + duration * way / way[-1])], [0.0, *way]
        return followed(tip, law=law, boundary="free", times=times, approaches=path).columns

    slow, quick = (-drawn(duration)["normal_force"].min() for duration in (1e4, 1e-3))
    # the range, half as long as the displacements, adds a tenth to what holds in the limit of no range
    assert slow == pytest.approx(1.5 * np.pi * 3e-4, rel=0.15)
    assert quick > 1.4 * slow


def test_a_jump_drops_what_is_missing_in_the_balance():
    heights = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    law = asperity.Exponential(2e-4, 4e-3)
    gaps = np.linspace(0.05, 0.012, 401)
    path = np.array([*gaps, *gaps[-2::-1]])
    # all steps at once are those of the instantaneous body
    found = followed(heights, 1.0, law=law, times=np.zeros(path.size), mean_gaps=path).columns
    cycle = asperity.cycle(heights, 1.0, modulus=1.0, law=law, mean_gaps=[0.05, 0.012, 0.05]).run()
    drop = sum(event["energy_drop"] for event in cycle.events if event["energy_drop"])
    jumps = np.argsort(np.diff(found["imbalance"]))[:2]
    # work over a step in which the pressure jumps is known to half of the jump times the step
    error = abs(np.diff(found["mean_pressure"])[jumps]).sum() * (gaps[0] - gaps[1]) / 2
    assert error < 0.5 * drop and abs(found["imbalance"][-1] + drop) < error
    assert abs(found["dissipated"]).max() < 1e-9 * drop


def test_units_mirror_images_and_tables(rough, tmp_path):
    in_metres = asperity.prepare(rough, unit="um")
    given = {"prony": PRONY, "times": [0, 1], "modulus": "2MPa"}
    with_units = asperity.viscoelastic(in_metres, mean_pressures=["20kPa", "20kPa"], **given)
    plain = followed(rough, times=[0, 1], mean_pressures=[0.01, 0.01])
    np.testing.assert_allclose(with_units.columns["contact_fraction"], plain.columns["contact_fraction"])
    tip = asperity.surface.paraboloid(32, 1e-6, radius=2e-6)
    by_text = asperity.viscoelastic(tip, boundary="free", approaches=["20nm", "20nm"], **given).columns
    np.testing.assert_allclose(by_text["approach"], 2e-8)
    with pytest.raises(ValueError, match="give both units, or neither"):
        asperity.viscoelastic(tip, boundary="free", approaches=[2e-8, 2e-8], **given).run()

    doubled = asperity.prepare(rough, mirror=True)
    part, whole = (
        followed(doubled, times=[0, 1], mean_pressures=[0.01, 0.01], whole=whole).columns for whole in (False, True)
    )
    for name in ("contact_fraction", "stored", "dissipated"):
        np.testing.assert_allclose(part[name], whole[name], rtol=1e-6)

    contact = asperity.Contact(rough, modulus=1.0)
    again = contact.viscoelastic(prony=PRONY, times=[0, 1], mean_pressures=[0.01, 0.01])
    assert repr(again) == "Viscoelastic(0 of 2 times solved)" and repr(next(again)).startswith("Moment(time=0: mean_pressure")
    assert contact.solve(mean_pressure=0.01).report["modulus"] == 1.0
    travelled = pickle.loads(pickle.dumps(again))
    assert list(travelled.to_dataframe()["contact_fraction"]) == list(plain.columns["contact_fraction"])
    assert with_units.plot(of="mean_pressure").get_ylabel() == "mean pressure (kPa)"
    with pytest.raises(ValueError, match="of is 'area': it must be one of the columns time"):
        plain.plot(of="area")


def test_what_has_not_converged_is_told(rough):
    with pytest.warns(asperity.ConvergenceWarning, match="not converged"):
        found = followed(rough, times=[0, 1], mean_pressures=[0.01, 0.01], max_iterations=2).columns
    assert list(found["status"]) == ["iteration-limit"] * 2


def test_what_does_not_relax_and_paths_that_do_not_hold_together_are_refused(rough):
    good = {"times": [0, 1], "mean_pressures": [0.01, 0.01]}
    for changed, kind, message in [
        ({"prony": None}, TypeError, "prony is None: give pairs"),
        ({"prony": [0.5]}, TypeError, r"prony is \[0.5\]: give pairs"),
        ({"prony": [(-0.5, 1)]}, ValueError, r"prony has \(-0.5, 1\): a share of the modulus is positive"),
        ({"prony": [(0.5, 0)]}, ValueError, "its relaxation time positive and finite"),
        ({"prony": [(0.5, 1), (0.6, 2)]}, ValueError, "shares of prony add up to 1.1, more than 1"),
        ({"mean_pressures": None}, ValueError, "loads are missing: give one list of mean_pressures"),
        ({"mean_gaps": [1, 2]}, ValueError, "loads are mean_pressures and mean_gaps: give one list"),
        ({"times": [0]}, ValueError, "there are 1 times and 2 mean_pressures: give a load at each time"),
        ({"times": None}, TypeError, "times is None: it must be a list of numbers"),
        ({"times": ["1s", "2s"]}, TypeError, "time is '1s': it must be a number"),
        ({"times": [1, 0]}, ValueError, "time 0 follows 1: times must not fall"),
        ({"times": [0, np.inf]}, ValueError, "they must be finite"),
        ({"hardness": 0.1}, TypeError, "viscoelastic.. has no keyword hardness"),
        ({"body": asperity.Symbol(lambda q: q)}, ValueError, "symbol is given"),
        ({"law": asperity.JKR(1e-5)}, ValueError, "law is jkr, whose range is that of the grid"),
        ({"law": "jkr", "work_of_adhesion": 1e-5}, ValueError, "law is jkr"),
        ({"branch": "both"}, ValueError, "branch is both"),
        ({"mean_pressure": 0.01}, TypeError, "give mean_pressures="),
    ]:
        with pytest.raises(kind, match=message):
            followed(rough, **{"prony": PRONY, **good, **changed})
    with pytest.raises(ValueError, match="hardness is given: it does not relax as the modulus does"):
        asperity.Contact(rough, modulus=1.0, hardness=0.1).viscoelastic(prony=PRONY, **good)
    coating = asperity.Coating(0.1, modulus=2.0, poisson=0.3, substrate_poisson=0.3)
    with pytest.raises(ValueError, match="coating is given"):
        followed(rough, body=coating, **good)
    hole = np.where(rough.heights > 0.9 * rough.heights.max(), np.nan, rough.heights)
    with pytest.raises(ValueError, match="absent nodes of a periodic body"):
        followed(hole, 1.0, absent_missing=True, **good)
