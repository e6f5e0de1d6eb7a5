"""Boundaries of path constraints where H is linear in the controls: what keeps to them, and what is refused.

On the boundary a control is where the constraint keeps it, as a rule between its bounds; as it minimises H there, its
switching function vanishes all along, and the multiplier of the constraint is what keeps it zero (Maurer, On optimal
control problems with bounded state variables and control appearing linearly, SIAM Journal on Control and Optimization
15, 1977). Order, multiplier, costates and junctions are as in :mod:`satsym.symbolic.principle.path.path_constraints`.
"""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.algebra import simplified, tidy
from satsym.symbolic.checks import identity
from satsym.symbolic.derivation import Derivation, DerivationError, Equation, Step
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle.path import notation as pn
from satsym.symbolic.principle.path.path_constraints import STEP, acting, affine, constraints
from satsym.symbolic.switching import notation as s


def boundary_control(so_far: Derivation) -> Step | None:
    """The control that keeps g^(q) = 0."""
    if STEP not in so_far:
        return None
    controls, equations, checks = symbols_of(so_far.model.controls), list[Equation](), []
    for found in constraints(so_far):
        effect, rest = affine(so_far, found, controls)
        u = acting(so_far, found)
        law = tidy(simplified(-rest / effect[controls.index(u)]))
        equations.append(Equation(f"{found.name}_{u.name}", pn.boundary_control(found.name, u), law))
        checks.append(identity("keeps the constraint", [found.rates[-1].xreplace({u: law})]))
    return Step("boundary_control", "stay on the boundary", tuple(equations), (STEP,), tuple(checks))


def refuse(so_far: Derivation) -> None:
    """Refuse what no boundary control is derived for, before anything is.

    Raises
    ------
    DerivationError
        If a constraint holds a control that switches, or magnitudes of controls cost something or move something.
    """
    problem = so_far.problem
    assert problem is not None
    controls, what = symbols_of(problem.model.controls), f"{problem.name}: path_constraints"
    held = [name for name, g in problem.path_constraints.items() if sp.sympify(g).free_symbols & set(controls)]
    if held:
        message = f"{what} {held[0]}: H is linear in the controls, beside which a constraint that holds one is not "
        raise DerivationError(
            f"{message}derived; state the constraint as a bound of that control", ("path_constraints",)
        )
    stated = sp.Tuple(problem.running_cost, *so_far.rhs("first_order"))
    if problem.path_constraints and any(stated.has(a) for a in s.magnitudes(controls)):
        message = "beside |u| they are not derived; use two controls, one for each sign, both with the lower bound 0"
        raise DerivationError(f"{what}: {message}", ("path_constraints", "running_cost"))
