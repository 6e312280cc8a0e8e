"""The adhesion law of a table."""

from __future__ import annotations

import os
from typing import cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _asperity
from .law import ParameterLaw


class Tabulated(ParameterLaw):
    """A law with a traction that is a monotone cubic through the points of a table.

    Parameters
    ----------
    gaps : array_like, shape (N,)
        Gaps, lengths that rise from zero.
    tractions : array_like, shape (N,)
        Tractions, attraction positive; the last one is zero.
    source : str, optional
        File that they come from, as `read` sets it.

    Examples
    --------
    >>> import asperity
    >>> law = asperity.Tabulated([0.0, 1e-9, 2e-9], [50e6, 25e6, 0.0])
    >>> f"{-law.energy(0.0):.3f}"
    '0.050'
    """

    __module__ = "asperity"
    __match_args__ = ("gaps", "tractions", "source")

    def __new__(cls, gaps: ArrayLike, tractions: ArrayLike, source: str | None = None) -> Tabulated:
        return cls._from(*_asperity.tabulated(gaps, tractions, source))

    @property
    def gaps(self) -> NDArray[np.float64]:
        """Gaps of the table, shape (N,), lengths."""
        return cast("NDArray[np.float64]", self._values[0])

    @property
    def tractions(self) -> NDArray[np.float64]:
        """Tractions of the table, shape (N,), attraction positive."""
        return cast("NDArray[np.float64]", self._values[1])

    @property
    def source(self) -> str | None:
        """File of the table, if it comes from one."""
        return cast("str | None", self._values[2])

    @staticmethod
    def read(path: str | os.PathLike[str]) -> Tabulated:
        """The law of a file with a gap and a traction on each line.

        Parameters
        ----------
        path : str or path
            A text of two columns, or ``.npy``.
        """
        return Tabulated._from(*_asperity.read_law(path))
