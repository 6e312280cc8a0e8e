"""Adhesion laws written in Python."""

import math
import threading
from types import SimpleNamespace

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


W, RANGE = 2e-5, 8e-3


def own(law, wrong=()):
    """The functions of a law alone, some of them with the wrong sign."""

    def function(name):
        right = getattr(law, name)
        return (lambda gap: -right(gap)) if name in wrong else right

    return SimpleNamespace(**{name: function(name) for name in ("energy", "traction", "slope")})


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


def test_a_kink_is_enclosed(rough):
    law = Linear(2e-5, 1.6e-2)
    solution = asperity.solve(rough, modulus=1.0, mean_gap=0.012, law=law)
    # the adhesive energy of the table is that of the law, node by node
    assert np.isclose(solution.adhesive_energy, law.energy(solution.gap).mean(), rtol=1e-10)


def test_a_law_in_python_that_repels_keeps_the_surfaces_apart(rough):
    options = {"modulus": 1.0, "mean_pressure": 0.01, "wall": "none"}
    law = asperity.Morse(W, RANGE)
    found, expected = (asperity.solve(rough, law=one, **options) for one in (own(law), law))
    assert found.converged and np.allclose(found.gap / RANGE, expected.gap / RANGE, rtol=0, atol=1e-6)
    assert np.array_equal(found.contact, expected.contact)


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
    law, narrow = Exponential(2e-5, 8e-3), Exponential(2e-5, 1e-10)
    narrow.energy, narrow.traction, narrow.slope = law.energy, law.traction, law.slope
    with pytest.raises(ValueError, match="still has a traction at a gap of 1.04.*e-4, .* give it an attribute range"):
        asperity.solve(rough, law=narrow, **options)
    with pytest.raises(ValueError, match=r"wall='none', or LennardJones"):
        asperity.solve(rough, law=own(asperity.LennardJones(W, RANGE)), **options)


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


def test_a_wrong_sign_is_told(rough):
    options = {"modulus": 1.0, "mean_pressure": 0.01}
    # one whose range is found, and one that repels
    for law in (asperity.Exponential(W, RANGE), asperity.Morse(W, RANGE)):
        for wrong in (["traction"], ["energy"]):
            for ask in (lambda law: asperity.solve(rough, law=law, **options), asperity.check_law):
                with pytest.raises(ValueError, match="change the sign of one of the two|correct one of the two"):
                    ask(own(law, wrong))
    with pytest.raises(ValueError, match="positive at no gap: the law repels"):
        asperity.solve(rough, law=own(Linear(W, RANGE), ["energy", "traction", "slope"]), **options)


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


def test_check_law_passes_laws_and_needs_no_gap():
    for law in (Exponential(2e-5, 8e-3), Linear(2e-5, 8e-3), asperity.Exponential(1.0, 0.1)):
        asperity.check_law(law, 0.1)
    for law in (Exponential(W, RANGE), Linear(W, RANGE), own(asperity.LennardJones(W, RANGE))):
        asperity.check_law(law)
