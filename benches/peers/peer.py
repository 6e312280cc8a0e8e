"""One measurement of a peer, in a process of its own, as examples/timed.rs does it for asperity.

    python peer.py PROGRAM HEIGHTS [NAME=VALUE ...]

Prints a line of JSON. `seconds` counts from the heights in memory to the solution in memory, and `processor` is the time
of the processor within; whatever the program builds to get there (model, operator, plans) is included, and so it is for
asperity. The side of the surface and E* are 1.
"""

import json
import statistics
import sys
import time
from pathlib import Path

import numpy as np


def resident(name):
    """VmRSS or VmHWM of this process, in bytes."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith(name):
            return 1024 * int(line.split()[1])
    return None


class Clock:
    """The time since it was made."""

    def __init__(self):
        self.begin, self.busy = time.perf_counter(), time.process_time()

    def read(self):
        return {"seconds": time.perf_counter() - self.begin, "processor": time.process_time() - self.busy}


def forget_peak():
    Path("/proc/self/clear_refs").write_text("5")


def symbol(n, kind=np.float64):
    """q/2 of E*|q|/2 on the half spectrum."""
    k = np.fft.fftfreq(n, 1 / n)
    return (np.pi * np.hypot(k[:, None], np.arange(n // 2 + 1)[None, :])).astype(kind)


def aspher(path, options):
    """Nested, periodic or free. Light result, coarse tolerance 1e-3, build: the fastest of those tried (see README.md)."""
    build = "portable" if options["precision"] == "float" else "native"
    sys.path.insert(0, str(Path(sys.prefix).parent / f"aspher-{build}"))
    import aspher as program

    base = resident("VmRSS")
    gap = -np.load(path)
    n = gap.shape[0]
    gap = gap.ravel()
    forget_peak()
    clock = Clock()
    result = program.solve_nested(
        grid_size=n,
        gap=gap,
        p_nominal=float(options["pressure"]),
        backend="fft" if options.get("boundary") == "free" else "periodic",
        tol=float(options["tolerance"]),
        precision=options["precision"],
        coarse_tol=1e-3,
        light_result=True,
    )
    times = clock.read()
    peak = resident("VmHWM")
    report = {"iterations": result.iterations, "area": result.contact_area, "status": result.status}
    return report | times | {"peak": peak, "base": base}, lambda: result.pressure


def tamaas(path, options):
    """Polonsky-Keer-Rey: in the pressure for a given mean pressure, in the gap for the exponential law."""
    import tamaas as program

    base = resident("VmRSS")
    program.set_log_level(program.LogLevel.error)
    solver_type = program.PolonskyKeerRey
    heights = np.load(path)
    n = heights.shape[0]
    forget_peak()
    clock = Clock()
    model = program.ModelFactory.createModel(program.model_type.basic_2d, [1.0, 1.0], [n, n])
    model.E, model.nu = 1.0, 0.0
    adhesive = "work" in options
    primal = solver_type.gap if adhesive else solver_type.pressure
    solver = solver_type(model, heights, float(options["tolerance"]), primal, primal)
    solver.max_iter = 20000
    if adhesive:
        law = program.ExponentialAdhesionFunctional(heights)
        law.parameters = {"rho": float(options["range"]), "surface_energy": float(options["work"])}
        solver.addFunctionalTerm(law)
    error = solver.solve(float(options["gap" if adhesive else "pressure"]))
    times = clock.read()
    peak = resident("VmHWM")
    gap = model["gap"]
    # in the gap the solver keeps g >= 0 by projection; in the pressure, p >= 0
    area = float(np.mean(gap <= 0.0) if adhesive else np.mean(model.traction > 0.0))
    status = "converged" if error <= float(options["tolerance"]) else "not converged"
    report = {"area": area, "status": status, "peak": peak, "base": base} | times

    def pressure():
        if not adhesive:
            return np.array(model.traction)
        return np.fft.irfft2(symbol(n) * np.fft.rfft2(gap + heights), s=(n, n))

    return report, pressure


def contactmechanics(path, options):
    """Constrained conjugate gradients on a free half-space, for a given force or offset."""
    from ContactMechanics import FreeFFTElasticHalfSpace
    from ContactMechanics.Factory import make_system
    from SurfaceTopography import Topography

    base = resident("VmRSS")
    heights = np.load(path)
    n = heights.shape[0]
    forget_peak()
    clock = Clock()
    held = {"external_force": float(options["pressure"])} if "pressure" in options else {}
    if "approach" in options:
        held = {"offset": float(options["approach"]) - heights.max()}
    substrate = FreeFFTElasticHalfSpace((n, n), 1.0, (1.0, 1.0))
    system = make_system(interaction="hardwall", substrate=substrate, surface=Topography(heights, (1.0, 1.0)))
    result = system.minimize_proxy(pentol=float(options["tolerance"]), maxiter=1000, **held)
    times = clock.read()
    peak = resident("VmHWM")
    status = "converged" if result.success else "not converged"
    report = {"area": float(system.compute_contact_area()), "status": status}
    return report | times | {"peak": peak, "base": base}, lambda: np.array(system.force) * n * n


def scipy(path, options):
    """One operator application by SciPy's pocketfft."""
    import scipy.fft

    kind = np.float32 if options["precision"] == "f32" else np.float64
    field = np.load(path).astype(kind)
    n = field.shape[0]
    factor = symbol(n, kind)
    seconds = []
    for _ in range(int(options["apply"]) + 1):
        begin = time.perf_counter()
        spectrum = scipy.fft.rfft2(field, workers=1)
        spectrum *= factor
        result = scipy.fft.irfft2(spectrum, s=(n, n), workers=1, overwrite_x=True)
        seconds.append(time.perf_counter() - begin)
    return {"seconds": statistics.median(seconds[1:]), "check": float(np.sum(result.astype(float) ** 2))}, None


PROGRAMS = {"aspher": aspher, "contactmechanics": contactmechanics, "tamaas": tamaas, "scipy": scipy}


def main():
    program, path = sys.argv[1:3]
    options = dict(argument.split("=", 1) for argument in sys.argv[3:])
    report, pressure = PROGRAMS[program](path, options)
    print(json.dumps(report), flush=True)
    if "save" in options:
        np.save(options["save"], pressure())


if __name__ == "__main__":
    main()
