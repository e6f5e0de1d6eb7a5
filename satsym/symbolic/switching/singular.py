"""Singular arcs and boundary arcs of controls in which H is linear: the controls that keep to them.

On a singular arc a switching function stays at its threshold, and its time derivatives determine the control.

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
from satsym.symbolic.algebra import definitions_of, simplified, tidy
from satsym.symbolic.checks import Check, Point, compare, identity, numeric, partial
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Conclusion, Derivation, DerivationError, Equation, Step
from satsym.symbolic.model import symbols_of, t
from satsym.symbolic.principle.path import notation as pn
from satsym.symbolic.principle.path.path_constraints import STEP, acting, affine, constraints
from satsym.symbolic.switching import notation as s
from satsym.symbolic.switching.functions import along_extremals, directional, flow
from satsym.symbolic.switching.singular_search import SIDES, Search, searches


def singular_arcs(so_far: Derivation) -> Step:
    """Derive time derivatives of each switching function until its control appears, and the singular control."""
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
    """Derive the condition for a singular arc to minimise, if a derivative contains the control."""
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
    """Tell whether the step ``singular_arcs`` took as many derivatives with the same outcome."""
    stated, name = {equation.name for equation in so_far.step("singular_arcs").equations}, search.control.name
    taken = [f"{name}{suffix}_{count}" in stated for count in (search.order, search.order + 1)]
    return taken == [True, False] and (f"{name}{search.branch}" in stated) == (search.outcome == "order")


def chattering(so_far: Derivation) -> tuple[str, ...]:
    """Return controls whose singular arcs cannot be joined to a bound by finitely many switches.

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
    """Return the factored quantity of the generalised Legendre-Clebsch condition, of an even order."""
    return (-1) ** (search.order // 2) * search.slope


def _kept(search: Search) -> tuple[sp.Expr, ...]:
    """Return the derivatives that were differentiated once more."""
    return search.derivatives[:-1]


def _suffix(found: Sequence[Search], search: Search) -> str:
    """Return the suffix of names of derivatives; empty if they are the same at all thresholds."""
    alike = all(o.derivatives == search.derivatives for o in found if o.control == search.control)
    return "" if alike else search.branch


def _on_surface(search: Search) -> Any:
    """Return a function that moves a point to the surface of conditions, with the singular control."""
    values = dict(search.surface.solved)
    if search.outcome == "order":
        values[search.control] = search.singular
    place = numeric(list(values.values()))
    return lambda point: {**point, **dict(zip(values, place(point), strict=True))}


def _stays(so_far: Derivation, search: Search) -> Check:
    """Check by differences that the next derivatives vanish on the surface under the singular control.

    Where some of the conditions are not solved, points do not satisfy them. The control is solved for without them, so
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
    """Compare the factor of the control with the slope, in the control, of differences along extremals.

    These are differences of the derivative before the last one, as the step ``singular_arcs`` has it.
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
    """Return all symbols that need values at points."""
    model = so_far.model
    found = {t, *rates, *symbols_of((*model.controls, *model.parameters)), *definitions_of(model)}
    return found.union(*(sp.sympify(e).free_symbols for e in (*expressions, *rates.values())))


def _level(so_far: Derivation, search: Search) -> sp.Basic:
    """Return the threshold of the switching function, and the sign of the control there."""
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
    """Draw conclusions from the value of H about an arc on which no derivative determines the control."""
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


# On the boundary of a path constraint a control is where the constraint keeps it, as a rule between its bounds. As the
# control minimises H there, its switching function vanishes all along, and the multiplier of the constraint is what
# keeps it zero (Maurer, On optimal control problems with bounded state variables and control appearing linearly, SIAM
# Journal on Control and Optimization 15, 1977). Order, multiplier, costates and junctions are as in
# satsym.symbolic.principle.path.path_constraints.


def boundary_control(so_far: Derivation) -> Step | None:
    """Derive the control that keeps g <= 0 on its boundary from g^(q) = 0, where q is the order of the constraint g."""
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


def refuse_mixtures(so_far: Derivation) -> None:
    """Refuse path constraints for which no boundary control can be derived, before any step.

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
        place = f"{what} {held[0]}"
        raise DerivationError(
            f"{place}: H is linear in the controls, so a constraint that contains a control is not derived; "
            "write the constraint as a bound on that control",
            ("path_constraints",),
        )
    stated = sp.Tuple(problem.running_cost, *so_far.rhs("first_order"))
    if problem.path_constraints and any(stated.has(a) for a in s.magnitudes(controls)):
        message = (
            "path constraints are not supported together with |u|; use two controls, one for each sign, with the lower "
            "bound 0"
        )
        raise DerivationError(f"{what}: {message}", ("path_constraints", "running_cost"))
