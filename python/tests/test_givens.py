"""The same question gets the same answer from the program and from Python: the table of givens that the page is held to."""

import json
import pathlib
import re
import subprocess
import warnings

import numpy as np
import pytest

import asperity

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "crates" / "scene" / "tests" / "givens"
ROWS = json.loads((FOLDER / "givens.json").read_text())

#: What differs from face to face: the time, and files that are arrays in Python.
DIFFERENT = {"seconds", "initial_gap", "hardness_map"}


def worded(text):
    """A text with keywords in the place of keys in braces, as `asperity_scene::worded`."""

    def named(found):
        command, key, value = found.groups()
        key = {"initial_gap": "start", "hardness_map": "hardness"}.get(key, key)
        if command:
            return f"asperity.{command[:-1]}({key}={'...' if value is None else True})"
        return key if value is None else f"{key}={value[1:]!r}" if value[1:] else f"{key}=True"

    return re.sub(r"\{(\w+:)?(\w+)(=[^}]*)?\}", named, text)


def of_program(tool, row):
    """The report of the program; its complaint where it refuses."""
    options = []
    for key, value in {**row["given"], **row.get("files", {})}.items():
        name = "--" + key.replace("_", "-")
        if value is True:
            options += [name]
        elif isinstance(value, list):
            options += [name, *map(str, value)]
        else:
            options += [f"{name}={value}"]
    command = [tool, "solve", "--heights", row["map"], "--threads", "1", "--json", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    return json.loads(done.stdout) if done.returncode != 1 else done.stderr


def of_python(row):
    """The report of Python; its complaint where it refuses."""
    given, files = dict(row["given"]), dict(row.get("files", {}))
    if "hardness_map" in files:
        given["hardness"] = np.load(files.pop("hardness_map"))["heights"]
    if "initial_gap" in files:
        given["start"] = np.load(files.pop("initial_gap"))["heights"]
    try:
        return asperity.solve(row["map"], threads=1, **given, **files).report
    except (ValueError, TypeError) as refused:
        return str(refused)


@pytest.mark.parametrize("row", ROWS, ids=[row["name"] for row in ROWS])
def test_program_and_python_answer_a_given_alike(row, tool, monkeypatch):
    monkeypatch.chdir(FOLDER)
    program = of_program(tool, row)
    with warnings.catch_warnings(record=True) as given:
        warnings.simplefilter("always")
        python = of_python(row)
    if "refused" in row:
        assert python == row.get("own", {}).get("python", worded(row["refused"]))
        return
    assert [str(one.message).split(":")[0] for one in given if one.category is asperity.InputWarning] == row.get("warned", [])
    one, other = ({key: value for key, value in report.items() if key not in DIFFERENT} for report in (program, python))
    assert one == other
