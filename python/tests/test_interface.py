"""The law of an interface, and the contact in tables, as the tool writes them."""

import pathlib
import pickle
import subprocess

import numpy as np
import pytest

import asperity

PRESSED = {"modulus": 1.0, "mean_pressures": [0.005, 0.01, 0.02]}


@pytest.fixture(scope="module")
def rough():
    return asperity.surface.self_affine(64, 2.0, rms_slope=0.1, k_s=8, seed=1)


def asked(tool, folder, *words):
    subprocess.run([tool, *map(str, words)], cwd=folder, check=True, capture_output=True)


def test_the_table_and_its_files_are_those_of_the_tool(tmp_path, tool, rough):
    np.save(tmp_path / "heights.npy", rough.heights)
    # fmt: off
    asked(tool, tmp_path, "interface", "--heights", "heights.npy", "--lengths", 2, "--mean-pressures",
          "0.005,0.01,0.02", "--conductivities", 1, 2, "--leakage", "--for", "abaqus,comsol,moose", "--out", "law.csv")
    # fmt: on
    law = asperity.interface(rough.heights, 2.0, conductivities=(1.0, 2.0), leakage=1e-3, **PRESSED)
    assert (len(law), law.columns["status"].tolist()) == (3, ["converged"] * 3)
    theirs = np.genfromtxt(tmp_path / "law.csv", delimiter=",", names=True)
    for name in ("closure", "contact_stiffness", "stiffness_error", "thermal_conductance", "transmissivity_y_upper"):
        assert np.array_equal(law.columns[name], theirs[name]), name
    for code in ("abaqus", "comsol", "moose"):
        (tmp_path / "own").mkdir(exist_ok=True)
        for file in law.write(tmp_path / "own" / "law", code):
            assert file.read_text() == (tmp_path / file.name).read_text()
    with pytest.raises(ValueError, match="code is ansys: it must be 'abaqus', 'comsol' or 'moose'"):
        law.write(tmp_path / "law", "ansys")


def test_an_interface_travels_between_processes(tmp_path, rough):
    law = asperity.interface(rough, leakage=1e-3, **PRESSED)
    other = pickle.loads(pickle.dumps(law))
    assert other.rows == law.rows and len(other) == 3 and not list(other)
    assert [file.read_text() for file in other.write(tmp_path / "other", "moose")] == [
        file.read_text() for file in law.write(tmp_path / "law", "moose")
    ]


def test_units_are_told(tmp_path):
    rough = asperity.surface.self_affine(64, 20e-6, rms_slope=0.1, k_s=8, seed=1)
    rough = asperity.Topography(rough.heights, rough.lengths, "m")
    law = asperity.interface(
        rough, modulus="1GPa", mean_pressures=["2MPa", "4MPa"], resistivities=("17nOhm·m", "2.4uOhm*cm")
    )
    (file,) = law.write(tmp_path / "joint", "abaqus")
    text = file.read_text()
    assert "*GAP ELECTRICAL CONDUCTANCE, PRESSURE\n** electrical_conductance [S/m2], mean_pressure [Pa]\n" in text
    stiffness, conductance = law.columns["contact_stiffness"], law.columns["electrical_conductance"]
    assert np.allclose(conductance, 2 * stiffness / (1e9 * 41e-9), rtol=1e-12)


def test_an_interface_has_rows_that_converged_and_no_pressure_with_adhesion(rough, tmp_path):
    law = asperity.Exponential(1e-5, 2e-2)
    sticky = asperity.interface(rough, law=law, **PRESSED)
    with pytest.raises(ValueError, match="no row says where: add 0 to mean_pressures"):
        sticky.write(tmp_path / "law", "moose")
    assert set(sticky.columns["branch"]) == {"loading"}
    few = asperity.interface(rough, max_iterations=3, **PRESSED)
    with pytest.warns(asperity.ConvergenceWarning), pytest.raises(ValueError, match="row 1 has not converged"):
        few.write(tmp_path / "law", "moose")
    assert not list(pathlib.Path(tmp_path).iterdir())


def test_the_contact_in_tables_is_that_of_the_tool(tmp_path, tool, rough):
    np.save(tmp_path / "heights.npy", rough.heights)
    # fmt: off
    asked(tool, tmp_path, "solve", "--heights", "heights.npy", "--lengths", 2, "--mean-pressure", 0.02, "--no-pictures",
          "--out", "pressed")
    # fmt: on
    asked(tool, tmp_path, "contact", "pressed", "--out", "contact")
    solution = asperity.solve(rough.heights, 2.0, modulus=1.0, mean_pressure=0.02)
    found = asperity.contact.tables(solution)
    theirs = {name: np.loadtxt(tmp_path / "contact" / f"{name}.csv", delimiter=",", skiprows=1)
              for name in ("gap", "pressure", "autocorrelation", "clusters")}
    assert np.array_equal(found.clusters, theirs["clusters"])
    assert np.array_equal(found.autocorrelation, theirs["autocorrelation"])
    for name in ("gap", "pressure"):
        density = getattr(found, name)
        assert np.array_equal(density.density, theirs[name][:, 2])
        assert np.array_equal(density.edges[1:], theirs[name][:, 1])
    assert found.clusters[:, 0].astype(int).tolist() == solution.statistics.cluster_sizes.tolist()
    assert found.figures["clusters"] == len(found.clusters)
