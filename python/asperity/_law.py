"""What a report says of the adhesion, by the names of the tool."""

from __future__ import annotations

from typing import Any

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
    cut_off, varies = None, False
    while isinstance(law, (_asperity.CutOff, _asperity.Varying)):
        cut_off, varies = getattr(law, "distance", cut_off), varies or isinstance(law, _asperity.Varying)
        law = law.law
    own = not isinstance(law, _asperity.Law)
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


def _number(law: Any, name: str) -> float | None:
    value = getattr(law, name, None)
    return None if value is None else float(value)
