"""Projected quasi-Newton descent in the control, with the gradient that a forward-backward sweep provides.

In the metric of H_uu the Hessian of J is the identity plus a smoothing operator. A limited-memory method that starts
from the identity therefore converges quickly and independently of the grid. Controls at an active bound move to the
control law instead (a two-metric projection: Bertsekas, SIAM J. Control Optim. 20, 1982); on the sphere that bounds a
ball, the descent continues along the sphere.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solution import Iteration
from satsym.solvers.sweep.sweeps import Forward, Sweep, SweepProblem, backward, forward, unbounded_law
from satsym.status import Status

MEMORY = 20
"""Number of stored pairs; few are needed, since a terminal cost on n states adds n large eigenvalues."""

SUFFICIENT = 1e-4
"""Fraction of the decrease predicted by the gradient that a step must achieve (Armijo)."""

SHORTEST, SHORTEST_CLOSE = 2.0**-40, 2.0**-20
"""Step lengths below which a direction is abandoned, far from the optimum and close to it."""

CLOSE_RESIDUAL = 1e-2
"""Residual below which a step may also be accepted because it reduces the residual.

Gradient and J are fourth-order approximations, but the gradient is not the derivative of the approximate J. Near the
optimum J can therefore no longer decide which step is better.
"""

NOTICEABLE = 1e-9
"""Relative decrease of J below which it may be caused by rounding or discretisation."""

ROUNDING = 30.0
"""Factor of the effect of a change of the last digit, within which a residual cannot be reduced further."""

TINY_RESIDUAL = 1e-9
"""Residual below which the effect of rounding is tested before each step, to avoid many steps without progress."""

SURE = 3.0
"""Value of ``ROUNDING`` while steps that reduce the residual are still found."""


@dataclass(frozen=True, eq=False)
class Descent:
    """State of the quasi-Newton descent."""

    sweep: Sweep
    """The current control with its motion, costates and gradient."""
    pairs: tuple[tuple[Array, Array], ...] = ()
    """Recent pairs of step and change of gradient in the scaled control, the newest last."""
    stalled: bool = False
    """Whether no acceptable step was found from the current control."""


@dataclass(frozen=True, eq=False)
class QuasiNewton:
    """Quasi-Newton descent from an initial motion, which must be usable."""

    problem: SweepProblem
    start: Forward
    tolerance: float

    def init(self) -> Descent:
        """Return the state at the initial control."""
        return Descent(backward(self.problem, self.start))

    def measure(self, state: Descent, number: int) -> Iteration:
        """Return cost and residual of an iteration."""
        return Iteration(number, state.sweep.objective, state.sweep.residual)

    def terminate(self, state: Descent) -> tuple[Status, str] | None:
        """Return status and message if the control agrees with the control law, or no step is found.

        Otherwise ``None``.
        """
        residual = state.sweep.residual
        if residual <= self.tolerance:
            return Status.CONVERGED, "control and control law agree"
        factor = ROUNDING if state.stalled else SURE if residual <= TINY_RESIDUAL else 0.0
        if factor and residual <= factor * _rounding(self.problem, state.sweep):
            return Status.CONVERGED, f"control and control law agree to {residual:.0e}, as far as rounding allows"
        if not state.stalled:
            return None
        return Status.NOT_CONVERGED, f"no step decreases the cost further; residual {residual:.1e}"

    def step(self, state: Descent) -> Descent:
        """Return the state after one projected step with backtracking.

        If none is found, it is repeated without memory.
        """
        for pairs in (state.pairs, ()):
            found = self._search(state.sweep, pairs)
            if found is not None:
                return Descent(found, self._remember(pairs, state.sweep, found))
        return replace(state, stalled=True)

    def _scale(self, sweep: Sweep, free: Tangent) -> Array:
        """Return square roots of weight times H_uu.

        They scale the control so that the Hessian of J is near the identity.
        """
        instance = self.problem.instance
        h_uu = self.problem.kernels.control_hessian_batch(
            self.problem.times, sweep.forward.x, sweep.u, sweep.lam, instance.parameters
        )
        return np.sqrt(self.problem.weights * np.einsum("iik->ik", h_uu) * free.curvature)

    def _direction(self, sweep: Sweep, pairs: Sequence[tuple[Array, Array]]) -> tuple[Array, Array]:
        """Return the step in the control, and the gradient of J on the fine grid, restricted to free directions."""
        free = tangent(self.problem, sweep)
        scale = self._scale(sweep, free)
        gradient = free.along(self.problem.weights * sweep.gradient)
        descent = -_inverse_hessian(pairs, free.free(gradient / scale), free) / scale
        return np.where(free.moves, descent, sweep.step), gradient

    def _search(self, sweep: Sweep, pairs: Sequence[tuple[Array, Array]]) -> Sweep | None:
        """Return the first sweep along the projected direction with a smaller cost or, close to the optimum, residual.

        ``None`` is returned if there is none.
        """
        direction, gradient = self._direction(sweep, pairs)
        if not np.sum(gradient * direction) < 0.0:
            return None
        length, shortest = 1.0, SHORTEST_CLOSE if sweep.residual < CLOSE_RESIDUAL else SHORTEST
        while length > shortest:
            u = self.problem.instance.control_set.project(sweep.u + length * direction)
            predicted = float(np.sum(gradient * (u - sweep.u)))
            motion = forward(self.problem, u)
            if motion.usable:
                decrease = sweep.objective - motion.objective
                if decrease >= -SUFFICIENT * predicted and decrease > NOTICEABLE * abs(sweep.objective):
                    return backward(self.problem, motion)
                if sweep.residual < CLOSE_RESIDUAL:
                    trial = backward(self.problem, motion)
                    if trial.residual <= (1.0 - 0.1 * length) * sweep.residual:
                        return trial
                length *= _shrink(motion.objective - sweep.objective, predicted)
            else:
                length *= 0.25
        return None

    def _remember(
        self, pairs: Sequence[tuple[Array, Array]], before: Sweep, after: Sweep
    ) -> tuple[tuple[Array, Array], ...]:
        then, now = tangent(self.problem, before), tangent(self.problem, after)
        scale = self._scale(after, now)
        step = scale * (after.u - before.u)
        change = self.problem.weights * (now.along(after.gradient) - then.along(before.gradient)) / scale
        return (*pairs, (step, change))[-MEMORY:]


def _rounding(problem: SweepProblem, sweep: Sweep) -> float:
    """Return the residual that rounding alone causes: the change of the control law for a change in the last digits."""
    nudged = sweep.u * (1.0 + 4.0 * np.finfo(float).eps)
    instance = problem.instance
    initial = tuple(float(np.nextafter(value, np.inf)) for value in instance.initial)
    moved = replace(problem, instance=replace(instance, initial=initial))
    motion = forward(moved, nudged)
    if not motion.usable:
        return 0.0
    change = np.abs(backward(moved, motion).law - sweep.law).max(initial=0.0)
    return float(change / max(np.abs(sweep.law).max(initial=0.0), np.finfo(float).tiny))


def _shrink(change: float, predicted: float) -> float:
    """Return the factor to the minimum of the parabola through the known values, limited to [0.1, 0.5]."""
    curvature = change - predicted
    return float(min(0.5, max(0.1, -predicted / (2.0 * curvature)))) if curvature > 0.0 else 0.5


def _inverse_hessian(pairs: Sequence[tuple[Array, Array]], gradient: Array, free: Tangent) -> Array:
    """Return the product of the L-BFGS inverse Hessian in the free directions with a gradient.

    The two-loop recursion starts from the identity (Nocedal and Wright, 7.4).
    """
    q = gradient.copy()
    used = []
    for step, change in reversed(pairs):
        s, y = free.free(step), free.free(change)
        curvature = np.sum(s * y)
        if curvature > 1e-12 * np.sum(y * y):
            weight = np.sum(s * q) / curvature
            q -= weight * y
            used.append((s, y, curvature, weight))
    for s, y, curvature, weight in reversed(used):
        q += (weight - np.sum(y * q) / curvature) * s
    return q


ON_SPHERE = 1e-9
"""Relative distance from the sphere below which a control counts as lying on it."""


@dataclass(frozen=True, eq=False)
class Tangent:
    """Directions in which the controls of a sweep are free.

    In a box a control is free or saturated. A saturated control in a ball can still turn: it moves on a sphere, so that
    only tangential gradients count and the curvature of the sphere is added to the Hessian.
    """

    moves: NDArray[np.bool_]
    """Whether a control may move in the free directions; otherwise it is saturated. Shape (m, M)."""
    normal: Array | None = None
    """Unit normals of the sphere, zero for controls not on it, shape (m, M); ``None`` without a ball."""
    curvature: Array | float = 1.0
    """Hessian of H on the sphere relative to H_uu, one elsewhere; shape (M,), or a number."""

    def along(self, field: Array) -> Array:
        """Return a field without its normal components, shape (m, M)."""
        return field if self.normal is None else field - self.normal * (self.normal * field).sum(axis=0)

    def free(self, field: Array) -> Array:
        """Return a field without its normal components, and zero for saturated controls, shape (m, M)."""
        return np.where(self.moves, self.along(field), 0.0)


def tangent(problem: SweepProblem, sweep: Sweep) -> Tangent:
    """Return the free directions at the control of a sweep."""
    instance = problem.instance
    wanted = unbounded_law(problem, sweep)
    free = instance.control_set.active(wanted) == 0
    if instance.model.spec.control_set != "ball" or free.all():
        return Tangent(free)
    norm, excess = np.linalg.norm(sweep.u, axis=0), np.linalg.norm(wanted, axis=0) / instance.max_norm
    outside = (excess > 1.0) & (norm >= (1.0 - ON_SPHERE) * instance.max_norm)
    held = outside & ((sweep.u * wanted).sum(axis=0) > 0.0)  # from the far side the way is through the ball
    return Tangent(
        moves=free | held,
        normal=np.where(held, sweep.u / np.where(held, norm, 1.0), 0.0),
        curvature=np.where(held, excess, 1.0),
    )
