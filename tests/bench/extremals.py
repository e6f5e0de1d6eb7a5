"""Random extremals of seven kinds of motion, and how often each is conjugate to its start, counted by other code.

Everything here but the statement of a problem for satsym is independent of it: the Hamiltonian under the best controls
is written by hand, differentiated by SymPy, and integrated by SciPy together with the derivatives of the states by the
initial costates. A conjugate time is a change of sign of the determinant of these derivatives.

An extremal begins at a state and with costates that are drawn uniformly, each from the interval that its kind states,
and lasts a time that is drawn from the kind's list; its end is where it leads. Extremals that leave the domain of their
kind, or become larger than :data:`LARGEST`, are drawn again.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
import sympy as sp
from scipy.integrate import solve_ivp

import satsym
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.status import Status

LARGEST = 30.0
"""States and costates of an extremal that is not drawn again are smaller."""
NODES = 2001
BEGUN = 0.02
"""From this share of the horizon on conjugate times are counted; before it the determinant is lost in rounding."""
REAL = {"real": True}


@dataclass(frozen=True)
class Kind:
    """A kind of motion from which extremals are drawn.

    Attributes
    ----------
    states, controls
        Symbols.
    rates
        Of the states, affine in the controls.
    cost
        The running cost, in whose Hessian by the controls `weights` stand on the diagonal and nothing beside it.
    weights
        Positive numbers.
    initial, costates
        Lower and upper ends from which each initial value is drawn.
    horizons
        Durations, one of which is drawn.
    inside
        Index of a state and the value above which it stays, where the motion has a domain.
    """

    states: tuple[sp.Symbol, ...]
    controls: tuple[sp.Symbol, ...]
    rates: tuple[Any, ...]
    cost: Any
    weights: tuple[float, ...]
    initial: tuple[tuple[float, float], ...]
    costates: tuple[tuple[float, float], ...]
    horizons: tuple[float, ...]
    inside: tuple[int, float] | None = None


def _around(*values: float) -> tuple[tuple[float, float], ...]:
    return tuple((-v, v) for v in values)


def _oscillators() -> Kind:
    """Two coupled oscillators whose cost falls with the distance."""
    q, v, a, b, u, w = sp.symbols("q v a b u w", **REAL)
    cost = (u**2 + w**2 - q**2 / 2 - a**2 / 4) / 2
    rates = (v, -q + (a - q) / 4 + u, b, -a + (q - a) / 4 + w)
    return Kind((q, v, a, b), (u, w), rates, cost, (1, 1), _around(1, 1, 1, 1), _around(1, 1, 1, 1), (6.0, 9.0, 12.0))


def _pendulum() -> Kind:
    """A pendulum with a torque at its pivot, at least effort."""
    q, v, u = sp.symbols("q v u", **REAL)
    rates = (v, -sp.sin(q) + u)
    return Kind((q, v), (u,), rates, u**2 / 2, (1,), _around(2, 1), _around(1, 1), (8.0, 14.0, 20.0))


def _van_der_pol() -> Kind:
    """Van der Pol's oscillator, at least effort."""
    q, v, u = sp.symbols("q v u", **REAL)
    rates = (v, (1 - q**2) * v - q + u)
    return Kind((q, v), (u,), rates, u**2 / 2, (1,), _around(1.5, 1.5), _around(1, 1), (6.0, 9.0, 12.0))


def _duffing() -> Kind:
    """Duffing's oscillator between two wells, at least effort."""
    q, v, u = sp.symbols("q v u", **REAL)
    rates = (v, q - q**3 - v / 10 + u)
    return Kind((q, v), (u,), rates, u**2 / 2, (1,), _around(1.5, 1), _around(1, 1), (8.0, 12.0, 16.0))


def _polar() -> Kind:
    """A satellite in polar coordinates with thrust in both directions, at least effort."""
    r = sp.Symbol("r", positive=True)
    v, a, w, u1, u2 = sp.symbols("v a w u1 u2", **REAL)
    rates = (v, r * w**2 - 1 / r**2 + u1, w, (u2 - 2 * v * w) / r)
    start = ((0.9, 1.2), (-0.1, 0.1), (0.0, 0.0), (0.8, 1.1))
    effort = (u1**2 + u2**2) / 2
    return Kind((r, v, a, w), (u1, u2), rates, effort, (1, 1), start, _around(*[0.25] * 4), (9.0, 12.0, 15.0), (0, 0.2))


def _rendezvous() -> Kind:
    """A rendezvous near a circular orbit, linearised, at least effort; no extremal of it has a conjugate point."""
    x, y, v, w, u1, u2 = sp.symbols("x y v w u1 u2", **REAL)
    rates = (v, w, 3 * x + 2 * w + u1, -2 * v + u2)
    effort = (u1**2 + u2**2) / 2
    ends = _around(*[0.05] * 4)
    return Kind((x, y, v, w), (u1, u2), rates, effort, (1, 1), _around(1, 1, 1, 1), ends, (3.0, 6.0, 9.0))


def _spin() -> Kind:
    """A rigid body with moments of inertia 3, 2 and 1 and torques about two axes, at least effort."""
    a, b, c, u, w = sp.symbols("a b c u w", **REAL)
    rates = (b * c / 3 + u, -a * c + w, a * b)
    costs = (u**2 + w**2) / 2
    return Kind((a, b, c), (u, w), rates, costs, (1, 1), _around(1, 1, 1), _around(0.4, 0.4, 0.4), (8.0, 12.0, 16.0))


KINDS: dict[str, Callable[[], Kind]] = {
    "coupled oscillators": _oscillators,
    "pendulum": _pendulum,
    "van der pol": _van_der_pol,
    "duffing": _duffing,
    "polar orbit": _polar,
    "rendezvous": _rendezvous,
    "rigid body": _spin,
}


@dataclass(frozen=True)
class Drawn:
    """A random extremal.

    Attributes
    ----------
    case, found
        The problem whose end is where the extremal leads, and what a solver would hand back.
    conjugate
        How often its times are conjugate to its start.
    """

    case: Instance
    found: Solution
    conjugate: int


def drawn(kind: str, rng: np.random.Generator) -> Drawn:
    """Draw an extremal of a kind."""
    given, (rates, controls) = KINDS[kind](), _functions(kind)
    n = len(given.states)
    while True:
        x, costates = (np.array([rng.uniform(*ends) for ends in rows]) for rows in (given.initial, given.costates))
        tf = float(rng.choice(given.horizons))
        times = np.linspace(0.0, tf, NODES)

        def left(_: float, y: np.ndarray) -> float:
            return LARGEST - float(np.abs(y[: 2 * n]).max())

        def outside(_: float, y: np.ndarray) -> float:
            return float(y[given.inside[0]]) - given.inside[1] if given.inside else 1.0

        left.terminal = outside.terminal = True  # type: ignore[attr-defined]
        start = np.concatenate([x, costates, np.eye(2 * n)[:, n:].ravel()])
        run = solve_ivp(rates, (0.0, tf), start, "DOP853", times, events=(left, outside), rtol=1e-12, atol=1e-14)
        if run.status == 0:
            break
    u = np.array([np.broadcast_to(v, times.shape) for v in controls(*run.y[: 2 * n])])
    names = [str(v) for v in given.states]
    case = satsym.Instance.of(
        _problem(kind),
        initial=dict(zip(names, map(float, x), strict=True)),
        final=dict(zip(names, map(float, run.y[:n, -1]), strict=True)),
        tf=tf,
    ).case
    none = tuple(() for _ in given.controls)
    found = Solution(case, "drawn", Status.CONVERGED, "", 0.0, times, run.y[:n], u, run.y[n : 2 * n], none, 0, (), 0.0)
    return Drawn(case, found, _conjugate(run.y[2 * n :], n))


def _conjugate(derivatives: np.ndarray, n: int) -> int:
    """How often the determinant of states by initial costates changes its sign after the start.

    At first its sign is that of (-1)^n, for H is concave in the costates.
    """
    block = derivatives.reshape(2 * n, n, -1)[:n]
    signs = np.sign(np.linalg.det(np.moveaxis(block, -1, 0)))[int(BEGUN * (NODES - 1)) :]
    return int((np.diff(np.concatenate([[(-1.0) ** n], signs])) != 0).sum())


@cache
def _functions(kind: str) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """Rates of states, costates and their derivatives by the initial costates; and the controls."""
    given = KINDS[kind]()
    n = len(given.states)
    lam = sp.symbols(f"l0:{n}", real=True)
    full = given.cost + sum(a * b for a, b in zip(lam, given.rates, strict=True))
    still = dict.fromkeys(given.controls, 0)
    best = {u: -sp.diff(full, u).subs(still) / c for u, c in zip(given.controls, given.weights, strict=True)}
    reduced, z = sp.expand(full.subs(best)), (*given.states, *lam)
    slope = [sp.diff(reduced, v) for v in z]
    moved = sp.Matrix([*slope[n:], *(-v for v in slope[:n])])
    motion = sp.lambdify([z], list(moved), "numpy", cse=True)
    flow = sp.lambdify([z], moved.jacobian(z).tolist(), "numpy", cse=True)

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        here = y[: 2 * n]
        carried = np.array(flow(here), dtype=float) @ y[2 * n :].reshape(2 * n, n)
        return np.concatenate([motion(here), carried.ravel()])

    return rates, sp.lambdify(z, [best[u] for u in given.controls], "numpy")


@cache
def _problem(kind: str) -> Any:
    """The problem as it is stated to satsym."""
    given, name = KINDS[kind](), kind.replace(" ", "_")
    domain = given.inside and given.states[given.inside[0]]
    motion = satsym.FirstOrder(
        name=f"{name}_drawn",
        title=kind.capitalize(),
        states=tuple(satsym.Variable(str(v), str(v), positive=v is domain) for v in given.states),
        controls=tuple(satsym.Variable(str(v), str(v)) for v in given.controls),
        parameters=(),
        rates=dict(zip(given.states, given.rates, strict=True)),
    )
    return satsym.Problem(name=name, title=kind.capitalize(), model=motion, running_cost=given.cost)
