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
    axes = solution.plot(length_unit="m", pressure_unit="Pa")
    axes[0].figure.savefig(tmp_path / f"solution.{form}")
    assert (tmp_path / f"solution.{form}").stat().st_size > 1000
    # adhesion is on a scale of its own, below that of the compression
    compression, tension = (bar for bar in axes[1].child_axes)
    assert compression.get_ylabel() == "compression (mPa)" and tension.get_ylabel().startswith("tension (")
    assert tension.get_position().y1 < compression.get_position().y0
    # zero looks the same on both, and where nothing presses
    upper, lower = axes[1].images
    assert upper.cmap(0) == pytest.approx(lower.cmap(127), abs=0.02) and upper.cmap(0) == axes[1].get_facecolor()


def drawn(solution):
    """The colours of the contact, by the classes that the legend has."""
    left = solution.plot()[0]
    (image,) = left.images
    named = {text.get_text(): patch.get_facecolor() for text, patch in zip(left.get_legend().get_texts(), left.get_legend().get_patches())}
    return image.cmap(image.norm(image.get_array())).transpose(1, 0, 2), named


def test_classes_are_those_of_the_tool(rough, law):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
    colours, named = drawn(solution)
    shares = {name: np.mean((colours == colour).all(axis=-1)) for name, colour in named.items()}
    assert shares["contact"] == solution.contact_fraction
    # where the traction is more than a hundredth of w/ρ, as the library counts it
    attracts = law.traction(solution.gap) > 0.01 * law.work_of_adhesion / law.range
    assert 0.01 < shares["attractive"] < 0.99
    assert np.array_equal((colours == named["attractive"]).all(axis=-1), attracts & ~solution.contact)
    assert set(drawn(asperity.solve(rough, modulus=1.0, mean_pressure=0.01))[1]) == {"apart", "contact"}
    yielded = asperity.solve(rough, modulus=1.0, mean_pressure=0.02, hardness=0.1)
    colours, named = drawn(yielded)
    assert np.array_equal((colours == named["yielded"]).all(axis=-1), yielded.plastic_depth > 0)


def test_axes_may_be_given(rough):
    figure, axes = plt.subplots(1, 2)
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    assert all(given is drawn for given, drawn in zip(axes, solution.plot(axes))) and axes[0].get_xlim() == (0.0, 1.0)
    with pytest.raises(ValueError, match="ax has 1 axes: it must be two of matplotlib"):
        solution.plot(axes[0])


def test_without_adhesion_there_is_no_scale_of_tension(rough):
    axes = asperity.solve(rough, modulus=1.0, mean_pressure=0.01).plot()
    assert [bar.get_ylabel() for bar in axes[1].child_axes] == ["pressure"]


def test_a_sign_that_no_node_has_has_no_scale(rough, law):
    apart = asperity.solve(rough, modulus=1.0, mean_gap=0.08, law=law)
    assert apart.pressure.max() < 0.0
    (bar,) = apart.plot()[1].child_axes
    assert bar.get_ylabel().startswith("tension")
    # but for one of which the end is given
    assert len(apart.plot(colour_limits=(-1.0, 1.0))[1].child_axes) == 2


def test_labels_of_scales_are_apart_beside_a_low_map(rough, law):
    low = asperity.Topography(np.concatenate([rough.heights] * 4), (4.0, 1.0))
    right = asperity.solve(low, modulus=1.0, mean_pressure=0.01, law=law).plot(pressure_unit="mPa")[1]
    right.figure.draw_without_rendering()
    compression, tension = (bar.yaxis.label.get_window_extent() for bar in right.child_axes)
    assert tension.y1 < compression.y0


def test_a_scale_ends_where_most_of_the_load_is_carried(rough):
    heights = np.array(rough)
    highest = np.unravel_index(heights.argmax(), heights.shape)
    scarred = heights.copy()
    scarred[:12, (highest[1] + heights.shape[1] // 2) % heights.shape[1]] = 1.5 * heights.max()
    solution = asperity.solve(scarred, 1.0, modulus=1.0, mean_pressure=0.01)
    pressure = solution.contact_pressure
    right = solution.plot(pressure_unit="Pa")[1]
    image, (bar,) = right.images[0], right.child_axes
    end = image.get_clim()[1]
    factor = image.get_array().max() / pressure.max()
    share = pressure[pressure * factor > end].sum() / pressure.sum()
    assert end < 0.75 * factor * pressure.max() and 0.01 < share < 0.75
    assert f"{100 * share:.2g} % of the load beyond, to" in right.texts[0].get_text()
    assert bar.get_ylabel().startswith("pressure (")
    # all of it on demand
    right = solution.plot(colour_limits=(0.0, 2 * pressure.max()))[1]
    assert right.images[0].get_clim() == (0.0, 2 * pressure.max())
    assert not right.texts
    with pytest.raises(ValueError, match=r"colour_limits are \(1.0, 2.0\)"):
        solution.plot(colour_limits=(1.0, 2.0))


def test_clusters_have_colours(rough):
    solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01)
    left = solution.plot(colour_clusters=True)[0]
    image = left.images[0]
    colours = image.cmap(image.norm(image.get_array()))
    labels = asperity.contact.clusters(solution.contact).labels.T
    assert (colours[labels == 0] == 1).all() and len(np.unique(colours[labels == 1], axis=0)) == 1
    assert (colours[labels == 1][0] != colours[labels == 2][0]).any()
    assert f"{labels.max()} clusters" in left.get_title()


def test_a_line_a_sweep_a_cycle_and_a_map_are_drawn(rough):
    wave = 0.02 * np.cos(2 * np.pi * np.arange(64) / 64)
    law = asperity.Exponential(1e-3, 8e-3)
    assert len(asperity.solve(wave, 1.0, modulus=1.0, mean_gap=0.01).plot()) == 2
    sweep = asperity.sweep(rough, modulus=1.0, mean_pressures=[0.005, 0.01])
    assert sweep.plot(pressure_unit="Pa").get_xlabel() == "mean pressure (mPa)"
    cycle = asperity.cycle(wave, 1.0, modulus=1.0, law=law, mean_gaps=[0.08, 0.01, 0.08], steps=5)
    assert cycle.plot(length_unit="m").get_xlabel() == "mean gap (mm)"
    assert rough.plot().get_xlabel() == "x"


def test_numbers_of_results_in_known_units_are_converted(rough, law):
    metres = asperity.Topography(1e-6 * rough.heights, (1e-6, 1e-6), "m")
    options = {"modulus": "1GPa", "law": asperity.Exponential("20mJ/m2", "8nm")}
    units = {"length_unit": "nm", "pressure_unit": "kPa"}
    left, right = asperity.solve(metres, mean_pressure="10MPa", **options).plot(**units)
    solution = asperity.solve(metres, mean_pressure="10MPa", **options)
    assert left.get_xlabel() == "x (nm)" and left.get_xlim() == pytest.approx((0.0, 1000.0))
    assert right.child_axes[0].get_ylabel() == "compression (kPa)"
    assert right.images[0].get_array().max() == pytest.approx(1e-3 * solution.pressure.max())
    axes = asperity.sweep(metres, mean_pressures=["10MPa"], **options).plot(of="gap", **units)
    x, y = axes.lines[0].get_data()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("mean pressure (kPa)", "mean gap (nm)")
    assert x == pytest.approx(1e4) and y == pytest.approx(1e9 * solution.mean_gap)
    tip = asperity.surface.paraboloid(32, "1um", radius="2um")
    cycle = asperity.cycle(tip, boundary="free", approaches=["0nm", "10nm"], steps=2, modulus="1GPa")
    axes = cycle.plot(force_unit="uN", **units)
    x, y = axes.lines[0].get_data()
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("approach (nm)", "normal force (uN)")
    assert x[-1] == pytest.approx(10.0) and y[-1] == pytest.approx(1e6 * cycle.columns["normal_force"][-1])
    with pytest.raises(ValueError, match="length_unit is 'kPa': it must be a unit of a length, as 'nm'"):
        cycle.plot(length_unit="kPa")
    # numbers without a unit are what the user says
    plain = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
    assert plain.plot(**units)[0].get_xlim() == (0.0, 1.0)


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
    refused = {"law": {"law": law}, "a body of another kind": {"body": asperity.Layer(0.1, 0.3)}}
    refused |= {"boundary='free'": {"boundary": "free"}, "a hardness": {"hardness": 0.1}}
    for name, more in refused.items():
        with pytest.raises(ValueError, match=f"and this run has {name}: leave theory out"):
            asperity.sweep(rough, modulus=1.0, mean_pressures=[0.01], **more).plot(theory=True)
    with pytest.raises(ValueError, match="has a line: leave theory out"):
        asperity.sweep(rough.heights[0], 1.0, modulus=1.0, mean_pressures=[0.01]).plot(theory=True)
