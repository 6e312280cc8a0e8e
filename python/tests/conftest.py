"""Scenes that the tests share."""

import os
import pathlib
import shutil

import matplotlib
import numpy as np
import pytest

import asperity

matplotlib.use("Agg")

ROOT = pathlib.Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def rough():
    """A rough surface of 64 by 64 nodes, on sides of 1."""
    return asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_l=2, k_s=10, seed=3)


@pytest.fixture(scope="session")
def law():
    """An exponential law that the grid of `rough` resolves."""
    return asperity.Exponential(work_of_adhesion=2e-5, range=8e-3)


@pytest.fixture(scope="session")
def sphere():
    """A paraboloid with a radius of curvature of 2, its apex on a node."""
    x = np.arange(64) / 64 - 0.5
    return -(x[:, None] ** 2 + x**2) / 4


@pytest.fixture(scope="session")
def tool():
    """The command-line tool, built from the same sources: named by ASPERITY_TOOL, or where cargo leaves it."""
    named = os.environ.get("ASPERITY_TOOL")
    path = pathlib.Path(named) if named else ROOT / "target" / "release" / "asperity"
    assert path.is_file(), f"{path} is not there: cargo build --release, or set ASPERITY_TOOL"
    return shutil.which(str(path))
