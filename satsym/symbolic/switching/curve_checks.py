"""Checks of a switching curve, by following the motion: arrival at the target, and costates with H = 0."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.checks import Point, compare, numeric
from satsym.symbolic.derivation import Check, Derivation
from satsym.symbolic.model import symbols_of
from satsym.symbolic.principle.pontryagin import costates
from satsym.symbolic.switching import notation as s
from satsym.symbolic.switching.functions import parts, written_out


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
        """Given final values of position and rate."""
        return n.target(self.position), n.target(self.rate)


def arrives(so_far: Derivation, chain: Chain, curve: sp.Expr, law: sp.Expr) -> Check:
    """Check that the law leads from a point of the curve to the target."""
    motion = _Motion(so_far, chain)
    place, control = numeric([chain.target[0] + curve]), numeric([law])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        here = motion.start(point)
        here[chain.position] = place(here)[0]
        end = motion.last_arc(here, control({**here, s.BEYOND_CURVE: mp.mpf(0)})[0])
        return motion.states(end), motion.targets(here)

    return compare("the curve leads to the target", motion.symbols(curve, law), sides)


def extremal(so_far: Derivation, chain: Chain, beyond: sp.Expr, law: sp.Expr) -> Check:
    """Check that the law arrives from anywhere, and that costates with H = 0 make the same controls."""
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
    """Check that two arcs of those durations lead from rest to rest."""
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
    """States and costates under a constant control, followed numerically."""

    def __init__(self, so_far: Derivation, chain: Chain) -> None:
        constants = definitions_of(so_far.model)
        self.chain = chain
        self.moving = [*symbols_of(so_far.model.states), *costates(so_far)]
        self.slopes = [e.xreplace(constants) for e in (*so_far.rhs("first_order"), *so_far.rhs("costate_equations"))]
        self.rates = numeric(self.slopes)

    def symbols(self, *expressions: sp.Expr) -> set[sp.Symbol]:
        """What a check needs values of."""
        chain = self.chain
        needed = {n.TIME, *self.moving, chain.control, chain.falling, chain.rising, *chain.target}
        return needed.union(*(e.free_symbols for e in (*expressions, *self.slopes)))

    def start(self, point: Point) -> Point:
        """The point with zero between the bounds."""
        low, high = sorted((self.chain.falling, self.chain.rising), key=lambda bound: bound.name.endswith("_max"))
        return {**point, low: -abs(point[low]), high: abs(point[high])}

    def states(self, here: Point) -> list[Any]:
        return [here[self.chain.position], here[self.chain.rate]]

    def targets(self, here: Point) -> list[Any]:
        return [here[target] for target in self.chain.target]

    def after(self, here: Point, control: Any, time: Any) -> Point:
        """Everything after a time: one step of RK4, which is exact where all are polynomials of time up to t^4."""
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
        """Everything after the time that the rate needs to its target at the size of its slope, whatever its sign."""
        slope = self.rates({**here, self.chain.control: control})[self.moving.index(self.chain.rate)]
        return self.after(here, control, abs((here[self.chain.target[1]] - here[self.chain.rate]) / slope))


def _until(crossed: Callable[[Any], bool]) -> Any:
    """The time of the first crossing, by halving."""
    early, late = mp.mpf(0), mp.mpf(1)
    while not crossed(late) and late < mp.mpf(2) ** 60:
        late *= 2
    for _ in range(mp.mp.prec + 10):
        middle = (early + late) / 2
        early, late = (early, middle) if crossed(middle) else (middle, late)
    return late


def _zeros(functions: Callable[[Point], list[Any]], here: Point, unknown: tuple[sp.Symbol, ...]) -> Point:
    """Where functions that are affine in some unknowns vanish."""
    none = {**here, **dict.fromkeys(unknown, mp.mpf(0))}
    constant = mp.matrix(functions(none))
    columns = [mp.matrix(functions({**none, symbol: mp.mpf(1)})) - constant for symbol in unknown]
    matrix = mp.matrix(len(constant), len(unknown))
    for k, column in enumerate(columns):
        for i in range(len(constant)):
            matrix[i, k] = column[i]
    return dict(zip(unknown, mp.lu_solve(matrix, -constant), strict=True))
