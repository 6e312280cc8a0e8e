"""The branches of a force curve: approach and withdrawal."""

from __future__ import annotations

import numpy as np

from .tips import Array

#: The fewest points of a branch.
_FEWEST = 8


def noise_of(force: Array) -> float:
    """The standard deviation of the noise of forces."""
    # by second differences, which a curve hardly has from point to point; of few digits more than half may be zero
    rough = np.abs(np.diff(force, 2))
    return float((np.median(rough) / 0.6745 or rough.std()) / np.sqrt(6.0))


def order_branches(z: Array, force: Array) -> tuple[Array, Array, str]:
    """Positions and forces with the approach in front of the withdrawal, and what speaks against this order."""
    if z.size < 2 * _FEWEST:
        return z, force, ""
    steps, ends = np.abs(np.diff(z)), z[[0, -1]] > 0.5 * (z.min() + z.max())
    if steps.max() > 0.5 * np.ptp(z):
        # both branches begin at the same end
        split = int(np.argmax(steps)) + 1
    elif ends[0] == ends[1]:
        split = int(np.argmin(z) if ends[0] else np.argmax(z)) + 1
    else:
        return z, force, ""
    branches = [(z[:split], force[:split]), (z[split:], force[split:])]
    if min(split, z.size - split) < _FEWEST:
        return z, force, ""
    grows = [bool(where[-1] > where[0]) for where, _ in branches]
    # how far the force falls below the force far from contact
    fars = [float(np.median(load[where <= np.quantile(where, 0.25)])) for where, load in branches]
    depths = [far - float(load.min()) for far, (_, load) in zip(fars, branches)]
    # a branch that ends in contact, or never leaves tension, tells nothing
    ends = [float(load[np.argsort(where)[: max(where.size // 20, 3)]].mean()) for where, load in branches]
    apart = all(where.min() < z.min() + 0.1 * np.ptp(z) for where, _ in branches)
    apart &= all(abs(max(fars) - end) < 0.5 * max(depths) for end in ends)
    is_clear = apart and abs(depths[0] - depths[1]) > max(8.0 * noise_of(force), 0.1 * max(depths))
    deeper = int(depths[1] > depths[0])
    withdrawal = grows.index(False) if grows[0] != grows[1] else deeper if is_clear else 1
    against = ""
    if is_clear and deeper != withdrawal:
        against = (
            f"branches: the force falls by {depths[1 - withdrawal]:.3g} as z grows, and by {depths[withdrawal]:.3g} as it "
            "falls, but adhesion pulls harder on a withdrawal: if the points are in reverse order, give z[::-1] and force[::-1]"
        )
    step = [1 if grow == (at != withdrawal) else -1 for at, grow in enumerate(grows)]
    where, load = (
        np.concatenate([branches[at][column][:: step[at]] for at in (1 - withdrawal, withdrawal)]) for column in (0, 1)
    )
    return where, load, against
