"""Quantities with units."""

import pickle
import re

import numpy as np
import pytest

import asperity


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"modulus": "70GPa"}, "mean_gap is 0.01, without a unit, but modulus 70GPa has one: give both units, or neither"),
        ({"mean_gap": None, "modulus": "1GPa", "spring": ("2N/m", 1.0)}, "spring_position is 1.0, without a unit, but modulus 1GPa has"),
        ({"modulus": "70gpa"}, "modulus is 70gpa: gpa is no unit that is known (did you mean GPa?), it must be a number"),
    ],
)
def test_quantities_all_have_units_or_none_has(rough, wrong, message):
    with pytest.raises(ValueError, match=re.escape(message)):
        asperity.solve(rough, **{"modulus": 1.0, "mean_gap": 0.01, **wrong})


def test_quantities_with_units_are_in_the_si(rough):
    metres = asperity.Topography(1e-6 * rough.heights, (1e-6, 1e-6))
    plain = asperity.solve(metres, modulus=1e9, mean_pressure=1e7)
    for unit, heights in (("um", rough.heights), ("nm", 1e3 * rough.heights), (None, metres.heights)):
        side = {"um": 1.0, "nm": 1e3, None: 1e-6}[unit]
        known = asperity.Topography(heights, (side, side), unit)
        solution = asperity.solve(known, modulus="1GPa", mean_pressure="10MPa")
        assert np.allclose(solution.gap, plain.gap, rtol=1e-9, atol=1e-16)
        assert solution.report["length_unit"] == "m" and np.isclose(solution.lengths[0], 1e-6, rtol=1e-14)
    assert "1 µm x 1 µm" in repr(solution) and re.search(r"pressure +10 MPa", repr(solution))
    solution = asperity.solve(metres.heights, "1um", modulus="1GPa", spring=("1N/m", "2nm"))
    assert (solution.report["spring_stiffness"], solution.report["control_value"]) == (1.0, 2e-9)
    assert solution.report["given"]["spring_position"] == "2nm"
    swept = asperity.sweep(metres, modulus="1GPa", mean_pressures=["5MPa", "10MPa"])
    assert swept.columns["control_value"].tolist() == [5e6, 10e6]
    swept = asperity.sweep(metres, modulus="1GPa", mean_pressures=["5MPa", "10MPa"])
    assert [one.report["given"] for one in swept] == 2 * [{"modulus": "1GPa", "mean_pressures": "5MPa,10MPa"}]
    with pytest.raises(ValueError, match=r"is in px, .* give the unit of its lengths by asperity.prepare\(unit=...\)"):
        asperity.solve(asperity.Topography(rough.heights, (1.0, 1.0), "px"), modulus="1GPa", mean_gap="1nm")
    # a preparation keeps the unit of the map
    prepared = asperity.prepare(asperity.Topography(rough.heights, None, "um"), "20um", flip=True)
    assert (prepared.lengths, prepared.unit) == ((20.0, 20.0), "um") and "20 um x 20 um" in prepared.log[1]
    drawn = asperity.surface.self_affine(64, "2um", rms_height="5nm", k_s=16)
    assert (drawn.lengths, drawn.unit) == ((2e-6, 2e-6), "m") and np.isclose(drawn.heights.std(), 5e-9, rtol=1e-12)
    assert np.isclose(asperity.surface.statistics(known, "2um").rms_height, metres.heights.std(), rtol=1e-12)


def test_laws_and_walls_have_units_or_none(rough):
    law = asperity.Exponential("50mJ/m2", range="1nm")
    assert (law.work_of_adhesion, law.range) == (0.05, 1e-9) and law == asperity.Exponential(0.05, 1e-9)
    assert repr(law) == "Exponential(work_of_adhesion='50mJ/m2', range='1nm')"
    copied = pickle.loads(pickle.dumps(law))
    assert copied.given == law.given == ({"work_of_adhesion": "50mJ/m2", "range": "1nm"}, None)
    for message, wrong in [
        ("range is 1e-9, without a unit, but work_of_adhesion 50mJ/m2 has", lambda: asperity.Morse("50mJ/m2", 1e-9)),
        ("work_of_adhesion is 1nm: nm is a unit of something else", lambda: asperity.Morse("1nm", "1nm")),
        ("cut_off is 1e-8, without a unit", lambda: asperity.CutOff(law, 1e-8)),
    ]:
        with pytest.raises(ValueError, match=message):
            wrong()
    metres = asperity.Topography(1e-6 * rough.heights, (1e-6, 1e-6))
    options = {"modulus": "1GPa", "mean_gap": "10nm"}
    cut = asperity.CutOff(asperity.PowerLaw("1mJ/m2", "5nm", 3), "0.1um")
    solution = asperity.solve(metres, law=cut, wall=asperity.Penalty("1GPa/nm"), **options)
    bare = asperity.CutOff(asperity.PowerLaw(1e-3, 5e-9, 3), 1e-7)
    plain = asperity.solve(metres, modulus=1e9, mean_gap=1e-8, law=bare, wall=asperity.Penalty(1e18))
    assert solution.gap.tobytes() == plain.gap.tobytes() and plain.report["given"] is None
    texts = {"work_of_adhesion": "1mJ/m2", "range": "5nm", "cut_off": "0.1um", "wall_stiffness": "1GPa/nm"}
    assert solution.report["given"] == {**options, **texts}
    # a law of one's own and works at the nodes are in SI units
    varying = asperity.Varying(law, np.full(rough.shape, 1e-3))
    given = asperity.solve(metres, law=varying, **options).report["given"]
    assert given == {**options, "range": "1nm"}
    for wrong in ({"law": bare}, {"wall": asperity.Penalty(1e18)}, {"modulus": 1e9, "mean_gap": 1e-8, "law": cut}):
        with pytest.raises(ValueError, match="without a unit"):
            asperity.solve(metres, **{**options, **wrong})
