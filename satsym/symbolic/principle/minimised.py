"""H at its minimiser over a control set that is a product of sets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.control_part import SWITCHED
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import tidy
from satsym.symbolic.checks import Point, compare, numeric
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Derivation, Equation, Step
from satsym.symbolic.factoring import factored
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle import effort as pn
from satsym.symbolic.principle.branches import Minimum, norm_of
from satsym.symbolic.principle.parts import limits_of
from satsym.symbolic.principle.pontryagin import costates
from satsym.symbolic.principle.set_checks import ordered
from satsym.symbolic.principle.set_laws import found, problem_of, relaxed, written_out


def minimised_hamiltonian(so_far: Derivation) -> Step | None:
    """H* = H with the law in it, where no bound of a box or on a square is active, and the law has no bounds in it."""
    problem, every = problem_of(so_far), found(so_far)
    if any(one.branch == "stationary" for one in every):
        return None
    h = so_far.equation("hamiltonian.H").rhs
    least: dict[sp.Symbol, sp.Expr] = {}
    gained = sp.Integer(0)
    for one in every:
        if one.branch == "quadratic":
            least |= dict(zip(one.part.symbols, one.hats, strict=True))
            continue
        least |= dict.fromkeys(pn.components_of(one.part), sp.Integer(0))
        if one.branch == "switched":
            (s,), ends = one.vector, one.part.bounds
            gained += sign(problem) * sp.Max(*(-sign(problem) * end * s for end in ends))
            continue
        length = sp.Integer(1) if one.part.kind == "angle" else one.part.bounds[-1]
        shortest = one.part.bounds[0] if one.part.kind == "annulus" else 0
        slope = sp.sqrt(factored(sum((s**2 for s in one.vector), sp.Integer(0))))
        if one.weight != 0:
            least[norm_of(one.part)] = sp.Integer(0)
            margin = slope - sign(problem) * one.weight
            gained += sign(problem) * sp.Max(length * margin, shortest * margin)
        else:
            gained += sign(problem) * length * slope
    (plain,) = relaxed(so_far, [h])
    h_star = tidy(plain.xreplace(least), ()) - gained
    value, at_minimum = numeric([h]), numeric([h_star])
    laws = [so_far.equation(f"control_law.{u.name}").rhs for u in symbols_of(problem.model.controls)]
    wide = _wide(every)
    chosen = numeric(written_out(so_far, laws))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        here = {**point, **wide}
        for one in every:
            here = ordered(one, here) if one.branch in SWITCHED else here
        law = dict(zip(symbols_of(problem.model.controls), chosen(here), strict=True))
        return at_minimum(here), value({**here, **law})

    everything = h.free_symbols.union(h_star.free_symbols, symbols_of(limits_of(problem)), costates(so_far))
    check = compare("H at the optimal control", everything, sides)
    name = "minimised_hamiltonian" if problem.convention == "minimum" else "maximised_hamiltonian"
    equation = Equation("H_star", n.MINIMISED, h_star)
    bounded = any(one.branch == "quadratic" and one.part.kind != "free" for one in every)
    rule = worded("substitute the law, inside" if bounded else "substitute the law", problem)
    return Step(name, rule, (equation,), ("hamiltonian", "control_law"), (check,))


def _wide(every: Sequence[Minimum]) -> dict[sp.Symbol, Any]:
    """Bounds that are not active, of the sets on which H is quadratic."""
    found: dict[sp.Symbol, Any] = {}
    for one in every:
        if one.branch == "quadratic" and one.part.kind == "box":
            half = len(one.part.bounds) // 2
            found |= dict.fromkeys(one.part.bounds[:half], mp.mpf(-(10**9)))
            found |= dict.fromkeys(one.part.bounds[half:], mp.mpf(10**9))
        elif one.branch == "quadratic":
            found |= dict(zip(one.part.bounds[::-1], (mp.mpf(10**9), mp.mpf(10) ** -9), strict=False))
    return found
