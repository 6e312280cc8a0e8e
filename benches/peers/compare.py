#!/usr/bin/env python3
"""asperity against FFTW, SciPy, aspher, Tamaas and ContactMechanics, on the same heights, in one run; prints Markdown
tables.

    benches/peers/setup.sh                       (once)
    benches/peers/compare.py [--quick] [--rows application,wall,heavy,adhesion,free] [--csv FILE]

Rules
-----
1. One thread each. Every measurement is a process of its own, so that no program finds its memory or plans warm; our
   process and the peer's take turns (ours, theirs, ours, theirs ...). The ratio is formed within each round;
   the tables give the median of the ratios and, in brackets, the least and the largest.
2. Solves: the time counts from the heights in memory to the solution in memory, on both sides, with the construction of
   operators, plans and problem; without start-up of the process and reading of the file. It is the time of the
   processor, which other programs on the machine change less than the time of the clock. Applications: warm, plans made
   before (FFTW_MEASURE), the median of many in each process. Of several builds of FFTW the fastest counts, row by row.
3. Solves are compared at equal true error, not at equal tolerance, for no two programs mean the same by it. The reference
   is our solution at a tolerance of 1e-12 (or as low as it gets), cross-checked with the tightest of each peer. Two errors of
   a solution are taken against it: of the contact area, relative; and of the elastic pressure p in the energy norm,
   sqrt(<p-p*, K(p-p*)> / <p*, K p*>), as field. Every program runs once at each tolerance of a ladder. For a level it
   then gets the loosest tolerance which meets the level, as do all tighter ones of its ladder (so that nobody wins by a
   lucky error that crosses zero); of several modes of a program the faster counts.
4. Level "certified 1e-6": we have to certify the relative error in the energy norm by ourselves (tolerance 1e-6); for
   the peer it is enough that its true error is below 1e-6, which it need not know.
5. Where the tightest solution of a peer differs from the reference by more than 1e-3 in either measure, the run fails.
6. All rows are printed, whoever wins. A ratio above 1 means that asperity is faster. --csv writes every single
   measurement.
"""

import argparse
import csv
import datetime
import json
import os
import platform
import shlex
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CACHE = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "asperity-peers"
ONE_THREAD = {"OMP_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}

PRESSURE = 0.02  # of E* h', at an rms slope h' of 1
HEAVY = [0.127, 0.337, 0.64]  # the same, for contact of 25, 57 and 84 %
RADIUS, FORCE = 0.25, 0.1  # of the sphere that the same roughness is on, and of E* L²
SEED = 1
OURS = {
    "f64": ["3e-2", "1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5", "1e-5", "1e-6"],
    "f32": ["3e-2", "1e-2", "3e-3", "1e-3", "3e-4", "1e-4", "3e-5", "1e-5"],
}
# (the mode of aspher, its tolerances): the duality gap, quadratic in the error
ASPHER = {
    "f64": [
        ("double", ["1e-3", "3e-4", "1e-4", "3e-5", "1e-5", "3e-6", "1e-6", "3e-7", "1e-7", "1e-8", "1e-12"]),
        ("float_then_double", ["1e-6", "3e-7", "1e-7", "1e-8"]),
    ],
    "f32": [("float", ["1e-3", "3e-4", "1e-4", "3e-5", "1e-5", "4e-6", "2e-6"])],
}
# those at which the certified level is met
TIGHT = [("double", ["1e-6", "3e-7", "1e-7", "3e-8"]), ("float_then_double", ["1e-6", "3e-7", "1e-7"])]
TAMAAS = ["1e-3", "1e-4", "1e-5", "1e-6", "1e-8", "1e-10"]
# the largest penetration, a length
CONTACT_MECHANICS = ["1e-5", "1e-6", "1e-7", "1e-8"]
ADHESIVE = ["1e-2", "1e-3", "1e-4", "1e-5", "1e-6", "1e-8"]
# the levels: (name, which error, how small)
LEVELS = {
    "f64": [("area 1e-3", "area", 1e-3), ("area 1e-4", "area", 1e-4), ("certified 1e-6", "energy", 1e-6)],
    "f32": [("area 1e-3", "area", 1e-3), ("area 1e-4", "area", 1e-4), ("energy 1e-4", "energy", 1e-4)],
}


# what is kept of a measurement; round 0 belongs to a ladder
COLUMNS = "table nodes given program tolerance round seconds processor area_error energy_error peak status".split()


class Bench:
    def __init__(self, options):
        self.options = options
        self.rows = None
        if options.csv:
            self.rows = csv.DictWriter(open(options.csv, "w", newline="", buffering=1), COLUMNS, lineterminator="\n")
            self.rows.writeheader()
        self.peers = options.peers.resolve()
        self.python = self.peers / "venv/bin/python"
        self.disagreement = False
        if not self.python.exists():
            sys.exit(f"{self.python} is not there: run benches/peers/setup.sh, or name its folder with --peers")
        self.timed = ROOT / "target/release/examples/timed"
        self.folder = tempfile.TemporaryDirectory(prefix="asperity-peers-")
        self.work = Path(self.folder.name)
        build = ["cargo", "build", "--release", "--quiet"]
        subprocess.run([*build, "--bin", "asperity"], cwd=ROOT, check=True)
        subprocess.run([*build, "-p", "asperity-examples", "--example", "timed"], cwd=ROOT, check=True)

    def run(self, commands):
        """The last line of JSON of each (command, about how many seconds it takes).

        They run one after the other under the prefix, in batches of less than a minute, if a single command takes less.
        """
        batches, total = [], float("inf")
        for command, seconds in commands:
            total += seconds + 0.5
            if total > 45:
                batches.append([])
                total = seconds + 0.5
            batches[-1].append(f"{shlex.join(map(str, command))} | tail -n 1")
        reports = []
        for batch in batches:
            lines = "\n".join(batch)
            command = [*self.options.prefix.split(), "bash", "-c", f"set -eo pipefail\n{lines}"]
            done = subprocess.run(command, env=os.environ | ONE_THREAD, capture_output=True, text=True)
            if done.returncode != 0:
                sys.exit(f"{lines}\n{done.stderr}")
            reports += map(json.loads, done.stdout.splitlines())
        return reports

    def keep(self, report, **row):
        """Writes a measurement."""
        if self.rows:
            report = {name: report[name] for name in ("seconds", "processor", "peak", "status") if name in report}
            digits = {name: f"{value:.4g}" for name, value in (report | row).items() if isinstance(value, float)}
            self.rows.writerow(report | row | digits)

    def heights(self, n):
        path = self.work / f"{n}.npy"
        if not path.exists():
            shortest = min(64, n // 8)
            surface = ["surface", "--size", n, "--rms-slope", 1, "--hurst", 0.8, "--k-l", 4, "--k-s", shortest, "--seed", SEED]
            command = [ROOT / "target/release/asperity", *surface, "--out", path]
            subprocess.run(list(map(str, command)), check=True, capture_output=True)
        return path

    def rough_sphere(self, n):
        import numpy as np

        path = self.work / f"sphere-{n}.npy"
        if not path.exists():
            x = np.arange(n) / n - 0.5
            np.save(path, np.load(self.heights(n)) - (x[:, None] ** 2 + x[None, :] ** 2) / (2 * RADIUS))
        return path

    def ours(self, heights, settings, save=None):
        """The command of a solve of ours: the only place that knows how it is called."""
        command = [self.timed, heights, *options(settings), *self.options.ours.split()]
        return command + (["--save", save] if save else [])

    def theirs(self, program, heights, settings, save=None):
        command = [self.python, HERE / "peer.py", program, heights, *arguments(settings)]
        return command + ([f"save={save}"] if save else [])


def arguments(settings):
    return [f"{name}={value}" for name, value in settings.items()]


def options(settings):
    return [f"--{argument}" for argument in arguments(settings)]


def log(*words):
    print(*words, file=sys.stderr, flush=True)


def seconds(report):
    """The processor's time of a solve, and the clock's of an application."""
    return report.get("processor", report["seconds"])


def median(reports, value=seconds):
    return statistics.median(map(value, reports))


def ratio(ours, theirs):
    ratios = [seconds(b) / seconds(a) for a, b in zip(ours, theirs)]
    if len(ratios) == 1:
        return f"**{ratios[0]:.2f}** (one run)"
    return f"**{statistics.median(ratios):.2f}** ({min(ratios):.2f}–{max(ratios):.2f})"


def table(head, rows):
    print("| " + " | ".join(head) + " |")
    print("|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print(flush=True)


# ---- operator applications ----


def application(bench):
    sizes = [512, 1024] if bench.options.quick else [512, 1024, 2048, 4096]
    rounds = 3 if bench.options.quick else 7
    cases, todo = [], []
    for n in sizes:
        for precision, bits in [("f64", 64), ("f32", 32)]:
            repeat = max(5, 40 * 512 // n)
            path = bench.heights(n)
            kind = {"precision": precision, "apply": repeat}
            scipy = [bench.python, HERE / "peer.py", "scipy", path, *arguments(kind)]
            commands = {"ours": [bench.timed, path, *options(kind)], "scipy": scipy}
            for i, library in enumerate((bench.peers / f"fftw{bits}.libraries").read_text().split()):
                commands[i] = [bench.peers / f"fftw{bits}", library, n, repeat, bench.work / f"wisdom-{bits}-{i}"]
            cases.append((n, precision, list(commands)))
            # the first round of FFTW makes the plans; it does not count
            todo += [(command, 10 * (n / 4096) ** 2) for command in commands.values()]
            todo += [(command, 4 * (n / 4096) ** 2) for command in commands.values()] * rounds
    reports, rows = bench.run(todo), []
    for n, precision, names in cases:
        mine, reports = reports[: len(names) * (rounds + 1)], reports[len(names) * (rounds + 1) :]
        found = {name: mine[len(names) + i :: len(names)] for i, name in enumerate(names)}
        for name, timed in found.items():
            program = {"ours": "asperity"}.get(name, name if name == "scipy" else f"FFTW {name}")
            for i, report in enumerate(timed):
                bench.keep(report, table="application", nodes=n, given=precision, program=program, round=i + 1)
        squares = [found[name][0]["check"] for name in ("ours", "scipy")]
        if abs(squares[0] / squares[1] - 1) > 1e-3:
            sys.exit(f"the applications of asperity and SciPy differ at {n}: {squares}")
        builds = [name for name in names if isinstance(name, int)]
        best = min(builds, key=lambda i: median(found[i]))
        times = [f"{1e3 * median(found[i]):.2f}" for i in builds]
        inverse = statistics.median(a["seconds"] / b["seconds"] for a, b in zip(found["ours"], found[best]))
        rows.append(
            [
                f"{n}²",
                precision,
                f"{1e3 * median(found['ours']):.2f}",
                " / ".join(f"**{t}**" if i == best else t for i, t in zip(builds, times)),
                ratio(found["ours"], found[best]),
                f"{inverse:.2f}",
                ratio(found["ours"], found["scipy"]),
            ]
        )
    print("### One operator application: forward transform, product, inverse\n")
    head = ["grid", "", "asperity, ms", "FFTW, ms: as packaged / built for this machine"]
    table(head + ["FFTW / asperity", "asperity / FFTW", "SciPy / asperity"], rows)


# ---- solves ----


class Case:
    """A problem on one grid, with its reference solution."""

    table = "wall"

    def __init__(self, bench, n, problem):
        import numpy as np
        from scipy import fft

        self.bench, self.n, self.problem, self.np, self.fft = bench, n, problem, np, fft
        self.weights, self.heights = self.compliances(), bench.heights(n)

    def compliances(self):
        np, n = self.np, self.n
        # K on the half spectrum, with the weights of Parseval's sum
        k = np.fft.fftfreq(n, 1 / n)[:, None]
        l = np.arange(n // 2 + 1)[None, :]
        q = np.hypot(k, l)
        q[0, 0] = np.inf
        return np.where((l == 0) | (2 * l == n), 1.0, 2.0) / (np.pi * q)

    def settings(self, precision, tolerance):
        return {"precision": precision, "tolerance": tolerance} | self.problem

    def square(self, pressure):
        spectrum = self.fft.rfft2(pressure)
        return float((self.weights * (spectrum.real**2 + spectrum.imag**2)).sum())

    def errors(self, report, path):
        pressure = self.np.load(path)
        area = abs(report["area"] / self.reference["area"] - 1)
        return {"area": area, "energy": (self.square(pressure - self.pressure) / self.energy) ** 0.5}

    def ours(self, precision):
        command = lambda tolerance, save=None: self.bench.ours(self.heights, self.settings(precision, tolerance), save)
        return f"asperity {precision}", command, OURS[precision], 0.4 * (self.n / 512) ** 2

    def aspher(self, mode, tolerances):
        command = lambda tolerance, save=None: self.bench.theirs("aspher", self.heights, self.settings(mode, tolerance), save)
        return f"aspher {mode}", command, tolerances, 0.5 * (self.n / 512) ** 2

    def tamaas(self, tolerances):
        command = lambda tolerance, save=None: self.bench.theirs("tamaas", self.heights, self.settings("f64", tolerance), save)
        return "tamaas", command, tolerances, (6 if "work" in self.problem else 3) * (self.n / 512) ** 3

    def climb(self, ladders):
        """Finds the reference and runs the ladders: for each a list of (tolerance, command, report, errors)."""
        reference = self.bench.work / "reference.npy"
        todo = [(self.bench.ours(self.heights, self.settings("f64", "1e-12"), reference), (self.n / 512) ** 2)]
        path = lambda i, tolerance: self.bench.work / f"solution-{i}-{tolerance}.npy"
        for i, (_, command, tolerances, about) in enumerate(ladders):
            todo += [(command(tolerance, path(i, tolerance)), about) for tolerance in tolerances]
        self.reference, *reports = self.bench.run(todo)
        log(self.n, "reference:", self.reference)
        self.pressure = self.np.load(reference)
        self.energy = self.square(self.pressure)
        steps = []
        for i, (name, command, tolerances, _) in enumerate(ladders):
            steps.append([])
            for tolerance in tolerances:
                report = reports.pop(0)
                errors = self.errors(report, path(i, tolerance))
                path(i, tolerance).unlink()
                steps[-1].append((tolerance, command(tolerance), report, errors, name))
                self.keep(steps[-1][-1], report, 0)
                log(f"{self.n} {name} {tolerance}: {seconds(report):.3f} s, {report['status']},", errors)
        return steps

    def keep(self, step, report, round):
        """Writes a measurement of a step."""
        tolerance, _, _, errors, program = step
        table = "adhesion" if "work" in self.problem else self.table
        given = next(name for name in ("pressure", "gap", "approach") if name in self.problem)
        row = dict(table=table, nodes=self.n, given=given, program=program, tolerance=tolerance, round=round)
        self.bench.keep(report, **row, area_error=errors["area"], energy_error=errors["energy"])

    def agreement(self, steps):
        """How far the tightest of a peer is from the reference, as words."""
        tolerance, _, _, errors, _ = steps[-1]
        self.bench.disagreement |= errors["area"] > 1e-3 or errors["energy"] > 1e-3
        nodes = round(errors["area"] * self.reference["area"] * self.n**2)
        return f"contact areas differ by {nodes} nodes, pressures by {errors['energy']:.0e} (its tolerance {tolerance})"


class FreeCase(Case):
    """A rough sphere on a free half-space."""

    table = "free"

    def __init__(self, bench, n, problem):
        super().__init__(bench, n, problem | {"boundary": "free"})
        self.heights = bench.rough_sphere(n)

    def compliances(self):
        """Love's kernel on the padded grid, as its modes."""
        np, n = self.np, self.n
        x = np.minimum(np.arange(2 * n), 2 * n - np.arange(2 * n)) / n
        x, y, half = x[:, None], x[None, :], 0.5 / n
        f = lambda t, s, u: t * (np.arcsinh(s / np.abs(t)) - np.arcsinh(u / np.abs(t)))
        low, high = (x - half, y - half), (x + half, y + half)
        kernel = f(high[0], high[1], low[1]) + f(high[1], high[0], low[0])
        kernel += f(low[0], low[1], high[1]) + f(low[1], low[0], high[0])
        modes = self.fft.rfft2(kernel / np.pi).real
        l = np.arange(n + 1)[None, :]
        return modes * np.where((l == 0) | (l == n), 1.0, 2.0)

    def square(self, pressure):
        spectrum = self.fft.rfft2(pressure, s=(2 * self.n, 2 * self.n))
        return float((self.weights * (spectrum.real**2 + spectrum.imag**2)).sum())

    def contact_mechanics(self, tolerances):
        theirs = lambda settings, save: self.bench.theirs("contactmechanics", self.heights, settings, save)
        command = lambda tolerance, save=None: theirs(self.settings("f64", tolerance), save)
        return "ContactMechanics", command, tolerances, 20 * (self.n / 512) ** 2


def chosen(steps, error, limit):
    """The loosest step that meets the limit as do all tighter ones, or None."""
    found = None
    for step in reversed(steps):
        if step[3][error] > limit:
            break
        found = step
    return found


def cell(step, reports):
    tolerance, _, _, errors, _ = step
    return f"{median(reports):.3g} s ({tolerance}; {errors['area']:.0e}, {errors['energy']:.0e})"


def compared(case, wanted):
    """A row and the reports of both for each (our ladder, the ladder of a peer, level, rounds)."""
    found, todo = [], []
    for ours, modes, (name, error, limit), rounds in wanted:
        mine = ours[-1] if name.startswith("certified") else chosen(ours, error, limit)
        candidates = [step for step in (chosen(steps, error, limit) for steps in modes) if step]
        peer = min(candidates, key=lambda step: seconds(step[2]), default=None)
        rounds = rounds if mine and peer else 0
        found.append((name, mine, peer, rounds))
        if rounds:
            todo += [(mine[1], mine[2]["seconds"]), (peer[1], peer[2]["seconds"])] * rounds
    reports, rows = case.bench.run(todo), []
    for name, mine, peer, rounds in found:
        both, reports = reports[: 2 * rounds], reports[2 * rounds :]
        first, second = both[::2], both[1::2]
        for step, reports_of in ((mine, first), (peer, second)):
            for i, report in enumerate(reports_of):
                case.keep(step, report, i + 1)
        cells = [cell(step, times or [step[2]]) if step else "not reached" for step, times in ((mine, first), (peer, second))]
        rows.append(([name, *cells, ratio(first, second) if rounds else "–"], first, second))
        log(case.n, rows[-1][0])
    return rows


def compared_once(mine, peer):
    """A row of the tightest of ours and a step of a peer, as they ran on their ladders."""
    cells = [cell(step, [step[2]]) for step in (mine[-1], peer)]
    return [LEVELS["f64"][-1][0], *cells, ratio([mine[-1][2]], [peer[2]])]


HEAD = ["grid", "", "peer", "level", "asperity (tolerance; errors of area, energy)", "peer (the same)", "peer / asperity"]


def wall(bench):
    rows, notes, memory = [], [], []
    for n in [512] if bench.options.quick else bench.options.sizes:
        rounds = 3 if bench.options.quick or n > 1024 else 5
        case = Case(bench, n, {"pressure": PRESSURE})
        ladders = {precision: [case.ours(precision), *(case.aspher(*mode) for mode in ASPHER[precision])] for precision in OURS}
        all_ladders = ladders["f64"] + ladders["f32"] + ([case.tamaas(TAMAAS)] if n <= 1024 else [])
        steps = case.climb(all_ladders)
        note = f"{n}²: reference {100 * case.reference['area']:.4f} % contact, certified to "
        note += f"{case.reference['relative_error']:.0e}; aspher: {case.agreement(steps[1])}"
        double, single = steps[: len(ladders["f64"])], steps[len(ladders["f64"]) :][: len(ladders["f32"])]
        wanted = [("aspher", "f64", (double[0], double[1:], level, rounds)) for level in LEVELS["f64"]]
        wanted += [("aspher", "f32", (single[0], single[1:], level, rounds)) for level in LEVELS["f32"]]
        if n <= 1024:
            few = 3 if n <= 512 else 1
            wanted += [("Tamaas", "f64", (double[0], [steps[-1]], level, few)) for level in LEVELS["f64"]]
            note += f"; Tamaas: {case.agreement(steps[-1])}"
        notes.append(note)
        for (peer, precision, (*_, level, _)), (row, first, second) in zip(wanted, compared(case, [w for *_, w in wanted])):
            rows.append([f"{n}²", precision, peer, *row])
            if first and peer == "aspher" and level is LEVELS[precision][-1]:
                memory.append((n, precision, level[0], first, second))
    print(f"### Hard wall, p̄ = {PRESSURE} E*h', H = 0.8, k = 4…64, or to eight nodes a wave, seed {SEED}\n")
    table(HEAD, rows)
    for note in notes:
        print(f"- {note}")
    print("\n### Peak resident memory of the whole process, MiB (scalars of the solve's precision per node)\n")
    lines = []
    for n, precision, level, first, second in memory:
        field = n * n * (8 if precision == "f64" else 4)
        mib = lambda size: f"{size / 2**20:.0f} ({size / field:.1f})"
        of = lambda reports, name: statistics.median(report[name] for report in reports)
        base, a, b = of(second, "base"), of(first, "peak"), of(second, "peak")
        lines.append([f"{n}²", precision, level, mib(a), mib(b), mib(b - base), f"**{(b - base) / a:.2f}**"])
    table(["grid", "", "level", "asperity", "aspher", "aspher less interpreter", "aspher less interpreter / asperity"], lines)


def heavy(bench):
    rows, notes, level = [], [], LEVELS["f64"][-1]
    for n, pressure in [(512, p) for p in HEAVY] if bench.options.quick else [(1024, p) for p in HEAVY] + [(4096, PRESSURE)]:
        case = Case(bench, n, {"pressure": pressure})
        case.table = f"wall at {pressure}"
        large = n > 1024
        ladders = [case.ours("f64"), *(case.aspher(*mode) for mode in TIGHT)] + ([] if large else [case.tamaas(["1e-6", "1e-7"])])
        ours, *theirs = case.climb(ladders)
        contact = f"{100 * case.reference['area']:.1f} %"
        notes.append(f"{n}², {contact}: aspher: {case.agreement(theirs[0])}")
        wanted = [(ours, theirs[: len(TIGHT)], level, 3)]
        if not large:
            wanted.append((ours, theirs[len(TIGHT) :], level, 1))
            notes[-1] += f"; Tamaas: {case.agreement(theirs[-1])}"
        for peer, (row, _, _) in zip(("aspher", "Tamaas"), compared(case, wanted)):
            rows.append([f"{n}²", contact, peer, *row[1:]])
    print(f"### Hard wall to a certified 1e-6, as above, at p̄ = {', '.join(map(str, HEAVY))} E*h', and on a large grid\n")
    table(["grid", "contact", *HEAD[2:3], *HEAD[4:]], rows)
    for note in notes:
        print(f"- {note}")
    print()


def adhesion(bench):
    import numpy as np

    rows, notes, certified = [], [], ADHESIVE[-1]
    for n in [512] if bench.options.quick else [n for n in bench.options.sizes if n <= 1024]:
        rms = float(np.load(bench.heights(n)).std())
        wall = bench.ours(bench.heights(n), {"pressure": PRESSURE, "tolerance": "1e-8"})
        [wall] = bench.run([(wall, (n / 512) ** 2)])
        case = Case(bench, n, {"gap": wall["mean_gap"], "range": 0.1 * rms, "work": 0.1 * 0.1 * rms})
        large = n > 512
        # a minute or two on the large grid: one run, at the tolerance that certified 1e-6 took on the small one
        tolerances = [certified] if large else ADHESIVE[1::2] if bench.options.quick else ADHESIVE
        ours, steps = case.climb([case.ours("f64"), case.tamaas(tolerances)])
        certified = (chosen(steps, "energy", 1e-6) or steps[-1])[0]
        note = f"{n}²: reference {100 * case.reference['area']:.4f} % contact, certified to {case.reference['relative_error']:.0e}"
        notes.append(f"{note}; Tamaas: {case.agreement(steps)}")
        if large:
            rows.append([f"{n}²", "f64", "Tamaas", *compared_once(ours, steps[0])])
            continue
        rounds = 1 if bench.options.quick else 3
        for row, _, _ in compared(case, [(ours, [steps], level, rounds) for level in LEVELS["f64"]]):
            rows.append([f"{n}²", "f64", "Tamaas", *row])
    print("### Exponential law, ρ = 0.1 h_rms, w = 0.1 E*h'ρ, at the mean gap of the hard wall\n")
    table(HEAD, rows)
    for note in notes:
        print(f"- {note}")
    print()


def free(bench):
    rows, notes, certified = [], [], CONTACT_MECHANICS[-1]
    for n in [512] if bench.options.quick else bench.options.sizes:
        rounds = 3 if bench.options.quick or n > 1024 else 5
        large = n > 512
        # minutes on the large grid: one run, at the tolerance that certified 1e-6 took on the small one, or its tightest
        tolerances = [certified] if large else CONTACT_MECHANICS[1::2] if bench.options.quick else CONTACT_MECHANICS
        case = FreeCase(bench, n, {"pressure": FORCE})
        aspher = [case.aspher(*mode) for mode in ASPHER["f64"]]
        ladders = [case.ours("f64"), *aspher] + ([case.contact_mechanics(tolerances)] if n <= 1024 else [])
        ours, *theirs = case.climb(ladders)
        slow = theirs.pop() if n <= 1024 else None
        notes.append(
            f"{n}²: reference {100 * case.reference['area']:.4f} % contact, certified to "
            f"{case.reference['relative_error']:.0e}; aspher: {case.agreement(theirs[0])}"
        )
        wanted = [(ours, theirs, level, rounds) for level in LEVELS["f64"]]
        found = [("force", "aspher", row) for row, _, _ in compared(case, wanted)]
        rows += [[f"{n}²", *cells, *row] for *cells, row in found]
        if not slow:
            continue
        certified = (chosen(slow, "energy", 1e-6) or slow[-1])[0]
        notes[-1] += f"; ContactMechanics: {case.agreement(slow)}"
        found = []
        # and at the approach of that force
        for held in ("force", "approach"):
            if held == "approach":
                case = FreeCase(bench, n, {"approach": case.reference["approach"]})
                ours, slow = case.climb([case.ours("f64"), case.contact_mechanics(tolerances)])
                notes[-1] += f", by approach {case.agreement(slow)}"
            if large:
                found.append((held, "ContactMechanics", compared_once(ours, slow[0])))
            else:
                levels = compared(case, [(ours, [slow], level, 1) for level in LEVELS["f64"]])
                found += [(held, "ContactMechanics", row) for row, _, _ in levels]
        rows += [[f"{n}²", *cells, *row] for *cells, row in found]
    print(f"### Rough sphere on a free half-space, R = {RADIUS} L, F = {FORCE} E*L², roughness as on the hard wall\n")
    table(["grid", "given", *HEAD[2:]], rows)
    for note in notes:
        print(f"- {note}")
    print()


def conditions(bench):
    model = next((l.split(":")[1].strip() for l in Path("/proc/cpuinfo").read_text().splitlines() if "model name" in l), "?")
    flags = next((l for l in Path("/proc/cpuinfo").read_text().splitlines() if l.startswith("flags")), "")
    vectors = "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else "SSE2"
    git = subprocess.run(["git", "describe", "--always", "--dirty"], cwd=ROOT, capture_output=True, text=True)
    names = ["tamaas", "ContactMechanics", "numpy", "scipy", "aspher"]
    code = f"from importlib.metadata import version; print(', '.join(f'{{p}} {{version(p)}}' for p in {names}))"
    where = os.environ | {"PYTHONPATH": str(bench.peers / "aspher-native")}
    versions = subprocess.run([bench.python, "-c", code], env=where, capture_output=True, text=True).stdout.strip()
    print(
        f"{datetime.date.today()}; {model} ({os.cpu_count()} cores, {vectors}), {platform.system()}; asperity "
        f"{git.stdout.strip() or '?'}; FFTW 3.3.10, {versions}. One thread. Ratios: median (least–largest of the rounds); "
        "above 1 asperity is faster.\n",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peers", type=Path, default=CACHE, help="the folder that setup.sh filled")
    parser.add_argument("--quick", action="store_true", help="512² (and 1024² applications) only, fewer rounds")
    sizes = lambda text: [int(n) for n in text.split(",")]
    parser.add_argument("--sizes", type=sizes, default=[128, 256, 512, 1024, 2048], help="nodes along a side, of the solves")
    parser.add_argument("--rows", default="application,wall,heavy,adhesion,free", help="which tables")
    parser.add_argument("--csv", type=Path, help="a file for every single measurement")
    parser.add_argument("--prefix", default="", help="a command to run every measurement under, such as 'taskset -c 1'")
    ours = "further options for every solve of examples/timed.rs, as in --ours=--method=nested"
    parser.add_argument("--ours", default="", help=ours)
    options = parser.parse_args()
    # SciPy is in the peers' environment
    python = options.peers.resolve() / "venv/bin/python"
    if python.exists() and Path(sys.prefix) != python.parent.parent:
        os.execv(python, [str(python), __file__, *sys.argv[1:]])
    bench = Bench(options)
    conditions(bench)
    tables = {"application": application, "wall": wall, "heavy": heavy, "adhesion": adhesion, "free": free}
    for name in options.rows.split(","):
        if name not in tables:
            sys.exit(f"--rows {name}: the tables are {', '.join(tables)}")
        tables[name](bench)
    if bench.disagreement:
        sys.exit("a peer at its tightest tolerance differs from the reference by more than 1e-3: see the notes below the tables")


if __name__ == "__main__":
    main()
