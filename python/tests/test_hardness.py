"""A cap on the contact pressure: a surface that yields, and stays flattened."""

import pickle

import numpy as np
import pytest

import asperity

LOADS = [0.005, 0.03, 0.005, 0.03]


@pytest.fixture(scope="module")
def surface():
    return asperity.surface.self_affine(48, 1.0, rms_slope=0.2, k_s=6, seed=3)


@pytest.fixture(scope="module")
def elastic(surface):
    return asperity.solve(surface, modulus=1.0, mean_pressure=0.02)


def test_pressures_are_capped_and_the_depth_is_reported(surface, elastic):
    hardness = 0.3 * float(elastic.contact_pressure.max())
    solution = asperity.solve(surface, modulus=1.0, mean_pressure=0.02, hardness=hardness)
    gap, depth = solution.gap, solution.plastic_depth
    assert solution.contact_pressure.max() == hardness and elastic.plastic_depth is None
    assert all(elastic.report[key] is None for key in ("hardness", "plastic_fraction", "plastic_depth_max", "plastic_energy"))
    report = solution.report
    assert (report["hardness"], report["plastic_depth_max"]) == (hardness, depth.max())
    assert report["plastic_fraction"] == (depth > 0).mean()
    assert np.isclose(report["plastic_depth_mean"], depth.mean(), rtol=1e-12)
    assert np.isclose(report["plastic_energy"], hardness * depth.mean(), rtol=1e-12)
    assert report["corrected_contact_fraction"] is None and np.isnan(solution.statistics.corrected_contact_fraction)
    assert "greatest plastic depth" in repr(solution)
    # u = g + h to the surface as it is now
    assert np.array_equal(solution.displacement, gap + (solution.heights - depth))
    with pytest.raises(ValueError, match="read-only"):
        depth[0, 0] = 1.0
    assert np.array_equal(pickle.loads(pickle.dumps(solution)).plastic_depth, depth)


@pytest.mark.parametrize("hardness", [True, np.True_, np.ones((48, 48), bool)])
def test_a_truth_value_is_no_hardness(surface, hardness):
    with pytest.raises((TypeError, ValueError), match="hardness is .*: it must be"):
        asperity.solve(surface, modulus=1.0, mean_pressure=0.02, hardness=hardness)


def test_a_hardness_may_vary_and_have_a_unit(surface, elastic):
    soft = 0.2 * float(elastic.contact_pressure.max())
    nodes = np.where(np.arange(48)[:, None] < 24, soft, 1.0) * np.ones(48)
    varying = asperity.solve(surface, modulus=1.0, mean_pressure=0.02, hardness=nodes)
    assert np.all(varying.contact_pressure <= nodes) and varying.contact_pressure.max() > soft
    assert varying.plastic_depth[:24].max() > 0.0 and varying.plastic_depth[24:].max() == 0.0
    assert (varying.report["hardness"], varying.report["hardness_map"]) == (nodes.mean(), "array")
    metres = asperity.Topography(1e-6 * surface.heights, (1e-6, 1e-6))
    text = asperity.solve(metres, modulus="1GPa", mean_pressure="20MPa", hardness="100MPa")
    assert text.report["hardness"] == 1e8 and text.report["given"]["hardness"] == "100MPa"
    pascals = asperity.solve(metres, modulus="1GPa", mean_pressure="20MPa", hardness=np.full((48, 48), 1e8))
    assert np.array_equal(pascals.contact_pressure, text.contact_pressure)
    with pytest.raises(ValueError, match="hardness is 1.0, without a unit"):
        asperity.solve(metres, modulus="1GPa", mean_pressure="20MPa", hardness=1.0)
    with pytest.raises(ValueError, match="m is a unit of something else"):
        asperity.solve(metres, modulus="1GPa", mean_pressure="20MPa", hardness="1m")
    with pytest.raises(ValueError, match="hardness"):
        asperity.solve(surface, modulus=1.0, mean_pressure=0.02, hardness=np.ones((48, 24)))


def test_a_hardness_has_the_axes_of_the_heights(surface, elastic):
    soft = 0.2 * float(elastic.contact_pressure.max())
    nodes = np.where(np.arange(48)[:, None] < 24, soft, 1.0) * np.ones(48)
    expected = asperity.solve(surface, modulus=1.0, mean_pressure=0.02, hardness=nodes)
    xarray = pytest.importorskip("xarray")
    labelled = xarray.DataArray(nodes, dims=("x", "y"))
    buffer = nodes.T.copy()
    for hardness in (buffer, labelled):
        contact = asperity.Contact(surface.heights.T, 1.0, axes="yx", modulus=1.0, hardness=hardness)
        buffer *= 2.0
        for found in (contact.solve(mean_pressure=0.02), next(contact.sweep(mean_pressures=[0.02]))):
            assert np.array_equal(found.contact_pressure, expected.contact_pressure)
    image = xarray.DataArray(surface.heights.T, dims=("y", "x"))
    found = asperity.solve(image, 1.0, modulus=1.0, mean_pressure=0.02, hardness=nodes.T)
    assert np.array_equal(found.contact_pressure, expected.contact_pressure)


def test_an_equilibrium_that_has_yielded_has_no_stability(surface):
    solution = asperity.solve(surface, modulus=1.0, mean_pressure=0.02, hardness=0.2)
    with pytest.raises(ValueError, match="does not come back"):
        asperity.stability(solution)


def test_a_sweep_keeps_the_depth_also_where_a_solve_was_interrupted(surface):
    given = {"modulus": 1.0, "mean_pressures": LOADS, "hardness": 0.08}
    solutions = list(asperity.sweep(surface, **given))
    energies = [solution.report["plastic_energy"] for solution in solutions]
    assert 0.0 < energies[0] < energies[1] and np.allclose(energies[1:], energies[1], rtol=1e-4)
    interrupts = iter([True, False, False, True, False, False, False, False])

    class Once:
        def __init__(self):
            self.raises = next(interrupts)

        def __call__(self, state):
            if self.raises and state.iteration > 2:
                self.raises = False
                raise KeyboardInterrupt

    observe = [Once()]
    sweep = asperity.sweep(surface, **given, observe=lambda state: observe[0](state))
    found = []
    while len(found) < len(LOADS):
        try:
            found.append(next(sweep))
        except KeyboardInterrupt:
            pass
        observe[0] = Once()
    for one, other in zip(found, solutions, strict=True):
        assert np.array_equal(one.gap, other.gap) and np.array_equal(one.plastic_depth, other.plastic_depth)
