#!/usr/bin/env python3
"""Draws the time of a solve to a certified 1e-6 against the nodes, from the tables of the README next to this file.

    benches/peers/picture.py [OUT.png]        (default: examples/pictures/peers.png; needs matplotlib)
    benches/peers/picture.py --table          prints the time of the other programs over the time of asperity
"""

import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROW = re.compile(
    r"\| (\d+)² \| (f64|force|approach) \| (\w+) \| certified 1e-6 "
    r"\| ([\d.e+-]+) s [^|]*\| ([\d.e+-]+) s [^|]*\| \*\*([\d.]+)\*\*"
)
HEAVY = re.compile(r"\| (\d+)² \| ([\d.]+) % \| (\w+) \|[^|]*\|[^|]*\| \*\*([\d.]+)\*\*")


def rows(text):
    """Of each kind of contact, in the order of the tables, the rows to a certified 1e-6."""
    parts = ((part.split(",")[0], ROW.findall(part)) for part in text.split("### ")[1:])
    return {kind: found for kind, found in parts if found}


def rounded(ratio):
    """A ratio as words."""
    return f"{float(ratio):.{1 if float(ratio) < 10 else 0}f}"


def heavy(text):
    """The same of hard walls by their contact, on other grids and under other loads."""
    ratios = {}
    for side, contact, peer, ratio in HEAVY.findall(text):
        ratios.setdefault(peer, {})[f"{float(contact):.0f} % contact, {side}²"] = rounded(ratio)
    heads = list(dict.fromkeys(head for row in ratios.values() for head in row))
    yield f"| program on a hard wall | {' | '.join(heads)} |"
    yield "|---" * (len(heads) + 1) + "|"
    for name, row in ratios.items():
        yield f"| {name} | {' | '.join(row.get(head, '') for head in heads)} |"


def table(kinds):
    """The time of the other programs over the time of asperity, in Markdown."""
    ratios = {}
    for kind, found in kinds.items():
        for side, given, peer, _, _, ratio in found:
            name = f"{peer}, {kind.lower()}" + ("" if given == "f64" else f", given {given}")
            ratios.setdefault(name, {})[int(side)] = rounded(ratio)
    sides = sorted({side for row in ratios.values() for side in row})
    yield f"| program and problem | {' | '.join(f'{side}²' for side in sides)} |"
    yield "|---" * (len(sides) + 1) + "|"
    for name, row in ratios.items():
        yield f"| {name} | {' | '.join(row.get(side, '') for side in sides)} |"


def lines(found):
    """Of each program of a kind of contact its line, as {nodes: seconds}."""
    programs = {}
    for side, given, peer, ours, theirs, _ in found:
        if given == "f64":
            programs.setdefault("asperity", {}).setdefault(int(side) ** 2, float(ours))
            programs.setdefault(peer, {})[int(side) ** 2] = float(theirs)
    return programs


def draw(kinds, out):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    kinds = {kind: programs for kind, found in kinds.items() if (programs := lines(found))}
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


def main():
    text = (HERE / "README.md").read_text()
    kinds = rows(text)
    out = sys.argv[1] if len(sys.argv) > 1 else HERE.parent.parent / "examples/pictures/peers.png"
    if out == "--table":
        print(*table(kinds), "", *heavy(text), sep="\n")
    else:
        draw(kinds, out)


if __name__ == "__main__":
    main()
