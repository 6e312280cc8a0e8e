"""The recipes run as they stand, print what their page shows, and what it says of each holds.

    UPDATE=1 python -m pytest python/tests/test_recipes.py

writes what they print into the page.
"""

import os
import pathlib
import re
import runpy
import shutil
import warnings

import numpy as np
import pytest

import asperity

PAGE = pathlib.Path(__file__).resolve().parents[2] / "docs" / "python" / "recipes.md"
for package in ("matplotlib", "scipy", "afmformats"):
    pytest.importorskip(package)
FILES = runpy.run_path(str(PAGE.parents[1] / "recipe_files.py"))
#: A recipe, and below it what it prints.
RECIPE = re.compile(r"^### (.*?)\n.*?^```python\n(.*?)^```\n(?:\n```text\n(.*?)^```\n)?", re.MULTILINE | re.DOTALL)
RECIPES = {title: code for title, code, _ in RECIPE.findall(PAGE.read_text())}


def two_elastic_rough_bodies(found):
    both, steel, brass = found["both"], found["steel"], found["brass"]
    assert f"{found['slope']:.2f}" == "0.14" and f"{found['share']:.2f}" == "0.67"
    assert found["share"] == pytest.approx(steel / (steel + brass), rel=1e-9)
    # as one body has it
    heights = np.asarray(found["one"]) + np.asarray(found["other"])[::-1]
    one = asperity.solve(heights, 20e-6, modulus=found["modulus"], mean_pressure=500e6)
    assert one.contact_fraction == both.contact_fraction


def a_coated_tip(found):
    moduli = found["read_off"]
    assert [f"{modulus / 1e9:.2f}" for modulus in moduli] == ["1.05", "1.17", "1.43"]
    area, side = found["area"], found["side"]
    assert side > 7 * 2 * np.sqrt(area / np.pi)
    # a cell of twice the width, a steep one, has the same contact but for the images
    warnings.filterwarnings("ignore", "steep", asperity.InputWarning)
    tip = asperity.surface.paraboloid(512, 2 * side, radius=found["radius"])
    assert found["pressed"].report["warnings"][0]["code"] == "ends"
    wide = asperity.solve(tip, modulus=10e9, normal_force=found["force"], body=found["coating"])
    assert wide.statistics.corrected_contact_fraction * (2 * side) ** 2 == pytest.approx(area, rel=0.02)
    with pytest.raises(ValueError, match="coating has no free boundary"):
        asperity.solve(tip, modulus=10e9, normal_force=1e-9, body=found["coating"], boundary="free")


def a_soft_coating_under_an_afm(found):
    row = r"^\| E₁/E₂ = (0\.\d+), ν = (0\.\d) \| ([\d.]+) \| ([\d.]+) \| ([\d.]+) \|$"
    page = re.findall(row, PAGE.read_text(), re.MULTILINE)
    table, widths, formula = found["table"], found["widths"], np.array(list(found["table"].values()))
    for ratio, poisson, *written in page:
        row = np.array(table[float(ratio), float(poisson)])[[0, 2, 4]]
        assert row == pytest.approx([float(value) for value in written], abs=6e-3)
    # the force is that of the integral equation
    on_coating = runpy.run_path(str(PAGE.parents[2] / "python" / "benches" / "shapes.py"))["on_coating"]
    for (ratio, poisson), row in table.items():
        scaled = widths * ratio ** (2 / 3) * (1 - 0.22 * poisson**2) / (1 - 1.92 * poisson**2)
        share = 2.25 * scaled**1.5 / (1 + 2.25 * scaled**1.5)
        exact = (1 - poisson**2) * (1 + (1 / ratio - 1) * share) / np.array(row)
        for width, force in zip(widths, exact):
            radii = np.linspace(0.3 * width, 1.6 * width, 8)
            roots, forces = np.transpose([on_coating(radius, ratio, poisson) for radius in radii])
            assert np.polyval(np.polyfit(roots, forces, 5), width) == pytest.approx(force, rel=3e-3)
    assert len(page) == 4 and formula.min() < 0.6


def a_tip_on_a_thin_layer(found):
    page = re.findall(r"^\| ν = 0\.\d.*?\|((?: [\d.]+ \|)+)$", PAGE.read_text(), re.MULTILINE)
    written = [[float(value) for value in row.strip(" |").split("|")] for row in page]
    table, chi = found["table"], found["wanted"]
    assert np.array([*table.values(), found["series"]]) == pytest.approx(np.array(written), abs=6e-3)
    assert (found["series"] / table[0.5] - 1)[[0, -1]] == pytest.approx([-0.01, -0.16], abs=6e-3)
    # the integral equation of an elastic layer
    exact = runpy.run_path(str(PAGE.parents[2] / "python" / "benches" / "shapes.py"))["on_layer"]
    for poisson, row in table.items():
        roots, ratios = np.transpose([exact(radius, poisson)[1:] for radius in (0.25, 0.7, 1.2)])
        assert np.polyval(np.polyfit(chi, row, 4), roots) == pytest.approx(ratios, rel=3e-3)
    assert pathlib.Path("layer.png").stat().st_size > 1000


def a_pyramid(found):
    coefficient, (three, four) = found["coefficient"], found["found"].values()
    assert [f"{value:.3f}" for value in (three, four, four * np.pi / 2)] == ["0.882", "0.738", "1.159"]
    # many faces are a cone
    assert 2 * coefficient(64, 256) - coefficient(64, 128) == pytest.approx(2 / np.pi, rel=1e-3)


def a_rough_sphere(found):
    share = found["share"]
    assert [f"{found:.2f}" for found in share] == ["0.21", "0.68", "0.93"]


def rubber_that_creeps(found):
    area, creep = found["area"], found["creep"]
    assert [f"{100 * share:.1f}" for share in (*area, found["relaxed"])] == ["22.9", "41.1", "75.4", "76.0"]
    assert (creep["status"] == "converged").all() and (np.diff(creep["contact_fraction"]) >= 0).all()
    # steps that are half as long change the area by less than is given
    times = np.sort(np.append(creep["time"], (creep["time"][1:] + creep["time"][:-1]) / 2))
    pressures = np.full(times.size, 50e3)
    fine = asperity.viscoelastic(found["rough"], **found["rubber"], times=times, mean_pressures=pressures).columns
    assert np.interp([0.0, 1.0, 100.0], times, fine["contact_fraction"]) == pytest.approx(area, abs=2e-3)


def a_soft_tip_that_is_drawn_off(found):
    force, exact = found["force"], 1.5 * np.pi * found["work"] * found["radius"]
    assert [f"{1e6 * one:.1f}" for one in (*force, exact)] == ["5.2", "9.0", "10.5", "4.7"]
    assert (found["drawn"]["status"] == "converged").all() and found["drawn"]["contact_fraction"][-1] == 0


def a_force_curve(found):
    fit = found["fit"]
    assert [f"{end / 1e9:.2f}" for end in fit.modulus] == ["2.00", "1.98", "2.03"]
    assert f"{1e3 * fit.work_of_adhesion.value:.0f}" == "50" and fit.verdict.startswith("Maugis")
    assert f"{fit.tabor_parameter.value:.1f}" == "1.0"
    assert pathlib.Path("curve.png").stat().st_size > 1000


def a_map_of_force_curves(found):
    map, table = found["found"], found["table"]
    assert map.shape == (3, 3) and (map.reason == "").all() and len(table) == 9
    assert map.young.value == pytest.approx(0.75 * FILES["MAP"]["made"](3, 200, 2e-5)[1], rel=0.01)
    assert pathlib.Path("map.png").stat().st_size > 1000


def electroadhesion(found):
    rows = [found["found"][voltage] for voltage in (0, 100, 200)]
    assert [f"{100 * one.contact_fraction:.1f}" for one in rows] == ["7.6", "24.0", "68.8"]
    # Maxwell's stress at the gaps, and between flat surfaces
    film, flat = found["film"], 8.854e-12 * np.array([100, 200]) ** 2 / 2 / found["film"] ** 2
    mean = [np.mean(stress / (1 + one.gap / film) ** 2) for stress, one in zip(flat, rows[1:])]
    assert [f"{stress / 1e3:.1f}" for stress in (*mean, *flat)] == ["12.5", "61.2", "15.9", "63.7"]
    assert [one.contact_pressure.mean() - 5e3 for one in rows[1:]] == pytest.approx(mean, rel=1e-4)
    # behind a film that is thick compared with the roughness the attraction adds to the pressure
    law = asperity.PowerLaw(work_of_adhesion=flat[0] * 1e-3, range=1e-3, exponent=1)
    with pytest.warns(asperity.InputWarning, match="range"):
        far = asperity.solve(found["pad"], modulus=2e6, mean_pressure=5e3, law=law)
    near = asperity.solve(found["pad"], modulus=2e6, mean_pressure=5e3 + flat[0])
    assert far.contact_fraction == pytest.approx(near.contact_fraction, abs=2e-3)


def capillaries(found):
    pulled, radius, tension = found["pulled"], found["radius"], found["tension"]
    wet = 4 * np.pi * tension * radius
    assert [f"{1e9 * force:.0f}" for force in (wet, *(pulled["rough", humidity] for humidity in (0.1, 0.5, 0.9)))] == [
        *("90", "14", "43", "77")
    ]
    for humidity in (0.1, 0.5, 0.9):
        width = 1.05e-9 / -np.log(humidity)
        exact = -asperity.exact.MaugisDugdale(radius, 70e9, 2 * tension, width).pull_off().load
        assert pulled["smooth", humidity] == pytest.approx(exact, rel=0.03) and 0.93 * wet < exact < wet


def a_rough_particle_for_particle_codes(found):
    columns, loss = found["columns"], found["loss"]
    assert [f"{1e15 * loss:.2f}", f"{found['stuck']:.2f}", f"{found['weakest']:.2f}"] == ["0.56", "0.47", "0.90"]
    assert (columns["status"] == "converged").all()
    # what is lost is the area between the branches, by the trapezoidal rule, and by the balance of energies
    (there, up), (back, down) = (np.loadtxt(f"{branch}.txt").T for branch in ("approach", "withdrawal"))
    x, y = np.append(there, back), np.append(up, down)
    assert np.sum((y[1:] + y[:-1]) / 2 * np.diff(x)) == pytest.approx(loss, rel=0.02)
    assert abs(columns["imbalance"][-1]) < 0.02 * columns["dissipated"][-1]
    assert pathlib.Path("particle.png").stat().st_size > 1000


def bonding_of_a_wafer(found):
    assert [f"{100 * share:.0f}" for share in found["bonded"]] == ["100", "60", "5"]
    assert [f"{energy:.2g}" for energy in found["flat"]] == ["0.035", "0.15", "0.38"]
    plate, thickness = found["wafer"](1e-3).function, 1e-3
    # a thin plate, and a half-space
    assert plate(np.array([20.0])) == pytest.approx(140e9 * thickness**3 / 12 * 20.0**4, rel=1e-3)
    assert plate(np.array([2e4])) == pytest.approx(140e9 * 2e4 / 2, rel=1e-9)
    # a wave closes under its amplitude times its stiffness
    q, wave = 2 * np.pi / 0.01, asperity.surface.wave(64, 0.01, amplitude=1e-6)
    for share, area in ((1.001, 1.0), (0.9, 0.9)):
        load = share * 1e-6 * plate(np.array([q]))[0]
        closed = asperity.solve(wave, modulus=140e9, mean_pressure=load, body=found["wafer"](1e-3))
        assert closed.contact_fraction == 1.0 if share > 1 else closed.contact_fraction < area


def two_hundred_surfaces(found):
    area = found["area"]
    assert len(set(area)) > 100 and f"{area.mean():.3f} {area.std():.3f}" == "0.224 0.007"
    assert area[7] == found["pressed"](7)


def which_rms_slope_a_paper_means(found):
    slope, along_x = found["found"].rms_slope, found["along_x"]
    # an isotropic map, but for what one map has of it
    assert np.sqrt(2) * along_x == pytest.approx(slope, rel=0.15)
    assert found["found"].rms_slope_differences < slope
    ratio = found["area"] / found["persson"]
    assert ratio.max() == pytest.approx(1.5, abs=0.01) and ratio[-1] == pytest.approx(1.0, abs=0.05)
    assert pathlib.Path("persson.pdf").stat().st_size > 1000


def how_much_of_the_area_is_noise(found):
    area = dict(zip(found["cut_offs"], found["area"]))
    true = asperity.solve(found["rough"], modulus=70e9, mean_pressure=700e6).statistics.corrected_contact_fraction
    assert area[8] > area[16] > area[32] == pytest.approx(true, rel=0.01)
    assert area[64] == pytest.approx(area[32], rel=0.03) and area[128] < 0.9 * true


def penalty_uzawa_and_the_default(found):
    hard, soft, stiff, uzawa = found["found"]
    assert [f"{100 * one.contact_fraction:.1f}" for one in (soft, stiff, hard)] == ["14.5", "12.4", "12.0"]
    assert hard.report["min_gap"] == 0.0 and soft.report["min_gap"] < stiff.report["min_gap"] < 0.0
    assert uzawa.contact_fraction == pytest.approx(hard.contact_fraction, abs=2 / 128**2)
    assert hard.operator_applications < uzawa.operator_applications
    assert all(pressed.converged for pressed in found["found"])


def a_seal(found):
    lower, upper, seal = found["lower"], found["upper"], found["seal"]
    assert [f"{1e12 * flow:.2g}" for flow in upper] == ["40", "2.7", "0.0052", "0"]
    assert (lower <= upper).all() and (upper - lower <= 1e-3 * upper).all()
    assert [f"{share:.2f}" for share in seal["contact_fraction"][2:]] == ["0.33", "0.58"]


def a_rock_joint(found):
    law, aperture, pressures = found["law"], found["aperture"], found["pressures"]
    assert [f"{1e6 * value:.0f}" for value in (*law["closure"][[0, -1]], *aperture[[0, -1]])] == ["43", "128", "127", "38"]
    assert [f"{value / 1e9:.3g}" for value in law["contact_stiffness"][[0, -1]]] == ["18.9", "1.33e+03"]
    assert [f"{value:.1e}" for value in found["permeability"][[0, -1]]] == ["1.4e-09", "1.2e-10"]
    # theory has a stiffness in proportion to the load, and a little less under light loads on one map
    assert 0.85 < np.polyfit(np.log(pressures), np.log(law["contact_stiffness"]), 1)[0] < 1
    # the flow is at most that of parallel channels, and the mean gap is more than the hydraulic aperture
    pressed = asperity.solve(found["joint"], modulus=found["granite"], mean_pressure=pressures[-1])
    assert aperture[-1] < np.cbrt(np.mean(pressed.gap**3))
    assert aperture[-1] == pytest.approx(0.7 * law["mean_gap"][-1], rel=0.01) and (aperture < law["mean_gap"]).all()


def a_joint_for_finite_elements(found):
    law, current, pressures = found["law"], found["current"].columns, found["pressures"]
    assert [f"{value / 1e3:.1f}" for value in law["thermal_conductance"][[0, -1]]] == ["4.8", "205.6"]
    assert f"{found['power']:.2f}" == "0.82"
    errors = np.abs(law["thermal_conductance"] / found["finer"] - 1).max(), law["conductance_error"].max()
    assert [f"{100 * error:.0f}" for error in errors] == ["3", "5"]
    factor = (1 / 237 + 1 / 15) / (27e-9 + 720e-9)
    assert current["electrical_conductance"] == pytest.approx(factor * law["thermal_conductance"], rel=1e-9)
    # what MOOSE reads begins at no load, and has these values
    moose = {file.name: file.read_text() for file in found["files"]}
    assert sorted(moose) == ["current.conductance.csv", "current.inp", "current.pressure.csv"] + [
        *("heat.conductance.csv", "heat.inp", "heat.pressure.csv")
    ]
    assert "*GAP CONDUCTANCE, PRESSURE" in moose["heat.inp"] and "*GAP ELECTRICAL" in moose["current.inp"]
    x, y = np.genfromtxt("heat.conductance.csv", delimiter=",", skip_header=1).T
    assert (x[0], y[0]) == (0, 0) and np.allclose(x[1:], pressures) and np.allclose(y[1:], law["thermal_conductance"])


def a_battery_electrode(found):
    resistance, columns = found["resistance"], found["columns"]
    assert [f"{value:.2g}" for value in resistance[[0, -1]]] == ["1.5", "0.062"]
    assert f"{100 * columns['conductance_error'].max():.0f}" == "5"
    # Barber's identity, and heights and load that are twice as large
    stiffness = columns["contact_stiffness"]
    assert resistance == pytest.approx(1e4 * 1e9 * (0.05 + 27e-9) / (2 * stiffness), rel=1e-9)
    twice = asperity.Topography(2 * found["electrode"].heights, found["electrode"].lengths)
    columns = asperity.sweep(twice, mean_pressures=2 * found["pressures"], **found["stack"]).columns
    assert columns["electrical_conductance"] == pytest.approx(1e4 / resistance, rel=1e-3)


def an_electrical_contact_with_adhesion(found):
    conductance, stiffness = found["gain"]
    assert [f"{100 * (gain - 1):.0f}" for gain in (*conductance, *stiffness)] == ["34", "11", "9", "4"]


def written(title, printed):
    """The page with what a recipe prints."""

    def block(found):
        whole, (start, end) = found[0], (found.start(), found.end(2) + len("```\n"))
        shown = f"\n```text\n{printed}```\n" if printed else ""
        return whole[: end - start] + shown if found[1] == title else whole

    return RECIPE.sub(block, PAGE.read_text())


def words_and_numbers(text):
    """The words of a text, and its numbers, of which machines may round the last digits in other ways."""
    number = r"[-+]?\d+(?:\.\d+)?(?:e[-+]\d+)?"
    return re.split(number, text), [float(found) for found in re.findall(number, text)]


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The folder of the files that recipes read."""
    folder = tmp_path_factory.mktemp("files")
    FILES["write_all"](folder)
    return folder


@pytest.mark.parametrize("title", RECIPES)
def test_the_recipe_runs(title, files, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for file in files.iterdir():
        shutil.copy(file, tmp_path)
    found = {}
    exec(RECIPES[title], found)
    page = written(title, capsys.readouterr().out)
    if os.environ.get("UPDATE"):
        PAGE.write_text(page)
    (words, numbers), (shown, known) = map(words_and_numbers, (page, PAGE.read_text()))
    same = words == shown and np.allclose(numbers, known, rtol=0.01, atol=1e-14)
    assert same, "it prints something else than its page shows: UPDATE=1 writes it there"
    globals()[re.sub(r"\W+", "_", title).lower()](found)
