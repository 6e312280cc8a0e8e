"""Rough surfaces and their statistics, and clusters."""

import numpy as np
import pytest

import asperity
from asperity import contact, surface


def test_a_surface_has_the_slope_that_is_asked_for():
    rough = surface.self_affine((96, 64), (1.5, 1.0), rms_slope=0.1, hurst=0.7, k_l=2, k_s=16, seed=9)
    assert rough.shape == (96, 64) and rough.lengths == (1.5, 1.0) and rough.periodic
    found = surface.statistics(rough)
    assert np.isclose(found.rms_slope, 0.1, rtol=1e-12) and np.isclose(found.rms_height, rough.heights.std())
    assert found == surface.statistics(rough.heights, rough.lengths)
    alone = surface.statistics(rough.heights)
    assert alone[:6] == found[:6] and np.isnan(alone[6:]).all()
    with pytest.raises(ValueError, match="rms_height or rms_slope"):
        surface.self_affine(64, 1.0)
    with pytest.raises(ValueError, match="k_s is 64"):
        surface.self_affine(64, 1.0, rms_slope=0.1)


def test_spectra_add_up_to_the_variance(rough):
    psd = surface.spectrum(rough)
    total = (psd.densities * psd.waves).sum() * psd.cell
    assert np.isclose(total, rough.heights.var(), rtol=1e-12)


def test_clusters_meet_across_the_boundaries():
    found = contact.clusters(np.array([[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 0, 0]]))
    assert found.sizes.tolist() == [2, 1] and found.labels.tolist() == [[1, 0, 0, 1], [0, 2, 0, 0], [0, 0, 0, 0]]


def test_statistics_of_a_solution_are_those_of_its_map(rough, law):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
    found = solution.statistics
    assert found.cluster_sizes.tolist() == contact.clusters(solution.contact).sizes.tolist()
    assert np.isclose(found.contact_fraction + found.attractive_fraction + found.apart_fraction, 1.0)
    assert np.isclose(found.repulsive_fraction, (solution.contact_pressure > 0).mean())
