"""Two surfaces that face each other, and two elastic bodies."""

import pathlib
import pickle

import numpy as np
import pytest

import asperity


@pytest.fixture(scope="module")
def pair():
    return [asperity.surface.self_affine(32, 1.0, rms_slope=0.1, k_l=2, k_s=10, seed=seed) for seed in (1, 2)]


def pressed(heights, **given):
    return asperity.solve(heights, **{"modulus": 1.0, "mean_pressure": 0.02, **given})


def test_two_surfaces_are_the_one_between_them(pair):
    one, other = pair
    both = pressed(one, against=other)
    between = np.asarray(one) + np.asarray(other)[::-1]
    np.testing.assert_array_equal(both.heights, between)
    np.testing.assert_array_equal(both.gap, pressed(between, lengths=1.0).gap)
    assert (both.report["against"], both.report["shift"], both.report["against_modulus"]) == ("array", [0, 0], None)
    # whole nodes are rolled, parts of nodes are phases, here of waves that the grid resolves
    moved = pressed(one, against=other, shift=(3 / 32, -1 / 32))
    rolled = np.roll(np.asarray(other)[::-1], (3, -1), (0, 1))
    np.testing.assert_array_equal(moved.heights, np.asarray(one) + rolled)
    part = pressed(one, against=other, shift=0.4 / 32).heights - np.asarray(one)
    phases = np.exp(-2j * np.pi * np.fft.fftfreq(32) * 0.4)[:, None]
    expected = np.fft.ifft2(np.fft.fft2(np.asarray(other)[::-1]) * phases).real
    np.testing.assert_allclose(part, expected, atol=1e-15)


@pytest.mark.filterwarnings("ignore:flat")
def test_congruent_surfaces_close_without_a_load(pair):
    one = pair[0]
    fits = -np.asarray(one)[::-1]
    # the second one elastic or rigid
    for given in ({}, {"against_modulus": 2.0}):
        closed = pressed(one, against=fits, mean_pressure=0.0, **given)
        assert (closed.contact_fraction, closed.mean_gap) == (1.0, 0.0)
    assert pressed(one, against=fits, shift=1 / 32, mean_pressure=1e-6).contact_fraction < 0.1


def test_arrays_of_images_files_and_lines_face_each_other(pair, tmp_path):
    one, other = (np.asarray(surface) for surface in pair)
    both = pressed(one, lengths=1.0, against=other)
    image = pressed(one.T, lengths=1.0, against=other.T, axes="yx")
    np.testing.assert_array_equal(image.gap, both.gap)
    np.save(tmp_path / "other.npy", other)
    file = pressed(one, lengths=1.0, against=tmp_path / "other.npy", axes="xy")
    np.testing.assert_array_equal(file.gap, both.gap)
    assert file.report["against"].endswith("other.npy")
    line = pressed(one[:, 0], lengths=1.0, against=other[:, 0])
    np.testing.assert_array_equal(line.heights, one[:, 0] + other[::-1, 0])


@pytest.mark.filterwarnings("ignore:window-edge")
def test_each_body_moves_by_its_compliance(pair):
    one, other = pair
    rigid = pressed(one, against=other)
    np.testing.assert_array_equal(rigid.displacement, rigid.gap + rigid.heights)
    assert rigid.against_displacement is None
    # beyond a free window the pressure vanishes to the tolerance of the solve
    for given, tolerance in (({}, 1e-12), ({"boundary": "free"}, 1e-7)):
        both = pressed(one, against=other, modulus=3.0, against_modulus=6.0, **given)
        single = pressed(one, against=other, modulus=2.0, **given)
        np.testing.assert_array_equal(both.gap, single.gap)
        np.testing.assert_allclose(both.displacement, 2 * both.against_displacement, atol=1e-15)
        rest = both.displacement + both.against_displacement - both.gap - both.heights
        assert np.ptp(rest) < tolerance
        np.testing.assert_array_equal(pickle.loads(pickle.dumps(both)).displacement, both.displacement)


def test_tables_stability_and_accuracy_have_both(pair, tmp_path):
    one, other = pair
    law = asperity.Exponential(1e-4, 4e-3)
    given = {"against": other, "against_modulus": 2.0, "shift": 0.25, "modulus": 2.0}
    sweep = asperity.sweep(one, mean_gaps=[0.05, 0.04], out=tmp_path / "table.csv", **given)
    alone = asperity.solve(one, mean_gap=0.04, **given)
    assert sweep.columns["mean_pressure"][1] == pytest.approx(alone.mean_pressure, rel=1e-5)
    assert len(asperity.sweep(one, mean_gaps=[0.05, 0.04], out=tmp_path / "table.csv", **given).rows) == 2
    asperity.cycle(one, mean_gaps=[0.06, 0.05], law=law, steps=3, **given).run()
    held = asperity.solve(one, mean_gap=0.05, law=law, stability=True, **given)
    again = asperity.stability(held)
    assert again.eigenvalue == pytest.approx(held.report["stability"]["eigenvalue"], rel=1e-6)
    right = asperity.solve(one, mean_pressure=0.02, accuracy=0.1, **given)
    np.testing.assert_allclose(
        right.displacement + right.against_displacement, right.gap + right.heights - (right.gap + right.heights).mean(), atol=1e-12
    )


def test_a_shifted_start_ends_in_the_same_contact_in_fewer_steps(pair):
    one, other = pair
    before = pressed(one, against=other, nested=False)
    cold = pressed(one, against=other, shift=0.5 / 32, nested=False)
    warm = pressed(one, against=other, shift=0.5 / 32, start=before)
    assert warm.operator_applications < cold.operator_applications
    np.testing.assert_allclose(warm.gap, cold.gap, atol=1e-5 * cold.gap.max())


def test_originals_of_mirrored_maps_face_each_other(pair):
    one, other = (asperity.prepare(surface, mirror=True) for surface in pair)
    both = pressed(one, against=other)
    between = asperity.prepare(np.asarray(pair[0]) + np.asarray(pair[1])[::-1], 1.0, mirror=True)
    np.testing.assert_array_equal(both.gap, pressed(between).gap)
    np.testing.assert_array_equal(both.heights, np.asarray(pair[0]) + np.asarray(pair[1])[::-1])


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"shift": 0.1}, "there is no surface on the other side"),
        ({"against": np.zeros((8, 8))}, "against has 8 x 8 nodes .*heights has 32 x 32 .*asperity.prepare\\(crop=...\\)"),
        ({"against": np.full((32, 32), np.nan)}, "1024 of 1024 points are missing: .*absent_missing=True"),
        ({"against": np.zeros((32, 32)), "against_modulus": -1.0}, "against_modulus is -1.0: it must be a number, positive"),
        ({"against": np.zeros((32, 32)), "shift": (0.1, 0.0), "boundary": "free"}, "shift is 0.1 0, but with a free boundary"),
        ({"against": asperity.Topography(np.zeros((32, 32)), unit="nm")}, "against is in nm, but heights names no unit"),
    ],
)
def test_what_does_not_fit_is_refused(pair, given, message):
    with pytest.raises(ValueError, match=message):
        pressed(pair[0], **given)


def test_a_shift_has_two_lengths_at_most(pair):
    with pytest.raises(ValueError, match="shift is 1, 2, 3: it must be one value or two"):
        pressed(pair[0], against=pair[1], shift=(1, 2, 3))


def test_the_code_of_the_page_runs(pair, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for surface, name in zip(pair, ("heights", "other")):
        np.save(name, 20e-6 * np.asarray(surface))
    found = {}
    page = (pathlib.Path(__file__).resolve().parents[2] / "docs/program/two-surfaces.md").read_text()
    exec(page.split("```python\n")[1].split("```")[0], found)
    assert found["both"].converged and found["both"].report["against_modulus"] == pytest.approx(210e9 / 0.91)


def test_contact_moduli_of_one_and_two_bodies(pair):
    assert asperity.contact_modulus(210e9, 0.3) == pytest.approx(210e9 / 0.91, rel=1e-15)
    assert asperity.contact_modulus(3.0, 0.5, 6.0, 0.0) == pytest.approx(2.4, rel=1e-15)
    # texts give texts, which a call with units takes
    steel = asperity.contact_modulus("210GPa", 0.3, other_young="70GPa", other_poisson=0.33)
    assert float(steel.removesuffix("Pa")) == pytest.approx(1 / (0.91 / 210e9 + (1 - 0.33**2) / 70e9), rel=1e-14)
    metres = [asperity.prepare(surface, unit="um") for surface in pair]
    solution = pressed(metres[0], modulus=steel, mean_pressure="1GPa", against=metres[1], shift=("0.5um", "0um"))
    assert solution.report["shift"] == [5e-7, 0] and solution.report["given"]["shift"] == ["0.5um", "0um"]
    for wrong, error in [((1.0, 0.6), ValueError), ((-1.0, 0.3), ValueError), ((1.0, 0.3, 2.0), TypeError)]:
        with pytest.raises(error):
            asperity.contact_modulus(*wrong)
