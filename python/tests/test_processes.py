"""Many solves: in threads, in processes, and one after the other."""

import copy
import multiprocessing
import pickle
import resource
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import asperity


def share(seed, threads=1):
    heights = asperity.surface.self_affine(32, 1.0, rms_slope=0.1, k_l=2, k_s=8, seed=seed)
    return asperity.solve(heights, modulus=1.0, mean_pressure=0.01, threads=threads).contact_fraction


@pytest.mark.parametrize("threads", [1, None])
def test_a_pool_of_threads_finds_the_same(threads):
    expected = [share(seed) for seed in range(40)]
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(share, range(40), [threads] * 40)) == expected


def test_solves_of_one_contact_wait_for_each_other(rough, law):
    contact = asperity.Contact(rough, modulus=1.0, law=law, body=asperity.Layer(0.2, 0.3, "bonded"))
    loads = [0.01, 0.02, 0.03, 0.04] * 4
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(lambda load: contact.solve(mean_pressure=load), loads))
        assert [one.mean_gap for one in found] == [contact.solve(mean_pressure=load).mean_gap for load in loads]
        table = contact.sweep(mean_pressures=loads)
        solved = [one for one in pool.map(lambda _: next(table, None), range(20)) if one is not None]
    assert len(table.rows) == len(solved) == len(loads) and {type(one.body) for one in solved} == {asperity.Layer}
    assert pickle.loads(pickle.dumps(table)).rows == table.rows
    assert copy.copy(contact).solve(mean_pressure=0.01).gap.tobytes() == contact.solve(mean_pressure=0.01).gap.tobytes()


def test_an_observer_does_not_solve_its_own_contact(rough):
    contact = asperity.Contact(rough, modulus=1.0)
    table = contact.sweep(mean_pressures=[0.01, 0.02], observe=lambda _: next(table))
    refused = "its observer cannot solve it in between: make another asperity.Contact"
    with pytest.raises(RuntimeError, match=refused):
        contact.solve(mean_pressure=0.01, observe=lambda _: contact.solve(mean_pressure=0.02))
    with pytest.raises(RuntimeError, match=refused):
        next(table)
    assert contact.solve(mean_pressure=0.01).converged


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
# a fork of a process with threads is what is tested
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_processes_find_the_same_however_they_are_started(method):
    expected = [share(seed, None) for seed in range(6)]  # threads are running in this process
    context = multiprocessing.get_context(method)
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        assert list(pool.map(share, range(6), [None] * 6, timeout=100)) == expected


@pytest.mark.parametrize("backend", ["loky", "threading"])
def test_joblib_finds_the_same(backend):
    joblib = pytest.importorskip("joblib")
    found = joblib.Parallel(n_jobs=2, backend=backend)(joblib.delayed(share)(seed) for seed in range(6))
    assert found == [share(seed) for seed in range(6)]


@pytest.mark.skipif(sys.platform != "linux", reason="the peak of the memory is in kilobytes on Linux alone")
def test_ten_thousand_solves_do_not_grow_the_memory():
    heights = asperity.surface.self_affine(16, 1.0, rms_slope=0.1, k_l=2, k_s=6)
    law = asperity.Exponential(1e-5, 8e-3)

    def solve(count):
        for _ in range(count):
            asperity.solve(heights, modulus=1.0, mean_gap=0.01, law=law, threads=1)
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = solve(1000)
    # a leak of one field of 2 KB a solve would be 18 MB
    assert solve(9000) - before < 4000


def test_arrays_outlive_their_solution(rough):
    gap = asperity.solve(rough, modulus=1.0, mean_gap=0.01).gap
    copy = gap.copy()
    for _ in range(20):
        asperity.solve(rough, modulus=1.0, mean_gap=0.02)
    assert np.array_equal(gap, copy)


def test_a_solution_travels_between_processes(rough, law):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
    other = pickle.loads(pickle.dumps(solution))
    assert other.report == solution.report and repr(other) == repr(solution)
    assert other.gap.tobytes() == solution.gap.tobytes()
    assert other.statistics.cluster_sizes.tolist() == solution.statistics.cluster_sizes.tolist()
