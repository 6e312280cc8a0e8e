"""The code of the README runs as it stands, from top to bottom."""

import pathlib
import re

import numpy as np
import pytest

import asperity

README = pathlib.Path(__file__).resolve().parents[1] / "README.md"


def test_the_code_of_the_readme_runs(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    measured = asperity.surface.self_affine(64, 2e-6, rms_height=6e-9, k_l=2, k_s=10).heights.copy()
    measured[4:6, 7] = np.nan
    np.savez("measured.npz", heights=measured, lengths=(2e-6, 2e-6), unit="m")
    found = {}
    blocks = re.findall(r"^```python\n(.*?)^```", README.read_text(), re.MULTILINE | re.DOTALL)
    assert len(blocks) == 5
    for block in blocks:
        exec(block, found)
    assert found["solution"].converged and found["pressed"].converged and len(found["table"]) == 3
    assert found["right"].report["accuracy"]["reached"]
    assert [event["event"] for event in found["cycle"].events] == ["jump-in", "jump-out"]
    assert -found["cycle"].columns["normal_force"].min() == pytest.approx(5.09e-9, rel=1e-3)
    assert pathlib.Path("pressed.pdf").stat().st_size > 1000
