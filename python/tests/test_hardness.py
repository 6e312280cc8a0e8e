"""A cap on the contact pressure: a surface that yields, and stays flattened."""

import pickle

import numpy as np
import pytest

import asperity


@pytest.fixture(scope="module")
def surface():
    return asperity.surface.self_affine(48, 1.0, rms_slope=0.2, k_s=6, seed=3)


@pytest.fixture(scope="module")
def elastic(surface):
    return asperity.solve(surface, modulus=1.0, mean_pressure=0.02)


def test_a_solution_has_its_plastic_depth(surface, elastic):
    hardness = 0.3 * float(elastic.contact_pressure.max())
    solution = asperity.solve(surface, modulus=1.0, mean_pressure=0.02, hardness=hardness)
    depth = solution.plastic_depth
    assert solution.report["plastic_depth_max"] == depth.max() > 0.0 and elastic.plastic_depth is None
    assert np.isnan(solution.statistics.corrected_contact_fraction) and "greatest plastic depth" in repr(solution)
    # u = g + h to the surface as it is now
    assert np.array_equal(solution.displacement, solution.gap + (solution.heights - depth))
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
    assert varying.plastic_depth[:24].max() > 0.0 and varying.plastic_depth[24:].max() == 0.0
    assert (varying.report["hardness"], varying.report["hardness_map"]) == (nodes.mean(), "array")
    metres = asperity.Topography(1e-6 * surface.heights, (1e-6, 1e-6))
    text = asperity.solve(metres, modulus="1GPa", mean_pressure="20MPa", hardness="100MPa")
    assert text.report["hardness"] == 1e8 and text.report["given"]["hardness"] == "100MPa"
    pascals = asperity.solve(metres, modulus="1GPa", mean_pressure="20MPa", hardness=np.full((48, 48), 1e8))
    assert np.array_equal(pascals.contact_pressure, text.contact_pressure)


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
