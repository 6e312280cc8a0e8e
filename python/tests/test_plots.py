"""Figures can be drawn and saved; how they look is for people."""

import numpy as np
import pytest

import asperity

plt = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


@pytest.mark.parametrize("form", ["svg", "pdf", "png"])
def test_a_solution_is_drawn(tmp_path, rough, law, form):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
    figure = solution.plot(length_unit="m", pressure_unit="Pa")
    figure.savefig(tmp_path / f"solution.{form}")
    assert (tmp_path / f"solution.{form}").stat().st_size > 1000
    labels = [axes.get_ylabel() for axes in figure.axes]
    # adhesion is on a scale of its own
    assert "compression (mPa)" in labels and any(label.startswith("tension (") for label in labels)
    # zero looks the same on both
    images = figure.axes[1].images
    assert len(images) == 2 and all(image.cmap(0.0) == (1.0, 1.0, 1.0, 1.0) for image in images)


def test_without_adhesion_there_is_no_scale_of_tension(rough):
    figure = asperity.solve(rough, modulus=1.0, mean_pressure=0.01).plot()
    assert [axes.get_ylabel() for axes in figure.axes] == ["y", "", "pressure"]


def test_a_line_a_sweep_a_cycle_and_a_map_are_drawn(rough):
    wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    law = asperity.Exponential(1e-3, 8e-3)
    assert len(asperity.solve(wave, 1.0, modulus=1.0, mean_gap=0.01).plot().axes) == 2
    sweep = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.005, 0.01])
    assert sweep.plot(pressure_unit="Pa").get_xlabel() == "mean pressure (mPa)"
    cycle = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.08, 0.01, 0.08], steps=5)
    assert cycle.plot(length_unit="m").get_xlabel() == "mean gap (mm)"
    assert rough.plot().get_xlabel() == "x"
