#!/usr/bin/env python3
"""The overhead of a call from Python over the solve in Rust.

    python python/benches/overhead.py [NODES] [REPETITIONS]

A line for each scene: the median time of the solve, that of the call, and the median of the overhead, all of the same
calls. The solve is what `report["seconds"]` has: the problem and its solution, from heights to fields in memory. What
is left of the call are checks and copies of the input, the statistics of the report, and the way of the fields to
numpy.
"""

import statistics
import sys
import time

import asperity

LAW = asperity.Exponential(work_of_adhesion=1e-6, range=1e-3)
SCENES = {
    "f64": {},
    "f32": {"precision": "f32"},
    "f64, tolerance 1e-3": {"tolerance": 1e-3},
    "f64, exponential": {"law": LAW},
}


def main():
    nodes = int(sys.argv[1]) if len(sys.argv) > 1 else 1024
    repetitions = int(sys.argv[2]) if len(sys.argv) > 2 else 9
    heights = asperity.surface.self_affine(nodes, 1.0, rms_slope=0.1, k_s=nodes / 16, seed=1).heights
    print(f"{nodes} x {nodes} nodes, {repetitions} calls     solve / s   call / s   overhead")
    for name, options in SCENES.items():
        calls, solves = [], []
        for _ in range(repetitions + 1):
            begin = time.perf_counter()
            solution = asperity.solve(heights, 1.0, modulus=1.0, mean_pressure=0.01, **options)
            calls.append(time.perf_counter() - begin)
            solves.append(solution.report["seconds"])
        # the first call starts threads and plans transforms
        del calls[0], solves[0]
        overhead = statistics.median(call / solve - 1 for call, solve in zip(calls, solves))
        solve, call = statistics.median(solves), statistics.median(calls)
        print(f"{name:<32} {solve:9.3f} {call:10.3f} {100 * overhead:9.2f} %")


if __name__ == "__main__":
    main()
