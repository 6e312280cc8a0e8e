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


def test_a_shape_of_one_number_is_a_line():
    line = surface.self_affine((256,), 1.0, rms_slope=0.1, seed=1)
    same = surface.self_affine((256, 1), 1.0, rms_slope=0.1, seed=1)
    assert line.shape == (256,) and line.lengths == same.lengths and np.array_equal(line.heights, same.heights)
    assert asperity.solve(line, modulus=1.0, mean_pressure=0.01).gap.shape == (256,)
    for made in (surface.wave((16,), 1.0, amplitude=0.1), surface.fourier([[3, 0, 0.5, 0.0]], (16,), 1.0)):
        assert made.shape == (16,)


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


def test_a_surface_comes_back_from_its_fourier_coefficients(rough, tmp_path):
    n = rough.shape[0]
    half = np.fft.rfft2(rough.heights) / rough.heights.size
    half[np.abs(half) < 1e-15] = 0.0
    qx, qy = np.meshgrid(np.fft.fftfreq(n, 1 / n), np.arange(n // 2 + 1), indexing="ij")
    rows = np.stack([qx, qy, half.real, half.imag], axis=-1).reshape(-1, 4)
    found = surface.fourier(rows, n, rough.lengths)
    np.testing.assert_allclose(found.heights, rough.heights, rtol=0, atol=1e-14)
    assert found.periodic and found.lengths == rough.lengths and found.unit is None
    # of a file, in units of 0.1 mm, on a finer grid; its nodes are among the new ones
    path = tmp_path / "surface.Fourier.ASCII.dat"
    np.savetxt(path, rows[half.ravel() != 0], fmt=["%d", "%d", "%.17g", "%.17g"], delimiter=", ", header="qX, qY")
    fine = surface.fourier(path, 2 * n, "0.1mm", fourier_unit="0.1mm")
    assert (fine.unit, fine.lengths, fine.source) == ("m", (1e-4, 1e-4), str(path))
    np.testing.assert_allclose(fine.heights[::2, ::2], 1e-4 * rough.heights, rtol=0, atol=1e-18)


def test_coefficients_are_refused_by_their_row():
    for rows, message in [
        ([[1, 0, 1, 0], [0.5, 0, 1, 0]], r"coefficients\[1\]: number of waves along x is 0.5"),
        ([[1, 0, 1, 0], [0, 8, 1, 0]], r"coefficients\[1\]: number of waves along y is 8: .* take more nodes"),
        ([[1, 2, 1, 1], [-1, -2, 1, 1]], r"coefficients\[1\]: .* complex conjugate"),
        ([[1, 0, 1]], "3 columns"),
        ([[1, 0, 0, 0]], "other than zero is 0"),
    ]:
        with pytest.raises(ValueError, match=message):
            surface.fourier(rows, 16, 1.0)
    with pytest.raises(ValueError, match="give fourier_unit"):
        surface.fourier([[1, 0, 1, 0]], 16, "1um")
    with pytest.raises(FileNotFoundError):
        surface.fourier("nothing.dat", 16, 1.0)
