#!/usr/bin/env python3
"""A thousand different scenes of 128² nodes from one process, by asperity and by aspher.

    python benches/peers/batch.py [SCENES] [NODES] [ROUNDS.csv]

Run it by the Python of the peers (setup.sh) with asperity installed in it. Each scene is a surface of its own under a
mean pressure on a hard wall, to a certified or reached 1e-6, from heights in memory to the contact fraction. asperity
takes one thread a scene, one scene after the other or two at a time; aspher takes all cores for a scene. The rounds take
turns. The time of the processor shows what each one takes of the cores.
"""

import csv
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
    begin, busy = time.perf_counter(), time.process_time()
    found = solves()
    return (time.process_time() - busy, time.perf_counter() - begin), found


def main():
    count, n = [int(text) for text in sys.argv[1:3]] + [1000, 128][len(sys.argv[1:3]) :]
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
    print(f"{'ms a scene':<26} {'processor':>9} {'clock':>9}")
    for name, rounds in times.items():
        print(f"{name:<26}", *(f"{1e3 * statistics.median(kind) / count:9.2f}" for kind in zip(*rounds)))
    ratios = [theirs / ours for (ours, _), (theirs, _) in zip(times["asperity, one at a time"], times["aspher, one at a time"])]
    print(f"aspher / asperity, processor, one at a time: {statistics.median(ratios):.2f} ({min(ratios):.2f}–{max(ratios):.2f})")
    if len(sys.argv) > 3:
        with open(sys.argv[3], "w", newline="") as file:
            out = csv.writer(file, lineterminator="\n")
            out.writerow(["program", "scenes", "nodes", "round", "processor", "seconds"])
            for name, rounds in times.items():
                out.writerows([name, count, n, i, *(f"{t:.4g}" for t in pair)] for i, pair in enumerate(rounds, 1))
    print(f"contact fractions differ by at most {worst:.1e}")


if __name__ == "__main__":
    main()
