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


def test_a_scale_ends_where_most_of_the_load_is_carried(rough):
    heights = np.array(rough)
    highest = np.unravel_index(heights.argmax(), heights.shape)
    scarred = heights.copy()
    scarred[:12, (highest[1] + heights.shape[1] // 2) % heights.shape[1]] = 1.5 * heights.max()
    solution = asperity.solve(scarred, 1.0, modulus=1.0, mean_pressure=0.01)
    pressure = solution.contact_pressure
    figure = solution.plot(pressure_unit="Pa")
    image, bar = figure.axes[1].images[0], figure.axes[2]
    end = image.get_clim()[1]
    factor = image.get_array().max() / pressure.max()
    share = pressure[pressure * factor > end].sum() / pressure.sum()
    assert end < 0.75 * factor * pressure.max() and 0.01 < share < 0.75
    assert f"{100 * share:.2g} % of the load above, up to" in bar.get_ylabel()
    # all of it on demand
    figure = solution.plot(colour_limits=(0.0, 2 * pressure.max()))
    assert figure.axes[1].images[0].get_clim() == (0.0, 2 * pressure.max())
    assert figure.axes[2].get_ylabel() == "pressure"
    with pytest.raises(ValueError, match=r"colour_limits are \(1.0, 2.0\)"):
        solution.plot(colour_limits=(1.0, 2.0))


def test_clusters_have_colours(rough):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    figure = solution.plot(colour_clusters=True)
    colours = figure.axes[0].images[0].get_array()
    labels = asperity.contact.clusters(solution.contact).labels.T
    assert (colours[labels == 0] == 255).all() and len(np.unique(colours[labels == 1], axis=0)) == 1
    assert (colours[labels == 1][0] != colours[labels == 2][0]).any()
    assert f"{labels.max()} clusters" in figure.axes[0].get_title()


def test_a_line_a_sweep_a_cycle_and_a_map_are_drawn(rough):
    wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    law = asperity.Exponential(1e-3, 8e-3)
    assert len(asperity.solve(wave, 1.0, modulus=1.0, mean_gap=0.01).plot().axes) == 2
    sweep = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.005, 0.01])
    assert sweep.plot(pressure_unit="Pa").get_xlabel() == "mean pressure (mPa)"
    cycle = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.08, 0.01, 0.08], steps=5)
    assert cycle.plot(length_unit="m").get_xlabel() == "mean gap (mm)"
    assert rough.plot().get_xlabel() == "x"


def test_theories_are_drawn_beside_a_sweep(rough, law):
    metres = asperity.Topography(1e-6 * rough.heights, (1e-6, 1e-6), "m")
    sweep = asperity.sweep(metres, modulus="1GPa", mean_pressures=["5MPa", "10MPa", "40MPa"])
    axes = sweep.plot(theory=True)
    named = {line.get_label(): line for line in axes.lines}
    assert list(named) == ["corrected area", "nodes in contact", "Persson", "Greenwood and Williamson"]
    assert axes.get_xlabel() == "mean pressure (MPa)" and axes.get_legend() is not None
    persson = asperity.exact.Persson.of(metres, modulus="1GPa")
    x, y = named["Persson"].get_data()
    assert x[-1] == pytest.approx(40.0) and y[-1] == pytest.approx(persson.contact_fraction("40MPa"))
    axes = sweep.plot(of="gap", theory=True)
    assert [line.get_label() for line in axes.lines] == ["solves", "Persson"] and axes.get_ylabel() == "mean gap (nm)"
    assert axes.lines[1].get_data()[1][-1] == pytest.approx(1e9 * persson.mean_gap("40MPa"))
    # with both bodies elastic it is the modulus of both
    both = asperity.sweep(rough, modulus=2.0, against=0 * rough.heights, against_modulus=2.0, mean_pressures=[0.05])
    one = asperity.exact.Persson.of(rough, modulus=1.0).contact_fraction(0.05)
    assert both.plot(theory=True).lines[2].get_data()[1][-1] == pytest.approx(one)
    with pytest.raises(ValueError, match="of is 'pressure': it must be 'area' or 'gap'"):
        sweep.plot(of="pressure")
    for more in ({"law": law}, {"body": asperity.Layer(0.1, 0.3)}, {"boundary": "free"}, {"hardness": 0.1}):
        (name,) = more
        with pytest.raises(ValueError, match=f"and this is of {name}: leave theory out"):
            asperity.sweep(rough, modulus=1.0, mean_pressures=[0.01], **more).plot(theory=True)
    with pytest.raises(ValueError, match="of a line: leave theory out"):
        asperity.sweep(rough.heights[0], 1.0, modulus=1.0, mean_pressures=[0.01]).plot(theory=True)
