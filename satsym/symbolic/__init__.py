"""Reasoning with sympy: from declared physics and a cost to a derivation whose every step was checked."""

from satsym.spec import Variable
from satsym.symbolic.derivation import Check, Conclusion, Derivation, DerivationError, Equation, Step
from satsym.symbolic.model import Definition, FirstOrder, Linearised, Model, Newton, Output, Problem, symbols_of, t
from satsym.symbolic.pipeline import derive

__all__ = [
    "Check",
    "Conclusion",
    "Definition",
    "Derivation",
    "DerivationError",
    "Equation",
    "FirstOrder",
    "Linearised",
    "Model",
    "Newton",
    "Output",
    "Problem",
    "Step",
    "Variable",
    "derive",
    "symbols_of",
    "t",
]
