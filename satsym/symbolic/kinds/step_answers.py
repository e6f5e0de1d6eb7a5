"""The answer of a closed loop to a step in closed form: states, control, extremes and totals.

Everything starts from rest. The derivative of a step is an impulse; an ideal differentiator passes it on.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import simplify
from satsym.symbolic.checks import Point, compare, numeric
from satsym.symbolic.derivation import Check, Derivation, DerivationError, Equation, Step
from satsym.symbolic.factoring import factored
from satsym.symbolic.kinds import commanded as cn
from satsym.symbolic.kinds.commanded import SECONDS, control_of, loop_of, s
from satsym.symbolic.model import symbols_of


def step_response(so_far: Derivation) -> Step:
    """How the states answer to a step of the command."""
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
    """What the control does meanwhile: an impulse when the command steps, and what comes after."""
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
    """When the following state first reaches the command, how far it goes beyond, and where all states end."""
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
        """Root search and quadrature."""
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
    """The impulse and the function of time with which a state or the control answers to the step."""
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
    """Zeros of e^(-E t) times a polynomial in time."""
    polynomial = sp.Poly(sp.expand(sp.expand(answer) * sp.exp(damping * SECONDS)), SECONDS)
    return [simplify(root) for root in sp.roots(polynomial)]


def _integral(answer: sp.Expr) -> sp.Expr:
    return sp.expand(sp.integrate(sp.expand(answer), SECONDS))


def _in_the_end(answer: sp.Expr, damping: sp.Symbol) -> sp.Expr:
    """What is left of an answer when all that decays has decayed."""
    return factored(
        sp.expand(answer).replace(lambda e: isinstance(e, sp.exp) and e.has(damping), lambda _: sp.Integer(0))
    )


def _transformed(so_far: Derivation, answers: dict[sp.Symbol, tuple[sp.Expr, sp.Expr]]) -> Check:
    """Check answers by their Laplace integrals, in numbers."""
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
