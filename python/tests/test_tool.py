"""Surfaces, preparations and laws from the tool and from Python: the same bits, and the same words."""

import json
import pickle
import subprocess

import numpy as np
import pytest

import asperity


def asked(tool, folder, command, *options):
    subprocess.run([tool, command, *map(str, options)], cwd=folder, check=True, capture_output=True)


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


WORK, REACH = 2e-5, 8e-3
GAPS, TRACTIONS = [0.0, 4e-3, 1.6e-2], [2.5e-3, 1.5e-3, 0.0]
#: Works of adhesion that differ over the surface.
WORKS = np.linspace(0.0, 1.0, 64)[:, None] * np.linspace(1.0, 0.5, 64) * WORK
GIVEN = ["--work-of-adhesion", WORK, "--range", REACH]
WITHIN = asperity.CutOff(asperity.VanDerWaals(1e-7, REACH), 0.05)
VARYING = asperity.Varying(asperity.Exponential(WORKS.max(), REACH), WORKS)
#: Laws and walls of the tool by its options, next to objects of Python.
# fmt: off
OBJECTS = [
    ("exponential", GIVEN, asperity.Exponential(WORK, REACH), "hard"),
    ("maugis-dugdale", GIVEN, asperity.MaugisDugdale(WORK, REACH), "hard"),
    ("lennard-jones", GIVEN, asperity.LennardJones(WORK, REACH, cut=True), "hard"),
    ("power", [*GIVEN, "--exponent", 3], asperity.PowerLaw(WORK, REACH, 3.0), "hard"),
    ("van-der-waals", ["--hamaker", 1e-7, "--range", REACH, "--cut-off", 0.05], WITHIN, "hard"),
    ("table", ["--law-table", "law.txt"], asperity.Tabulated(GAPS, TRACTIONS), "hard"),
    ("exponential", ["--work-of-adhesion-map", "works.npy", "--range", REACH], VARYING, "hard"),
    ("morse", [*GIVEN, "--wall", "none"], asperity.Morse(WORK, REACH), "none"),
    ("none", ["--wall", "penalty", "--wall-stiffness", 500], None, asperity.Penalty(500.0)),
    ("none", ["--wall", "uzawa", "--wall-stiffness", 500], None, asperity.Uzawa(500.0)),
]
# fmt: on


@pytest.mark.parametrize(("name", "options", "law", "wall"), OBJECTS)
def test_fields_by_objects_are_those_of_the_tool(tmp_path, tool, rough, name, options, law, wall):
    np.save(tmp_path / "heights.npy", rough.heights)
    np.save(tmp_path / "works.npy", WORKS)
    np.savetxt(tmp_path / "law.txt", np.column_stack([GAPS, TRACTIONS]))
    scene = ["--heights", "heights.npy", "--lengths", 2, 2, "--mean-pressure", 0.02, "--precision", "f32"]
    asked(tool, tmp_path, "solve", *scene, "--no-pictures", "--out", "out", "--law", name, *options)
    given = {"modulus": 1.0, "mean_pressure": 0.02, "law": law, "wall": wall, "precision": "f32"}
    solution = asperity.solve(rough.heights, (2.0, 2.0), **given)
    for field in ("gap", "pressure", "contact_pressure"):
        assert np.load(tmp_path / "out" / f"{field}.npy").tobytes() == getattr(solution, field).tobytes(), field
