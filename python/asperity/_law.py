"""What a report says of the adhesion, by the names of the tool."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _asperity

_NAMES: dict[type, str] = {
    _asperity.Exponential: "exponential",
    _asperity.LennardJones: "lennard-jones",
    _asperity.MaugisDugdale: "maugis-dugdale",
    _asperity.Morse: "morse",
    _asperity.PowerLaw: "power",
    _asperity.Tabulated: "table",
    _asperity.VanDerWaals: "van-der-waals",
}


def entries(law: Any, wall: str) -> dict[str, Any]:
    """The law with its parameters, where it varies, and the wall; an object of one's own goes by its class."""
    law, cut_off, works = _unwrapped(law)
    varies, own = works is not None, not isinstance(law, _asperity.Law)
    table = isinstance(law, _asperity.Tabulated)
    return {
        "law": "none" if law is None else _NAMES.get(type(law), type(law).__name__),
        "work_of_adhesion": None if varies else _number(law, "work_of_adhesion"),
        "range": _number(law, "range"),
        "exponent": None if own else _number(law, "exponent"),
        "hamaker": None if own else _number(law, "hamaker"),
        "law_table": law.source or "array" if table else None,
        "cut_off": cut_off,
        "work_of_adhesion_map": "array" if varies else None,
        "wall": wall,
    }


def fields(law: Any) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | None, bool]:
    """Gaps and tractions and the works of adhesion of a law, and whether it may differ from others of its name."""
    law, _, works = _unwrapped(law)
    table = np.column_stack([law.gaps, law.tractions]) if isinstance(law, _asperity.Tabulated) else None
    own = law is not None and not isinstance(law, _asperity.Law)
    if works is None:
        return table, None, own
    # the law that varies may be one of another work of adhesion than the largest
    return table, np.atleast_2d(works), own or getattr(law, "work_of_adhesion", None) != np.max(works)


def _unwrapped(law: Any) -> tuple[Any, float | None, Any]:
    """The law of which a law that ends or varies is made, the gap at which it ends, and its works of adhesion."""
    cut_off, works = None, None
    while isinstance(law, (_asperity.CutOff, _asperity.Varying)):
        if isinstance(law, _asperity.Varying):
            works = law.work_of_adhesion
        else:
            cut_off = law.distance
        law = law.law
    return law, cut_off, works


def _number(law: Any, name: str) -> float | None:
    value = getattr(law, name, None)
    return None if value is None else float(value)
