"""Closed forms: the body on a line by algebra over both signs, quadratic costs by Gramians and conjugate times."""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import expm

from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.case import Case
from tests.bench.truth.linear import linear

NEVER = Answer(Truth.INFEASIBLE, None, "algebra: no pair of arcs arrives")


def line_time(case: Case) -> Answer:
    """Least time of a body on a line: two arcs at opposite bounds, of whatever signs these are."""
    q, v = case.initial["q"], case.initial["q_dot"]
    end, rate = float(case.final["q"]), float(case.final["q_dot"])
    low, high = case.bounds["u1"]
    times = [t for a, b in ((low, high), (high, low)) for t in _two_arcs(q, v, end, rate, a, b)]
    if not times:
        return NEVER
    return Answer(Truth.MINIMUM, min(times), "algebra over both signs", min(times))


def _two_arcs(q: float, v: float, end: float, rate: float, a: float, b: float) -> list[float]:
    """Durations of two arcs, first a and then b, that lead from (q, v) to (end, rate).

    With w the rate between them: end - q = (w^2 - v^2)/(2 a) + (rate^2 - w^2)/(2 b), where neither is zero.
    """
    found = []
    for w in _between(q, v, end, rate, a, b):
        first = (w - v) / a if a else None
        last = (rate - w) / b if b else None
        if first is None:
            # Coasting at rate v first: its length makes up the way that is left.
            way = end - q - (rate**2 - v**2) / (2.0 * b)
            first = way / v if v else (0.0 if abs(way) < 1e-12 else -1.0)
        if last is None:
            way = end - q - (rate**2 - v**2) / (2.0 * a)
            last = way / rate if rate else (0.0 if abs(way) < 1e-12 else -1.0)
        if first >= -1e-12 and last >= -1e-12:
            found.append(max(first, 0.0) + max(last, 0.0))
    return found


def _between(q: float, v: float, end: float, rate: float, a: float, b: float) -> tuple[float, ...]:
    if a == 0.0:
        return (v,)
    if b == 0.0:
        return (rate,)
    square = (end - q + v**2 / (2.0 * a) - rate**2 / (2.0 * b)) / (1.0 / (2.0 * a) - 1.0 / (2.0 * b))
    return (math.sqrt(square), -math.sqrt(square)) if square >= 0.0 else ()


def line_fuel_free(case: Case) -> Answer:
    """Least weighted time and fuel of a body on a line: a burn, a coast and a burn, by the length of the first."""
    low, high = case.bounds["u1"]
    best = (math.inf, 0.0)
    for a, b in ((low, high), (high, low)):
        longest = 40.0
        grid = np.concatenate([[0.0], np.geomspace(1e-7, longest, 40001)])
        costs, durations = _burns(case, grid, a, b)
        for k in np.argsort(costs)[:3]:
            left, right = grid[max(k - 1, 0)], grid[min(k + 1, len(grid) - 1)]
            for _ in range(12):
                fine = np.linspace(left, right, 401)
                values, lengths = _burns(case, fine, a, b)
                at = int(np.argmin(values))
                best = min(best, (float(values[at]), float(lengths[at])))
                left, right = fine[max(at - 1, 0)], fine[min(at + 1, 400)]
        del durations
    if not math.isfinite(best[0]):
        return Answer(Truth.UNKNOWN, None, "no burn, coast and burn arrives", None)
    return Answer(Truth.MINIMUM, best[0], "burn, coast, burn: the least over the length of the first", best[1])


def _burns(case: Case, first: np.ndarray, a: float, b: float) -> tuple[np.ndarray, np.ndarray]:
    q, v = case.initial["q"], case.initial["q_dot"]
    end, rate = float(case.final["q"]), float(case.final["q_dot"])
    with np.errstate(all="ignore"):
        middle = v + a * first
        last = (rate - middle) / b
        way = end - q - v * first - a * first**2 / 2.0 - middle * last - b * last**2 / 2.0
        coast = np.where(np.abs(way) < 1e-13, 0.0, way / middle)
        duration = first + coast + last
        cost = case.parameters["weight_time"] * duration + abs(a) * first + abs(b) * last
    bad = ~np.isfinite(cost) | (coast < 0.0) | (last < 0.0)
    return np.where(bad, np.inf, cost), duration


def conjugate(case: Case) -> Answer:
    """Costs (u^2 - a x^2)/2 on axes of their own: in closed form before the conjugate time, unbounded after it."""
    assert case.tf is not None
    duration, cost = case.tf - case.t0, 0.0
    for k, name in enumerate(case.initial, start=1):
        rate, x0 = math.sqrt(case.parameters.get(f"a{k}", 1.0)), case.initial[name]
        limit = math.pi / rate if name in case.final else math.pi / (2.0 * rate)
        if duration > limit:
            return Answer(Truth.UNBOUNDED, None, f"conjugate time {limit:.6g} of {name} is before the end", duration)
        angle = rate * duration
        if name in case.final:
            xf = float(case.final[name])
            cost += rate / 2.0 * ((x0**2 + xf**2) * math.cos(angle) - 2.0 * x0 * xf) / math.sin(angle)
        else:
            cost -= rate / 2.0 * x0**2 * math.tan(angle)
    return Answer(Truth.MINIMUM, cost, "Riccati equation in closed form", duration)


def weighed(case: Case) -> Answer:
    """Energy and a weighed end: a quadratic function of the end, by the Gramian."""
    assert case.tf is not None
    motion, duration = linear(case), case.tf - case.t0
    n = len(motion.x0)
    K = np.diag([case.parameters.get(f"k{k}", 0.0) for k in range(1, n + 1)])
    free = expm(motion.A * duration) @ motion.x0
    inverse = np.linalg.inv(_gramian(motion.A, motion.B, duration))
    curvature = inverse + K
    if np.linalg.eigvalsh(curvature)[0] < 0.0:
        return Answer(
            Truth.UNBOUNDED, None, "the cost as a function of the end is not convex: by the Gramian", duration
        )
    end = np.linalg.solve(curvature, inverse @ free)
    cost = ((end - free) @ inverse @ (end - free) + end @ K @ end) / 2.0
    return Answer(Truth.MINIMUM, float(cost), "Gramian", duration)


def one_within_bounds(case: Case) -> Answer:
    """One state within bounds: constant controls are best, so the least over the reachable interval."""
    assert case.tf is not None
    duration, x0, k = case.tf - case.t0, case.initial["x1"], case.parameters.get("k1", 0.0)
    low, high = case.bounds["u1"]
    inner = -k * x0 / (1.0 + k * duration) if 1.0 + k * duration > 0.0 else low
    controls = [low, high, min(max(inner, low), high)]
    cost = min(u * u * duration / 2.0 + k * (x0 + u * duration) ** 2 / 2.0 for u in controls)
    return Answer(Truth.MINIMUM, cost, "constant controls, the least of both bounds and the vertex", duration)


def line_end(case: Case) -> Answer:
    """Least energy to a line of the phase plane, without bounds: by the Gramian."""
    assert case.tf is not None
    motion, duration = linear(case), case.tf - case.t0
    gap = motion.gap(duration)
    gram = motion.C @ _gramian(motion.A, motion.B, duration) @ motion.C.T
    return Answer(Truth.MINIMUM, float(gap @ np.linalg.solve(gram, gap)) / 2.0, "Gramian", duration)


def _gramian(A: np.ndarray, B: np.ndarray, duration: float) -> np.ndarray:
    n = len(A)
    block = np.zeros((2 * n, 2 * n))
    block[:n, :n], block[:n, n:], block[n:, n:] = A, B @ B.T, -A.T
    both = expm(block * duration)
    return np.asarray(both[:n, n:] @ both[:n, :n].T)


def line_end_time(case: Case) -> Answer:
    """Least time to a line of the phase plane: the greatest and least of x2 - m x1 that bounds allow, over time."""
    x1, x2 = case.initial["x1"], case.initial["x2"]
    m, c = case.parameters["m"], case.parameters["c"]
    low, high = case.bounds["u1"]

    def reach(T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        # effect of u at tf - s is 1 - m s; it changes its sign at s = 1/m
        split = np.clip(1.0 / m, 0.0, T) if m > 0.0 else T
        early = split - m * split**2 / 2.0
        late = (T - split) - m * (T**2 - split**2) / 2.0
        drift = x2 - m * (x1 + x2 * T) - c
        return drift + high * early + low * late, drift + low * early + high * late

    grid = np.linspace(0.0, 60.0, 600001)
    most, least = reach(grid)
    hit = np.flatnonzero((most >= 0.0) & (least <= 0.0))
    if not len(hit):
        return Answer(Truth.UNKNOWN, None, "no control arrives within 60", None)
    before, after = (grid[max(hit[0] - 1, 0)], grid[hit[0]])
    for _ in range(60):
        middle = (before + after) / 2.0
        up, down = reach(np.array([middle]))
        before, after = (before, middle) if up[0] >= 0.0 >= down[0] else (middle, after)
    return Answer(Truth.MINIMUM, float(after), "reachable values of the constraint, over time", float(after))


def ellipse(case: Case) -> Answer:
    """Least energy to an ellipse: the nearest of its points, by the roots of a polynomial."""
    assert case.tf is not None
    duration, a, b = case.tf - case.t0, case.parameters["a"], case.parameters["b"]
    x, y = case.initial["x1"], case.initial["x2"]
    angles = np.linspace(0.0, 2.0 * math.pi, 20001)

    def distance(angle: np.ndarray) -> np.ndarray:
        return np.asarray((a * np.cos(angle) - x) ** 2 + (b * np.sin(angle) - y) ** 2)

    width = angles[1]
    for _ in range(8):
        at = angles[int(np.argmin(distance(angles)))]
        angles = np.linspace(at - width, at + width, 401)
        width /= 150.0
    nearest = float(distance(angles).min())
    return Answer(Truth.MINIMUM, nearest / (2.0 * duration), "the nearest point of the ellipse", duration)
