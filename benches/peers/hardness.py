#!/usr/bin/env python3
"""A rough surface with a cap on the contact pressure: asperity against Tamaas and ContactMechanics, at equal error.

    python benches/peers/hardness.py [NODES] [--slowest SECONDS]

asperity, Tamaas (`KatoSaturated`) and ContactMechanics (`PlasticTopography`) find the same pressures. Each runs at the
loosest tolerance, in steps of ten, at which its pressures are within 1e-3 of the solution, in the root of the mean square
compared with the error of the pressures; the solution is asperity's to a certified 1e-10. Times are medians of three, from
heights in memory to pressures in memory, of one thread; one run counts where it took longer than ten seconds.
"""

import argparse
import importlib.util
import os
import statistics
import time
import warnings

os.environ.update({name: "1" for name in ("OMP_NUM_THREADS", "RAYON_NUM_THREADS", "ASPERITY_THREADS")})

import numpy as np
from python import heights_of

ERROR = 1e-3


def asperity(heights, mean_pressure, hardness, tolerance):
    import asperity

    given = {"mean_pressure": mean_pressure, "hardness": hardness, "tolerance": tolerance, "threads": 1}
    solution = asperity.solve(heights, 1.0, modulus=1.0, **given)
    return solution.contact_pressure if solution.converged else None


def tamaas(heights, mean_pressure, hardness, tolerance):
    import tamaas as tm

    tm.set_log_level(tm.LogLevel.error)
    tm.initialize(1)
    model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [1.0, 1.0], list(heights.shape))
    model.E, model.nu = 1.0, 0.0
    solver = tm.KatoSaturated(model, heights.copy(), tolerance, hardness)
    solver.max_iter = 100_000
    solver.solve(mean_pressure)
    return np.array(model.traction)


def contact_mechanics(heights, mean_pressure, hardness, tolerance):
    from ContactMechanics import PeriodicFFTElasticHalfSpace
    from ContactMechanics.Factory import make_plastic_system
    from SurfaceTopography import PlasticTopography, Topography

    substrate = PeriodicFFTElasticHalfSpace(heights.shape, 1.0, (1.0, 1.0))
    surface = PlasticTopography(Topography(heights, (1.0, 1.0), periodic=True), hardness)
    system = make_plastic_system(substrate=substrate, surface=surface)
    found = system.minimize_proxy(external_force=mean_pressure, pentol=tolerance, maxiter=10_000)
    return np.abs(system.force) * heights.size if found.success else None


PROGRAMS = {"asperity": asperity, "tamaas": tamaas, "ContactMechanics": contact_mechanics}


def timed(program, *given):
    begin = time.perf_counter()
    pressures = program(*given)
    return time.perf_counter() - begin, pressures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("nodes", type=int, nargs="?", default=512)
    parser.add_argument("--slowest", type=float, default=120.0, help="seconds after which no tighter tolerance is tried")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    heights = heights_of(options.nodes)
    print(f"{options.nodes} x {options.nodes} nodes, rms slope 0.1; pressures in E*")
    print(f"{'p':>5} {'H':>5} {'yielded':>8} {'contact':>8}  {'program':<17} {'tolerance':>9} {'error':>8} {'seconds':>8} {'ratio':>7}")
    for mean_pressure, hardness in [(0.01, 0.1), (0.02, 0.1), (0.02, 0.05), (0.07, 0.1), (0.08, 0.1), (0.09, 0.1)]:
        exact = asperity(heights, mean_pressure, hardness, 1e-10)
        yielded, contact = (exact >= hardness).mean(), (exact > 0).mean()
        fastest = None
        for name, program in PROGRAMS.items():
            if importlib.util.find_spec(name) is None:
                print(f"{name} is not installed")
                continue
            for tolerance in 10.0 ** -np.arange(2, 11):
                given = (heights, mean_pressure, hardness, float(tolerance))
                taken, pressures = timed(program, *given)
                if pressures is None:
                    continue
                error = np.sqrt(((pressures - exact) ** 2).mean() / (exact**2).mean())
                if error <= ERROR or taken > options.slowest:
                    break
            else:
                print(f"{mean_pressure:5} {hardness:5} {yielded:8.4f} {contact:8.4f}  {name:<17} not converged")
                continue
            if taken < 10.0:
                taken = statistics.median(timed(program, *given)[0] for _ in range(3))
            fastest = fastest or taken
            row = f"{tolerance:9.0e} {error:8.1e} {taken:8.3f} {taken / fastest:7.1f}"
            print(f"{mean_pressure:5} {hardness:5} {yielded:8.4f} {contact:8.4f}  {name:<17} {row}", flush=True)


main()
