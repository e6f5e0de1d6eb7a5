"""The second variation of a smooth extremal, one arc with changes of the control constant on short pieces."""

from __future__ import annotations

from dataclasses import dataclass
from math import gcd

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.solution import Solution
from satsym.solvers.certificate.second_variation import Arc, Quadratic, quadratic, scaled_units

PIECES = 50
"""On which the control's change is constant, at most."""

NUDGE = 1e-6
"""Relative change of states and costates that shows how the control law follows them."""


@dataclass(frozen=True, eq=False)
class Along:
    """The second variation along a solution, and how its control follows changes."""

    second: Quadratic
    feedback: Array
    direct: Array
    """The control by the states and by what changes by itself, in units, shapes (2 N + 1, m, n)."""

    def controls(self, direction: Array) -> Array:
        """What a direction does to the controls at nodes and midpoints of the grid, shape (m, 2 N + 1)."""
        (arc,), n = self.second.arcs, self.feedback.shape[2]
        (h, per), x, found = arc.widths, np.zeros(n + 1), []
        length, unit = direction[0] * arc.lasting, np.sqrt(2.0 / (h * per))
        for k in range(len(self.feedback) // 2):
            first = 1 + (n + 1) * (k // per)
            w = unit * direction[first : first + n + 1]
            middle, after = arc.stepped(k, x, w, np.asarray(length / arc.lasting))
            found += [
                self.feedback[at] @ y[:n] + self.direct[at] @ w[:n] for at, y in ((2 * k, x), (2 * k + 1, middle))
            ]
            x = after
        found.append(self.feedback[-1] @ x[:n] + self.direct[-1] @ w[:n])
        return np.array(found).T


def along(solution: Solution, grid: Grid) -> Along | None:
    """The second variation of a solution; ``None`` where numbers fail.

    Parameters
    ----------
    grid
        On which the linearised motion is integrated.
    """
    instance, n, t = solution.instance, len(solution.x), interleave(grid.nodes, grid.midpoints)
    model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
    z = np.array([np.interp(t, solution.times, row) for row in np.concatenate([solution.x, solution.lam])])
    state, cost = scaled_units(solution)
    scale = np.concatenate([state[:-1], cost / state[:-1]])
    slopes = np.zeros((len(t), 2 * n, 2 * n + 1))
    slopes[:, :, :-1] = model.canonical_jacobian_batch(t, z[:n], z[n:], p, bounds).transpose(2, 0, 1)
    law, rates = _law_slopes(solution, t, z, scale), np.asarray(model.canonical_batch(t, z[:n], z[n:], p, bounds))
    if not (np.isfinite(slopes).all() and np.isfinite(law).all() and np.isfinite(rates).all()):
        return None
    still = np.zeros(len(t)), np.zeros(len(t))  # the final time is given
    arc = Arc.of(t, slopes, rates, still, state, cost, gcd(grid.steps, PIECES))
    # the law follows the costates as -K B', where push is the root of B K B'
    direct = -law[:, :, n:] @ np.linalg.pinv(arc.push[:, :n, :n], rcond=NUDGE, hermitian=True)
    return Along(quadratic(solution, [arc], state, cost), law[:, :, :n], direct)


def _law_slopes(solution: Solution, t: Array, z: Array, scale: Array) -> Array:
    """The control law by scaled states and costates, by differences, shape (M, m, 2n)."""
    instance, n = solution.instance, len(z) // 2
    size = np.maximum(np.abs(z).max(axis=1), NUDGE * scale)
    change = NUDGE * size[:, None] * np.concatenate([np.eye(2 * n), -np.eye(2 * n)], axis=1)
    moved = (z[:, None] + change[:, :, None]).reshape(2 * n, -1)
    p, bounds = instance.parameters, instance.control_set.arguments
    law = np.asarray(instance.model.control_law_batch(np.tile(t, 4 * n), moved[:n], moved[n:], p, bounds))
    ahead, behind = np.split(law.reshape(len(law), 4 * n, len(t)), 2, axis=1)
    return np.asarray((ahead - behind).transpose(2, 0, 1) * (scale / (2.0 * NUDGE * size)))
