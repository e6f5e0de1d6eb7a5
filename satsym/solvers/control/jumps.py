"""Jumps of a control law from one minimiser of H to another: where they are, and how neighbouring extremals pass them.

States and costates go on while the control jumps, where the excess of H under one minimiser over the other vanishes.
Beside an extremal that jumps, a neighbour with the excess sigma at that time jumps at a time that is later by
``-sigma / sigma'``, and goes until then at the rates F before instead of those after the jump. At the node of a jump
two intervals therefore meet but for ``(F+ - F-) sigma / sigma'``, which vanishes once the node is where the jump is;
and Newton's method, which knows how that follows states and costates, sees the jump move.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

HALVINGS = 48
"""Halvings of the time between two points, towards where the control moves most."""

MOVED = 1e-6
"""Share of the largest control by which one moves that may have jumped."""

WHOLE, FAINT_JUMP = 8, 0.1
"""Halvings until which that holds, and afterwards the share of a jump that must be left, for the rest is none."""

POLISHED = 8
"""Steps of Newton's method from a minimiser of H nearby."""

INSTANT = 1e-6
"""Over which a derivative by explicit time is taken, relative to it."""


@dataclass(frozen=True, eq=False)
class Jump:
    """A jump along a motion."""

    time: float
    """In the unit of what it was looked for in."""
    before: Array
    after: Array
    """The control on both sides, shape (m,)."""


@dataclass(frozen=True, eq=False)
class Saltation:
    """How neighbouring extremals pass a jump, scaled as the states and costates are."""

    leap: Array
    """Change of the rates, shape (2n,)."""
    excess: float
    """Excess of H after the jump over H before."""
    slopes: Array
    """Slopes of the excess by states and costates, shape (2n,)."""
    drift: float
    """Its rate by explicit time."""
    speed: float
    """Its rate along the extremal."""

    @property
    def matrix(self) -> Array:
        """What neighbours differ by after the jump, by what they differed by before it, shape (2n, 2n)."""
        return np.asarray(np.eye(len(self.leap)) + np.outer(self.leap, self.slopes) / self.speed)

    @property
    def gap(self) -> Array:
        """The gap between both sides at a node that is not yet where the jump is, shape (2n,)."""
        return np.asarray(self.leap * (self.excess / self.speed))


def jumps(law: Callable[[Array], Array], times: Array, left: float) -> list[Jump]:
    """Where a law jumps, in order.

    Where it moves from one of the times to the next, that is narrowed down to where it moves most: of the move of a
    continuous law there is nothing left then.

    Parameters
    ----------
    law
        From times (M,) to controls (m, M).
    times
        Between which jumps are looked for, shape (N,).
    left
        Share of the largest control by which it still moves where it jumps.
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
    """The saltation of a jump.

    Parameters
    ----------
    t, z
        The time, and states and costates there, shape (2n,).
    jump
        With the control before and after, nearly.
    unit, cost
        Of states and costates, shape (2n,), and of the cost.
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
    """The minimiser of H near a control, shape (m,), at a time, states and costates (2n,)."""
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
