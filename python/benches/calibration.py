#!/usr/bin/env python3
"""Do the p-values and intervals of `fit_curve` hold? Prints Markdown tables of rates by kinds of simulated curves.

    python python/benches/calibration.py [CURVES [SEED]]

CURVES, 16000 by default, are made of Hertz, DMT, Maugis and JKR alike by the closed forms, and fitted on all cores: 15
minutes on two. A true model has a p-value below 0.05 in 5 % of the curves, and a 95 % interval misses the truth as often.
Curves that are refused, as they tell the modulus within no decade, are counted. A rate of N curves has a standard
deviation of 22 %/√N.
"""

import os
import sys
import warnings
from concurrent.futures import ProcessPoolExecutor

import numpy as np

import asperity
from asperity import exact

RADIUS, MODULUS, WORK = 20e-9, 2e9, 0.05
#: the length of the displacements by adhesion, and the pull-off force of a rigid sphere
LENGTH, PULL = (WORK**2 * RADIUS / MODULUS**2) ** (1 / 3), 2 * np.pi * WORK * RADIUS
MODELS = ("Hertz", "DMT", "Maugis", "JKR")
KINDS = {
    "spring": ("none", "soft", "stiff"),
    "points": (24, 50, 150, 400),
    "spacing": ("even", "uneven", "repeated", "jittered"),
    "noise": ("1 to 2 %", "2 to 5 %"),
    "branches": ("both", "approach", "withdrawal"),
}


def equilibria(model, tabor):
    """Approaches and loads from bodies apart on, by the closed forms."""
    radii = np.sqrt(RADIUS * LENGTH) * np.linspace(0.0, 12.0, 4001)
    hertz = exact.Hertz(RADIUS, MODULUS).at_contact_radius(radii)
    if model == "Hertz":
        return hertz.approach, hertz.load
    if model == "DMT":
        return np.append(0.0, hertz.approach), np.append(0.0, hertz.load - PULL)
    if model == "JKR":
        contact = exact.Jkr(RADIUS, MODULUS, WORK).at_contact_radius(radii)
        return contact.approach, contact.load
    reach = LENGTH / tabor
    contact = exact.MaugisDugdale(RADIUS, MODULUS, WORK, reach).at_contact_radius(radii)
    # before contact the traction acts on a circle about the axis
    c, traction = np.linspace(0.0, 1.0, 2000)[:-1] * contact.adhesion_radius[0], WORK / reach
    approach = c**2 / (2 * RADIUS) - 4 * traction * c / (np.pi * MODULUS) - reach
    return np.append(approach, contact.approach), np.append(-np.pi * traction * c**2, contact.load)


def followed(where, load, z):
    """Loads at positions in the order of time: the bodies stay on an equilibrium until it ends."""
    reached = np.maximum.accumulate(z)
    there = np.interp(reached, np.maximum.accumulate(where), load)
    # a step back follows the equilibrium that was reached
    jump = int(np.argmax(where[1:] <= np.maximum.accumulate(where)[:-1])) if (np.diff(where) <= 0).any() else where.size
    before = reached <= where[: jump + 1].max() if jump < where.size else np.ones(z.size, bool)
    last = int(np.argmin(where[jump:])) + jump if jump < where.size else 0
    back = np.where(before, np.interp(z, where[: jump + 1], load[: jump + 1]), np.interp(z, where[last:], load[last:]))
    return np.where(reached > z, back, there)


def spaced(low, high, points, spacing, rng):
    """Positions that grow, but for their jitter."""
    even = np.linspace(low, high, points)
    if spacing == "uneven":
        return np.sort(rng.uniform(low, high, points))
    if spacing == "repeated":
        return np.sort(rng.choice(even, points))
    return even + (spacing == "jittered") * 0.5 * (even[1] - even[0]) * rng.normal(size=points)


def drawn(model, kind, rng):
    """z, force, and the keywords of a fit of a random curve of a model and a kind, with its truths."""
    tabor = {"Hertz": np.nan, "DMT": 0.0, "JKR": np.inf, "Maugis": 10 ** rng.uniform(-1, 0.7)}[model]
    approach, load = equilibria(model, tabor)
    deepest = LENGTH * 10 ** rng.uniform(0.5, 1.6)
    # in contact the approach grows from the last fold on
    contact = int(np.flatnonzero(np.diff(approach) <= 0)[-1:].sum()) + 1
    greatest = np.interp(deepest, approach[contact:], load[contact:])
    share = {"none": np.inf, "soft": 10 ** rng.uniform(-0.3, 0.3), "stiff": 10 ** rng.uniform(0.3, 1.3)}[kind["spring"]]
    stiffness = share * 2 * MODULUS * np.sqrt(RADIUS * deepest)
    where = approach + load / stiffness
    high = deepest + greatest / stiffness
    low = where.min() - rng.uniform(0.5, 2.0) * high
    positions = lambda: spaced(low, high, kind["points"], kind["spacing"], rng)
    there, back = positions(), positions()[::-1]
    ways = {
        "approach": (there, followed(where, load, there)),
        "withdrawal": (back, followed(-where[::-1], load[::-1], -back)),
    }
    legs = [ways[name] for name in (ways if kind["branches"] == "both" else [kind["branches"]])]
    z, force = np.concatenate(legs, axis=1)
    scale = greatest if model == "Hertz" else PULL
    noise = scale * 10 ** rng.uniform(*((-2.0, -1.7) if kind["noise"] == "1 to 2 %" else (-1.7, -1.3)))
    point, offset, slope = deepest * rng.normal(), scale * rng.normal(), 0.1 * scale / (high - low) * rng.normal()
    force = force + offset + slope * z + noise * rng.normal(size=z.size)
    options = {"radius": RADIUS, "direction": None if kind["branches"] == "both" else kind["branches"]}
    if np.isfinite(stiffness):
        options["spring_stiffness"] = stiffness
    truths = {"modulus": MODULUS, "work_of_adhesion": WORK * (model != "Hertz"), "contact_point": point}
    if model != "Hertz":
        truths["tabor_parameter"] = tabor
    return z + point, force, options, truths


def rated(given):
    """What a fit of a curve says: whether it was refused, p < 0.05 of the true model, and which truths were missed."""
    model, kind, seed = given
    z, force, options, truths = drawn(model, kind, np.random.default_rng(seed))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            fit = asperity.fit_curve(z, force, **options)
        except ValueError as refused:
            return {"refused": 1.0, "why": str(refused)}
    found = {"p": float(fit.models[model].p_value < 0.05), "value": fit.models[model].p_value}
    for name, true in truths.items():
        interval = getattr(fit, name)
        found[name] = float(not interval.lower <= true <= interval.upper)
    return found


def study(curves, seed):
    """Models, kinds and what was found of each curve."""
    rng = np.random.default_rng(seed)
    given = []
    for number in range(curves):
        kind = {name: values[rng.integers(len(values))] for name, values in KINDS.items()}
        given.append((MODELS[number % len(MODELS)], kind, (seed, number)))
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        return [(*one[:2], found) for one, found in zip(given, pool.map(rated, given, chunksize=20))]


def tables(found):
    """The lines of the tables: rates in per cent by models, and by each kind."""
    columns = ("p", "modulus", "work_of_adhesion", "contact_point", "tabor_parameter")

    def row(label, chosen):
        told = [one for one in chosen if "refused" not in one]
        rates = [[one[name] for one in told if name in one] for name in columns]
        cells = [f"{100 * np.mean(rate):.1f}" if rate else "" for rate in rates]
        return f"| {label} | {len(chosen)} | {len(chosen) - len(told)} | {' | '.join(cells)} |"

    for name, values in {"all": ("",), **KINDS}.items():
        yield f"| {name} | curves | refused | p < 0.05 | modulus | work of adhesion | contact point | Tabor parameter |"
        yield "|---" * 8 + "|"
        for model in MODELS:
            for value in values:
                chosen = [one for of, kind, one in found if of == model and kind.get(name, "") == value]
                yield row(f"{model} {value}".strip(), chosen)
        yield ""


if __name__ == "__main__":
    numbers = [int(text) for text in sys.argv[1:]]
    found = study(*(numbers + [16000, 2027][len(numbers) :]))
    print("\n".join(tables(found)))
