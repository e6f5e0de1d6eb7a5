"""Least time in closed form: the curve on which a bounded control switches, and the law that it makes of the state.

In two states, a chain of two integrators, the switching function is linear in time and so changes its sign once at
most: the last arc is one of the two motions under a bound that arrive at the target. Together they are the switching
curve. Off it the control is the one whose arc has yet to meet the curve.
"""

from __future__ import annotations

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, simplify
from satsym.symbolic.derivation import Derivation, Equation, Step
from satsym.symbolic.factoring import as_factors
from satsym.symbolic.functions.minimisers import Switch
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle import control_sets
from satsym.symbolic.switching import curve_checks
from satsym.symbolic.switching import notation as s
from satsym.symbolic.switching.curve_checks import Chain

STEP = "switching_curve"
_CLOCK = sp.Dummy("time", real=True)


def states_of(derivation: Derivation) -> tuple[str, str] | None:
    """Names of position and rate where there is a switching curve."""
    chain = _chain(derivation) if STEP in derivation else None
    return (chain.position.name, chain.rate.name) if chain else None


def switching_curve(so_far: Derivation) -> Step | None:
    """The arcs that arrive at the target, the curve they make, the law, and how long a change of position takes."""
    chain = _chain(so_far)
    if chain is None:
        return None
    low, high = chain.falling, chain.rising
    q, v = chain.position, chain.rate
    q_f, v_f = chain.target
    rising, falling = (_arc(chain, bound) for bound in (high, low))
    # (v^2 - v_f^2) times the sign of v - v_f is |v - v_f| (v + v_f): one expression for both arcs
    mean, half = (sp.expand(rising + falling) / 2, sp.expand(falling - rising) / 2)
    slower = (v + v_f) * ((1 / high + 1 / low) * (v - v_f) - (1 / high - 1 / low) * sp.Abs(v - v_f))
    curve = chain.slope / (4 * chain.gain) * slower
    assert simplify(mean + half * sp.sign(v - v_f) - curve.replace(sp.Abs, lambda e: e * sp.sign(e))) == 0
    side = sp.sign(s.BEYOND_CURVE) + (1 - sp.sign(s.BEYOND_CURVE) ** 2) * sp.sign(v - v_f)
    stated = Switch(s.SIDE, sp.Integer(0), low, high)
    law = stated.xreplace({s.SIDE: side})
    duration, first = _between_rests(chain)
    equations = (
        Equation("rising", q - q_f, rising),
        Equation("falling", q - q_f, falling),
        Equation("curve", s.ON_CURVE, q_f + curve),
        Equation("beyond", s.BEYOND_CURVE, q - s.ON_CURVE),
        Equation("side", s.SIDE, side),
        Equation(chain.control.name, n.optimal(chain.control), stated),
        Equation("duration", s.TRANSITION, duration),
        Equation("first", s.FIRST_ARC, first),
    )
    checks = (
        curve_checks.arrives(so_far, chain, curve, law),
        curve_checks.extremal(so_far, chain, q - q_f - curve, law),
        curve_checks.between_rests(so_far, chain, law, duration, first),
    )
    sources = ("first_order", "control_law", "switching_rate", "boundary_conditions")
    return Step(STEP, "eliminate time", equations, sources, checks)


def _chain(so_far: Derivation) -> Chain | None:
    """The two integrators, where time alone costs; otherwise nothing."""
    problem, model = so_far.problem, so_far.model
    if problem is None or len(model.states) != 2 or len(model.controls) != 1 or model.reference:
        return None
    if problem.path_constraints:
        return None
    constants = definitions_of(model)
    cost = sp.sympify(problem.running_cost).xreplace(constants)
    if problem.terminal_cost != 0 or problem.end_conditions or not cost.is_positive:
        return None
    states, (control,) = symbols_of(model.states), symbols_of(model.controls)
    if problem.control_set != "box" or cost.free_symbols & {*states, control, n.TIME}:
        return None
    low, high = symbols_of(control_sets.bounds("box", model.controls))
    rates = dict(zip(states, so_far.rhs("first_order").xreplace(constants), strict=True))
    for q, v in (states, states[::-1]):
        slope, gain = sp.diff(rates[q], v), sp.diff(rates[v], control)
        free = slope.free_symbols | gain.free_symbols
        if free & {*states, control, n.TIME} or not slope.is_positive or gain.is_zero is not False:
            continue
        if sp.expand(rates[q] - slope * v) != 0 or sp.expand(rates[v] - gain * control) != 0:
            continue
        if gain.is_positive or gain.is_negative:
            return Chain(q, v, control, slope, gain, *((low, high) if gain.is_positive else (high, low)))
    return None


def _moved(chain: Chain, bound: sp.Expr, time: sp.Expr, start: tuple[sp.Expr, sp.Expr]) -> tuple[sp.Expr, sp.Expr]:
    """Position and rate after a time under a constant control."""
    rate = start[1] + sp.integrate(chain.gain * bound, (_CLOCK, 0, _CLOCK))
    position = start[0] + sp.integrate(chain.slope * rate, (_CLOCK, 0, _CLOCK))
    return position.xreplace({_CLOCK: time}), rate.xreplace({_CLOCK: time})


def _arc(chain: Chain, bound: sp.Symbol) -> sp.Expr:
    """Position, seen from the target, as a function of the rate along the motion under a bound that arrives there."""
    before = sp.Dummy("before", real=True)
    position, rate = _moved(chain, bound, before, chain.target)
    (moment,) = sp.solve(rate - chain.rate, before)
    return as_factors(simplify(position.xreplace({before: moment}) - chain.target[0]))


def _between_rests(chain: Chain) -> tuple[sp.Expr, sp.Expr]:
    """How long the way from rest to rest takes, and the first of its two arcs."""
    duration, first = (sp.Dummy(name, positive=True) for name in ("duration", "first"))
    way = chain.target[0] - chain.position
    found = []
    for level, last in ((chain.rising, chain.falling), (chain.falling, chain.rising)):
        middle = _moved(chain, level, first, (sp.Integer(0), sp.Integer(0)))
        end = _moved(chain, last, duration - first, middle)
        (fraction,) = sp.solve(end[1], first)
        found.append((as_factors(fraction / duration), as_factors(end[0].xreplace({first: fraction}) / duration**2)))
    (fraction, reached), (other, _) = found
    side = sp.sign(way)
    total = sp.sqrt(sp.Abs(way) * sp.expand(1 / reached))
    return total, s.TRANSITION * (as_factors(fraction + other) / 2 + as_factors(fraction - other) / 2 * side)
