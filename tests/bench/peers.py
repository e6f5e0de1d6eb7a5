"""The same trajectory by other means: what a good user writes without generated code, and what other tools offer.

Every peer is a function from a case to a runner; it raises Missing where its tool is not there.
"""

# ruff: noqa: B905 - zip(strict=True) takes time, which would be unfair to the peers

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from orbit import PARAMETERS, START, T_FINAL, Array, Case


class Missing(Exception):
    """A tool that is not there, and why."""


@dataclass(frozen=True)
class Runner:
    """Something to time.

    Attributes
    ----------
    run
        Integrates the whole trajectory.
    final
        The final state that run arrives at, shape (4,).
    note
        How its work differs from that of the others.
    """

    run: Callable[[], object]
    final: Callable[[], Array]
    note: str = ""


def right_hand_sides(modules: str) -> tuple[Callable[..., list[Any]], Callable[..., float]]:
    """f(x, u, (sigma, omega)) and the running cost L(u, (c1, c2)) by sympy.lambdify."""
    import sympy as sp

    x = r, r_dot, _, theta_dot = sp.symbols("r r_dot theta theta_dot")
    u = u1, u2 = sp.symbols("u1 u2")
    p = sigma, omega = sp.symbols("sigma omega")
    c = c1, c2 = sp.symbols("c1 c2")
    f = [r_dot, r * theta_dot**2 - sigma**3 * omega**2 / r**2 + u1, theta_dot, (u2 - 2 * r_dot * theta_dot) / r]
    cost = (c1 * u1**2 + c2 * u2**2) / 2
    return sp.lambdify((x, u, p), f, modules=modules, cse=True), sp.lambdify((u, c), cost, modules=modules, cse=True)


def on_floats(case: Case) -> Runner:
    """RK4 for any right-hand side on tuples of floats; functions by lambdify with ``math``."""
    f, cost = right_hand_sides("math")
    p, c = PARAMETERS[:2], PARAMETERS[2:4]
    times = case.times.tolist()
    u, u_mid = list(zip(*case.u.tolist(), strict=True)), list(zip(*case.u_mid.tolist(), strict=True))

    def run() -> list[Sequence[float]]:
        x: Sequence[float] = START
        nodes, middles, total = [x], [], 0.0
        k1, l1 = f(x, u[0], p), cost(u[0], c)
        for i in range(len(times) - 1):
            h = times[i + 1] - times[i]
            half, sixth, eighth, middle, end = 0.5 * h, h / 6.0, 0.125 * h, u_mid[i], u[i + 1]
            k2 = f([a + half * k for a, k in zip(x, k1)], middle, p)
            k3 = f([a + half * k for a, k in zip(x, k2)], middle, p)
            k4 = f([a + h * k for a, k in zip(x, k3)], end, p)
            z = [a + sixth * (p1 + 2.0 * (p2 + p3) + p4) for a, p1, p2, p3, p4 in zip(x, k1, k2, k3, k4)]
            k5, l3 = f(z, end, p), cost(end, c)
            middles.append([0.5 * (a + b) + eighth * (s1 - s5) for a, b, s1, s5 in zip(x, z, k1, k5)])
            total += sixth * (l1 + 4.0 * cost(middle, c) + l3)
            nodes.append(z)
            x, k1, l1 = z, k5, l3
        return nodes

    return Runner(run, lambda: np.array(run()[-1]))


def on_floats_states_only(case: Case) -> Runner:
    """The same without running cost and midpoints: less work than the generated loop does."""
    f, p = right_hand_sides("math")[0], PARAMETERS[:2]
    times = case.times.tolist()
    u, u_mid = list(zip(*case.u.tolist(), strict=True)), list(zip(*case.u_mid.tolist(), strict=True))

    def run() -> list[Sequence[float]]:
        x: Sequence[float] = START
        nodes = [x]
        for i in range(len(times) - 1):
            h = times[i + 1] - times[i]
            half, sixth, middle, end = 0.5 * h, h / 6.0, u_mid[i], u[i + 1]
            k1 = f(x, u[i], p)
            k2 = f([a + half * k for a, k in zip(x, k1)], middle, p)
            k3 = f([a + half * k for a, k in zip(x, k2)], middle, p)
            k4 = f([a + h * k for a, k in zip(x, k3)], end, p)
            x = [a + sixth * (p1 + 2.0 * (p2 + p3) + p4) for a, p1, p2, p3, p4 in zip(x, k1, k2, k3, k4)]
            nodes.append(x)
        return nodes

    return Runner(run, lambda: np.array(run()[-1]), "no cost, no midpoints")


def on_arrays(case: Case) -> Runner:
    """RK4 with array arithmetic; functions by lambdify with ``numpy``. States only."""
    listed, p = right_hand_sides("numpy")[0], PARAMETERS[:2]
    times, u, u_mid = case.times, case.u.T.copy(), case.u_mid.T.copy()

    def f(x: Array, control: Array) -> Array:
        return np.array(listed(x, control, p))

    def run() -> Array:
        nodes = np.empty((len(times), 4))
        nodes[0] = x = np.array(START)
        for i, h in enumerate(np.diff(times)):
            k1 = f(x, u[i])
            k2 = f(x + 0.5 * h * k1, u_mid[i])
            k3 = f(x + 0.5 * h * k2, u_mid[i])
            k4 = f(x + h * k3, u[i + 1])
            nodes[i + 1] = x = x + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4)
        return nodes

    return Runner(run, lambda: run()[-1], "no cost, no midpoints")


def casadi(case: Case) -> Runner:
    """CasADi: the step as an SX function, mapaccum over the nodes, evaluated by its virtual machine."""
    try:
        import casadi as ca
    except ImportError:
        raise Missing("casadi is not installed") from None
    sigma, omega, c1, c2 = PARAMETERS[:4]
    y, g = ca.SX.sym("y", 5), ca.SX.sym("g", 7)
    h, u, u_mid, u_end = g[0], g[1:3], g[3:5], g[5:7]

    def f(y: Any, u: Any) -> Any:
        inv_r = 1.0 / y[0]
        return ca.vertcat(
            y[1],
            y[0] * y[3] * y[3] - sigma**3 * omega**2 * inv_r * inv_r + u[0],
            y[3],
            (u[1] - 2.0 * y[1] * y[3]) * inv_r,
            0.5 * (c1 * u[0] * u[0] + c2 * u[1] * u[1]),
        )

    k1 = f(y, u)
    k2 = f(y + 0.5 * h * k1, u_mid)
    k3 = f(y + 0.5 * h * k2, u_mid)
    z = y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + f(y + h * k3, u_end))
    middle = 0.5 * (y + z) + 0.125 * h * (k1 - f(z, u_end))
    loop = ca.Function("step", [y, g], [z, middle[:4]], {"cse": True}).mapaccum(case.steps)
    start = ca.DM([*START, 0.0])
    given = ca.DM(np.vstack([np.diff(case.times), case.u[:, :-1], case.u_mid, case.u[:, 1:]]))
    return Runner(lambda: loop(start, given), lambda: np.array(loop(start, given)[0])[:4, -1])


def solve_ivp(case: Case, method: str) -> Runner:
    """SciPy at the error of the RK4 grid, with the control as a function: from a table it is several times slower."""
    import math

    from scipy.integrate import solve_ivp as solve

    mu = PARAMETERS[0] ** 3 * PARAMETERS[1] ** 2

    def f(t: float, x: Array) -> tuple[float, ...]:
        r, r_dot, _, theta_dot = x.tolist()
        u1, u2 = 0.1 * math.sin(3.0 * t), 0.05 * math.cos(t)
        return r_dot, r * theta_dot * theta_dot - mu / (r * r) + u1, theta_dot, (u2 - 2.0 * r_dot * theta_dot) / r

    def final(tolerance: float, method: str = method) -> Array:
        return solve(f, (0.0, T_FINAL), START, method=method, rtol=tolerance, atol=tolerance).y[:, -1]

    exact = final(1e-13, "DOP853")
    allowed = np.abs(on_arrays(case).final() - exact).max()
    tolerance = next(e for e in 10.0 ** -np.arange(3.0, 13.5, 0.5) if np.abs(final(e) - exact).max() <= allowed)
    return Runner(lambda: final(tolerance), lambda: final(tolerance), f"error at most that of the grid, {allowed:.0e}")
