"""Points on the way that are passed at free times: N(x, t, p) = 0, by name, in order.

At such a time the costs before and after it leave (lambda(t+) - lambda(t-))' dx + (H(t-) - H(t+)) dt in the first
variation, which N, adjoined with multipliers pi of either sign, must balance for every dx and dt (Bryson and Ho,
Applied Optimal Control, 3.5).
"""

from __future__ import annotations

from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy
from satsym.symbolic.checks import Point, compare, numeric, slopes
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Check, Derivation, Equation, Step
from satsym.symbolic.dimension_algebra import Dimension, over
from satsym.symbolic.model import Problem, Requirement, symbols_of, t

STEP = "interior_conditions"
"""Name of the step that occurs only in derivations with waypoints."""


def entry(name: str, place: int, count: int) -> str:
    """Return the name of one of the conditions at a point; a single condition has the name of the point."""
    return name if count == 1 else f"{name}_{place}"


def named(problem: Problem) -> dict[str, sp.Expr]:
    """Map names to all conditions, those of the first point first."""
    return {
        entry(name, k, len(stated)): sp.sympify(condition)
        for name, stated in problem.interior.items()
        for k, condition in enumerate(stated, start=1)
    }


def condition(name: str) -> sp.Symbol:
    """Return the symbol for a condition, by its name."""
    return sp.Symbol(f"interior_{name}", real=True)


def multiplier(name: str) -> sp.Symbol:
    """Return the symbol for the multiplier of a condition, by its name."""
    return sp.Symbol(f"pi_{name}", real=True)


def change(of: sp.Symbol, point: str) -> sp.Symbol:
    """Return the symbol for the value of a quantity before a point less the value after it."""
    return sp.Symbol(f"change_of_{of.name}_at_{point}", real=True)


def interior_conditions(so_far: Derivation) -> Step | None:
    """Derive the jumps of costates and H at each point."""
    problem = so_far.problem
    if problem is None or not problem.interior:
        return None
    states, s = symbols_of(so_far.model.states), sign(problem)
    equations, checks = list[Equation](), list[Check]()
    for point, stated in problem.interior.items():
        names = [entry(point, k, len(stated)) for k in range(1, len(stated) + 1)]
        equations += [Equation(one, condition(one), sp.sympify(e)) for one, e in zip(names, stated, strict=True)]
        adjoined = sum((multiplier(one) * e for one, e in zip(names, stated, strict=True)), sp.Integer(0))
        jumps = [
            Equation(f"{point}_{lam.name}", change(lam, point), tidy(s * sp.diff(adjoined, x)))
            for x, lam in zip(states, map(n.costate_of, states), strict=True)
        ]
        jumps.append(Equation(f"{point}_H", change(n.HAMILTONIAN, point), tidy(-s * sp.diff(adjoined, t))))
        checks.append(_first_variation(states, s * adjoined, jumps))
        equations += jumps
    rule = worded("pass a point", problem)
    return Step(STEP, rule, tuple(equations), ("hamiltonian", "costate_equations"), tuple(checks))


def _first_variation(states: tuple[sp.Symbol, ...], adjoined: sp.Expr, jumps: list[Equation]) -> Check:
    """Check the jumps against the change of the adjoined conditions along any dx and dt, by differences."""
    found, value = numeric([one.rhs for one in jumps]), numeric([adjoined])
    along = {x: sp.Dummy(f"delta {x.name}", real=True) for x in (t, *states)}

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        *of_costates, of_h = found(point)
        left = sum(jump * point[along[x]] for jump, x in zip(of_costates, states, strict=True)) - of_h * point[along[t]]
        return [left], slopes(lambda h: value({**point, **{x: point[x] + h * point[d] for x, d in along.items()}}))

    return compare("change where a point is passed", {*along, *along.values()} | adjoined.free_symbols, sides)


def names(problem: Problem) -> dict[str, str]:
    """Map the names of all symbols of points on the way to LaTeX."""
    found: dict[str, str] = {}
    for place, (point, stated) in enumerate(problem.interior.items(), start=1):
        for k in range(1, len(stated) + 1):
            one = entry(point, k, len(stated))
            foot = f"{place}{k}" if len(stated) > 1 else f"{place}"
            found |= {condition(one).name: f"N_{{{foot}}}", multiplier(one).name: rf"\pi_{{{foot}}}"}
        for v, (x,) in ((v, symbols_of((v,))) for v in problem.model.states):
            lam = rf"\lambda_{{{v.latex}}}"
            found[change(n.costate_of(x), point).name] = rf"{lam}(t_{place}^-) - {lam}(t_{place}^+)"
        found[change(n.HAMILTONIAN, point).name] = rf"H(t_{place}^-) - H(t_{place}^+)"
    return found


def declare(
    known: dict[str, Dimension | None], problem: Problem, total: Dimension | None, require: Requirement
) -> None:
    """Enter the dimensions of all symbols of points on the way, where `total` is the dimension of the cost."""
    for name, stated in named(problem).items():
        known[condition(name).name] = found = require(f"the interior point {name}", stated)
        known[multiplier(name).name] = over(total, found)
    for point in problem.interior:
        for of in (n.HAMILTONIAN, *map(n.costate_of, symbols_of(problem.model.states))):
            known[change(of, point).name] = known[of.name]
