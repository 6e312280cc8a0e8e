"""A contact that is solved more than once, and the keys of the program as keywords."""

import copy
import json
import pickle
import subprocess
import types
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import asperity


def same(one, other):
    return all(np.array_equal(getattr(one, name), getattr(other, name)) for name in ("gap", "pressure", "contact_pressure"))


@pytest.mark.parametrize("precision", ["f64", "f32"])
def test_a_contact_solves_again_with_the_bits_of_the_functions(rough, law, precision):
    given = {"modulus": 1.0, "law": law, "precision": precision}
    contact = asperity.Contact(rough, **given)
    for load in ({"mean_pressure": 0.01}, {"mean_gap": 0.02}, {"mean_pressure": 0.01, "stability": True}):
        assert same(contact.solve(**load), asperity.solve(rough, **given, **load))
    swept = contact.sweep(mean_pressures=[0.005, 0.01])
    # a solve between the rows of a table is none of its rows
    contact.solve(mean_gap=0.02)
    assert same(list(swept)[1], list(asperity.sweep(rough, **given, mean_pressures=[0.005, 0.01]))[1])
    found = contact.pull_off(rtol=0.1)
    assert found.pressure == asperity.pull_off(rough, **given, rtol=0.1).pressure
    held = contact.solve(mean_gap=0.02)
    assert contact.stability(held).eigenvalue == pytest.approx(asperity.stability(held).eigenvalue, rel=1e-12)


@pytest.mark.parametrize(
    ("objects", "keys"),
    [
        (
            {"law": asperity.Exponential(1e-4, 4e-3), "mean_gap": 0.02},
            {"law": "exponential", "work_of_adhesion": 1e-4, "range": 4e-3, "mean_gap": 0.02},
        ),
        (
            {"body": asperity.Layer(0.1, 0.3), "mean_pressure": 0.01},
            {"layer": 0.1, "poisson": 0.3, "mean_pressure": 0.01},
        ),
        (
            {"wall": asperity.Penalty(500.0), "mean_pressure": 0.01},
            {"wall": "penalty", "wall_stiffness": 500.0, "mean_pressure": 0.01},
        ),
        ({"spring": (0.5, 0.02)}, {"spring_stiffness": 0.5, "spring_position": 0.02}),
    ],
)
def test_keys_are_those_of_objects(rough, objects, keys):
    one, other = (asperity.solve(rough, modulus=1.0, **given) for given in (objects, keys))
    assert same(one, other)
    numbers = {key: value for key, value in one.report.items() if key not in ("seconds", "law")}
    assert {key: other.report[key] for key in numbers} == numbers


def test_keys_beside_objects_that_have_them_are_refused(rough, law):
    for wrong, match in [
        ({"law": law, "range": 1.0}, "range is given with law"),
        ({"body": asperity.Layer(0.1, 0.3), "poisson": 0.3}, "poisson is given with body"),
        ({"wall": asperity.Penalty(1.0), "wall_stiffness": 2.0}, "wall_stiffness is given with wall"),
        ({"spring": (1.0, 1.0), "spring_position": 2.0}, "spring_position is given with spring"),
    ]:
        with pytest.raises(TypeError, match=match):
            asperity.solve(rough, modulus=1.0, **wrong)
    with pytest.raises(ValueError, match="law exponential lacks range"):
        asperity.solve(rough, modulus=1.0, mean_gap=0.01, law="exponential", work_of_adhesion=1e-4)


def test_units_are_those_of_the_contact_and_its_calls(rough):
    metres = asperity.Topography(1e-6 * rough.heights, (1e-6, 1e-6))
    keys = {"law": "exponential", "work_of_adhesion": "1mJ/m2", "range": "5nm"}
    contact = asperity.Contact(metres, modulus="1GPa", **keys)
    solution = contact.solve(mean_gap="10nm")
    assert solution.report["given"] == {"modulus": "1GPa", "work_of_adhesion": "1mJ/m2", "range": "5nm", "mean_gap": "10nm"}
    assert contact.solve(mean_pressure="1MPa").report["given"]["mean_pressure"] == "1MPa"
    with pytest.raises(ValueError, match="mean_gap is .*, without a unit, but modulus 1GPa has one"):
        contact.solve(mean_gap=1e-8)
    with pytest.raises(ValueError, match="without a unit"):
        asperity.Contact(metres, modulus=1e9).solve(mean_gap="10nm")


def test_a_solution_is_saved_as_by_the_program(rough, tmp_path, tool):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, hardness=1.0)
    solution.save(tmp_path / "out")
    for name in ("gap", "pressure", "contact_pressure", "plastic_depth"):
        assert np.array_equal(np.load(tmp_path / "out" / f"{name}.npy"), getattr(solution, name))
    assert json.loads((tmp_path / "out" / "report.json").read_text()) == solution.report
    command = [tool, "contact", str(tmp_path / "out"), "--json"]
    found = json.loads(subprocess.run(command, check=True, capture_output=True).stdout)
    assert found["clusters"] == len(asperity.contact.tables(solution).clusters)


def equal(first, second):
    """Whether two solutions are the same, but for numbers that are infinite."""
    fields = ("gap", "pressure", "contact_pressure", "plastic_depth", "mode")
    of = [(getattr(first, name), getattr(second, name)) for name in fields]
    for a, b in of:
        assert a is b is None or (a.dtype == b.dtype and np.array_equal(a, b, equal_nan=True))
    # mirror images are the same to the tolerance of the solve
    assert np.allclose(first.whole_gap, second.whole_gap, rtol=0, atol=1e-5 * np.nanmax(first.gap[first.gap < np.inf]))
    assert first.report == second.report
    counted = first.statistics._replace(cluster_sizes=None), second.statistics._replace(cluster_sizes=None)
    assert counted[0] == pytest.approx(counted[1], abs=1e-15, nan_ok=True)
    assert np.array_equal(first.statistics.cluster_sizes, second.statistics.cluster_sizes)


@pytest.mark.parametrize(
    "scene",
    [
        {"mean_pressure": 0.01, "hardness": 0.05},
        {"mean_pressure": 0.01, "precision": "f32", "stability": True, "law": asperity.Exponential(1e-5, 2e-3)},
        {"mean_pressure": 0.01, "body": asperity.Layer(0.1, 0.3, "sliding")},
        {"mean_pressure": 0.01, "body": asperity.Coating(0.1, 3.0, 0.3, 0.2)},
        {"approach": 1e-3, "boundary": "free"},
        {"mean_pressure": 0.01, "against_modulus": 3.0},
    ],
    ids=str,
)
def test_a_solution_is_loaded_as_it_was_saved(rough, tmp_path, scene):
    solution = asperity.solve(rough, modulus=1.0, **scene)
    solution.save(tmp_path)
    again = asperity.load(tmp_path)
    equal(solution, again)
    assert np.array_equal(again.heights, solution.heights) and again.lengths == solution.lengths
    assert np.array_equal(again.displacement, solution.displacement)
    assert repr(pickle.loads(pickle.dumps(again))) == repr(again)
    assert "contact fraction" in repr(again) and again.body == solution.body
    assert [one and one.gap for one in again.percolation()] == [one and one.gap for one in solution.percolation()]
    again.save(tmp_path / "again")
    equal(again, asperity.load(tmp_path / "again"))


def test_a_folder_of_an_earlier_version_lacks_a_number_or_says_which_one_it_needs(rough, tmp_path):
    asperity.solve(rough, modulus=1.0, mean_pressure=0.01).save(tmp_path)
    file = tmp_path / "report.json"
    whole = json.loads(file.read_text())

    def without(name):
        file.write_text(json.dumps({key: value for key, value in whole.items() if key != name}))
        return asperity.load(tmp_path)

    assert np.isnan(without("perimeter").statistics.perimeter) and without("perimeter").report["perimeter"] is None
    for name in whole:
        try:
            assert without(name).report[name] is None
        except ValueError as refused:
            assert str(refused) == f"{file} is no report of a solve, without {name}: name the folder of one, or solve anew"


def test_absent_nodes_lines_and_mirrored_maps_are_loaded(tmp_path):
    x = np.arange(32) / 32
    holed = 0.01 * np.cos(2 * np.pi * x)[:, None] * np.cos(2 * np.pi * x)
    holed[:4, :4] = np.nan
    absent = asperity.solve(holed, 1.0, modulus=1.0, mean_pressure=0.01, absent_missing=True)
    line = asperity.solve(0.01 * np.cos(2 * np.pi * x), 1.0, modulus=1.0, mean_pressure=0.01)
    mirrored = asperity.prepare(asperity.surface.self_affine(24, 1.0, rms_slope=0.1, k_s=6, seed=2), mirror=True)
    part = asperity.solve(mirrored, modulus=1.0, mean_pressure=0.01, resistivities=(1.0, 1.0), stiffness=True)
    assert part.report["part"] == "original" and np.isinf(absent.gap[:4, :4]).all()
    for name, solution in (("absent", absent), ("line", line), ("part", part)):
        solution.save(tmp_path / name)
        again = asperity.load(tmp_path / name)
        equal(solution, again)
        assert again.topography.shape == solution.topography.shape
        assert np.array_equal(again.topography.heights, solution.topography.heights, equal_nan=True)
    again = asperity.load(tmp_path / "part")
    assert again.conductance((1.0, 1.0)).per_area == pytest.approx(part.conductance((1.0, 1.0)).per_area, rel=1e-12)


@pytest.mark.parametrize("files", ["npy", "npz"])
def test_a_folder_of_the_program_is_loaded(rough, tmp_path, tool, files):
    np.save(tmp_path / "heights.npy", rough.heights)
    given = ["--heights", str(tmp_path / "heights.npy"), "--modulus", "1", "--mean-pressure", "0.01"]
    folder = tmp_path / "out"
    subprocess.run([tool, "solve", *given, "--format", files, "--out", str(folder), "--quiet"], check=True)
    found, known = asperity.load(folder), asperity.load(folder, heights=rough)
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    assert np.array_equal(found.gap, solution.gap) and found.contact_fraction == solution.contact_fraction
    assert np.array_equal(known.displacement, solution.displacement)
    with pytest.raises(ValueError, match="has no heights: give asperity.load heights="):
        found.displacement  # noqa: B018
    with pytest.raises(ValueError, match=r"heights have shape \(3, 3\)"):
        asperity.load(folder, heights=np.zeros((3, 3)))


@pytest.mark.parametrize(
    "scene",
    [
        {"mean_pressure": "10MPa"},
        {"mean_pressure": "10MPa", "hardness": "40MPa", "precision": "f32"},
        {"normal_force": "1uN", "boundary": "free"},
    ],
    ids=str,
)
@pytest.mark.filterwarnings("ignore:window-edge")
def test_heights_that_were_not_solved_are_refused(rough, tmp_path, scene):
    microns = asperity.Topography(rough.heights, rough.lengths, "um")
    solution = asperity.solve(microns, modulus="1GPa", **scene)
    solution.save(tmp_path)
    for heights in (microns, solution.heights, solution.heights.astype("f4")):
        assert np.allclose(asperity.load(tmp_path, heights=heights).heights, solution.heights, rtol=1e-6, atol=0)
    for wrong in (rough.heights, solution.heights[::-1], solution.heights.T, 0.9 * solution.heights):
        with pytest.raises(ValueError, match=r"elastic energy of .* report says .*: give the map that was solved, .*, in m$"):
            asperity.load(tmp_path, heights=wrong)


def test_a_law_that_no_folder_keeps_is_given_anew(rough, tmp_path):
    gaps, own = np.linspace(0.0, 0.05, 60), asperity.Exponential(1e-5, 8e-3)
    own = types.SimpleNamespace(energy=own.energy, traction=own.traction, slope=own.slope, work_of_adhesion=1e-5, range=8e-3)
    works = np.linspace(1e-5, 2e-5, rough.heights.size).reshape(rough.heights.shape)
    for law, told in (
        (asperity.Varying(asperity.Exponential(1.0, 8e-3), works), r"keep works of adhesion that vary: .*load\(folder, law="),
        (asperity.Tabulated(gaps, 1e-3 * (1 - gaps / 0.05)), "keeps no values of the law table: give it anew"),
        (own, "keeps no values of the law SimpleNamespace: give it anew"),
    ):
        solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
        solution.save(tmp_path)
        with pytest.raises(ValueError, match=told):
            asperity.stability(asperity.load(tmp_path))
        again = asperity.load(tmp_path, law=law)
        assert asperity.stability(again).eigenvalue == asperity.stability(solution).eigenvalue


def test_what_is_no_folder_of_a_solve_is_refused(rough, tmp_path):
    with pytest.raises(FileNotFoundError, match="has no report.json: name the folder of a solve"):
        asperity.load(tmp_path)
    (tmp_path / "report.json").write_text("{}")
    with pytest.raises(ValueError, match="is no report of a solve"):
        asperity.load(tmp_path)
    asperity.solve(rough, modulus=1.0, mean_pressure=0.01).save(tmp_path)
    np.save(tmp_path / "pressure.npy", np.zeros((3, 3)))
    with pytest.raises(ValueError, match=r"pressure in .* has shape \(3, 3\), the report says"):
        asperity.load(tmp_path)
    (tmp_path / "pressure.npy").unlink()
    with pytest.raises(ValueError, match="has no pressure.npy: solve with --format npy or npz"):
        asperity.load(tmp_path)


def test_a_page_is_that_of_the_program(rough, tmp_path, tool):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    solution.save(tmp_path / "page")
    subprocess.run([tool, "report", str(tmp_path / "page"), "--out", str(tmp_path / "of.html")], check=True)
    asperity.report(solution, tmp_path / "page.html")
    assert (tmp_path / "page.html").read_text() == (tmp_path / "of.html").read_text()
    asperity.report(tmp_path / "page", tmp_path / "of.html", force=True)
    with pytest.raises(ValueError, match="of.html.*force=True"):
        asperity.report(tmp_path / "page", tmp_path / "of.html")
    asperity.sweep(rough, modulus=1.0, mean_pressures=[0.005, 0.01], out=tmp_path / "sweep.csv").run()
    asperity.report(tmp_path / "sweep.csv", tmp_path / "sweep.html")
    assert "contact fraction" in (tmp_path / "sweep.html").read_text()
    with pytest.raises(ValueError, match="name a folder of results"):
        asperity.report(tmp_path, tmp_path / "none.html")


def test_results_go_on_in_pandas_and_xarray(rough):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    contact = asperity.Contact(rough, modulus=1.0)
    table = contact.sweep(mean_pressures=[0.005, 0.01]).to_dataframe()
    assert table["mean_pressure"].tolist() == pytest.approx([0.005, 0.01])
    fields = contact.solve(mean_pressure=0.01).to_xarray()
    assert fields["gap"].dims == ("x", "y") and fields.attrs["status"] == "converged"


@pytest.mark.filterwarnings("ignore:range")
def test_a_cycle_smooths_jumps_unless_it_is_told_not_to():
    x = np.arange(32) / 32 - 0.5
    law = asperity.MaugisDugdale(work_of_adhesion=1e-4, range=4e-3)
    tip = asperity.Contact(-(x[:, None] ** 2 + x**2) / 4, 1.0, modulus=1.0, boundary="free", law=law)
    forces = [
        list(tip.cycle(approaches=[-0.01, 0.005, -0.01], **key).columns["normal_force"])
        for key in ({}, {"smooth": True}, {"smooth": None}, {"smooth": False})
    ]
    assert forces[0] == forces[1] == forces[2] != forces[3]


def test_a_law_of_a_table_is_an_object(rough):
    with pytest.raises(ValueError, match=r"law is table: give its values, as law=asperity.Tabulated\(gaps, tractions\)"):
        asperity.Contact(rough, modulus=1.0, law="table")


def test_springs_have_their_positions_and_no_others(rough):
    contact = asperity.Contact(rough, modulus=1.0)
    with pytest.raises(TypeError, match="spring_positions is given with springs"):
        contact.sweep(springs=[(1.0, 0.1)], spring_positions=[0.05])
    with pytest.raises(ValueError, match="springs is empty"):
        contact.sweep(springs=[])


@pytest.mark.parametrize(
    "law",
    [{"law": asperity.Exponential("50mJ/m2", "5nm")}, {"law": "jkr", "work_of_adhesion": "50mJ/m2"}],
    ids=["an object", "a name without a range"],
)
def test_the_stability_of_a_solution_with_units_takes_numbers_in_the_si(law):
    rough = asperity.surface.self_affine(32, "1um", rms_slope=0.1, k_s=8, seed=1)
    layer = asperity.Layer("200nm", 0.3)
    for body in (None, layer):
        held = asperity.solve(rough, modulus="1GPa", mean_pressure="10MPa", body=body, **law)
        found = asperity.stability(held)
        asked = asperity.solve(rough, modulus="1GPa", mean_pressure="10MPa", body=body, stability=True, **law)
        assert found.eigenvalue == asked.report["stability"]["eigenvalue"]
        other = asperity.stability(held, mean_pressure="5MPa"), asperity.stability(held, mean_pressure=5e6)
        assert other[0].eigenvalue == other[1].eigenvalue


def test_a_contact_travels_between_processes(rough):
    layer = asperity.Layer(0.2, 0.3, "bonded")
    works = asperity.Varying(asperity.Exponential(1e-5, 4e-3), np.full((64, 64), 1e-5))
    for keys in ({"body": layer}, {"law": works}, {"hardness": np.full((64, 64), 0.5)}, {"against": rough, "shift": (0.1, 0)}):
        contact = asperity.Contact(rough, modulus=1.0, **keys)
        expected = contact.solve(mean_pressure=0.01)
        for other in (copy.deepcopy(contact), pickle.loads(pickle.dumps(contact))):
            assert same(other.solve(mean_pressure=0.01), expected)
        assert other.sweep(mean_pressures=[0.01]).columns["mean_gap"] == expected.mean_gap
    with ProcessPoolExecutor(2, get_context("spawn")) as pool:
        assert same(pool.submit(contact.solve, mean_pressure=0.01).result(), expected)


def test_what_is_shown_of_contacts_tables_and_maps_has_units(tmp_path):
    rough = asperity.surface.self_affine(64, 1e-6, rms_slope=0.1, k_s=8, seed=1)
    law = asperity.Exponential("50mJ/m2", "3nm")
    contact = asperity.Contact(rough, modulus="1GPa", law=law)
    assert repr(contact) == (
        "Contact(Topography(64 x 64 heights, 1 µm x 1 µm), modulus='1GPa', law=Exponential(work_of_adhesion='50mJ/m2', "
        "range='3nm'))"
    )
    sweep = contact.sweep(mean_pressures=["1MPa", "2MPa"]).run()
    head, names, first, _ = repr(sweep).splitlines()
    assert head == "Sweep(2 of 2 loads solved)" and names.split() == ["mean", "pressure", "mean", "gap", "contact", "status"]
    assert first.split()[:2] == ["1", "MPa"] and first.endswith(" %      converged")
    pulled = repr(contact.pull_off(rtol=0.1)).splitlines()
    assert pulled[0].endswith("Pa") and pulled[1].endswith("N") and "None" in pulled[2]
    leak = repr(asperity.leakage(contact.solve(mean_pressure="-0.1MPa")))
    assert leak.startswith("along x  transmissivity ") and "nm³" in leak
    both = rough + rough
    assert np.array_equal(both.heights, 2 * rough.heights) and both.lengths == rough.lengths
    assert np.array_equal((rough + 1.0).heights, rough.heights + 1.0) and rough.seed is not None and both.seed is None
    for other in (np.ones(3), asperity.surface.self_affine(64, 2e-6, rms_slope=0.1, k_s=8)):
        with pytest.raises(ValueError, match="equal shapes|differ in their sides"):
            rough + other
    both.save(tmp_path / "both.npz")
    assert asperity.read(tmp_path / "both.npz").heights.tobytes() == both.heights.tobytes()
    with pytest.raises(ValueError, match="force"):
        both.save(tmp_path / "both.npz")


def test_fields_of_another_solve_are_refused(rough, tmp_path):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    other = asperity.solve(rough, modulus=1.0, mean_pressure=0.0101)
    missing = solution.gap.copy()
    missing[3, 4] = np.nan
    for name, field, expected in (
        ("gap", other.gap, "gap in .* has the mean .* of another solve"),
        ("gap", -solution.gap, "of another solve"),
        ("gap", missing, "1 missing values, the report says 0"),
        ("pressure", other.pressure, "pressure in .* of another solve"),
        ("heights", rough.heights[::-1], "heights give an elastic energy"),
    ):
        solution.save(tmp_path)
        np.save(tmp_path / f"{name}.npy", field)
        with pytest.raises(ValueError, match=expected):
            asperity.load(tmp_path)
