"""Controls without closed form, which stay symbols at which H_u, or H_u with a constraint adjoined, vanishes.

Steps on path constraints contain these symbols, and their rates where they differentiate along an extremal. Their
numbers are found by Newton's method where expressions are evaluated.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import sympy as sp

from satsym.symbolic.algebra import gradient, tidy
from satsym.symbolic.checks import Check, Point, compare, numeric, partial
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Derivation, DerivationError, Equation, Step
from satsym.symbolic.functions.roots import Argmin, Vertex
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle.branches import Minimum
from satsym.symbolic.principle.path import notation as pn
from satsym.symbolic.principle.path import path_constraints as states


def refuse_jumping(name: str, every: Sequence[Minimum]) -> None:
    """Refuse path constraints beside controls that may jump, or at which H_u does not vanish.

    Raises
    ------
    DerivationError
        At the first set of such.
    """
    for one in every:
        controls = ", ".join(u.name for u in one.part.symbols)
        if one.part.kind not in ("free", "box", "angle"):
            message = (
                f"bounds on the norm of {controls} are not supported together with path constraints; use a box or an "
                "angle"
            )
        elif one.branch in ("switched", "throttled"):
            message = (
                f"H is linear in {controls}; path constraints are derived only where H has a strict minimum in all "
                "controls"
            )
        elif any(law.has(Vertex, Argmin) for law in one.laws):
            message = (
                f"H is not always convex in {controls}, which may therefore jump; path constraints are derived only "
                "where H is convex"
            )
        else:
            continue
        raise DerivationError(f"{name}: path_constraints: {message}", ("path_constraints",))


def control_rates(so_far: Derivation) -> Step | None:
    """Derive the rates of the controls on the boundary of each constraint on states alone."""
    if states.STEP not in so_far or not states.stationary(so_far):
        return None
    controls, h = symbols_of(so_far.model.controls), so_far.equation("hamiltonian.H").rhs
    equations, checks = list[Equation](), list[Check]()
    for found in states.constraints(so_far):
        moving = states.canonical(so_far, found)
        equations += [Equation(f"{found.name}_{u.name}", pn.control_rate(found.name, u), moving[u]) for u in controls]
        checks += [states.rates_along((slope, sp.Integer(0)), moving) for slope in gradient(h, controls)]
    sources = (states.STEP, "control_law", "costate_equations")
    return Step("control_rates", "differentiate stationarity along", tuple(equations), sources, tuple(checks))


def conditions(so_far: Derivation, name: str, g: sp.Expr) -> tuple[list[Equation], Check]:
    """Return what vanishes while a mixed constraint is active: derivatives of H with it adjoined, by the controls.

    Together with the constraint itself they determine controls and multiplier.
    """
    controls, h = symbols_of(so_far.model.controls), so_far.equation("hamiltonian.H").rhs
    whole = h + sign(states.problem_of(so_far)) * pn.multiplier(name) * g
    slopes = [tidy(slope, controls) for slope in gradient(whole, controls)]
    value, derived = numeric([whole]), numeric(slopes)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        return derived(point), [partial(value, point, u)[0] for u in controls]

    equations = [Equation(f"{name}_{u.name}", sp.Integer(0), slope) for u, slope in zip(controls, slopes, strict=True)]
    return equations, compare("numeric derivative", whole.free_symbols | {*controls}, sides)


def mixed(so_far: Derivation, stated: dict[str, sp.Expr], step: str) -> Step:
    """Derive the step of all constraints that contain controls."""
    equations, checks = list[Equation](), []
    for name, g in stated.items():
        found, check = conditions(so_far, name, g)
        equations += [Equation(name, pn.rate(name, 0), g), *found]
        checks.append(check)
    rule = worded("hold by stationarity", states.problem_of(so_far))
    return Step(step, rule, tuple(equations), ("hamiltonian",), tuple(checks))
