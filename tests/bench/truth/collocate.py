"""Direct collocation with CasADi and Ipopt: one nonlinear program a model, everything else by its bounds.

States are polynomials of degree four on intervals, equal ones unless told otherwise, matched at Gauss points, where the
controls live as well.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial.legendre import leggauss

from tests.bench.truth.case import Case
from tests.bench.truth.physics import MODELS

POINTS = 4
NODES = (leggauss(POINTS)[0] + 1.0) / 2.0
WEIGHTS = leggauss(POINTS)[1] / 2.0
KEPT = (1, 2)
"""Of the points, those at which constraints along the way are kept, besides the ends of intervals: at all of them there
would be as many on a boundary as there are controls, and one more."""
DENSE = 24
"""Places an interval at which they are looked at afterwards."""
OPTIONS = {
    "print_time": False,
    "expand": False,
    "ipopt.print_level": 0,
    "ipopt.sb": "yes",
    "ipopt.tol": 1e-9,
    "ipopt.max_iter": 250,
    "ipopt.bound_relax_factor": 0.0,
    "ipopt.acceptable_tol": 1e-7,
}


@dataclass(frozen=True, eq=False)
class Start:
    """An initial guess.

    Attributes
    ----------
    duration
        Of time.
    path
        States at given shares of it: shares (k,) to states (n, k).
    shift
        What is added to final angles that count modulo a turn.
    """

    duration: float
    path: Any
    shift: float = 0.0


@dataclass(frozen=True, eq=False)
class Found:
    """A solution of the program.

    Attributes
    ----------
    cost, duration
        As the program has them.
    states
        At the ends of intervals, shape (n, intervals + 1).
    controls
        At the Gauss points, shape (intervals, POINTS, m).
    goal
        What the final states had to be; NaN where they are free.
    slope
        Derivative of the least cost with respect to it.
    edges
        Between intervals, as fractions of the duration, shape (intervals + 1,).
    inside
        States at the Gauss points, shape (intervals, POINTS, n).
    """

    cost: float
    duration: float
    states: np.ndarray
    controls: np.ndarray
    goal: np.ndarray
    slope: np.ndarray
    edges: np.ndarray
    inside: np.ndarray

    def path(self, fractions: np.ndarray) -> np.ndarray:
        """States between the ends of intervals, on straight lines."""
        return np.array([np.interp(fractions, self.edges, row) for row in self.states])

    def dense(self) -> tuple[np.ndarray, np.ndarray]:
        """Fractions of the duration between the ends of intervals, shape (M,), and states there, shape (n, M)."""
        known = np.concatenate([self.states.T[:-1, None], self.inside], axis=1)
        x = np.einsum("ji,kin->kjn", _values(np.arange(DENSE) / DENSE), known)
        fractions = self.edges[:-1, None] + np.diff(self.edges)[:, None] * np.arange(DENSE) / DENSE
        return fractions.ravel(), x.reshape(-1, x.shape[-1]).T


def solved(case: Case, start: Start, intervals: int, edges: np.ndarray | None = None) -> Found | None:
    """Solve from one start; ``None`` where Ipopt ends without success."""
    edges = np.linspace(0.0, 1.0, intervals + 1) if edges is None else edges
    program = _program(case.model, intervals)
    physics = MODELS[case.model]
    n, m = len(physics.states), len(physics.controls)
    given = program.bounds(case, start)
    with np.errstate(all="ignore"):
        p = [*physics.given(case.parameters), case.t0, *np.diff(edges)]
        result = program.solver(x0=program.guess(case, start, edges), p=p, **given)
    if not program.solver.stats()["success"]:
        return None
    values = np.array(result["x"]).ravel()
    rest = values[1 + n :].reshape(intervals, POINTS * (n + m) + n)
    controls = rest[:, POINTS * n : POINTS * (n + m)].reshape(intervals, POINTS, m)
    at_end, on_curve = np.array(result["lam_x"]).ravel()[-n:], np.array(result["lam_g"]).ravel()[: program.curves]
    goal, slope = np.full(n, np.nan), np.zeros(n)
    for i, name in enumerate(physics.states):
        if name not in case.final:
            continue
        moving = case.final[name] == "reference"
        slope[i] = -(on_curve[i] if moving else at_end[i])
        goal[i] = values[-n + i]
    states = np.vstack([values[1 : 1 + n], rest[:, -n:]]).T
    inside = rest[:, : POINTS * n].reshape(intervals, POINTS, n)
    return Found(float(result["f"]), float(values[0]), states, controls, goal, slope, edges, inside)


@dataclass(frozen=True, eq=False)
class _Program:
    """A nonlinear program: its solver, and how many of its constraints concern what."""

    model: str
    intervals: int
    solver: Any
    curves: int
    ends: int
    matches: int
    balls: int
    kept: int

    def bounds(self, case: Case, start: Start) -> dict[str, np.ndarray]:
        """Of variables and constraints."""
        physics = MODELS[self.model]
        n, inf = len(physics.states), np.inf
        pairs = [case.bounds.get(name, (-inf, inf)) for name in physics.controls]
        block_low = np.concatenate(
            [np.full(POINTS * n, -inf), np.tile([a for a, _ in pairs], POINTS), np.full(n, -inf)]
        )
        block_high = np.concatenate([np.full(POINTS * n, inf), np.tile([b for _, b in pairs], POINTS), np.full(n, inf)])
        initial = [case.initial[name] for name in physics.states]
        span = (1e-3, 20.0 * start.duration) if case.tf is None else (case.tf - case.t0,) * 2
        low = np.concatenate([[span[0]], initial, np.tile(block_low, self.intervals)])
        high = np.concatenate([[span[1]], initial, np.tile(block_high, self.intervals)])
        free = np.full(self.curves, inf)
        for i, name in enumerate(physics.states):
            value = case.final.get(name)
            if value == "reference":
                free[i] = 0.0
            elif value is not None:
                low[i - n] = high[i - n] = value + (start.shift if name in case.free_angles else 0.0)
        exact = np.zeros(self.ends + self.matches)
        radius = inf if case.max_norm is None else case.max_norm**2
        constraints_low = np.concatenate([-free, exact, np.full(self.balls + self.kept, -inf)])
        constraints_high = np.concatenate([free, exact, np.full(self.balls, radius), np.zeros(self.kept)])
        return {"lbx": low, "ubx": high, "lbg": constraints_low, "ubg": constraints_high}

    def guess(self, case: Case, start: Start, edges: np.ndarray) -> np.ndarray:
        """The start on the grid; the controls in the middle of their bounds, as near to zero as these allow."""
        physics = MODELS[self.model]
        fractions = edges[:-1, None] + np.diff(edges)[:, None] * np.append(NODES, 1.0)
        states = start.path(fractions.ravel()).T.reshape(self.intervals, POINTS + 1, -1)
        middle = [np.clip(0.0, *case.bounds.get(name, (-np.inf, np.inf))) for name in physics.controls]
        rows = [np.concatenate([block[:POINTS].ravel(), np.tile(middle, POINTS), block[POINTS]]) for block in states]
        return np.concatenate([[start.duration], [case.initial[name] for name in physics.states], *rows])


@cache
def _program(model: str, intervals: int) -> _Program:
    import casadi as ca

    physics = MODELS[model]
    n, m = len(physics.states), len(physics.controls)
    slopes, ends = _polynomials()
    p, t0, T = ca.SX.sym("p", len(physics.parameters)), ca.SX.sym("t0"), ca.SX.sym("T")
    widths, begun = ca.SX.sym("w", intervals), t0
    x = ca.SX.sym("x", n)
    variables, matches, balls, kept, cost = [T, x], [], [], [], 0.0
    for k in range(intervals):
        xs = [ca.SX.sym(f"x_{k}_{j}", n) for j in range(POINTS)]
        us = [ca.SX.sym(f"u_{k}_{j}", m) for j in range(POINTS)]
        after = ca.SX.sym(f"x_{k}", n)
        points, h = [x, *xs], T * widths[k]
        for j in range(POINTS):
            t = begun + h * NODES[j]
            rate = ca.vertcat(*physics.rate(ca, t, xs[j], us[j], p))
            matches.append(sum(slopes[i, j] * points[i] for i in range(POINTS + 1)) - h * rate)
            cost += h * WEIGHTS[j] * physics.running(ca, t, xs[j], us[j], p)
            balls.append(ca.dot(us[j], us[j]))
            kept += physics.kept(ca, t, xs[j], p) if j in KEPT else ()
        matches.append(sum(ends[i] * points[i] for i in range(POINTS + 1)) - after)
        variables += [*xs, *us, after]
        x = after
        if k < intervals - 1:
            kept += physics.kept(ca, begun + h, x, p)
        begun += h
    curve = physics.reference(ca, t0 + T, p)
    curves = [x - ca.vertcat(*curve)] if len(curve) else [x]
    psi = list(physics.ends(ca, t0 + T, x, p))
    cost += physics.terminal(ca, t0 + T, x, p)
    ball = balls if model.endswith("_ball") else []
    constraints = ca.vertcat(*curves, *psi, *matches, *ball, *kept)
    program = {"x": ca.vertcat(*variables), "p": ca.vertcat(p, t0, widths), "f": cost, "g": constraints}
    solver = ca.nlpsol("program", "ipopt", program, OPTIONS)
    return _Program(model, intervals, solver, n, len(psi), ca.vertcat(*matches).shape[0], len(ball), len(kept))


def _polynomials() -> tuple[np.ndarray, np.ndarray]:
    """Slopes at the Gauss points and values at the end of the polynomials that are one at 0 or one Gauss point."""
    slopes = np.array([one.deriv()(NODES) for one in _basis()])
    return slopes, _values(np.ones(1))[0]


def _values(fractions: np.ndarray) -> np.ndarray:
    """Those polynomials at fractions of an interval, shape (M, POINTS + 1)."""
    return np.array([one(fractions) for one in _basis()]).T


def _basis() -> list[np.poly1d]:
    nodes, found = np.append(0.0, NODES), []
    for i in range(POINTS + 1):
        one = np.poly1d([1.0])
        for k in range(POINTS + 1):
            if k != i:
                one *= np.poly1d([1.0, -nodes[k]]) / (nodes[i] - nodes[k])
        found.append(one)
    return found
