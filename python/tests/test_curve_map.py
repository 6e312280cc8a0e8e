"""Maps of force curves are fitted as their curves are, and the rates of p-values and intervals are those that are told."""

import pathlib
import runpy
import warnings

import numpy as np
import pytest

import asperity

special = pytest.importorskip("scipy.special")

BENCHES = pathlib.Path(__file__).resolve().parents[1] / "benches"
MAP = runpy.run_path(str(BENCHES / "curve_map.py"))
OPTIONS = {"radius": MAP["RADIUS"], "spring_stiffness": MAP["STIFFNESS"]}


@pytest.fixture(scope="module")
def made():
    curves, moduli = MAP["made"](4, 200, 2e-5)
    # one that is no curve
    curves[2, 1, 1] = np.random.default_rng(1).normal(scale=1e-11, size=200)
    return curves, moduli


@pytest.fixture(scope="module")
def found(made):
    return asperity.fit_curves(made[0], **OPTIONS, poisson=0.5, lengths=1e-5)


def test_a_map_has_the_numbers_of_its_curves(made, found):
    curves, moduli = made
    assert found.shape == (4, 4) and np.argwhere(np.isnan(found.modulus.value)).tolist() == [[2, 1]]
    assert "there is no contact in the data" in found.reason[2, 1] and (found.reason == "").sum() == 15
    fits = found.reason == ""
    assert found.modulus.value[fits] == pytest.approx(moduli[fits], rel=0.01)
    assert found.young.value[fits] == pytest.approx(0.75 * found.modulus.value[fits])
    one = asperity.fit_curve(*curves[1, 3], **OPTIONS)
    for name in ("modulus", "work_of_adhesion", "tabor_parameter", "contact_point"):
        assert tuple(end[1, 3] for end in getattr(found, name)) == getattr(one, name)
    assert found.p_values["DMT"][1, 3] == one.models["DMT"].p_value and found.noise[1, 3] == one.noise
    # pairs of any number of points, and any number of threads
    pairs = [pair[:, ::2] if k % 3 else pair for k, pair in enumerate(curves.reshape(-1, 2, 200))]
    some = asperity.fit_curves(pairs, **OPTIONS, shape=(4, 4), threads=1)
    assert some.modulus.value[0, 3] == found.modulus.value[0, 3] and some.young.value.shape == (4, 4)
    assert "16 force curves, 15 of them fitted" in repr(found) and "1 without: there is no contact" in repr(found)


def test_a_map_is_a_table_and_a_picture(found):
    pandas, xarray = pytest.importorskip("pandas"), pytest.importorskip("xarray")
    table, arrays = found.to_dataframe(), found.to_xarray()
    assert isinstance(table, pandas.DataFrame) and isinstance(arrays, xarray.Dataset)
    row = table[(table["row"] == 1) & (table["column"] == 3)].iloc[0]
    assert row["modulus_lower"] == found.modulus.lower[1, 3] == arrays["modulus_lower"][1, 3]
    assert arrays["x"][0] == pytest.approx(1.25e-6) and table["reason"].str.contains("no contact").sum() == 1
    plt = pytest.importorskip("matplotlib.pyplot")
    ax = found.plot("contact_height")
    assert ax.get_images()[0].get_array().mask.sum() == 1
    with pytest.raises(ValueError, match="of is 'height': it must be one of modulus, young"):
        found.plot("height")
    plt.close("all")


def test_the_map_of_a_file_is_that_of_its_arrays(made, found, tmp_path, recwarn):
    formats, h5py = pytest.importorskip("afmformats"), pytest.importorskip("h5py")
    path = tmp_path / "map.h5"
    metadata = {"imaging mode": "force-distance", "spring constant": MAP["STIFFNESS"]}
    metadata |= {f"grid shape {axis}": 4 for axis in "xy"} | {f"grid size {axis}": 1e-5 for axis in "xy"}
    with h5py.File(path, "w") as file:
        # one place has no curve
        for number, place in enumerate([place for place in np.ndindex(4, 4) if place != (0, 2)][::-1]):
            z, force = made[0][place]
            data = {"height (measured)": -z, "force": force, "segment": np.repeat([0, 1], 100).astype(np.uint8)}
            here = {**metadata, "enum": number, "path": path, "grid index x": place[0], "grid index y": place[1]}
            formats.AFMForceDistance(data, here).export_data(file, metadata=True, fmt="hdf5")
    map = asperity.fit_curves(path, radius="2um")
    same = asperity.fit_curves(path, radius="2um", model="jkr", lengths=("10um", "20um"))
    assert same.lengths == (1e-5, 2e-5) and same.p_values.keys() == {"JKR"}
    assert map.shape == (4, 4) and map.lengths == (1e-5, 1e-5) and map.reason[0, 2].startswith("the file has no curve")
    both = (map.reason == "") & (found.reason == "")
    assert both.sum() == 14 and map.modulus.value[both] == pytest.approx(found.modulus.value[both], rel=1e-6)


def test_what_is_no_map_is_refused(made, tmp_path):
    curves, _ = made
    for wrong, told in (
        ((curves[..., 0, :],), r"curves has shape \(4, 4, 200\): it must be \(..., 2, N\)"),
        (([],), "curves has none"),
        (([curves[0, 0], "text"],), r"curves\[1\] is a str: it must be a pair"),
    ):
        with pytest.raises((TypeError, ValueError), match=told):
            asperity.fit_curves(*wrong, radius=1e-6)
    with pytest.raises(ValueError, match=r"shape is \(5, 5\), of 25 places, and there are 16 curves"):
        asperity.fit_curves(curves, radius=1e-6, shape=(5, 5))
    with pytest.raises(TypeError, match="radius is None, and tip is None: give one of them"):
        asperity.fit_curves(curves)
    path = tmp_path / "curve.csv"
    path.write_text("z (nm),F (nN)\n0,1\n1,2\n")
    with pytest.raises(ValueError, match="is a text, of one curve: take read_curve"):
        asperity.fit_curves(path, radius="1um")
    with pytest.raises(FileNotFoundError):
        asperity.fit_curves(tmp_path / "none.h5", radius="1um")
    # a reason that holds for many is a warning
    wide = curves.copy()
    wide[:, :, 1] += 0.02 * np.ptp(wide[0, 0, 1]) * np.sin(1e7 * wide[:, :, 0])
    with pytest.warns(asperity.InputWarning, match="of 16 curves: residuals of neighbouring points"):
        asperity.fit_curves(wide, **OPTIONS, model="hertz")


def test_true_models_are_ruled_out_and_truths_missed_as_often_as_told():
    study = runpy.run_path(str(BENCHES / "calibration.py"))
    random, counts = np.random.default_rng(12), {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for number in range(80):
            kind = {name: values[random.integers(len(values))] for name, values in study["KINDS"].items()}
            for name, rate in study["rated"]((study["MODELS"][number % 4], kind, (12, number))).items():
                if name not in ("value", "why"):
                    counts.setdefault(name, []).append(rate)
    # more come about by chance once in a thousand times for each
    most = next(k for k in range(81) if special.bdtrc(k, 80, 0.05) < 1e-3)
    assert all(sum(counts[name]) <= most for name in ("p", "modulus", "work_of_adhesion", "contact_point", "tabor_parameter"))
    assert sum(counts.get("refused", [])) <= 3
