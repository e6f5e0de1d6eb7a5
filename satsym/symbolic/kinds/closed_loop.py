"""A linear law that follows a command: what may be stated, and the steps that are derived from it.

These are small motions about rest, transfer functions, poles, and critical damping.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import simplify, tidy, vanishes
from satsym.symbolic.checks import Point, compare, identity, numeric, partial
from satsym.symbolic.derivation import Derivation, DerivationError, Equation, Step
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over, power_of, product
from satsym.symbolic.factoring import factored
from satsym.symbolic.kinds import commanded as cn
from satsym.symbolic.kinds import step_answers
from satsym.symbolic.kinds.commanded import COMMAND, SECONDS, Statement, control_of, loop_of, s
from satsym.symbolic.kinds.derived import original_equations
from satsym.symbolic.model import MaybeStep, Problem, Requirement, symbols_of
from satsym.symbolic.motion import steps as motion


def linearised_about_rest(so_far: Derivation) -> Step:
    """The equations of motion, to first order about rest."""
    model = loop_of(so_far)
    states, control = symbols_of(model.states), control_of(model)
    rates = so_far.rhs("original_equations")
    rest = dict.fromkeys((*states, control), sp.Integer(0))
    if not all(vanishes(e) for e in rates.xreplace(rest)):
        raise DerivationError(f"{model.name}: the state of rest does not satisfy the equations of {model.of.name}")
    linear = rates.jacobian([*states, control]).xreplace(rest) * sp.Matrix([*states, control])
    equations = tuple(Equation(x.name, n.rate_of(x), tidy(f)) for x, f in zip(states, linear, strict=True))
    exact, found = numeric(list(rates)), numeric(list(linear))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        slopes = [partial(exact, {**point, **dict.fromkeys(rest, mp.mpf(0))}, x) for x in rest]
        total = [sum(column[k] * point[x] for column, x in zip(slopes, rest, strict=True)) for k in range(len(states))]
        return found(point), total

    check = compare("numeric derivative", rates.free_symbols | {*rest}, sides)
    return Step("small_motions", "first order about rest", equations, ("original_equations",), (check,))


def control_law(so_far: Derivation) -> Step:
    """The law as stated, and as a function of transforms."""
    model = loop_of(so_far)
    equations = (Equation("law", control_of(model), sp.sympify(model.law)),)
    allowed = {s, COMMAND, *symbols_of(model.gains), *symbols_of(model.states), *symbols_of(model.of.parameters)}
    inputs = [COMMAND, *symbols_of(model.states)]
    linear = sum(sp.diff(model.law, x) * x for x in inputs)
    foreign = sp.sympify(model.law).free_symbols - allowed
    if foreign or sp.expand(linear - model.law) != 0:
        raise DerivationError(
            f"{model.name}: the law must be linear in the states and the command, and must contain no other symbols"
        )
    proof = identity("linear in states and command", [linear - model.law])
    return Step("law", "given law", equations, ("small_motions",), (proof,))


def transfer_functions(so_far: Derivation) -> Step:
    """From the command to each state and to the control, by Laplace transforms from rest."""
    model = loop_of(so_far)
    states, control = symbols_of(model.states), control_of(model)
    unknown = [*states, control]
    conditions = [s * x - f for x, f in zip(states, so_far.rhs("small_motions"), strict=True)]
    conditions.append(control - model.law)
    solved = sp.solve(conditions, unknown, dict=True)
    if len(solved) != 1:
        raise DerivationError(f"{model.name}: the loop has no transfer functions")
    ratios = {x: _as_ratio(solved[0][x] / COMMAND) for x in unknown}
    equations = tuple(Equation(x.name, cn.transfer_to(x), ratio) for x, ratio in ratios.items())
    system = sp.Matrix(conditions)
    matrix, right = numeric(list(system.jacobian(unknown))), numeric(list(-system.jacobian([COMMAND])))
    found = numeric(list(ratios.values()))

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """The transforms by elimination, in numbers."""
        size = len(unknown)
        return found(point), list(mp.lu_solve(_square(matrix(point), size), right(point)))

    check = compare("solved by elimination", system.free_symbols - {*unknown, COMMAND}, sides)
    return Step("transfer_function", "Laplace transform", equations, ("small_motions", "law"), (check,))


def poles_and_zeros(so_far: Derivation) -> Step:
    """Zeros of the denominator and of the numerator on the way to the state that follows."""
    model = loop_of(so_far)
    numerator, denominator = sp.fraction(so_far.equation(f"transfer_function.{model.follows.name}").rhs)
    lead = sp.Poly(denominator, s).LC()
    polynomial = sp.Add(*(simplify(c / lead) * s**k for (k,), c in sp.Poly(denominator, s).terms()))
    poles, zeros = (sorted(sp.roots(sp.Poly(e, s)), key=str) for e in (denominator, numerator))
    if not 0 < len(poles) <= 2:
        raise DerivationError(f"{model.name}: the loop must be of second order to be critically damped")
    equations = [Equation("characteristic_polynomial", cn.POLYNOMIAL, polynomial)]
    equations += [Equation(f"pole_{k}", cn.pole(k), tidy(simplify(p))) for k, p in enumerate(poles, 1)]
    equations += [Equation(f"zero_{k}", cn.zero(k), simplify(z)) for k, z in enumerate(zeros, 1)]
    vanish = [denominator.xreplace({s: p}) for p in poles] + [numerator.xreplace({s: z}) for z in zeros]
    proof = identity("roots of both polynomials", vanish)
    return Step("poles_and_zeros", "roots", tuple(equations), ("transfer_function",), (proof,))


def critical_damping(so_far: Derivation) -> Step:
    """The gains with which both poles are where the damping says."""
    model = loop_of(so_far)
    gains, (damping,) = symbols_of(model.gains), symbols_of((model.damping,))
    polynomial = so_far.equation("poles_and_zeros.characteristic_polynomial").rhs
    wanted = sp.Poly(polynomial - (s + damping) ** 2, s).all_coeffs()
    found = sp.solve(wanted, gains, dict=True)
    if len(found) != 1 or set(found[0]) != set(gains):
        raise DerivationError(f"{model.name}: no choice of gains places both poles where they are required")
    equations = tuple(Equation(k.name, k, factored(found[0][k])) for k in gains)
    value = numeric([polynomial, sp.diff(polynomial, s)])
    gain = numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """The polynomial and its slope at the double pole."""
        return value({**point, **dict(zip(gains, gain(point), strict=True)), s: -point[damping]}), [0, 0]

    check = compare(
        "double root", polynomial.free_symbols | {damping}.union(*(e.rhs.free_symbols for e in equations)), sides
    )
    return Step("critical_damping", "double pole", equations, ("poles_and_zeros",), (check,))


def first_order(so_far: Derivation) -> Step:
    """The loop after the step, its gains filled in: a motion without control."""
    model = loop_of(so_far)
    states = symbols_of(model.states)
    (command,) = symbols_of((model.command,))
    gains = {e.lhs: e.rhs for e in so_far.step("critical_damping").equations}
    law = sp.expand(sp.sympify(model.law)).xreplace(gains)
    rates = dict(zip(states, so_far.rhs("small_motions"), strict=True))
    later = sp.Integer(0)
    for (power,), coefficient in sp.Poly(law, s).terms():
        value = coefficient
        for _ in range(power):
            value = sum(sp.diff(value, x) * rates[x] for x in states)  # the command is constant after the step
        later += value
    control = control_of(model)
    found = sp.solve(later.xreplace({COMMAND: command}) - control, control)
    if len(found) != 1:
        raise DerivationError(f"{model.name}: the law does not determine the control")
    closed = {x: tidy(simplify(rate.xreplace({control: found[0]}))) for x, rate in rates.items()}
    equations = tuple(Equation(x.name, n.rate_of(x), closed[x]) for x in states)
    answers = {x: so_far.equation(f"step_response.{x.name}").rhs for x in states}
    proof = identity(
        "the answer to a step obeys them",
        [sp.diff(answers[x], SECONDS) - closed[x].xreplace(answers).xreplace(dict(model.where)) for x in states],
    )
    return Step("first_order", "law put in", equations, ("small_motions", "law", "critical_damping"), (proof,))


def _as_ratio(expression: sp.Expr) -> sp.Expr:
    """A ratio of polynomials whose denominator has the leading coefficient 1."""
    numerator, denominator = sp.fraction(sp.cancel(sp.together(expression)))
    lead = sp.Poly(denominator, s).LC()
    above = sp.Poly(sp.cancel(numerator / lead), s)
    below = sp.Poly(sp.cancel(denominator / lead), s)
    written = [sp.Add(*(factored(c) * s**k for (k,), c in p.terms())) for p in (above, below)]
    return sp.factor_terms(written[0]) / written[1]


def _square(entries: list[Any], size: int) -> Any:
    return mp.matrix([entries[k * size : (k + 1) * size] for k in range(size)])


@dataclass(frozen=True, kw_only=True)
class ClosedLoop(Statement):
    """Small motions about rest under a linear law that follows a command, critically damped.

    Its controls are none: the law takes their place. Its states are those of the motion.
    What is stated of it: :class:`~satsym.symbolic.kinds.commanded.Statement`.
    """

    def steps(self) -> tuple[MaybeStep, ...]:
        """Small motions, the law, transfer functions, and the answer to a step."""
        return (
            original_equations,
            linearised_about_rest,
            control_law,
            transfer_functions,
            poles_and_zeros,
            critical_damping,
            step_answers.step_response,
            step_answers.control_response,
            step_answers.extremes,
            first_order,
            motion.linearisation,
        )

    def stated(self) -> Iterator[tuple[str, list[sp.Expr], set[sp.Symbol]]]:
        """The law, by states and gains."""
        known = set(symbols_of((*self.states, *self.parameters, *self.gains)))
        yield "the law", [self.law], known | {cn.s, cn.COMMAND}

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Transfer functions, poles and answers; time is the old one."""
        return cn.names(self)

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of transforms and answers, and refuse a law, command or damping that has others."""
        super().enter_dimensions(known, require)
        second, control = known[n.TIME.name], cn.control_of(self)
        known[cn.COMMAND.name] = known[self.follows.name]
        known[cn.s.name] = over(PLAIN, second)
        require("the command", symbols_of((self.command,))[0], known[self.follows.name])
        require("the damping", symbols_of((self.damping,))[0], known[cn.s.name])
        require("the law", self.law, known[control.name])
        for symbol in (*symbols_of(self.states), control):
            known[cn.transfer_to(symbol).name] = over(known[symbol.name], known[cn.COMMAND.name])
            known[n.answer_of(symbol).name] = known[cn.final_of(symbol).name] = known[symbol.name]
            known[n.initial(symbol).name] = known[symbol.name]
        impulse = product((known[control.name], second))
        known[cn.impulse_of(control).name] = known[cn.TOTAL_IMPULSE.name] = impulse
        known[cn.SMOOTH_SQUARE.name] = product((impulse, known[control.name]))
        known[cn.FIRST_REACHED.name] = known[cn.HIGHEST_AT.name] = second
        known[cn.OVERSHOOT.name] = PLAIN
        known[cn.POLYNOMIAL.name] = power_of(known[cn.s.name], sp.Integer(2))
        for k in (1, 2):
            known[cn.pole(k).name] = known[cn.zero(k).name] = known[cn.s.name]
