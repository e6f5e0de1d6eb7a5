"""One validated step of z' = F(z) and of its derivatives by the start, V' = F_z V, by Taylor series.

The coefficients of the series hold for every start in a ball; the remainder is the next coefficient, taken over a ball
that the motions of the step do not leave (Corliss and Rihm). The module does not depend on what F is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

from flint import arb, arb_mat, arb_series, ctx

from satsym.proof.balls.arithmetic import Ball, NotProved, Series, value

Matrix = Any
"""An ``arb_mat`` of FLINT: a matrix of intervals."""
SHORTEST = 1e-9
"""Fraction of its initial length below which a step is not shortened further in the search for an enclosure."""
FEWER = 0.65
"""Fraction of the terms of a series that is used for derivatives with respect to initial values.

The derivatives are multiplied by small numbers and need less accuracy.
"""


class Field(Protocol):
    """A differential equation: autonomous rates of m components, their derivatives row by row, and an integrand."""

    def rates(self, z: Sequence[Series]) -> Sequence[Series]: ...

    def jacobian(self, z: Sequence[Series]) -> Sequence[Series]: ...

    def cost(self, z: Sequence[Series]) -> Series: ...


@dataclass(frozen=True)
class Order:
    """The number of terms of the series, and the allowed remainder of a step relative to the sizes of components."""

    terms: int
    remainder: float


@dataclass(frozen=True)
class Step:
    """A step of at most the length `h` from the states `z`.

    Attributes
    ----------
    h
        Length of the step; if it is a ball, the step holds for each length in it.
    range
        Balls that no motion from `z` leaves.
    middle
        Coefficients of the motion from the midpoint of the start.
    series, last
        Series of the motions from `z`: coefficients up to `terms` - 1 at the start of the step, and the next one within
        it.
    flow
        Coefficients of the derivatives by the start, the last one within the step.
    costs
        Coefficients of the cost so far along the motion from the midpoint, the last one within the step.
    terms
        Number of coefficients of these series before the last one.
    """

    h: Ball
    range: list[Ball]
    middle: list[Series]
    series: list[Series]
    last: Sequence[Series]
    flow: list[Matrix]
    costs: list[Ball]
    terms: int

    def from_middle(self, time: Ball) -> list[Ball]:
        """Return the end of the motion from the midpoint of the start, after a time."""
        return self._ended(self.middle, time)

    def reached(self, time: Ball) -> list[Ball]:
        """Return the ends of all motions from the start, after a time."""
        return self._ended(self.series, time)

    def derivative(self, time: Ball | None = None) -> Matrix:
        """Return derivatives by the start after a time, by default the whole step."""
        return polynomial(self.flow, self.h if time is None else time)

    def cost(self, time: Ball) -> Ball:
        """Return the integral of the cost along the motion from the midpoint."""
        return polynomial(self.costs, time)

    def _ended(self, series: Sequence[Series], time: Ball) -> list[Ball]:
        n = self.terms
        return [polynomial([*(s[k] for k in range(n)), w[n]], time) for s, w in zip(series, self.last, strict=True)]


def unit(m: int) -> Matrix:
    """Return the identity matrix."""
    return arb_mat(m, m, [int(i == j) for i in range(m) for j in range(m)])


def column(values: Sequence[Ball]) -> Matrix:
    """Return a matrix of one column."""
    return arb_mat(len(values), 1, list(values))


def inverse(jacobian: Matrix) -> Matrix:
    """Return an approximate inverse of a ball matrix, with exact entries.

    Raises
    ------
    NotProved
        If there is none.
    """
    if jacobian.nrows() != jacobian.ncols():
        raise NotProved("the numbers of equations and unknowns differ; two bounds are reached at the same time")
    try:
        return jacobian.mid().inv().mid()
    except ZeroDivisionError:
        raise NotProved("the equations of the extremal are singular; it may belong to a family of extremals") from None


def polynomial(coefficients: Sequence[Any], at: Ball) -> Any:
    """Evaluate a polynomial in balls or in matrices, constant term first."""
    total = coefficients[-1]
    for c in reversed(coefficients[:-1]):
        total = total * at + c
    return total


def from_zero(h: Ball) -> Ball:
    """Return the ball of all times from 0 to h."""
    return arb(0).union(h)


def expand(field: Field, z: Sequence[Ball], n: int) -> list[Series]:
    """Return coefficients 0 to n of the motion from each point of the ball z.

    They follow by Newton's method on series: with k coefficients known, the residual of the equation is linear in the
    next k.
    """
    m, found, k = len(z), [[v] for v in z], 1
    while k <= n:
        wanted = min(2 * k, n + 1)
        ctx.cap = wanted - 1
        series = [arb_series(c) for c in found]
        rates = field.rates(series)
        ctx.cap = max(wanted - k, 1)
        a = _matrices(field, series, wanted - k - 1)
        e: list[Matrix] = []  # coefficients k, k + 1, ... of what is missing
        for j in range(k, wanted):
            total = arb_mat(m, 1, [rate[j - 1] for rate in rates])
            for i, known in enumerate(e):
                total += a[len(e) - 1 - i] * known
            e.append(total * (arb(1) / j))
        for i, c in enumerate(found):
            c.extend(one[i, 0] for one in e)
        k = wanted
    ctx.cap = n + 1
    return [arb_series(c) for c in found]


def _matrices(field: Field, series: Sequence[Series], count: int) -> list[Matrix]:
    """Return the coefficients of F_z along a series."""
    if count <= 0:
        return []
    m, entries = len(series), field.jacobian(series)
    return [arb_mat(m, m, [e[k] for e in entries]) for k in range(count)]


def expand_flow(field: Field, series: Sequence[Series], start: Matrix, n: int) -> list[Matrix]:
    """Return coefficients 0 to n of V' = F_z V along a series, for a given V(0)."""
    ctx.cap = n
    a, found = _matrices(field, series, n), [start]
    for k in range(n):
        total = a[0] * found[k]
        for j in range(1, k + 1):
            total += a[j] * found[k - j]
        found.append(total * (arb(1) / (k + 1)))
    return found


def jacobian(field: Field, z: Sequence[Ball]) -> Matrix:
    """Return F_z over a ball."""
    ctx.cap = 1
    m = len(z)
    return arb_mat(m, m, [value(v) for v in field.jacobian([arb_series([v]) for v in z])])


def rates(field: Field, z: Sequence[Ball]) -> list[Ball]:
    """Return F over a ball."""
    ctx.cap = 1
    return [value(v) for v in field.rates([arb_series([v]) for v in z])]


def step(
    field: Field, middle: Sequence[Ball], z: Sequence[Ball], h: Ball, order: Order, sizes: Sequence[float]
) -> tuple[Step, Ball]:
    """Take a step of length h, or a shorter one to keep the remainder small; also return the length to try next.

    Raises
    ------
    NotProved
        If no step has an enclosure.
    """
    n, shortest = order.terms, float(h.mid()) * SHORTEST
    near, point = expand(field, z, n), expand(field, middle, n)
    while (found := _enclosed(field, near, h, order, sizes)).range is None:
        h = arb(found.try_next)
        if found.try_next < shortest:
            raise NotProved("a step of the integration has no enclosure")
    b, last = found.range, found.last
    fewer = int(FEWER * n)
    flow = expand_flow(field, near, unit(len(z)), fewer - 1)
    flow.append(expand_flow(field, last, _within(jacobian(field, b), h), fewer)[fewer])
    ctx.cap = n + 1
    cost, last_cost = field.cost(point), field.cost(last)
    costs = [arb(0), *(cost[k] / (k + 1) for k in range(n)), last_cost[n] / (n + 1)]
    return Step(h, b, point, near, last, flow, costs, n), arb(found.try_next)


@dataclass(frozen=True)
class _Tried:
    """The result of trying a step.

    Attributes
    ----------
    try_next
        The length to try next, after this step or in its place.
    range, last
        Balls that motions do not leave, and their series; no range where none was found.
    """

    try_next: float
    range: list[Ball] | None = None
    last: Sequence[Series] = ()


def _enclosed(field: Field, near: Sequence[Series], h: Ball, order: Order, sizes: Sequence[float]) -> _Tried:
    """Try a step: tell whether the widened polynomial contains itself with its remainder over this range."""
    n, length = order.terms, float(h.mid())
    tau = from_zero(h)
    try:
        b = [_wider(polynomial([s[k] for k in range(n)], tau)) for s in near]
        last = expand(field, b, n)
        ctx.cap = n + 1
        costly = field.cost(last)[n] * h / (n + 1)
        rests = zip([*(w[n] for w in last), costly], sizes, strict=True)
        rest = max(float((w * h**n).abs_upper()) / size for w, size in rests)
        if rest > 10.0 * order.remainder:
            return _Tried(length * max(0.3, 0.9 * (order.remainder / rest) ** (1 / n)))
        stays = [polynomial([*(s[k] for k in range(n)), w[n]], tau) for s, w in zip(near, last, strict=True)]
        if all(o.contains_interior(v) for o, v in zip(b, stays, strict=True)):
            longer = 0.95 * (order.remainder / rest) ** (1 / n) if rest > 0.0 else 2.0
            return _Tried(length * min(2.0, longer), b, last)
    except (ArithmeticError, ValueError):  # something that may vanish is divided by
        pass
    return _Tried(length / 2)


def _wider(v: Ball) -> Ball:
    """Return a ball that contains v well inside."""
    return arb(v.mid(), v.rad() * 1.05 + abs(v.mid()) * 1e-5 + 1e-25)


def _within(a: Matrix, h: Ball) -> Matrix:
    """Return a ball matrix that no V with V' = A V, V(0) = I leaves within h: |V - I| <= exp(|A| h) - I (Gronwall)."""
    m = a.nrows()
    bound = (arb_mat(m, m, [v.abs_upper() for v in a.entries()]) * h.abs_upper()).exp() - unit(m)
    return unit(m) + arb_mat(m, m, [arb(0, v.abs_upper()) for v in bound.entries()])
