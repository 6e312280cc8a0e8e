"""Force curves of tips of any shape are fitted by tables of solves, and give what the curves were made of."""

import numpy as np
import pytest

import asperity

pytest.importorskip("scipy")

SIDE, RANGE = 40e-9, 0.5e-9
LAW = asperity.Exponential(work_of_adhesion=0.06, range=RANGE)


@pytest.fixture(scope="module")
def tip():
    sphere = asperity.surface.sphere(48, SIDE, radius=40e-9)
    rough = asperity.surface.self_affine(48, SIDE, rms_height=0.1e-9, hurst=0.8, k_l=3, k_s=10, seed=1)
    return asperity.Topography(sphere.heights + rough.heights, (SIDE, SIDE))


@pytest.fixture(scope="module")
def table(tip):
    return asperity.TipTable(tip, approaches=(-5e-9, 1.6e-9), modulus=1e9, law=LAW, works=10, steps=50)


def cycled(tip, modulus, work, spring, noise=0.01, **loads):
    """Positions and forces of an own cycle, at equal distances, with an offset and noise."""
    law = asperity.Exponential(work, RANGE)
    columns = asperity.cycle(tip, modulus=modulus, law=law, boundary="free", steps=60, **loads).columns
    z, load, leg = (columns[name] for name in ("control_value", "normal_force", "leg"))
    even = np.linspace(z.min(), z.max(), 200)
    there, back = (np.flatnonzero(leg == way) for way in (1, 2))
    jumps = np.array([energy is not None and energy > 0.0 for energy in columns["energy_drop"]])
    ways = []
    for way, at in ((there, even), (back, -even[::-1])):
        sign = 1.0 if way is there else -1.0
        falls = np.where(jumps[way], np.abs(load[way] - load[way - 1]), 0.0)
        jump = int(np.argmax(falls))
        late = np.interp(at, sign * z[way[jump:]], load[way[jump:]])
        early = np.interp(at, sign * z[way[: jump + 1]][:-1], load[way[: jump + 1]][:-1]) if jump else late
        ways.append(np.where(at < sign * z[way[jump]], early, late))
    # off, the tip is where it was on its way in
    ways[1] = np.where(-even[::-1] * -1.0 < z[back].min(), ways[0][::-1], ways[1])
    force = np.concatenate(ways)
    force += 0.2e-9 + np.random.default_rng(1).normal(scale=noise * abs(force.min()), size=force.size)
    return np.append(even, even[::-1]) + 1e-9, force


@pytest.mark.filterwarnings("ignore:hardness")
@pytest.mark.parametrize(("modulus", "work", "spring"), [(2.3e9, 0.041, None), (1.6e9, 0.057, 10.0), (1.4e9, 0.037, 10.0)])
def test_own_cycles_of_a_rough_tip_are_fitted_back(tip, table, modulus, work, spring):
    loads = {"approaches": [-4.9e-9, 1.5e-9, -4.9e-9]}
    if spring:
        loads = {"springs": [(spring, rest) for rest in (-6e-9, 3e-9, -9e-9)]}
    fit = asperity.fit_curve(*cycled(tip, modulus, work, spring, **loads), tip=table, spring_stiffness=spring)
    assert fit.modulus.value == pytest.approx(modulus, rel=0.02)
    assert fit.work_of_adhesion.value == pytest.approx(work, rel=0.02)
    assert fit.contact_point.value == pytest.approx(1e-9, abs=0.02e-9)
    print(fit, fit.modulus.value/modulus, fit.work_of_adhesion.value/work)
