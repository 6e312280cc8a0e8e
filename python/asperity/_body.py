"""Elastic bodies that are no half-space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, Literal, TypeAlias

from ._measured import Measured
from ._types import Quantity


@dataclass(frozen=True)
class Layer(Measured):
    """An elastic layer on a rigid base, in the place of a half-space; ``modulus`` is its contact modulus E*.

    A thick layer is the half-space. A thin one is springs of stiffness M/t, or E*/t if it slides, with
    M = E*(1 − ν)²/(1 − 2ν); a bonded one of ν = ½ has to flow sideways. The boundary is periodic.

    Parameters
    ----------
    thickness : float
        Thickness t of the layer, a length.
    poisson : float
        Poisson's ratio ν, greater than -1 and at most 0.5.
    base : {"bonded", "sliding"}
        Hold of the base: the layer does not move on it, or slides without friction.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> soft = asperity.solve(rough, modulus=1.0, mean_pressure=0.02)
    >>> thin = asperity.solve(rough, modulus=1.0, mean_pressure=0.02, body=asperity.Layer(0.1, poisson=0.5))
    >>> thin.contact_fraction < soft.contact_fraction
    True
    """

    thickness: Quantity
    poisson: float
    base: Literal["bonded", "sliding"] = "bonded"

    _keys: ClassVar[dict[str, str]] = {"thickness": "layer", "poisson": "poisson"}

    @property
    def _parameters(self) -> dict[str, Any]:
        return {"layer": self.thickness, "poisson": self.poisson, "base": self.base}


@dataclass(frozen=True)
class Coating(Measured):
    """An elastic coating that is bonded to a half-space, whose contact modulus E* is ``modulus``.

    Waves that are short beside the thickness have the stiffness of the coating, long ones that of the substrate. The
    boundary is periodic.

    Parameters
    ----------
    thickness : float
        Thickness t of the coating, a length.
    modulus : float
        Contact modulus E/(1 − ν²) of the coating, a pressure.
    poisson : float
        Poisson's ratio of the coating, greater than -1 and at most 0.5.
    substrate_poisson : float
        Poisson's ratio of the half-space under it.

    Examples
    --------
    >>> import asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> bare = asperity.solve(rough, modulus=1.0, mean_pressure=0.02)
    >>> hard = asperity.Coating(0.05, modulus=10.0, poisson=0.2, substrate_poisson=0.3)
    >>> asperity.solve(rough, modulus=1.0, mean_pressure=0.02, body=hard).contact_fraction < bare.contact_fraction
    True
    """

    thickness: Quantity
    modulus: Quantity
    poisson: float
    substrate_poisson: float

    _keys: ClassVar[dict[str, str]] = {
        "thickness": "coating",
        "modulus": "coating_modulus",
        "poisson": "coating_poisson",
        "substrate_poisson": "poisson",
    }

    @property
    def _parameters(self) -> dict[str, Any]:
        return {key: getattr(self, name) for name, key in self._keys.items()}


#: An elastic body as functions take it; a half-space is none of these.
Body: TypeAlias = Layer | Coating


def parameters(body: Body | None) -> dict[str, Any]:
    """The parameters of a body by the keys of reports."""
    return {} if body is None else body._parameters


def of(report: Any) -> Body | None:
    """The body of a report."""
    if report["layer"] is not None:
        return Layer(report["layer"], report["poisson"], report["base"] or "bonded")
    if report["coating"] is not None:
        return Coating(report["coating"], report["coating_modulus"], report["coating_poisson"], report["poisson"])
    return None
