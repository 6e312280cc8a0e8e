#!/usr/bin/env python3
"""Tables that other programs publish, by asperity, with the error of our grid; prints a Markdown table in a minute.

    pip install rfgen==0.1.6 scipy
    python python/benches/published.py

aspher's tables of convergence press one surface of 8192² nodes by rfgen on coarser grids, every s-th node, on a free
half-space: nodes in contact, sides of cells between nodes in contact and others, and the area less 0.118 cells for each of
these sides. Its rows on 2048² nodes are ours alone. MIRCO's factors E*Lδ/F are for a flat square punch of the side L, and
their error comes from the capacity of a square. reynoldsflow's flows, 12 times as large in its units, go along x through a
random gap that is periodic along y: they are twice the transmissivity of the gap next to its mirror image. Exits with 1
where a published digit is missed, or a factor by more than 1e-12. Takes 7 GB of memory.
"""

import sys
import warnings

import numpy as np
import rfgen
from scipy.ndimage import gaussian_filter

import asperity

NODES = 8192
EXCESS = (np.pi - 1 + np.log(2)) / 24
CAPACITY = 0.36679
ROUGH = {
    128: ("0.4692", "3524", "0.4438"),
    256: ("0.4592", "7129", "0.4463"),
    512: ("0.4544", "14351", "0.4479"),
    1024: ("0.4516", "28748", "0.4483"),
    2048: (),
}
BALL = {512: ("0.03192", "0.02630"), 1024: ("0.02870", "0.02571"), 2048: ()}
FLOWS = {256: "0.0277323298", 512: "0.0029641495", 1024: "0.0545516245"}
PUNCH = {
    3: "0.961389237917602",
    5: "0.924715342432435",
    9: "0.899837531880697",
    17: "0.884976751041942",
    33: "0.876753783192863",
    65: "0.872397956576882",
    129: "0.870146309331433",
    257: "0.868998266942617",
}

# the surfaces are as their authors have them: they touch at the edge of the map, and press harder than E*
warnings.simplefilter("ignore", asperity.InputWarning)


def surface(low, high):
    """Heights of the mean zero, of the wavenumbers from low to high, level below the lower one if it is above 1."""
    heights = rfgen.selfaffine_field(
        dim=2,
        N=NODES,
        Hurst=0.8,
        k_low=low / NODES,
        k_high=high / NODES,
        plateau=low > 1,
        noise=True,
        rng=np.random.default_rng(7),
        verbose=False,
    ).astype(float)
    return heights - heights.mean()


def spectral_slope(heights):
    """The rms slope by the derivatives of the Fourier series."""
    wavenumbers = 2 * np.pi * np.fft.fftfreq(len(heights), 1 / len(heights))
    power = np.abs(np.fft.fft2(heights) / heights.size) ** 2
    return np.sqrt(np.sum((wavenumbers[:, None] ** 2 + wavenumbers**2) * power))


def pressed(heights, **load):
    """Contact, switches and corrected area of a solve, and the contact within our own edge with its error."""
    solution = asperity.solve(heights, 1.0, modulus=1.0, boundary="free", tolerance=1e-7, nested=True, **load)
    touching = solution.contact_pressure > 0
    switches = sum(int(np.count_nonzero(np.diff(touching, axis=axis))) for axis in (0, 1))
    area, report = touching.mean() - EXCESS * switches / touching.size, solution.report
    error = report["grid_error"]["area"]
    edge = own(report["corrected_contact_fraction"], error and error["relative"], report["grid_error_reason"])
    return touching.mean(), switches, area, edge


def own(value, error, reason=None):
    """A number with its error of the grid, or the reason why it has none."""
    return f"{value:#.4g}, no error: {reason}" if error is None else f"{value:#.4g} ± {100 * error:.2g} %"


def rough():
    """aspher's rough surface."""
    heights = surface(1, 32)
    heights *= 0.1 / spectral_slope(heights)
    for nodes, published in ROUGH.items():
        step = NODES // nodes
        *found, edge = pressed(heights[::step, ::step].copy(), mean_pressure=0.03)
        yield f"aspher, surface, {nodes}²", published, found, edge


def ball():
    """aspher's rough ball."""
    heights = surface(12, 256)
    heights *= 2e-3 / heights.std()
    for nodes, published in BALL.items():
        step, x = NODES // nodes, (np.arange(nodes) + 0.5) / nodes - 0.5
        contact, _, area, edge = pressed(
            heights[::step, ::step] - (x[:, None] ** 2 + x**2) / 20, normal_force=4.439e-3
        )
        yield f"aspher, ball, {nodes}²", published, (contact, area), edge


def punch():
    """MIRCO's flat punch."""
    for nodes, published in PUNCH.items():
        solution = asperity.solve(
            np.zeros((nodes, nodes)), 1.0, modulus=1.0, approach=0.01, boundary="free", tolerance=1e-12
        )
        factor, exact = 0.01 / solution.normal_force, 1 / (np.pi * CAPACITY)
        yield f"MIRCO, punch, {nodes}²", (published,), (factor,), own(factor, factor / exact - 1)


def flow():
    """reynoldsflow's rough gap."""
    for nodes, published in FLOWS.items():
        noise = np.random.default_rng(23349).standard_normal((nodes, nodes))
        field = gaussian_filter(noise, nodes / 48, mode=("reflect", "wrap"))
        field -= field.mean()
        gap = np.clip(field / field.std() + 0.35, 0, None)
        along = asperity.leakage(np.concatenate([gap, gap[::-1]]), lengths=(2.0, 1.0), tolerance=1e-9).x
        found = 12 * (along.lower + along.upper)
        yield f"reynoldsflow, gap, {nodes}²", (published,), (found,), own(found, along.grid_error)


def main():
    missed = 0
    print("| table | published | asperity | our own, with the error of the grid |")
    print("|---|---|---|---|")
    for table in (rough, ball, punch, flow):
        for label, published, found, beside in table():
            ours = [f"{number:.{len(digits.partition('.')[2])}f}" for number, digits in zip(found, published)]
            if table is punch:
                missed += abs(found[0] - float(published[0])) > 1e-12
            else:
                missed += sum(here != there for here, there in zip(ours, published))
            cells = label, ", ".join(published), ", ".join(ours), beside
            print(f"| {' | '.join(cells)} |", flush=True)
    sys.exit(f"{missed} published figures are missed" if missed else 0)


if __name__ == "__main__":
    main()
