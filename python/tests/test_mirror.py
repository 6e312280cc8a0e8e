"""Solutions on mirrored maps are of the original, unless the whole is asked for."""

import numpy as np
import pytest

import asperity


@pytest.fixture(scope="module")
def mirrored():
    rough = asperity.surface.self_affine(48, 1.0, rms_slope=0.1, k_l=2, k_s=10, seed=5)
    return asperity.prepare(rough, crop=(4, 2, 32, 24), mirror=True)


def test_a_solution_is_of_the_original(mirrored):
    assert (mirrored.shape, mirrored.original, mirrored.seed) == ((64, 48), (32, 24), 5)
    part = asperity.solve(mirrored, modulus=1.0, mean_pressure=0.01, stability=True, stiffness=True)
    whole = asperity.solve(mirrored, modulus=1.0, mean_pressure=0.01, stability=True, stiffness=True, whole=True)
    assert (part.report["part"], whole.report["part"]) == ("original", "whole")
    assert (part.report["shape"], part.report["solved_shape"], whole.report["solved_shape"]) == ([32, 24], [64, 48], None)
    for name in ("gap", "pressure", "contact_pressure", "heights", "contact", "mode"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name)[:32, :24])
    np.testing.assert_array_equal(part.whole_gap, whole.gap)
    assert part.lengths == pytest.approx((32 / 48, 24 / 48))
    assert part.statistics.contact_nodes == part.report["contact_nodes"] == part.contact.sum()
    assert part.statistics.perimeter == part.report["perimeter"]
    assert asperity.contact.tables(part).figures["perimeter"] == pytest.approx(part.statistics.perimeter)
    assert "original, 32 x 24 of 64 x 48 nodes" in repr(part)


def test_a_start_may_be_of_either(mirrored):
    first = asperity.solve(mirrored, modulus=1.0, mean_pressure=0.01)
    for start in (first, first.gap, first.whole_gap):
        again = asperity.solve(mirrored, modulus=1.0, mean_pressure=0.01, start=start)
        assert again.converged and again.iterations < first.iterations
    assert asperity.stability(first).mode.shape == (32, 24)


def test_an_accuracy_refines_the_original_too(mirrored):
    right = asperity.solve(mirrored, modulus=1.0, mean_pressure=0.01, accuracy=0.2)
    assert right.gap.shape == right.heights.shape == tuple(right.report["shape"])
    assert right.report["shape"] == [nodes // 2 for nodes in right.report["solved_shape"]]
