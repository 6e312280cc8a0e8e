#!/usr/bin/env python3
"""Draws the time of a solve to a certified 1e-6 against the nodes, from the tables of the README beside this file.

    benches/peers/picture.py [OUT.png]        (default: examples/pictures/peers.png; needs matplotlib)
"""

import re
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent
ROW = re.compile(r"\| (\d+)² \| f64 \| (\w+) \| certified 1e-6 \| ([\d.e+-]+) s [^|]*\| ([\d.e+-]+) s ")


def lines(text):
    """Of each kind of contact, in the order of the tables: the line of each program, as {nodes: seconds}."""
    kinds = {}
    for part in text.split("### ")[1:]:
        programs = {}
        for side, peer, ours, theirs in ROW.findall(part):
            nodes = int(side) ** 2
            programs.setdefault("asperity", {}).setdefault(nodes, float(ours))
            programs.setdefault(peer, {})[nodes] = float(theirs)
        if programs:
            kinds[part.split(",")[0]] = programs
    return kinds


def main():
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parent.parent / "examples/pictures/peers.png"
    kinds = lines((HERE / "README.md").read_text())
    colours = {"asperity": "#0a288c", "aspher": "#c81e14", "Tamaas": "#3c3c3c"}
    figure, axes = plt.subplots(1, len(kinds), figsize=(4.2 * len(kinds), 3.6), sharey=True, squeeze=False)
    for axis, (kind, programs) in zip(axes[0], kinds.items()):
        for name, points in programs.items():
            nodes, seconds = zip(*sorted(points.items()))
            axis.loglog(nodes, seconds, "o-", color=colours[name], label=name)
            axis.annotate(name, (nodes[-1], seconds[-1]), (6, 0), textcoords="offset points", va="center", color=colours[name])
        sides = sorted({n for points in programs.values() for n in points})
        axis.set_xticks(sides, [f"{round(n**0.5)}²" for n in sides])
        axis.minorticks_off()
        axis.set_xlim(sides[0] / 1.3, sides[-1] * 4)
        axis.set_title(kind, fontsize=10)
        axis.set_xlabel("nodes")
        axis.grid(color="#dddddd")
    axes[0][0].set_ylabel("seconds, one thread, to 1e-6")
    figure.tight_layout()
    figure.savefig(out, dpi=110)


if __name__ == "__main__":
    main()
