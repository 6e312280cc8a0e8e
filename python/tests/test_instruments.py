"""Files of instruments, which the package SurfaceTopography reads, and the command that converts them."""

import sys
import warnings
from types import SimpleNamespace

import numpy as np
import pytest

import asperity
from asperity import __main__
from asperity.maps import instruments

HEIGHTS = 1e-9 * np.random.default_rng(1).normal(size=(12, 8))
MISSING = np.ma.masked_array(HEIGHTS, HEIGHTS == HEIGHTS[3, 5])
#: A map of 64 x 64 numbers for a reader that takes the size of a file for a sign.
UNKNOWN = bytes(2 * 64 * 64)


@pytest.fixture
def surface_topography():
    with warnings.catch_warnings():
        # of MPI
        warnings.simplefilter("ignore", ImportWarning)
        return pytest.importorskip("SurfaceTopography")


@pytest.fixture
def scan(surface_topography):
    """A map of SurfaceTopography with a missing point, as an image: lines from the top."""
    return surface_topography.Topography(MISSING, (3e-6, 1.2e-6), unit="m")


@pytest.fixture
def without(monkeypatch):
    """As if SurfaceTopography were not installed."""
    for name in ("SurfaceTopography", "SurfaceTopography.IO"):
        monkeypatch.setitem(sys.modules, name, None)


def test_a_map_of_an_instrument_is_that_of_gwyddion(tmp_path, surface_topography, scan):
    surface_topography.Topography(HEIGHTS, (3e-6, 1.2e-6), unit="m").to_gwy(str(tmp_path / "scan.gwy"))
    scan.to_x3p(tmp_path / "scan.x3p")
    own, found = (asperity.read(tmp_path / f"scan.{ending}") for ending in ("gwy", "x3p"))
    assert np.array_equal(np.isnan(found.heights), MISSING.mask[:, ::-1])
    assert np.allclose(np.where(np.isnan(found.heights), own.heights, found.heights), own.heights, rtol=1e-15, atol=0)
    assert found.lengths == pytest.approx(own.lengths, rel=1e-15) == (3e-6, 1.2e-6)
    assert (found.unit, found.source, found.periodic) == ("m", str(tmp_path / "scan.x3p"), False)


def test_every_function_takes_such_a_file(tmp_path, scan):
    path = tmp_path / "scan.x3p"
    scan.to_x3p(path)
    made = asperity.prepare(str(path), fill=True, mirror=True)
    assert made.shape == (24, 16) and made.source == str(path)
    assert asperity.surface.statistics(asperity.prepare(path, fill=True)).rms_height == pytest.approx(1e-9, rel=0.2)
    with pytest.raises(ValueError, match="1 of 12 x 8 heights are missing"):
        asperity.solve(path, modulus=1e9, mean_pressure=1e6)


def test_coordinates_of_arrays_are_kept_and_units_become_metres(tmp_path, surface_topography):
    scan = surface_topography.Topography(1e9 * MISSING, (3000.0, 1200.0), unit="nm", periodic=True)
    scan.to_netcdf(tmp_path / "scan.nc")
    found = asperity.read(tmp_path / "scan.nc")
    assert np.allclose(found.heights, MISSING.filled(np.nan), rtol=1e-12, atol=0, equal_nan=True)
    assert found.lengths == pytest.approx((3e-6, 1.2e-6), rel=1e-6) and (found.unit, found.periodic) == ("m", True)


def test_a_channel_is_chosen_by_number_or_name(tmp_path, surface_topography):
    h5py = pytest.importorskip("h5py")
    path = tmp_path / "maps.h5"
    with h5py.File(path, "w") as file:
        file["first"], file["second"] = HEIGHTS, 2 * HEIGHTS
    with pytest.raises(ValueError, match=r'0 "first", 1 "second": choose one, by asperity.read\(path, channel=NUMBER\)'):
        asperity.read(path)
    for channel, factor in [(0, 1), ("first", 1), (1, 2), ("1", 2), ("second", 2)]:
        found = asperity.read(path, channel)
        assert np.array_equal(found.heights, factor * HEIGHTS) and (found.lengths, found.unit) == (None, None)
    for channel in (2, -1, "third"):
        with pytest.raises(ValueError, match=f'channel "{channel}" is not one of these'):
            asperity.read(path, channel)


def test_what_is_no_height_is_no_channel():
    def channel(index, name, unit="nm", is_height=True):
        return SimpleNamespace(index=index, name=name, unit=unit, is_height_channel=is_height)

    height, phase, error = channel(0, "Z"), channel(1, "Phase", is_height=False), channel(2, "Error", ("nm", None))
    assert instruments._choose([height, phase, error], None, "scan.spm") is height
    for asked in (1, "Phase", 2, "Error"):
        with pytest.raises(ValueError, match='scan.spm: holds 3 channels, of heights are 0 "Z", and channel'):
            instruments._choose([height, phase, error], asked, "scan.spm")
    with pytest.raises(ValueError, match="none of them of heights"):
        instruments._choose([phase, error], None, "scan.spm")


def test_the_package_is_named_where_it_may_help(tmp_path, without):
    for name, start in [("a.tif", b"II*\0"), ("b.sur", b"DIGITAL SURF\0"), ("c.zon", b"KPK0"), ("d.dat", b"\5")]:
        path = tmp_path / name
        path.write_bytes(start + UNKNOWN)
        with pytest.raises(ValueError, match=rf"{name}: is .*pip install 'asperity\[instruments\]'"):
            asperity.read(path)
        with pytest.raises(ValueError, match="instruments"):
            asperity.prepare(path)


def test_a_named_format_is_tried_whatever_its_bytes_are(tmp_path, surface_topography):
    path = tmp_path / "scan.spm"
    path.write_bytes(b"\\*File list\r\n\\Version: 1\r\n")
    with pytest.raises(ValueError, match="is a Nanoscope file.*; SurfaceTopography does not read it either: "):
        asperity.read(path)


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("rows.txt", b"1 2 3\n4 5\n"),
        ("points.xyz", b"0 0 1\n1 0 2\n0 1\n"),
        ("utf16.txt", "no numbers\n".encode("utf-16")),
        ("short.npy", b"\x93NUMPY\1\0" + UNKNOWN),
        ("short.npz", b"PK\3\4" + UNKNOWN),
        ("short.gwy", b"GWYP" + UNKNOWN),
    ],
)
def test_texts_and_own_formats_are_refused_by_asperity_alone(tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError) as refused:
        asperity.read(tmp_path / name)
    assert "SurfaceTopography" not in str(refused.value) and "pip" not in str(refused.value)


def test_a_file_that_nothing_reads_keeps_its_refusal(tmp_path, scan):
    (tmp_path / "unknown.bin").write_bytes(UNKNOWN)
    with pytest.raises(ValueError, match="is a binary file.*SurfaceTopography does not read it either: the format is"):
        asperity.read(tmp_path / "unknown.bin")
    scan.to_x3p(tmp_path / "scan.x3p")
    (tmp_path / "scan.x3p").write_bytes((tmp_path / "scan.x3p").read_bytes()[:-40])
    with pytest.raises(ValueError, match="SurfaceTopography does not read it either"):
        asperity.read(tmp_path / "scan.x3p")
    with pytest.raises(FileNotFoundError, match="does not exist"):
        asperity.read(tmp_path / "none.x3p")
    with pytest.raises(ValueError, match="is a folder"):
        asperity.read(tmp_path)


@pytest.fixture
def convert(tmp_path, monkeypatch, capsys):
    """Runs the command in the folder of the test: its exit code, output and errors."""

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["asperity", "convert", *arguments])
        return __main__.main(), *capsys.readouterr()

    monkeypatch.chdir(tmp_path)
    return run


def test_convert_writes_what_read_reads(tmp_path, scan, convert):
    scan.to_x3p(tmp_path / "scan.x3p")
    found = asperity.read(tmp_path / "scan.x3p")
    for ending, precision in [("npz", 0), ("npy", 0), ("gsf", 1e-7)]:
        code, said, errors = convert("scan.x3p", f"scan.{ending}")
        assert (code, errors) == (0, "") and said.startswith("written  Topography(12 x 8 heights, 1 missing, 3 µm x")
        again = asperity.read(tmp_path / f"scan.{ending}")
        assert np.allclose(again.heights, found.heights, rtol=precision, atol=0, equal_nan=True)
        if ending != "npy":
            assert again.lengths == pytest.approx(found.lengths, rel=1e-15) and again.unit == "m"


def test_convert_refuses_on_one_line(tmp_path, convert):
    np.save(tmp_path / "map.npy", HEIGHTS)
    (tmp_path / "taken.npz").write_bytes(b"kept")
    (tmp_path / "words.txt").write_text("no numbers\n")
    for arguments, message in [
        (["map.npy", "taken.npz"], "exists: use --force"),
        (["map.npy", "map.txt"], "choose .npz, .npy or .gsf"),
        (["none.npy", "out.npz"], "does not exist"),
        (["words.txt", "out.npz"], "words.txt: "),
        (["map.npy"], "required: OUT"),
        (["map.npy", "out.npz", "--chanel", "1"], "unrecognized arguments: --chanel"),
    ]:
        code, said, errors = convert(*arguments)
        assert (code, said) == (1, "") and errors.startswith("error: ") and message in errors
        assert errors.count("\n") == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["map.npy", "taken.npz", "words.txt"]
    assert (tmp_path / "taken.npz").read_bytes() == b"kept"
    assert convert("map.npy", "taken.npz", "--force")[0] == 0
    assert np.array_equal(asperity.read(tmp_path / "taken.npz").heights, HEIGHTS)
