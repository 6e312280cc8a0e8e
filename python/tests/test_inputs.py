"""Heights from arrays of all kinds, and from the objects of other packages."""

import inspect
import pickle
from functools import partial

import numpy as np
import pytest

import asperity


def gap(heights, lengths=(1.0, 1.0), **options):
    return asperity.solve(heights, lengths, modulus=1.0, mean_gap=0.01, **options).gap


@pytest.mark.parametrize(
    "same",
    [
        np.asfortranarray,
        lambda h: h.T.copy().T,
        lambda h: np.repeat(np.repeat(h, 2, 0), 3, 1)[::2, ::3],
        lambda h: h[::-1, ::-1].copy()[::-1, ::-1],
        lambda h: h.astype(">f8"),
        lambda h: h.astype(np.longdouble),
        lambda h: h.tolist(),
        lambda h: np.ma.masked_array(h, mask=False),
    ],
)
def test_any_order_stride_and_float_type_gives_the_same_bits(rough, same):
    assert gap(same(rough.heights)).tobytes() == gap(rough.heights).tobytes()


def test_single_precision_and_integers_are_taken_as_they_are(rough):
    single = rough.heights.astype(np.float32)
    assert gap(single).tobytes() == gap(single.astype(np.float64)).tobytes()
    steps = np.round(1000 * rough.heights).astype(np.int16)
    assert gap(steps, (1000.0, 1000.0)).tobytes() == gap(steps.astype(float), (1000.0, 1000.0)).tobytes()


def test_heights_are_neither_changed_nor_held(rough):
    heights = rough.heights.copy()
    heights.flags.writeable = False
    assert gap(heights).shape == (64, 64) and np.array_equal(heights, rough.heights)
    reused = heights.copy()
    contact = asperity.Contact(reused, 1.0, modulus=1.0)
    solutions = [asperity.solve(reused, 1.0, modulus=1.0, mean_pressure=0.01), contact.solve(mean_pressure=0.01)]
    reused *= 2.0
    solutions.append(next(contact.sweep(mean_pressures=[0.01])))
    for solution in solutions:
        assert np.array_equal(solution.heights, heights) and np.array_equal(solution.gap, solutions[0].gap)


def test_missing_points_are_refused_with_the_remedy(rough):
    heights = rough.heights.copy()
    heights[3, 5] = np.nan
    for missing in (heights, np.ma.masked_invalid(heights), np.ma.masked_array(rough.heights, np.isnan(heights))):
        with pytest.raises(ValueError, match=r"1 of 64 x 64 heights .* at index \[3, 5\].*asperity.prepare\(fill=True"):
            gap(missing)
        with pytest.raises(ValueError, match="or treat them as absent nodes by absent_missing=True"):
            gap(missing)
        filled = asperity.prepare(missing, 1.0, fill=True)
        assert filled.missing == 0 and np.isfinite(gap(filled, None)).all()


def test_what_is_no_map_of_numbers_is_refused():
    for heights in (np.zeros((3, 3), complex), [["a"]], [None], np.zeros((2, 2), "M8[s]")):
        with pytest.raises(TypeError, match="real numbers"):
            gap(heights)
    for heights in (0.0, np.zeros((2, 2, 2)), np.zeros((0, 3)), []):
        with pytest.raises(ValueError, match="have shape"):
            gap(heights)


@pytest.mark.filterwarnings("ignore:open-edges")
def test_one_length_means_square_cells(rough):
    assert asperity.prepare(rough.heights[:, :32], 1.0).lengths == (1.0, 0.5)
    assert asperity.surface.self_affine((64, 32), 1.0, rms_slope=0.1, k_s=8).lengths == (1.0, 0.5)


def test_maps_beyond_the_memory_are_an_error():
    endless = np.broadcast_to(np.zeros(1), (2**20, 2**20))
    small = np.random.default_rng(1).normal(size=(16, 16))
    for ask in (
        lambda: asperity.solve(endless, 1.0, modulus=1.0, mean_gap=1.0),
        lambda: asperity.surface.statistics(endless, 1.0),
        lambda: asperity.prepare(endless, 1.0),
        lambda: asperity.prepare(small, 1.0, resample=(2**20, 2**20)),
        lambda: asperity.surface.self_affine(2**20, 1.0, rms_slope=0.1),
    ):
        with pytest.raises(MemoryError, match="1048576 x 1048576 nodes takes .* GiB"):
            ask()


def test_threads_are_as_many_as_in_the_tool(rough):
    for threads in (0, 1025, 10**9):
        with pytest.raises(ValueError, match=f"threads is {threads}: it must be from 1 to 1024"):
            gap(rough, None, threads=threads)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda h: asperity.solve(h, modulus=1.0, mean_pressures=[1.0]), "give mean_pressure, .* asperity.sweep"),
        (lambda h: asperity.sweep(h, modulus=1.0, mean_gap=0.1), r"give mean_gaps=\[...\], or one load to asperity.solve"),
        (lambda h: asperity.solve(h, modulus=1.0, pressure=1.0), r"solve\(\) .* pressure: did you mean mean_pressure"),
        (lambda h: asperity.cycle(h, modulus=1.0, gap=[1.0]), "has no keyword gap: did you mean mean_gaps"),
        (lambda h: asperity.solve(h, E=1.0, mean_gap=1.0), "did you mean modulus"),
        (lambda h: asperity.solve(h, modulus=1.0, mean_gap=1.0, tolerence=1.0), "did you mean tolerance"),
        (lambda h: asperity.solve(h, modulus=1.0, mean_gap=1.0, initial_gap=h), "did you mean start"),
        (lambda h: asperity.sweep(h, modulus=1.0, indentation=[1.0]), "did you mean approaches"),
        (lambda h: asperity.prepare(h, detrand="plane"), r"prepare\(\) has no keyword detrand: did you mean detrend"),
        (lambda h: asperity.Exponential(work_of_adhesion=1.0, rho=1.0), r"Exponential\(\) .* rho: did you mean range"),
        (lambda h: asperity.VanDerWaals(A=1.0, range=1.0), r"VanDerWaals\(\) has no keyword A: did you mean hamaker"),
        (lambda h: asperity.Morse(1.0, None), r"Morse\(\) is without range"),
        (lambda h: asperity.Morse(1.0, 1.0, colour=1.0), "it has work_of_adhesion, range"),
    ],
)
def test_a_keyword_that_is_wrong_is_told_by_the_right_one(rough, ask, message):
    with pytest.raises(TypeError, match=message):
        ask(rough)


def test_functions_of_the_package_travel_to_other_processes():
    for function in (asperity.solve, asperity.sweep, asperity.cycle, asperity.prepare, asperity.stability):
        assert pickle.loads(pickle.dumps(function)) is function
        assert "Parameters" in function.__doc__ and "kwargs" not in inspect.signature(function).parameters


def test_one_length_of_a_topography_means_square_cells():
    heights = np.random.default_rng(1).normal(size=(16, 8)) * 1e-3
    topography = asperity.Topography(heights, 1.0)
    assert topography.lengths == (1.0, 0.5) and asperity.Topography(heights[:, 0], 2.0).lengths == (2.0, 2.0)
    assert asperity.solve(topography, modulus=1.0, mean_pressure=1e-3).converged
    for line in (heights[:, 0], heights[:, 0].tolist()):
        gap = asperity.solve(asperity.Topography(line, 2.0), modulus=1.0, mean_pressure=1e-3).gap
        assert gap.tobytes() == asperity.solve(line, 2.0, modulus=1.0, mean_pressure=1e-3).gap.tobytes()
    with pytest.raises(ValueError, match="they must be .Lx, Ly., or Lx alone"):
        asperity.Topography(heights, (1.0, 2.0, 3.0))


def test_no_message_prints_an_array(rough):
    big = np.ones((32, 32))
    solve = partial(asperity.solve, rough, modulus=1.0)
    for call, expected in {
        lambda: solve(mean_pressure=0.1, law="exponential", work_of_adhesion=big, range=1.0): r"Varying\(law, works\)",
        lambda: solve(mean_pressure=0.1, law="exponential", work_of_adhesion=[1.0] * 999, range=1.0): "4993 characters",
        lambda: solve(mean_pressure=big): r"mean_pressure is an array of shape \(32, 32\)",
        lambda: solve(mean_pressure=0.1, body=big): "body is an array of shape .*: it must be an asperity.Layer",
        lambda: solve(spring=big): "spring is an array of shape",
        lambda: asperity.Layer(big, 0.3): "thickness is an array of shape",
        lambda: asperity.prepare(big, 1.0, resample=big): "resample is a list of lists",
    }.items():
        with pytest.raises((TypeError, ValueError), match=expected) as refused:
            call()
        assert len(str(refused.value)) < 250
