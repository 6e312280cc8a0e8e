"""The same scene from the tool and from Python: the same bits, and the same names."""

import csv
import json
import subprocess

import numpy as np
import pytest

import asperity

#: Inputs that only one of the two has.
DIFFERENT = {"seconds", "heights", "version"}

#: Keys and columns of bodies as a whole, which one of the two may have alone.
BODIES = {"boundary", "normal_force", "approach", "spring_stiffness", "absent_points", "edge_traction"}

#: Keys of laws, walls and maps that the tool has alone.
LAWS = {"mu_rho_node", "exponent", "hamaker", "law_table", "cut_off", "work_of_adhesion_map", "wall"}


def shared(names):
    return [name for name in names if name not in BODIES | LAWS]


def asked(tool, folder, command, *options):
    subprocess.run([tool, command, *map(str, options)], cwd=folder, check=True, capture_output=True)


@pytest.mark.parametrize("precision", ["f64", "f32"])
@pytest.mark.parametrize("name", [None, "exponential", "maugis-dugdale"])
def test_fields_have_the_same_bits_and_the_report_the_same_keys(tmp_path, tool, rough, name, precision):
    np.save(tmp_path / "heights.npy", rough.heights)
    work, reach = 2e-5, 8e-3
    options = ["--work-of-adhesion", work, "--range", reach, "--law", name] if name else []
    # fmt: off
    asked(tool, tmp_path, "solve", "--heights", "heights.npy", "--lengths", 2, 2, "--modulus", 3, "--mean-pressure", 0.02,
          "--precision", precision, "--stability", "--no-pictures", "--out", "out", *options)
    # fmt: on
    laws = {None: None, "exponential": asperity.Exponential, "maugis-dugdale": asperity.MaugisDugdale}
    law = laws[name] and laws[name](work, reach)
    solution = asperity.solve(
        rough.heights, (2.0, 2.0), modulus=3.0, mean_pressure=0.02, law=law, precision=precision, stability=True
    )
    for field in ("gap", "pressure", "contact_pressure"):
        assert np.load(tmp_path / "out" / f"{field}.npy").tobytes() == getattr(solution, field).tobytes()
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert shared(report) == shared(solution.report)
    found = json.loads(json.dumps(solution.report), parse_constant=lambda _: None)
    for key in (report.keys() & found.keys()) - DIFFERENT:
        assert report[key] == found[key], key


def test_a_sweep_has_the_columns_of_the_tool(tmp_path, tool, rough, law):
    np.save(tmp_path / "heights.npy", rough.heights)
    # fmt: off
    asked(tool, tmp_path, "sweep", "--heights", "heights.npy", "--mean-pressures", "0.01,0.02,0.015", "--out", "sweep.csv",
          "--law", "exponential", "--work-of-adhesion", law.work_of_adhesion, "--range", law.range)
    # fmt: on
    with open(tmp_path / "sweep.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    columns = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.01, 0.02, 0.015], law=law).columns
    assert shared(rows[0]) == shared(columns)
    for name in shared(columns):
        column = columns[name]
        assert [type(column[0])(row[name]) for row in rows] == list(column), name


def test_a_cycle_has_the_columns_of_the_tool(tmp_path, tool):
    wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    np.save(tmp_path / "heights.npy", wave[:, None])
    law = asperity.Exponential(2e-4, 4e-3)
    # fmt: off
    asked(tool, tmp_path, "cycle", "--heights", "heights.npy", "--law", "exponential", "--work-of-adhesion", 2e-4,
          "--range", 4e-3, "--mean-gaps", "0.05,0.012,0.05,0.04", "--steps", 10, "--out", "cycle.csv")
    # fmt: on
    with open(tmp_path / "cycle.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    columns = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.05, 0.012, 0.05, 0.04], steps=10).columns
    assert set(shared(columns)) <= set(rows[0])
    assert [row["event"] or None for row in rows] == list(columns["event"])
    for name in ("mean_gap", "mean_pressure", "work", "dissipated", "imbalance"):
        assert [float(row[name]) for row in rows] == list(columns[name]), name


def test_a_self_affine_surface_is_that_of_the_tool(tmp_path, tool):
    asked(tool, tmp_path, "surface", "--size", 64, "--rms-slope", 0.1, "--k-s", 16, "--seed", 5, "--out", "rough.npy")
    drawn = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=16, seed=5)
    assert np.load(tmp_path / "rough.npy").tobytes() == drawn.heights.tobytes()
