"""Singular arcs: a switching function that stays at its threshold, and what its time derivatives say of the control.

Along such an arc every total time derivative of the switching function vanishes. The first one in which the control
appears determines it (Kelley, Kopp and Moyer, Singular extremals, 1967); until then each derivative is a condition on
states and costates. For the arc to minimise, the generalised Legendre-Clebsch condition has to hold:
(-1)^q d/du (d/dt)^(2q) H_u >= 0, where 2q is that order (<= 0 where H is maximised).
One control is taken to be singular, the others are held at their bounds. A control with a weight w on its magnitude
has two thresholds: sigma = -w, where it is positive, and sigma = w, where it is negative.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from satsym.agreement import LIMIT
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.checks import Check, Point, compare, numeric, partial
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Conclusion, Derivation, Equation, Step
from satsym.symbolic.model import symbols_of, t
from satsym.symbolic.switching import notation as s
from satsym.symbolic.switching.functions import along_extremals, directional, flow
from satsym.symbolic.switching.singular_search import SIDES, Search, searches


def singular_arcs(so_far: Derivation) -> Step:
    """Derivatives of each switching function until its control appears, and the control on a singular arc."""
    equations: dict[str, Equation] = {}
    checks: list[Check] = []
    conclusions: list[Conclusion] = []
    found = searches(so_far)
    for search in found:
        suffix = _suffix(found, search)
        for k, derivative in enumerate(search.derivatives, 1):
            name = f"{search.control.name}{suffix}_{k}"
            equations[name] = Equation(name, s.derivative_of(search.control, k, suffix), derivative)
        if search.outcome == "order":
            name = f"{search.control.name}{search.branch}"
            equations[name] = Equation(name, s.singular(search.control, search.branch), search.singular)
        before = [search.threshold, *(d.xreplace({search.control: sp.Integer(0)}) for d in _kept(search))]
        checks.append(
            along_extremals(
                so_far, "numeric derivative along extremals", before, list(search.derivatives), search.magnitude
            )
        )
        if search.outcome == "order" or (search.outcome == "closed" and not search.surface.left):
            checks.append(_stays(so_far, search))
        conclusions += _conclusions(so_far, search)
    sources = ("switching_function", "switching_rate")
    appears = any(search.outcome == "order" for search in found)
    return Step(
        "singular_arcs",
        "differentiate until the control appears" if appears else "differentiate at the threshold",
        tuple(equations.values()),
        sources,
        tuple(checks),
        tuple(conclusions),
    )


def generalised_legendre_clebsch(so_far: Derivation) -> Step | None:
    """What a singular arc needs in order to minimise; nothing where no derivative contains the control."""
    assert so_far.problem is not None
    equations, checks, conclusions = [], list[Check](), []
    found = searches(so_far)
    for search in found:
        if not _is_found_before(so_far, search, _suffix(found, search)):
            checks.append(Check("slope of differences", math.inf, LIMIT))
        if search.outcome != "order" or search.order % 2:
            continue
        value = _kelley(search)
        symbol = s.kelley(search.control, search.branch)
        equations.append(Equation(f"{search.control.name}{search.branch}", symbol, value))
        checks.append(_slope_of_differences(so_far, search, _suffix(found, search)))
        needed = sign(so_far.problem) * value
        verdict = "satisfied" if needed.is_positive else "violated" if needed.is_negative else "open"
        conclusions.append(
            Conclusion(
                worded(f"Legendre-Clebsch {verdict}", so_far.problem),
                {"level": _level(so_far, search), "value": symbol},
            )
        )
    if not (equations or checks):
        return None
    rule = worded("generalised Legendre-Clebsch", so_far.problem)
    return Step(
        "generalised_legendre_clebsch", rule, tuple(equations), ("singular_arcs",), tuple(checks), tuple(conclusions)
    )


def _is_found_before(so_far: Derivation, search: Search, suffix: str) -> bool:
    """Whether the step ``singular_arcs`` took as many derivatives and came to the same end."""
    stated, name = {equation.name for equation in so_far.step("singular_arcs").equations}, search.control.name
    taken = [f"{name}{suffix}_{count}" in stated for count in (search.order, search.order + 1)]
    return taken == [True, False] and (f"{name}{search.branch}" in stated) == (search.outcome == "order")


def chattering(so_far: Derivation) -> tuple[str, ...]:
    """Names of the controls whose singular arcs no arc at a bound joins with a finite number of switches.

    So it is where the control first appears in a derivative of order 2q with an even q, and the generalised
    Legendre-Clebsch condition holds strictly: within its bounds, the control would have to leave such an arc towards
    either side with a switching function of the wrong sign (Kelley, Kopp and Moyer, 1967; McDanell and Powers,
    Necessary conditions for joining optimal singular and nonsingular subarcs, SIAM Journal on Control 9, 1971).
    """
    if so_far.problem is None or "singular_arcs" not in so_far:
        return ()
    return tuple(
        search.control.name
        for search in searches(so_far)
        if search.outcome == "order" and not search.branch and search.order % 4 == 0
        if (sign(so_far.problem) * _kelley(search)).is_positive
    )


def _kelley(search: Search) -> sp.Expr:
    """What the generalised Legendre-Clebsch condition is about, of an even order; factored, as the slope is."""
    return (-1) ** (search.order // 2) * search.slope


def _kept(search: Search) -> tuple[sp.Expr, ...]:
    """The derivatives of which a further one was taken."""
    return search.derivatives[:-1]


def _suffix(found: Sequence[Search], search: Search) -> str:
    """What names of derivatives end with: nothing where they are the same at all thresholds of the control."""
    alike = all(o.derivatives == search.derivatives for o in found if o.control == search.control)
    return "" if alike else search.branch


def _on_surface(search: Search) -> Any:
    """A function that moves a point to the surface, the control to its singular value."""
    values = dict(search.surface.solved)
    if search.outcome == "order":
        values[search.control] = search.singular
    place = numeric(list(values.values()))
    return lambda point: {**point, **dict(zip(values, place(point), strict=True))}


def _stays(so_far: Derivation, search: Search) -> Check:
    """Check that on the surface, with the singular control, the next derivatives vanish, by differences.

    Where some of the conditions are not solved, points do not meet these. The control is solved for without them, so
    that the last derivative vanishes all the same.
    """
    rates = {z: rate.xreplace(dict(search.magnitude)) for z, rate in flow(so_far).items()}
    conditions = [search.threshold, *(d.xreplace({search.control: sp.Integer(0)}) for d in search.derivatives)]
    conditions = conditions[:-1] if search.outcome == "order" else conditions
    unsolved = bool(search.surface.left)
    values, motion = numeric(conditions[-1:] if unsolved else conditions), numeric(list(rates.values()))
    move = _on_surface(search)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        here = move(point)
        changes = directional(values, motion, list(rates), here)
        found = changes if unsolved else [*values(here), *changes]
        return found, [0] * len(found)

    claim = "last derivative vanishes" if unsolved else "vanish on the arc"
    return compare(claim, _symbols(so_far, conditions, rates), sides)


def _slope_of_differences(so_far: Derivation, search: Search, suffix: str) -> Check:
    """Compare what multiplies the control with the slope, in the control, of differences along extremals.

    They are differences of the derivative before the last one as the step ``singular_arcs`` has it.
    """
    rates = {z: rate.xreplace(dict(search.magnitude)) for z, rate in flow(so_far).items()}
    before = search.threshold
    if search.order > 1:
        stated = so_far.equation(f"singular_arcs.{search.control.name}{suffix}_{search.order - 1}").rhs
        before = stated.xreplace({search.control: sp.Integer(0)})
    everything = _symbols(so_far, [before], rates)
    values, motion = numeric([before]), numeric(list(rates.values()))
    slope, move = numeric([search.slope]), _on_surface(search)

    def change(point: Mapping[sp.Symbol, Any]) -> list[Any]:
        return directional(values, motion, list(rates), dict(point))

    return compare(
        "slope of differences",
        everything,
        lambda point: (slope(move(point)), partial(change, move(point), search.control)),
    )


def _symbols(so_far: Derivation, expressions: Sequence[sp.Expr], rates: Mapping[sp.Symbol, sp.Expr]) -> set[sp.Symbol]:
    """Everything that points must give values to."""
    model = so_far.model
    found = {t, *rates, *symbols_of((*model.controls, *model.parameters)), *definitions_of(model)}
    return found.union(*(sp.sympify(e).free_symbols for e in (*expressions, *rates.values())))


def _level(so_far: Derivation, search: Search) -> sp.Basic:
    """Where the switching function is, and of which sign the control."""
    assert so_far.problem is not None
    u, sigma = search.control, s.switching_of(search.control)
    if not search.branch:
        return sp.Eq(sigma, 0, evaluate=False)
    side = SIDES[search.branch]
    relation = sp.Ge if side > 0 else sp.Le
    at = sp.Eq(sigma, -side * sign(so_far.problem) * s.weight_of(u), evaluate=False)
    return sp.Tuple(at, relation(u, 0, evaluate=False))


def _conclusions(so_far: Derivation, search: Search) -> list[Conclusion]:
    fill: dict[str, sp.Basic] = {
        "level": _level(so_far, search),
        "control": search.control,
        "surface": search.surface.equations(),
    }
    if search.outcome == "order":
        order = {"order": sp.Integer(search.order), "half": sp.Rational(search.order, 2)}
        return [Conclusion("singular arc" if search.order % 2 == 0 else "singular arc of odd order", fill | order)]
    if search.outcome == "impossible":
        last = search.surface.reduced(search.derivatives[-1])
        return [Conclusion("singular arc impossible", fill | {"order": sp.Integer(search.order), "value": last})]
    if search.outcome == "open":
        return [Conclusion("singular arc open", fill | {"order": sp.Integer(search.order)})]
    return [Conclusion("singular arc without the control", fill), *_by_h(so_far, search)]


def _by_h(so_far: Derivation, search: Search) -> list[Conclusion]:
    """What the value of H says of an arc on which no derivative determines the control."""
    problem = so_far.problem
    assert problem is not None
    h = so_far.equation("hamiltonian.H").rhs.xreplace(dict(search.magnitude))
    value = search.surface.reduced(h)
    if value.has(search.control):
        return []
    steady = not any(sp.sympify(e).has(t) for e in (*flow(so_far).values(), h, *_terminal(so_far)))
    if value.is_nonzero and steady:
        return [Conclusion("singular arc excluded by H", {"value": value})]
    key = "where H vanishes" if steady and value != 0 else "undetermined"
    return [Conclusion(f"singular arc {key}", {"value": value, "control": search.control})]


def _terminal(so_far: Derivation) -> list[sp.Expr]:
    problem = so_far.problem
    assert problem is not None
    return [problem.terminal_cost, *problem.end_conditions]
