"""Jumps of a control law from one minimiser of H to another: their times, and their effect on neighbouring extremals.

States and costates are continuous at a jump, where the excess of H under one minimiser over the other vanishes. A
neighbouring extremal with the excess sigma at that time jumps later by ``-sigma / sigma'``, and until then has the
rates F- before the jump instead of the rates F+ after it. At the node of a jump two intervals therefore meet with a gap
``(F+ - F-) sigma / sigma'``, which vanishes once the node is at the jump. Newton's method uses the derivatives of this
gap with respect to states and costates, and thus moves the jump.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

HALVINGS = 48
"""Number of bisections of the time between two points, towards the larger change of the control."""

MOVED = 1e-6
"""Change of a control between two times, relative to the largest control, above which it may jump in between."""

WHOLE, FAINT_JUMP = 8, 0.1
"""Number of bisections during which the limit ``MOVED`` holds, and the fraction of a jump that has to remain
afterwards."""

POLISHED = 8
"""Maximum number of Newton steps to a minimiser of H nearby."""

INSTANT = 1e-6
"""Relative step of the finite difference with respect to explicit time."""


@dataclass(frozen=True, eq=False)
class Jump:
    """A jump of the control along a motion."""

    time: float
    """Time of the jump, in the unit of the given times."""
    before: Array
    after: Array
    """Controls before and after the jump, shape (m,)."""


@dataclass(frozen=True, eq=False)
class Saltation:
    """Effect of a jump on neighbouring extremals, in scaled states and costates."""

    leap: Array
    """Change of the rates at the jump, shape (2n,)."""
    excess: float
    """Excess of H under the control after the jump over H under the control before it."""
    slopes: Array
    """Derivatives of the excess with respect to states and costates, shape (2n,)."""
    drift: float
    """Partial derivative of the excess with respect to explicit time."""
    speed: float
    """Time derivative of the excess along the extremal."""

    @property
    def matrix(self) -> Array:
        """Return the saltation matrix: deviations after the jump by deviations before it, shape (2n, 2n)."""
        return np.asarray(np.eye(len(self.leap)) + np.outer(self.leap, self.slopes) / self.speed)

    @property
    def gap(self) -> Array:
        """Return the gap between two intervals at a node that is not yet at the jump, shape (2n,)."""
        return np.asarray(self.leap * (self.excess / self.speed))


def jumps(law: Callable[[Array], Array], times: Array, left: float) -> list[Jump]:
    """Return the jumps of a control law, in order of time.

    If the control changes between two times, the interval is bisected towards the larger change; for a continuous law
    the change tends to zero.

    Parameters
    ----------
    law
        Function from times (M,) to controls (m, M).
    times
        Times between which jumps are searched for, shape (N,).
    left
        Minimum size of a jump, relative to the largest control.
    """
    values = law(times)
    low, high, first, last = times[:-1], times[1:], values[:, :-1], values[:, 1:]
    largest = max(float(np.abs(values).max(initial=0.0)), 1e-300)
    for k in range(HALVINGS):
        still = min(MOVED, left) if k < WHOLE else FAINT_JUMP * left
        kept = np.abs(last - first).max(axis=0, initial=0.0) > still * largest
        low, high, first, last = low[kept], high[kept], first[:, kept], last[:, kept]
        if not low.size:
            return []
        middle = 0.5 * (low + high)
        between = law(middle)
        later = np.abs(last - between).max(axis=0) > np.abs(between - first).max(axis=0)
        low, high = np.where(later, middle, low), np.where(later, high, middle)
        first, last = np.where(later, between, first), np.where(later, last, between)
    jumped = np.flatnonzero(np.abs(last - first).max(axis=0, initial=0.0) > left * largest)
    return [Jump(float(low[k] + high[k]) / 2.0, first[:, k], last[:, k]) for k in jumped]


def saltation(instance: Instance, t: float, z: Array, jump: Jump, unit: Array, cost: float) -> Saltation:
    """Return the saltation at a jump.

    Parameters
    ----------
    t, z
        Time of the jump, and states and costates there, shape (2n,).
    jump
        Jump with approximate controls before and after.
    unit, cost
        Units of states and costates, shape (2n,), and of the cost.
    """
    model, p, n = instance.model, instance.parameters, len(z) // 2
    x, lam = tuple(z[:n].tolist()), tuple(z[n:].tolist())
    pair = [tuple(beside(instance, t, z, u).tolist()) for u in (jump.before, jump.after)]
    before, after = (np.array([*model.dynamics(t, x, u, p), *model.costate_rate(t, x, u, lam, p)]) / unit for u in pair)
    step = INSTANT * max(abs(t), 1.0)

    def excess(at: float) -> float:
        one, other = (float(model.hamiltonian(at, x, u, lam, p)) for u in pair)
        return (other - one) / cost

    leap = after - before
    slopes = np.concatenate([-leap[n:], leap[:n]])
    drift = 0.0 if model.spec.autonomous else (excess(t + step) - excess(t - step)) / (2.0 * step)
    return Saltation(leap, excess(t), slopes, drift, float(slopes @ before) + drift)


def beside(instance: Instance, t: float, z: Array, u: Array) -> Array:
    """Return the minimiser of H near a control, shape (m,), at a time, states and costates (2n,)."""
    model, p, n, m = instance.model, instance.parameters, len(z) // 2, len(u)
    x, lam, control_set = tuple(z[:n].tolist()), tuple(z[n:].tolist()), instance.control_set
    for _ in range(POLISHED):
        at = tuple(u.tolist())
        slope = np.array(model.stationarity(t, x, at, lam, p), dtype=float)
        curved = np.array(model.control_hessian(t, x, at, lam, p), dtype=float).reshape(m, m)
        held = control_set.project((u - 1e-9 * np.sign(slope) * (1.0 + np.abs(u)))[:, None])[:, 0] == u
        free = ~held & (np.diag(curved) > 0.0)
        if not free.any():
            break
        move = np.zeros(m)
        move[free] = -np.linalg.solve(curved[np.ix_(free, free)], slope[free])
        u = control_set.project((u + move)[:, None])[:, 0]
    return u
