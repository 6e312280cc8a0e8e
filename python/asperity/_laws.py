"""The laws that are formulas, as `tests/test_stub.py` writes them."""

from ._asperity import Exponential, JKR, LennardJones, MaugisDugdale, Morse, PowerLaw, VanDerWaals

__all__ = ["Exponential", "JKR", "LennardJones", "MaugisDugdale", "Morse", "PowerLaw", "VanDerWaals"]
