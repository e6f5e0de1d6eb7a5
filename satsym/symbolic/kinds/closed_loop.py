"""Closed loops: a linear control law that follows a command, and the steps that are derived from it.

The steps are the linear motion about rest, transfer functions, poles, critical damping, and the step response.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import simplify, tidy, vanishes
from satsym.symbolic.checks import Point, compare, identity, numeric, partial
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.dimension_algebra import PLAIN, Dimension, over, power_of, product
from satsym.symbolic.factoring import factored
from satsym.symbolic.kinds import commanded as cn
from satsym.symbolic.kinds.commanded import COMMAND, SECONDS, Statement, control_of, loop_of, s
from satsym.symbolic.kinds.derived import original_equations
from satsym.symbolic.model import MaybeStep, Problem, Requirement, symbols_of
from satsym.symbolic.motion import steps as motion


def linearised_about_rest(so_far: Derivation) -> Step:
    """Derive the equations of motion to first order about rest."""
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
    """State the control law in time, and as a function of Laplace transforms."""
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
    """Derive the transfer functions from the command to each state and to the control."""
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
        """Return the transforms by numeric elimination, beside the derived ones."""
        size = len(unknown)
        return found(point), list(mp.lu_solve(_square(matrix(point), size), right(point)))

    check = compare("solved by elimination", system.free_symbols - {*unknown, COMMAND}, sides)
    return Step("transfer_function", "Laplace transform", equations, ("small_motions", "law"), (check,))


def poles_and_zeros(so_far: Derivation) -> Step:
    """Find the poles, and the zeros of the transfer function to the state that follows the command."""
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
    """Solve for the gains that make both poles equal to the stated double pole."""
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
        """Return the characteristic polynomial and its slope at the double pole."""
        return value({**point, **dict(zip(gains, gain(point), strict=True)), s: -point[damping]}), [0, 0]

    check = compare(
        "double root", polynomial.free_symbols | {damping}.union(*(e.rhs.free_symbols for e in equations)), sides
    )
    return Step("critical_damping", "double pole", equations, ("poles_and_zeros",), (check,))


def first_order(so_far: Derivation) -> Step:
    """Derive the motion of the closed loop after the step, with its gains filled in."""
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
    """Write an expression as a ratio of polynomials whose denominator has the leading coefficient 1."""
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
    """The linear motion about rest under a control law that follows a command, critically damped.

    It has no controls: the law takes their place. Its states are those of the motion. The declarations are those of
    :class:`~satsym.symbolic.kinds.commanded.Statement`.
    """

    def steps(self) -> tuple[MaybeStep, ...]:
        """List the steps: linear motion, law, transfer functions, and the step response."""
        return (
            original_equations,
            linearised_about_rest,
            control_law,
            transfer_functions,
            poles_and_zeros,
            critical_damping,
            step_response,
            control_response,
            extremes,
            first_order,
            motion.linearisation,
        )

    def stated(self) -> Iterator[tuple[str, list[sp.Expr], set[sp.Symbol]]]:
        """Return the law, which is a function of states and gains."""
        known = set(symbols_of((*self.states, *self.parameters, *self.gains)))
        yield "the law", [self.law], known | {cn.s, cn.COMMAND}

    def names(self, problem: Problem | None) -> dict[str, str]:
        """Map the names of transfer functions, poles and step responses to LaTeX."""
        return cn.names(self)

    def enter_dimensions(self, known: dict[str, Dimension | None], require: Requirement) -> None:
        """Enter the dimensions of transforms and answers, and refuse a law, command or damping of other ones."""
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


def step_response(so_far: Derivation) -> Step:
    """Derive the response of the states to a step of the command."""
    model = loop_of(so_far)
    states = symbols_of(model.states)
    answers = {x: _answer(so_far, x) for x in states}
    if any(impulse != 0 for impulse, _ in answers.values()):
        raise DerivationError(f"{model.name}: the step response of a state contains an impulse")
    special = [Equation(f"where_{symbol.name}", symbol, sp.sympify(value)) for symbol, value in model.where.items()]
    equations = (*special, *(Equation(x.name, n.answer_of(x), value) for x, (_, value) in answers.items()))
    check = _transformed(so_far, {x: (sp.Integer(0), value) for x, (_, value) in answers.items()})
    rule = f"back from transforms{', special case' if special else ''}"
    return Step("step_response", rule, equations, ("transfer_function", "critical_damping"), (check,))


def control_response(so_far: Derivation) -> Step:
    """Derive the control after a step of the command: an impulse, and the control after it."""
    model = loop_of(so_far)
    control = control_of(model)
    impulse, value = _answer(so_far, control)
    equations = (
        Equation("impulse", cn.impulse_of(control), impulse),
        Equation("smooth", n.answer_of(control), value),
        Equation("initial", n.initial(control), value.xreplace({SECONDS: sp.Integer(0)})),
    )
    check = _transformed(so_far, {control: (impulse, value)})
    sources = ("transfer_function", "critical_damping")
    return Step("control_response", "back from transforms, impulse", equations, sources, (check,))


def extremes(so_far: Derivation) -> Step:
    """Derive when the following state first reaches the command, its overshoot, and the final values of all states."""
    model = loop_of(so_far)
    (command,), (damping,) = symbols_of((model.command,)), symbols_of((model.damping,))
    answers = {x: so_far.equation(f"step_response.{x.name}").rhs for x in symbols_of(model.states)}
    followed = answers[model.follows]
    control, impulse = so_far.equation("control_response.smooth").rhs, so_far.equation("control_response.impulse").rhs
    first, highest = _zeros(followed - command, damping), _zeros(sp.diff(followed, SECONDS), damping)
    turns = _zeros(control, damping)
    if not len(first) == len(highest) == len(turns) == 1:
        raise DerivationError(
            f"{model.name}: the step response must have exactly one crossing, one maximum and one change of sign"
        )
    overshoot = simplify(followed.xreplace({SECONDS: highest[0]}) / command - 1)
    before, at_turn = (_integral(control).subs(SECONDS, place) for place in (sp.Integer(0), turns[0]))
    pieces = [impulse, at_turn - before, _in_the_end(_integral(control), damping) - at_turn]
    signs = numeric(pieces)({symbol: mp.mpf(1) for piece in pieces for symbol in piece.free_symbols})
    total = factored(sp.Add(*(piece * (1 if sign > 0 else -1) for piece, sign in zip(pieces, signs, strict=True))))
    square = _integral(sp.expand(control**2))
    squared = factored(_in_the_end(square, damping) - square.subs(SECONDS, 0))
    ends = {x: _in_the_end(value, damping) for x, value in answers.items()}
    starts = {x: value.subs(SECONDS, 0) for x, value in answers.items()}
    equations = [
        Equation("first_reached", cn.FIRST_REACHED, first[0]),
        Equation("highest_at", cn.HIGHEST_AT, highest[0]),
        Equation("overshoot", cn.OVERSHOOT, overshoot),
        *(Equation(f"initial_{x.name}", n.initial(x), simplify(value)) for x, value in starts.items()),
        *(Equation(f"final_{x.name}", cn.final_of(x), simplify(value)) for x, value in ends.items()),
        Equation("total_impulse", cn.TOTAL_IMPULSE, total),
        Equation("smooth_square", cn.SMOOTH_SQUARE, squared),
    ]
    functions = numeric([followed, control])
    found = numeric([first[0], highest[0], overshoot, total, squared, impulse, *turns])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        """Return the same quantities by numeric root search and quadrature."""
        reached, top, beyond, spent, square, sudden, *changes = found(point)

        def at(time: Any, which: int) -> Any:
            return functions({**point, SECONDS: time})[which]

        crossing = mp.findroot(lambda time: at(time, 0) - point[command], reached * 1.01)
        summit = mp.findroot(lambda time: mp.diff(lambda z: at(z, 0), time), top * 1.01)
        places = [0, *changes, *(changes[-1] + k / point[damping] for k in (5, 20, 60)), mp.inf]
        used = sum(abs(mp.quad(lambda z: at(z, 1), [a, b])) for a, b in pairwise(places))
        effort = mp.quad(lambda z: at(z, 1) ** 2, places)
        height = at(summit, 0) / point[command] - 1
        return [reached, top, beyond, spent, square], [crossing, summit, height, used + abs(sudden), effort]

    symbols = (followed.free_symbols | control.free_symbols | impulse.free_symbols) - {SECONDS}
    check = compare("searched and integrated numerically", symbols, sides)
    sources = ("step_response", "control_response")
    return Step("extremes", "crossings and integrals", tuple(equations), sources, (check,))


def _answer(so_far: Derivation, symbol: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Return the impulse and the function of time with which a state or the control responds to the step."""
    model = loop_of(so_far)
    (command,) = symbols_of((model.command,))
    gains = {e.lhs: e.rhs for e in so_far.step("critical_damping").equations}
    image = sp.cancel(
        sp.together((_transfer(so_far, symbol) * command / s).xreplace(gains).xreplace(dict(model.where)))
    )
    numerator, denominator = sp.fraction(image)
    quotient, rest = sp.div(sp.Poly(numerator, s), sp.Poly(denominator, s))
    if quotient.degree() > 0:
        raise DerivationError(f"{model.name}: the step response of {symbol.name} is more singular than an impulse")
    value = sp.Integer(0)
    for part in sp.Add.make_args(sp.apart(factored((rest / denominator).as_expr()), s)):
        above, below = sp.fraction(sp.together(part))
        ((root, order),) = sp.roots(sp.Poly(below, s)).items() if below.has(s) else ((sp.Integer(0), 0),)
        if order:
            lead = sp.Poly(below, s).LC()
            value += above / lead * SECONDS ** (order - 1) / sp.factorial(order - 1) * sp.exp(root * SECONDS)
    (damping,) = symbols_of((model.damping,))
    return factored(quotient.as_expr()), sp.collect(sp.expand(value), sp.exp(-damping * SECONDS), factored)


def _zeros(answer: sp.Expr, damping: sp.Symbol) -> list[sp.Expr]:
    """Return the zeros of e^(-E t) times a polynomial in time."""
    polynomial = sp.Poly(sp.expand(sp.expand(answer) * sp.exp(damping * SECONDS)), SECONDS)
    return [simplify(root) for root in sp.roots(polynomial)]


def _integral(answer: sp.Expr) -> sp.Expr:
    return sp.expand(sp.integrate(sp.expand(answer), SECONDS))


def _in_the_end(answer: sp.Expr, damping: sp.Symbol) -> sp.Expr:
    """Return the limit of a response as time grows, when all decaying terms have vanished."""
    return factored(
        sp.expand(answer).replace(lambda e: isinstance(e, sp.exp) and e.has(damping), lambda _: sp.Integer(0))
    )


def _transformed(so_far: Derivation, answers: dict[sp.Symbol, tuple[sp.Expr, sp.Expr]]) -> Check:
    """Check step responses by their numeric Laplace integrals."""
    model = loop_of(so_far)
    (command,), (damping,) = symbols_of((model.command,)), symbols_of((model.damping,))
    gains = {e.lhs: e.rhs for e in so_far.step("critical_damping").equations}
    images = [(_transfer(so_far, x) * command / s).xreplace(gains).xreplace(dict(model.where)) for x in answers]
    expected = numeric(images)
    values, impulses = [numeric([v]) for _, v in answers.values()], numeric([i for i, _ in answers.values()])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        here = {**point, s: abs(point[s]) + 1}
        places = [0, *(k / (here[s] + here[damping]) for k in (2, 10, 40)), mp.inf]

        def image(value: Callable[[Point], list[Any]]) -> Any:
            return mp.quad(lambda time: mp.exp(-here[s] * time) * value({**here, SECONDS: time})[0], places)

        return [i + image(value) for i, value in zip(impulses(here), values, strict=True)], expected(here)

    symbols = set().union(*(e.free_symbols for e in images), *(v.free_symbols for _, v in answers.values())) - {SECONDS}
    return compare("Laplace integral", symbols | {s, damping}, sides)


def _transfer(so_far: Derivation, symbol: sp.Symbol) -> sp.Expr:
    return so_far.equation(f"transfer_function.{symbol.name}").rhs
