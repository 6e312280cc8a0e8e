"""The same scene from the tool and from Python: the same bits, and the same names."""

import csv
import json
import pickle
import subprocess

import numpy as np
import pytest

import asperity

#: Inputs that only one of the two has: its time, its files, its version.
DIFFERENT = {"seconds", "heights", "initial_gap", "law_table", "work_of_adhesion_map", "version"}

WORK, REACH = 2e-5, 8e-3
GAPS, TRACTIONS = [0.0, 4e-3, 1.6e-2], [2.5e-3, 1.5e-3, 0.0]
#: Works of adhesion that differ over the surface.
WORKS = np.linspace(0.0, 1.0, 64)[:, None] * np.linspace(1.0, 0.5, 64) * WORK

GIVEN = ["--work-of-adhesion", WORK, "--range", REACH]
#: Laws and walls of the tool by its options, next to those of Python.
LAWS = {
    "none": ([], None, "hard"),
    "exponential": (GIVEN, asperity.Exponential(WORK, REACH), "hard"),
    "maugis-dugdale": (GIVEN, asperity.MaugisDugdale(WORK, REACH), "hard"),
    "lennard-jones": (GIVEN, asperity.LennardJones(WORK, REACH, cut=True), "hard"),
    "morse": (GIVEN, asperity.Morse(WORK, REACH), "hard"),
    "power": ([*GIVEN, "--exponent", 3], asperity.PowerLaw(WORK, REACH, 3.0), "hard"),
    "van-der-waals": (
        ["--hamaker", 1e-7, "--range", REACH, "--cut-off", 0.05],
        asperity.CutOff(asperity.VanDerWaals(1e-7, REACH), 0.05),
        "hard",
    ),
    "table": (["--law-table", "law.txt"], asperity.Tabulated(GAPS, TRACTIONS), "hard"),
}
WITHOUT_WALL = {
    "lennard-jones": ([*GIVEN, "--wall", "none"], asperity.LennardJones(WORK, REACH), "none"),
    "morse": ([*GIVEN, "--wall", "none"], asperity.Morse(WORK, REACH), "none"),
}
SPRINGS = {
    "none": (["--wall", "penalty", "--wall-stiffness", 500], None, asperity.Penalty(500.0)),
    "exponential": ([*GIVEN, "--wall", "uzawa", "--wall-stiffness", 500], LAWS["exponential"][1], asperity.Uzawa(500.0)),
}
VARYING = {
    "exponential": (
        ["--work-of-adhesion-map", "works.npy", "--range", REACH],
        asperity.Varying(asperity.Exponential(WORKS.max(), REACH), WORKS),
        "hard",
    )
}
SCENES = [*LAWS.items(), *WITHOUT_WALL.items(), *SPRINGS.items(), *VARYING.items()]


def asked(tool, folder, command, *options):
    subprocess.run([tool, command, *map(str, options)], cwd=folder, check=True, capture_output=True)


def same(folder, solution):
    """Holds the fields and the report of a folder against those of a solution."""
    for field in ("gap", "pressure", "contact_pressure"):
        assert np.load(folder / f"{field}.npy").tobytes() == getattr(solution, field).tobytes(), field
    report = json.loads((folder / "report.json").read_text())
    assert list(report) == list(solution.report)
    found = json.loads(json.dumps(solution.report), parse_constant=lambda _: None)
    for key in report.keys() - DIFFERENT:
        assert report[key] == found[key], key
    for key in ("initial_gap", "law_table", "work_of_adhesion_map"):
        assert (report[key] is None) == (found[key] is None), key


@pytest.mark.parametrize("precision", ["f64", "f32"])
@pytest.mark.parametrize("scene", SCENES, ids=lambda scene: f"{scene[0]}-{scene[1][2]}")
def test_fields_have_the_same_bits_and_the_report_the_same_keys(tmp_path, tool, rough, scene, precision):
    name, (options, law, wall) = scene
    np.save(tmp_path / "heights.npy", rough.heights)
    np.save(tmp_path / "works.npy", WORKS)
    np.savetxt(tmp_path / "law.txt", np.column_stack([GAPS, TRACTIONS]))
    # fmt: off
    asked(tool, tmp_path, "solve", "--heights", "heights.npy", "--lengths", 2, 2, "--modulus", 3, "--mean-pressure", 0.02,
          "--precision", precision, "--stability", "--no-pictures", "--out", "out", "--law", name, *options)
    # fmt: on
    solution = asperity.solve(
        rough.heights,
        (2.0, 2.0),
        modulus=3.0,
        mean_pressure=0.02,
        law=law,
        wall=wall,
        precision=precision,
        stability=True,
    )
    same(tmp_path / "out", solution)


def table(path):
    """The rows of a table of the tool."""
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def same_columns(rows, columns):
    assert list(rows[0]) == list(columns)
    for name, column in columns.items():
        if name in ("heights", "seed"):
            # the tool alone has read a file, and a .npy says nothing of a seed
            assert {row[name] for row in rows} == {"heights.npy" if name == "heights" else ""}
            continue
        if column.dtype.kind == "f":
            # a cell that does not apply is empty
            assert np.array([float(row[name] or "nan") for row in rows]).tobytes() == column.tobytes(), name
        else:
            assert [row[name] for row in rows] == ["" if cell is None else str(cell) for cell in column], name


def test_a_sweep_has_the_columns_of_the_tool(tmp_path, tool, rough, law):
    np.save(tmp_path / "heights.npy", rough.heights)
    # fmt: off
    asked(tool, tmp_path, "sweep", "--heights", "heights.npy", "--mean-pressures", "0.01,0.02,0.015", "--out", "sweep.csv",
          "--law", "exponential", "--work-of-adhesion", law.work_of_adhesion, "--range", law.range)
    # fmt: on
    columns = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.01, 0.02, 0.015], law=law).columns
    same_columns(table(tmp_path / "sweep.csv"), columns)


@pytest.mark.parametrize("law", [None, asperity.Exponential(WORK, REACH)], ids=["none", "exponential"])
def test_contact_fractions_are_found_as_by_the_tool(tmp_path, tool, rough, law):
    np.save(tmp_path / "heights.npy", rough.heights)
    options = [] if law is None else ["--law", "exponential", *GIVEN]
    # fmt: off
    asked(tool, tmp_path, "solve", "--heights", "heights.npy", "--contact-fraction", 0.1, "--no-pictures", "--out", "out",
          *options)
    asked(tool, tmp_path, "sweep", "--heights", "heights.npy", "--contact-fractions", "0.05,0.2", "--out", "sweep.csv",
          *options)
    # fmt: on
    solution = asperity.solve(rough, modulus=1.0, law=law, contact_fraction=0.1)
    same(tmp_path / "out", solution)
    assert solution.report["search"]["reached"] and abs(solution.contact_fraction - 0.1) <= 1e-3
    columns = asperity.sweep(rough, modulus=1.0, law=law, contact_fractions=[0.05, 0.2]).columns
    rows = table(tmp_path / "sweep.csv")
    assert [row.pop("reached") for row in rows] == ["true", "true"] and columns.pop("reached").all()
    same_columns(rows, columns)


def test_reduced_pressures_are_those_of_the_tool(tmp_path, tool, rough):
    np.save(tmp_path / "heights.npy", rough.heights)
    # fmt: off
    asked(tool, tmp_path, "sweep", "--heights", "heights.npy", "--modulus", 3, "--reduced-pressures", "0.01,0.02", "--out",
          "sweep.csv")
    # fmt: on
    same_columns(
        table(tmp_path / "sweep.csv"), asperity.sweep(rough, modulus=3.0, reduced_pressures=[0.01, 0.02]).columns
    )
    alone = asperity.solve(rough, modulus=3.0, reduced_pressure=0.01)
    assert alone.mean_pressure == pytest.approx(0.01 * 3.0 * asperity.surface.statistics(rough).rms_slope, rel=1e-14)


def test_a_cycle_takes_reduced_pressures_as_the_tool_does(tmp_path, tool, rough):
    np.save(tmp_path / "heights.npy", rough.heights)
    # fmt: off
    asked(tool, tmp_path, "cycle", "--heights", "heights.npy", "--modulus", 3, "--reduced-pressures", "0.01,0.02",
          "--steps", 3, "--out", "cycle.csv")
    # fmt: on
    found = asperity.cycle(rough, modulus=3.0, reduced_pressures=[0.01, 0.02], steps=3)
    same_columns(table(tmp_path / "cycle.csv"), found.columns)


@pytest.mark.parametrize("gaps", [[0.05, 0.012, 0.05, 0.04], [0.05, 0.012, 0.2]])
def test_a_cycle_has_the_columns_of_the_tool(tmp_path, tool, gaps):
    wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    np.save(tmp_path / "heights.npy", wave[:, None])
    # fmt: off
    asked(tool, tmp_path, "cycle", "--heights", "heights.npy", "--law", "exponential", "--work-of-adhesion", 2e-4,
          "--range", 4e-3, "--mean-gaps", ",".join(map(str, gaps)), "--steps", 10, "--out", "cycle.csv")
    # fmt: on
    law = asperity.Exponential(2e-4, 4e-3)
    columns = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=gaps, steps=10).columns
    same_columns(table(tmp_path / "cycle.csv"), columns)


def test_a_cycle_without_a_wall_has_the_columns_of_the_tool(tmp_path, tool):
    wave = 0.01 * np.cos(2 * np.pi * np.arange(64) / 64)
    np.save(tmp_path / "heights.npy", wave[:, None])
    # fmt: off
    asked(tool, tmp_path, "cycle", "--heights", "heights.npy", "--law", "morse", "--work-of-adhesion", 1e-3,
          "--range", 1e-2, "--wall", "none", "--mean-gaps", "0.06,0.002,0.06", "--steps", 10, "--smallest-step", 1e-3,
          "--out", "cycle.csv")
    # fmt: on
    cycle = asperity.cycle(
        wave,
        1.0,
        modulus=1.0,
        law=asperity.Morse(1e-3, 1e-2),
        wall="none",
        mean_gaps=[0.06, 0.002, 0.06],
        steps=10,
        smallest_step=1e-3,
    )
    same_columns(table(tmp_path / "cycle.csv"), cycle.columns)


@pytest.mark.parametrize("options", [[], ["--nested"]])
def test_a_contact_stiffness_is_that_of_the_tool(tmp_path, tool, options):
    rough = asperity.surface.self_affine(128, 2.0, rms_slope=0.1, k_l=2, k_s=16, seed=3)
    np.save(tmp_path / "heights.npy", rough.heights)
    # fmt: off
    asked(tool, tmp_path, "solve", "--heights", "heights.npy", "--lengths", 2, "--mean-pressure", 0.02, "--stiffness",
          *options, "--no-pictures", "--out", "out")
    asked(tool, tmp_path, "sweep", "--heights", "heights.npy", "--lengths", 2, "--mean-pressures", "0.01,0.02",
          "--stiffness", "--out", "sweep.csv")
    # fmt: on
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.02, stiffness=True, nested=bool(options) or None)
    same(tmp_path / "out", solution)
    assert solution.normal_stiffness == 4.0 * solution.contact_stiffness > 0.0
    sweep = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.01, 0.02], stiffness=True)
    same_columns(table(tmp_path / "sweep.csv"), sweep.columns)


def test_a_cycle_of_a_tip_from_afar_has_the_columns_of_the_tool(tmp_path, tool):
    x = 0.24 * (np.arange(24) / 24 - 0.5)
    tip = -(x[:, None] ** 2 + x**2) / 4
    np.save(tmp_path / "heights.npy", tip)
    # fmt: off
    asked(tool, tmp_path, "cycle", "--heights", "heights.npy", "--lengths", 0.24, "--boundary", "free", "--law", "exponential",
          "--work-of-adhesion", 2e-5, "--range", 2e-3, "--spring-stiffness", 0.01, "--spring-positions=-0.02,0,-0.03",
          "--steps", 10, "--smallest-step", 1e-3, "--out", "cycle.csv")
    # fmt: on
    law, springs = asperity.Exponential(2e-5, 2e-3), [(0.01, rest) for rest in (-0.02, 0.0, -0.03)]
    cycle = asperity.cycle(
        tip, 0.24, modulus=1.0, law=law, springs=springs, boundary="free", steps=10, smallest_step=1e-3
    )
    with pytest.warns(asperity.InputWarning, match="window-edge"):
        cycle.run()
    same_columns(table(tmp_path / "cycle.csv"), cycle.columns)
    assert [event["event"] for event in cycle.events if event["energy_drop"]] == ["jump-in", "pull-off"]


def test_a_self_affine_surface_is_that_of_the_tool(tmp_path, tool):
    asked(tool, tmp_path, "surface", "--size", 64, "--rms-slope", 0.1, "--k-s", 16, "--seed", 5, "--out", "rough.npy")
    drawn = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=16, seed=5)
    assert np.load(tmp_path / "rough.npy").tobytes() == drawn.heights.tobytes()


@pytest.mark.parametrize(
    ("form", "given"),
    [
        ("sphere", {"radius": 0.7}),
        ("paraboloid", {"radius": 0.7}),
        ("cone", {"angle": 30.0}),
        ("wave", {"amplitude": 0.1, "periods": (2, 1)}),
        ("flat-punch", {"radius": 0.3}),
        ("self-affine", {"rms_slope": 0.1, "k_s": 8}),
    ],
)
@pytest.mark.parametrize("tilt", [None, (0.1, -0.05)])
def test_surfaces_that_are_made_are_those_of_the_tool(tmp_path, tool, form, given, tilt):
    options = {**given, **({"tilt": tilt} if tilt else {})}
    texts = [part for key, value in options.items() for part in (f"--{key.replace('_', '-')}", *np.ravel(value))]
    sides = ["--shape", 48, 36, "--lengths", 2, 1.5]
    asked(tool, tmp_path, "surface", "--form", form, *sides, "--out", "made.npy", *texts)
    made = getattr(asperity.surface, form.replace("-", "_"))((48, 36), (2.0, 1.5), **options)
    assert np.load(tmp_path / "made.npy").tobytes() == made.heights.tobytes()
    assert made.lengths == (2.0, 1.5) and (made.missing > 0) == (form in ("sphere", "flat-punch"))


@pytest.mark.filterwarnings("ignore:(spikes|line-offsets)")
def test_a_preparation_has_the_heights_and_the_log_of_the_tool(tmp_path, tool, rough):
    scan = rough.heights + 0.01 * np.sin(1.7 * np.arange(rough.shape[1])) + 0.1 * np.arange(rough.shape[0])[:, None]
    scan[3, 4], scan[20, 10], scan[30, 31] = -9999.0, np.nan, 9.0
    np.save(tmp_path / "scan.npy", scan)
    # fmt: off
    asked(tool, tmp_path, "prepare", "scan.npy", "--lengths", 3, 2, "--missing=-9999", "--scale", 0.5, "--unit", "nm",
          "--crop", 2, 0, 60, 50, "--flip", "--align-rows", "polynomial:1", "--scan-axis", "y", "--despike", 8, "--detrend",
          "quadric", "--fill", "--mirror", "--resample", 90, 100, "--out", "made.npz")
    told = subprocess.run([tool, "run", "made.npz.scene.toml", "--out", "again.npz", "--json"], cwd=tmp_path,
                          check=True, capture_output=True)
    # fmt: on
    made = asperity.prepare(
        tmp_path / "scan.npy",
        (3.0, 2.0),
        missing=-9999,
        scale=0.5,
        unit="nm",
        crop=(2, 0, 60, 50),
        flip=True,
        align_rows=1,
        scan_axis="y",
        despike=8,
        detrend="quadric",
        fill=True,
        mirror=True,
        resample=(90, 100),
    )
    written = asperity.read(tmp_path / "made.npz")
    assert written.heights.tobytes() == made.heights.tobytes()
    assert (written.lengths, written.unit, written.original) == (made.lengths, made.unit, made.original)
    assert [f"{step['step']}: {step['what']}" for step in json.loads(told.stdout)["steps"]] == list(made.log)
    assert len(made.log) == 13 and pickle.loads(pickle.dumps(made)).log == made.log
    assert asperity.prepare(made, flip=True).log[:13] == made.log


def test_quantities_with_units_are_those_of_the_tool(tmp_path, tool, rough):
    np.savez(tmp_path / "heights.npz", heights=1e3 * rough.heights, lengths=[1e3, 1e3], unit="nm")
    # fmt: off
    asked(tool, tmp_path, "solve", "--heights", "heights.npz", "--modulus", "70GPa", "--mean-pressure", "700MPa",
          "--no-pictures", "--out", "out")
    asked(tool, tmp_path, "sweep", "--heights", "heights.npz", "--modulus", "70GPa", "--mean-gaps", "20nm,15nm", "--out",
          "sweep.csv")
    # fmt: on
    solution = asperity.solve(tmp_path / "heights.npz", modulus="70GPa", mean_pressure="700MPa")
    same(tmp_path / "out", solution)
    assert solution.report["given"] == {"modulus": "70GPa", "mean_pressure": "700MPa"}
    assert (solution.report["length_unit"], solution.report["pressure_unit"], solution.lengths[0]) == ("m", "Pa", 1e-6)
    sweep = asperity.sweep(tmp_path / "heights.npz", modulus="70GPa", mean_gaps=["20nm", "15nm"])
    rows = [{name.split(" [")[0]: cell for name, cell in row.items()} for row in table(tmp_path / "sweep.csv")]
    columns = sweep.columns
    for name in ("mean_gap", "mean_pressure", "modulus"):
        assert [float(row[name]) for row in rows] == columns[name].tolist(), name
