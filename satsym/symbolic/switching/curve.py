"""Minimum time in closed form: the curve on which a bounded control switches, and the law as a function of the state.

For two states, a chain of two integrators, the switching function is linear in time and so changes its sign once at
most: the last arc is one of the two motions under a bound that arrive at the target. Together they are the switching
curve. Off the curve the control is the one whose arc meets the curve later.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of, simplify
from satsym.symbolic.checks import Point, compare, numeric
from satsym.symbolic.derivation import Check, Derivation, Equation, Step
from satsym.symbolic.factoring import factored
from satsym.symbolic.functions.minimisers import Switch
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle import control_sets
from satsym.symbolic.principle.pontryagin import costates
from satsym.symbolic.switching import notation as s
from satsym.symbolic.switching.functions import parts, written_out

CURVE, FEEDBACK, RESTS = "switching_curve", "switching_feedback", "rest_to_rest"
"""Names of the three steps on a switching curve."""
_CLOCK = sp.Dummy("time", real=True)


def states_of(derivation: Derivation) -> tuple[str, str] | None:
    """Return the names of position and rate of a derivation with a switching curve."""
    chain = chain_of(derivation) if CURVE in derivation else None
    return (chain.position.name, chain.rate.name) if chain else None


def switching_curve(so_far: Derivation) -> Step | None:
    """Derive the arcs that arrive at the target, and the curve that they form."""
    chain = chain_of(so_far)
    if chain is None:
        return None
    low, high = chain.falling, chain.rising
    v, (q_f, v_f) = chain.rate, chain.target
    rising, falling = (_arc(chain, bound) for bound in (high, low))
    # (v^2 - v_f^2) times the sign of v - v_f is |v - v_f| (v + v_f): one expression for both arcs
    mean, half = (sp.expand(rising + falling) / 2, sp.expand(falling - rising) / 2)
    slower = (v + v_f) * ((1 / high + 1 / low) * (v - v_f) - (1 / high - 1 / low) * sp.Abs(v - v_f))
    curve = chain.slope / (4 * chain.gain) * slower
    assert simplify(mean + half * sp.sign(v - v_f) - curve.replace(sp.Abs, lambda e: e * sp.sign(e))) == 0
    equations = (
        Equation("rising", chain.position - q_f, rising),
        Equation("falling", chain.position - q_f, falling),
        Equation("curve", s.ON_CURVE, q_f + curve),
    )
    checks = (arrives(so_far, chain, curve, _law(chain)),)
    return Step(CURVE, "eliminate time", equations, ("first_order", "switching_rate", "boundary_conditions"), checks)


def switching_feedback(so_far: Derivation) -> Step | None:
    """Derive the time-optimal control as a function of the state: the side of the curve decides."""
    if CURVE not in so_far or (chain := chain_of(so_far)) is None:
        return None
    beyond = chain.position - so_far.equation(f"{CURVE}.curve").rhs
    equations = (
        Equation("beyond", s.BEYOND_CURVE, chain.position - s.ON_CURVE),
        Equation("side", s.SIDE, _side(chain)),
        Equation(chain.control.name, n.optimal(chain.control), _levels(chain)),
    )
    checks = (extremal(so_far, chain, beyond, _law(chain)),)
    return Step(FEEDBACK, "side of the curve", equations, (CURVE, "control_law"), checks)


def rest_to_rest(so_far: Derivation) -> Step | None:
    """Derive the time that a change of position takes from rest to rest, and its first arc."""
    if FEEDBACK not in so_far or (chain := chain_of(so_far)) is None:
        return None
    duration, first = _between_rests(chain)
    equations = (Equation("duration", s.TRANSITION, duration), Equation("first", s.FIRST_ARC, first))
    checks = (between_rests(so_far, chain, _law(chain), duration, first),)
    return Step(RESTS, "two arcs between rests", equations, ("first_order", FEEDBACK), checks)


def _side(chain: Chain) -> sp.Expr:
    """Return the sign of the distance from the curve; on the curve, the sign of the arc."""
    return sp.sign(s.BEYOND_CURVE) + (1 - sp.sign(s.BEYOND_CURVE) ** 2) * sp.sign(chain.rate - chain.target[1])


def _levels(chain: Chain) -> sp.Expr:
    """Return the bound that applies on each side of the curve."""
    return Switch(s.SIDE, sp.Integer(0), chain.falling, chain.rising)


def _law(chain: Chain) -> sp.Expr:
    """Return the control as a function of the distance from the curve and the rate."""
    return _levels(chain).xreplace({s.SIDE: _side(chain)})


def chain_of(so_far: Derivation) -> Chain | None:
    """Return the two integrators of a problem in which only time costs; ``None`` for other problems."""
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
    """Return position and rate after a time under a constant control."""
    rate = start[1] + sp.integrate(chain.gain * bound, (_CLOCK, 0, _CLOCK))
    position = start[0] + sp.integrate(chain.slope * rate, (_CLOCK, 0, _CLOCK))
    return position.xreplace({_CLOCK: time}), rate.xreplace({_CLOCK: time})


def _arc(chain: Chain, bound: sp.Symbol) -> sp.Expr:
    """Return position, relative to the target, as a function of the rate on the arc that arrives under a bound."""
    before = sp.Dummy("before", real=True)
    position, rate = _moved(chain, bound, before, chain.target)
    (moment,) = sp.solve(rate - chain.rate, before)
    return factored(simplify(position.xreplace({before: moment}) - chain.target[0]))


def _between_rests(chain: Chain) -> tuple[sp.Expr, sp.Expr]:
    """Return the time from rest to rest, and the duration of the first of its two arcs."""
    duration, first = (sp.Dummy(name, positive=True) for name in ("duration", "first"))
    way = chain.target[0] - chain.position
    found = []
    for level, last in ((chain.rising, chain.falling), (chain.falling, chain.rising)):
        middle = _moved(chain, level, first, (sp.Integer(0), sp.Integer(0)))
        end = _moved(chain, last, duration - first, middle)
        (fraction,) = sp.solve(end[1], first)
        found.append((factored(fraction / duration), factored(end[0].xreplace({first: fraction}) / duration**2)))
    (fraction, reached), (other, _) = found
    side = sp.sign(way)
    total = sp.sqrt(sp.Abs(way) * sp.expand(1 / reached))
    return total, s.TRANSITION * (factored(fraction + other) / 2 + factored(fraction - other) / 2 * side)


@dataclass(frozen=True)
class Chain:
    """Two integrators: ``position' = slope * rate``, ``rate' = gain * control``; slope and gain are constants.

    The slope is positive. `falling` and `rising` are the bounds under which the rate falls and rises, if zero lies
    between them.
    """

    position: sp.Symbol
    rate: sp.Symbol
    control: sp.Symbol
    slope: sp.Expr
    gain: sp.Expr
    falling: sp.Symbol
    rising: sp.Symbol

    @property
    def target(self) -> tuple[sp.Symbol, sp.Symbol]:
        """Return the given final values of position and rate."""
        return n.target(self.position), n.target(self.rate)


def arrives(so_far: Derivation, chain: Chain, curve: sp.Expr, law: sp.Expr) -> Check:
    """Check that the law leads from points of the curve to the target."""
    motion = _Motion(so_far, chain)
    place, control = numeric([chain.target[0] + curve]), numeric([law])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        here = motion.start(point)
        here[chain.position] = place(here)[0]
        end = motion.last_arc(here, control({**here, s.BEYOND_CURVE: mp.mpf(0)})[0])
        return motion.states(end), motion.targets(here)

    return compare("the curve leads to the target", motion.symbols(curve, law), sides)


def extremal(so_far: Derivation, chain: Chain, beyond: sp.Expr, law: sp.Expr) -> Check:
    """Check that the law arrives from any state, and that costates with H = 0 give the same controls."""
    motion, control = _Motion(so_far, chain), numeric([law])
    distance = numeric([beyond])
    optimal = numeric(written_out(so_far, [so_far.equation(f"control_law.{chain.control.name}").rhs]))
    found = parts(so_far)
    vanishing, lam = numeric([found.switching[0], found.drift]), costates(so_far)

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        start = motion.start(point)
        start[s.BEYOND_CURVE] = distance(start)[0]
        first = control(start)[0]
        time = _until(lambda time: distance(motion.after(start, first, time))[0] / start[s.BEYOND_CURVE] < 0)
        switch = motion.after(start, first, time)
        last = control({**switch, s.BEYOND_CURVE: mp.mpf(0)})[0]
        switch |= _zeros(vanishing, switch, lam)
        before, end = motion.after(switch, first, -time / 2), motion.last_arc(switch, last)
        expected = [optimal(before)[0], optimal(end)[0], *motion.targets(start)]
        return [first, last, *motion.states(end)], expected

    symbols = motion.symbols(beyond, law, *found.switching, found.drift)
    return compare("the law is that of the costates", symbols, sides)


def between_rests(so_far: Derivation, chain: Chain, law: sp.Expr, duration: sp.Expr, first: sp.Expr) -> Check:
    """Check that two arcs of these durations lead from rest to rest."""
    motion, control = _Motion(so_far, chain), numeric([law])
    times = numeric([duration, first.xreplace({s.TRANSITION: duration})])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        start = motion.start(point) | {chain.rate: mp.mpf(0), chain.target[1]: mp.mpf(0)}
        whole, until = times(start)
        way = start[chain.position] - start[chain.target[0]]
        levels = [control({**start, s.BEYOND_CURVE: side * way})[0] for side in (1, -1)]
        end = motion.after(motion.after(start, levels[0], until), levels[1], whole - until)
        return motion.states(end), motion.targets(start)

    return compare("from rest to rest", motion.symbols(law, duration, first), sides)


class _Motion:
    """States and costates under a constant control, integrated numerically."""

    def __init__(self, so_far: Derivation, chain: Chain) -> None:
        constants = definitions_of(so_far.model)
        self.chain = chain
        self.moving = [*symbols_of(so_far.model.states), *costates(so_far)]
        self.slopes = [e.xreplace(constants) for e in (*so_far.rhs("first_order"), *so_far.rhs("costate_equations"))]
        self.rates = numeric(self.slopes)

    def symbols(self, *expressions: sp.Expr) -> set[sp.Symbol]:
        """Return the symbols that need values in a check."""
        chain = self.chain
        needed = {n.TIME, *self.moving, chain.control, chain.falling, chain.rising, *chain.target}
        return needed.union(*(e.free_symbols for e in (*expressions, *self.slopes)))

    def start(self, point: Point) -> Point:
        """Return a point changed such that zero lies between the bounds."""
        low, high = sorted((self.chain.falling, self.chain.rising), key=lambda bound: bound.name.endswith("_max"))
        return {**point, low: -abs(point[low]), high: abs(point[high])}

    def states(self, here: Point) -> list[Any]:
        return [here[self.chain.position], here[self.chain.rate]]

    def targets(self, here: Point) -> list[Any]:
        return [here[target] for target in self.chain.target]

    def after(self, here: Point, control: Any, time: Any) -> Point:
        """Return the values after a time: one step of RK4, exact for polynomials of time up to t^4."""
        held = {**here, self.chain.control: control}

        def rates(shift: Any, by: list[Any]) -> list[Any]:
            moved = {z: held[z] + shift * k for z, k in zip(self.moving, by, strict=True)}
            return list(self.rates({**held, **moved}))

        k1 = rates(mp.mpf(0), [mp.mpf(0)] * len(self.moving))
        k2 = rates(time / 2, k1)
        k3 = rates(time / 2, k2)
        k4 = rates(time, k3)
        steps = zip(self.moving, k1, k2, k3, k4, strict=True)
        return {**held, **{z: held[z] + time / 6 * (a + 2 * b + 2 * c + d) for z, a, b, c, d in steps}}

    def last_arc(self, here: Point, control: Any) -> Point:
        """Return the values after the time that the rate needs to its target at the absolute value of its slope."""
        slope = self.rates({**here, self.chain.control: control})[self.moving.index(self.chain.rate)]
        return self.after(here, control, abs((here[self.chain.target[1]] - here[self.chain.rate]) / slope))


def _until(crossed: Callable[[Any], bool]) -> Any:
    """Find the time of the first crossing by bisection."""
    early, late = mp.mpf(0), mp.mpf(1)
    while not crossed(late) and late < mp.mpf(2) ** 60:
        late *= 2
    for _ in range(mp.mp.prec + 10):
        middle = (early + late) / 2
        early, late = (early, middle) if crossed(middle) else (middle, late)
    return late


def _zeros(functions: Callable[[Point], list[Any]], here: Point, unknown: tuple[sp.Symbol, ...]) -> Point:
    """Solve for the unknowns at which affine functions vanish."""
    none = {**here, **dict.fromkeys(unknown, mp.mpf(0))}
    constant = mp.matrix(functions(none))
    columns = [mp.matrix(functions({**none, symbol: mp.mpf(1)})) - constant for symbol in unknown]
    matrix = mp.matrix(len(constant), len(unknown))
    for k, column in enumerate(columns):
        for i in range(len(constant)):
            matrix[i, k] = column[i]
    return dict(zip(unknown, mp.lu_solve(matrix, -constant), strict=True))
