"""Path constraints on the state, g(x, t, p) <= 0: their order, boundary control, multiplier and junctions.

Constraints are adjoined directly (Hartl, Sethi and Vickson, SIAM Review 37, 1995, theorem 4.1): to H comes eta g with a
multiplier eta >= 0 that vanishes where g < 0. The control minimises H itself, also on the boundary, and the multiplier
keeps it there: for a constraint of order q it follows from the derivative of order q of g^(q) along the extremal.
Costates jump by -zeta g_x with zeta >= 0 at entries, exits and touch points, except for constraints of order one, where
the control would jump with them. One constraint is on its boundary at a time.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import depends, gradient, shortest, simplified, simplify, tidy, total_derivative, vanishes
from satsym.symbolic.checks import Point, compare, identity, never_below, numeric, partial, slopes
from satsym.symbolic.convention import sign, worded
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.model import Problem, symbols_of, t
from satsym.symbolic.principle.path import notation as pn
from satsym.symbolic.principle.pontryagin import costates

COMPETITORS = 20
"""Number of other controls on the boundary with which the boundary control is compared at each random point."""

STEP = "constraint_order"
"""Name of the step that occurs only in derivations with state constraints."""

CONTROL_PARTS = "control_parts"
"""Name of the step of derivations whose control law is found set by set; see
:mod:`satsym.symbolic.principle.product`."""

SWITCHING = "switching_function"
"""Name of the step of derivations in which H is linear in the controls; see
:mod:`satsym.symbolic.switching.singular`."""


@dataclass(frozen=True)
class Constraint:
    """A path constraint with its derivatives g, g', ..., g^(q), of which only the last contains the controls."""

    name: str
    rates: tuple[sp.Expr, ...]

    @property
    def order(self) -> int:
        """Return the order of the constraint: the number of time derivatives until a control appears."""
        return len(self.rates) - 1


def constraint_order(so_far: Derivation) -> Step | None:
    """Derive the time derivatives of each constraint along the motion, until a control appears."""
    if not (stated := pn.of_states(problem_of(so_far))):
        return None
    motion, equations, checks = motion_of(so_far), list[Equation](), []
    for found in (_differentiated(so_far, name) for name in stated):
        equations += [
            Equation(pn.entry(found.name, k), pn.rate(found.name, k), rate) for k, rate in enumerate(found.rates)
        ]
        checks.append(rates_along(found.rates, motion))
    return Step(STEP, "differentiate until a control appears", tuple(equations), ("first_order",), tuple(checks))


def boundary_control(so_far: Derivation) -> Step | None:
    """Derive the control that minimises H among those with g^(q) = 0, in closed form."""
    if STEP not in so_far or stationary(so_far):
        return None
    problem, controls = problem_of(so_far), symbols_of(so_far.model.controls)
    h, equations, checks = so_far.equation("hamiltonian.H").rhs, list[Equation](), []
    free = sp.Matrix([so_far.equation(f"stationarity.{u.name}_hat").rhs for u in controls])
    weight = sp.hessian(h, controls).applyfunc(simplify)
    for found in constraints(so_far):
        effect, rest = affine(so_far, found, controls)
        turned = weight.LUsolve(effect)
        missed = (effect.T * free)[0] + rest
        moved = turned * (missed / (effect.T * turned)[0])
        laws = [
            shortest(tidy(simplified(hat - move)), tidy(hat) - sp.factor_terms(move))
            for hat, move in zip(free, moved, strict=True)
        ]
        equations += [
            Equation(f"{found.name}_{u.name}", pn.boundary_control(found.name, u), law)
            for u, law in zip(controls, laws, strict=True)
        ]
        substituted = found.rates[-1].xreplace(dict(zip(controls, laws, strict=True)))
        checks.append(identity("keeps the constraint", [substituted]))
        if len(controls) > 1:  # a single one has no other
            checks.append(_cheapest_on_boundary(so_far, found, laws, sign(problem)))
    rule = worded("minimise H on the boundary", problem)
    return Step("boundary_control", rule, tuple(equations), (STEP, "hamiltonian"), tuple(checks))


def constraint_multiplier(so_far: Derivation) -> Step | None:
    """Derive the multiplier with which the minimising control stays on the boundary, and vanishing quantities."""
    if STEP not in so_far:
        return None
    equations, checks, law = list[Equation](), [], free_law(so_far)
    for found in constraints(so_far):
        vanishing = _vanishing(so_far, found)
        moving = canonical(so_far, found)
        last = tidy(total_derivative(vanishing[-1], moving), (eta := pn.multiplier(found.name),))
        by_eta = simplified(sp.diff(last, eta))
        value = tidy(simplified(-last.xreplace({eta: sp.Integer(0)}) / by_eta))
        equations += [
            Equation(pn.vanishing_entry(found.name, k), pn.vanishing(found.name, k), e) for k, e in enumerate(vanishing)
        ]
        equations.append(Equation(f"{found.name}_eta", eta, value))
        chain = (*(() if switching(so_far) else found.rates[-2:-1]), *vanishing, sp.Integer(0))
        checks.append(rates_along(chain, {x: r.xreplace({eta: value}) for x, r in moving.items()}))
        checks.append(adjoined(so_far, found, [moving[lam] for lam in costates(so_far)], law))
    key, law_from = ("keep the law on the boundary", "control_law")
    if switching(so_far):
        key, law_from = ("keep the switching function on the boundary", SWITCHING)
    sources = (STEP, law_from, "costate_equations")
    rule = worded(key, problem_of(so_far))
    return Step("constraint_multiplier", rule, tuple(equations), sources, tuple(checks))


def constrained_costates(so_far: Derivation) -> Step | None:
    """Derive the costate equations on the boundary."""
    if STEP not in so_far:
        return None
    states, equations, drifts, checks = symbols_of(so_far.model.states), list[Equation](), [], []
    law, controls = free_law(so_far), symbols_of(so_far.model.controls)
    for found in constraints(so_far):
        moving = canonical(so_far, found)
        equations += [Equation(f"{found.name}_{lam.name}", n.rate_of(lam), moving[lam]) for lam in costates(so_far)]
        h = so_far.equation("hamiltonian.H").rhs.xreplace(law)
        g, eta = found.rates[0], pn.multiplier(found.name)
        shift = sign(problem_of(so_far)) * eta * sum(sp.diff(g, x) * moving[x] for x in states)
        change = sum(sp.diff(h, v) * rate for v, rate in moving.items() if v not in controls)  # in these it is least
        drifts.append(change + shift)
        checks.append(adjoined(so_far, found, [moving[lam] for lam in costates(so_far)], law))
    checks.append(identity("H changes on the boundary with the constraint", drifts))
    rule = worded("adjoin the constraint", problem_of(so_far))
    return Step("constrained_costates", rule, tuple(equations), (STEP, "costate_equations"), tuple(checks))


def junction_conditions(so_far: Derivation) -> Step | None:
    """Derive tangency conditions and jumps of costates and H at entries, exits and touch points.

    The jump leaves the control unchanged where the order is two or more; where it is one, the jump changes g' by a
    multiple of zeta, which must vanish because g' = 0 on both sides.
    """
    if STEP not in so_far:
        return None
    problem, states, lam = problem_of(so_far), symbols_of(so_far.model.states), costates(so_far)
    law, equations, kept = free_law(so_far), list[Equation](), []
    h = so_far.equation("hamiltonian.H").rhs.xreplace(law)
    for found in constraints(so_far):
        g, zeta = found.rates[0], pn.jump(found.name)
        equations += [
            Equation(f"{found.name}_tangency_{k}", pn.rate(found.name, k), sp.Integer(0)) for k in range(found.order)
        ]
        jumps = [tidy(sign(problem) * zeta * sp.diff(g, x)) for x in states]
        jump_of_h = tidy(-sign(problem) * zeta * sp.diff(g, t))
        before = {costate: costate + jump for costate, jump in zip(lam, jumps, strict=True)}
        if found.order == 1:
            moved, stays = _moved_by_jump(so_far, found, before)
            kept += stays
            if all(vanishes(m) for m in moved):
                raise DerivationError(
                    f"{so_far.name}: path_constraints {found.name}: the jump of costates is not determined"
                )
            equations.append(Equation(f"{found.name}_jump", zeta, sp.Integer(0)))
            continue
        kept += _moved_by_jump(so_far, found, before)[1]
        # the rate of g vanishes where the jump is
        kept.append(h.xreplace(before) - h - sign(problem) * zeta * found.rates[1] - jump_of_h)
        equations += [
            Equation(f"{found.name}_{costate.name}", pn.change(costate), jump)
            for costate, jump in zip(lam, jumps, strict=True)
        ]
        equations.append(Equation(f"{found.name}_H", pn.change(n.HAMILTONIAN), jump_of_h))
    check = identity("the control passes junctions unchanged", kept)
    rule = worded("junctions between levels" if switching(so_far) else "junctions", problem)
    return Step("junction_conditions", rule, tuple(equations), (STEP, "control_law"), (check,))


def _moved_by_jump(
    so_far: Derivation, found: Constraint, before: Mapping[sp.Symbol, sp.Expr]
) -> tuple[list[sp.Expr], list[sp.Expr]]:
    """Return the change that a jump of the costates makes to the condition for the control, and what must vanish.

    For order one this is g' under the law, which changes by a multiple of zeta, or H_u where the control is its root,
    which changes by zeta times the effect of controls on g'. For order two it is the law, or H_u, which must not
    change.
    """
    zeta = pn.jump(found.name)
    if stationary(so_far):
        controls = symbols_of(so_far.model.controls)
        h, effects = so_far.equation("hamiltonian.H").rhs, gradient(found.rates[1], controls)
        shifts = [slope.xreplace(before) - slope for slope in gradient(h, controls)]
        if found.order > 1:
            return [], shifts
        factor = sign(problem_of(so_far)) * zeta
        return effects, [shift - factor * effect for shift, effect in zip(shifts, effects, strict=True)]
    if found.order > 1:
        deciding = _vanishing(so_far, found)[:1] if switching(so_far) else free_law(so_far).values()
        return [], [value.xreplace(before) - value for value in deciding]
    vanishing = _vanishing(so_far, found)[0]
    moved = simplify((vanishing.xreplace(before) - vanishing) / zeta)
    return [moved], [sp.diff(moved, zeta)]


def constraints(so_far: Derivation) -> list[Constraint]:
    """Return all path constraints on states alone, with their derivatives as the step has them."""
    if STEP not in so_far:
        return []
    stated = {e.name: e.rhs for e in so_far.step(STEP).equations}
    found = []
    for name in pn.of_states(problem_of(so_far)):
        orders = [k for k in range(pn.HIGHEST + 1) if pn.entry(name, k) in stated]
        found.append(Constraint(name, tuple(stated[pn.entry(name, k)] for k in orders)))
    return found


def _differentiated(so_far: Derivation, name: str) -> Constraint:
    problem = problem_of(so_far)
    motion, controls = motion_of(so_far), set(symbols_of(so_far.model.controls))
    what = f"{so_far.name}: path_constraints {name}"
    rates = [sp.sympify(problem.path_constraints[name])]
    for _ in range(pn.HIGHEST):
        rates.append(tidy(simplified(total_derivative(rates[-1], motion)), tuple(sorted(controls, key=str))))
        if rates[-1].free_symbols & controls:
            return Constraint(name, tuple(rates))
    if _uncontrolled(rates[-1], motion, controls):
        raise DerivationError(f"{what}: no control influences it, so it cannot be enforced", ("path_constraints",))
    raise DerivationError(
        f"{what}: its order exceeds {pn.HIGHEST}, the highest order that is supported", ("path_constraints",)
    )


def _uncontrolled(rate: sp.Expr, motion: Mapping[sp.Symbol, sp.Expr], controls: set[sp.Symbol]) -> bool:
    """Tell whether no control enters any time derivative; there are no new ones after as many as states."""
    for _ in motion:
        rate = total_derivative(rate, motion)
        if depends(rate, controls):
            return False
    return True


def affine(so_far: Derivation, found: Constraint, controls: tuple[sp.Symbol, ...]) -> tuple[sp.Matrix, sp.Expr]:
    """Return the factors of the controls in g^(q), and the rest of it."""
    effect = sp.Matrix(gradient(found.rates[-1], controls)).applyfunc(simplified)
    if any(e.free_symbols & set(controls) for e in effect):
        raise DerivationError(
            f"{so_far.name}: path_constraints {found.name}: the controls enter "
            f"{'its rate' if found.order else 'it'} nonlinearly, so the control on the boundary cannot be "
            "derived",
            ("path_constraints",),
        )
    return effect, found.rates[-1].xreplace(dict.fromkeys(controls, sp.Integer(0)))


def stationary(so_far: Derivation) -> bool:
    """Tell whether controls stay symbols at which H_u vanishes, because H is not known to be quadratic in them."""
    return CONTROL_PARTS in so_far


def switching(so_far: Derivation) -> bool:
    """Tell whether H is linear in the controls, which are then at bounds, or kept where H does not depend on them."""
    return SWITCHING in so_far


def acting(so_far: Derivation, found: Constraint) -> sp.Symbol:
    """Return the one control that occurs in the last time derivative of a constraint.

    Raises
    ------
    DerivationError
        If several do.
    """
    (first, *more) = [u for u in symbols_of(so_far.model.controls) if found.rates[-1].has(u)]
    if more:
        raise DerivationError(
            f"{so_far.name}: path_constraints {found.name}: the controls {', '.join(map(str, (first, *more)))} "
            "act on it together and H is linear in the controls, so the control that holds the motion on the "
            "boundary cannot be derived",
            ("path_constraints",),
        )
    return first


def free_law(so_far: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """Return the unbounded control that minimises H; empty where the controls stay symbols."""
    if stationary(so_far) or switching(so_far):
        return {}
    controls = symbols_of(so_far.model.controls)
    return {u: so_far.equation(f"stationarity.{u.name}_hat").rhs for u in controls}


def _vanishing(so_far: Derivation, found: Constraint) -> tuple[sp.Expr, ...]:
    """Return what vanishes on the boundary besides g, ..., g^(q-1): g^(q) under the law, and q - 1 derivatives of it.

    Where H is linear in the controls, it is the switching function of the control that acts on the boundary.
    """
    if switching(so_far):
        steps = (SWITCHING, "switching_rate")[: found.order]
        return tuple(so_far.equation(f"{step}.{acting(so_far, found).name}").rhs for step in steps)
    vanishing = [tidy(simplified(found.rates[-1].xreplace(free_law(so_far))))]
    moving = canonical(so_far, found)
    for _ in range(found.order - 1):
        vanishing.append(tidy(simplified(total_derivative(vanishing[-1], moving))))
    return tuple(vanishing)


def canonical(so_far: Derivation, found: Constraint) -> dict[sp.Symbol, sp.Expr]:
    """Return the rates of states and costates on the boundary, with the multiplier as a symbol."""
    states, law = symbols_of(so_far.model.states), free_law(so_far)
    force = -sign(problem_of(so_far)) * pn.multiplier(found.name)
    rates = so_far.rhs("costate_equations")
    moving = {x: rate.xreplace(law) for x, rate in motion_of(so_far).items()}
    for x, lam, rate in zip(states, costates(so_far), rates, strict=True):
        moving[lam] = tidy(rate.xreplace(law) + force * sp.diff(found.rates[0], x))
    return moving | (rates_of_controls(so_far, moving) if stationary(so_far) else {})


def rates_of_controls(so_far: Derivation, moving: Mapping[sp.Symbol, sp.Expr]) -> dict[sp.Symbol, sp.Expr]:
    """Return the rates of the controls at which H_u vanishes, from H_uu u' = -d/dt H_u without them."""
    controls, h = symbols_of(so_far.model.controls), so_far.equation("hamiltonian.H").rhs
    drift = sp.Matrix([total_derivative(slope, moving) for slope in gradient(h, controls)])
    rates = -sp.hessian(h, controls).applyfunc(simplify).LUsolve(drift)
    return {u: tidy(simplified(rate)) for u, rate in zip(controls, rates, strict=True)}


def motion_of(so_far: Derivation) -> dict[sp.Symbol, sp.Expr]:
    """Return the rate of each state."""
    return dict(zip(symbols_of(so_far.model.states), so_far.rhs("first_order"), strict=True))


def rates_along(rates: tuple[sp.Expr, ...], motion: Mapping[sp.Symbol, sp.Expr]) -> Check:
    """Check each time derivative of a constraint against the numeric one of the one before it."""
    values, derived, pace = numeric(list(rates[:-1])), numeric(list(rates[1:])), numeric(list(motion.values()))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        speed = dict(zip(motion, pace(point), strict=True))

        def later(h: Any) -> list[Any]:
            return values({**point, t: point[t] + h, **{x: point[x] + h * speed[x] for x in motion}})

        return derived(point), slopes(later)

    symbols = {t, *motion}.union(*(e.free_symbols for e in (*rates, *motion.values())))
    return compare("numeric rates along the motion", symbols, sides)


def adjoined(so_far: Derivation, found: Constraint, rates: list[sp.Expr], law: Mapping[sp.Symbol, sp.Expr]) -> Check:
    """Check costate rates under a law against numeric derivatives of H with the constraint adjoined."""
    states = symbols_of(so_far.model.states)
    rates = [rate.xreplace(dict(law)) for rate in rates]
    penalty = pn.multiplier(found.name) * found.rates[0]
    h = so_far.equation("hamiltonian.H").rhs
    whole = h + penalty if problem_of(so_far).convention == "minimum" else h - penalty
    value, controls, derived = numeric([whole]), numeric(list(law.values())), numeric(rates)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        here = {**point, **dict(zip(law, controls(point), strict=True))}
        return derived(point), [-partial(value, here, x)[0] for x in states]

    symbols = whole.free_symbols.union(states, *(e.free_symbols for e in (*rates, *law.values()))) - set(law)
    return compare("numeric derivative", symbols, sides)


def _cheapest_on_boundary(so_far: Derivation, found: Constraint, laws: list[sp.Expr], direction: int) -> Check:
    """Check H against its value for other controls with g^(q) = 0: the law moved, and brought back to the boundary."""
    controls, h = symbols_of(so_far.model.controls), so_far.equation("hamiltonian.H").rhs
    effect, _ = affine(so_far, found, controls)
    value, chosen, push = numeric([h]), numeric(laws), numeric(list(effect))

    def margins(point: Point, rng: random.Random) -> list[Any]:
        law, along = chosen(point), push(point)
        best, size = value({**point, **dict(zip(controls, law, strict=True))})[0], sum(a * a for a in along)
        found = []
        for _ in range(COMPETITORS):
            moved = [rng.uniform(-1.0, 1.0) for _ in law]
            back = sum(a * b for a, b in zip(along, moved, strict=True)) / size
            other = [u + m - back * a for u, m, a in zip(law, moved, along, strict=True)]
            found.append(direction * (value({**point, **dict(zip(controls, other, strict=True))})[0] - best))
        return found

    symbols = h.free_symbols.union(*(e.free_symbols for e in (*laws, *effect)))
    return never_below(worded("cheapest on the boundary", problem_of(so_far)), symbols, margins)


def problem_of(so_far: Derivation) -> Problem:
    """Return the problem of a derivation, which must have one."""
    assert so_far.problem is not None
    return so_far.problem
