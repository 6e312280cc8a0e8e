"""Elastic bodies that are no half-space."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, TypeAlias

from numpy.typing import ArrayLike

from ..common.types import Quantity
from .parameters import Parameters


@dataclass(frozen=True)
class Layer(Parameters):
    """An elastic layer on a rigid base, instead of a half-space; ``modulus`` is its contact modulus E*.

    A layer that is thick compared with the wavelength acts like a half-space. A thin one acts like springs of stiffness
    M/t, with M = E*(1 − ν)²/(1 − 2ν), or of stiffness E*/t if it slides. A thin bonded layer of ν = ½ is
    incompressible, and has to flow sideways. The boundary is periodic.

    Parameters
    ----------
    thickness : float
        Thickness t of the layer, a length.
    poisson : float
        Poisson's ratio ν, greater than -1 and at most 0.5.
    base : {"bonded", "sliding"}
        Whether the layer is bonded to its base, or slides on it without friction.

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
    def keys(self) -> dict[str, Any]:
        """Its keys, with their values as they were typed."""
        return {**super().keys, "base": self.base}


@dataclass(frozen=True)
class Coating(Parameters):
    """An elastic coating that is bonded to a half-space; ``modulus`` of the solve is the half-space's E*.

    Waves that are short compared with the thickness have the stiffness of the coating, and long ones the stiffness of
    the substrate. The boundary is periodic.

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


class Symbol:
    """An elastic body by the stiffness of its waves, a function of your own.

    A wave of the displacement u cos(qx·x + qy·y) of the surface needs the pressure k u cos(qx·x + qy·y), and k is what
    the function returns: ½E*q of a half-space. The function also sets the scale of the stiffness, so that ``modulus``
    only converts a ``reduced_pressure``. Measures of the grid use the modulus 2k/q of the shortest waves. The boundary
    is periodic.

    Parameters
    ----------
    function : callable
        ``function(q)`` of the wave number q = √(qx² + qy²), or ``function(qx, qy)`` of a body that differs with the
        direction; the number of its parameters without a default decides which. It is given arrays of float64, in
        radians per length, 2π over the wavelength, of the waves of a grid, up to a million at once, and returns the
        stiffnesses k > 0, real and a pressure per length, as an array of the same shape: in the units of the call, Pa/m
        where it has units. A body of two directions has k(−qx, −qy) = k(qx, qy). It is not asked for q = 0.

    Examples
    --------
    A half-space of the modulus 1 that is held by springs, too:

    >>> import asperity
    >>> rough = asperity.surface.self_affine(64, 1.0, rms_slope=0.1, k_s=8, seed=1)
    >>> held = asperity.Symbol(lambda q: 1.0 + 0.5 * q)
    >>> asperity.solve(rough, modulus=1.0, mean_pressure=0.02, body=held).converged
    True

    One that is stiffer along x:

    >>> fibres = asperity.Symbol(lambda qx, qy: 0.5 * (4 * qx**2 + qy**2) ** 0.5)
    >>> asperity.solve(rough, modulus=1.5, mean_pressure=0.02, body=fibres).converged
    True
    """

    def __init__(self, function: Callable[..., ArrayLike]) -> None:
        self.function = function
        self._is_isotropic = _count_parameters(function) == 1

    def __repr__(self) -> str:
        return f"Symbol({self._name})"

    @property
    def _name(self) -> str:
        return str(getattr(self.function, "__name__", type(self.function).__name__))


def _count_parameters(function: Any) -> int:
    """The number of parameters of a function of q, or of qx and qy."""
    if not callable(function):
        raise TypeError(f"function is {function!r}: it must be a function of q, or of qx and qy")
    try:
        known: Iterable[inspect.Parameter] = inspect.signature(function).parameters.values()
    except ValueError:
        # a function of C that does not tell
        known = ()
    count = sum(p.default is p.empty and p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD) for p in known)
    if count not in (1, 2):
        raise TypeError(
            f"function has {count} parameters without a default: it must have one, q, or two, qx and qy: write "
            "lambda q: ..., or lambda qx, qy: ..."
        )
    return count


#: An elastic body as functions take it; a half-space is none of these.
Body: TypeAlias = Layer | Coating | Symbol


def symbol(body: Body | None) -> tuple[Callable[..., ArrayLike], str, bool] | None:
    """The function of a body of one's own, its name, and whether it is one of q alone."""
    return (body.function, body._name, body._is_isotropic) if isinstance(body, Symbol) else None
