"""Expressions that derivations refuse: values at other times, unknown functions, integrals, conditions on states."""

from __future__ import annotations

from collections.abc import Collection

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.logic.boolalg import Boolean

from satsym.symbolic.functions.minimisers import MINIMISERS
from satsym.symbolic.functions.pieces import CORNERS
from satsym.symbolic.model import t

FUNCTIONS = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "exp", "log", "Abs")
"""Functions that derivations may use, by their sympy names."""

_KNOWN = {*FUNCTIONS, *(kind.__name__ for kind in (*CORNERS, *MINIMISERS))}


def unknown_functions(e: sp.Basic) -> list[str]:
    """Return the sympy names of functions in an expression that derivations may not use, in alphabetical order."""
    return sorted({f.func.__name__ for f in e.atoms(sp.Function)} - _KNOWN)


def complaint(e: sp.Basic, moving: Collection[sp.Symbol], magnitudes: Collection[sp.Expr]) -> str:
    """Describe what is wrong with an expression and what to do about it; empty if nothing is.

    Parameters
    ----------
    moving
        States and controls.
    magnitudes
        Those of controls, which have their own place in a law.
    """
    if isinstance(e, Boolean) and not e.is_Symbol:
        return (
            f"is the condition {e}, but must be a number; a condition on time alone can be written as "
            "Piecewise((1, ...), (0, True))"
        )
    names = {s.name for s in moving}
    if found := _first(e, sp.Derivative, sp.Subs):
        return (
            f"contains {found}, an unevaluated derivative; introduce a state for each rate, and differentiate known "
            "functions with diff"
        )
    if found := _first(e, sp.Integral, sp.Sum, sp.Product):
        return f"contains {found}, which has no closed form; add a state whose rate is the integrand"
    if found := _first(e, AppliedUndef):
        return _unknown(found, names)
    if other := unknown_functions(e):
        return (
            f"contains the function {other[0]}, which is not supported; the supported functions are "
            f"{', '.join(FUNCTIONS)} and sqrt"
        )
    corners = [c for c in sorted(e.atoms(*CORNERS), key=str) if c not in magnitudes]
    if jumping := [c for c in corners if c.free_symbols & set(moving)]:
        return (
            f"contains {jumping[0]}, whose derivatives jump; use a smooth expression, such as sqrt(v**2 + h**2) with "
            "a small h in place of Abs(v)"
        )
    if open_ended := [c for c in corners if t in c.free_symbols or isinstance(c, sp.Piecewise)]:
        return (
            f"contains {open_ended[0]}, whose conditions do not cover all times; use < and >, and end the "
            "Piecewise with (value, True)"
        )
    return ""


def _first(e: sp.Basic, *kinds: type) -> sp.Basic | None:
    return min(e.atoms(*kinds), key=str, default=None)


def _unknown(found: sp.Basic, moving: Collection[str]) -> str:
    """Describe what is wrong with a function that nobody defined."""
    name = found.func.__name__
    if name not in moving:
        return (
            f"contains {found}, an unknown function; define it with functions such as sin and exp, or, if it "
            "depends on time alone, by a table: interpolating_spline(3, t, times, values)"
        )
    if found.args == (t,):
        return f"contains {found}; write {name}, the symbol of the state or control, without the argument time"
    return f"contains {found}, a value at another time; delays are not supported: write the motion without delays"
