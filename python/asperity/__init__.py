"""Computes how rough surfaces touch and stick: frictionless normal contact with adhesion, with a certified error.

>>> import asperity
>>> rough = asperity.surface.self_affine(128, 1.0, rms_slope=0.1, k_s=16, seed=1)
>>> law = asperity.Exponential(work_of_adhesion=1e-5, range=4e-3)
>>> solution = asperity.solve(rough, modulus=1.0, mean_pressure=0.01, law=law)
>>> solution.converged
True

Fields have shape (Nx, Ny), with x along the first axis. Units may be any consistent ones, and compression is positive.
Results do not depend on the number of threads. The interpreter's lock is free during a solve.
"""

import sys

from . import contact, exact, surface
from ._asperity import VERSION as __version__
from ._asperity import Iteration, Law, check_law
from .answers.numbers import Report
from .answers.cycle import Cycle, CycleLimit, Step
from .answers.findings import (
    Conductance,
    Constriction,
    ContactStatistics,
    Percolation,
    Plan,
    PressureDistribution,
    Stability,
)
from .answers.folder import load, report
from .answers.interface import Interface
from .answers.leakage import Flow, Leakage, leakage
from .answers.pull_off import PullOff
from .answers.solution import Solution
from .answers.sweep import Sweep
from .api.contact import Contact
from .api.loading import pull_off, viscoelastic
from .api.solve import solve, stability
from .api.tables import cycle, interface, sweep
from .bodies.body import Coating, Layer, Symbol
from .bodies.wall import Penalty, Uzawa
from .common.progress import progress
from .common.types import OwnLaw
from .common.warnings import AccuracyWarning, ConvergenceWarning, InputWarning
from .curves import CurveFit, CurveMap, Estimate, ForceCurve, ModelFit, TipTable, fit_curve, fit_curves, read_curve
from .laws.composite import CutOff, Varying
from .laws.formulas import JKR, Exponential, LennardJones, MaugisDugdale, Morse, PowerLaw, VanDerWaals
from .laws.tabulated import Tabulated
from .maps.files import read
from .maps.packages import from_topography
from .maps.pair import contact_modulus
from .maps.prepare import prepare
from .maps.topography import Topography
from .relaxation.viscoelastic import Moment, Viscoelastic

__all__ = [
    "AccuracyWarning",
    "Coating",
    "Conductance",
    "Constriction",
    "Contact",
    "ContactStatistics",
    "ConvergenceWarning",
    "CurveFit",
    "CurveMap",
    "CutOff",
    "Cycle",
    "CycleLimit",
    "Estimate",
    "Exponential",
    "Flow",
    "ForceCurve",
    "InputWarning",
    "Interface",
    "Iteration",
    "JKR",
    "Law",
    "Layer",
    "Leakage",
    "LennardJones",
    "MaugisDugdale",
    "ModelFit",
    "Moment",
    "Morse",
    "OwnLaw",
    "Penalty",
    "Percolation",
    "Plan",
    "PowerLaw",
    "PressureDistribution",
    "PullOff",
    "Report",
    "Solution",
    "Stability",
    "Step",
    "Sweep",
    "Symbol",
    "Tabulated",
    "TipTable",
    "Topography",
    "Uzawa",
    "VanDerWaals",
    "Varying",
    "Viscoelastic",
    "__version__",
    "check_law",
    "contact",
    "contact_modulus",
    "cycle",
    "exact",
    "fit_curve",
    "fit_curves",
    "from_topography",
    "interface",
    "leakage",
    "load",
    "prepare",
    "progress",
    "pull_off",
    "read",
    "read_curve",
    "report",
    "solve",
    "stability",
    "surface",
    "sweep",
    "viscoelastic",
]


def __dir__() -> list[str]:
    """The names that are meant, and no modules that are used here."""
    return __all__


# modules by which pickles of earlier versions name the classes
sys.modules.update(
    {
        f"{__name__}.{name}": sys.modules[f"{__name__}.{place}"]
        for name, place in {
            "_accuracy": "answers.findings",
            "_body": "bodies.body",
            "_contact": "answers.posed",
            "_cycle": "answers.cycle",
            "_flow": "answers.leakage",
            "_interface": "answers.interface",
            "_progress": "common.progress",
            "_pull_off": "answers.pull_off",
            "_solution": "answers.solution",
            "_stability": "answers.findings",
            "_sweep": "answers.sweep",
            "_theory": "exact.theory",
            "_topography": "maps.topography",
            "_viscoelastic": "relaxation.viscoelastic",
            "_wall": "bodies.wall",
            "_warnings": "common.warnings",
            "curves.maps": "curves.curve_map",
            "curves.read": "curves.files.read",
        }.items()
    }
)
