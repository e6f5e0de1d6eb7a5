"""The boundary residual: one function whose zeros satisfy the end conditions of every boundary type.

At the final time the first variation of the cost leaves (H + S_t) dt + (S_x - lambda)' dx, which must vanish for every
variation that the instance admits (Kirk, Optimal Control Theory, 5.1). Two numbers for each state say which: ``given``
(dx = 0) and ``on_reference`` (dx = c'(t) dt); with neither the state is free. The factors of the independent
variations, and the conditions on the end itself, are the residuals. With the five choices of textbooks, and all
mixtures, they are the boundary conditions. Terminal constraints psi = 0 enter through S + nu' psi.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import gradient, tidy
from satsym.symbolic.checks import Point, compare, numeric, slopes
from satsym.symbolic.convention import sign
from satsym.symbolic.derivation import Check, Derivation, Equation, Step
from satsym.symbolic.model import Model, symbols_of, t

TIME_VARIATION = sp.Symbol("delta_t", real=True)
KINDS = ("given", "reference", "free")


def boundary_residual(so_far: Derivation) -> Step:
    """Derive the residuals of end conditions and transversality, by state, constraint and final time.

    Of the two residuals of a state one is zero by the choice of ``given`` and ``on_reference``.
    """
    problem = so_far.problem
    if problem is None:
        raise TypeError(f"{so_far.name} has no cost")
    states = symbols_of(so_far.model.states)
    lam = [n.costate_of(x) for x in states]
    given, on_reference = [n.given(x) for x in states], [n.on_reference(x) for x in states]
    target, nu = [n.target(x) for x in states], n.multipliers(problem)
    curve = [so_far.model.reference.get(x, sp.Integer(0)) for x in states]
    constraints = [sp.sympify(c) for c in problem.end_conditions]
    weighted = problem.terminal_cost + sum((v * c for v, c in zip(nu, constraints, strict=True)), sp.Integer(0))

    slopes, slope_t = [tidy(g) for g in gradient(weighted, states)], tidy(sp.diff(weighted, t))
    free = [sp.Symbol(f"delta_{x.name}", real=True) for x in states]
    moves = [
        rho * sp.diff(c, t) * TIME_VARIATION + (1 - g - rho) * dx
        for g, rho, c, dx in zip(given, on_reference, curve, free, strict=True)
    ]
    variation = (n.HAMILTONIAN + sign(problem) * slope_t) * TIME_VARIATION + sum(
        ((sign(problem) * slope - costate) * move for slope, costate, move in zip(slopes, lam, moves, strict=True)),
        sp.Integer(0),
    )
    ends = [
        g * (x - goal) + rho * (x - c)
        for g, rho, x, goal, c in zip(given, on_reference, states, target, curve, strict=True)
    ]
    equations = (
        *(Equation(x.name, n.residual_of(x), end) for x, end in zip(states, ends, strict=True)),
        *(
            Equation(costate.name, n.residual_of(costate), -sp.diff(variation, dx))
            for costate, dx in zip(lam, free, strict=True)
        ),
        *(Equation(v.name, n.residual_of(v), c) for v, c in zip(nu, constraints, strict=True)),
        Equation("final_time", n.residual_of(n.FINAL_TIME), sp.diff(variation, TIME_VARIATION)),
    )
    return Step(
        "boundary_residual",
        "collect variations",
        equations,
        ("boundary_conditions",),
        (_first_variation(states, lam, sign(problem) * weighted, curve, equations),),
    )


def on_a_reference(model: Model, equations: Sequence[Equation]) -> list[Equation]:
    """Return equations without the conditions for states that end on a reference, if the model has none."""
    idle = {} if model.reference else {n.on_reference(x): sp.Integer(0) for x in symbols_of(model.states)}
    return [replace(e, rhs=e.rhs.xreplace(idle)) for e in equations]


def _first_variation(
    states: Sequence[sp.Symbol],
    lam: Sequence[sp.Symbol],
    weighted: sp.Expr,
    curve: Sequence[sp.Expr],
    equations: Sequence[Equation],
) -> Check:
    """Check the residuals against the change of S + H t - lambda' x along admissible ends, by differences."""
    residuals, cost, path = numeric([e.rhs for e in equations]), numeric([weighted]), numeric(list(curve))
    dt, *moves = chosen = [sp.Dummy(f"delta {symbol.name}", real=True) for symbol in (t, *states)]
    stated = (weighted, *curve, *(e.rhs for e in equations))
    everything = {*states, *lam, *chosen, n.HAMILTONIAN, t}.union(*(sp.sympify(e).free_symbols for e in stated))

    def value(point: Point) -> Any:
        costates = sum(point[costate] * point[x] for x, costate in zip(states, lam, strict=True))
        return cost(point)[0] + point[n.HAMILTONIAN] * point[t] - costates

    def variation(point: Point, turn: int) -> tuple[Any, Any]:
        kinds = [KINDS[(turn + i) % len(KINDS)] for i in range(len(states))]
        here = {**point, **{n.given(x): int(kind == "given") for x, kind in zip(states, kinds, strict=True)}}
        here |= {n.on_reference(x): int(kind == "reference") for x, kind in zip(states, kinds, strict=True)}
        found = residuals(here)
        # The residual of a free state is lambda - S_x: what its variation multiplies, with the sign changed.
        free = sum(f * point[dx] for f, dx in zip(found[len(states) :], moves, strict=False))

        def moved(h: Any) -> list[Any]:
            end = {**here, t: here[t] + h * point[dt]}
            on_curve = zip(path(end), path(here), strict=True)
            for x, kind, dx, (later, now) in zip(states, kinds, moves, on_curve, strict=True):
                end[x] = here[x] + {"given": 0, "reference": later - now, "free": h * point[dx]}[kind]
            return [value(end)]

        return found[-1] * point[dt] - free, slopes(moved)[0]

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        both = [variation(point, turn) for turn in range(len(KINDS))]  # every state is of each kind once
        return [found for found, _ in both], [change for _, change in both]

    return compare("change along admissible ends", everything, sides)
