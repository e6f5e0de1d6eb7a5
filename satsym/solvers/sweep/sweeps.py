"""One forward-backward sweep: states forwards, costates backwards, and the control law that follows from them.

Controls, states and costates are stored on the fine grid of nodes and midpoints, shape (rows, 2N+1), where even columns
are nodes. The backward sweep is the adjoint of the forward sweep and yields the gradient H_u of the cost (Bryson and
Ho, Applied Optimal Control, 2.2 and 7.2).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.solvers.iteration import Limits
from satsym.solvers.simulation import blocks


@dataclass(frozen=True, eq=False)
class SweepProblem:
    """The problem of a sweep: an instance with a free final state, its kernels, a grid, and limits of time."""

    instance: Instance
    kernels: Kernels
    grid: Grid
    limits: Limits | None = None

    @cached_property
    def times(self) -> Array:
        """Nodes and midpoints, shape (2N+1,)."""
        return interleave(self.grid.nodes, self.grid.midpoints)

    @cached_property
    def weights(self) -> Array:
        """Simpson weights on the fine grid, shape (2N+1,)."""
        return interleave(self.grid.node_weights, self.grid.midpoint_weights)


@dataclass(frozen=True, eq=False)
class Forward:
    """A control and the motion under it."""

    u: Array
    x: Array
    """Controls and states on the fine grid."""
    objective: float
    """The cost J; NaN if the motion is not finite."""
    in_domain: bool
    """Whether the motion stays in the domain of the model."""

    @property
    def usable(self) -> bool:
        """Whether costates can be computed along the motion."""
        return self.in_domain and bool(np.isfinite(self.objective))


@dataclass(frozen=True, eq=False)
class Sweep:
    """A motion with its costates, the control law and the gradient."""

    forward: Forward
    """Control and motion of the forward sweep."""
    lam: Array
    """Costates on the fine grid."""
    law: Array
    """The admissible control that minimises H for these states and costates."""
    gradient: Array
    """The gradient H_u, the derivative of J with respect to the control, per unit of time."""

    @property
    def u(self) -> Array:
        """The control of the forward sweep."""
        return self.forward.u

    @property
    def objective(self) -> float:
        """The cost J of the motion."""
        return self.forward.objective

    @property
    def step(self) -> Array:
        """Control law minus control; zero at an extremal."""
        return self.law - self.u

    @property
    def residual(self) -> float:
        """Largest difference between control and control law, relative to the largest control."""
        size = max(np.abs(self.u).max(initial=0.0), np.abs(self.law).max(initial=0.0))
        return float(np.abs(self.step).max(initial=0.0) / size) if size > 0.0 else 0.0


def forward(problem: SweepProblem, u: Array) -> Forward:
    """Return the motion under a control on the fine grid, shape (m, 2N+1)."""
    instance, kernels = problem.instance, problem.kernels
    p, grid = instance.parameters, problem.grid
    x, x_mid, running = blocks.forward(kernels, grid.nodes, instance.initial, u[:, ::2], u[:, 1::2], p, problem.limits)
    fine = interleave(x, x_mid)
    if not np.isfinite(fine).all():
        return Forward(u, fine, float("nan"), in_domain=True)
    terminal = kernels.terminal_cost(grid.tf, tuple(x[:, -1].tolist()), p)
    return Forward(u, fine, running + terminal, kernels.in_domain(fine))


def backward(problem: SweepProblem, motion: Forward) -> Sweep:
    """Return a usable motion with its costates, control law and gradient."""
    instance, kernels = problem.instance, problem.kernels
    p, grid, x, u = instance.parameters, problem.grid, motion.x, motion.u
    lam_f = kernels.terminal_gradient(grid.tf, tuple(x[:, -1].tolist()), p)
    motion_at, control_at = (x[:, ::2], x[:, 1::2]), (u[:, ::2], u[:, 1::2])
    nodes, mids = blocks.backward(kernels, grid.nodes, lam_f, motion_at, control_at, p, problem.limits)
    lam = interleave(nodes, mids)
    law = kernels.control_law_batch(problem.times, x, lam, p, instance.control_set.arguments)
    gradient = kernels.stationarity_batch(problem.times, x, u, lam, p)
    return Sweep(motion, lam, law, gradient)


def unbounded_law(problem: SweepProblem, sweep: Sweep) -> Array:
    """Return the control that would minimise H without bounds, shape (m, 2N+1)."""
    bounds = problem.instance.control_set.without_bounds.arguments
    law: Array = problem.kernels.control_law_batch(
        problem.times, sweep.forward.x, sweep.lam, problem.instance.parameters, bounds
    )
    return law
