"""Draws the pictures of the page of warnings, and checks that each scene gives its warning.

    python docs/pictures.py FOLDER
"""

import sys
import warnings
from contextlib import contextmanager
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import asperity

PRESSED = {"modulus": "1GPa", "mean_pressure": "2MPa"}


@contextmanager
def picture(code, *titles):
    """Two panels, the left one of a scene with the warning and the right one of its remedy."""
    figure, axes = plt.subplots(1, 2, figsize=(7.2, 2.4), sharey=True, layout="constrained")
    for ax, title in zip(axes, titles):
        ax.set_title(title, fontsize="medium")
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        yield axes
    assert code in [str(warning.message).split(":")[0] for warning in told], f"no warning {code}"
    figure.savefig(Path(sys.argv[1]) / f"warning-{code}.png", dpi=100)


def section(ax, solution, line, periods=1):
    """Surface and half-space along a line of nodes, with the gap between them in white."""
    surface, gap = (1e9 * np.tile(field[:, line], periods) for field in (solution.heights, solution.gap))
    x = 1e6 * solution.lengths[0] * np.linspace(0, periods, surface.size)
    ax.set_facecolor(("C0", 0.4))
    ax.fill_between(x, surface, surface + gap, color="w", linewidth=0)
    ax.fill_between(x, surface.min() - 2, surface, color="0.75", linewidth=0)
    ax.margins(0, 0.2)
    ax.set(xlabel="x (µm)", ylabel="height (nm)", ylim=(surface.min() - 2, None))


def contact(ax, solution):
    """The contact map, black where there is contact."""
    colours = matplotlib.colors.ListedColormap(asperity._asperity.palette("contact")[:2] / 255)
    extent = [1e6 * end for length in solution.lengths for end in (0, length)]
    ax.imshow(solution.contact.T, cmap=colours, origin="lower", extent=extent, interpolation="nearest")
    ax.set(xlabel="x (µm)", ylabel="y (µm)")


with picture("ends", "a periodic cell", "a free boundary") as axes:
    tip = asperity.surface.paraboloid(96, "0.4um", radius="1um")
    for ax, boundary, periods in zip(axes, ("periodic", "free"), (3, 1)):
        section(ax, asperity.solve(tip, modulus="1GPa", normal_force="50nN", boundary=boundary), 48, periods)
    axes[1].text(0.2, -12, "surface", ha="center")
    axes[1].text(0.2, 1.5, "half-space", ha="center")

rough = asperity.surface.self_affine((256, 128), ("4um", "2um"), rms_height="6nm", k_l=2, k_s=40, seed=5)
with picture("open-edges", "as measured, two periods", "mirrored") as axes:
    scan = asperity.Topography(rough.heights[:128, :64], (2e-6, 1e-6), unit="m")
    section(axes[0], asperity.solve(scan, **PRESSED), 9, 2)
    section(axes[1], asperity.solve(asperity.prepare(scan, mirror=True), whole=True, **PRESSED), 9)


def mended(show, defects, **steps):
    """What is shown of the surface with defects of a measurement, and of that after steps of its preparation."""
    measured = asperity.Topography(rough.heights + defects, rough.lengths, unit="m", periodic=True)
    for ax, surface in zip(axes, (measured, asperity.prepare(measured, **steps))):
        show(ax, asperity.solve(surface, **PRESSED))


with picture("spikes", "as measured", "despiked") as axes:
    dust = np.zeros(rough.shape)
    dust[[60, 180], 64] = 20e-9
    mended(lambda ax, solution: section(ax, solution, 64), dust, despike=True)

rng = np.random.default_rng(1)
with picture("scars", "as measured", "scars removed") as axes:
    scars = np.zeros(rough.shape)
    for start, line in rng.integers((200, 128), size=(6, 2)):
        scars[start : start + 50, line] = 10e-9
    mended(contact, scars, remove_scars=True, scan_axis="x")

with picture("noise", "as measured", "without waves below 100 nm") as axes:
    mended(contact, rng.normal(scale=1e-9, size=rough.shape), cut_off_wavelength="100nm")

with picture("range", "24² nodes", "128² nodes") as axes:
    for ax, nodes in zip(axes, (24, 128)):
        tip = asperity.surface.paraboloid(nodes, "22nm", radius="20nm")
        law, way = asperity.Exponential("50mJ/m2", "0.15nm"), ["-1.5nm", "0.5nm", "-1.5nm"]
        asperity.cycle(tip, modulus="2GPa", law=law, boundary="free", approaches=way, steps=60).plot(ax)
