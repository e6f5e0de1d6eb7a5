"""Least energy of linear motions within boxes and balls, by the dual problem: concave, of as many unknowns as ends.

For multipliers nu of the end the least of the Lagrangian is g(nu) = nu'd + integral of min over u of (u'u/2 - s'u)
with s = B' exp(A'(tf - t)) C' nu. It is a lower bound of every cost; where its slope vanishes the control that
attains it arrives, and costs as much. Where nu'd exceeds the greatest integral of s'u, no control arrives at all.
"""

from __future__ import annotations

import numpy as np

from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.case import Case
from tests.bench.truth.linear import Linear, linear

STEPS = 4000
ROUNDS = 200
ARRIVES = 1e-9
SEPARATES = 1e-6


def least_energy(case: Case) -> Answer:
    """The least energy within the bounds, or a proof that no control arrives."""
    assert case.tf is not None
    motion, duration = linear(case), case.tf - case.t0
    effects, _ = motion.effect(duration, STEPS)
    h, d = duration / STEPS, motion.gap(duration)
    gram = h * np.einsum("kim,kjm->ij", effects, effects)
    size = np.sqrt(np.diag(gram)) + 1e-300
    nu = np.linalg.solve(gram, d)
    for rounds in range(ROUNDS):
        s = np.einsum("kim,i->km", effects, nu)
        u, weight = _nearest(motion, s)
        left = d - h * np.einsum("kim,km->i", effects, u)
        if np.abs(left / size).max() < ARRIVES * max(1.0, np.abs(d / size).max()):
            cost = h * float((u * u).sum()) / 2.0
            bound = float(nu @ d) + h * float((u * u / 2.0 - s * u).sum())
            how = f"dual problem, {rounds} rounds: lower bound {bound:.9g}"
            return Answer(Truth.MINIMUM, cost, how, duration)
        unit = nu / np.linalg.norm(nu * size)
        surplus = float(unit @ d) - h * _support(motion, np.einsum("kim,i->km", effects, unit))
        if surplus > SEPARATES:
            return Answer(Truth.INFEASIBLE, None, f"a direction separates the end by {surplus:.1e}", duration)
        nu = _improved(motion, effects, h, d, nu, left, weight)
    return Answer(Truth.UNKNOWN, None, "the dual problem does not settle: feasible by a hair or not at all", duration)


def _improved(
    motion: Linear, effects: np.ndarray, h: float, d: np.ndarray, nu: np.ndarray, left: np.ndarray, weight: np.ndarray
) -> np.ndarray:
    """A Newton step on the dual, shortened until it rises."""

    def value(at: np.ndarray) -> float:
        s = np.einsum("kim,i->km", effects, at)
        u, _ = _nearest(motion, s)
        return float(at @ d) + h * float((u * u / 2.0 - s * u).sum())

    curvature = h * np.einsum("kim,kmn,kjn->ij", effects, weight, effects)
    scale = np.sqrt(np.diag(h * np.einsum("kim,kjm->ij", effects, effects)))
    curvature += np.diag(scale**2) * 1e-12
    step, now = np.linalg.solve(curvature, left), value(nu)
    for _ in range(60):
        if value(nu + step) >= now + 1e-4 * float(step @ left):
            return nu + step
        step = step / 2.0
    return nu + step


def _nearest(motion: Linear, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The points of the control set nearest to s, and the derivative of that, shape (count, m, m)."""
    m = s.shape[1]
    if np.isfinite(motion.radius):
        size = np.maximum(np.linalg.norm(s, axis=1), 1e-300)
        out = size > motion.radius
        factor = np.where(out, motion.radius / size, 1.0)
        across = s / size[:, None]
        weight = factor[:, None, None] * (
            np.eye(m) - np.where(out, 1.0, 0.0)[:, None, None] * across[:, :, None] * across[:, None, :]
        )
        return s * factor[:, None], weight
    u = np.clip(s, motion.low, motion.high)
    inside = (s > motion.low) & (s < motion.high)
    return u, inside[:, :, None] * np.eye(m)


def _support(motion: Linear, s: np.ndarray) -> float:
    """The sum of the greatest s'u."""
    if np.isfinite(motion.radius):
        return float(motion.radius * np.linalg.norm(s, axis=1).sum())
    with np.errstate(invalid="ignore"):
        values = np.where(s > 0.0, s * motion.high, np.where(s < 0.0, s * motion.low, 0.0))
    return float(values.sum())
