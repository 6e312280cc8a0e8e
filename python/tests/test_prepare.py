"""Heights that are prepared step by step."""

import warnings
from functools import partial

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


@pytest.mark.filterwarnings("ignore:(open-edges|tilt|spikes)")
def test_prepare_takes_the_steps_of_the_tool():
    rng = np.random.default_rng(1)
    tilted = rng.normal(size=(40, 30)) + 5 * np.arange(40)[:, None]
    made = asperity.prepare(
        tilted, (40.0, 30.0), scale=1e-3, crop=(4, 2, 32, 24), flip=True, detrend="plane", window=0.2
    )
    assert made.shape == (32, 24) and made.lengths == (32.0, 24.0) and made.missing == 0
    assert np.abs(made.heights).max() < 1e-2
    assert asperity.prepare(made, resample=(64, 48)).shape == (64, 48)
    with pytest.raises(ValueError, match="detrend is cubic"):
        asperity.prepare(tilted, detrend="cubic")
    with pytest.raises(ValueError, match="crop"):
        asperity.prepare(tilted, crop=(0, 0, 100, 1))
    coded = tilted.copy()
    coded[3, 4], coded[20, 10] = -9999, 1e4
    made = asperity.prepare(coded, missing=-9999, align_rows="median", despike=10, detrend=3)
    assert made.missing == 1 and np.nanmax(np.abs(made.heights)) < 20
    assert np.nanstd(asperity.prepare(coded, missing=[-9999, 1e4], align_rows=1).heights) < 2
    assert asperity.prepare(tilted, remove_scars=1.5).log[1].startswith("remove-scars: no scars along x beyond ")
    with pytest.raises(ValueError, match="remove_scars is -1.0: it must be a number, positive"):
        asperity.prepare(tilted, remove_scars=-1.0)
    x, y = np.meshgrid(np.arange(40) - 20, np.arange(30) - 15, indexing="ij")
    with pytest.warns(asperity.InputWarning, match="smooth: the rms slope by differences is"):
        ball = asperity.prepare(np.sqrt(90.0**2 - x**2 - y**2), (40.0, 30.0), remove_form="sphere")
    assert np.abs(ball.heights).max() < 1e-9
    for wrong in [{"align_rows": "mode"}, {"scan_axis": "z"}, {"remove_form": "cone"}, {"detrend": 13}]:
        with pytest.raises(ValueError):
            asperity.prepare(tilted, (40.0, 30.0), **wrong)


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


def test_a_warning_of_scars_knows_whether_some_were_removed():
    scan = 0.2 * np.array(asperity.surface.self_affine(128, 1.0, rms_height=0.01, k_l=2, k_s=60, seed=9))
    for first, last, line in ((10, 30, 40), (60, 100, 7), (20, 60, 90), (80, 110, 64), (5, 40, 120)):
        scan[first:last, line] += 8e-3
    left = asperity.prepare(scan, 1.0, remove_scars=1000.0, mirror=True)
    removed = asperity.prepare(scan, 1.0, remove_scars=True)
    assert (removed.scars_removed, left.scars_removed) == (0.667, 1000.0)
    asperity.solve(removed, modulus=1.0, mean_pressure=4e-3)
    raw = asperity.prepare(scan, 1.0)
    for heights, remedy in ((raw, "prepare --remove-scars --scan-axis"), (left, "--remove-scars below 1000")):
        with pytest.warns(asperity.InputWarning, match=f"scars: .*{remedy}"):
            asperity.solve(heights, modulus=1.0, mean_pressure=4e-3)


def test_scars_and_noise_are_left_out():
    rough = asperity.surface.self_affine(128, 1.0, rms_height=0.01, k_l=2, k_s=60, seed=2)
    clean = np.array(rough)
    assert asperity.surface.knee_wavelength(rough) is None
    scan = clean.copy()
    scan[20:60, 40] += 0.04
    scan[70:120, 90] -= 0.04
    made = asperity.prepare(scan, 1.0, remove_scars=True)
    assert made.log[-1].startswith("remove-scars: 2 scars along x") and "90 of 16384 points" in made.log[-1]
    assert ((made.heights - clean) ** 2).sum() < 1e-2 * ((scan - clean) ** 2).sum()
    noisy = clean + 4e-3 * np.random.default_rng(3).normal(size=clean.shape)
    knee = asperity.surface.knee_wavelength(noisy, 1.0)
    assert 2 / 128 < knee < 0.5
    smooth = asperity.prepare(noisy, 1.0, cut_off_wavelength=knee)
    assert ((smooth.heights - clean) ** 2).sum() < 0.5 * ((noisy - clean) ** 2).sum()
    metres = asperity.prepare(1e-6 * noisy, "1um", unit="um", scale=1e6, cut_off_wavelength=f"{knee}um")
    assert np.allclose(metres.heights, smooth.heights, rtol=0, atol=1e-12)
    with pytest.raises(ValueError, match="cut_off_wavelength"):
        asperity.prepare(noisy, "1um", cut_off_wavelength=0.1)


def test_a_cleaning_is_its_steps(rough):
    scan = rough.heights + 0.1 * np.sin(1.7 * np.arange(rough.shape[1]) ** 2)
    scan[5, 6], scan[20, 30] = np.nan, 3.0
    steps = {"align_rows": "median", "remove_scars": True, "despike": True, "detrend": "plane", "fill": True}
    of = partial(asperity.prepare, scan, 1.0, mirror=True)
    cleaned = of(clean=True)
    assert cleaned.heights.tobytes() == of(**steps).heights.tobytes()
    assert [line.split(":")[0] for line in cleaned.log][2:-1] == ["align-rows", "remove-scars", "despike", "detrend", "fill"]
    for part, step in zip(("rows", "scars", "spikes", "plane"), steps):
        others = {name: value for name, value in steps.items() if name != step}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            assert of(clean=True, without=part).log == of(**others).log
    assert of(clean=True, detrend="quadric").log == of(**{**steps, "detrend": "quadric"}).log
    with pytest.raises(ValueError, match="without is spice: it must be rows, scars, spikes, plane or holes"):
        of(clean=True, without="spice")
