"""The canonical equations of the satellite in polar coordinates, written out by hand, and two ways to solve them.

Nothing here comes from satsym: what the sweep finds is compared with scipy's collocation (solve_bvp) and with
shooting over arcs that end exactly where a control meets or leaves a bound.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp

Array = np.ndarray
INFINITY = math.inf


@dataclass(frozen=True, kw_only=True)
class Orbit:
    """A transfer with given final time, free final state and a quadratic terminal cost.

    Parameters
    ----------
    sigma, omega
        Radius and angular velocity of the reference orbit.
    c, k
        Weights of the controls, and of the final errors of (r, r_dot, theta, theta_dot).
    start, tf
        Initial state at time 0, final time.
    lower, upper
        Bounds of the controls.
    max_norm
        Bound of their norm, known to :func:`collocation` only.
    """

    sigma: float = 1.0
    omega: float = 1.0
    c: tuple[float, float] = (1.0, 1.0)
    k: tuple[float, float, float, float] = (1.0, 1.0, 0.0, 1.0)
    start: tuple[float, float, float, float] = (1.1, 0.0, 0.0, 0.9)
    tf: float = 2.0 * math.pi
    lower: tuple[float, float] = (-INFINITY, -INFINITY)
    upper: tuple[float, float] = (INFINITY, INFINITY)
    max_norm: float = INFINITY

    @property
    def mu(self) -> float:
        return self.sigma**3 * self.omega**2

    def wanted(self, y: Array) -> tuple[Array, Array]:
        """The controls that minimise the Hamiltonian where there are no bounds."""
        return -y[5] / self.c[0], -y[7] / (self.c[1] * y[0])

    def error(self, x: Array) -> Array:
        """Final state deviation from the reference."""
        return x - np.array([self.sigma, 0.0, self.omega * self.tf, self.omega])

    def costates_wanted(self, x: Array) -> Array:
        """Gradient of the terminal cost."""
        return np.array(self.k) * self.error(x)

    def terminal_cost(self, x: Array) -> float:
        return float(0.5 * np.dot(self.k, self.error(x) ** 2))

    def rates(self, y: Array, u1: Array, u2: Array) -> list[Array]:
        """Rates of change of states, costates and accumulated cost; y has the rows r, v, theta, w, l1 ... l4, J."""
        r, v, _, w, l1, l2, l3, l4 = y[:8]
        turning = (u2 - 2.0 * v * w) / r
        return [
            v,
            r * w**2 - self.mu / r**2 + u1,
            w,
            turning,
            -l2 * (w**2 + 2.0 * self.mu / r**3) + l4 * turning / r,
            -l1 + 2.0 * l4 * w / r,
            0.0 * r,
            -2.0 * l2 * r * w - l3 + 2.0 * l4 * v / r,
            0.5 * (self.c[0] * u1**2 + self.c[1] * u2**2),
        ]


@dataclass(frozen=True)
class Extremal:
    """A solution: cost, initial costate, when each control meets or leaves a bound, and everything over time."""

    cost: float
    costate: Array
    switches: tuple[tuple[float, ...], tuple[float, ...]]
    at: Callable[[Array], Array] = field(repr=False)


def collocation(orbit: Orbit, tolerance: float = 1e-10) -> Extremal:
    """By solve_bvp from the simulation without control; for bounds only as good as corners allow."""

    def rates(_: Array, y: Array) -> Array:
        u = np.array([np.clip(v, a, b) for v, a, b in zip(orbit.wanted(y), orbit.lower, orbit.upper, strict=True)])
        u /= np.maximum(1.0, np.hypot(*u) / orbit.max_norm)
        return np.vstack(orbit.rates(y, *u))

    def residual(first: Array, last: Array) -> Array:
        return np.concatenate([first[:4] - orbit.start, last[4:8] - orbit.costates_wanted(last[:4]), first[8:]])

    times = np.linspace(0.0, orbit.tf, 201)
    y0 = (*orbit.start, 0.0, 0.0, 0.0, 0.0, 0.0)
    simulation = solve_ivp(lambda t, y: rates(t, y[:, None])[:, 0], (0.0, orbit.tf), y0, t_eval=times, rtol=1e-8)
    found = solve_bvp(rates, residual, times, simulation.y, tol=tolerance, max_nodes=200_000)
    assert found.success, found.message
    return Extremal(found.y[8, -1] + orbit.terminal_cost(found.y[:4, -1]), found.y[4:8, 0], ((), ()), found.sol)


def shooting(orbit: Orbit, costate: Array) -> Extremal:
    """By Newton's method on the initial costate, with arcs that end where a control meets or leaves a bound.

    Parameters
    ----------
    costate
        Where to start, such as what :func:`collocation` finds.
    """
    scale = np.abs(costate).max()
    for _ in range(20):
        residual = _miss(orbit, costate)
        columns = []
        for k in range(4):
            step = np.zeros(4)
            step[k] = 1e-5 * scale
            columns.append((_miss(orbit, costate + step) - _miss(orbit, costate - step)) / (2e-5 * scale))
        change = np.linalg.solve(np.transpose(columns), -residual)
        costate = costate + change
        if np.abs(change).max() <= 1e-12 * scale:
            break
    else:
        raise AssertionError("shooting does not converge")
    return _fly(orbit, costate)


def _miss(orbit: Orbit, costate: Array) -> Array:
    last = _fly(orbit, costate).at(np.array([orbit.tf]))[:, 0]
    return last[4:8] - orbit.costates_wanted(last[:4])


def _fly(orbit: Orbit, costate: Array) -> Extremal:
    """One arc after another; on each, a control is held at a bound or follows the law."""
    t, y = 0.0, np.array([*orbit.start, *costate, 0.0])
    held = [_side(v, a, b) for v, a, b in zip(orbit.wanted(y), orbit.lower, orbit.upper, strict=True)]
    switches: tuple[list[float], list[float]] = ([], [])
    arcs = []
    while t < orbit.tf:
        arc = _arc(orbit, t, y, held)
        arcs.append((t, arc.t[-1], arc.sol))
        t, y = arc.t[-1], arc.y[:, -1]
        crossed = [k for k, times in enumerate(arc.t_events) if len(times) and abs(times[-1] - t) < 1e-12 * orbit.tf]
        for k in crossed:
            i, bound = divmod(k, 2)
            held[i] = 0 if held[i] else (-1, 1)[bound]
            switches[i].append(t)

    def at(times: Array) -> Array:
        owner = np.searchsorted([end for _, end, _ in arcs[:-1]], times)
        return np.column_stack([arcs[a][2](time) for a, time in zip(owner, times, strict=True)])

    return Extremal(float(y[8] + orbit.terminal_cost(y[:4])), costate, (tuple(switches[0]), tuple(switches[1])), at)


def _side(value: float, lower: float, upper: float) -> int:
    """Which bound holds a control: -1 the lower, 1 the upper, 0 none."""
    return int(value > upper) - int(value < lower)


def _arc(orbit: Orbit, t: float, y: Array, held: list[int]) -> object:
    """Up to the next change of what holds a control, or to the end.

    Each event is watched in one direction only, so that the one at which an arc begins does not end it.
    """

    def control(y: Array) -> list[float]:
        limits = zip(orbit.wanted(y), orbit.lower, orbit.upper, held, strict=True)
        return [(wanted, upper, lower)[side] for wanted, lower, upper, side in limits]

    def rates(_: float, y: Array) -> list[float]:
        return orbit.rates(y, *control(y))

    def event(i: int, bound: float, direction: int) -> Callable[[float, Array], float]:
        def distance(_: float, y: Array) -> float:
            return orbit.wanted(y)[i] - bound if direction and math.isfinite(bound) else 1.0

        distance.terminal, distance.direction = True, direction
        return distance

    events = []
    for i, side in enumerate(held):
        events.append(event(i, orbit.lower[i], {0: -1, -1: 1, 1: 0}[side]))
        events.append(event(i, orbit.upper[i], {0: 1, 1: -1, -1: 0}[side]))
    return solve_ivp(
        rates,
        (t, orbit.tf),
        y,
        "DOP853",
        dense_output=True,
        events=events,
        rtol=1e-13,
        atol=1e-16,
        max_step=orbit.tf / 60,
    )
