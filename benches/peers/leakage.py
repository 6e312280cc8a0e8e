#!/usr/bin/env python3
"""asperity leak against reynoldsflow on the same gaps near percolation; prints a Markdown table.

    benches/peers/setup.sh                       (once)
    benches/peers/leakage.py [--sizes 512 1024] [--limit 300] [--memory 12]

The gaps come from a solve: a self-affine surface (k = 4…N/16, rms slope 0.1, seed 1) under a mean pressure of 0.0205 E*.
Both programs take the cube of the gap at the nodes, its harmonic mean at the faces, and a periodic cell: they solve the same
network. asperity encloses the transmissivities along x and along y between bounds of a relative distance of 1e-6;
reynoldsflow solves for the flow along x, to its relative residual of 1e-12. Each measurement is a process of its own on one
core. The time is the processor's: of the whole process of asperity, and of the solve alone of reynoldsflow, once its
functions are compiled. The memory is the peak of the process. A solver that passes the limit of seconds, or of memory in
GiB, is left out on larger grids. The run fails where a flow lies further outside of the bounds than its residual allows.
"""

import argparse
import json
import os
import platform
import resource
import signal
import subprocess
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "asperity-peers"
SOLVERS = ["scipy.amg-rs", "scipy.amg-smooth_aggregation", "scipy-spsolve", "pardiso"]
PRESSURE = "0.0205"
ALLOWED = 1e-6  # of a flow from the bounds, relative


def theirs(path, solver):
    """Prints the transmissivity along x by a solver of reynoldsflow, and the seconds of the processor."""
    import numpy as np
    from reynoldsflow import transport

    def flow(gap):
        options = {"solver": solver, "boundary_mode": "periodic", "pressure_gradient": 1.0}
        kept, _, flux = transport.solve_fluid_problem(gap, **options)
        return transport.compute_total_flux(kept, flux, len(gap), boundary_mode="periodic")[0]

    flow(1.0 + np.random.default_rng(0).random((32, 32)))  # compiles
    gap = np.load(path)
    begin = time.process_time()
    found = flow(gap) / 12
    packages = {name: version(name) for name in ("reynoldsflow", "pyamg", "scipy", "numba", "pypardiso")}
    print(json.dumps({"transmissivity": found, "seconds": time.process_time() - begin, "packages": packages}))


class Failed(Exception):
    """A measurement that passed a limit."""


def measured(command, limit, memory):
    """What a command prints on one core, the seconds of its processor, and its peak memory in MiB."""

    def bounded():
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})
        resource.setrlimit(resource.RLIMIT_AS, (memory << 30, memory << 30))
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 5))

    threads = {name: "1" for name in ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")}
    with tempfile.TemporaryFile() as told, tempfile.TemporaryFile() as said:
        child = subprocess.Popen(command, stdout=told, stderr=said, preexec_fn=bounded, env=os.environ | threads)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
        used = usage.ru_utime + usage.ru_stime
        if child.returncode == -signal.SIGXCPU:
            raise Failed(f"more than {limit} s")
        if child.returncode:
            said.seek(0)
            last = said.read().decode().strip().rpartition("\n")[2]
            raise Failed(f"{last or 'killed'} ({used:.0f} s, {usage.ru_maxrss >> 10} MiB)")
        told.seek(0)
        return json.loads(told.read()), used, usage.ru_maxrss >> 10


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", type=int, nargs="+", default=[512, 1024, 2048, 4096])
    parser.add_argument("--solvers", nargs="+", default=SOLVERS)
    parser.add_argument("--limit", type=int, default=300, help="seconds of the processor")
    parser.add_argument("--memory", type=int, default=12, help="GiB of addresses")
    parser.add_argument("--peers", type=Path, default=CACHE, help="folder of setup.sh")
    parser.add_argument("--asperity", type=Path, default=ROOT / "target/release/asperity")
    parser.add_argument("--one", nargs=2, metavar=("GAP", "SOLVER"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        return theirs(*options.one)
    python, left, packages, outside = options.peers / "venv/bin/python", list(options.solvers), {}, []
    head = ["grid", "asperity: x between, y between", "s", "MiB"]
    head += [f"{solver}: distance from the bounds of x, s, MiB" for solver in left]
    print("| " + " | ".join(head) + " |\n" + "|---" * len(head) + "|", flush=True)
    for n in options.sizes:
        with tempfile.TemporaryDirectory() as folder:
            heights, pressed = Path(folder, "heights.npy"), Path(folder, "pressed")
            make = f"surface --size {n} --lengths 1 --k-l 4 --k-s {n // 16} --rms-slope 0.1 --seed 1 --out {heights}"
            press = f"solve --heights {heights} --lengths 1 --modulus 1 --mean-pressure {PRESSURE} --out {pressed}"
            for command in (make, press):
                subprocess.run([options.asperity, *command.split()], check=True, stdout=subprocess.DEVNULL)
            gap = pressed / "gap.npy"
            command = [options.asperity, "leak", gap, "--lengths", "1", "--json"]
            report, seconds, mebibytes = measured(command, 3600, 1 << 10)
            x, y = (report["transmissivity"][axis] for axis in "xy")
            row = [f"{n}²", f"{x['lower']:.7e} {x['upper']:.7e}, {y['lower']:.7e} {y['upper']:.7e}"]
            row += [f"{seconds:.2f}", str(mebibytes)]
            for solver in options.solvers:
                if solver not in left:
                    row.append("–")
                    continue
                try:
                    command = [python, __file__, "--one", gap, solver]
                    found, _, mebibytes = measured(command, options.limit, options.memory)
                    flow, packages = found["transmissivity"], found["packages"]
                    distance = max(x["lower"] - flow, flow - x["upper"], 0.0) / x["upper"]
                    outside += [f"{n}² {solver}: {distance:.1e}"] if distance > ALLOWED else []
                    row.append(f"{distance:.0e}, {found['seconds']:.1f}, {mebibytes}")
                except Failed as failed:
                    left.remove(solver)
                    row.append(str(failed))
        print("| " + " | ".join(row) + " |", flush=True)
    told = ", ".join(f"{name} {number}" for name, number in packages.items())
    print(f"\n{time.strftime('%Y-%m-%d')}; {platform.machine()}, one core; {told}.")
    if outside:
        sys.exit("outside of the bounds: " + "; ".join(outside))


if __name__ == "__main__":
    main()
