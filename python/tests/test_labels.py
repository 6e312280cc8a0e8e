"""Arrays that hold more than heights: record arrays, stacked channels, and tables with coordinates."""

import numpy as np
import pytest

import asperity

NX, NY = 12, 8
HEIGHTS = np.random.default_rng(2).normal(size=(NX, NY))
X, Y = 0.25 * np.arange(NX), 0.15 * np.arange(NY)


@pytest.fixture
def frame():
    """Makes a DataFrame of the heights, y along its index and x along its columns."""
    pandas = pytest.importorskip("pandas")
    return lambda z=HEIGHTS.T, index=Y, columns=X: pandas.DataFrame(z, index=index, columns=columns)


def test_a_record_array_is_refused_by_its_columns():
    table = np.zeros((NX, NY), [("z", float), ("q", np.float32)])
    with pytest.raises(TypeError, match=r'heights are a record array of z, q: give one column, such as a\["z"\]'):
        asperity.prepare(table)
    with pytest.raises(TypeError, match="start gaps are a record array"):
        asperity.solve(HEIGHTS, (3.0, 1.2), modulus=1.0, mean_gap=1.0, start=table)
    table["z"] = HEIGHTS
    assert np.array_equal(asperity.prepare(table["z"]).heights, HEIGHTS)


@pytest.mark.parametrize(
    ("shape", "channel"), [((3, 8, 12), "array[0]"), ((8, 3, 12), "array[:, 0]"), ((8, 12, 3), "array[..., 0]")]
)
def test_stacked_channels_are_refused_with_the_way_to_one(shape, channel):
    with pytest.raises(ValueError) as refused:
        asperity.prepare(np.zeros(shape))
    assert str(refused.value).startswith(f"heights have shape {shape}") and str(refused.value).endswith(channel)
    assert eval(channel, {"array": np.zeros(shape)}).shape == (8, 12)


def test_a_table_with_coordinates_is_a_data_array_with_them(frame):
    xarray = pytest.importorskip("xarray")
    data = xarray.DataArray(HEIGHTS.T, dims=("y", "x"), coords={"y": Y, "x": X})
    expected = asperity.prepare(data)
    rotated = frame(HEIGHTS, X, Y).rename_axis(index="x", columns="y")
    named = frame(HEIGHTS, X, Y).rename_axis(index="x [m]", columns="y (m)")
    falling = frame(HEIGHTS[::-1, ::-1].T, Y[::-1], X[::-1])
    same = frame().rename_axis(index="x", columns="x")
    for table in (frame(), falling, frame().rename_axis(index="row", columns="X"), same, rotated, named):
        found = asperity.prepare(table)
        assert np.array_equal(found.heights, HEIGHTS) and found.lengths == expected.lengths
    assert expected.lengths == pytest.approx((3.0, 1.2), rel=1e-14) and np.array_equal(expected.heights, HEIGHTS)
    assert np.array_equal(asperity.prepare(frame(HEIGHTS, X, Y), axes="xy").heights, HEIGHTS)
    integers = asperity.prepare(frame(index=150 * np.arange(NY), columns=250 * np.arange(NX)))
    assert integers.lengths == (3000.0, 1200.0) and np.array_equal(integers.heights, HEIGHTS)
    with pytest.raises(ValueError, match="coordinate y is not equidistant"):
        asperity.prepare(frame(index=Y**2))
    with pytest.raises(ValueError, match="coordinate y is not equidistant"):
        asperity.prepare(frame(index=[*Y[:-1], np.nan]))
    with pytest.raises(ValueError, match=r"axes is 'xy', but the dimensions are"):
        asperity.prepare(frame().rename_axis(index="y"), axes="xy")


def test_labels_that_count_are_no_coordinates(frame):
    names = [f"column {n}" for n in range(NX)]
    for index, columns in [(None, None), (None, names), (3 + np.arange(NY), None)]:
        table = frame(index=index, columns=columns)
        found = asperity.prepare(table)
        assert np.array_equal(found.heights, HEIGHTS.T) and found.lengths is None
    part = asperity.prepare(frame(index=None, columns=None).iloc[2:6, 3:9])
    assert np.array_equal(part.heights, HEIGHTS.T[2:6, 3:9]) and part.lengths is None


def test_coordinates_along_one_axis_alone_are_refused_with_the_remedy(frame):
    for table, has, lacks in [
        (frame(columns=None), "index", "columns"),
        (frame(columns=X.astype(str)), "index", "columns"),
        (frame(index=None), "columns", "index"),
    ]:
        with pytest.raises(ValueError, match=rf"coordinates as its {has} .* frame.{lacks}.astype\(float\).*to_numpy"):
            asperity.prepare(table)
    texts = frame(columns=X.astype(str))
    texts.columns = texts.columns.astype(float)
    assert np.array_equal(asperity.prepare(texts).heights, HEIGHTS)


def test_what_goes_with_heights_is_turned_as_they_are(frame):
    xarray = pytest.importorskip("xarray")
    heights = 0.01 * HEIGHTS
    gaps = 0.1 + 0.01 * HEIGHTS
    options = {"modulus": 1.0, "mean_gap": 0.05, "max_iterations": 1}
    with pytest.warns(asperity.ConvergenceWarning):
        expected = asperity.solve(heights, (3.0, 1.2), start=gaps, **options).gap
    falling = frame(gaps[:, ::-1].T, Y[::-1])
    for start in (frame(gaps.T), falling, xarray.DataArray(falling, dims=("y", "x"))):
        with pytest.warns(asperity.ConvergenceWarning):
            assert asperity.solve(frame(heights.T), start=start, **options).gap.tobytes() == expected.tobytes()
    assert asperity.leakage(frame(1 + 0.1 * HEIGHTS.T), 3.0).report == asperity.leakage(1 + 0.1 * HEIGHTS, 3.0).report
    law = asperity.Varying(asperity.Exponential(1.0, 8e-3), falling)
    assert np.array_equal(law.work_of_adhesion, gaps)
