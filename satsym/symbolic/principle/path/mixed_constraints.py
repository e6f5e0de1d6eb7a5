"""Path constraints g(x, u, t, p) <= 0 that are linear in the controls: the law on the boundary, and its multiplier.

H is minimised over the controls that satisfy the constraint. Where the law without the constraint satisfies it, that is
the law; else the constraint is active, and with H + mu g the conditions g = 0 and H_u + mu g_u = 0 give controls and mu
>= 0 (Hartl, Sethi and Vickson, SIAM Review 37, 1995, theorem 4.1). Nothing jumps at entry and exit, where mu vanishes.
One constraint is active at a time.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import sympy as sp

from satsym.symbolic.algebra import depends, simplified, simplify, tidy, total_derivative
from satsym.symbolic.checks import Check, Point, identity, never_below, numeric
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Conclusion, Derivation, Equation, Step
from satsym.symbolic.model import symbols_of, t
from satsym.symbolic.notation import rate_of
from satsym.symbolic.principle.path import notation as pn
from satsym.symbolic.principle.path import path_constraints, stationary_controls
from satsym.symbolic.principle.path.path_constraints import (
    COMPETITORS,
    Constraint,
    adjoined,
    affine,
    free_law,
    motion_of,
    problem_of,
    stationary,
    switching,
)
from satsym.symbolic.principle.pontryagin import costates

STEP = "mixed_constraints"
"""Name of the step that occurs only in derivations with constraints on controls."""


def mixed_constraints(so_far: Derivation) -> Step | None:
    """Derive for each constraint when it is active, and then the controls and the multiplier."""
    problem = problem_of(so_far)
    if not (stated := pn.mixed(problem)):
        return None
    if stationary(so_far):
        return replace(stationary_controls.mixed(so_far, stated, STEP), conclusions=remarks(so_far, stated))
    controls, h = symbols_of(so_far.model.controls), so_far.equation("hamiltonian.H").rhs
    equations, checks = list[Equation](), []
    slopes, weight = sp.Matrix([h]).jacobian(controls).T, sp.hessian(h, controls).applyfunc(simplify)
    hats = free_law(so_far)
    for name, g in stated.items():
        found = Constraint(name, (g,))
        effect, _ = affine(so_far, found, controls)
        turned = weight.LUsolve(effect)
        missed, unit = tidy(simplified(found.rates[0].xreplace(hats))), (effect.T * turned)[0]
        value = tidy(simplified(sign(problem) * missed / unit))
        laws = {u: tidy(simplified(hats[u] - turned[k] * missed / unit)) for k, u in enumerate(controls)}
        equations += [
            Equation(name, pn.rate(name, 0), found.rates[0]),
            Equation(pn.vanishing_entry(name, 0), pn.vanishing(name, 0), missed),
            *(Equation(f"{name}_{u.name}", pn.boundary_control(name, u), law) for u, law in laws.items()),
            Equation(f"{name}_eta", pn.multiplier(name), value),
        ]
        conditions = [found.rates[0], *(slopes + sign(problem) * value * effect)]
        checks.append(identity("active with a stationary control", [e.xreplace(laws) for e in conditions]))
        parted = [hats[u] - laws[u] - sign(problem) * value * turned[k] for k, u in enumerate(controls)]
        checks.append(identity("enters and leaves without a jump", parted))
        checks.append(_cheapest(so_far, found, laws))
    rule = worded("keep what holds a control", problem)
    sources = ("hamiltonian", "stationarity")
    return Step(STEP, rule, tuple(equations), sources, tuple(checks), remarks(so_far, stated))


def remarks(so_far: Derivation, stated: Mapping[str, sp.Expr]) -> tuple[Conclusion, ...]:
    """Return remarks on constraints that are bounds of the controls, or leave the costate equations unchanged."""
    problem, states = problem_of(so_far), symbols_of(so_far.model.states)
    bounds = [pn.rate(name, 0) for name in stated if name not in problem.path_constraints]
    still = [pn.rate(name, 0) for name, g in stated.items() if not g.has(*states)]
    said = (("bound among constraints", "bounds", bounds), ("no state in constraints", "constraints", still))
    return tuple(Conclusion(key, {place: sp.Tuple(*found)}) for key, place, found in said if found)


def mixed_costates(so_far: Derivation) -> Step | None:
    """Derive the costate equations while each constraint is active."""
    if STEP not in so_far:
        return None
    problem, states, lam = problem_of(so_far), symbols_of(so_far.model.states), costates(so_far)
    h, equations, checks, drifts = so_far.equation("hamiltonian.H").rhs, list[Equation](), [], []
    with_states = [found for found in constraints(so_far) if found.rates[0].has(*states)]
    if not with_states:
        return None
    for found in with_states:
        laws, value = _active(so_far, found)
        eta, g = pn.multiplier(found.name), found.rates[0]
        whole = h.xreplace(laws) if laws else h + sign(problem) * eta * g  # in whose controls that is least
        pushed = [
            tidy(rate - sign(problem) * eta * sp.diff(g, x), lam)
            for x, rate in zip(states, so_far.rhs("costate_equations"), strict=True)
        ]
        equations += [
            Equation(f"{found.name}_{costate.name}", rate_of(costate), rate)
            for costate, rate in zip(lam, pushed, strict=True)
        ]
        checks.append(adjoined(so_far, found, pushed, laws))
        moving = {x: rate.xreplace(laws) for x, rate in motion_of(so_far).items()}
        moving |= {c: r.xreplace({eta: value}).xreplace(laws) for c, r in zip(lam, pushed, strict=True)}
        by_time = (sp.diff(h, t) + sign(problem) * value * sp.diff(g, t)).xreplace(laws)
        drifts.append(total_derivative(whole, moving) - by_time)
    checks.append(identity("H changes on the boundary with the constraint", drifts))
    rule, sources = worded("adjoin what holds a control", problem), (STEP, "costate_equations")
    return Step("mixed_costates", rule, tuple(equations), sources, tuple(checks))


def constraints(so_far: Derivation) -> list[Constraint]:
    """Return all path constraints that contain a control, with order zero; none for switching controls."""
    if switching(so_far):
        return [Constraint(name, (g,)) for name, g in pn.mixed(problem_of(so_far)).items()]
    if STEP not in so_far:
        return []
    stated = {e.name: e.rhs for e in so_far.step(STEP).equations}
    return [Constraint(name, (stated[name],)) for name in pn.mixed(problem_of(so_far))]


def _active(so_far: Derivation, found: Constraint) -> tuple[dict[sp.Symbol, sp.Expr], sp.Expr]:
    """Return controls and multiplier while a constraint is active, as symbols where no closed form exists."""
    if stationary(so_far):
        return {}, pn.multiplier(found.name)
    stated = {e.name: e.rhs for e in so_far.step(STEP).equations}
    controls = symbols_of(so_far.model.controls)
    return {u: stated[f"{found.name}_{u.name}"] for u in controls}, stated[f"{found.name}_eta"]


def _cheapest(so_far: Derivation, found: Constraint, active: dict[sp.Symbol, sp.Expr]) -> Check:
    """Check H against its value for random other controls that were moved until they satisfy the constraint."""
    problem, h, g = problem_of(so_far), so_far.equation("hamiltonian.H").rhs, found.rates[0]
    controls, hats = tuple(active), free_law(so_far)
    effect, _ = affine(so_far, found, controls)
    value, kept, push = numeric([h]), numeric([g]), numeric(list(effect))
    free, bound = numeric([hats[u] for u in controls]), numeric(list(active.values()))

    def margins(point: Point, rng: random.Random) -> list[Any]:
        def at(law: list[Any]) -> Point:
            return {**point, **dict(zip(controls, law, strict=True))}

        along = push(point)
        law = free(point) if kept(at(free(point)))[0] <= 0 else bound(point)
        size, best = sum(a * a for a in along), value(at(law))[0]
        found = []
        for _ in range(COMPETITORS):
            moved = [u + rng.uniform(-1.0, 1.0) for u in law]
            over = max(kept(at(moved))[0], 0) / size
            other = [u - over * a for u, a in zip(moved, along, strict=True)]
            found.append(sign(problem) * (value(at(other))[0] - best))
        return found

    symbols = h.free_symbols.union(g.free_symbols, *(e.free_symbols for e in (*hats.values(), *active.values())))
    return never_below(worded("cheapest that keeps it", problem), symbols, margins)


def every(so_far: Derivation) -> list[Constraint]:
    """Return all path constraints, first those on states alone."""
    return [*path_constraints.constraints(so_far), *constraints(so_far)]


def linear_quadratic(so_far: Derivation) -> bool:
    """Tell whether motion, costs and path constraints are linear or quadratic, so that signs decide convexity.

    The motion must be linear, the costs quadratic, and path constraints linear or quadratic. Whether the problem is
    convex then depends on the signs of matrices, which depend on the parameters.
    """
    problem, found, states = so_far.problem, every(so_far), symbols_of(so_far.model.states)
    if problem is None or problem.interior:  # times that are free make none convex
        return False
    moving = (*states, *symbols_of(so_far.model.controls))

    def settled(expressions: list[Any], order: int) -> bool:
        """Tell whether derivatives of this order are free of states and controls."""
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
