"""One call: arrays in, arrays out, and how good they are."""

import _thread
import json
import os
import re
import subprocess
import sys
import signal
import threading
import time
from types import SimpleNamespace

import numpy as np
import pytest

import asperity


def test_fields_are_arrays_of_the_shape_of_the_heights(rough):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    assert solution.status == "converged" and solution.converged
    for field in (solution.gap, solution.pressure, solution.contact_pressure):
        assert field.shape == (64, 64) and field.dtype == np.float64 and field.flags.c_contiguous
    assert solution.contact.dtype == bool and solution.contact.sum() == solution.report["contact_nodes"]
    assert not np.any((solution.gap > 0) & (solution.contact_pressure > 0))
    assert np.isclose(solution.pressure.mean(), 0.01, rtol=1e-6)
    assert np.array_equal(solution.displacement, solution.gap + rough.heights)


def test_single_precision_has_fields_and_a_default_tolerance_of_its_own(rough):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, precision="f32")
    double = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    assert solution.gap.dtype == solution.pressure.dtype == np.float32
    assert solution.report["tolerance"] == 1e-4 and double.report["tolerance"] == 1e-6
    assert np.isclose(solution.mean_gap, double.mean_gap, rtol=1e-3)


def test_bits_do_not_depend_on_the_number_of_threads(rough, law):
    one, two, all_of_them = (
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law, threads=threads) for threads in (1, 2, None)
    )
    assert one.report["threads"] == 1 and two.report["threads"] == 2
    for name in ("gap", "pressure", "contact_pressure"):
        assert getattr(one, name).tobytes() == getattr(two, name).tobytes() == getattr(all_of_them, name).tobytes()


def test_a_solve_that_has_not_converged_is_a_status_and_a_warning(rough):
    with pytest.warns(asperity.ConvergenceWarning, match="iteration-limit.* after 2 iterations.* raise max_iterations, or give a gap nearby as start") as caught:
        solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, max_iterations=2)
    assert not solution.converged and solution.status == "iteration-limit"
    assert solution.gap.min() >= 0 and solution.relative_error > 1e-6
    assert caught[0].filename == __file__  # the line of the caller


def test_an_observer_sees_the_iterations(rough):
    states = []
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=states.append)
    assert [state.iteration for state in states] == sorted({state.iteration for state in states})
    assert states[-1].relative_error < 1e-6 and "relative_error" in repr(states[-1])
    unobserved = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    assert solution.gap.tobytes() == unobserved.gap.tobytes()


def test_an_observer_is_called_on_the_thread_of_the_solve(rough):
    threads = set()
    asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=lambda _: threads.add(threading.get_ident()))
    assert threads == {threading.get_ident()}


def test_an_observer_may_solve_even_on_one_thread():
    script = """if True:
        import asperity
        rough = asperity.surface.self_affine(32, 1.0, rms_slope=0.1, k_l=2, k_s=8)
        def solve(observe=None):
            return asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=observe)
        found = []
        outer = solve(lambda state: found.append(solve()))
        assert outer.report["threads"] == 1 and len(found) > 3
        assert all(inner.gap.tobytes() == outer.gap.tobytes() for inner in found)
    """
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", script], env=environment, check=True, timeout=30)


def test_stop_iteration_in_an_observer_ends_the_solve(rough):
    def observe(state):
        if state.relative_error < 1e-2:
            raise StopIteration

    with pytest.warns(asperity.ConvergenceWarning, match="stopped"):
        solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=observe)
    assert solution.status == "stopped" and solution.relative_error < 1e-2


def test_an_exception_in_an_observer_arrives_as_it_was_raised_with_what_was_reached(rough):
    class Mine(Exception):
        pass

    def observe(state):
        if state.iteration == 3:
            raise Mine("three")

    with pytest.raises(Mine, match="three") as caught:
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=observe)
    assert caught.value.solution.status == "stopped" and caught.value.solution.iterations <= 4
    assert caught.traceback[-1].name == "observe"


@pytest.mark.parametrize("observe", [None, [].append])
def test_ctrl_c_ends_a_solve_with_what_was_reached(observe):
    # a program that a script starts in the background ignores Ctrl-C
    signal.signal(signal.SIGINT, signal.default_int_handler)
    heights = asperity.surface.self_affine(1024, 1.0, rms_slope=0.1, k_s=256)
    # it would take several seconds
    hard = {"method": "rey2017", "tolerance": 1e-10, "threads": 1, "observe": observe}
    timer = threading.Timer(0.5, _thread.interrupt_main)
    timer.start()
    started = time.perf_counter()
    with pytest.raises(KeyboardInterrupt) as caught:
        asperity.solve(heights, modulus=1.0, mean_pressure=0.01, **hard)
    timer.join()
    assert time.perf_counter() - started < 3
    assert caught.value.solution.status == "stopped" and caught.value.solution.gap.shape == (1024, 1024)


def test_the_interpreter_is_free_during_a_solve():
    heights = asperity.surface.self_affine(512, 1.0, rms_slope=0.1, k_s=64)
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.005)

    thread = threading.Thread(target=tick)
    thread.start()
    begin = time.perf_counter()
    asperity.solve(heights, modulus=1.0, mean_pressure=0.01, threads=1)
    end = time.perf_counter()
    done.set()
    thread.join()
    within = [t for t in ticks if begin < t < end]
    assert len(within) > 5  # a held lock would leave one or two


@pytest.mark.filterwarnings("ignore:ends")
def test_the_stability_that_is_found_later_is_the_one_of_the_solve(sphere, law):
    options = {"modulus": 1.0, "mean_gap": 0.0398, "law": law}
    asked = asperity.solve(sphere, 1.0, stability=True, **options)
    found = asperity.stability(asperity.solve(sphere, 1.0, **options))
    assert {**found._asdict(), "mode": None} == {**asked.report["stability"], "mode": None}
    assert found.mode.tobytes() == asked.mode.tobytes()


def test_the_table_and_the_html_say_how_it_ended(rough, law):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
    told = repr(solution)
    assert told.startswith("side lengths") and told.endswith("converged") and "mu_rho" in told and "net pressure" in told
    assert "least pressure " in told and "greatest pressure " in told
    html = solution._repr_html_()
    assert "data:image/svg+xml;base64," in html and "converged" in html
    metres = asperity.Topography(1e-6 * rough.heights, (1e-6, 1e-6), "m")
    told = repr(asperity.solve(metres, modulus=1e9, mean_pressure=1e7, stability=True))
    assert "1 µm x 1 µm" in told and re.search(r"mean gap +[0-9.]+ [np]m\n", told) and "its lower bound" in told
    json.dumps(solution.report)  # plain numbers, lists and text


def test_what_is_found_later_is_about_the_solve():
    class Exponential:
        """A law whose work of adhesion can be changed."""

        range = 8e-3

        def __init__(self, work):
            self.work = work

        def energy(self, gap):
            return -self.work * np.exp(-gap / self.range)

        def traction(self, gap):
            return -self.energy(gap) / self.range

        def slope(self, gap):
            return self.energy(gap) / self.range**2

    law = Exponential(2e-5)
    heights = asperity.surface.self_affine(128, 1.0, rms_slope=0.1, k_l=2, k_s=10, seed=3).heights
    options = {"modulus": 1.0, "mean_pressure": 0.01, "law": law, "nested": True}
    told = asperity.solve(heights, 1.0, **options).report
    solution = asperity.solve(heights, 1.0, **options)
    for field in (solution.gap, solution.pressure, solution.contact_pressure):
        with pytest.raises(ValueError, match="read-only"):
            field[0, 0] = 1.0
    law.work = law.range = 1.0
    heights[:] = 0.0
    assert told["grid_error"]["gap"] is not None and told["attractive_fraction"] > 0
    assert {**solution.report, "seconds": None} == {**told, "seconds": None}


def test_what_is_refused_says_why(rough):
    for given, message in [
        ({"mean_gap": np.inf}, "mean_gap is inf"),
        ({"lengths": (1.0, -1.0)}, "lengths is -1.0: it must be a number, positive"),
        ({"mean_gap": [1.0, 2.0]}, "must be one value"),
    ]:
        with pytest.raises(ValueError, match=message):
            asperity.solve(**{"heights": rough.heights, "lengths": 1.0, "modulus": 1.0, "mean_gap": 0.01} | given)


@pytest.mark.parametrize("precision", ["f32", "f64"])
def test_the_distribution_of_the_pressure_integrates_to_the_contact(rough, law, precision):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law, precision=precision)
    density, edges = solution.pressure_distribution(30)
    assert density.shape == (30,) and edges.shape == (31,) and edges[0] == 0
    # tension is in no bin
    assert np.sum(density * np.diff(edges)) == pytest.approx(solution.contact_fraction, rel=1e-12)
    assert edges[-1] == solution.contact_pressure.max() and solution.pressure.min() < 0
    pressed = solution.contact_pressure[solution.contact]
    counts, _ = np.histogram(pressed, bins=30, range=(0, edges[-1]))
    # a pressure on an edge may be in either bin
    assert np.abs(counts - density * np.diff(edges) * solution.gap.size).sum() <= 2
    for bins in (0, -1):
        with pytest.raises(ValueError, match="number of bins"):
            solution.pressure_distribution(bins)


def test_the_distribution_of_the_pressure_knows_lines_and_absent_nodes():
    x = np.linspace(-0.5, 0.5, 64, endpoint=False)
    line = asperity.solve(-(x**2) / 4, lengths=1.0, modulus=1.0, mean_gap=0.018)
    disc = np.where(np.hypot(x[:, None], x) < 0.3, 0.0, np.nan)
    free = {"boundary": "free", "absent_missing": True}
    punch = asperity.solve(disc, lengths=(1.0, 1.0), modulus=1.0, approach=0.01, **free)
    assert line.gap.ndim == 1 and punch.absent_nodes > 0 and punch.contact_fraction == 1.0
    for solution in (line, punch):
        density, edges = solution.pressure_distribution()
        assert np.sum(density * np.diff(edges)) == pytest.approx(solution.contact_fraction, rel=1e-12)


def test_the_pace_of_a_cycle_is_told(law, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    wave = 0.02 * np.cos(2 * np.pi * np.arange(32) / 32)
    loads = {"modulus": 1.0, "law": law, "mean_gaps": [0.05, 0.03, 0.05], "steps": 5}
    cycle = asperity.cycle(wave, 1.0, observe=asperity.progress(), **loads)
    assert cycle.seconds_left > 0
    assert all(cycle.seconds_left >= 0 for _ in cycle) and cycle.seconds_left is None
    del cycle
    shown = capsys.readouterr().err
    assert re.search(r"0 states, 0 events, 0 % of the way, about .* left; error ", shown)
    assert re.search(r"[1-9]\d* states, 0 events, \d+ % of the way, about .* left; error ", shown)


def test_progress_shows_iterations_and_error(rough, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=asperity.progress())
    shown = capsys.readouterr().err
    assert " iterations, error " in shown and shown.endswith("\n")
    assert f"\r{solution.iterations} iterations, error {solution.relative_error:.1e}" in shown
    drawn = []

    class Bar(SimpleNamespace):
        def set_postfix_str(self, text, refresh):
            drawn.append(text)

        def update(self, iterations):
            drawn.append(iterations)

        def close(self):
            drawn.append("closed")

    monkeypatch.setitem(sys.modules, "tqdm.auto", SimpleNamespace(tqdm=Bar))
    asperity.solve(rough, modulus=1.0, mean_pressure=0.01, observe=asperity.progress())
    assert sum(drawn[1::2]) == solution.iterations and drawn[-1] == "closed"


def test_long_calls_show_progress_to_people_by_default(rough, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    monkeypatch.delenv("TQDM_DISABLE", raising=False)

    def shown():
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
        return capsys.readouterr().err

    assert shown() == ""
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    # a short one has none
    assert shown() == ""
    monkeypatch.setattr("asperity.common.progress._PATIENCE", 0.0)
    assert " iterations, error " in shown()
    monkeypatch.setenv("TQDM_DISABLE", "1")
    assert shown() == ""
