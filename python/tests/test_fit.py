"""Force curves of known contacts are fitted, with intervals that cover what they were made of.

ASPERITY_CURVES=1000 makes the test of coverage a study of a quarter of an hour: pytest -s tests/test_fit.py -k cover
"""

import os
import subprocess
import sys

import numpy as np
import pytest
from force_curves import LENGTH, MODULUS, PULL, RADIUS, WORK, curve

import asperity

pytest.importorskip("scipy")
special = pytest.importorskip("scipy.special")


def fitted(tabor, spring=20.0, **options):
    z, force = curve(tabor, spring, **options)
    return asperity.fit_curve(z, force, radius=RADIUS, spring_stiffness=spring)


def covers(found, true):
    return found.lower <= true <= found.upper


def test_intervals_cover():
    count = int(os.environ.get("ASPERITY_CURVES", "6"))
    true = {"modulus": MODULUS, "work_of_adhesion": WORK, "contact_point": 3e-9, "offset": 2e-10, "slope": 2e-3}
    true["drift"] = 3e-10
    hits = dict.fromkeys(["tabor_parameter", *true], 0)
    random = np.random.default_rng(5)
    for seed in range(count):
        tabor, spring, noise = 10 ** random.uniform(-1, 0.7), 10 ** random.uniform(0.3, 1.6), random.uniform(0.01, 0.05)
        # an error by a warning if the minimum is not the least, which the residuals show
        fit = fitted(tabor, spring, noise=noise, seed=seed)
        for name in hits:
            hits[name] += covers(getattr(fit, name), true.get(name, tabor))
    print({name: f"{hit / count:.3f}" for name, hit in hits.items()})
    # of 0.95 of so many at least this: fewer come about by chance once in ten thousand times for each name
    least = next(k for k in range(count + 1) if special.bdtr(k, count, 0.95) > 1e-4)
    assert min(hits.values()) >= least, hits


@pytest.mark.parametrize(("tabor", "name", "other"), [(0.0, "DMT", "JKR"), (np.inf, "JKR", "DMT")])
def test_the_limits_are_recovered(tabor, name, other):
    # an end that is hit and one that is ruled out, far from the 0.05 between them
    fit = fitted(tabor, noise=0.01)
    assert fit.models[name].p_value > 0.05 > 1e-6 > fit.models[other].p_value and f"{name} fits" in fit.verdict
    assert fit.models[name].modulus == pytest.approx(MODULUS, rel=0.02)
    assert fit.models[name].work_of_adhesion == pytest.approx(WORK, rel=0.02)
    assert covers(fit.tabor_parameter, tabor) and covers(fit.range, np.inf if tabor == 0.0 else 0.0)


def test_a_curve_between_the_limits_is_told():
    fit = fitted(0.7, noise=0.01)
    assert fit.verdict.startswith("Maugis, with a Tabor parameter from 0.") and covers(fit.tabor_parameter, 0.7)
    assert covers(fit.range, LENGTH / 0.7)
    assert max(fit.models[name].p_value for name in ("Hertz", "DMT", "JKR")) < 0.05 and fit.models["Maugis"].aic == 0.0
    # the covariance is that of the intervals, about twice the standard deviation to both sides
    deviations = np.sqrt(np.diag(fit.covariance))
    for name, deviation in zip(fit.names, deviations):
        found = getattr(fit, name)
        assert found.upper - found.lower == pytest.approx(2 * 1.97 * deviation, rel=0.25), name


def test_the_best_of_several_minima_is_found():
    # with no spring and little noise a range three times as short fits the jumps of this one, and no more
    fit = fitted(0.5, None, noise=1e-3)
    assert fit.tabor_parameter.value == pytest.approx(0.5, rel=0.02) and fit.noise == pytest.approx(1e-3 * PULL, rel=0.15)


def test_a_soft_spring_does_not_tell_the_limits_apart():
    fit = fitted(2.0, 2.0, noise=0.05, points=100)
    assert "cannot tell DMT from JKR" in fit.verdict and fit.tabor_parameter[1:] == (0.0, np.inf)
    assert covers(fit.modulus, MODULUS) and covers(fit.work_of_adhesion, WORK)


@pytest.mark.parametrize("spring", [None, 20.0])
def test_without_adhesion_the_interval_has_zero(spring):
    found = [fitted(None, spring, seed=seed) for seed in range(2)]
    # each has zero in 95 of 100 cases
    bare = [fit for fit in found if fit.work_of_adhesion.lower == 0.0]
    # a pull-off of ten times the noise would be seen
    assert len(bare) >= 1 and all(0.0 <= fit.work_of_adhesion.upper < 0.2 * WORK for fit in found)
    assert all("No adhesion is seen" in fit.verdict and np.isnan(fit.tabor_parameter.value) for fit in bare)
    assert sum(covers(fit.modulus, MODULUS) for fit in found) >= 1


def test_a_long_baseline_and_few_digits_do_no_harm():
    spring, step = 20.0, 0.02 * PULL
    z, force = curve(1.0, spring, far=800, points=2000, noise=0.02, slope=0.0)
    for values in (force, step * np.round(force / step)):
        fit = asperity.fit_curve(z, values, radius=RADIUS, spring_stiffness=spring)
        # the limits of the interval and the noise of rounding, a twelfth of the square of a step
        assert covers(fit.modulus, MODULUS) and covers(fit.work_of_adhesion, WORK)
        assert fit.noise == pytest.approx(0.02 * PULL * (1.0 if values is force else np.sqrt(13 / 12)), rel=0.1)


def test_one_direction_is_enough():
    z, force = curve(1.0, 20.0)
    both = asperity.fit_curve(z, force, radius=RADIUS, spring_stiffness=20.0)
    for part in (slice(200), slice(200, None)):
        fit = asperity.fit_curve(z[part], force[part], radius=RADIUS, spring_stiffness=20.0)
        assert fit.drift is None and fit.names[-1] == "slope"
        assert np.ptp(fit.modulus) > np.ptp(both.modulus) and 0.8 * WORK < fit.work_of_adhesion.value < 1.2 * WORK
    back = asperity.fit_curve(z[:199:-1], force[:199:-1], radius=RADIUS, spring_stiffness=20.0, direction="withdrawal")
    # the same points but for their order
    assert back.modulus == pytest.approx(fit.modulus, rel=1e-2)


def test_a_jump_that_came_early_is_left_out():
    z, force = curve(2.0, 5.0, noise=0.01)
    jump = 200 + int(np.argmax(np.diff(force[200:])))
    # an early jump: the next points behind it were on the baseline already
    force[jump - 5 : jump + 1] = force[jump + 1 : jump + 7]
    fit = asperity.fit_curve(z, force, radius=RADIUS, spring_stiffness=5.0, jumps=False)
    assert covers(fit.work_of_adhesion, WORK) and covers(fit.modulus, MODULUS)
    assert fit.residuals.std() == pytest.approx(0.01 * PULL, rel=0.15)


def test_units_are_those_of_the_si():
    z, force = curve(1.0, 20.0)
    bare = asperity.fit_curve(z, force, radius=RADIUS, spring_stiffness=20.0)
    units = {"radius": "20nm", "spring_stiffness": "20N/m", "length_unit": "nm", "force_unit": "nN"}
    fit = asperity.fit_curve(1e9 * z, 1e9 * force, poisson=0.5, **units)
    # but for the rounding of the factor
    assert fit.modulus == pytest.approx(bare.modulus, rel=1e-6)
    assert fit.young == pytest.approx([0.75 * end for end in fit.modulus])
    assert "GPa" in repr(fit) and "mJ/m²" in repr(fit) and "Pa" not in repr(bare)
    assert repr(fit).splitlines()[-1] == fit.verdict
    for wrong in ({"length_unit": "nm"}, {"radius": 2e-8, "spring_stiffness": 20.0}):
        with pytest.raises(ValueError, match="give all units"):
            asperity.fit_curve(z, force, **{**({"radius": "20nm"} if "radius" not in wrong else units), **wrong})


def test_a_fit_is_drawn():
    plt = pytest.importorskip("matplotlib.pyplot")
    z, force = curve(1.0, 20.0)
    fit = asperity.fit_curve(z, force, radius=RADIUS, spring_stiffness=20.0)
    upper, lower = fit.plot(length_unit="m", force_unit="N")
    assert (upper.get_ylabel(), lower.get_xlabel(), len(upper.get_lines())) == ("force (nN)", "z (nm)", 4)
    assert lower.get_ylabel() == "residual (pN)"
    assert np.allclose(lower.get_lines()[0].get_ydata(), 1e12 * fit.residuals[:200])
    plt.close("all")


def test_what_is_no_curve_is_refused():
    z, force = curve(1.0, 20.0)
    random = np.random.default_rng(1)

    def fit(z, force, **options):
        return asperity.fit_curve(z, force, **{"radius": RADIUS, "spring_stiffness": 20.0, **options})

    with pytest.raises(ValueError, match="there is no contact in the data"):
        fit(z, 1e-3 * z + random.normal(scale=1e-10, size=z.size))
    with pytest.raises(ValueError, match="at .* points in a row: the detector is saturated"):
        fit(z, np.minimum(force, 0.7 * force.max()))
    with pytest.raises(ValueError, match="spring of stiffness 0.02"):
        soft, weak = curve(1.0, 0.02, noise=0.05, points=100)
        fit(soft, weak, spring_stiffness=0.02)
    with pytest.raises(ValueError, match="z has 12 points: a fit of up to 7 parameters needs at least 20"):
        fit(z[:12], force[:12])
    with pytest.raises(ValueError, match="force is nan at point 17, one of 2"):
        fit(z, np.where(np.isin(np.arange(z.size), [17, 40]), np.nan, force))
    with pytest.raises(ValueError, match="z has 400 points and force 399"):
        fit(z, force[1:])
    with pytest.raises(ValueError, match="z must grow as the surfaces approach"):
        fit(-z, force)
    with pytest.raises(ValueError, match="radius is 0.0: it must be positive"):
        fit(z, force, radius=0.0)
    with pytest.raises(ValueError, match="force grows with z by .* spring_stiffness is only 2: one of these is wrong"):
        fit(z, force, spring_stiffness=2.0)
    with pytest.raises(ValueError, match="force is 0.0 at all points"):
        fit(z, 0 * force)
    with pytest.raises(TypeError, match="z is no array of numbers"):
        fit(["a"] * force.size, force)
    with pytest.raises(ValueError, match="length_unit is 'nN'"):
        fit(z, force, radius="20nm", spring_stiffness="20N/m", length_unit="nN", force_unit="nN")
    with pytest.raises(ValueError, match="direction is 'up'"):
        fit(z, force, direction="up")
    with pytest.raises(TypeError, match="did you mean radius"):
        fit(z, force, radiuss=1.0)


def test_masked_points_are_missing_and_curves_without_noise_are_none_that_are_saturated():
    z, force = curve(1.0, 20.0)
    wrong = np.where(np.arange(z.size) % 50 == 7, 1.0, force)
    kept = wrong != 1.0
    options = {"radius": RADIUS, "spring_stiffness": 20.0}
    fits = [asperity.fit_curve(z[kept], force[kept], **options), asperity.fit_curve(z, np.ma.array(wrong, mask=~kept), **options)]
    assert fits[0].modulus == fits[1].modulus and fits[1].z.size == kept.sum()
    for tabor in (None, np.inf):
        z, force = curve(tabor, 20.0, noise=0.0, slope=0.0, drift=0.0)
        assert asperity.fit_curve(z, force, **options).modulus.value == pytest.approx(MODULUS, rel=1e-3)


@pytest.mark.parametrize("least", [0.3, 0.9])
def test_a_withdrawal_that_ends_in_contact_is_in_order(least):
    # at a fixed approach JKR goes on in tension, and the withdrawal ends there or before
    z, force = curve(np.inf, None, drift=0.0)
    cut = z[200:][np.argmin(force[200:])] + (least - 0.9) * LENGTH
    kept = np.append(np.full(200, True), z[200:] > cut)
    fit = asperity.fit_curve(z[kept], force[kept], radius=RADIUS)
    assert covers(fit.modulus, MODULUS) or fit.modulus.value == pytest.approx(MODULUS, rel=0.05)


@pytest.mark.parametrize("model", ["hertz", "dmt", "maugis", "jkr"])
def test_one_model_is_fitted_alone(model):
    tabor = {"hertz": None, "dmt": 0.0, "maugis": 0.7, "jkr": np.inf}[model]
    z, force = curve(tabor, 20.0)
    fit = asperity.fit_curve(z, force, radius=RADIUS, spring_stiffness=20.0, model=model)
    (name,) = fit.models
    assert name.lower() == model and fit.models[name].p_value > 1e-3 and f"By {name} alone" in fit.verdict or model == "hertz"
    assert fit.modulus.value == pytest.approx(MODULUS, rel=0.03)
    assert (fit.work_of_adhesion is None) == (model == "hertz") and fit.tabor_parameter is fit.range is None
    with pytest.raises(ValueError, match="model is 'jkrs': it must be one of 'hertz', 'dmt', 'maugis', 'jkr'"):
        asperity.fit_curve(z, force, radius=RADIUS, model="jkrs")


def test_one_point_may_have_the_greatest_force():
    z, force = curve(1.0, 20.0)
    fit = force < 0.6 * force.max()
    fit[np.argmax(force)] = True
    assert covers(asperity.fit_curve(z[fit], force[fit], radius=RADIUS, spring_stiffness=20.0).modulus, MODULUS)


def test_a_curve_of_another_tip_is_named():
    # a cone has a force as the square of the approach
    approach = np.linspace(-10e-9, 10e-9, 400)
    force = 4e-9 * (approach.clip(0) / 1e-9) ** 2 + np.random.default_rng(1).normal(scale=1e-9, size=400)
    with pytest.warns(asperity.InputWarning, match="neighbouring points have a correlation"):
        asperity.fit_curve(approach, force, radius=RADIUS)


def test_an_indentation_beyond_the_radius_is_told():
    z, force = curve(1.0, None)
    with pytest.warns(asperity.InputWarning, match=r"is 1\.39e\+08 times the radius of the tip: give z, "):
        asperity.fit_curve(1e9 * z, 1e9 * force, radius=RADIUS)


def test_without_scipy_the_way_to_it_is_told():
    script = """
import sys
sys.modules["scipy"] = None
import asperity
asperity.fit_curve(range(20), range(20), radius=1)
"""
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60)
    assert "ImportError: fits need SciPy: pip install 'asperity[fit]'" in found.stderr
