#!/usr/bin/env python3
"""Solves in one process, of the tool with MPI and without, and in two: times and ratios, as medians over rounds.

    cargo build --release && .ci/mpi --quick          (which leaves the tool with MPI in target/mpi)
    benches/processes.py [NODES] [ROUNDS]             (2048 and 5)

A ratio is formed within each round, in which all take turns. The time is that of the report: from the heights in memory
to the solution in memory.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

TARGET = Path(__file__).resolve().parent.parent / "target"
PLAIN, SHARED = str(TARGET / "release/asperity"), str(TARGET / "mpi/asperity")
ROOT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def mpi(processes, threads):
    """The command of the tool with MPI."""
    job = ["mpiexec", "-q", "--oversubscribe", "--bind-to", "none", "-n", str(processes), SHARED]
    return job, threads


CASES = {
    "without MPI, 1 thread": ([PLAIN], 1),
    "1 process, 1 thread": mpi(1, 1),
    "without MPI, 2 threads": ([PLAIN], 2),
    "1 process, 2 threads": mpi(1, 2),
    "2 processes, 1 thread": mpi(2, 1),
}
RATIOS = [
    ("1 process, 1 thread", "without MPI, 1 thread"),
    ("2 processes, 1 thread", "1 process, 2 threads"),
    ("2 processes, 1 thread", "without MPI, 1 thread"),
]


def main():
    nodes = int(sys.argv[1]) if len(sys.argv) > 1 else 2048
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    with tempfile.TemporaryDirectory() as folder:
        run = lambda *words: subprocess.run(words, check=True, cwd=folder, env={**os.environ, **ROOT})
        surface = f"surface --size {nodes} --k-s {nodes // 8} --rms-slope 0.1 --quiet --out heights.npy"
        run(PLAIN, *surface.split())
        times = {name: [] for name in CASES}
        for _ in range(rounds):
            for name, (program, threads) in CASES.items():
                solve = f"solve --heights heights.npy --mean-pressure 0.002 --threads {threads} --no-pictures --quiet"
                run(*program, *solve.split(), "--force", "--out", "out")
                times[name].append(json.loads((Path(folder) / "out/report.json").read_text())["seconds"])
    for name, found in times.items():
        print(f"{name:24} {statistics.median(found):8.3f} s")
    for a, b in RATIOS:
        ratios = [x / y for x, y in zip(times[a], times[b])]
        print(f"{a} / {b}: {statistics.median(ratios):.3f} ({min(ratios):.3f} to {max(ratios):.3f})")


if __name__ == "__main__":
    main()
