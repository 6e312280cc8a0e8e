#!/usr/bin/env python3
"""Many different scenes from one process of Python, against their solves alone.

    python python/benches/many_scenes.py [SCENES] [NODES]

Each scene is a surface of its own under one load, on a hard wall and with an exponential law; surfaces are made before.
A line has the time of a scene in a loop on one thread, and in pools of a thread and of a process for each core. Shares
are of the speed of the solves alone, as ``report["seconds"]`` has them in the loop, on one core, or on all. The ways
take turns, and times are the least of three rounds.
"""

import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import asperity

LAWS = {"hard wall": None, "exponential law": asperity.Exponential(work_of_adhesion=1e-5, range=4e-3)}


def solved(scene):
    """The solution of a surface with a law."""
    rough, law = scene
    return asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law, threads=1)


def contact(scene):
    """The contact fraction, which is known with the solve."""
    return solved(scene).contact_fraction


def timed(map_of, scenes):
    """The milliseconds of a scene, and all contact fractions."""
    begin = time.perf_counter()
    found = list(map_of(contact, scenes))
    return 1e3 * (time.perf_counter() - begin) / len(scenes), found


def main():
    count, nodes = (int(given) for given in (sys.argv[1:] + ["1000", "128"][len(sys.argv) - 1 :])[:2])
    cores = os.cpu_count()
    surfaces = [asperity.surface.self_affine(nodes, 1.0, rms_slope=0.1, k_s=nodes / 8, seed=k) for k in range(count)]
    print(f"{count} scenes of {nodes} x {nodes} nodes, ms a scene; {cores} cores")
    print(f"{'':<16} {'solve':>6} {'loop':>6} {'share':>6} {'threads':>8} {'share':>6} {'processes':>10} {'share':>6}")
    with ThreadPoolExecutor(cores) as threads, ProcessPoolExecutor(cores) as processes:
        ways = [map, threads.map, lambda *given: processes.map(*given, chunksize=10)]
        for name, law in LAWS.items():
            scenes = [(surface, law) for surface in surfaces]
            alone, rounds = [], []
            for _ in range(3):
                alone.append(1e3 * sum(solved(scene).report["seconds"] for scene in scenes) / count)
                rounds.append([timed(way, scenes) for way in ways])
            assert all(found == rounds[0][0][1] for one in rounds for _, found in one)
            solve, times = min(alone), [min(time for time, _ in way) for way in zip(*rounds)]
            shares = [f"{100 * solve / time:4.0f} %" for time in (times[0], cores * times[1], cores * times[2])]
            print(f"{name:<16} {solve:6.2f} {times[0]:6.2f} {shares[0]:>6} {times[1]:8.2f} {shares[1]:>6}", end="")
            print(f" {times[2]:10.2f} {shares[2]:>6}")


if __name__ == "__main__":
    main()
