"""What `prepare(clean=True)` does to twenty maps of known surfaces, with the faults of an AFM: a table of docs/program/maps.md."""

import warnings

import numpy as np

import asperity

warnings.simplefilter("ignore", asperity.InputWarning)
SHAPE, SIDE = (256, 256), 5e-6


def scanned(surface, rng):
    """The map of an instrument: offsets of lines, scars, spikes, noise, holes and a tilt."""
    rms = surface.std()
    x = np.arange(SHAPE[0])
    scan = surface + 0.2 * rms * rng.normal(size=SHAPE[1]) + 0.01 * rms * rng.normal(size=SHAPE)
    for line, start in rng.integers(0, 200, (8, 2)):
        scan[start : start + 40, line] += rms
    spikes = tuple(rng.integers(0, 256, (2, 10)))
    scan[spikes] += 10 * rms
    scan[tuple(rng.integers(0, 256, (2, 200)))] = np.nan
    return scan + 0.05 * rms * x[:, None] - 0.02 * rms * x


def figures(heights):
    """The rms slope by differences, and the contact area at a fixed load."""
    topography = asperity.Topography(heights, SIDE, unit="m")
    made = asperity.prepare(topography, fill=True, mirror=True)
    solved = asperity.solve(made, modulus="1GPa", mean_pressure="5MPa")
    return asperity.surface.statistics(made).rms_slope_differences, solved.statistics.corrected_contact_fraction


errors = {name: [] for name in ("as it was scanned", "plane alone", "clean", "clean, without rows", "without faults, clean")}
for seed in range(20):
    rng = np.random.default_rng(seed)
    made = asperity.surface.self_affine(SHAPE, SIDE, hurst=0.8, rms_height=20e-9, k_l=2, k_s=32, seed=seed)
    true = asperity.prepare(made.heights, SIDE, unit="m", detrend="plane").heights
    scan = asperity.Topography(scanned(true, rng), SIDE, unit="m")
    maps = (
        scan,
        asperity.prepare(scan, detrend="plane"),
        asperity.prepare(scan, clean=True),
        asperity.prepare(scan, clean=True, without="rows"),
        asperity.prepare(true, SIDE, unit="m", clean=True),
    )
    expected = figures(true)
    for all_errors, one in zip(errors.values(), maps):
        all_errors.append([found / right - 1 for found, right in zip(figures(one.heights), expected)])
print("| map | slope | contact area |\n|---|---|---|")
for name, found in errors.items():
    slope, area = 100 * np.mean(np.abs(found), 0)
    print(f"| {name} | {slope:.3g} % | {area:.3g} % |")
