"""Force curves of a smooth tip, by the exact solutions, and of a rough one, by solves."""

import numpy as np

import asperity
from asperity import exact

RADIUS, MODULUS, WORK = 20e-9, 2e9, 0.05
LENGTH = (WORK**2 * RADIUS / MODULUS**2) ** (1 / 3)
PULL = 2 * np.pi * WORK * RADIUS


def equilibria(tabor):
    """Approaches and loads from bodies apart on, by the exact solutions in their own units."""
    radii = np.linspace(0.0, 30.0, 4000) * np.sqrt(RADIUS * LENGTH) / 4
    if tabor is None:
        contact = exact.Hertz(RADIUS, MODULUS).at_contact_radius(radii)
        return contact.approach, contact.load
    if tabor == 0.0:
        contact = exact.Hertz(RADIUS, MODULUS).at_contact_radius(radii)
        return np.append(0.0, contact.approach), np.append(0.0, contact.load - PULL)
    if np.isinf(tabor):
        contact = exact.Jkr(RADIUS, MODULUS, WORK).at_contact_radius(radii)
        return contact.approach, contact.load
    reach = LENGTH / tabor
    contact = exact.MaugisDugdale(RADIUS, MODULUS, WORK, reach).at_contact_radius(radii)
    # before contact, a pressure on a circle about the axis
    c, stress = np.linspace(0.0, 1.0, 4000)[:-1] * contact.adhesion_radius[0], WORK / reach
    approach = c**2 / (2 * RADIUS) - 4 * stress * c / (np.pi * MODULUS) - reach
    return np.append(approach, contact.approach), np.append(-np.pi * stress * c**2, contact.load)


def curve(tabor, spring=None, *, noise=0.02, points=400, seed=1, far=6, offset=2e-10, slope=2e-3, drift=3e-10):
    """Positions and forces of an approach and a withdrawal, with jumps, a baseline, a drift, and noise."""
    approach, load = equilibria(tabor)
    compliance = 0.0 if spring is None else 1 / spring
    where = approach + compliance * load
    most = np.interp(12 * LENGTH, approach[approach.size // 2 :], load[approach.size // 2 :])
    z = np.linspace(1.2 * where.min() - far * LENGTH, 12 * LENGTH + compliance * most, points // 2)
    there = np.interp(z, np.maximum.accumulate(where), load)
    back = np.interp(z, np.minimum.accumulate(where[::-1])[::-1], load)
    z = np.append(z, z[::-1]) + 3e-9
    force = np.append(there, back[::-1]) + offset + slope * z + drift * np.linspace(0, 1, z.size)
    return z, force + np.random.default_rng(seed).normal(scale=noise * PULL, size=z.size)


#: the range of the adhesion of the rough tip
RANGE = 0.5e-9


def rough_tip():
    """A tip of 40 nm with a roughness of 0.25 nm."""
    sphere = asperity.surface.sphere(48, 40e-9, radius=40e-9)
    rough = asperity.surface.self_affine(48, 40e-9, rms_height=0.25e-9, hurst=0.8, k_l=3, k_s=10, seed=1)
    return asperity.Topography(sphere.heights + rough.heights, sphere.lengths)


def cycled(tip, modulus, work, spring=None, noise=0.01):
    """Positions and forces of an own cycle, with an offset and noise."""
    z = np.linspace(-4.8e-9, 3e-9 if spring else 1.5e-9, 150)
    z = np.append(z, z[::-1])
    loads = {"springs": [(spring, rest) for rest in z]} if spring else {"approaches": z}
    law = asperity.Exponential(work, RANGE)
    force = asperity.sweep(tip, modulus=modulus, law=law, boundary="free", **loads).columns["normal_force"]
    noise *= np.random.default_rng(1).normal(size=force.size) * abs(force.min())
    return z + 1e-9, force + 0.2e-9 + noise
