"""Outputs to first order: C = g_x and D = g_u along any motion, or for a linear model at zero."""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.algebra import definitions_of, simplified, tidy
from satsym.symbolic.checks import first_order_at_zero
from satsym.symbolic.derivation import Derivation, Equation, Step
from satsym.symbolic.model import symbols_of
from satsym.symbolic.motion.jacobians import jacobians


def output_matrix(so_far: Derivation) -> Step | None:
    """C and D: the outputs differentiated by states and controls."""
    model = so_far.model
    if not model.outputs:
        return None
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    linear, constants = "deviations" in so_far, definitions_of(model)
    rest = dict.fromkeys((*states, *controls), sp.Integer(0)) if linear else {}
    values = [g.xreplace(constants) if linear else g for g in _outputs(so_far)]
    names = symbols_of(o.variable for o in model.outputs)
    equations, check = jacobians(values, names, {"C": states, "D": controls}, lambda e: tidy(simplified(e)), rest)
    rule = "differentiate outputs at zero" if linear else "differentiate outputs"
    sources = ("outputs", "original_states") if linear else ("outputs",)
    return Step("output_matrix", rule, equations, sources, (check,))


def output_equations(so_far: Derivation) -> Step | None:
    """The linear outputs y = C x + D u of a linear model."""
    model = so_far.model
    if "deviations" not in so_far or not model.outputs:
        return None
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    names = symbols_of(o.variable for o in model.outputs)
    entries = [e.rhs for e in so_far.step("output_matrix").equations]
    c = sp.Matrix(len(names), len(states), entries[: len(names) * len(states)])
    d = sp.Matrix(len(names), len(controls), entries[len(names) * len(states) :])
    found = c * sp.Matrix(states) + (d * sp.Matrix(controls) if controls else sp.zeros(len(names), 1))
    equations = tuple(Equation(y.name, y, value) for y, value in zip(names, found, strict=True))
    exact = [g.xreplace(definitions_of(model)) for g in _outputs(so_far)]
    check = first_order_at_zero("first order of the exact outputs", exact, list(found), (*states, *controls))
    return Step("output_equations", "drop higher orders of outputs", equations, ("output_matrix",), (check,))


def _outputs(so_far: Derivation) -> list[sp.Expr]:
    """What is measured, as functions of the model's own states and controls."""
    values = [sp.sympify(o.value) for o in so_far.model.outputs]
    if "original_states" not in so_far:
        return values
    inverse = {e.lhs: e.rhs for e in so_far.step("original_states").equations}
    return [g.xreplace(inverse) for g in values]
