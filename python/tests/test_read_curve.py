"""Files of force curves are read into the SI, or refused with a reason on one line."""

import sys

import numpy as np
import pytest

import asperity
from asperity.curves.branches import order_branches
from force_curves import curve

Z, FORCE = np.array([-10.5, 0.25, 2.0]), np.array([-0.5, 0.25, 3.5])

#: Texts of these numbers.
TEXTS = {
    "tabs": "Height (nm)\tForce [nN]\n-10.5\t-0.5\n0.25\t0.25\n2\t3.5\n",
    "csv": '"Time (s)","Height (nm)","Deflection (V)","Force (nN)"\n0,-10.5,1,-0.5\n1,0.25,1,0.25\n2,2,1,3.5\n',
    "decimal commas": "Messung vom Montag\n\nWeg (nm);Kraft (nN)\n-10,5;-0,5\n0,25;0,25\n2;3,5\n",
    "spaces and decimal commas": "Height (pm)  Vertical deflection (pN)\n-10500,0 -500,0\n250,0 250,0\n2000,0 3500,0\n",
    "units below": "z, F\nnm, nN\n-10.5, -0.5\n0.25, 0.25\n2.0, 3.5\n",
    "micrometres": "Höhe (µm)\tKraft (nN)\n-0,0105\t-0,5\n0,00025\t0,25\n0,002\t3,5\n",
    "slashes": "z/nm;F/nN\n-10.5;-0.5\n0.25;0.25\n2;3.5\n",
    "two segments that fall towards contact": "# speed: 1\n# columns: height force\n# units: m N\n"
    "1.05e-8 -5e-10\n-2.5e-10 2.5e-10\n\n# segment: retract\n# columns: height force\n-2e-9 3.5e-9\n",
}


@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "cp1252"])
def test_texts_are_read(name, encoding, tmp_path):
    path = tmp_path / "curve.txt"
    path.write_text(TEXTS[name], encoding=encoding)
    z, force = asperity.read_curve(path)
    assert z == pytest.approx(1e-9 * Z, rel=1e-12) and force == pytest.approx(1e-9 * FORCE, rel=1e-12)


def test_columns_are_chosen(tmp_path):
    path = tmp_path / "curve.txt"
    path.write_text("Height (nm)\tTip (nm)\tForce (nN)\n0\t1\t2\n1\t3\t4\n")
    with pytest.raises(ValueError, match="columns 'Height' in nm, 'Tip' in nm, 'Force' in nN: it is not clear which is z"):
        asperity.read_curve(path)
    for z in ("Tip", 1):
        assert asperity.read_curve(path, z=z).z == pytest.approx([1e-9, 3e-9])
    with pytest.raises(ValueError, match="none of them alone is 'Piezo'"):
        asperity.read_curve(path, z="Piezo")
    with pytest.raises(ValueError, match="column 'Tip' is in nm, and not in a unit of force: give another force"):
        asperity.read_curve(path, z=0, force="Tip")
    path.write_text("0 1\n2 3\n")
    with pytest.raises(ValueError, match="column '' has no unit of length: give length_unit"):
        asperity.read_curve(path)
    assert asperity.read_curve(path, length_unit="um", force_unit="nN").z == pytest.approx([0.0, 2e-6])
    path.write_text("z (nm)\tDeflection (nm)\n0\t1\n1\t2\n")
    with pytest.raises(ValueError, match="column 'Deflection' is in nm, and not in nN: .* spring_stiffness, by which"):
        asperity.read_curve(path, z=0, force=1, force_unit="nN")
    for stiffness in (0.5, "0.5N/m"):
        assert asperity.read_curve(path, z=0, spring_stiffness=stiffness).force == pytest.approx([0.5e-9, 1e-9])
    path.write_text("z (nm)\tSensor (V)\n0\t1\n1\t2\n")
    with pytest.raises(ValueError, match="column 'Sensor' is in V: give sensitivity, too"):
        asperity.read_curve(path, spring_stiffness=0.5)
    with pytest.raises(ValueError, match="sensitivity is '50nm': it must be a length per V, as '50nm/V'"):
        asperity.read_curve(path, spring_stiffness=0.5, sensitivity="50nm")
    volts = asperity.read_curve(path, spring_stiffness="0.5N/m", sensitivity="50nm/V")
    assert volts.force == pytest.approx([25e-9, 50e-9])
    path.write_text("z (nm)\tF (nN)\n0\t1\n1\t2\n")
    with pytest.raises(ValueError, match="column 'F' is in nN, and not in N: leave force_unit out"):
        asperity.read_curve(path, force_unit="N")
    assert asperity.read_curve(path, force_unit="nN").force == pytest.approx([1e-9, 2e-9])
    path.write_text("z (nm)\tF (nN)\n0\tnan\n1\t2\n")
    assert np.array(asperity.read_curve(path)) == pytest.approx(1e-9 * np.array([[1.0], [2.0]]))


@pytest.mark.parametrize("layout", [(1, 1, 1), (1, 1, -1), (1, -1, 1), (1, -1, -1), (-1, 1, 1), (-1, 1, -1)])
def test_the_approach_comes_first_whatever_the_order_of_a_file(layout, tmp_path):
    there, back, order = layout
    made = np.array(curve(1.0, 20.0, noise=0.005))
    branches = [made[:, :200][:, ::there], made[:, 200:][:, ::back]][::order]
    path = tmp_path / "curve.csv"
    heading = {"delimiter": ",", "header": "Height (nm),Force (nN)", "comments": ""}
    np.savetxt(path, 1e9 * np.hstack(branches).T, "%.6f", **heading)
    assert np.array(asperity.read_curve(path)) == pytest.approx(made, abs=1e-15)
    # backwards in time the withdrawal looks like an approach
    assert order_branches(*made)[2] == ""
    told = "branches: the force falls by 5e-09 as z grows, and by 4.27e-09 as it falls"
    assert order_branches(*made[:, ::-1])[2].startswith(told)


def test_pauses_are_left_out_and_told(tmp_path):
    path, z, force = tmp_path / "curve.csv", *curve(None, 20.0, noise=0.01)
    top = np.linspace(z[199], z[199] + 0.1 * np.ptp(z), 80)
    where, load = np.insert(z, 200, top), np.insert(force, 200, np.full(80, force[199]))
    told = "pause: 80 of 480 points of .* are of a pause"
    for names in (("0", "1", "2"), ("approach", "pause", "retract"), ("Extend", "Hold", "Withdraw")):
        parts = np.repeat(names, [200, 80, 200])
        rows = "".join(f"{a:.9g},{b:.9g},{part}\n" for a, b, part in zip(1e9 * where, 1e9 * load, parts))
        path.write_text("Height (nm),Force (nN),Segment\n" + rows)
        with pytest.warns(asperity.InputWarning, match=told):
            found = asperity.read_curve(path)
        assert np.array(found) == pytest.approx(np.array([z, force]), rel=1e-7)
    # a position that is held, without a word
    where[200:280] = where[199]
    np.savetxt(path, 1e9 * np.array([where, load]).T, header="z (nm),F (nN)", delimiter=",", comments="")
    with pytest.warns(asperity.InputWarning, match="pause: [78]. of 480"):
        assert abs(asperity.read_curve(path).z.size - 401) <= 1


def test_legs_beside_each_other_are_joined(tmp_path):
    path, z, force = tmp_path / "curve.csv", *(1e9 * np.array(curve(1.0, 20.0, noise=0.005)))
    for one, other in (("Extend", "Retract"), ("Approach", "Withdraw"), ("Trace", "Retrace")):
        table = np.array([z[:200], force[:200], z[200:], force[200:]]).T
        heading = f"{one} Z (nm),{one} Force (nN),{other} Z (nm),{other} Force (nN)"
        np.savetxt(path, table, header=heading, delimiter=",", comments="")
        assert np.array(asperity.read_curve(path)) == pytest.approx(1e-9 * np.array([z, force]), rel=1e-12)
        one_leg = asperity.read_curve(path, z=f"{other} Z (nm)", force=3)
        assert np.sort(one_leg.z) == pytest.approx(1e-9 * np.sort(z[200:]))


def test_units_may_be_in_names(tmp_path):
    path = tmp_path / "curve.csv"
    path.write_text("depth_nm,load_uN,time_s\n0,0,0\n0.5,0.01,1\n29.5,1.5,2\n")
    z, force = asperity.read_curve(path)
    assert z == pytest.approx([0, 5e-10, 2.95e-8]) and force == pytest.approx([0, 1e-8, 1.5e-6])


def test_texts_of_instruments_are_read(tmp_path, capfd):
    formats = pytest.importorskip("afmformats")
    path, z, force = tmp_path / "curve.txt", *curve(None, 20.0, noise=0.01)
    keys = {"Max load (µN)": 1, "k (N/m)": 0.5, "Piezo position (nm) (Measured)": 9, "Piezo speed  (µm/s)": 1}
    keys |= {"Software version": 3, "Date": "01/02/2026", "Time": "10:11:12"}
    head = "Device:\tChiaro\n" + "".join(f"{key}\t{value}\n" for key, value in keys.items())
    names = "Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)\tAuxiliary\n"
    rows = "".join(f"{k}\t{1e6 * b:.12g}\t{1e9 * a:.12g}\t0\t{1e9 * a:.12g}\t0\n" for k, (a, b) in enumerate(zip(z, force)))
    path.write_text(head + names + rows, encoding="latin-1")
    found = asperity.read_curve(path)
    assert np.array(found) == pytest.approx(np.array([z, force]), rel=1e-9)
    # its own text, with a column of words
    data = {"force": force, "height (measured)": -z, "segment": np.repeat([0, 1], 200).astype(np.uint8)}
    tab = tmp_path / "curve.tab"
    formats.AFMForceDistance(data, {"path": path, "enum": 0, "imaging mode": "force-distance"}).export_data(tab, fmt="tab")
    assert np.array(asperity.read_curve(tab)) == pytest.approx(np.array([z, force]), rel=1e-4)
    (tmp_path / "broken.jpk-force").write_bytes(b"PK\x03\x04" + bytes(100))
    with pytest.raises(ValueError, match="is not read by afmformats"):
        asperity.read_curve(tmp_path / "broken.jpk-force")
    assert capfd.readouterr().err == ""


def test_what_is_no_curve_is_refused(tmp_path, monkeypatch):
    path = tmp_path / "curve.txt"
    for text, told in (
        ("", "has no line of at least two numbers"),
        ("a b\nc d\n", "has no line of at least two numbers"),
        ("z (nm)\tF (nN)\n1\t2\n3\t4\t5\n", "line 3 is no row of 2 numbers: '3"),
        ("z (nm)\tF (nN)\n1\tnan\n", "has no point with a finite position and force"),
        ("z (nm)\tF (nN)\n1\t2\nend\n", "line 3 is no row of 2 numbers: 'end'"),
    ):
        path.write_text(text)
        with pytest.raises(ValueError, match=told) as refused:
            asperity.read_curve(path)
        assert "\n" not in str(refused.value) and str(path) in str(refused.value)
    with pytest.raises(FileNotFoundError):
        asperity.read_curve(tmp_path / "none.txt")
    path.write_bytes(b"PK\x03\x04\x00\x00")
    monkeypatch.setitem(sys.modules, "afmformats", None)
    with pytest.raises(ValueError, match=r"is binary, or .*: pip install 'asperity\[curves\]'"):
        asperity.read_curve(path)


def test_files_of_instruments_are_read(tmp_path):
    afmformats = pytest.importorskip("afmformats")
    path = tmp_path / "curve.h5"
    data = {"force": 1e-9 * FORCE, "height (measured)": -1e-9 * Z, "height (piezo)": -2e-9 * Z, "time": Z}
    curve = afmformats.AFMForceDistance(data, {"path": path, "enum": 0, "imaging mode": "force-distance"})
    curve.export_data(path, fmt="hdf5")
    z, force = asperity.read_curve(path)
    # heights fall towards contact
    assert z == pytest.approx(1e-9 * Z) and force == pytest.approx(1e-9 * FORCE)
    assert asperity.read_curve(path, z="height (piezo)").z == pytest.approx(2e-9 * Z)
    with pytest.raises(ValueError, match="is not read by afmformats: it finds 1 curves, and none of number 1"):
        asperity.read_curve(path, number=1)
    path.write_bytes(b"\0" * 100)
    with pytest.raises(ValueError, match="is not read by afmformats: "):
        asperity.read_curve(path)
