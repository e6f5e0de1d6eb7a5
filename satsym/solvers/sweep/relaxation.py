"""Plain relaxation of the sweep, u <- (1 - rho) u + rho law, as textbooks and the documents print it.

Near an extremal without active bounds the law responds to a change v of the control by -K v with K >= 0, so
an error shrinks by 1 - rho (1 + k) for each eigenvalue k of K: relaxation is stable only if
rho < 2/(1 + max k). K grows quickly with the horizon. Far from the extremal K is another one, so what a
failed relaxation is told is measured at the extremal, which a method without this limit finds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.solution import Iteration
from satsym.solvers.iteration import Limits, computed, iterate
from satsym.solvers.sweep.quasi_newton import QuasiNewton
from satsym.solvers.sweep.sweeps import Forward, Sweep, SweepProblem, backward, forward, unbounded_law
from satsym.status import Status

GROWTH = 1e3
"""Divergence: the control and its law are this many times farther apart than they have been."""

PATIENCE = 200
"""Sweeps without coming closer after which it is clear that they go round in circles."""

PROBE = 1e-6
"""Size of the perturbation with which the response of the control law is measured, relative to the control."""

PROBES = 30
"""Power iterations at the most, to find the largest response."""

FALLBACK = 100, 5.0
"""Iterations and seconds that finding the extremal may take when relaxation has failed."""


@dataclass(frozen=True, eq=False)
class Relaxed:
    """Where the relaxation is."""

    sweep: Sweep
    """The last sweep that could be completed."""
    closest: float
    since: int = 0
    """Smallest distance of control and law so far, and the number of sweeps since then."""
    broken: bool = False
    """Whether the next control led out of the domain or to numbers that are not finite."""


@dataclass(frozen=True, eq=False)
class Relaxation:
    """The method, from a starting motion that must be usable."""

    problem: SweepProblem
    start: Forward
    tolerance: float
    fraction: float

    def init(self) -> Relaxed:
        """Sweep the starting control."""
        sweep = backward(self.problem, self.start)
        return Relaxed(sweep, _distance(sweep))

    def measure(self, state: Relaxed, number: int) -> Iteration:
        """Cost and residual."""
        return Iteration(number, state.sweep.objective, state.sweep.residual)

    def step(self, state: Relaxed) -> Relaxed:
        """Move a share of the way to the control law."""
        motion = forward(self.problem, state.sweep.u + self.fraction * state.sweep.step)
        if not motion.usable:
            return replace(state, broken=True)
        sweep = backward(self.problem, motion)
        distance = _distance(sweep)
        closer = distance < state.closest
        return Relaxed(sweep, min(distance, state.closest), 0 if closer else state.since + 1)

    def terminate(self, state: Relaxed) -> tuple[Status, str] | None:
        """Converged when control and control law agree; given up when they grow apart or circle."""
        if state.sweep.residual <= self.tolerance:
            return Status.CONVERGED, "control and control law agree"
        if state.broken or _distance(state.sweep) > GROWTH * state.closest:
            return Status.NOT_CONVERGED, f"relaxation {self.fraction:g} diverges; {self._advice()}"
        if state.since >= PATIENCE:
            return Status.NOT_CONVERGED, f"relaxation {self.fraction:g} goes round in circles; {self._advice()}"
        return None

    def _advice(self) -> str:
        largest = largest_stable(self.problem, self._near_extremal())
        return (
            f"here the iteration converges only if relaxation is below about {largest:.2g}; leave out "
            "relaxation to use a method without this limit"
        )

    def _near_extremal(self) -> Forward:
        iterations, seconds = FALLBACK
        limits = Limits(iterations, computed() + seconds)
        return iterate(QuasiNewton(self.problem, self.start, self.tolerance), limits, None).state.sweep.forward


def largest_stable(problem: SweepProblem, motion: Forward) -> float:
    """The largest stable relaxation near a motion, from the largest response of the law to the control.

    Power iteration on the law without bounds; a lower response found too early makes the estimate optimistic.
    """
    base = unbounded_law(problem, backward(problem, motion))
    size = PROBE * max(np.abs(base).max(), np.abs(motion.u).max(), np.finfo(float).tiny)
    direction = np.ones_like(motion.u)
    response = 0.0
    for _ in range(PROBES):
        direction *= size / np.abs(direction).max()
        moved = forward(problem, motion.u + direction)
        if not moved.usable:
            break
        change = unbounded_law(problem, backward(problem, moved)) - base
        before, response = response, float(-np.sum(change * direction) / np.sum(direction**2))
        if abs(response - before) <= 1e-3 * abs(response):
            break
        direction = change
    return 2.0 / (1.0 + max(response, 0.0))


def _distance(sweep: Sweep) -> float:
    """How far control and control law are apart."""
    return float(np.abs(sweep.step).max(initial=0.0))
