"""Force curves of tips of any shape are fitted by tables of solves, and give what the curves were made of."""

import pathlib
import pickle
import runpy

import numpy as np
import pytest
from force_curves import LENGTH, MODULUS, RADIUS, RANGE, WORK, curve, cycled, rough_tip

import asperity

pytest.importorskip("scipy")

LAW = asperity.Exponential(work_of_adhesion=0.06, range=RANGE)


@pytest.fixture(scope="module")
def tip():
    return rough_tip()


@pytest.fixture(scope="module")
def table(tip, tmp_path_factory):
    file = tmp_path_factory.mktemp("tip") / "tip.npz"
    tip.save(file)
    return asperity.TipTable(file, approaches=(-5e-9, 1.6e-9), modulus=1e9, law=LAW, steps=25)


@pytest.mark.filterwarnings("ignore:hardness")
@pytest.mark.parametrize(("modulus", "work", "spring"), [(2.3e9, 0.041, None), (1.6e9, 0.057, 10.0), (1.4e9, 0.037, 10.0)])
def test_own_cycles_of_a_rough_tip_are_fitted_back(tip, table, modulus, work, spring):
    fit = asperity.fit_curve(*cycled(tip, modulus, work, spring), tip=table, spring_stiffness=spring)
    assert fit.modulus.value == pytest.approx(modulus, rel=0.02)
    assert fit.work_of_adhesion.value == pytest.approx(work, rel=0.02)
    assert fit.contact_point.value == pytest.approx(1e-9, abs=0.02e-9)
    assert fit.verdict.startswith("Adhesion is seen, by TipTable(") and fit.tabor_parameter is fit.range is None


@pytest.mark.filterwarnings("ignore:hardness", "ignore:range", "ignore:window-edge")
def test_what_is_beyond_a_table_is_refused(tip, table):
    z, force = cycled(tip, 2.3e9, 0.041)
    with pytest.raises(ValueError, match="the curve goes to an approach of .*e-09, and the table to 1.6e-09"):
        asperity.fit_curve(z * 1.5, force, tip=table)
    with pytest.raises(ValueError, match="asks for w/E. of .* or more, and the table ends at 6e-11"):
        asperity.fit_curve(*cycled(tip, 0.6e9, 0.06), tip=table)
    with pytest.raises(ValueError, match="attraction is .* % of the pull-off: begin further from contact"):
        asperity.TipTable(tip, approaches=(-0.5e-9, 1.5e-9), modulus=1e9, law=LAW, works=4, steps=10)
    for wrong, told in (
        ({"tip": tip}, "make its table first"),
        ({}, "give one of them"),
        ({"tip": table, "spring_stiffness": "2N/m"}, "give all units, or none"),
    ):
        with pytest.raises((TypeError, ValueError), match=told):
            asperity.fit_curve(z, force, **wrong)
    for wrong, told in (
        ({"approaches": (1e-9, 2e-9)}, "they must be a negative one, before contact"),
        ({"works": 5}, "works is 5: it must be even"),
        ({"modulus": "1GPa"}, "give all units, or none"),
        ({"body": asperity.Symbol(lambda q: q)}, "it must be a Layer or a Coating"),
    ):
        with pytest.raises((TypeError, ValueError), match=told):
            asperity.TipTable(tip, **{"approaches": (-1e-9, 2e-9), "modulus": 1e9, "law": LAW, **wrong})


@pytest.mark.filterwarnings("ignore:the table has an error")
def test_a_table_takes_any_law_and_travels(tip):
    law = asperity.VanDerWaals(hamaker=6e-20, range=RANGE)
    few = {"approaches": (-8e-9, 1e-9), "modulus": 2e9, "works": 4, "steps": 10}
    table = asperity.TipTable(tip, law=asperity.CutOff(law, 5e-9), **few)
    # that of two half-spaces, A/(12 π D₀²)
    assert table.ratio == pytest.approx(6e-20 / (12 * np.pi * RANGE**2) / 2e9)
    z = np.append(there := np.linspace(-7e-9, 0.8e-9, 60), there[::-1])
    force = table._solved.load(z.clip(0)) * 3e9 + np.random.default_rng(1).normal(scale=1e-11, size=z.size)
    fit, other = (asperity.fit_curve(z, force, tip=one) for one in (table, pickle.loads(pickle.dumps(table))))
    assert other.modulus == fit.modulus and other.work_of_adhesion == fit.work_of_adhesion
    assert pickle.loads(pickle.dumps(fit)).verdict == fit.verdict


def noisy(force, share=1e-3):
    return force + np.random.default_rng(1).normal(scale=share * force.max(), size=force.size)


def test_a_cone_is_that_of_sneddon():
    cone = asperity.surface.cone(64, "100nm", angle=10)
    table = asperity.TipTable(cone, approaches=("-1nm", "6nm"), modulus="1GPa")
    z = np.linspace(-2.0, 5.0, 100)
    force = 2e9 / (np.pi * np.tan(np.radians(10))) * 5.0 * (1e-9 * z.clip(0)) ** 2
    fit = asperity.fit_curve(z, 1e9 * noisy(force), tip=table, length_unit="nm", force_unit="nN", poisson=0.5)
    # the apex is a node, and the grid resolves the contact from a few nodes on
    assert fit.modulus.value == pytest.approx(5e9, rel=2e-3) and abs(fit.contact_point.value) < 2e-11
    assert fit.young == pytest.approx([0.75 * end for end in fit.modulus])
    assert fit.work_of_adhesion is None and "without adhesion" in fit.verdict and list(fit.models) == ["no adhesion"]
    assert "GPa" in repr(fit) and "5e-09 m" not in repr(table) and "-1e-09 to 6e-09 m" in repr(table)


# a contact that is wide compared with the thickness, which is at most two nodes
@pytest.mark.filterwarnings("ignore:ends", "ignore:thin-body")
@pytest.mark.parametrize(("base", "poisson"), [("bonded", 0.3), ("sliding", 0.3)])
def test_a_sphere_on_a_thin_layer_is_one_on_springs(base, poisson):
    tip, thickness = asperity.surface.paraboloid(64, 1.0, radius=20.0), 0.02
    layer = asperity.Layer(thickness, poisson=poisson, base=base)
    table = asperity.TipTable(tip, approaches=(-0.0001, 0.003), modulus=1.0, body=layer)
    stiffness = (1 - poisson) ** 2 / (1 - 2 * poisson) if base == "bonded" else 1.0
    z = np.linspace(-0.001, 0.0025, 200)
    # springs of the stiffness M/t per area
    force = np.pi * 20.0 * 5.0 * stiffness * z.clip(0) ** 2 / thickness
    fit = asperity.fit_curve(z, noisy(force), tip=table)
    assert fit.modulus.value == pytest.approx(5.0, rel=0.01)


# the tip is steep at the edge of the map, as a paraboloid of 20 nm is
@pytest.mark.filterwarnings("ignore:steep", "ignore:hardness", "ignore:range")
def test_a_table_of_a_paraboloid_is_that_of_maugis():
    tip = asperity.surface.paraboloid(64, 28e-9, radius=RADIUS)
    law = asperity.MaugisDugdale(work_of_adhesion=1.5 * WORK, range=2 * LENGTH)
    table = asperity.TipTable(tip, approaches=(-4e-9, 3e-9), modulus=MODULUS, law=law, works=12, steps=15)
    for spring in (None, 20.0):
        fit = asperity.fit_curve(*curve(0.5, spring), tip=table, spring_stiffness=spring)
        assert fit.modulus.value == pytest.approx(MODULUS, rel=0.02)
        assert fit.work_of_adhesion.value == pytest.approx(WORK, rel=0.02)


# the cell is some times as wide as the contact, and the layer four nodes thick
@pytest.mark.filterwarnings("ignore:ends", "ignore:thin-body", "ignore:range")
def test_a_layer_that_sticks_is_fitted_back():
    tip, layer = asperity.surface.paraboloid(64, 4.0, radius=20.0), asperity.Layer(0.5, poisson=0.45)
    law = asperity.Exponential(work_of_adhesion=4e-3, range=0.04)
    table = asperity.TipTable(tip, approaches=(-0.25, 0.06), modulus=1.0, law=law, body=layer, works=8, steps=20)
    top = tip.heights.max() - tip.heights.mean()
    gaps = top - np.linspace(-0.24, 0.045, 120)
    law = asperity.Exponential(work_of_adhesion=6e-3, range=0.04)
    loads = {"mean_gaps": np.append(gaps, gaps[::-1]), "start": "apart"}
    columns = asperity.sweep(tip, modulus=2.0, law=law, body=layer, **loads).columns
    # the mean pressure squeezes the layer by its thickness over M
    squeezed = 0.5 * (1 - 0.9) / (1 - 0.45) ** 2 / 2.0 * columns["mean_pressure"]
    fit = asperity.fit_curve(top - columns["mean_gap"] + squeezed, noisy(columns["normal_force"], 5e-3), tip=table)
    assert fit.modulus.value == pytest.approx(2.0, rel=0.02)
    assert fit.work_of_adhesion.value == pytest.approx(6e-3, rel=0.02)


# the cell is some ten times as wide as the contact
@pytest.mark.filterwarnings("ignore:ends", "ignore:thin-body")
def test_a_sphere_on_a_coating_is_that_of_the_integral_equation():
    tip, coating = asperity.surface.paraboloid(128, 8.0, radius=20.0), asperity.Coating(0.5, 0.1, 0.3, 0.3)
    table = asperity.TipTable(tip, approaches=(-0.01, 0.05), modulus=1.0, body=coating)
    # √(Rδ)/t is 1 and 2: the force over that of Hertz on the coating alone, by the equation of Lebedev and Ufliand
    depth = np.array([1.0, 2.0]) ** 2 * 0.25 / 20.0
    ratio = table._solved.load(depth) / (4 / 3 * 0.1 * np.sqrt(20.0) * depth**1.5)
    assert ratio == pytest.approx([coated(1.0, 0.1, 0.3), coated(2.0, 0.1, 0.3)], rel=0.01)
    z = np.linspace(-0.02, 0.045, 120)
    fit = asperity.fit_curve(z, noisy(3.0 * table._solved.load(z.clip(0))), tip=table)
    assert covers(fit.modulus, 3.0) and fit.modulus.value == pytest.approx(3.0, rel=0.02)


def covers(found, true):
    return found.lower <= true <= found.upper


def coated(wanted, ratio, poisson):
    """The force of a paraboloid at √(Rδ)/t over that on a half-space of the coating, for moduli of a ratio."""
    path = pathlib.Path(__file__).resolve().parents[1] / "benches" / "shapes.py"
    on_coating = runpy.run_path(str(path))["on_coating"]
    radii = np.linspace(0.3 * wanted, 1.5 * wanted, 12)
    roots, forces = np.transpose([on_coating(radius, ratio, poisson) for radius in radii])
    return np.interp(wanted, roots, forces)
