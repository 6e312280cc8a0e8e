"""Tables in files: those of the tool, which an interrupted run continues."""

import filecmp
import os
import subprocess
import sys

import numpy as np
import pytest

import asperity

PRESSURES = [0.01, 0.02, 0.015]
GAPS = [0.05, 0.012, 0.05]
WORKS = np.linspace(0.5, 1.0, 64)[:, None] * np.full(64, 2e-5)


def asked(tool, folder, command, *options):
    subprocess.run([tool, command, *map(str, options)], cwd=folder, check=True, capture_output=True)


def sweep(folder, out, loads=PRESSURES, **given):
    return asperity.sweep(asperity.read(folder / "heights.npy"), 1.0, modulus=1.0, mean_pressures=loads, out=out, **given)


def cycle(folder, out, **given):
    law, wave = asperity.Exponential(2e-4, 4e-3), asperity.read(folder / "wave.npy")
    return asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=GAPS, steps=10, out=out, **given)


def interrupted(begin, rows):
    """A table of which the solve behind so many rows raises."""

    def observe(state):
        if len(found.rows) == rows:
            raise KeyboardInterrupt

    found = begin(observe=observe)
    with pytest.raises(KeyboardInterrupt):
        found.run()
    assert len(found.rows) == rows
    return found


@pytest.fixture
def folder(tmp_path, rough):
    np.save(tmp_path / "heights.npy", rough.heights)
    np.save(tmp_path / "wave.npy", 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)[:, None])
    np.save(tmp_path / "works.npy", WORKS)
    np.savetxt(tmp_path / "law.txt", [[0.0, 2.5e-3], [4e-3, 1.5e-3], [1.6e-2, 0.0]])
    return tmp_path


SWEEPS = {
    "plain": ([], {}),
    "single": (["--precision", "f32"], {"precision": "f32"}),
    "stiffness": (["--stiffness", "--method", "rey2017"], {"stiffness": True, "method": "rey2017"}),
    "table": (["--law", "table", "--law-table", "law.txt"], {"law": "law.txt"}),
    "varying": (
        ["--law", "exponential", "--work-of-adhesion-map", "works.npy", "--range", 8e-3],
        {"law": asperity.Varying(asperity.Exponential(WORKS.max(), 8e-3), WORKS)},
    ),
    "hardness": (["--hardness", 0.1], {"hardness": 0.1}),
    "start": (["--initial-gap", "gap.npy"], {"start": "gap.npy"}),
}


@pytest.mark.parametrize(("name", "end"), [*((name, "csv") for name in SWEEPS), ("plain", "jsonl")])
def test_the_tool_and_python_write_the_same_sweep_and_go_on_with_each_other(folder, tool, name, end):
    options, given = SWEEPS[name]
    np.save(folder / "gap.npy", np.full((64, 64), 0.1))
    if given.get("law") == "law.txt":
        given = {"law": asperity.Tabulated.read(folder / "law.txt")}
    if "start" in given:
        given = {"start": np.load(folder / "gap.npy")}
    ours, theirs, first, second = (folder / f"{name}.{end}" for name in ("ours", "theirs", "first", "second"))

    def by_tool(out, loads):
        loads = ",".join(map(str, loads))
        asked(tool, folder, "sweep", "--heights", "heights.npy", "--mean-pressures", loads, "--out", out, *options)

    by_tool(theirs, PRESSURES)
    columns = sweep(folder, ours, **given).columns
    assert ours.read_bytes() == theirs.read_bytes()
    by_tool(first, PRESSURES[:2])
    found = sweep(folder, first, **given)
    assert len(list(found)) == 1 and first.read_bytes() == ours.read_bytes()
    assert all(np.array_equal(column, columns[name], column.dtype.kind == "f") for name, column in found.columns.items())
    sweep(folder, second, PRESSURES[:2], **given).run()
    by_tool(second, PRESSURES)
    assert second.read_bytes() == ours.read_bytes()


def test_contact_fractions_and_springs_are_kept_as_by_the_tool(folder, tool, sphere):
    np.save(folder / "sphere.npy", sphere)
    rough, tip = asperity.read(folder / "heights.npy"), asperity.read(folder / "sphere.npy")
    asked(tool, folder, "sweep", "--heights", "heights.npy", "--contact-fractions", "0.05,0.2,0.1", "--out", "a.csv")
    # fmt: off
    asked(tool, folder, "sweep", "--heights", "sphere.npy", "--boundary", "free", "--spring-stiffness", 0.1,
          "--spring-positions=-0.01,0.01,0.02", "--out", "b.csv")
    # fmt: on
    springs = [(0.1, position) for position in (-0.01, 0.01, 0.02)]
    for count in (2, 3):
        wanted = [0.05, 0.2, 0.1][:count]
        asperity.sweep(rough, 1.0, modulus=1.0, contact_fractions=wanted, out=folder / "fractions.csv").run()
        held = springs[:count]
        asperity.sweep(tip, 1.0, modulus=1.0, boundary="free", springs=held, out=folder / "springs.csv").run()
    assert filecmp.cmp(folder / "a.csv", folder / "fractions.csv", shallow=False)
    assert filecmp.cmp(folder / "b.csv", folder / "springs.csv", shallow=False)
    stiffer = [(0.1, -0.01), (0.2, 0.01), (0.1, 0.02)]
    with pytest.raises(ValueError, match="control is spring of stiffness 0.1, and not spring of stiffness 0.1 0.2 0.1"):
        asperity.sweep(tip, 1.0, modulus=1.0, boundary="free", springs=stiffer, out=folder / "springs.csv")


def test_a_cycle_that_was_interrupted_ends_as_one_that_was_not(folder, tool):
    # fmt: off
    asked(tool, folder, "cycle", "--heights", "wave.npy", "--law", "exponential", "--work-of-adhesion", 2e-4, "--range", 4e-3,
          "--mean-gaps", "0.05,0.012,0.05", "--steps", 10, "--out", "cycle.csv", "--fields", "fields")
    # fmt: on
    whole, files = (folder / "cycle.csv").read_bytes(), sorted(os.listdir(folder / "fields"))
    uninterrupted = cycle(folder, None)
    rows, out, fields = 9, folder / "interrupted.csv", folder / "interrupted"
    first = interrupted(lambda **given: cycle(folder, out, fields=fields, **given), rows)
    # as left by a run that was killed before it removed them
    left = fields / f"gap-{rows - 1:04}.npy"
    if not left.exists():
        left.touch()
    found = cycle(folder, out, fields=fields)
    assert len(found.rows) == rows and [row["leg"] for row in found.rows] == [row["leg"] for row in first.rows]
    steps = list(found)
    assert out.read_bytes() == whole and rows + len(steps) == len(found.rows)
    assert sorted(os.listdir(fields)) == files and files
    assert filecmp.cmpfiles(folder / "fields", fields, files, shallow=False) == (files, [], [])
    assert [event["event"] for event in found.events] == [event["event"] for event in uninterrupted.events]


def test_a_sweep_goes_on_after_an_exception_in_the_same_object(folder):
    sweep(folder, folder / "whole.csv").run()
    stop = [True]

    def observe(state):
        if stop and len(found.rows) == 1:
            raise stop.pop() and KeyboardInterrupt

    found = sweep(folder, folder / "again.csv", observe=observe)
    with pytest.raises(KeyboardInterrupt):
        found.run()
    other = interrupted(lambda **given: sweep(folder, folder / "again.csv", **given), 1)
    assert [row["status"] for row in found.run().rows] == ["converged"] * 3
    with pytest.raises(ValueError, match="has rows of another run by now: make the same call again"):
        other.run()
    assert filecmp.cmp(folder / "whole.csv", folder / "again.csv", shallow=False)


class Linear:
    """A traction that falls linearly to zero."""

    range = 8e-3

    def __init__(self, work_of_adhesion):
        self.work_of_adhesion = work_of_adhesion

    def energy(self, gap):
        return -self.work_of_adhesion * (1 - gap / self.range).clip(0) ** 2

    def traction(self, gap):
        return 2 * self.work_of_adhesion / self.range * (1 - gap / self.range).clip(0)

    def slope(self, gap):
        return -2 * self.work_of_adhesion / self.range**2 * (gap < self.range)


def test_other_inputs_are_refused_by_name(folder, rough):
    out = folder / "sweep.csv"

    def begun(**other):
        given = {"modulus": 1.0, "mean_pressures": PRESSURES[:1], "law": Linear(2e-5), "out": out}
        return asperity.sweep(rough, **{**given, **other})

    begun().run()
    text = out.read_bytes()
    for other, message in [
        ({"modulus": 2.0}, "modulus is 1, and not 2: choose another out, or force=True to start over"),
        ({"law": None}, "law is Linear, and not none"),
        ({"law": Linear(3e-5)}, "work of adhesion is"),
        ({"start": np.full((64, 64), 0.1)}, "another file of its initial gap"),
        ({"branch": "unloading"}, "branch is by the load, and not unloading"),
    ]:
        with pytest.raises(ValueError, match=message):
            begun(**other)
    law = Linear(2e-5)
    law.slope = lambda gap: -2 * 2e-5 / 8e-3**2 * (gap < 8e-3) * 1.0
    begun(law=law).run()
    law.traction = lambda gap: 2 * 2e-5 / 8e-3 * (1 - gap / 8e-3).clip(0) * (1 + 1e-9)
    with pytest.raises(ValueError, match="law values is"):
        begun(law=law)
    whole = {"out": folder / "varying.csv", "law": asperity.Varying(asperity.Exponential(WORKS.max(), 8e-3), WORKS)}
    begun(**whole).run()
    with pytest.raises(ValueError, match="law values is none, and not"):
        begun(**{**whole, "law": asperity.Varying(asperity.Exponential(1.0, 8e-3), WORKS)})
    with pytest.raises(ValueError, match="another file of its work of adhesion map"):
        begun(**{**whole, "law": asperity.Varying(asperity.Exponential(WORKS.max(), 8e-3), WORKS[::-1])})
    assert out.read_bytes() == text
    other = begun(modulus=2.0, force=True).columns
    assert other["modulus"] == [2.0] and out.read_bytes() != text
    out.write_text("mine")
    with pytest.raises(ValueError, match="was changed since it was written"):
        begun(modulus=2.0)
    assert out.read_text() == "mine"


def test_a_file_has_one_writer_and_a_table_without_rows_leaves_none(folder, rough):
    out = folder / "sweep.csv"
    first = sweep(folder, out)
    next(first)
    with pytest.raises(ValueError, match=r"held by a table of this process, Sweep\(1 of 3 loads solved\): run\(\) that, or del"):
        sweep(folder, out)
    code = f"import asperity; asperity.sweep('heights.npy', 1.0, modulus=1.0, mean_pressures={PRESSURES}, out='sweep.csv')"
    other = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, check=False)
    assert "another run is writing there: wait until it has ended, or choose another out" in other.stderr
    del first
    first = sweep(folder, out)
    assert len(first.rows) == 1
    first.run()
    assert len(sweep(folder, out).rows) == 3
    before = sorted(os.listdir(folder))
    with pytest.raises(ValueError):
        asperity.sweep(rough, modulus=1.0, mean_pressures=[np.nan], out=folder / "none.csv").run()
    with pytest.raises(ValueError, match="ends in neither .csv nor .jsonl"):
        sweep(folder, folder / "sweep.txt")
    with pytest.raises(ValueError, match="give out, too"):
        sweep(folder, None, fields=folder / "fields")
    with pytest.raises(ValueError, match="is read by this run"):
        asperity.sweep(asperity.Topography(rough.heights, source=str(folder / "x.csv")), 1.0, modulus=1.0, out=folder / "x.csv",
                       mean_pressures=PRESSURES)  # fmt: skip
    with pytest.raises(OSError, match=r"cannot be written"):
        sweep(folder, folder / "heights.npy" / "sweep.csv")
    assert sorted(os.listdir(folder)) == before
