"""Heights from arrays of all kinds, and from the objects of other packages."""

import inspect
import pickle
import struct
import warnings
from functools import partial

import numpy as np
import pandas
import pytest
import xarray

import asperity


def gap(heights, lengths=(1.0, 1.0), **options):
    return asperity.solve(heights, lengths, modulus=1.0, mean_gap=0.01, **options).gap


@pytest.mark.parametrize(
    "same",
    [
        np.asfortranarray,
        lambda h: h.T.copy().T,
        lambda h: np.repeat(np.repeat(h, 2, 0), 3, 1)[::2, ::3],
        lambda h: h[::-1, ::-1].copy()[::-1, ::-1],
        lambda h: h.astype(">f8"),
        lambda h: h.astype(np.longdouble),
        lambda h: h.tolist(),
        lambda h: np.ma.masked_array(h, mask=False),
    ],
)
def test_any_order_stride_and_float_type_gives_the_same_bits(rough, same):
    assert gap(same(rough.heights)).tobytes() == gap(rough.heights).tobytes()


def test_single_precision_and_integers_are_taken_as_they_are(rough):
    single = rough.heights.astype(np.float32)
    assert gap(single).tobytes() == gap(single.astype(np.float64)).tobytes()
    steps = np.round(1000 * rough.heights).astype(np.int16)
    assert gap(steps, (1000.0, 1000.0)).tobytes() == gap(steps.astype(float), (1000.0, 1000.0)).tobytes()


def test_heights_are_neither_changed_nor_held(rough):
    heights = rough.heights.copy()
    heights.flags.writeable = False
    assert gap(heights).shape == (64, 64) and np.array_equal(heights, rough.heights)
    reused = heights.copy()
    contact = asperity.Contact(reused, 1.0, modulus=1.0)
    solutions = [asperity.solve(reused, 1.0, modulus=1.0, mean_pressure=0.01), contact.solve(mean_pressure=0.01)]
    reused *= 2.0
    solutions.append(next(contact.sweep(mean_pressures=[0.01])))
    for solution in solutions:
        assert np.array_equal(solution.heights, heights) and np.array_equal(solution.gap, solutions[0].gap)


def test_missing_points_are_refused_with_the_remedy(rough):
    heights = rough.heights.copy()
    heights[3, 5] = np.nan
    for missing in (heights, np.ma.masked_invalid(heights), np.ma.masked_array(rough.heights, np.isnan(heights))):
        with pytest.raises(ValueError, match=r"1 of 64 x 64 heights .* at index \[3, 5\].*asperity.prepare\(fill=True"):
            gap(missing)
        with pytest.raises(ValueError, match="or treat them as absent nodes by absent_missing=True"):
            gap(missing)
        filled = asperity.prepare(missing, 1.0, fill=True)
        assert filled.missing == 0 and np.isfinite(gap(filled, None)).all()


def test_what_is_no_map_of_numbers_is_refused():
    for heights in (np.zeros((3, 3), complex), [["a"]], [None], np.zeros((2, 2), "M8[s]")):
        with pytest.raises(TypeError, match="real numbers"):
            gap(heights)
    for heights in (0.0, np.zeros((2, 2, 2)), np.zeros((0, 3)), []):
        with pytest.raises(ValueError, match="have shape"):
            gap(heights)


@pytest.mark.filterwarnings("ignore:open-edges")
def test_one_length_means_square_cells(rough):
    assert asperity.prepare(rough.heights[:, :32], 1.0).lengths == (1.0, 0.5)
    assert asperity.surface.self_affine((64, 32), 1.0, rms_slope=0.1, k_s=8).lengths == (1.0, 0.5)


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


class DataArray:
    """An array with coordinates, like xarray's."""

    def __init__(self, values, coords, attrs=None, units=None):
        self.values, self.dims, self.attrs = values, tuple(coords), attrs or {}
        self.coords = {name: Coordinate(values, units) for name, values in coords.items()}


class Coordinate:
    def __init__(self, values, units):
        self.values, self.attrs = np.asarray(values), {"units": units} if units else {}


def test_a_data_array_brings_its_coordinates(rough):
    x = (np.arange(64) + 0.5) / 64
    data = DataArray(rough.heights, {"x": x, "y": x}, {"units": "m"}, "m")
    assert np.allclose(asperity.prepare(data).lengths, (1.0, 1.0), rtol=1e-14) and asperity.prepare(data).unit == "m"
    falling = DataArray(rough.heights[::-1], {"x": x[::-1], "y": x})
    assert np.array_equal(asperity.prepare(falling).heights, rough.heights)
    with pytest.raises(ValueError, match="coordinate y is not equidistant"):
        gap(DataArray(rough.heights, {"x": x, "y": x**2}), None)
    with pytest.raises(ValueError, match=r"different units \(m, nm\)"):
        gap(DataArray(rough.heights, {"x": x, "y": x}, {"units": "nm"}, "m"), None)


def test_a_data_array_of_xarray_gives_the_same_bits(rough):
    xarray = pytest.importorskip("xarray")
    x = np.arange(64) / 64
    data = xarray.DataArray(rough.heights, dims=("x", "y"), coords={"x": x, "y": x}, attrs={"units": "m"})
    assert gap(data, None).tobytes() == gap(rough.heights).tobytes()
    assert asperity.prepare(data).unit == "m"
    line = asperity.prepare(data.isel(y=3))
    assert line.shape == (64,) and line.lengths == (1.0, 1.0)
    missing = data.where(data < data.max())
    assert asperity.prepare(missing).missing == 1 and asperity.prepare(missing, fill=True).missing == 0


def test_texts_are_read_by_what_is_said_of_them(tmp_path):
    def read(text, **kwargs):
        path = tmp_path / "map.txt"
        path.write_text(text, encoding="utf-8")
        return asperity.read(path, **kwargs)

    header = "# Kanal: {}\n# Breite: 3 µm\n# Höhe: 2000 nm\n# Einheiten: nm\n"
    text = header.format("Topo") + "1 2 4\n4 6 3\n" + header.format("zurück") + "9 2 1\n4 6 3\n"
    with pytest.raises(ValueError, match=r'2 channels \(0 "Topo", 1 "zurück"\).*asperity.read\(path, channel=NUMBER\)'):
        read(text)
    second = read(text, channel="zurück")
    assert second.heights[0, 1] == 9e-9 and second.lengths == (3e-6, 2e-6) and second.log == ('also in the file: 0 "Topo"',)

    words = "Height\nof a tip\n1 2 lost\n4 7 6\n"
    with pytest.raises(ValueError, match=r"asperity.read\(path, missing_words=...\), here \"lost\""):
        read(words)
    with pytest.raises(ValueError, match=r"asperity.read\(path, skip_lines=...\), here 2"):
        read(words, missing_words="lost")
    tip = read(words, missing_words="lost", skip_lines=2)
    assert tip.heights.shape == (2, 3) and np.isnan(tip.heights[0, 2])
    with pytest.raises(ValueError, match="has no masks"):
        read(words, masked=True)
    assert read("# Weite: 3 um\n1 2\n3 4\n").log == ("also in the file: Weite: 3 um",)


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


def test_files_are_read_with_what_belongs_to_them(tmp_path, rough):
    path = tmp_path / "heights.npz"
    np.savez(path, heights=rough.heights, lengths=(2.0, 2.0), unit="m")
    found = asperity.read(path)
    assert np.array_equal(found.heights, rough.heights) and found.lengths == (2.0, 2.0) and found.unit == "m"
    assert asperity.solve(found, modulus=1.0, mean_gap=0.01).report["heights"] == str(path)
    with pytest.raises(FileNotFoundError, match="does not exist"):
        asperity.read(tmp_path / "none.npy")
    (tmp_path / "no.npy").write_text("nothing")
    with pytest.raises(ValueError, match="no.npy"):
        asperity.read(tmp_path / "no.npy")


def gwy(path, *channels):
    """Writes a file of Gwyddion with channels, each a title with heights in m."""

    def item(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + data

    def text(value):
        return value.encode() + b"\0"

    def of(name, *items):
        data = b"".join(items)
        return text(name) + struct.pack("<I", len(data)) + data

    def field(heights):
        nx, ny = heights.shape
        values = heights.T.astype("<f8").tobytes()  # rows along x
        unit = of("GwySIUnit", item("unitstr", "s", text("m")))
        return of(
            "GwyDataField",
            item("xres", "i", struct.pack("<i", nx)),
            item("yres", "i", struct.pack("<i", ny)),
            item("xreal", "d", struct.pack("<d", 1e-6)),
            item("yreal", "d", struct.pack("<d", 2e-6)),
            item("si_unit_xy", "o", unit),
            item("si_unit_z", "o", unit),
            item("data", "D", struct.pack("<I", nx * ny) + values),
        )

    items = []
    for number, (title, heights) in enumerate(channels):
        items.append(item(f"/{number}/data", "o", field(heights)))
        items.append(item(f"/{number}/data/title", "s", text(title)))
    path.write_bytes(b"GWYP" + of("GwyContainer", *items))


def test_a_channel_of_several_is_chosen_by_number_or_title(tmp_path):
    trace = 1e-9 * np.arange(12.0).reshape(3, 4)
    path = tmp_path / "scan.gwy"
    gwy(path, ("Trace", trace), ("Retrace", 2 * trace))
    with pytest.raises(ValueError, match=r'1 "Retrace".*choose one, by asperity.read\(path, channel=NUMBER\)'):
        asperity.read(path)
    for channel, factor in [(0, 1), ("Trace", 1), (1, 2), ("Retrace", 2)]:
        found = asperity.read(path, channel=channel)
        assert found.lengths == (1e-6, 2e-6) and found.unit == "m"
        assert np.array_equal(np.sort(found.heights, axis=None), np.sort(factor * trace, axis=None))
    with pytest.raises(ValueError, match="2 channels"):
        asperity.read(path, channel=7)
    np.save(tmp_path / "heights.npy", trace)
    with pytest.raises(ValueError, match="has no channels"):
        asperity.read(tmp_path / "heights.npy", channel=0)


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
    xarray = pytest.importorskip("xarray")
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


def test_maps_beyond_the_memory_are_an_error():
    endless = np.broadcast_to(np.zeros(1), (2**20, 2**20))
    small = np.random.default_rng(1).normal(size=(16, 16))
    for ask in (
        lambda: asperity.solve(endless, 1.0, modulus=1.0, mean_gap=1.0),
        lambda: asperity.surface.statistics(endless, 1.0),
        lambda: asperity.prepare(endless, 1.0),
        lambda: asperity.prepare(small, 1.0, resample=(2**20, 2**20)),
        lambda: asperity.surface.self_affine(2**20, 1.0, rms_slope=0.1),
    ):
        with pytest.raises(MemoryError, match="1048576 x 1048576 nodes takes .* GiB"):
            ask()


def test_threads_are_as_many_as_in_the_tool(rough):
    for threads in (0, 1025, 10**9):
        with pytest.raises(ValueError, match=f"threads is {threads}: it must be from 1 to 1024"):
            gap(rough, None, threads=threads)


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
def test_a_step_that_is_wrong_is_told_with_its_value(steps, message):
    with pytest.raises(ValueError, match=message):
        asperity.prepare(OBLONG, 1.0, **steps)


def test_a_code_may_be_a_text():
    coded = np.where(OBLONG > 0, OBLONG, -9999.0)
    by_text, by_number = (asperity.prepare(coded, 1.0, missing=code).heights for code in ("-9999", -9999))
    assert np.array_equal(by_text, by_number, equal_nan=True) and np.isnan(by_text).any()


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda h: asperity.solve(h, modulus=1.0, mean_pressures=[1.0]), "give mean_pressure, .* asperity.sweep"),
        (lambda h: asperity.sweep(h, modulus=1.0, mean_gap=0.1), r"give mean_gaps=\[...\], or one load to asperity.solve"),
        (lambda h: asperity.solve(h, modulus=1.0, pressure=1.0), r"solve\(\) .* pressure: did you mean mean_pressure"),
        (lambda h: asperity.cycle(h, modulus=1.0, gap=[1.0]), "has no keyword gap: did you mean mean_gaps"),
        (lambda h: asperity.solve(h, E=1.0, mean_gap=1.0), "did you mean modulus"),
        (lambda h: asperity.solve(h, modulus=1.0, mean_gap=1.0, tolerence=1.0), "did you mean tolerance"),
        (lambda h: asperity.solve(h, modulus=1.0, mean_gap=1.0, initial_gap=h), "did you mean start"),
        (lambda h: asperity.sweep(h, modulus=1.0, indentation=[1.0]), "did you mean approaches"),
        (lambda h: asperity.prepare(h, detrand="plane"), r"prepare\(\) has no keyword detrand: did you mean detrend"),
        (lambda h: asperity.Exponential(work_of_adhesion=1.0, rho=1.0), r"Exponential\(\) .* rho: did you mean range"),
        (lambda h: asperity.VanDerWaals(A=1.0, range=1.0), r"VanDerWaals\(\) has no keyword A: did you mean hamaker"),
        (lambda h: asperity.Morse(1.0, None), r"Morse\(\) is without range"),
        (lambda h: asperity.Morse(1.0, 1.0, colour=1.0), "it has work_of_adhesion, range"),
    ],
)
def test_a_keyword_that_is_wrong_is_told_by_the_right_one(rough, ask, message):
    with pytest.raises(TypeError, match=message):
        ask(rough)


def test_functions_of_the_package_travel_to_other_processes():
    for function in (asperity.solve, asperity.sweep, asperity.cycle, asperity.prepare, asperity.stability):
        assert pickle.loads(pickle.dumps(function)) is function
        assert "Parameters" in function.__doc__ and "kwargs" not in inspect.signature(function).parameters


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


def test_one_length_of_a_topography_means_square_cells():
    heights = np.random.default_rng(1).normal(size=(16, 8)) * 1e-3
    topography = asperity.Topography(heights, 1.0)
    assert topography.lengths == (1.0, 0.5) and asperity.Topography(heights[:, 0], 2.0).lengths == (2.0, 2.0)
    assert asperity.solve(topography, modulus=1.0, mean_pressure=1e-3).converged
    for line in (heights[:, 0], heights[:, 0].tolist()):
        gap = asperity.solve(asperity.Topography(line, 2.0), modulus=1.0, mean_pressure=1e-3).gap
        assert gap.tobytes() == asperity.solve(line, 2.0, modulus=1.0, mean_pressure=1e-3).gap.tobytes()
    with pytest.raises(ValueError, match="they must be .Lx, Ly., or Lx alone"):
        asperity.Topography(heights, (1.0, 2.0, 3.0))


def test_no_message_prints_an_array(rough):
    big = np.ones((32, 32))
    solve = partial(asperity.solve, rough, modulus=1.0)
    for call, expected in {
        lambda: solve(mean_pressure=0.1, law="exponential", work_of_adhesion=big, range=1.0): r"Varying\(law, works\)",
        lambda: solve(mean_pressure=0.1, law="exponential", work_of_adhesion=[1.0] * 999, range=1.0): "4993 characters",
        lambda: solve(mean_pressure=big): r"mean_pressure is an array of shape \(32, 32\)",
        lambda: solve(mean_pressure=0.1, body=big): "body is an array of shape .*: it must be an asperity.Layer",
        lambda: solve(spring=big): "spring is an array of shape",
        lambda: asperity.Layer(big, 0.3): "thickness is an array of shape",
        lambda: asperity.prepare(big, 1.0, resample=big): "resample is a list of lists",
    }.items():
        with pytest.raises((TypeError, ValueError), match=expected) as refused:
            call()
        assert len(str(refused.value)) < 250


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


def test_masked_points_of_a_file_are_missing(tmp_path):
    with pytest.raises(TypeError, match="masked is of the mask of a .gwy file"):
        asperity.prepare(np.eye(4), 1.0, masked=True)
    np.save(tmp_path / "heights.npy", np.eye(4))
    with pytest.raises(ValueError, match="has no masks"):
        asperity.prepare(tmp_path / "heights.npy", 1.0, masked=True)


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
