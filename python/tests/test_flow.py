"""What follows a solve: percolation, leakage and conductance."""

import _thread
import json
import os
import signal
import subprocess
import threading
import time

import numpy as np
import pytest

import asperity


@pytest.fixture(scope="module")
def solution():
    rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_l=2, k_s=8, seed=1)
    return asperity.solve(rough, modulus=2.0, mean_pressure=0.02, stiffness=True)


@pytest.mark.parametrize("moment", [0.1, 0.5, 1.5])
def test_ctrl_c_ends_a_leakage_within_a_second_in_each_phase(moment):
    gap = np.random.default_rng(1).random((1024, 1024)) ** 4
    # a program that a script starts in the background ignores Ctrl-C
    signal.signal(signal.SIGINT, signal.default_int_handler)
    pressed = []

    def press():
        pressed.append(time.perf_counter())
        _thread.interrupt_main()

    timer = threading.Timer(moment, press)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        asperity.leakage(gap, tolerance=1e-12)
    timer.join()
    assert time.perf_counter() - pressed[0] < 1


def test_a_slot_leaks_along_its_path_with_fields_of_its_flow():
    wide = np.array([1.0, 2.0, 0.0, 3.0])
    gap = np.tile(wide, (6, 1))
    found = asperity.leakage(gap, (3.0, 2.0), boundary="free", viscosity=2.0, tolerance=1e-10)
    assert found.x.reached and found.x.upper - found.x.lower <= 1e-10 * found.x.upper
    assert (found.y.lower, found.y.upper, found.y.constriction) == (0.0, 0.0, None)
    assert found.report["flow_per_pressure"]["x"]["upper"] == found.x.upper / 2
    assert found.x.constriction.gap == 3.0 and (found.x.constriction.path[:, 1] == 3).all()
    assert found.x.flow.shape == (2, 6, 4)
    np.testing.assert_allclose(found.x.flow[0], gap**3 / 12 / 3, rtol=1e-4)
    assert np.isnan(found.y.pressure).all()
    # a list, a line, and a cell of 1 by 1
    found = asperity.leakage(np.ones((8, 6)))
    assert found.x.grid_error < 2e-4 and found.report["transmissivity"]["x"]["grid_error"] == found.x.grid_error
    assert asperity.leakage(np.ones((7, 6))).x.grid_error is None
    assert asperity.leakage([1.0, 2.0, 4.0]).x.upper > 0
    assert asperity.leakage(gap.astype("f4")[::-1]).report["boundary"] == "periodic"


def test_a_solution_leaks_and_percolates(solution):
    found = asperity.leakage(solution)
    same = asperity.leakage(solution.gap, solution.lengths)
    assert (found.x.lower, found.y.upper) == (same.x.lower, same.y.upper)
    for along, other in zip(solution.percolation(), (found.x.constriction, found.y.constriction)):
        assert along is not None and along.gap == other.gap == solution.gap[along.node]
        assert (solution.gap[tuple(along.path.T)] >= along.gap).all()
    # a wall of springs lets the surfaces overlap, which heights and an array of gaps may not
    soft = asperity.solve(solution.topography, modulus=2.0, mean_pressure=0.02, wall=asperity.Penalty(20.0))
    assert soft.gap.min() < 0 and asperity.leakage(soft).x.constriction.gap == soft.percolation().x.gap
    for wrong in (soft.gap, solution.topography.heights):
        with pytest.raises(ValueError, match=r"least gap is -.*Is it a gap\?.*of heights solve first"):
            asperity.leakage(wrong)
    pressed = asperity.solve(solution.topography, modulus=2.0, mean_pressure=1.0)
    assert pressed.percolation() == (None, None)


def test_units_and_refusals(solution):
    gap = 1e-6 * np.ones((8, 8))
    found = asperity.leakage(gap, "1mm", viscosity="1mPas")
    assert found.report["viscosity"] == 1e-3
    assert abs(found.x.upper / (1e-18 / 12) - 1) < 1e-5
    with pytest.raises(ValueError, match="lengths is 1.0, without a unit, but viscosity 1mPas has one"):
        asperity.leakage(gap, 1.0, viscosity="1mPas")
    for of, given, kind, message in [
        (solution, {"lengths": 1.0}, ValueError, "leave lengths out"),
        (gap, {"boundary": "open"}, ValueError, "boundary is"),
        (gap, {"viscosity": -1.0}, ValueError, "viscosity is -1"),
        (gap, {"tolerance": 2.0}, ValueError, "tolerance is 2"),
        (gap, {"absent_gap": -1.0}, ValueError, "gap of absent nodes is -1"),
        (gap, {"max_iterations": 0}, ValueError, "max_iterations is 0"),
        (gap, {"viscosty": 1.0}, TypeError, "did you mean viscosity"),
    ]:
        with pytest.raises(kind, match=message):
            asperity.leakage(of, **given)
    wavy = 1 + 0.9 * np.sin(np.add.outer(np.arange(32), np.arange(32) ** 1.5))
    with pytest.warns(asperity.ConvergenceWarning, match="bounds of the transmissivity hold"):
        asperity.leakage(wavy, max_iterations=2, tolerance=1e-9)


def test_gaps_with_a_unit_leak_in_metres(solution):
    rough = solution.topography
    microns = asperity.Topography(rough.heights, rough.lengths, "um")
    pressed = asperity.solve(microns, modulus=1e3, mean_pressure=10.0, tolerance=1e-9)
    strings = asperity.solve(microns, modulus="1GPa", mean_pressure="10MPa", tolerance=1e-9)
    found, same = (asperity.leakage(one, viscosity="1mPas", tolerance=1e-10) for one in (pressed, strings))
    for axis in ("x", "y"):
        flow, other = (one.report["flow_per_pressure"][axis]["upper"] for one in (found, same))
        assert flow == pytest.approx(other, rel=1e-9)
    gap = pressed.gap.copy()
    gap[:4, :4] = np.inf
    holed = asperity.Topography(gap, pressed.lengths, "um")
    of_metres = asperity.leakage(holed, absent_gap="50nm").x.upper
    assert of_metres == pytest.approx(1e-18 * asperity.leakage(holed, absent_gap=0.05).x.upper, rel=1e-9)
    with pytest.raises(ValueError, match="viscosity is 0.001 in SI units, but .* no unit: give a number in the units of"):
        asperity.leakage(solution, viscosity="1mPas")
    with pytest.raises(ValueError, match="absent_gap is 5e-08 in SI units"):
        asperity.leakage(solution, absent_gap="50nm")


def test_gaps_bring_their_sides(tmp_path):
    gap = asperity.Topography(np.full((32, 32), 2.0), (100.0, 50.0), "um")
    np.savez(tmp_path / "gap.npz", heights=gap.heights, lengths=(100.0, 50.0), unit="m")
    for of in (gap, tmp_path / "gap.npz"):
        found = asperity.leakage(of)
        assert found.x.upper == pytest.approx(1 / 3, rel=1e-5) and found.y.upper == pytest.approx(4 / 3, rel=1e-5)
    assert asperity.leakage(gap, 50.0).x.upper == pytest.approx(2 / 3, rel=1e-5)
    assert asperity.leakage(gap, viscosity="1mPas").y.upper == pytest.approx(4e-18 / 3, rel=1e-5)
    with pytest.raises(TypeError, match="gaps are an array of complex"):
        asperity.leakage(np.ones((3, 3), complex))


def test_the_conductance_is_that_of_the_stiffness(solution):
    found = solution.conductance((1.0, 3.0))
    stiffness = solution.contact_stiffness
    assert abs(found.per_area / (2 * stiffness / (2.0 * 4.0)) - 1) < 1e-4
    share = solution.report["stiffness_error"]
    assert found.whole == found.per_area and share < found.relative_error < share + 1e-3
    with pytest.raises(ValueError, match="resistivity of the first body is -1"):
        solution.conductance((-1.0, 1.0))


def test_resistivities_have_units_as_those_of_a_solve(solution):
    rough = solution.topography
    microns = asperity.Topography(rough.heights, rough.lengths, "um")
    load = {"modulus": "1GPa", "mean_pressure": "10MPa", "stiffness": True}
    told = asperity.solve(microns, resistivities=("17nOhm m", "24nOhm m"), **load).report["conductance"]
    for pressed in (asperity.solve(microns, **load), asperity.solve(microns, modulus=1e3, mean_pressure=10.0)):
        found = pressed.conductance(("17nOhm m", "24nOhm m"))
        assert found.per_area == pytest.approx(told["value"], rel=1e-3) and found.whole == pytest.approx(told["whole"], rel=1e-3)
    with pytest.raises(ValueError, match=r"resistivities is \(1e-09, 2.0\) in SI units, but .* no unit: give a number"):
        solution.conductance(("1nOhm m", "2Ohm m"))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"body": asperity.Layer(0.1, poisson=0.3, base="bonded")}, "the body is a layer: .* between half-spaces"),
        ({"plate": 1e-9}, "the body is a plate: .* between half-spaces"),
        ({"wall": asperity.Penalty(500.0)}, "the wall is penalty: only a hard wall"),
    ],
)
def test_a_contact_conducts_between_half_spaces_and_at_a_hard_wall_alone(solution, given, message):
    other = asperity.solve(solution.topography, modulus=2.0, mean_pressure=0.02, **given)
    with pytest.raises(ValueError, match=message):
        other.conductance((1.0, 1.0))


@pytest.mark.skipif("ASPERITY_TOOL" not in os.environ, reason="ASPERITY_TOOL names the program")
def test_the_program_says_the_same(solution, tmp_path):
    np.save(tmp_path / "gap.npy", solution.gap)
    command = [os.environ["ASPERITY_TOOL"], "leak", "gap.npy", "--lengths", "1", "--json"]
    report = json.loads(subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout)
    assert report["transmissivity"] == asperity.leakage(solution).report["transmissivity"]
