"""Reasoning with sympy: from declared physics and a cost to a derivation whose every step was checked."""

from satsym.spec import ModeGroup, Variable
from satsym.symbolic.derivation import Check, Conclusion, Derivation, DerivationError, Equation, Step
from satsym.symbolic.kinds.about_rest import AboutRest
from satsym.symbolic.kinds.bodies import CLOCK, moving
from satsym.symbolic.kinds.closed_loop import ClosedLoop
from satsym.symbolic.kinds.commanded import COMMAND, s
from satsym.symbolic.kinds.first_order import FirstOrder
from satsym.symbolic.kinds.gyrostat import Gyrostat, Motor
from satsym.symbolic.kinds.linearised import Linearised
from satsym.symbolic.kinds.multibody import Multibody
from satsym.symbolic.kinds.newton import Newton
from satsym.symbolic.kinds.reduced import Reduced
from satsym.symbolic.kinds.scaled import Scaled
from satsym.symbolic.model import Definition, Demand, Model, Output, Problem, symbols_of, t
from satsym.symbolic.notation import rate_of
from satsym.symbolic.pipeline import derive
from satsym.symbolic.sets import Angle, Annulus, Ball, Box, Free
from satsym.symbolic.time_limit import keep_short

__all__ = [
    "CLOCK",
    "COMMAND",
    "AboutRest",
    "Angle",
    "Annulus",
    "Ball",
    "Box",
    "Check",
    "ClosedLoop",
    "Conclusion",
    "Definition",
    "Demand",
    "Derivation",
    "DerivationError",
    "Equation",
    "FirstOrder",
    "Free",
    "Gyrostat",
    "Linearised",
    "ModeGroup",
    "Model",
    "Motor",
    "Multibody",
    "Newton",
    "Output",
    "Problem",
    "Reduced",
    "Scaled",
    "Step",
    "Variable",
    "derive",
    "moving",
    "rate_of",
    "s",
    "symbols_of",
    "t",
]

keep_short()
