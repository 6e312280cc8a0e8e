"""The table of a tip of any shape, solved once."""

from __future__ import annotations

from ..bodies.body import Coating, Layer
from ..common.types import AxisOrder, Lengths, OwnLaw, Quantity
from ..maps.heights import Heights
from .solved_tip import SolvedTip


class TipTable:
    """The equilibria of a tip of any shape and its adhesion, solved once, with which `fit_curve` fits many curves.

    The force over E* depends on the approach, the adhesion law over w, and w/E* alone. So solves of one law at some
    moduli serve all moduli and works of adhesion up to the ratio of the table. Between its works, monotone
    cubics interpolate both branches. The withdrawal is that from the greatest approach. A table of 64 x 64 nodes takes
    seconds. Needs SciPy.

    Parameters
    ----------
    heights, lengths, axes
        Heights of the tip, as `solve` takes them: a measured map, or a form of `asperity.surface`, as a cone, with or
        without roughness.
    approaches : (float, float)
        Approaches between which the tip is solved: one before contact, negative, where its attraction is small, and the
        greatest one of the curves.
    modulus, law, work_of_adhesion, range
        Contact modulus E* and adhesion law, as `solve` takes them, with the greatest w/E* of the curves. The range of
        the law is fixed, and best one that the grid resolves: by `JKR` a smooth tip of 64 x 64 nodes is fitted with a
        work of adhesion 7 % too small. Without a law the force is in proportion to the modulus, and any will do.
    body : Layer or Coating, optional
        Layer under the tip, or coating on the half-space, which is alone by default. Its boundary is periodic, so that
        the map has to be much wider than the contact: approaches are of points far away, to the first order in the
        width of the contact over the map's. Moduli of coating and half-space stay in proportion, and a fit tells the
        one of the half-space.
    works : int
        Number of the ratios w/E* at which the tip is solved, even.
    steps : int
        Least number of states far from contact, near it, and in it, each way.

    Attributes
    ----------
    ratio : float
        Greatest w/E*, a length.
    error : float
        Estimated relative error of pull-off and greatest force, where w/E* is above a 27th of the greatest one: a
        quarter of the error of a table of every second work.

    Examples
    --------
    >>> import asperity, numpy as np
    >>> cone = asperity.surface.cone(64, 1.0, angle=10)
    >>> table = asperity.TipTable(cone, approaches=(-0.01, 0.04), modulus=1.0)
    >>> z = np.linspace(-0.01, 0.03, 100)
    >>> force = 2 / np.pi / np.tan(np.radians(10)) * 5.0 * z.clip(0) ** 2
    >>> fit = asperity.fit_curve(z, force + np.random.default_rng(1).normal(scale=5e-5, size=100), tip=table)
    >>> fit.modulus.lower < 5.0 < fit.modulus.upper < 5.1
    True
    """

    def __init__(
        self,
        heights: Heights,
        lengths: Lengths | None = None,
        *,
        axes: AxisOrder | None = None,
        approaches: tuple[Quantity, Quantity],
        modulus: Quantity,
        law: str | OwnLaw | None = None,
        work_of_adhesion: Quantity | None = None,
        range: Quantity | None = None,
        body: Layer | Coating | None = None,
        works: int = 12,
        steps: int = 40,
    ) -> None:
        self._solved = SolvedTip(
            heights,
            lengths,
            axes=axes,
            approaches=approaches,
            modulus=modulus,
            law=law,
            work_of_adhesion=work_of_adhesion,
            range=range,
            body=body,
            works=works,
            steps=steps,
        )

    @property
    def ratio(self) -> float:
        return self._solved.ratio

    @property
    def error(self) -> float:
        return self._solved.error

    def __repr__(self) -> str:
        return repr(self._solved)


TipTable.__module__ = "asperity"
