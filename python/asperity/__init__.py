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

from . import _laws, contact, exact, surface
from ._accuracy import Plan
from ._asperity import VERSION as __version__
from ._asperity import Iteration, Law, check_law
from ._body import Coating, Layer, Symbol
from ._contact import Contact, cycle, interface, pull_off, solve, stability, sweep, viscoelastic
from ._cycle import Cycle, CycleLimit, Step
from ._flow import Flow, Leakage, leakage
from ._folder import load, report
from ._interface import Interface
from ._laws import *
from ._laws import CutOff, Tabulated, Varying
from ._pair import contact_modulus
from ._prepare import prepare
from ._progress import progress
from ._pull_off import PullOff
from ._solution import (
    Conductance,
    Constriction,
    ContactStatistics,
    Percolation,
    PressureDistribution,
    Solution,
)
from ._stability import Stability
from ._sweep import Sweep
from ._topography import Topography, from_topography, read
from ._types import OwnLaw, Report
from ._viscoelastic import Moment, Viscoelastic
from ._wall import Penalty, Uzawa
from ._warnings import AccuracyWarning, ConvergenceWarning, InputWarning
from .curves import CurveFit, CurveMap, Estimate, ForceCurve, ModelFit, TipTable, fit_curve, fit_curves, read_curve

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
    "Flow",
    "ForceCurve",
    "InputWarning",
    "Interface",
    "Iteration",
    "Law",
    "Layer",
    "Leakage",
    "ModelFit",
    "Moment",
    "OwnLaw",
    "Penalty",
    "Percolation",
    "Plan",
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
__all__ += _laws.__all__
