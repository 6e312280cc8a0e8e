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
    assert both.report["against"] == "array" and both.against_displacement is None
    moved = pressed(one, against=other, shift=(3 / 32, -1 / 32), against_modulus=2.0)
    rolled = np.roll(np.asarray(other)[::-1], (3, -1), (0, 1))
    np.testing.assert_array_equal(moved.heights, np.asarray(one) + rolled)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(moved)).against_displacement, moved.against_displacement)


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
