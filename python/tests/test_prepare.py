"""Heights that are prepared step by step."""

import numpy as np
import pytest

import asperity


def test_coordinates_and_bytes_that_are_no_heights_are_told(rough):
    heights = rough.heights.copy()
    table = np.vstack([np.arange(heights.shape[1]), heights])
    with pytest.warns(asperity.InputWarning, match="axes: the first line"):
        asperity.prepare(table)
    with pytest.warns(asperity.InputWarning, match="byte-order"):
        asperity.prepare(heights.byteswap())
    heights[3, 4] = 1.70141e38
    with pytest.warns(asperity.InputWarning, match="missing-code: 1.70141e38 stands at 1 node"):
        asperity.prepare(heights)


@pytest.mark.filterwarnings("ignore:line-offsets")
def test_offsets_of_lines_along_the_other_axis_are_a_warning():
    x = np.linspace(0.0, 1.0, 96, endpoint=False)
    smooth = 0.02 * np.sin(2 * np.pi * 3 * x[:, None]) * np.cos(2 * np.pi * 2 * x)
    image = smooth + 0.02 * np.random.default_rng(1).normal(size=(96, 1))  # each row is a scan line
    with pytest.warns(asperity.InputWarning, match="scan-axis: lines along y are offset .* as lines along x") as caught:
        asperity.prepare(image, 1.0, align_rows="median")
    assert caught[0].filename == __file__
    aligned = asperity.prepare(image, 1.0, align_rows="median", axes="yx")
    assert np.abs(aligned.heights.T - smooth).max() < 2e-3
    along_y = asperity.prepare(image, 1.0, align_rows="median", scan_axis="y")
    assert np.allclose(along_y.heights, aligned.heights.T, rtol=0, atol=1e-15)


@pytest.mark.parametrize(
    ("steps", "message"),
    [
        ({"missing": "NA"}, "missing is NA: it must be a number"),
        ({"scale": "nm"}, "scale is nm: it must be a number"),
        ({"resample": 128}, "resample is 128: it must be two values, NX, NY"),
        ({"crop": (1, 2)}, "crop is 1, 2: it must be four values, X, Y, NX, NY"),
        ({"window": "wide"}, "window is wide: it must be a number"),
        ({"detrend": "cubic"}, "detrend is cubic: it must be"),
    ],
)
def test_a_step_that_is_wrong_is_told_with_its_value(rough, steps, message):
    with pytest.raises(ValueError, match=message):
        asperity.prepare(rough.heights, 1.0, **steps)


def test_a_code_may_be_a_text(rough):
    coded = np.where(rough.heights > 0, rough.heights, -9999.0)
    by_text, by_number = (asperity.prepare(coded, 1.0, missing=code).heights for code in ("-9999", -9999))
    assert np.array_equal(by_text, by_number, equal_nan=True) and np.isnan(by_text).any()


def test_noise_has_a_knee_and_a_map_remembers_how_scars_were_removed():
    rough = asperity.surface.self_affine(128, 1.0, rms_height=0.01, k_l=2, k_s=60, seed=2)
    noisy = rough.heights + 4e-3 * np.random.default_rng(3).normal(size=rough.shape)
    knee = asperity.surface.knee_wavelength(noisy, 1.0)
    assert asperity.surface.knee_wavelength(rough) is None and 2 / 128 < knee < 0.5
    assert asperity.prepare(rough, remove_scars=True).scars_removed == 0.667
