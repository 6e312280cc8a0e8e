"""Exact solutions at many loads at once."""

import pickle
import re

import numpy as np
import pytest

from asperity import exact


def test_hertz_is_a_function_of_arrays():
    loads = np.geomspace(1e-6, 1e-2, 12).reshape(3, 4)
    contact = exact.Hertz(2.0, 1.0).at_load(loads)
    assert np.allclose(contact.contact_radius**3, 0.75 * loads * 2.0) and contact.approach.shape == (3, 4)
    assert np.allclose(contact.load, loads)
    r = np.linspace(0.0, 0.2, 5)
    assert contact.pressure(r).shape == (3, 4, 5) and contact.gap(0.0).shape == (3, 4)


def test_one_load_gives_numbers():
    contact = exact.Jkr(2.0, 1.0, 1e-5).pull_off()
    assert isinstance(contact.load, float) and np.isclose(contact.load, -1.5 * np.pi * 1e-5 * 2.0)
    assert isinstance(contact.pressure(0.0), float)


def test_maugis_is_between_jkr_and_dmt():
    sphere = exact.MaugisDugdale(2.0, 1.0, 1e-4, 2e-3)
    assert np.isclose(sphere.tabor_parameter, 1.36, atol=5e-3)
    assert 1.5 < -sphere.pull_off().load / (np.pi * 1e-4 * 2.0) < 2.0
    loads = np.linspace(0.9 * sphere.pull_off().load, 1e-3, 5)
    assert np.allclose(
        sphere.at_contact_radius(sphere.at_load(loads).contact_radius).load, loads, rtol=1e-9, atol=1e-14
    )


def test_waves():
    wave = exact.WavyLine(0.01, 1.0, 1.0)
    half = wave.at_mean_pressure([0.0, 0.5 * wave.closing_pressure]).half_width
    assert np.allclose(half, [0.0, 0.25])
    assert np.isclose(exact.closing_pressure_2d(0.01, 1.0, 1.0), 0.0444288, atol=1e-7)
    adhesive = exact.AdhesiveWavyLine(0.01, 1.0, 1.0, 1e-5)
    assert adhesive.pull_off().mean_pressure < 0 < adhesive.jump_to_full_contact().mean_pressure


def test_what_a_solution_does_not_have_is_refused():
    with pytest.raises(ValueError, match="load is -1: it must be no tension beyond the pull-off force"):
        exact.Jkr(2.0, 1.0, 1e-5).at_load([0.0, -1.0])
    with pytest.raises(ValueError, match="radius of curvature is 0"):
        exact.Hertz(0.0, 1.0)
    with pytest.raises((TypeError, ValueError)):
        exact.Hertz(1.0, 1.0).at_load("much")


def test_numbers_have_units_or_none():
    tip, bare = exact.Jkr("20nm", "2GPa", "50mJ/m2"), exact.Jkr(20e-9, 2e9, 0.05)
    assert tip == bare and (tip.radius, tip.modulus) == (20e-9, 2e9)
    found, same = tip.at_load(["-1nN", "5nN"]), bare.at_load([-1e-9, 5e-9])
    assert np.array_equal(found.contact_radius, same.contact_radius)
    # numbers beside units are in the SI
    assert np.array_equal(tip.at_load([-1e-9, 5e-9]).approach, same.approach)
    assert np.array_equal(found.pressure(["0nm", "1nm"]), same.pressure([0.0, 1e-9]))
    wave = exact.WavyLine(amplitude="10nm", wavelength="1um", modulus="1GPa")
    assert wave.at_half_width("250nm").mean_pressure == pytest.approx(0.5 * wave.closing_pressure, rel=1e-12)
    assert exact.closing_pressure_2d("10nm", "1um", "1GPa") == pytest.approx(np.sqrt(2) * wave.closing_pressure)
    copied = pickle.loads(pickle.dumps(tip))
    assert copied == tip and repr(copied) == repr(tip)


@pytest.mark.parametrize(
    ("message", "wrong"),
    [
        ("modulus is 2000000000.0, without a unit, but radius 20nm has", lambda: exact.Hertz("20nm", 2e9)),
        ("radius is 20Pa: Pa is a unit of something else", lambda: exact.Hertz("20Pa", "2GPa")),
        ("load is 1nm: nm is a unit of something else", lambda: exact.Hertz("20nm", "2GPa").at_load("1nm")),
        ("load is 2.0: give a number, or a text", lambda: exact.Hertz("20nm", "2GPa").at_load(["1nN", 2.0])),
        ("load is 1nN, with a unit, but Hertz(radius=2, modulus=1) has", lambda: exact.Hertz(2.0, 1.0).at_load("1nN")),
    ],
)
def test_what_a_formula_refuses(message, wrong):
    with pytest.raises(ValueError, match=re.escape(message)):
        wrong()


def test_solutions_and_states_say_what_they_are():
    tip = exact.Hertz("20nm", modulus="70GPa")
    assert repr(tip).startswith("Hertz(radius='20nm', modulus='70GPa')\n  sphere without adhesion: P = ")
    assert repr(tip).endswith("Hertz (1881)")
    assert "contact_radius=" in repr(tip.at_load("1nN"))
    assert repr(tip.at_load(np.ones((3, 4)))) == "Contact(3, 4) of Hertz(radius='20nm', modulus='70GPa')"
