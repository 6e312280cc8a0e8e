#!/usr/bin/env python3
"""Times of a map of force curves, beside those of nanite: prints a Markdown table.

    python python/benches/curve_map.py [SIDE [POINTS]]

SIDE² curves, 64² by default, of POINTS points in all, 500 by default, are of a sphere of 2 µm on a cantilever of 0.1 N/m,
on a gel with a modulus between 5 and 20 kPa: Hertz with 2 % noise, and Maugis with adhesion. Seconds are those of all
processors, and of the clock. The error is the median of |E*/E*₀ − 1|. nanite fits Hertz to the approach alone, curve by
curve, if it is installed; its contact point comes first by its default.
"""

import sys
import time
import warnings

import numpy as np

import asperity
from asperity import exact

RADIUS, STIFFNESS, NOISE = 2e-6, 0.1, 0.02


def equilibria(modulus, work):
    """Approaches and loads from bodies apart on, of Hertz or of Maugis with a Tabor parameter of 1."""
    if work == 0.0:
        contact = exact.Hertz(RADIUS, modulus).at_contact_radius(np.linspace(0.0, 1.5e-6, 1500))
        return contact.approach, contact.load
    reach = (work**2 * RADIUS / modulus**2) ** (1 / 3)
    contact = exact.MaugisDugdale(RADIUS, modulus, work, reach).at_contact_radius(np.linspace(0.0, 1.5e-6, 1500))
    c, traction = np.linspace(0.0, 1.0, 500)[:-1] * contact.adhesion_radius[0], work / reach
    approach = c**2 / (2 * RADIUS) - 4 * traction * c / (np.pi * modulus) - reach
    return np.append(approach, contact.approach), np.append(-np.pi * traction * c**2, contact.load)


def made(side, points, work, seed=1):
    """Positions and forces of a map, an array (side, side, 2, points), and its moduli."""
    rng = np.random.default_rng(seed)
    x, y = np.meshgrid(*[np.linspace(0.0, 1.0, side)] * 2, indexing="ij")
    moduli = 5e3 * 4 ** (0.5 + 0.5 * np.sin(6 * x) * np.cos(4 * y))
    curves = np.empty((side, side, 2, points))
    half = points // 2
    for place in np.ndindex(side, side):
        approach, load = equilibria(moduli[place], work)
        where = approach + load / STIFFNESS
        z = np.linspace(-1.2e-6, 0.6e-6 + np.interp(0.6e-6, approach, load) / STIFFNESS, half)
        there = np.interp(z, np.maximum.accumulate(where), load)
        back = np.interp(z, np.minimum.accumulate(where[::-1])[::-1], load)
        force = np.append(there, back[::-1])
        noise = NOISE * (force.max() if work == 0.0 else 2 * np.pi * work * RADIUS)
        curves[place] = np.append(z, z[::-1]) + 3e-7 * np.sin(3 * x[place]), force + noise * rng.normal(size=2 * half)
    return curves, moduli


def by_nanite(curves):
    """The contact moduli of nanite's fit of Hertz to all curves, for ν = ½."""
    from nanite import model
    from nanite.indent import Indentation

    found = np.full(curves.shape[:2], np.nan)
    for place in np.ndindex(curves.shape[:2]):
        z, force = curves[place]
        half = z.size // 2
        data = {"force": force, "height (measured)": -z, "segment": np.repeat([0, 1], half).astype(np.uint8)}
        data["time"] = np.arange(z.size) * 1e-3
        metadata = {"path": "map", "enum": 0, "imaging mode": "force-distance", "spring constant": STIFFNESS}
        curve = Indentation(data, metadata)
        curve.apply_preprocessing(["compute_tip_position", "correct_force_offset", "correct_tip_offset"])
        parameters = model.get_init_parms("hertz_para")
        parameters["R"].value, parameters["nu"].value = RADIUS, 0.5
        curve.fit_model(model_key="hertz_para", params_initial=parameters, weight_cp=False)
        found[place] = curve.fit_properties["params_fitted"]["E"].value / (1 - 0.5**2)
    return found


def timed(function):
    """What a function returns, and its seconds of processor and clock."""
    begin = time.process_time(), time.perf_counter()
    return function(), time.process_time() - begin[0], time.perf_counter() - begin[1]


def main(side=64, points=500):
    print("| curves | fit | processor, s | clock, s | ms a curve | error of E* | without |\n|---|---|---|---|---|---|---|")
    for name, work in (("Hertz", 0.0), ("Maugis", 2e-5)):
        curves, moduli = made(side, points, work)
        options = {"radius": RADIUS, "spring_stiffness": STIFFNESS}
        fits = {
            "all four models": lambda: asperity.fit_curves(curves, **options).modulus.value,
            "`model=\"hertz\"`": lambda: asperity.fit_curves(curves, model="hertz", **options).modulus.value,
            "nanite's Hertz": lambda: by_nanite(curves),
        }
        for label, fit in fits.items():
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                try:
                    found, processor, clock = timed(fit)
                except ImportError:
                    continue
            error = np.nanmedian(abs(found / moduli - 1))
            row = f"{processor:.0f} | {clock:.0f} | {1e3 * processor / side**2:.1f} | {100 * error:.2g} %"
            print(f"| {name} | {label} | {row} | {int(np.isnan(found).sum())} |", flush=True)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
