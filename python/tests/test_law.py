"""The adhesion laws of the library."""

import math
import pickle

import numpy as np
import pytest
from own_laws import Exponential

import asperity


def test_the_law_without_a_range_is_an_object_with_a_unit():
    law = asperity.JKR("50mJ/m2")
    asperity.check_law(law)
    assert law == pickle.loads(pickle.dumps(law)) and law.energy([0.0, 1e-9]).tolist() == [-0.05, 0.0]
    rough = asperity.surface.self_affine(64, 1e-6, rms_height=3e-9, k_l=2, k_s=8, seed=3)
    report = asperity.solve(rough, modulus=1e9, mean_pressure=5e6, law=asperity.JKR(0.05)).report
    assert report["range"] == pytest.approx(math.sqrt(13 * 0.05 * 1e-6 / 64 / 1e9), rel=1e-12)
    with pytest.raises(TypeError, match="range"):
        asperity.JKR(0.05, range=1e-9)


def test_functions_of_the_library_take_any_shape():
    law = asperity.Exponential(0.05, 2e-9)
    assert law.energy(0.0) == -0.05 and isinstance(law.energy(0.0), float)
    assert law.traction([0.0, 2e-9]).shape == (2,) and law.slope(np.zeros((2, 3))).shape == (2, 3)
    assert law == asperity.Exponential(0.05, 2e-9) != asperity.Exponential(0.05, 3e-9)
    assert pickle.loads(pickle.dumps(law)) == law and eval(repr(law), vars(asperity)) == law
    with pytest.raises(ValueError, match="range of adhesion is -1"):
        asperity.MaugisDugdale(1.0, -1.0)


W, RANGE = 2e-5, 8e-3
GAPS = np.linspace(0.0, 2e-2, 9)
LAWS = [
    asperity.Exponential(W, RANGE),
    asperity.MaugisDugdale(W, RANGE),
    asperity.LennardJones(W, RANGE),
    asperity.LennardJones(W, RANGE, cut=True),
    asperity.Morse(W, RANGE),
    asperity.PowerLaw(W, RANGE, 3.0),
    asperity.VanDerWaals(1e-7, RANGE),
    asperity.Tabulated(GAPS, W / RANGE * np.exp(-GAPS / RANGE) * (GAPS < 2e-2)),
    asperity.CutOff(asperity.PowerLaw(W, RANGE, 3.0), 0.03),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: type(law).__name__)
def test_laws_of_the_library_travel(law):
    assert isinstance(law, asperity.Law)
    other = pickle.loads(pickle.dumps(law))
    assert other == law and repr(other) == repr(law)
    if not isinstance(law, asperity.Tabulated):  # of which eight digits are written
        assert eval(repr(law), dict(vars(asperity))) == law
    assert np.array_equal(law.traction(GAPS[1:]), other.traction(GAPS[1:]))
    assert law != asperity.Exponential(W, 2 * RANGE)


def test_a_table_is_read_from_a_file(tmp_path):
    np.savetxt(tmp_path / "law.txt", np.column_stack([[0.0, 1e-9, 2e-9], [50e6, 25e6, 0.0]]))
    law = asperity.Tabulated.read(tmp_path / "law.txt")
    assert law == asperity.Tabulated([0.0, 1e-9, 2e-9], [50e6, 25e6, 0.0])
    assert law.source == str(tmp_path / "law.txt") and law.gaps.tolist() == [0.0, 1e-9, 2e-9]
    with pytest.raises(ValueError, match="last traction in the table is 1"):
        asperity.Tabulated([0.0, 1.0, 2.0], [1.0, 1.0, 1.0])
    with pytest.raises(FileNotFoundError):
        asperity.Tabulated.read(tmp_path / "none.txt")
    np.savetxt(tmp_path / "wide.txt", np.ones((3, 3)))
    with pytest.raises(ValueError, match="has 3 columns, not two"):
        asperity.Tabulated.read(tmp_path / "wide.txt")


def test_a_work_of_adhesion_may_differ_from_node_to_node(rough):
    works = np.where(np.arange(64)[:, None] < 32, 0.0, W) * np.ones((64, 64))
    options = {"modulus": 1.0, "mean_pressure": 1e-3}
    for law in (asperity.Exponential(1.0, RANGE), Exponential(1.0, RANGE), LAWS[-1]):
        varying = asperity.Varying(law, works)
        assert np.allclose(-varying.energy(0.0), works, rtol=1e-12)
        assert varying.energy(np.full((64, 64), 1e-3)).shape == (64, 64)
        solution = asperity.solve(rough, law=varying, **options)
        assert np.isclose(varying.energy(solution.gap).mean(), solution.adhesive_energy, rtol=1e-9)
        assert solution.report["mu_rho_node"] == [32, 0] and solution.report["work_of_adhesion"] is None
        other = asperity.Varying(law, works)
        assert other == varying or isinstance(law, Exponential)
    travelled = pickle.loads(pickle.dumps(asperity.Varying(asperity.Exponential(1.0, RANGE), works)))
    assert np.array_equal(travelled.work_of_adhesion, works) and travelled.law == asperity.Exponential(1.0, RANGE)
    for given, message in [
        ((asperity.Exponential(1.0, RANGE), -works), "work of adhesion is -2e-5"),
        ((asperity.Exponential(0.0, RANGE), works), "work of adhesion of the law that varies is 0"),
        ((asperity.Exponential(1.0, RANGE), np.ones((2, 2, 2))), "works of adhesion have shape"),
        ((asperity.Varying(asperity.Exponential(1.0, RANGE), works), works), "varies already"),
        ((asperity.CutOff(asperity.Varying(asperity.Exponential(1.0, RANGE), works), 0.1), works), "varies already"),
    ]:
        with pytest.raises(ValueError, match=message):
            asperity.Varying(*given)
    with pytest.raises(ValueError, match="cut off already"):
        asperity.CutOff(asperity.CutOff(asperity.Exponential(1.0, RANGE), 0.1), 0.1)
    with pytest.raises(ValueError, match="32 x 64"):
        asperity.solve(rough, law=asperity.Varying(asperity.Exponential(1.0, RANGE), works[32:]), **options)
    with pytest.raises(ValueError, match=r"gap has shape \[3\]"):
        asperity.Varying(asperity.Exponential(1.0, RANGE), works).traction([1.0, 2.0, 3.0])


def test_a_map_of_works_with_holes_is_refused_by_its_name(rough):
    works = np.full((64, 64), W)
    works[3, 4] = np.nan
    for holed in (works, np.ma.masked_array(np.full((64, 64), W), np.isnan(works))):
        with pytest.raises(ValueError, match=r"work_of_adhesion: 1 of 4096 nodes .* \(NaN\) at index \[3, 4\]: give"):
            asperity.Varying(asperity.Exponential(1.0, RANGE), holed)


def test_walls_of_springs_are_values_and_refuse_what_they_cannot_do(rough):
    wall = asperity.Penalty(stiffness=100)
    assert wall == asperity.Penalty(100.0) != asperity.Uzawa(100.0) and wall.stiffness == 100.0
    assert pickle.loads(pickle.dumps(wall)) == wall and eval(repr(wall), vars(asperity)) == wall
    for stiffness in (0.0, -1.0, np.inf, np.nan):
        with pytest.raises(ValueError, match="stiffness is .*: it must be"):
            asperity.Uzawa(stiffness)
    options = {"modulus": 1.0, "law": asperity.Exponential(W, RANGE)}
    with pytest.raises(ValueError, match="springs .* rigid wall"):
        list(asperity.cycle(rough, mean_gaps=[0.02, 0.01], wall=wall, **options))
    soft = asperity.solve(rough, mean_gap=0.02, wall=wall, stability=True, **options)
    assert asperity.stability(soft).eigenvalue == pytest.approx(soft.report["stability"]["eigenvalue"], rel=1e-6)
    rounds = asperity.solve(rough, mean_gap=0.02, wall=asperity.Uzawa(100.0), **options)
    with pytest.raises(ValueError, match="multipliers .* stability=True"):
        asperity.stability(rounds)
    columns = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.01], wall=wall).columns
    assert columns["min_gap"][0] < 0


def test_works_that_vary_have_the_axes_that_are_named(rough):
    works = np.where(np.arange(64)[:, None] < 32, 1e-4, 2e-4) * np.ones(64)
    law, near = asperity.Exponential(1e-4, 8e-3), {"modulus": 1.0, "mean_gap": 0.02}
    expected = asperity.solve(rough, law=asperity.Varying(law, works), **near)
    image = asperity.Varying(law, works.T, axes="yx")
    for varying in (image, pickle.loads(pickle.dumps(image))):
        found = asperity.solve(rough.heights.T, 1.0, axes="yx", law=varying, **near)
        assert np.array_equal(found.gap, expected.gap)
    with pytest.raises(ValueError, match="give asperity.Varying"):
        asperity.solve(rough.heights.T, 1.0, axes="yx", law=asperity.Varying(law, works.T), **near)
