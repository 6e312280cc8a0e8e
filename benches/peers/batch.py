#!/usr/bin/env python3
"""A thousand different scenes of 128² nodes from one process, by asperity and by aspher.

    python benches/peers/batch.py [SCENES] [NODES]

Run it by the Python of the peers (setup.sh) with asperity installed in it. Each scene is a surface of its own under a
mean pressure on a hard wall, to a certified or reached 1e-6, from heights in memory to the contact fraction. asperity
takes one thread a scene, one scene after the other or two at a time; aspher takes one. The rounds take turns.
"""

import statistics
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from importlib.metadata import version
from pathlib import Path

import asperity
import numpy as np

PRESSURE = 0.002  # a fiftieth of E* h', at an rms slope h' of 0.1


def ours(heights):
    return asperity.solve(heights, 1.0, modulus=1.0, mean_pressure=PRESSURE, threads=1).contact_fraction


def theirs(heights):
    import aspher

    result = aspher.solve_nested(
        grid_size=len(heights),
        gap=-heights.ravel(),
        p_nominal=PRESSURE,
        backend="periodic",
        tol=1e-6,
        precision="double",
        coarse_tol=1e-3,
        light_result=True,
    )
    return result.contact_area


def timed(solves):
    begin = time.perf_counter()
    found = solves()
    return time.perf_counter() - begin, found


def main():
    count, n = [int(text) for text in sys.argv[1:]] + [1000, 128][len(sys.argv) - 1 :]
    sys.path.insert(0, str(Path(sys.prefix).parent / "aspher-native"))
    surface = dict(hurst=0.8, k_l=4, k_s=n // 8, rms_slope=0.1)
    heights = [np.asarray(asperity.surface.self_affine(n, 1.0, seed=seed, **surface)) for seed in range(count)]
    with ThreadPoolExecutor(2) as pool:
        ways = {
            "asperity, one at a time": lambda: list(map(ours, heights)),
            "asperity, two at a time": lambda: list(pool.map(ours, heights)),
            "aspher, one at a time": lambda: list(map(theirs, heights)),
        }
        times = {name: [] for name in ways}
        for _ in range(3):
            areas = {}
            for name, solves in ways.items():
                seconds, areas[name] = timed(solves)
                times[name].append(seconds)
    first, *others = areas.values()
    worst = max(np.abs(np.subtract(first, other)).max() for other in others)
    print(f"{count} scenes of {n} x {n} nodes; asperity {version('asperity')}, aspher {version('aspher')}")
    for name, seconds in times.items():
        print(f"{name:<26} {1e3 * statistics.median(seconds) / count:7.2f} ms a scene")
    print(f"contact fractions differ by at most {worst:.1e}")


if __name__ == "__main__":
    main()
