#!/usr/bin/env python3
"""Forces of rigid bodies of simple shapes beside exact ones; prints a Markdown table in seconds.

    python python/benches/shapes.py [NODES]

Each body is solved on NODES² nodes of a free half-space, 1024 by default, and on half as many a side. The error is mostly
of first order in the spacing, so that twice the finer value less the coarser one is closer. Flat punches have the area of
their nodes. K is the stiffness F/δ, and M the moment of the pressure. Layers are ten nodes thick, in a periodic cell; the
exact number is that of the limit of no thickness, and they are half as thick on the finer grid.
"""

import sys
import warnings

import numpy as np

import asperity

SIDE, DEPTH = 2.0, 0.02

# the punch on a layer stands among its images, which do not matter at some thicknesses away
warnings.filterwarnings("ignore", "ends", asperity.InputWarning)


def elliptic(e2):
    """The complete elliptic integrals K and E; the mean over a period is right to rounding."""
    root = np.sqrt(1 - e2 * np.sin(2 * np.pi * np.arange(200) / 200) ** 2)
    return np.pi / 2 * np.mean(1 / root), np.pi / 2 * np.mean(root)


def pressed(heights, depth=DEPTH):
    """The solution of a body at a given approach; where the heights are missing, there is nothing."""
    return asperity.solve(heights, SIDE, modulus=1.0, approach=depth, boundary="free", absent_missing=True)


def punch(inside):
    """K/(E*√A) of a flat punch."""

    def found(x, y):
        solution = pressed(np.where(inside(x, y), 0.0, np.nan))
        return solution.normal_force / DEPTH / np.sqrt(np.mean(inside(x, y)) * SIDE**2)

    return found


def ellipse(ratio):
    """A flat punch of semi-axes of a ratio, and its K/(E*√A)."""
    exact = np.sqrt(np.pi * ratio) / elliptic(1 - 1 / ratio**2)[0]
    return punch(lambda x, y: x**2 + (ratio * y) ** 2 < 0.8**2), exact


def oblique(x, y):
    """3M/(E*a³ tan θ) of a circular punch that is oblique by θ."""
    inside, slope = np.hypot(x, y) < 0.8, 0.2 * DEPTH
    solution = pressed(np.where(inside, slope * x, np.nan))
    assert not np.any(solution.gap[inside])
    radius = np.sqrt(np.mean(inside) * SIDE**2 / np.pi)
    return 3 * np.sum(solution.pressure[inside] * x[inside]) * (SIDE / len(x)) ** 2 / (radius**3 * slope)


def cone(x, y):
    """F tan β/(E*δ²) of a cone whose side has the angle β with the half-space."""
    return pressed(-0.04 * np.hypot(x, y)).normal_force * 0.04 / DEPTH**2


def sphere(x, y):
    """F/(E*√(Rδ³)) of a paraboloid."""
    return pressed(-(x**2 + y**2) / (2 * 20.0)).normal_force / np.sqrt(20.0 * DEPTH**3)


def ellipsoid(x, y):
    """F/(E*aδ) of a paraboloid whose contact is an ellipse of the semi-axes a and a/2."""
    (first, second), a, b = elliptic(0.75), 0.6, 0.3
    # the greatest pressure over E* of this depth and these semi-axes, and half of the curvatures
    greatest = DEPTH / (b * first)
    along, across = (greatest * b / (0.75 * a**2) * part for part in (first - second, 4 * second - first))
    return pressed(-along * x**2 - across * y**2).normal_force / (a * DEPTH)


def layer(base, poisson, exact):
    """Kt/(E*A) of a circular punch on a thin layer."""

    def found(x, y):
        inside, thickness = np.hypot(x, y) < 0.8, 10 * SIDE / len(x)
        solution = asperity.solve(
            np.where(inside, 0.0, np.nan),
            SIDE,
            modulus=1.0,
            mean_pressure=1e-3,
            absent_missing=True,
            body=asperity.Layer(thickness, poisson, base),
            stiffness=True,
        )
        # the approach of the stiffness is without the compression of the layer as a whole, which is added
        share = np.mean(inside)
        return 1 / (share * SIDE**2 / (solution.normal_stiffness * thickness) + share / exact)

    return f"flat punch, layer {base} at ν = {poisson}", "Kt/(E\\*A)", found, exact, "springs, Johnson (1985)"


BODIES = [
    ("flat punch, circle", "K/(E\\*√A)", punch(lambda x, y: np.hypot(x, y) < 0.8), 2 / np.sqrt(np.pi), "Boussinesq (1885)"),
    ("flat punch, ellipse 2:1", "K/(E\\*√A)", *ellipse(2), "capacity of an ellipse"),
    ("flat punch, ellipse 4:1", "K/(E\\*√A)", *ellipse(4), "capacity of an ellipse"),
    (
        "flat punch, square",
        "K/(E\\*√A)",
        punch(lambda x, y: np.maximum(abs(x), abs(y)) < 0.75),
        np.pi * 0.36679,
        "capacity of a square, Read (1997)",
    ),
    ("oblique flat punch, circle", "3M/(E\\*a³ tan θ)", oblique, 4.0, "Borowicka (1943)"),
    ("cone", "F tan β/(E\\*δ²)", cone, 2 / np.pi, "Love (1939)"),
    ("paraboloid", "F/(E\\*√(Rδ³))", sphere, 4 / 3, "Hertz (1881)"),
    ("paraboloid, ellipse 2:1", "F/(E\\*aδ)", ellipsoid, 2 * np.pi / (3 * elliptic(0.75)[0]), "Hertz (1881)"),
    layer("sliding", 0.3, 1.0),
    layer("bonded", 0.3, 0.7**2 / 0.4),
]


def main():
    nodes = int(sys.argv[1]) if len(sys.argv) > 1 else 1024
    print(f"| body | quantity | {nodes}² nodes | with {nodes // 2}² nodes | exact | source |")
    print("|---|---|---|---|---|---|")
    for body, quantity, found, exact, source in BODIES:
        coarse, fine = (found(*centres(count)) for count in (nodes // 2, nodes))
        print(f"| {body} | {quantity} | {fine:.4f} | {2 * fine - coarse:.4f} | {exact:.4f} | {source} |")


def centres(count):
    """The coordinates of the cells, about the middle of the side."""
    x = ((np.arange(count) + 0.5) / count - 0.5) * SIDE
    return np.meshgrid(x, x, indexing="ij")


if __name__ == "__main__":
    main()
