"""The best fits of all models to a curve, by their columns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .curve import Curve
from .tips import Array


@dataclass(frozen=True)
class Fits:
    """Fits of one curve, in the order from DMT over the Tabor parameters to JKR; an element of each array for each fit."""

    #: names of the models
    model: NDArray[np.str_]
    modulus: Array
    work: Array
    point: Array
    tabor: Array
    #: the root of the work of adhesion in its scale, which is what varies
    root_work: Array
    #: sums of the squares of residuals
    squares: Array
    #: loads at the points, then how far jumps are off, as forces
    load: Array
    #: derivatives of the loads by the logarithm of the modulus, the root of the work, the contact point in its scale, and
    #: the logarithm of the Tabor parameter; zero of those that do not vary
    load_by: Array
    #: positions of jumps of approach and withdrawal, and the force that a shift by a length weighs as much as
    seen: Array

    def __len__(self) -> int:
        return len(self.model)


def search(curve: Curve, models: list[str], jumps: bool) -> Fits:
    """The best fits of models, of the fullest at many Tabor parameters."""
    tip = curve.tip
    names = list(tip.fewer)
    full = next((name for name in models if tip.fewer[name] == 0 and tip.tabor.size > 1), None)
    rows = [
        (names.index(name), float(np.log(tabor)))
        for name in models
        for tabor in (tip.tabor if name == full else np.ones(1))
    ]
    begins = zip(np.log(curve.moduli / curve.modulus), (curve.points - curve.point) / curve.length)
    model, parameters, free, squares, load, load_by, off, off_by, seen = curve.core.search(
        tip.equilibria,
        rows,
        [tip.adheres(name) for name in names],
        None if full is None else names.index(full),
        [(float(modulus), float(point)) for modulus, point in begins],
        jumps,
        curve.least,
    )
    return Fits(
        model=np.array(names)[model],
        modulus=curve.modulus * np.exp(parameters[:, 0]),
        work=curve.work * (parameters[:, 1] ** 2 + curve.floor),
        point=curve.point + curve.length * parameters[:, 2],
        tabor=np.exp(parameters[:, 3]),
        root_work=parameters[:, 1],
        squares=squares,
        load=np.concatenate([load, off], axis=1),
        load_by=np.concatenate([load_by, off_by], axis=1) * free[:, None, :],
        seen=seen,
    )
