"""Reasoning with sympy: from declared physics and a cost to a derivation whose every step was checked."""

from satsym.spec import Variable
from satsym.symbolic.derivation import Check, Conclusion, Derivation, DerivationError, Equation, Step
from satsym.symbolic.kinds.rotation_models import COMMAND, ClosedLoop, Gyrostat, Motor, Reduced, Scaled, s
from satsym.symbolic.model import Definition, FirstOrder, Linearised, Model, Newton, Output, Problem, symbols_of, t
from satsym.symbolic.notation import rate_of
from satsym.symbolic.pipeline import derive

__all__ = [
    "COMMAND",
    "Check",
    "ClosedLoop",
    "Conclusion",
    "Definition",
    "Derivation",
    "DerivationError",
    "Equation",
    "FirstOrder",
    "Gyrostat",
    "Linearised",
    "Model",
    "Motor",
    "Newton",
    "Output",
    "Problem",
    "Reduced",
    "Scaled",
    "Step",
    "Variable",
    "derive",
    "rate_of",
    "s",
    "symbols_of",
    "t",
]
