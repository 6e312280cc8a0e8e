"""Bodies by the stiffness of their waves, functions of one's own."""

import numpy as np
import pytest

import asperity

LAW = asperity.Exponential(1e-4, 4e-3)


@pytest.fixture(scope="module")
def rough():
    return asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_l=2, k_s=16, seed=1)


def pressed(rough, body=None, **given):
    return asperity.solve(rough, **{"modulus": 1.0, "mean_pressure": 0.02, "body": body, **given})


def half_space(q):
    return 0.5 * q


def half_space_of_both(qx, qy):
    return 0.5 * np.hypot(qx, qy)


def bonded(q, thickness=0.05, nu=0.3):
    """The formula of Bentall and Johnson."""
    x, a = q * thickness, 3 - 4 * nu
    return 0.5 * q * (a * np.cosh(2 * x) + 2 * x**2 + 5 - 12 * nu + 8 * nu**2) / (a * np.sinh(2 * x) - 2 * x)


# of white noise, which has all waves
@pytest.mark.filterwarnings("ignore:noise")
@pytest.mark.parametrize("function", [half_space, half_space_of_both])
@pytest.mark.parametrize("shape", [(64, 64), (48, 30), (35, 33), (128,)])
def test_that_of_the_half_space_is_the_default(function, shape):
    lengths = (1.0, 0.7)[: len(shape)] if len(shape) == 2 else 1.0
    heights = 1e-3 * np.random.default_rng(1).standard_normal(shape)
    default, own = (pressed(heights, lengths=lengths, body=body) for body in (None, asperity.Symbol(function)))
    # the two stiffnesses differ by rounding, and the steps of the solves with them
    np.testing.assert_allclose(own.gap, default.gap, atol=1e-5 * default.gap.max())
    assert own.report["mu_rho"] == pytest.approx(default.report["mu_rho"], rel=1e-12)
    assert (own.report["symbol"], default.report["symbol"]) == (function.__name__, None)
    assert own.report["warnings"] == default.report["warnings"]


def test_that_of_a_layer_is_the_layer(rough):
    layer, own = pressed(rough, asperity.Layer(0.05, 0.3)), pressed(rough, asperity.Symbol(bonded))
    np.testing.assert_allclose(own.gap, layer.gap, atol=1e-8 * layer.gap.max())
    assert (own.iterations, own.contact_fraction) == (layer.iterations, layer.contact_fraction)
    assert "stiffness of its waves, bonded" in repr(own)


def test_complex_numbers_and_one_for_all_waves_are_refused(rough):
    def lossy(q):
        return (0.5 + 0.1j) * q

    with pytest.raises(TypeError, match="lossy returned complex numbers: it must return real ones"):
        pressed(rough, asperity.Symbol(lossy))
    for one in (lambda q: 7.0, lambda q: np.array([7.0])):
        with pytest.raises(ValueError, match="lambda> returned an array of shape .* one value for each wave"):
            pressed(rough, asperity.Symbol(one))


def test_an_anisotropic_body_carries_a_wave_by_the_stiffness_of_that_wave():
    body = asperity.Symbol(lambda qx, qy: 0.5 * np.sqrt(4 * qx**2 + qy**2))
    x = 2 * np.pi * np.arange(32) / 32
    for along, stiffness in [(np.cos(x)[:, None] + 0 * x, 2 * np.pi), (np.cos(2 * x) + 0 * x[:, None], 2 * np.pi)]:
        # pressed flat, so that the pressure is k times the heights
        flat = asperity.solve(0.01 * along, 1.0, modulus=1.5, mean_pressure=1.0, body=body)
        np.testing.assert_allclose(flat.pressure - 1.0, 0.01 * stiffness * along, atol=1e-6)


def test_bits_do_not_depend_on_threads_and_nested_grids_ask_on_each_grid():
    rough = asperity.surface.self_affine(256, 1.0, rms_slope=0.1, k_s=16, seed=1)
    asked = []

    def counted(q):
        asked.append(len(q))
        return 0.5 * q

    one, two = (pressed(rough, asperity.Symbol(half_space), threads=threads, nested=True) for threads in (1, 2))
    assert one.gap.tobytes() == two.gap.tobytes() and len(one.report["levels"]) > 1
    nested = pressed(rough, asperity.Symbol(counted), nested=True)
    grids = [level["shape"][0] for level in nested.report["levels"]]
    # one of q and -q, with those of the Nyquist lines on both sides, and no mean
    assert sorted(n for n in asked if n > 1) == [(n // 2) * (n + 1) + n // 2 for n in grids]


def test_in_f32_sweeps_cycles_stability_and_to_an_accuracy(rough):
    own, layer = asperity.Symbol(bonded), asperity.Layer(0.05, 0.3)
    single = [pressed(rough, body, precision="f32").mean_gap for body in (own, layer)]
    assert single[0] == pytest.approx(single[1], rel=1e-6)
    both = [asperity.sweep(rough, modulus=1.0, mean_gaps=[0.03, 0.02], body=body).columns for body in (own, layer)]
    # at these gaps nothing touches: what is left is rounding
    np.testing.assert_allclose(both[0]["mean_pressure"], both[1]["mean_pressure"], rtol=1e-6, atol=1e-14)
    asperity.cycle(rough, modulus=1.0, mean_gaps=[0.03, 0.02], law=LAW, body=own, steps=3).run()
    held = pressed(rough, own, mean_pressure=None, mean_gap=0.03, law=LAW, stability=True)
    assert asperity.stability(held).verdict == held.report["stability"]["verdict"]
    finer = [pressed(rough, body, accuracy=0.1).contact_fraction for body in (own, layer)]
    assert finer[0] == pytest.approx(finer[1], rel=1e-6)


def test_a_table_knows_its_function_by_its_values(rough, tmp_path):
    def swept(function, gaps):
        given = {"modulus": 1.0, "out": tmp_path / "table.csv", "body": asperity.Symbol(function)}
        return asperity.sweep(rough, mean_gaps=gaps, **given).run().columns["mean_gap"]

    first = lambda q: 0.5 * q  # noqa: E731
    other = lambda q: 0.6 * q  # noqa: E731
    assert len(swept(first, [0.03])) == 1
    assert len(swept(lambda q: q / 2, [0.03, 0.02])) == 2
    with pytest.raises(ValueError, match="table.csv: belongs to another run: its symbol values"):
        swept(other, [0.03, 0.02])


def raising(q):
    raise RuntimeError("no data beyond 10")


@pytest.mark.parametrize(
    ("function", "kind", "message"),
    [
        (lambda q: 0.5 * q - 10, ValueError, r"stiffness is -6.8\d* for the wave \(qx, qy\) = \(6.28\d*, 0\): it must be positive"),
        (lambda q: np.where(q > 100, np.nan, q), ValueError, r"stiffness is NaN for the wave \(qx, qy\) = \(.*\): it must be positive"),
        (lambda qx, qy: np.hypot(qx, qy) + 0.1 * qy, ValueError, r"is .*, and .* for the opposite wave: .*one wave"),
        (lambda q: q[1:], ValueError, r"<lambda> returned an array of shape \[\d+\] for waves of shape \[\d+\]"),
        (lambda q: 1.0 if q < 1 else q, TypeError, "<lambda> takes one wave alone.*numpy.where"),
        (raising, RuntimeError, "no data beyond 10"),
        (lambda q: "stiff", ValueError, "could not convert string to float"),
    ],
)
def test_functions_that_are_no_stiffness_are_refused(rough, function, kind, message):
    with pytest.raises(kind, match=message):
        pressed(rough, asperity.Symbol(function))
    with pytest.raises(kind, match=message):
        pressed(rough, asperity.Symbol(function), nested=True)
    with pytest.raises(kind, match=message):
        asperity.sweep(rough, modulus=1.0, mean_gaps=[0.03], body=asperity.Symbol(function)).run()


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (3.0, "function is 3.0: it must be a function of q, or of qx and qy"),
        (lambda: 1.0, "function has 0 parameters without a default"),
        (lambda qx, qy, qz: 1.0, "function has 3 parameters without a default"),
        (np.vectorize(half_space), "lambda q: ..., or lambda qx, qy: ..."),
    ],
)
def test_what_is_no_function_of_waves_is_refused(function, message):
    with pytest.raises(TypeError, match=message):
        asperity.Symbol(function)


def test_a_free_boundary_is_refused(rough):
    with pytest.raises(ValueError, match="symbol has no free boundary"):
        pressed(rough, asperity.Symbol(half_space), mean_pressure=None, normal_force=0.01, boundary="free")


def test_one_against_another_elastic_body_is_both_in_series(rough):
    both = pressed(rough, modulus=3.0, against_modulus=6.0)
    own = pressed(rough, modulus=3.0, body=asperity.Symbol(lambda q: 1.5 * q), against_modulus=6.0)
    assert own.mean_gap == pytest.approx(both.mean_gap, rel=1e-6)
    assert own.report["mu_rho"] == pytest.approx(both.report["mu_rho"], rel=1e-6)
    assert own.contact_fraction == both.contact_fraction
    assert asperity.pull_off(rough, modulus=3.0, against_modulus=6.0, law=LAW).pressure == pytest.approx(
        asperity.pull_off(rough, modulus=2.0, law=LAW).pressure, rel=0.02
    )
