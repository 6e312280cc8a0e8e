"""The notebooks run from top to bottom, and draw their figure."""

import os
import pathlib
import subprocess
import sys

import pytest

EXAMPLES = sorted((pathlib.Path(__file__).resolve().parents[1] / "examples").glob("*.py"))


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_notebook(path, tmp_path):
    folder = pathlib.Path(os.environ.get("ASPERITY_FIGURES", tmp_path))
    environment = {**os.environ, "MPLBACKEND": "Agg", "PYTHONWARNINGS": "error::UserWarning"}
    found = subprocess.run(
        [sys.executable, path], cwd=folder, env=environment, capture_output=True, text=True, timeout=100
    )
    assert found.returncode == 0, found.stderr
    assert (folder / f"{path.stem}.png").stat().st_size > 5000
