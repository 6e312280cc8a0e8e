"""Heights from arrays of all kinds, and from the objects of other packages."""

import struct

import numpy as np
import pytest

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


def test_missing_points_are_refused_with_the_remedy(rough):
    heights = rough.heights.copy()
    heights[3, 5] = np.nan
    for missing in (heights, np.ma.masked_invalid(heights), np.ma.masked_array(rough.heights, np.isnan(heights))):
        with pytest.raises(ValueError, match=r"1 of 4096 nodes .* at index \[3, 5\].*asperity.prepare\(.*fill=True"):
            gap(missing)
        with pytest.raises(ValueError, match="or take them for absent nodes by absent_missing=True"):
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


def test_prepare_takes_the_steps_of_the_tool():
    rng = np.random.default_rng(1)
    tilted = rng.normal(size=(40, 30)) + 5 * np.arange(40)[:, None]
    made = asperity.prepare(
        tilted, (40.0, 30.0), scale=1e-9, crop=(4, 2, 32, 24), flip=True, detrend="plane", window=0.2
    )
    assert made.shape == (32, 24) and made.lengths == (32.0, 24.0) and made.missing == 0
    assert np.abs(made.heights).max() < 1e-8
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
    x, y = np.meshgrid(np.arange(40) - 20, np.arange(30) - 15, indexing="ij")
    ball = asperity.prepare(np.sqrt(90.0**2 - x**2 - y**2), (40.0, 30.0), remove_form="sphere")
    assert np.abs(ball.heights).max() < 1e-9
    for wrong in [{"align_rows": "mode"}, {"scan_axis": "z"}, {"remove_form": "cone"}, {"detrend": 13}]:
        with pytest.raises(ValueError):
            asperity.prepare(tilted, (40.0, 30.0), **wrong)


def test_a_number_with_a_unit_is_refused_by_its_name(rough):
    for wrong in ({"modulus": "70GPa"}, {"mean_gap": "1nm"}, {"mean_gap": None, "spring": ("2N/m", 0.0)}):
        options = {"modulus": 1.0, "mean_gap": 0.01, **wrong}
        with pytest.raises(TypeError, match=r"(modulus|mean_gap|stiffness of the spring) is '.*': it must be a number"):
            asperity.solve(rough, **options)
