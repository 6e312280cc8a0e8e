#!/usr/bin/env python3
"""The same job by the Python packages that are installed: a rough surface pressed on a hard wall by a mean pressure.

    python benches/peers/python.py [NODES]

Each job is the code that one writes for it, from heights in memory to the contact fraction; its lines are counted as
they stand. The tolerances are those that each package has for a contact map right to a node in ten thousand. Times are
medians of three, in this process, of whatever threads a package takes.
"""

import contextlib
import importlib.util
import os
import statistics
import sys
import time

import numpy as np

JOBS = {
    "asperity": """
import asperity
solution = asperity.solve(heights, 1.0, modulus=1.0, mean_pressure=0.02)
share = solution.contact_fraction
""",
    "tamaas": """
import tamaas as tm
model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1.0, 1.0], list(heights.shape))
model.E, model.nu = 1.0, 0.0
solver = tm.PolonskyKeerRey(model, heights, 1e-8)
assert solver.solve(0.02) < 1e-8
share = (model.traction > 0).mean()
""",
    "ContactMechanics": """
from SurfaceTopography import Topography
from ContactMechanics import PeriodicFFTElasticHalfSpace
from ContactMechanics.Factory import make_system
substrate = PeriodicFFTElasticHalfSpace(heights.shape, 1.0, (1.0, 1.0))
topography = Topography(heights, (1.0, 1.0), periodic=True)
system = make_system(interaction="hardwall", substrate=substrate, surface=topography)
assert system.minimize_proxy(external_force=0.02, pentol=1e-8).success
share = system.compute_contact_area()
""",
}


def heights_of(n):
    """Self-affine heights with a Hurst exponent of 0.8 and an rms slope of 0.1, by filtering white noise."""
    q = 2 * np.pi * np.hypot(*np.meshgrid(np.fft.fftfreq(n, 1 / n), np.fft.rfftfreq(n, 1 / n), indexing="ij"))
    band = (q >= 2 * np.pi * 4) & (q <= 2 * np.pi * n / 8)
    amplitude = np.where(band, np.where(q > 0, q, 1.0) ** -1.8, 0.0)
    spectrum = np.fft.rfft2(np.random.default_rng(1).normal(size=(n, n))) * amplitude
    rms_slope = np.fft.irfft2(spectrum * q, s=(n, n)).std()
    return np.fft.irfft2(spectrum, s=(n, n)) * 0.1 / rms_slope


def main():
    n = int(sys.argv[1]) if len(sys.argv) > 1 else 256
    heights = heights_of(n)
    print(f"{'':<17} {'lines':>5} {'seconds':>9} {'contact':>10}   {n} x {n} nodes")
    for name, code in JOBS.items():
        if importlib.util.find_spec(name) is None:
            print(f"{name:<17} not installed")
            continue
        times = []
        for _ in range(4):
            scope = {"heights": heights.copy()}
            with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
                begin = time.perf_counter()
                exec(code, scope)
                times.append(time.perf_counter() - begin)
        lines = len(code.strip().splitlines())
        # the first run imports
        print(f"{name:<17} {lines:>5} {statistics.median(times[1:]):>9.3f} {100 * scope['share']:>8.3f} %")


if __name__ == "__main__":
    main()
