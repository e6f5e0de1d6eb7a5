"""What the second variation owes to points on the way, whose times vary.

Variations are those at a moment that moves with the times: between two points by a share of what either is moved. With
theta for that shift, states vary by dx' = f_x dx + f_u du + f_t theta + f theta', and to the form come second
derivatives of H by time and 2 theta' (H_x dx + H_t theta); where a point is passed, pi' N by state and time, and its
linearised conditions hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solution import Solution
from satsym.solvers.certificate.constrained.passing import places
from satsym.solvers.certificate.constrained.replay import Replay
from satsym.solvers.constrained.arcs import conditions, gradient, missed

DIFFERENCE = 1e-5
"""Share of the duration by which a derivative by time is differenced once more."""


@dataclass(frozen=True, eq=False)
class Moving:
    """The points of a solution; a unit of each variation of their times is the duration."""

    solution: Solution
    again: Replay

    @cached_property
    def arcs(self) -> list[int]:
        """After which arcs they are passed."""
        return places(self.solution)

    @cached_property
    def _edges(self) -> Array:
        times = [self.again.pieces[k].times[-1] for k in self.arcs]
        return np.array([self.solution.times[0], *times, self.solution.times[-1]])

    @property
    def lasting(self) -> float:
        """The duration."""
        return float(self._edges[-1] - self._edges[0])

    def shifts(self, times: Array) -> Array:
        """By how much each variation shifts these times, shape (points, N)."""
        units = self.lasting * np.eye(len(self._edges))[1:-1]
        return np.array([np.interp(times, self._edges, row) for row in units]).reshape(len(self.arcs), len(times))

    def drives(self, t: Array, x: Array, u: Array, shift: Array, pace: Array) -> Array:
        """f_t theta + f theta', shape (points, n, N)."""
        model, p = self.solution.instance.model, self.solution.instance.parameters
        f = np.broadcast_to(model.dynamics_batch(t, x, u, p), x.shape)
        return np.asarray(shift[:, None] * self._by_time(lambda s: model.dynamics_batch(s, x, u, p), t, x.shape)) + (
            pace[:, None] * f
        )

    def mixed(self, t: Array, x: Array, u: Array, lam: Array, shift: Array, pace: Array) -> tuple[Array, Array]:
        """What the form has in a variation of times and one of states and controls, and in two of times.

        Shapes (points, n + m, N) and (points, points, N).
        """
        model, p = self.solution.instance.model, self.solution.instance.parameters
        h_x = -np.broadcast_to(model.costate_rate_batch(t, x, u, lam, p), x.shape)
        h_xt = -self._by_time(lambda s: model.costate_rate_batch(s, x, u, lam, p), t, x.shape)
        h_ut = self._by_time(lambda s: model.stationarity_batch(s, x, u, lam, p), t, u.shape)

        def h_t(times: Array) -> Array:
            return self._by_time(lambda s: model.hamiltonian_batch(s, x, u, lam, p), times, t.shape)

        step = DIFFERENCE * self.lasting
        h_tt = (h_t(t + step) - h_t(t - step)) / (2.0 * step)
        by_both = shift[:, None] * np.concatenate([h_xt, h_ut])
        by_both[:, : len(x)] += pace[:, None] * h_x
        twice = pace[:, None] * shift * h_t(t)
        return by_both, shift[:, None] * shift * h_tt + twice + twice.swapaxes(0, 1)

    def _by_time(self, of: object, t: Array, shape: tuple[int, ...]) -> Array:
        if self.solution.instance.model.spec.autonomous:
            return np.zeros(shape)
        moved: NDArray[Any] = t + 1j * COMPLEX_STEP
        return np.broadcast_to(np.imag(of(moved)) / COMPLEX_STEP, shape)  # type: ignore[operator]

    def passed(self, point: int) -> tuple[Array, Array]:
        """Rows that vanish where a point is passed, and the form there, by the state and by the variation of its time.

        Shapes (conditions, n + 1) and (n + 1, n + 1).
        """
        arc, which = self.arcs[point], conditions(self.solution.instance)[point]
        piece, n = self.again.pieces[arc], len(self.solution.x)
        t, x = piece.times[-1:], piece.z[:n, -1:]
        pi = np.array([self.again.jumps[arc][k] for k in which])

        def slopes(y: Array) -> Array:
            time, state = y[-1], y[:-1]
            by_x = [gradient(self.solution.instance, k, time, state) for k in which]
            by_t = missed(self.solution.instance, which, time, state)[1]
            return np.concatenate([np.array(by_x), by_t[:, None]], axis=1)[..., 0]

        here = np.concatenate([x, t[None]])
        unit = np.append(np.ones(n), self.lasting)
        moved = [here + 1j * COMPLEX_STEP * column[:, None] for column in np.eye(n + 1)]
        curved = np.array([pi @ np.imag(slopes(y)) / COMPLEX_STEP for y in moved])
        return np.real(slopes(here)) * unit, (curved + curved.T) / 2 * np.outer(unit, unit)
