"""All inequalities along the way, on states alone and mixed ones, bounds of controls beside them included."""

from __future__ import annotations

from typing import Any

import sympy as sp

from satsym.symbolic.algebra import depends
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import symbols_of, t
from satsym.symbolic.principle.path import mixed_constraints, path_constraints


def every(so_far: Derivation) -> list[path_constraints.Constraint]:
    """Return all constraints along the way, first those on states alone."""
    return [*path_constraints.constraints(so_far), *mixed_constraints.constraints(so_far)]


def linear_quadratic(so_far: Derivation) -> bool:
    """Whether the motion is linear, costs are quadratic, and constraints along the way, if any, linear or quadratic.

    What is left to make the problem convex are signs of matrices, which depend on the parameters.
    """
    problem, found, states = so_far.problem, every(so_far), symbols_of(so_far.model.states)
    if problem is None or problem.interior:  # times that are free make none convex
        return False
    moving = (*states, *symbols_of(so_far.model.controls))

    def settled(expressions: list[Any], order: int) -> bool:
        """Whether derivatives of this order are free of states and controls."""
        table = [sp.sympify(e) for e in expressions]
        for _ in range(order):
            table = [sp.diff(e, v) for e in table for v in moving]
        varying = {*moving, t} if order > 1 else set(moving)  # weights are looked at once
        return not any(depends(e, varying) for e in table)

    return (
        settled(list(so_far.rhs("first_order")), 1)
        and settled(list(problem.end_conditions), 1)
        and settled([problem.running_cost, problem.terminal_cost], 2)
        and settled([one.rates[0] for one in found], 2)
    )
