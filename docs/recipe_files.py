"""Writes the files that recipes read: a force curve of a sharp tip, and a map of force curves.

    python docs/recipe_files.py FOLDER
"""

import runpy
import sys
from pathlib import Path

import afmformats
import h5py
import numpy as np

PYTHON = Path(__file__).resolve().parents[1] / "python"
CURVES, MAP = (runpy.run_path(str(PYTHON / path)) for path in ("tests/force_curves.py", "benches/curve_map.py"))


def write_curve(path, positions, forces):
    """A force curve in nm and nN."""
    columns = 1e9 * np.column_stack([positions, forces])
    np.savetxt(path, columns, delimiter=",", header="Height (nm),Force (nN)", comments="")


def write_map(path):
    """A map of 3 x 3 force curves, in the layout of afmformats."""
    metadata = {"imaging mode": "force-distance", "spring constant": MAP["STIFFNESS"], "path": path}
    metadata |= {f"grid shape {axis}": 3 for axis in "xy"} | {f"grid size {axis}": 1e-6 for axis in "xy"}
    with h5py.File(path, "w") as file:
        for number, (z, force) in enumerate(MAP["made"](3, 200, 2e-5)[0].reshape(9, 2, 200)):
            data = {"height (measured)": -z, "force": force, "segment": np.repeat([0, 1], 100).astype(np.uint8)}
            here = {**metadata, "enum": number, "grid index x": number // 3, "grid index y": number % 3}
            afmformats.AFMForceDistance(data, here).export_data(file, metadata=True, fmt="hdf5")


def write_all(folder):
    folder.mkdir(parents=True, exist_ok=True)
    write_curve(folder / "curve.csv", *CURVES["curve"](1.0, 20.0, points=400))
    write_map(folder / "map.h5")


if __name__ == "__main__":
    write_all(Path(sys.argv[1]))
