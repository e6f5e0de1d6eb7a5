"""The MATLAB listing in appendix B of the ITS thesis as a program that does, statement by statement, what is printed.

Names are those of the listing: ``x1 .. x4`` the "initial system", ``x1s .. x4s`` the controlled one. Index ``i`` of
the listing is ``i - 1`` here. One statement is left out, for MATLAB could not execute it: ``x4s(i+1)=x4s(i)+kx4``
stands before ``kx4`` has a value, and once more, in its place, after it.

With ``once`` a loop multiplies its stages by h once, where the listing does it twice; all else stays as printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TypeAlias

State: TypeAlias = tuple[float, float, float, float]
Control: TypeAlias = tuple[float, float]
Rate: TypeAlias = Callable[[Sequence[float]], State]

TOLERANCE = 0.01
"""``tol=0.01`` in the flow chart."""

LOST: State = (math.nan, math.nan, math.nan, math.nan)


@dataclass(frozen=True)
class Run:
    """What the printed loop leaves behind.

    Attributes
    ----------
    sweeps
        How often the body of the ``while`` was executed.
    errors
        ``err1`` and ``err2`` at the end.
    step
        ``h``.
    x, u, lam
        States, controls and costates at the n + 1 nodes, a tuple a node.
    """

    sweeps: int
    errors: tuple[float, float]
    step: float
    x: list[State]
    u: list[Control]
    lam: list[State]


def initial_system(n: int, tf: float, start: State, omega: float, *, once: bool = False) -> list[State]:
    """The loop ``%sistem awal``: linear, without control; n + 1 states, not a number from where it overflows."""
    h = tf / n

    def stage(x1: float, x2: float, x3: float, x4: float) -> State:
        return h * x2, h * (3.0 * omega**2 * x1 + 2.0 * omega * x4 + 0.0), h * x4, h * (-2.0 * omega * x2 + 0.0)

    x = [start]
    for _ in range(n):
        x.append(_step(lambda y: stage(*y), x[-1], 1.0 if once else h))
    return x


def state_sweep(
    u: Sequence[Control], tf: float, start: State, sigma: float, omega: float, *, once: bool = False
) -> list[State]:
    """The loop ``%persamaan state``: n + 1 states from controls at n + 1 nodes."""
    n = len(u) - 1
    h = tf / n
    x = [start]
    for i in range(n):
        u1, u2 = u[i]
        mid1, mid2 = 0.5 * (u1 + u[i + 1][0]), 0.5 * (u2 + u[i + 1][1])

        def stage(y: Sequence[float], u1: float, u2: float) -> State:
            x1, x2, _, x4 = y
            second = x1 * x4**2 - sigma**3 * omega**2 / x1**2 + u1
            return h * x2, h * second, h * x4, h * ((-2.0 * x2 * x4 + u2) / x1)

        # k4 takes the mean of the controls, too, where u(i+1) would be meant
        first, later = partial(stage, u1=u1, u2=u2), partial(stage, u1=mid1, u2=mid2)
        x.append(_step(later, x[-1], 1.0 if once else h, first))
    return x


def costate_sweep(
    x: Sequence[State],
    u: Sequence[Control],
    tf: float,
    end: State,
    sigma: float,
    omega: float,
    *,
    once: bool = False,
) -> list[State]:
    """The loop ``%persamaan costate``: n + 1 costates from the last one, states and controls at the nodes."""
    n = len(u) - 1
    h = tf / n
    lam = [end] * (n + 1)

    def stage(costate: Sequence[float], x1: float, x2: float, x4: float, u2: float) -> State:
        lambda1, lambda2, lambda3, lambda4 = costate
        first = lambda2 * x4**2 + 2.0 * sigma**3 * omega**2 * lambda2 / x1**3
        return (
            h * -(first + (2.0 * lambda4 * x2 * x4 - u2 * lambda4) / x1**2),
            h * -(lambda1 - 2.0 * lambda4 * x4 / x1),
            h * 0.0,
            h * -(2.0 * lambda2 * x1 * x4 + lambda3 - 2.0 * lambda4 * x2 / x1),
        )

    for j in range(n - 1, -1, -1):
        late, early = (*x[j + 1], *u[j + 1]), (*x[j], *u[j])
        middle = [0.5 * (b + a) for b, a in zip(late, early, strict=True)]

        def at(place: Sequence[float]) -> Rate:
            return partial(stage, x1=place[0], x2=place[1], x4=place[3], u2=place[5])

        # k4 takes the means, too, where the values at node j would be meant
        lam[j] = _step(at(middle), lam[j + 1], 1.0 if once else h, at(late), sign=-1.0)
    return lam


def run(
    weights: Control,
    n: int,
    guess: Sequence[Control],
    *,
    tf: float,
    start: State,
    sigma: float,
    omega: float,
    most: int = 100,
) -> Run:
    """The flow chart: sweep, sweep back, update, and again ``while((err1>tol)&&(err2>tol))``.

    Parameters
    ----------
    weights
        c1 and c2.
    n
        Number of steps; the thesis does not say which.
    guess
        Controls at the n + 1 nodes to begin with; the thesis does not say which, either.
    most
        Stop after so many sweeps whatever the listing says.
    """
    u, errors, sweeps = list(guess), (TOLERANCE + 1.0, TOLERANCE + 1.0), 0
    x: list[State] = []
    lam: list[State] = []
    while errors[0] > TOLERANCE and errors[1] > TOLERANCE and sweeps < most:
        old = u
        x = state_sweep(u, tf, start, sigma, omega)
        lam = costate_sweep(x, u, tf, (0.0, 0.0, 0.0, 0.0), sigma, omega)
        u = update(lam, x, old, weights)
        errors = (error(u, old, 0), error(u, old, 1))
        sweeps += 1
    return Run(sweeps, errors, tf / n, x, u, lam)


def error(u: Sequence[Control], old: Sequence[Control], k: int) -> float:
    """The line ``err1=`` or ``err2=``."""
    size = math.fsum(abs(new[k]) for new in u)
    return TOLERANCE * size - math.fsum(abs(before[k] - new[k]) for before, new in zip(old, u, strict=True))


def update(lam: Sequence[State], x: Sequence[State], old: Sequence[Control], weights: Control) -> list[Control]:
    """The lines ``u1s=`` to ``u2=``: clip the law to [0, 1], and take the mean with the controls before."""
    c1, c2 = weights
    u2s = right_division([-node[3] for node in lam], [c2 * node[0] for node in x])
    return [
        (0.5 * (_clipped(-node[1] / c1) + before[0]), 0.5 * (_clipped(u2s) + before[1]))
        for node, before in zip(lam, old, strict=True)
    ]


def right_division(b: Sequence[float], a: Sequence[float]) -> float:
    """MATLAB's ``b/a`` of two rows: not element by element, but the one number q that makes q*a closest to b."""
    return math.fsum(p * q for p, q in zip(b, a, strict=True)) / math.fsum(q * q for q in a)


def _clipped(value: float) -> float:
    # MATLAB's max and min pass over what is not a number
    return 0.0 if math.isnan(value) else min(1.0, max(0.0, value))


def _step(later: Rate, y: State, again: float, first: Rate | None = None, sign: float = 1.0) -> State:
    """One step of the listing: the stages carry h already, and are multiplied ``again`` inside the next one."""

    def moved(k: State, share: float) -> State:
        return _state(a + sign * again * share * b for a, b in zip(y, k, strict=True))

    try:
        k1 = (first or later)(y)
        k2 = later(moved(k1, 0.5))
        k3 = later(moved(k2, 0.5))
        k4 = later(moved(k3, 1.0))
        total = [(a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(k1, k2, k3, k4, strict=True)]
    except ArithmeticError:
        return LOST
    return _state(a + sign * b for a, b in zip(y, total, strict=True))


def _state(values: Iterable[float]) -> State:
    x1, x2, x3, x4 = values
    return x1, x2, x3, x4
