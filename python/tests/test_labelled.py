"""Heights from maps, labelled arrays and tables of other packages, and their axes."""

from functools import partial

import numpy as np
import pandas
import pytest
import xarray

import asperity


def gap(heights, lengths=(1.0, 1.0), **options):
    return asperity.solve(heights, lengths, modulus=1.0, mean_gap=0.01, **options).gap


class Map:
    """A map like those of SurfaceTopography."""

    def __init__(self, heights, physical_sizes, is_periodic, unit=None):
        self._heights, self.physical_sizes, self.is_periodic, self.unit = heights, physical_sizes, is_periodic, unit

    def heights(self):
        return self._heights


def test_a_map_of_surface_topography_brings_its_sizes(rough):
    found = asperity.from_topography(Map(rough.heights, (2.0, 1.0), True, "µm"))
    assert found.lengths == (2.0, 1.0) and found.unit == "µm" and found.periodic
    assert found.heights is rough.heights
    assert gap(Map(rough.heights, (1.0, 1.0), True), None).tobytes() == gap(rough.heights).tobytes()
    line = asperity.from_topography(Map(rough.heights[0], (1.0,), True))
    assert line.shape == (64,) and line.lengths == (1.0, 1.0)
    with pytest.raises(TypeError, match=r"heights\(\)"):
        asperity.from_topography(rough.heights)


def test_a_map_that_is_not_periodic_is_a_warning_until_it_is_made_so(rough):
    measured = Map(np.ma.masked_greater(rough.heights, 0.04), (1.0, 1.0), False)
    with pytest.warns(asperity.InputWarning, match="not periodic"):
        gap(asperity.prepare(measured, fill=True), None)
    mirrored = asperity.prepare(measured, fill=True, mirror=True)
    assert mirrored.shape == (128, 128) and mirrored.lengths == (2.0, 2.0)
    gap(mirrored, None)


def test_a_data_array_brings_its_coordinates(rough):
    x = np.arange(64) / 64

    def data(y=x, unit="m"):
        coords = {name: (name, values, {"units": "m"}) for name, values in (("x", x), ("y", y))}
        return xarray.DataArray(rough.heights, coords, dims=("x", "y"), attrs={"units": unit})

    assert gap(data(), None).tobytes() == gap(rough.heights).tobytes()
    found = asperity.prepare(data())
    assert found.lengths == (1.0, 1.0) and found.unit == "m"
    assert np.array_equal(asperity.prepare(data()[::-1]).heights, rough.heights)
    line = asperity.prepare(data().isel(y=3))
    assert line.shape == (64,) and line.lengths == (1.0, 1.0)
    missing = data().where(data() < data().max())
    assert asperity.prepare(missing).missing == 1 and asperity.prepare(missing, fill=True).missing == 0
    with pytest.raises(ValueError, match="coordinate y is not equidistant"):
        gap(data(x**2), None)
    with pytest.raises(ValueError, match=r"different units \(m, nm\)"):
        gap(data(unit="nm"), None)


def packed(values, kind="<f8", skip=4):
    """The same numbers as a column of a packed record, of which no item lies a whole number of items from the next."""
    table = np.zeros(np.shape(values), np.dtype([("before", f"V{skip}"), ("z", kind)]))
    table["z"] = values
    return table["z"]


VIEWS = [
    packed,
    lambda h: packed(h[::-1, ::-1])[::-1, ::-1],
    lambda h: packed(h.T).T,
    lambda h: packed(h, ">f8"),
    lambda h: packed(h, skip=9),
    lambda h: np.frombuffer(b"odd!" + h.tobytes(), offset=4).reshape(h.shape),
]


@pytest.mark.parametrize("view", VIEWS)
def test_columns_of_packed_records_are_read_right_wherever_an_array_goes(rough, view):
    h = rough.heights
    z = view(h)
    assert np.array_equal(z, h) and not (z.flags.aligned and z.dtype.isnative)
    assert gap(z).tobytes() == gap(h).tobytes()
    if z.dtype.isnative:
        # past the checks of Python
        assert gap(asperity.Topography(z, (1.0, 1.0)), None).tobytes() == gap(h).tobytes()
    core = asperity.surface.statistics(asperity.Topography(h, (1.0, 1.0)))
    assert asperity.surface.statistics(z, 1.0) == core
    assert np.array_equal(asperity.surface.spectrum(z, 1.0).densities, asperity.surface.spectrum(h, 1.0).densities)
    prepared = [asperity.prepare(heights, 1.0, detrend="plane").heights for heights in (z, h)]
    assert np.array_equal(*prepared)
    start = gap(h) + 1e-3
    assert gap(h, start=view(start)).tobytes() == gap(h, start=start).tobytes()
    mirrored = asperity.prepare(h, 1.0, mirror=True)
    whole = asperity.solve(mirrored, modulus=1.0, mean_gap=0.01, start=start).gap
    assert asperity.solve(mirrored, modulus=1.0, mean_gap=0.01, start=view(start)).gap.tobytes() == whole.tobytes()
    works = 1e-5 * (1 + np.abs(h) / h.max())
    laws = [asperity.Varying(asperity.Exponential(1.0, 8e-3), w) for w in (works, view(works))]
    assert np.array_equal(laws[0].work_of_adhesion, laws[1].work_of_adhesion)
    assert laws[0].energy(view(start)).tobytes() == laws[1].energy(start).tobytes()
    law = asperity.Exponential(2e-5, 8e-3)
    for function in (law.energy, law.traction, law.slope):
        assert np.array_equal(function(view(start)), function(start))
    loads = np.abs(h) + 1e-4
    hertz = asperity.exact.Hertz(2.0, 1.0)
    assert np.array_equal(hertz.at_load(view(loads)).approach, hertz.at_load(loads).approach)
    sizes = asperity.contact.clusters(h > 0.01).sizes
    assert np.array_equal(asperity.contact.clusters(packed(h > 0.01, "?", skip=3)).sizes, sizes)


def test_tables_of_packed_records_are_read_right():
    gaps, tractions = np.array([0.0, 1e-9, 2e-9]), np.array([50e6, 25e6, 0.0])
    law = asperity.Tabulated(packed(gaps), packed(tractions))
    assert law == asperity.Tabulated(gaps, tractions) and law.gaps.tolist() == gaps.tolist()


OBLONG = asperity.surface.self_affine((64, 48), (1.0, 0.75), rms_slope=0.1, k_l=4, k_s=10, seed=3).heights


def test_axes_say_which_axis_is_x(rough):
    image = OBLONG.T  # [row, column]: 48 rows along y, of 64 columns along x
    upright = asperity.solve(image.T, (1.0, 0.75), modulus=1.0, mean_pressure=0.01)
    turned = asperity.solve(image, (1.0, 0.75), modulus=1.0, mean_pressure=0.01, axes="yx")
    assert turned.gap.shape == (64, 48) and turned.gap.tobytes() == upright.gap.tobytes()
    assert asperity.prepare(image, 1.0, axes="yx").lengths == (1.0, 0.75)
    assert asperity.prepare(image, 1.0, axes="xy").lengths == (1.0, 64 / 48)
    options = {"modulus": 1.0, "mean_pressures": [0.01], "axes": "yx"}
    assert next(asperity.sweep(image, (1.0, 0.75), **options)).gap.tobytes() == upright.gap.tobytes()
    cycle = asperity.cycle(image, (1.0, 0.75), modulus=1.0, mean_gaps=[0.02, 0.01], axes="yx", steps=2)
    assert next(cycle).solution.gap.shape == (64, 48)
    spectrum = asperity.surface.spectrum(image, (1.0, 0.75), axes="yx")
    assert np.array_equal(spectrum.densities, asperity.surface.spectrum(image.T, (1.0, 0.75)).densities)
    slope = asperity.surface.statistics(image, (1.0, 0.75), axes="yx").rms_slope
    assert slope == asperity.surface.statistics(image.T, (1.0, 0.75)).rms_slope
    with pytest.raises(ValueError, match="axes is 'zx': it must be 'xy'.*or 'yx'"):
        asperity.prepare(image, 1.0, axes="zx")
    for known in (rough, Map(image, (1.0, 1.0), True), "map.npy"):
        with pytest.raises(ValueError, match="axes is 'yx', but a file or a map knows its axes"):
            asperity.prepare(known, axes="yx")


def test_dimensions_that_are_named_say_which_axis_is_x():
    x, y = np.arange(64) / 64, np.arange(48) / 64
    data = xarray.DataArray(OBLONG, dims=("x", "y"), coords={"x": x, "y": y})
    upright = gap(data, None)
    for turned in (data.T, data.T.rename(x="X", y="Y"), data.T.rename(y="row"), data.T[::-1]):
        assert asperity.prepare(turned).lengths == (1.0, 0.75)
        assert gap(turned, None).tobytes() == upright.tobytes(), turned.dims
    image = data.T.rename(x="column", y="row")
    assert asperity.prepare(image).lengths == (0.75, 1.0)
    assert gap(image, None, axes="yx").tobytes() == upright.tobytes()
    assert gap(data, None, axes="xy").tobytes() == upright.tobytes()
    with pytest.raises(ValueError, match=r"axes is 'xy', but the dimensions are \('y', 'x'\)"):
        asperity.prepare(data.T, axes="xy")
    # starts and works of adhesion, too
    start = np.linspace(0.01, 0.02, 64)[:, None] * np.ones(48)
    assert gap(data, None, start=data.T * 0 + start.T).tobytes() == gap(data, None, start=start).tobytes()
    law = asperity.Varying(asperity.Exponential(1.0, 8e-3), abs(data.T))
    assert np.array_equal(law.work_of_adhesion, np.abs(OBLONG))


def test_tables_and_labelled_arrays_are_taken_or_refused_in_words():
    heights = np.add.outer(np.arange(6.0) ** 2, np.arange(4.0))
    frame = pandas.DataFrame(heights)
    for other in (frame.astype(object), frame.astype("Int64")):
        assert np.array_equal(asperity.prepare(other, 1.0), heights)
    missing = frame.astype("Int64")
    missing.iloc[1, 1] = pandas.NA
    assert asperity.prepare(missing, 1.0).missing == 1
    points = pandas.DataFrame([(z, x / 2, y / 2) for (x, y), z in np.ndenumerate(heights)], columns=["z", "X", "y"])
    with pytest.raises(ValueError, match=r"frame\.pivot\(index='X', columns='y', values='z'\)"):
        asperity.prepare(points)
    pivoted = asperity.prepare(points.pivot(index="X", columns="y", values="z"))
    assert np.array_equal(pivoted, heights) and pivoted.lengths == (3.0, 2.0)
    with pytest.warns(asperity.InputWarning, match="axes: columns 2 and 3 are the coordinates of a grid"):
        asperity.prepare(points.to_numpy())
    solution = asperity.solve(0.001 * heights, 1.0, modulus=1.0, mean_pressure=0.01)
    of = partial(xarray.DataArray, heights, dims=("x", "y"))
    x, y = np.arange(6.0), np.arange(4.0)
    for heights_of, expected in {
        lambda: solution.to_xarray(): "xarray.Dataset: give one of its variables, .*gap",
        lambda: pandas.DataFrame([["a", 1], ["b", 2]]): "no array of real numbers",
        lambda: of(coords={"x": x}): "none along y",
        lambda: of(coords={"x": x, "y": 0 * y}): "coordinate y is not equidistant",
        lambda: of(coords={"x": x, "y": list("abcd")}): "coordinate y is an array of <U1",
        lambda: [[1, 2], [3]]: "no array of real numbers",
    }.items():
        with pytest.raises((TypeError, ValueError), match=expected):
            asperity.prepare(heights_of())
