#!/usr/bin/env python3
"""The overhead of a call from Python over the solve in Rust.

    python python/benches/overhead.py [NODES] [REPETITIONS] [THREADS]

A line for each scene: the least time of the solve; that of the rest of the call, and its median; the least rest over the
least solve; the least processor time of the call, all threads together; and the least time of the first look at the
report. The scenes take turns, and least times are those that other programs on the machine disturb least. The solve is
what `report["seconds"]` has: the problem and its solution, from heights to fields in memory. The rest are a copy of the
heights, the checks of input and answer, and the way of the fields to numpy. What a look finds, as the contact
statistics, is no part of the call.
"""

import gc
import statistics
import sys
import time

import asperity

LAW = asperity.Exponential(work_of_adhesion=1e-6, range=1e-3)
SCENES = {
    "f64": {},
    "f32": {"precision": "f32"},
    "f64, tolerance 1e-3": {"tolerance": 1e-3},
    "f64, one grid": {"nested": False},
    "f64, exponential": {"law": LAW},
}


def measured(heights, options):
    """The times of a solve, of the rest of its call, of the processor in it, and of a look at the report."""
    gc.collect()
    begin, processor = time.perf_counter(), time.process_time()
    solution = asperity.solve(heights, 1.0, modulus=1.0, mean_pressure=0.01, **options)
    called, processor = time.perf_counter(), time.process_time() - processor
    seconds = solution.report["seconds"]
    return seconds, called - begin - seconds, processor, time.perf_counter() - called


def main():
    nodes, repetitions, threads = (int(given) for given in (sys.argv[1:] + ["1024", "21", "0"][len(sys.argv) - 1 :])[:3])
    heights = asperity.surface.self_affine(nodes, 1.0, rms_slope=0.1, k_s=nodes / 16, seed=1).heights
    print(f"{nodes} x {nodes} nodes, {repetitions} turns, {threads or 'all'} threads")
    print(f"{'':<22} {'solve/s':>9} {'rest/ms':>9} {'median':>7} {'rest':>8} {'processor/s':>12} {'look/ms':>8}")
    gc.disable()
    turns = {name: [] for name in SCENES}
    # the first turn starts threads and plans transforms
    for turn in range(repetitions + 1):
        for name, options in SCENES.items():
            found = measured(heights, {**options, "threads": threads or None})
            if turn > 0:
                turns[name].append(found)
    for name, rows in turns.items():
        median = statistics.median(rest for _, rest, _, _ in rows)
        solve, rest, processor, look = (min(column) for column in zip(*rows))
        print(
            f"{name:<22} {solve:9.3f} {1e3 * rest:9.2f} {1e3 * median:7.2f} {100 * rest / solve:6.2f} % "
            f"{processor:12.3f} {1e3 * look:8.1f}"
        )


if __name__ == "__main__":
    main()
