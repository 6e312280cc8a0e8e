"""Adhesion laws written in Python."""

import math
import threading

import numpy as np
import pytest
from own_laws import Exponential

import asperity


class Linear:
    """A traction that falls linearly to zero at the range: its slope jumps."""

    def __init__(self, work_of_adhesion, range):
        self.w, self.range = work_of_adhesion, range

    def left(self, gap):
        return np.maximum(1 - gap / self.range, 0.0)

    def energy(self, gap):
        return -self.w * self.left(gap) ** 2

    def traction(self, gap):
        return 2 * self.w / self.range * self.left(gap)

    def slope(self, gap):
        return np.where(gap < self.range, -2 * self.w / self.range**2, 0.0)


class Dugdale(Linear):
    """A traction that jumps to zero at the range."""

    def energy(self, gap):
        return -self.w * self.left(gap)

    def traction(self, gap):
        return np.where(gap < self.range, self.w / self.range, 0.0)

    def slope(self, gap):
        return np.zeros_like(gap)


W, RANGE = 2e-5, 8e-3


def test_a_law_in_python_may_be_cut_off(rough):
    cut = asperity.CutOff(Exponential(2e-5, 8e-3), 0.03)
    built_in = asperity.CutOff(asperity.Exponential(2e-5, 8e-3), 0.03)
    gaps = np.linspace(0.0, 0.04, 50)
    # the table has energy and traction to 1e-11 of their largest values
    assert np.allclose(cut.traction(gaps), built_in.traction(gaps), rtol=0, atol=1e-10 * built_in.traction(0.0))
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=cut)
    assert solution.report["law"] == "Exponential" and solution.report["cut_off"] == 0.03


@pytest.mark.parametrize("threads", [1, 2])
def test_a_law_in_python_is_that_of_the_library(rough, threads):
    options = {"modulus": 1.0, "mean_pressure": 0.01, "tolerance": 1e-8, "threads": threads}
    own = asperity.solve(rough, law=Exponential(2e-5, 8e-3), **options)
    built_in = asperity.solve(rough, law=asperity.Exponential(2e-5, 8e-3), **options)
    # the table has the traction to 1e-11; both solutions have their certified error
    assert np.allclose(own.gap, built_in.gap, rtol=0, atol=1e-7 * built_in.gap.max())
    assert own.report["contact_nodes"] == built_in.report["contact_nodes"]
    assert own.report["law"] == "Exponential" and own.report["range"] == 8e-3
    assert np.isclose(own.adhesive_energy, built_in.adhesive_energy, rtol=1e-9)
    assert own.report["mu_rho"] == built_in.report["mu_rho"]


def test_a_law_is_read_in_large_blocks_before_the_solve(rough):
    law = Exponential(2e-5, 8e-3)
    asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
    assert len(law.calls) < 10 and max(law.calls) > 4096


def test_kinks_and_jumps_are_enclosed(rough):
    for law in (Linear(2e-5, 1.6e-2), Dugdale(2e-5, 8e-3)):
        solution = asperity.solve(rough, modulus=1.0, mean_gap=0.012, law=law)
        # the adhesive energy of the table is that of the law, node by node
        assert np.isclose(solution.adhesive_energy, law.energy(solution.gap).mean(), rtol=1e-10)


def test_a_jump_in_python_is_as_good_as_maugis_dugdale(rough):
    # the equilibrium depends on the start, which is that of the smoothed law
    built_in = asperity.solve(rough, modulus=1.0, mean_gap=0.012, law=asperity.MaugisDugdale(2e-5, 8e-3))
    works = np.full((64, 64), 2e-5)
    for law in (
        Dugdale(2e-5, 8e-3),
        asperity.CutOff(Dugdale(2e-5, 8e-3), 0.03),
        asperity.CutOff(asperity.MaugisDugdale(2e-5, 8e-3), 8e-3),
        asperity.Varying(Dugdale(1.0, 8e-3), works),
        asperity.Varying(asperity.CutOff(asperity.MaugisDugdale(1.0, 8e-3), 0.03), works),
    ):
        own = asperity.solve(rough, modulus=1.0, mean_gap=0.012, law=law)
        assert np.isclose(own.mean_pressure, built_in.mean_pressure, rtol=1e-5, atol=1e-9)
        assert np.array_equal(own.contact, built_in.contact)


def test_an_exception_in_a_law_arrives_as_it_was_raised(rough):
    class Broken(Exponential):
        def traction(self, gap):
            raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError, match="mine"):
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=Broken(2e-5, 8e-3))
    with pytest.raises(ZeroDivisionError, match="mine"):
        asperity.check_law(Broken(2e-5, 8e-3), 0.1)


def test_a_law_that_is_none_is_refused(rough):
    class Short(Exponential):
        slope = None

    class Inconsistent(Exponential):
        def slope(self, gap):
            return 0.5 * super().slope(gap)

    class Infinite(Exponential):
        def energy(self, gap):
            with np.errstate(divide="ignore"):
                return -1.0 / gap

    class Shapeless(Exponential):
        def traction(self, gap):
            return super().traction(gap)[:7]

    options = {"modulus": 1.0, "mean_pressure": 0.01}
    with pytest.raises(TypeError, match=r"of type Short, without a method slope\(gap\)"):
        asperity.solve(rough, law=Short(2e-5, 8e-3), **options)
    with pytest.raises(ValueError, match="check_law"):
        asperity.solve(rough, law=Inconsistent(2e-5, 8e-3), **options)
    with pytest.raises(ValueError, match="slope of the adhesive traction is .* at a gap of"):
        asperity.check_law(Inconsistent(2e-5, 8e-3), 0.1)
    with pytest.raises(ValueError, match="adhesive energy is -inf at a gap of 0"):
        asperity.solve(rough, law=Infinite(2e-5, 8e-3), **options)
    with pytest.raises(ValueError, match=r"law.traction returned an array of shape \[7\]"):
        asperity.solve(rough, law=Shapeless(2e-5, 8e-3), **options)


def test_a_range_that_is_too_short_for_the_law_is_refused(rough):
    law, narrow = Exponential(2e-5, 8e-3), Exponential(2e-5, 1e-10)
    narrow.energy, narrow.traction, narrow.slope = law.energy, law.traction, law.slope
    with pytest.raises(ValueError, match="still has a traction at a gap of 1.04.*e-4, .* give it an attribute range"):
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=narrow)


def test_a_law_in_python_serves_single_precision_too(rough):
    options = {"modulus": 1.0, "mean_pressure": 0.01, "precision": "f32"}
    own = asperity.solve(rough, law=Exponential(2e-5, 8e-3), **options)
    built_in = asperity.solve(rough, law=asperity.Exponential(2e-5, 8e-3), **options)
    # both to a certified error of 1e-4
    assert np.allclose(own.gap, built_in.gap, rtol=0, atol=1e-3 * built_in.gap.max())


def test_the_laws_here_agree_with_themselves():
    for law in (Exponential(2e-5, 8e-3), Linear(2e-5, 8e-3), Dugdale(2e-5, 8e-3), asperity.Exponential(1.0, 0.1)):
        asperity.check_law(law, 0.1)


def test_laws_in_python_on_many_threads_do_not_wait_for_each_other(rough):
    found = []

    def solve():
        solution = asperity.solve(
            rough, modulus=1.0, mean_pressure=0.01, law=Exponential(2e-5, 8e-3), observe=lambda _: None
        )
        found.append(solution.gap.tobytes())

    threads = [threading.Thread(target=solve) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert len(found) == 8 and len(set(found)) == 1


class Powers:
    """Attraction by one power of the distance, and repulsion by a higher one, at rest at a distance of one range."""

    def __init__(self, work_of_adhesion, rest, high=8, low=2, shift=0.0):
        self.w, self.rest, self.high, self.low, self.shift = work_of_adhesion, rest, high, low, shift
        self.factor = work_of_adhesion / (high - low)

    def terms(self, gap, derivative):
        for power, factor in ((self.high, self.low), (self.low, -self.high)):
            yield power, self.factor * factor * (self.rest / (gap + self.shift)) ** (power + derivative)

    def energy(self, gap):
        return sum(term for _, term in self.terms(gap, 0))

    def traction(self, gap):
        return sum(-power / self.rest * term for power, term in self.terms(gap, 1))

    def slope(self, gap):
        return sum(power * (power + 1) / self.rest**2 * term for power, term in self.terms(gap, 2))


class Shifted:
    """A law of Morse whose gap counts from elsewhere."""

    def __init__(self, work_of_adhesion, length, rest):
        self.w, self.length, self.rest = work_of_adhesion, length, rest

    def e(self, gap):
        return np.exp(-(gap - self.rest) / self.length)

    def energy(self, gap):
        return self.w * self.e(gap) * (self.e(gap) - 2)

    def traction(self, gap):
        return 2 * self.w / self.length * self.e(gap) * (1 - self.e(gap))

    def slope(self, gap):
        return 2 * self.w / self.length**2 * self.e(gap) * (2 * self.e(gap) - 1)


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_a_law_in_python_that_repels_keeps_the_surfaces_apart(rough, precision):
    options = {"modulus": 1.0, "mean_pressure": 0.01, "wall": "none", "precision": precision}
    close = {"rtol": 0, "atol": 1e-6 if precision == "f64" else 1e-3}
    for own, built_in, shift in [
        (Powers(W, RANGE), asperity.LennardJones(W, RANGE), 0.0),
        (Shifted(W, RANGE, 0.0), asperity.Morse(W, RANGE), 0.0),
        (Shifted(W, RANGE, 2 * RANGE), asperity.Morse(W, RANGE), 2 * RANGE),
    ]:
        asperity.check_law(own)
        found = asperity.solve(rough, law=own, **options)
        expected = asperity.solve(rough, law=built_in, **options)
        assert found.converged and np.allclose((found.gap - shift) / RANGE, expected.gap / RANGE, **close)
        assert np.array_equal(found.contact, own.traction(found.gap) < 0) or precision == "f32"
        assert np.isclose(found.adhesive_energy, expected.adhesive_energy, rtol=1e-6 if precision == "f64" else 1e-3)
    # with a wall the law of Morse need not say its range either
    wall = {**options, "wall": "hard"}
    laws = (Shifted(W, RANGE, 0.0), asperity.Morse(W, RANGE))
    found, expected = (asperity.solve(rough, law=law, **wall) for law in laws)
    assert np.allclose(found.gap / RANGE, expected.gap / RANGE, **close)


def test_any_law_with_a_gap_of_rest_will_do(rough):
    powers = [(RANGE, 12, 6), (RANGE, 3, 1.5), (RANGE, 8, 2, RANGE), (3.7e-3, 5, 3)]
    for law in (Powers(W, *given) for given in powers):
        asperity.check_law(law)
        for pressure in (1e-4, 0.01, 0.2):
            found = asperity.solve(rough, modulus=1.0, mean_pressure=pressure, law=law, wall="none")
            assert found.converged
            # the table has what the law has, node by node
            assert np.isclose(found.adhesive_energy, law.energy(found.gap).mean(), rtol=1e-9)
            assert np.isclose(law.traction(found.gap).mean(), -pressure, rtol=1e-4)
            assert np.array_equal(found.contact, law.traction(found.gap) < 0) and found.contact.any()
    with pytest.raises(ValueError, match=r"wall='none', or LennardJones"):
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=Powers(W, RANGE))
    with pytest.raises(ValueError, match="does not repel"):
        asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=Linear(W, RANGE), wall="none")


def test_a_law_may_refuse_negative_gaps(rough):
    class Strict(Shifted):
        def traction(self, gap):
            if np.any(gap < 0):
                raise ValueError("negative")
            return super().traction(gap)

    options = {"modulus": 1.0, "mean_pressure": 0.01}
    found = asperity.solve(rough, law=Strict(W, RANGE, 0.0), **options)
    expected = asperity.solve(rough, law=asperity.Morse(W, RANGE), **options)
    assert np.allclose(found.gap / RANGE, expected.gap / RANGE, rtol=0, atol=1e-6)
    with pytest.raises(ValueError, match="does not repel"):
        asperity.solve(rough, law=Strict(W, RANGE, 0.0), wall="none", **options)


def test_the_gap_of_rest_is_found_in_any_unit():
    heights = np.cos(2 * np.pi * np.arange(32) / 32)
    for unit in (1e-9, 1e-6, 1.0, 1e3):
        law = Powers(1e-4 * unit, 0.01 * unit)
        found = asperity.solve(0.02 * unit * heights, unit, modulus=1.0, mean_pressure=1e-3, law=law, wall="none")
        assert found.converged and np.isclose(found.gap.min() / unit, 0.01, rtol=0.2)


def test_a_wrong_sign_is_told(rough):
    class Flipped:
        def __init__(self, law, functions):
            self.law, self.functions = law, functions

        def __getattr__(self, name):
            value = getattr(self.law, name)
            return (lambda gap: -value(gap)) if name in self.functions else value

    options = {"modulus": 1.0, "mean_pressure": 0.01}
    # those whose work and range are named, and those where they have to be found
    shifted = [Shifted(W, RANGE, rest) for rest in (0.0, RANGE)]
    for law in (Exponential(W, RANGE), Linear(W, RANGE), Powers(W, RANGE), *shifted):
        for functions in (["traction"], ["traction", "slope"], ["energy"]):
            for ask in (lambda law: asperity.solve(rough, law=law, **options), asperity.check_law):
                with pytest.raises(ValueError, match="change the sign of one of the two|correct one of the two"):
                    ask(Flipped(law, functions))
    upside_down = Flipped(Linear(W, RANGE), ["energy", "traction", "slope"])
    with pytest.raises(ValueError, match="positive at no gap: the law repels"):
        asperity.solve(rough, law=upside_down, **options)


def test_a_law_for_one_gap_alone_is_told_of_arrays(rough):
    class Scalar(Linear):
        def traction(self, gap):
            return 2 * self.w / self.range * (1 - gap / self.range) if gap < self.range else 0.0

    class Math(Exponential):
        def traction(self, gap):
            return self.work_of_adhesion / self.range * math.exp(-gap / self.range)

    for law in (Scalar(W, RANGE), Math(W, RANGE)):
        for ask in (lambda law: asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law), asperity.check_law):
            with pytest.raises(TypeError, match=r"law.traction takes one gap alone.* arrays .*numpy.where") as raised:
                ask(law)
            assert isinstance(raised.value.__cause__, (TypeError, ValueError))


def test_check_law_needs_no_gap():
    for law in (Exponential(W, RANGE), Linear(W, RANGE), Powers(W, RANGE)):
        asperity.check_law(law)
