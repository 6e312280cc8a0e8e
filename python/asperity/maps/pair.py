"""Two bodies: their contact modulus."""

from __future__ import annotations

from typing import overload

from .. import _asperity
from ..common.types import Quantity
from ..common.units import in_si, number
from ..common.words import suggests


@overload
def contact_modulus(
    young: float, poisson: float, other_young: float | None = None, other_poisson: float | None = None
) -> float: ...
@overload
def contact_modulus(
    young: str, poisson: float, other_young: str | None = None, other_poisson: float | None = None
) -> str: ...
@suggests
def contact_modulus(
    young: Quantity,
    poisson: float,
    other_young: Quantity | None = None,
    other_poisson: float | None = None,
) -> Quantity:
    """Contact modulus E* = E/(1 − ν²) of an elastic body, or of two: 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂.

    Parameters
    ----------
    young : float
        Young's modulus E, a pressure.
    poisson : float
        Poisson's ratio ν, greater than -1 and at most 0.5.
    other_young, other_poisson : float, optional
        Modulus and ratio of a second body, which is rigid without them.

    Returns
    -------
    float
        In the unit of Young's modulus; a string in Pa if that is a string with a unit, as ``modulus`` accepts it.

    Raises
    ------
    ValueError, TypeError
        For moduli that are not positive, other ratios, or one parameter of the second body without the other.

    Examples
    --------
    >>> import asperity
    >>> f"{asperity.contact_modulus(210e9, 0.3):.4g}"
    '2.308e+11'
    >>> asperity.contact_modulus("3GPa", 0.5, "6GPa", 0.0)
    '2400000000.0Pa'
    """
    if (other_young is None) != (other_poisson is None):
        raise TypeError("a second body has two parameters: give other_young and other_poisson, or neither")
    young, other_young, is_si = in_si(young=young, other_young=other_young)
    bodies = [(number("young", young), number("poisson", poisson))]
    if other_young is not None:
        bodies.append((number("other_young", other_young), number("other_poisson", other_poisson)))
    modulus = _asperity.contact_modulus(bodies)
    return f"{modulus!r}Pa" if is_si else modulus
