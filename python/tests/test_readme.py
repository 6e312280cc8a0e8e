"""The code of the README and of the pages runs as it stands, from top to bottom."""

import pathlib
import re

import numpy as np
import pytest

import asperity

ROOT = pathlib.Path(__file__).resolve().parents[2]


def run(page):
    """Runs the blocks of a page, and returns their number and what they have defined."""
    found = {}
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.MULTILINE | re.DOTALL)
    for block in blocks:
        exec(block, found)
    return len(blocks), found


@pytest.mark.parametrize("page", ["python/README.md", "docs/start.md"])
def test_the_first_solve_runs(page, tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    blocks, found = run(page)
    assert blocks == 1 and found["solution"].converged


def test_a_figure_for_a_paper_comes_in_few_lines(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    blocks, found = run("docs/gallery.md")
    assert blocks == 1 and pathlib.Path("adhesion.pdf").stat().st_size > 1000
    assert [len(line.get_xdata()) for line in found["ax"].get_lines()] == [12] * 3


def test_the_code_of_the_guide_runs(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    measured = asperity.surface.self_affine(64, 2e-6, rms_height=6e-9, k_l=2, k_s=10).heights.copy()
    measured[4:6, 7] = np.nan
    np.savez("measured.npz", heights=measured, lengths=(2e-6, 2e-6), unit="m")
    blocks, found = run("docs/python/guide.md")
    assert blocks == 6
    assert found["solution"].converged and found["pressed"].converged and len(found["table"]) == 3
    assert found["right"].report["accuracy"]["reached"]
    assert [event["event"] for event in found["cycle"].events] == ["jump-in", "jump-out"]
    assert -found["cycle"].columns["normal_force"].min() == pytest.approx(5.09e-9, rel=1e-3)
    quick = found["quick"]
    assert quick.force < 5.09e-9 < quick.force * quick.lost_pressure / quick.pressure
    assert pathlib.Path("pressed.pdf").stat().st_size > 1000
