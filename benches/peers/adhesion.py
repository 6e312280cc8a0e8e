#!/usr/bin/env python3
"""The package Adhesion and asperity on a rough surface with the law of Morse and no wall: the same state, to what
digit?

    python benches/peers/adhesion.py [NODES] [ASPERITY]

Needs Adhesion (pip install Adhesion) and the tool of asperity (default: target/release/asperity), which makes the heights.
Adhesion minimises at an offset by scipy's L-BFGS-B; asperity then holds its mean gap. Compared are the gaps at every node,
the nodes that repel each other, and the mean pressure. Lengths are in units of the side, pressures of E*.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from Adhesion.Interactions import Morse
from Adhesion.System import SmoothContactSystem
from ContactMechanics import PeriodicFFTElasticHalfSpace
from SurfaceTopography import Topography

WORK, RANGE, OFFSET = 2e-4, 4e-3, -0.008


def adhesion(heights):
    """Gap and mean pressure by Adhesion, with its evaluations and seconds."""
    begin = time.perf_counter()
    substrate = PeriodicFFTElasticHalfSpace(heights.shape, 1.0, (1.0, 1.0))
    topography = Topography(heights, (1.0, 1.0), periodic=True)
    system = SmoothContactSystem(substrate, Morse(WORK, RANGE), topography)
    options = {"ftol": 0, "gtol": 1e-9 * WORK / RANGE / heights.size, "maxiter": 100_000, "maxfun": 100_000, "maxcor": 20}
    result = system.minimize_proxy(offset=OFFSET, options=options)
    seconds = time.perf_counter() - begin
    gap = np.asarray(system.compute_gap(system.disp, OFFSET))
    return gap, result, seconds


def asperity(tool, folder, mean_gap):
    """Gap and report by asperity at a mean gap."""
    options = f"--law morse --work-of-adhesion {WORK} --range {RANGE} --wall none --tolerance 1e-9 --no-pictures --force"
    command = [tool, "solve", "--heights", folder / "heights.npy", "--mean-gap", repr(mean_gap), "--out", folder / "out"]
    subprocess.run([*command, *options.split(), "--quiet"], check=True)
    report = json.loads((folder / "out" / "report.json").read_text())
    return np.load(folder / "out" / "gap.npy"), report


def main():
    n = sys.argv[1] if len(sys.argv) > 1 else "128"
    tool = sys.argv[2] if len(sys.argv) > 2 else "target/release/asperity"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        surface = f"--size {n} --rms-slope 0.5 --hurst 0.8 --k-l 4 --k-s 16 --seed 1 --out {folder / 'heights.npy'}"
        subprocess.run([tool, "surface", *surface.split(), "--quiet"], check=True)
        heights = np.load(folder / "heights.npy")
        theirs, result, seconds = adhesion(heights)
        mean_gap = float(theirs.mean())
        ours, report = asperity(tool, folder, mean_gap)
    decay = np.exp(-theirs / RANGE)
    pressure = float((2 * WORK / RANGE * (decay**2 - decay)).mean())
    rms = heights.std()
    print(f"{n} x {n} nodes, mean gap {mean_gap / rms:.4f} of the rms height, mu_rho {report['mu_rho']:.2f}")
    print(f"{'':<10} {'applications':>12} {'seconds':>8} {'mean pressure':>16} {'repelling nodes':>16}")
    theirs_row = [result.nfev, seconds, pressure, int((theirs < 0).sum())]
    ours_row = [report[key] for key in ("operator_applications", "seconds", "mean_pressure", "contact_nodes")]
    for who, row in [("Adhesion", theirs_row), ("asperity", ours_row)]:
        print("{:<10} {:>12} {:>8.2f} {:>16.9e} {:>16}".format(who, *row))
    print(f"largest difference of the gaps {np.abs(ours - theirs).max() / RANGE:.1e} of the range of adhesion")
    print(f"Adhesion: {result.message}, largest force {np.abs(result.jac).max() * heights.size / (WORK / RANGE):.1e} w/rho")


main()
