"""Force curves of tips: their files, their fits, and the equilibria of tips of any shape."""

from .curve_map import CurveMap, fit_curves
from .files.read import ForceCurve, read_curve
from .fit import CurveFit, fit_curve
from .likelihood import Estimate, ModelFit
from .tip_table import TipTable

__all__ = [
    "CurveFit",
    "CurveMap",
    "Estimate",
    "ForceCurve",
    "ModelFit",
    "TipTable",
    "fit_curve",
    "fit_curves",
    "read_curve",
]
