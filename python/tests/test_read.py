"""Heights from files."""

import struct

import numpy as np
import pytest

import asperity


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

    def record(name, *items):
        data = b"".join(items)
        return text(name) + struct.pack("<I", len(data)) + data

    def field(heights):
        nx, ny = heights.shape
        values = heights.T.astype("<f8").tobytes()  # rows along x
        unit = record("GwySIUnit", item("unitstr", "s", text("m")))
        return record(
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
    path.write_bytes(b"GWYP" + record("GwyContainer", *items))


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


def test_masked_points_of_a_file_are_missing(tmp_path):
    with pytest.raises(TypeError, match="masked is of the mask of a .gwy file"):
        asperity.prepare(np.eye(4), 1.0, masked=True)
    np.save(tmp_path / "heights.npy", np.eye(4))
    with pytest.raises(ValueError, match="has no masks"):
        asperity.prepare(tmp_path / "heights.npy", 1.0, masked=True)
