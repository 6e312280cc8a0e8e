#!/usr/bin/env python3
"""Forces of rigid bodies of simple shapes against exact ones; prints a Markdown table in seconds.

    python python/benches/shapes.py [NODES]

Each body is solved on NODES² nodes of a free half-space, 1024 by default, and on half as many a side. The error is mostly
of first order in the spacing, so that twice the finer value less the coarser one is closer. Flat punches have the area of
their nodes. K is the stiffness F/δ, and M the moment of the pressure. Layers are in a periodic cell. Those compared
with springs are ten nodes thick; the exact number is that of the limit of no thickness, and they are half as thick on
the finer grid. The others are as thick as the contact is wide from its middle to its edge.
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


def oblique(first, second):
    """An elliptic punch that is oblique by θ along its first semi-axis, and its 3M/(E*a³ tan θ) with the longer one a."""
    longer, angles = max(first, second), 2 * np.pi * np.arange(200) / 200
    root = np.hypot(second * np.cos(angles), first * np.sin(angles))

    def found(x, y):
        inside, slope = np.hypot(x / first, y / second) < 1, 0.2 * DEPTH
        solution = pressed(np.where(inside, slope * x, np.nan))
        assert not np.any(solution.gap[inside])
        grown = np.sqrt(np.mean(inside) * SIDE**2 / (np.pi * first * second))
        moment = np.sum(solution.pressure[inside] * x[inside]) * (SIDE / len(x)) ** 2
        return 3 * moment / ((grown * longer) ** 3 * slope)

    return "3M/(E\\*a³ tan θ)", found, 2 * first**2 / (longer**3 * np.mean(np.cos(angles) ** 2 / root))


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


def punch_on_layer(inside, thickness, poisson, base, yielding):
    """K of a flat punch on a layer, of which `yielding` is the strain as a whole times E*/p."""
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
    return 1 / (1 / solution.normal_stiffness + yielding * thickness / SIDE**2)


def thin(base, poisson, yielding):
    """Kt/(E*A) of a circular punch on a thin layer."""

    def found(x, y):
        inside, thickness = np.hypot(x, y) < 0.8, 10 * SIDE / len(x)
        return punch_on_layer(inside, thickness, poisson, base, yielding) * thickness / (np.mean(inside) * SIDE**2)

    return f"flat punch, layer {base} at ν = {poisson}", "Kt/(E\\*A)", found, 1 / yielding, "springs, Johnson (1985)"


def on_layer(radius, poisson):
    """K/(2E*a) of a flat punch, and √(Rδ)/t and F/(4/3 E*√(Rδ³)) of a paraboloid, on a bonded layer.

    The radius a of the contact is in units of the thickness t. The pressure ½E* ∫ q J₀(qr) ∫ φ(s) cos(qs) ds dq, with φ up
    to a, is zero outside, and makes the displacement u inside where φ(s) − 1/π ∫ φ(x) (N(s + x) + N(s − x)) dx =
    2/π d/ds ∫ ru/√(s² − r²) dr. N(y) is ∫ (1 − W) cos(qy) dq with the compliance W of the layer over that of a
    half-space. Under the paraboloid φ(a) is zero.
    """
    a, b = 3 - 4 * poisson, 5 - 12 * poisson + 8 * poisson**2
    return on_body(radius, lambda q: (a * np.sinh(2 * q) - 2 * q) / (a * np.cosh(2 * q) + 2 * q**2 + b))


def on_coating(radius, ratio, poisson):
    """√(Rδ)/t and F/(4/3 E₁*√(Rδ³)) of a paraboloid on a coating whose modulus is in a ratio to that of its substrate."""
    kappa, parts = (ratio - 1) / (ratio + 3 - 4 * poisson), 3 - 4 * poisson
    lam = 1 - 4 * (1 - poisson) / (1 + ratio * parts)

    def compliance(q):
        theta = np.exp(-2 * q)
        above = 1 + 4 * q * kappa * theta - lam * kappa * theta**2
        return above / (1 - (lam + kappa + 4 * kappa * q**2) * theta + lam * kappa * theta**2)

    return on_body(radius, compliance)[1:]


def on_body(radius, compliance):
    """The same by the compliance of a body over that of a half-space, a function of qt."""
    (s, weights), (q, of_q) = (np.polynomial.legendre.leggauss(count) for count in (30, 100))
    s, weights, q, of_q = radius * (s + 1) / 2, radius * weights / 2, 10 * (q + 1), 10 * of_q
    missing = of_q * (1 - compliance(q))
    places = np.append(s, radius)[:, None]
    kernel = sum(np.cos(q * distance[..., None]) @ missing for distance in (places + s, places - s)) * weights / np.pi
    right = 2 / np.pi * np.hstack([np.ones_like(places), places**2])
    inner = np.linalg.solve(np.eye(len(s)) - kernel[:-1], right[:-1])
    flat, bowl = right[-1] + kernel[-1] @ inner
    depth, (force, less) = bowl / flat, np.pi * weights @ inner
    return force / (2 * radius), np.sqrt(depth), (depth * force - less) / (4 / 3 * depth**1.5)


def thick_punch(x, y):
    """K/(E*√A) of a circular punch on a bonded layer of ν = ½ as thick as its radius."""
    inside = np.hypot(x, y) < 0.2
    area = np.mean(inside) * SIDE**2
    return punch_on_layer(inside, np.sqrt(area / np.pi), 0.5, "bonded", 0.0) / np.sqrt(area)


def thick_sphere(poisson):
    """F/(E*√(Rδ³)) of a paraboloid, on a bonded layer as thick as its radius of contact."""
    radius, thickness, (_, root, ratio) = 20.0, 0.2, on_layer(1.0, poisson)
    force = 4 / 3 * ratio * (root * thickness) ** 3 / radius

    def found(x, y):
        heights, body = -(x**2 + y**2) / (2 * radius), asperity.Layer(thickness, poisson)
        solution = asperity.solve(heights, SIDE, modulus=1.0, normal_force=force, body=body)
        strain = solution.mean_pressure * (1 - 2 * poisson) / (1 - poisson) ** 2
        depth = strain * thickness - solution.mean_gap - np.mean(heights)
        return force / np.sqrt(radius * depth**3)

    source = "integral equation, Lebedev and Ufliand (1958)"
    return f"paraboloid, layer bonded at ν = {poisson}", "F/(E\\*√(Rδ³))", found, 4 / 3 * ratio, source


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
    ("oblique flat punch, circle", *oblique(0.8, 0.8), "Borowicka (1943)"),
    ("oblique flat punch, ellipse 2:1, along", *oblique(0.8, 0.4), "potential of an ellipse, Galin (1961)"),
    ("oblique flat punch, ellipse 2:1, across", *oblique(0.4, 0.8), "potential of an ellipse, Galin (1961)"),
    ("cone", "F tan β/(E\\*δ²)", cone, 2 / np.pi, "Love (1939)"),
    ("paraboloid", "F/(E\\*√(Rδ³))", sphere, 4 / 3, "Hertz (1881)"),
    ("paraboloid, ellipse 2:1", "F/(E\\*aδ)", ellipsoid, 2 * np.pi / (3 * elliptic(0.75)[0]), "Hertz (1881)"),
    thin("sliding", 0.3, 1.0),
    thin("bonded", 0.3, 0.4 / 0.7**2),
    (
        "flat punch, layer bonded at ν = 0.5, t = a",
        "K/(E\\*√A)",
        thick_punch,
        2 / np.sqrt(np.pi) * on_layer(1.0, 0.5)[0],
        "integral equation, Lebedev and Ufliand (1958)",
    ),
    thick_sphere(0.3),
    thick_sphere(0.5),
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
