"""The command of the package, against the program that cargo builds: the same words, files and exit codes."""

import os
import pathlib
import signal
import subprocess
import sys
import sysconfig
import time

import numpy as np
import pytest

STUDY = """\
command = "sweep"
out = "study.csv"
mean-pressures = "1e-3:1e-2:ROWS:log"
[make]
size = 32
k-s = 8
rms-slope = 0.1
[vary]
seed = [1, 2, 3]
"""


@pytest.fixture(params=["script", "module"])
def command(request):
    """The command as it is installed, or the package as a program."""
    script = pathlib.Path(sysconfig.get_path("scripts")) / "asperity"
    return [str(script)] if request.param == "script" else [sys.executable, "-m", "asperity"]


def started(command, folder, *arguments, **options):
    options = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    return subprocess.Popen([*command, *arguments], cwd=folder, **options)


def told(command, folder, *arguments):
    """The exit code and all that is printed, without the times of solves."""
    process = started(command, folder, *arguments)
    printed = [text.decode() for text in process.communicate()]
    lines = [[line for line in text.splitlines() if "seconds" not in line and "time  " not in line] for text in printed]
    return process.returncode, *lines


def files(folder):
    """The bytes of all files that tell no time."""
    names = {path.relative_to(folder): path for path in folder.rglob("*") if path.is_file()}
    times = ("report.json", ".csv", ".sum", ".jsonl")
    return {name: None if path.name.endswith(times) else path.read_bytes() for name, path in names.items()}


@pytest.fixture
def folders(tmp_path):
    """Two folders with the same files: one for the command, one for the program."""
    found = [tmp_path / "command", tmp_path / "program"]
    x = np.arange(64) / 64
    for folder in found:
        folder.mkdir()
        np.save(folder / "heights.npy", 0.01 * np.cos(2 * np.pi * x)[:, None] * np.cos(4 * np.pi * x))
        np.save(folder / os.fsdecode(b"h\xe9.npy"), np.eye(4))
        (folder / "study.toml").write_text(STUDY.replace("ROWS", "3"))
    return found


SOLVE = ["solve", "--heights", "heights.npy", "--out", "out"]
LINES = [
    (0, ["--version"]),
    (0, ["solve", "--help"]),
    (0, ["completions", "zsh"]),
    (0, ["laws"]),
    (0, ["demo"]),
    (0, ["stats", b"h\xe9.npy", "--json"]),
    (0, ["surface", "--size", "32", "--k-s", "8", "--rms-slope", "0.1", "--out", "rough.npz", "--json"]),
    (0, [*SOLVE, "--mean-pressure", "0.01", "--json"]),
    (0, ["sweep", "--heights", "heights.npy", "--mean-pressures", "0.01,0.02", "--out", "sweep.csv"]),
    (0, ["study", "study.toml", "--jobs", "1"]),
    (0, ["study", "study.toml", "--jobs", "2", "--quiet"]),
    (1, []),
    (1, ["solv"]),
    (1, ["study", "none.toml"]),
    (1, [*SOLVE, "--mean-presure", "0.01"]),
    (1, ["stats", "none.npy"]),
    (2, [*SOLVE, "--mean-pressure", "0.01", "--max-iterations", "1", "--no-nested"]),
]


@pytest.mark.parametrize(("code", "arguments"), LINES, ids=lambda value: value if isinstance(value, int) else None)
def test_a_command_does_what_the_program_does(folders, command, tool, code, arguments):
    found, expected = (told(by, folder, *arguments) for by, folder in zip((command, [tool]), folders, strict=True))
    assert found == expected and found[0] == code
    assert files(folders[0]) == files(folders[1])


def test_the_help_is_that_of_the_program_with_the_command_of_the_package(folders, command, tool):
    for ask in ("--help", "-h", "help"):
        (code, said, errors), expected = (told(by, folders[0], ask) for by in (command, [tool]))
        assert (code, errors) == (0, []) and said[: len(expected[1])] == expected[1]
        assert said[len(expected[1]) :][1:2] == ["Command of the Python package:"] and "  convert " in said[-1]
    code, said, errors = told(command, folders[0], "convert", "heights.npy", "heights.gsf")
    assert (code, said, errors) == (0, ["written  Topography(64 x 64 heights, unknown side lengths)"], [])
    assert "--channel NAME" in "".join(told(command, folders[0], "convert", "--help")[1])


def test_nobody_has_to_listen(folders, command):
    with started(command, folders[0], "completions", "bash") as process:
        process.stdout.close()
        assert process.stderr.read() == b"" and process.wait(60) == 0


@pytest.mark.skipif(sys.platform == "win32", reason="there are no signals")
@pytest.mark.parametrize("ended", [signal.SIGINT, signal.SIGTERM])
def test_an_interruption_says_what_stands(folders, command, ended):
    folder = folders[0]
    (folder / "study.toml").write_text(STUDY.replace("ROWS", "20000"))
    process = started(command, folder, "study", "study.toml", "--jobs", "2")
    end = time.monotonic() + 60
    while not list(folder.glob("study.csv.cases/*.csv")):
        assert time.monotonic() < end and process.poll() is None
        time.sleep(0.01)
    process.send_signal(ended)
    said = process.communicate(timeout=60)[1].decode()
    assert process.returncode == -ended
    assert said.startswith("interrupted: 0 of 3 cases are done: the same command continues") and said.count("\n") == 1
    # the cases end with it
    sizes = [0, 1]
    while sizes[-1] != sizes[-2]:
        time.sleep(0.5)
        sizes.append(sum(path.stat().st_size for path in folder.glob("study.csv.cases/*.csv")))
        assert time.monotonic() < end
