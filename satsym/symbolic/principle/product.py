"""The control law over a product of sets: H is split, minimised set by set, and regularised to be continuous.

The law of a direction (an angle, or a vector in a ball on which H depends linearly) is continuous wherever its slope
does not vanish, but no continuous law leads to it from vanishing costates. In the regularised problem the direction may
be shorter, and half its square costs ``smoothing``: its law is proportional to the slope up to the full length, and
equals the exact law where the slope is larger than the smoothing.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.control_part import SWITCHED
from satsym.symbolic import notation as n
from satsym.symbolic.algebra import depends, simplify, tidy, vanishes
from satsym.symbolic.chain import named_parts
from satsym.symbolic.checks import Point, compare, identity, never_below, numeric
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Check, Conclusion, Derivation, Equation, Step
from satsym.symbolic.factoring import factored
from satsym.symbolic.functions.roots import Argmin, Choice, Vertex
from satsym.symbolic.model import Problem, symbols_of
from satsym.symbolic.principle import control_sets
from satsym.symbolic.principle import effort as pn
from satsym.symbolic.principle.branches import Minimum, norm_of, with_norms
from satsym.symbolic.principle.parts import boxes_apart, limits_of, parts_of, weighed
from satsym.symbolic.principle.path.stationary_controls import refuse_jumping
from satsym.symbolic.principle.pontryagin import COMPETITORS, costates, numeric_gradient
from satsym.symbolic.principle.set_laws import (
    EPSILON,
    FACTOR,
    SCALES,
    adds_up,
    cheapest,
    convex,
    drawn,
    found,
    law_of,
    ordered,
    problem_of,
    relaxed,
    shortened,
    written_out,
)
from satsym.symbolic.principle.stationary import indefinite

STEP = "control_parts"
"""Name of the step that occurs only in derivations over products of control sets."""


def applies(so_far: Derivation) -> bool:
    """Tell whether the problem needs the law over a product of sets.

    It does where the control set is stated set by set, where it is a ball on which H is linear, where H is not
    quadratic, and where a path constraint is not linear in the controls.
    """
    problem = so_far.problem
    if problem is None:
        return False
    if problem.control_sets:
        return True
    controls = symbols_of(problem.model.controls)
    kept = [sp.diff(g, u) for g in problem.path_constraints.values() for u in controls]
    if any(not vanishes(sp.diff(slope, u)) for slope in kept for u in controls):
        return True  # on the boundary of such a constraint no law is in closed form
    stated = [with_norms(e, parts_of(problem)) for e in (problem.running_cost, *so_far.rhs("first_order"))]
    if problem.control_set != "ball":
        if any(e.has(sp.Abs) for e in stated):
            return False
        cost, *rates = stated
        if problem.control_set == "box" and any(not vanishes(sp.diff(f, u, 2)) for f in rates for u in controls):
            return True  # the costates decide whether H is convex
        if problem.control_set == "box" and any(_falls(so_far, cost, u) for u in controls):
            return True  # the better end is the minimiser
        slopes = [sp.diff(e, u) for e in stated for u in controls]
        return any(not vanishes(sp.diff(s, u, v)) for s in slopes for u in controls for v in controls)
    if len(controls) == 1:
        return False
    return all(vanishes(sp.diff(e, u, v)) for e in stated for u in controls for v in controls)


def _falls(so_far: Derivation, cost: sp.Expr, u: sp.Symbol) -> bool:
    """Tell whether a cost is concave in a control, everywhere or in some states."""
    curvature = simplify(sp.diff(cost, u, 2))
    return bool(curvature.is_negative) or _either_sign(so_far, curvature, symbols_of(so_far.model.states))


def _either_sign(so_far: Derivation, curvature: sp.Expr, by: Sequence[sp.Symbol]) -> bool:
    """Tell whether a curvature may have either sign because of these symbols."""
    return curvature.has(*by) and indefinite(so_far.name, curvature)


def needs_its_sets(so_far: Derivation) -> bool:
    """Tell whether H is minimised set by set though the sets, all boxes or all free, were joined into one.

    That is so where a cost is convex or concave depending on parameters: a box then asks for their sign.
    """
    problem = problem_of(so_far)
    if problem.control_set != "box" or applies(so_far):
        return applies(so_far)
    parameters, cost = symbols_of(so_far.model.parameters), problem.running_cost
    bends = (simplify(sp.diff(cost, u, 2)) for u in symbols_of(so_far.model.controls))
    return any(_either_sign(so_far, bend, parameters) for bend in bends)


def as_sets(so_far: Derivation, stated: Problem) -> Problem | None:
    """Return the problem with a box for each control that switches beside others; ``None`` where it can stay.

    Parameters
    ----------
    so_far
        Up to the motion, of the problem with boxes put together in one where it has no other sets.
    stated
        The problem as it is stated.
    """
    apart = boxes_apart(stated, _linear(so_far, stated))
    together = problem_of(so_far).control_set == "box" and bool(stated.control_sets)
    if apart is not stated or (together and (needs_its_sets(so_far) or _linear(so_far, stated))):
        return apart
    return None


def _linear(so_far: Derivation, stated: Problem) -> set[str]:
    """Return controls in boxes on which cost and motion depend linearly, without products with others of the box."""
    given = [sp.sympify(e) for e in (problem_of(so_far).running_cost, *so_far.rhs("first_order"))]
    found = set()
    for part in parts_of(stated):
        for u in part.symbols if part.kind == "box" else ():
            slopes = [sp.diff(e, u) for e in given]
            if not any(depends(slope, part.symbols) for slope in slopes):
                found.add(u.name)
    return found


def control_parts(so_far: Derivation) -> Step:
    """Split H into its parts by the controls of each set."""
    problem, h = problem_of(so_far), so_far.equation("hamiltonian.H").rhs
    every = found(so_far)
    if problem.path_constraints:
        refuse_jumping(so_far.name, every)
    equations: list[Equation] = []
    for one in every:
        symbols = one.part.symbols
        if one.branch == "quadratic":
            equations += [Equation(u.name, sp.Integer(0), g) for u, g in zip(symbols, one.gradient, strict=True)]
            equations += [
                Equation(f"{u.name}_hat", n.unconstrained(u), hat) for u, hat in zip(symbols, one.hats, strict=True)
            ]
        elif one.branch == "stationary":
            equations += [Equation(u.name, pn.slope_by(u), g) for u, g in zip(symbols, one.gradient, strict=True)]
        else:
            equations += [Equation(s.name, s, value) for s, value in zip(pn.slopes_of(one), one.vector, strict=True)]
            if one.weight != 0:
                weight = pn.weight_of(one.part.symbols[0])
                equations.append(Equation(weight.name, weight, one.weight))
    stationary = [one for one in every if one.branch == "stationary"]
    checks = [adds_up(so_far, h, every)] if len(stationary) < len(every) else []
    checks += [numeric_gradient(h, one.part.symbols, list(one.gradient)) for one in stationary]
    checks += [convex(so_far, one) for one in every if one.branch == "quadratic"]
    checks += [_stationary(one) for one in every if one.branch == "quadratic"]
    together = any(
        one.turned_by or set().union(*(g.free_symbols for g in one.gradient)) & _others(every, one) for one in every
    )
    rule = worded("one set" if len(every) == 1 else "sets together" if together else "set by set", problem)
    kinds = tuple(f"in H, {kind}" for kind in _kinds(every))
    return Step(STEP, rule, tuple(equations), ("hamiltonian",), tuple(checks), kinds=kinds)


def _stationary(one: Minimum) -> Check:
    """Check that derivatives of H by the controls of one set vanish at its unconstrained minimum."""
    hats = dict(zip(one.part.symbols, one.hats, strict=True))
    return identity("vanishes there", [slope.xreplace(hats) for slope in one.gradient])


def _others(every: Sequence[Minimum], one: Minimum) -> set[sp.Symbol]:
    """Return the controls of the other sets."""
    return {u for other in every if other is not one for u in other.part.symbols}


def _kinds(every: Sequence[Minimum]) -> tuple[str, ...]:
    """Return the keys of texts for the forms in which H depends on the controls, each once."""
    found: dict[str, None] = {}
    for one in every:
        if one.directed and one.branch != "switched":
            found["magnitude" if one.turned_by else "angle" if one.part.kind == "angle" else "vector"] = None
            found |= {"norm": None} if one.weight != 0 else {}
        else:
            found[one.branch] = None
    return tuple(found)


def control_law(so_far: Derivation) -> Step:
    """Derive the control that minimises H over the product of the sets, set by set."""
    problem, every = problem_of(so_far), found(so_far)
    laws = {u: law for one in every for u, law in zip(one.part.symbols, law_of(problem, one), strict=True)}
    controls = symbols_of(problem.model.controls)
    parts, stated = _in_parts(every, [laws[u] for u in controls])
    equations = tuple(Equation(s.name, s, value) for s, value in parts)
    equations += tuple(Equation(u.name, n.optimal(u), law) for u, law in zip(controls, stated, strict=True))
    h = so_far.equation("hamiltonian.H").rhs
    check = cheapest(so_far, h, written_out(so_far, [laws[u] for u in controls]))
    said = tuple(
        Conclusion("no direction where it vanishes", {"slope": sp.Tuple(*pn.slopes_of(one))})
        for one in every
        if one.directed and one.branch != "switched"
    )
    said += tuple(
        Conclusion("no level where it vanishes", {"slope": pn.slopes_of(one)[0]})
        for one in every
        if one.branch == "switched"
    )
    said += tuple(
        Conclusion("no length at the threshold", {"weight": sign(problem) * pn.weight_of(one.part.symbols[0])})
        for one in every
        if one.branch == "throttled" and not one.turned_by
    )
    turned = {one.part.symbols[0]: one.turned_by for one in every if one.turned_by}
    within = {one.part.symbols[0] for one in every if one.turned_to}
    said += tuple(
        Conclusion(f"magnitude that is turned{' within bounds' if u in within else ''}", {"size": u, "angle": angle})
        for u, angle in turned.items()
    )
    others = [one for one in every if not {*one.part.symbols} & {*turned.values()}]
    if any(not law.has(Vertex) for one in others for law in one.laws):
        bounded = any(one.part.kind == "box" for one in others if one.laws)
        said += (Conclusion(f"neither linear nor quadratic{'' if bounded else ', unbounded'}", {}),)
    said += tuple(Conclusion(key, {}) for key in sorted({key for one in every for key in one.remarks}))
    longer = {"stationary": "parts"} if parts else {}
    longer |= {"magnitude": "magnitude within"} if within else {}
    named = (longer.get(kind, kind) for kind in _kinds(every))
    kinds = tuple(worded(f"law, {kind}", problem) for kind in named)
    rule = worded("minimum of all", problem)
    return Step("control_law", rule, equations, (STEP,), (check,), said, kinds)


def _in_parts(
    every: Sequence[Minimum], laws: Sequence[sp.Expr]
) -> tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr]]:
    """Write laws that compare minimisers by named parts; leave other laws unchanged."""
    if not any(law.has(Choice, Vertex, Argmin) for one in every for law in one.laws):
        return [], list(laws)
    named = (pn.part_of_law(k) for k in range(1, pn.MOST_PARTS + 1))
    compared = [e for law in laws if isinstance(law, Vertex) for e in law.args[:2]]
    compared += [e for law in laws if isinstance(law, Argmin) for e in law.args[2:]]
    taken, left = sp.cse([*compared, *laws], symbols=named, order="canonical")
    parts, reduced = named_parts(taken, left, pn.part_of_law)
    return parts, reduced[len(compared) :]


def _norm(one: Minimum) -> sp.Expr:
    """Return the norm of a vector, or the magnitude that is its norm."""
    return one.part.symbols[0] if one.turned_by else sp.sqrt(sum(u**2 for u in one.part.symbols))


def smoothed_law(so_far: Derivation) -> Step | None:
    """Derive H of the regularised problem for directions, whose half squares cost a little, and its law."""
    problem = problem_of(so_far)
    every = found(so_far)
    directions = [one for one in every if one.directed]
    if not directions:
        return None
    short = [component for one in directions for component in pn.components_of(one.part)]
    limited = [v for one in directions for v in one.part.controls]
    saved = [(1 - FACTOR) * pn.weight_of(one.part.symbols[0]) * _norm(one) for one in directions if one.weight != 0]
    besides = sign(problem) * weighed(EPSILON, short, limited) - sp.Add(*saved)
    equations = [Equation("H", pn.REGULARISED_H, n.HAMILTONIAN + besides)]
    for one in directions:
        laws = shortened(problem, one)
        equations += [Equation(c.name, c, law) for c, law in zip(pn.components_of(one.part), laws, strict=True)]
    (h,) = relaxed(so_far, [so_far.equation("hamiltonian.H").rhs])
    h = h.xreplace({norm_of(one.part): _norm(one) for one in directions})
    (h,) = written_out(so_far, [h + besides])
    stationary = [one for one in found(so_far) if one.branch == "stationary"]
    beside = {u: law for one in stationary for u, law in zip(one.part.symbols, one.laws, strict=True)}
    turned = numeric(list(beside.values()))
    value, chosen = numeric([h]), numeric(written_out(so_far, [e.rhs for e in equations[1:]]))

    def margins(point: Point, rng: random.Random) -> list[Any]:
        margin = []
        for scale in SCALES:
            here = {**point, **{c: scale * point[c] for c in costates(so_far)}}
            for one in every:
                here = ordered(one, here)
            here |= dict(zip(beside, turned(here), strict=True))
            law = chosen(here)
            best = value({**here, **dict(zip(short, law, strict=True))})[0]
            for _ in range(COMPETITORS):
                other: list[Any] = []
                for one in directions:
                    limit = here[one.part.bounds[-1]]
                    bounds = {sp.Symbol("radius"): limit}
                    size = len(pn.components_of(one.part))
                    if one.branch in SWITCHED:
                        other += drawn(one, here, rng).values()
                    else:
                        other += control_sets.admissible("ball", bounds, list(bounds), size, rng, 1)[0]
                margin.append(sign(problem) * (value({**here, **dict(zip(short, other, strict=True))})[0] - best))
        return margin

    everything = {*short, *costates(so_far), EPSILON, *symbols_of(limits_of(problem))}
    everything |= h.free_symbols.union(*(e.free_symbols for e in written_out(so_far, [e.rhs for e in equations[1:]])))
    check = never_below(worded("cheapest admissible", problem), everything, margins)
    kinds = ("squares", *(kind for kind in _kinds(every) if kind in ("angle", "norm")))
    kinds = tuple(f"regularised, {kind}" for kind in kinds)
    rule = worded("shorter directions and less of norms" if saved else "shorter directions", problem)
    return Step("smoothed_law", rule, tuple(equations), (STEP, "control_law"), (check,), kinds=kinds)


def minimised_hamiltonian(so_far: Derivation) -> Step | None:
    """Derive H* = H with the law in it, where no bound is active, and the law contains no bounds."""
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
    """Return the conditions that no bound is active for sets on which H is quadratic."""
    found: dict[sp.Symbol, Any] = {}
    for one in every:
        if one.branch == "quadratic" and one.part.kind == "box":
            half = len(one.part.bounds) // 2
            found |= dict.fromkeys(one.part.bounds[:half], mp.mpf(-(10**9)))
            found |= dict.fromkeys(one.part.bounds[half:], mp.mpf(10**9))
        elif one.branch == "quadratic":
            found |= dict(zip(one.part.bounds[::-1], (mp.mpf(10**9), mp.mpf(10) ** -9), strict=False))
    return found
