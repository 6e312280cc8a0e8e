"""Force curves of tips: their files, their fits, and the equilibria of tips of any shape."""

from .fit import CurveFit, fit_curve
from .likelihood import Estimate, ModelFit
from .read import ForceCurve, read_curve
from .tip_table import TipTable

__all__ = ["CurveFit", "Estimate", "ForceCurve", "ModelFit", "TipTable", "fit_curve", "read_curve"]
