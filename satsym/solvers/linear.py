"""Linear problems in closed form: canonical equations and end conditions that are linear in states and costates.

With the state transition matrices of the Hamiltonian system, all conditions together are one linear system (Bryson and
Ho, Applied Optimal Control, 5.3). For an autonomous system these are matrix exponentials; with explicit time they are
integrated from the variational equations. Several successive arcs prevent growing modes from dominating others.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.collocation.continuation import kept
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.extremal import solved
from satsym.solvers.iteration import Limits
from satsym.solvers.shooting.arcs import MOST_STEPS, Arcs, sufficient
from satsym.solvers.shooting.newton import doubled, linearised, residual
from satsym.solvers.switching.linear.linear_motion import exponential
from satsym.solvers.two_point import unfinished
from satsym.status import BadInput, Status
from satsym.wording import counted

PLACES = 8
"""Number of times at which derivatives are compared, at two random points each."""

EQUAL_DERIVATIVES = 1e-9
"""Relative difference of derivatives that counts as rounding."""

TURN = 2.0
"""Largest growth or rotation of the fastest mode on one arc, as an exponent or in rad."""

MOST_ARCS = 2000
GAUSS = 16
"""Number of Gauss points of the running cost on each arc; the remaining error is below rounding."""

ACCURACY = 1e-11
"""Error of integrated arcs, with half of the steps that are used for the answer."""

CONTRADICTED = 1e-6
"""Remaining violation of the conditions, in scaled variables, above which they count as contradictory."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve a linear instance.

    Parameters
    ----------
    instance
        Instance with a given final time, final states given, on the reference or free, and inactive bounds.

    Raises
    ------
    BadInput
        If the instance is not linear, with the reason.
    """
    return solved(instance, progress, "linear", _extremal)


@dataclass(frozen=True, eq=False)
class Exponential(Arcs):
    """Arcs of an autonomous linear system, by matrix exponentials."""

    def variations(self) -> tuple[Array, Array]:
        """Return the ends of the arcs, and their derivatives by the beginnings."""
        flows = self.flows(np.diff(self.mesh))
        ends = flows[:, :-1, :-1] @ self.nodes.T[:-1, :, None] + flows[:, :-1, -1:]
        return ends[:, :, 0].T, flows[:, :-1, :-1]

    def ends(self) -> Array:
        """Return the ends of the arcs."""
        return self.variations()[0]

    def __call__(self, tau: Array) -> Array:
        """Return states and costates at times in [0, 1]."""
        arc = np.clip(np.searchsorted(self.mesh, tau, side="right") - 1, 0, len(self.mesh) - 2)
        flows = self.flows(tau - self.mesh[arc])
        values: Array = (flows[:, :-1, :-1] @ self.nodes.T[arc, :, None] + flows[:, :-1, -1:])[:, :, 0].T
        return values

    def cost(self) -> float:
        """Return the cost of the motion, by Gauss quadrature."""
        points, weights = np.polynomial.legendre.leggauss(GAUSS)
        widths = np.diff(self.mesh)[:, None]
        tau = (self.mesh[:-1, None] + widths * (points + 1.0) / 2.0).ravel()
        running = self.problem.running_cost(tau, self(tau), self.theta)
        integral = float(running @ (widths * weights / 2.0).ravel())
        return self.problem.elapsed(self.theta) * integral + self.terminal_cost

    @cached_property
    def _generator(self) -> Array:
        """Generator of the motion with respect to tau, with the driving term as last column, shape (2n + 1, 2n + 1)."""
        here, tau = np.append(self.problem.initial, np.zeros(self.problem.states))[:, None], np.zeros(1)
        slopes = self.problem.jacobian(tau, here, self.theta)[:, :, 0]
        driven = self.problem.rates(tau, here, self.theta) - slopes @ here
        found = np.zeros((len(slopes) + 1, len(slopes) + 1))
        found[:-1] = np.append(slopes, driven, axis=1) * self.problem.elapsed(self.theta)
        return found

    def flows(self, widths: Array) -> Array:
        """Return state transition matrices over given fractions of the duration, shape (M, 2n + 1, 2n + 1)."""
        turned = self._generator * widths[:, None, None]
        return exponential(turned) if np.isfinite(turned).all() else np.full_like(turned, np.nan)


def _extremal(instance: Instance, limits: Limits) -> Extremal:
    if instance.tf is None:
        raise _refusal(instance, "its final time is free")
    problem = two_point(instance, instance.tf - instance.t0)
    free = problem.relaxed(float("inf"))
    arcs = _arcs(free)
    if not is_linear(free):
        return Extremal(problem, arcs, float("inf"), Status.NON_FINITE, "the canonical equations are not finite", 0)
    try:
        matching, wrong = linearised(arcs)
        arcs = arcs.moved(*matching.correction(wrong.defects, wrong.start, wrong.finish), 1.0)
        arcs, error = doubled(arcs, matching)
    except np.linalg.LinAlgError:
        error = float("nan")
    if not (error <= instance.solver.tolerance and _violation(arcs) <= CONTRADICTED):
        message = (
            "the conditions contradict each other or leave costates undetermined: it might be impossible to reach "
            "the final state"
        )
        return unfinished(problem, arcs, message, 1, limits)
    if not kept(problem, arcs):
        raise _refusal(instance, "the bounds of its control are active")
    cost = arcs.cost() * problem.scale.cost
    limits.tell(cost, error)
    kind = "matrix exponentials" if isinstance(arcs, Exponential) else "variational equations"
    message = f"closed form by {kind} on {counted(len(arcs.widths), 'arc')}, estimated error {error:.0e}"
    return Extremal(problem, arcs, cost, Status.CONVERGED, message, 1)


def is_linear(problem: TwoPoint) -> bool:
    """Return whether derivatives are finite; refuse an instance whose derivatives vary between random points."""
    n, names, rng = problem.states, problem.instance.model.spec.state_names, np.random.default_rng(0)
    tau, places = np.linspace(0.0, 1.0, PLACES), rng.standard_normal((2, 2 * n, PLACES))
    places[:, list(problem.positive)] = np.abs(places[:, list(problem.positive)])
    here, there = (problem.jacobian(tau, place, problem.theta) for place in places)
    if not np.isfinite(here).all() or not np.isfinite(there).all():
        return False
    differs = ~(np.abs(here - there) <= EQUAL_DERIVATIVES * np.abs(here).max()).all(axis=2)
    if differs.any():
        row, column = np.argwhere(differs)[0]
        symbols = [*names, *(f"the costate of {name}" for name in names)]
        raise _refusal(problem.instance, f"the rate of {symbols[row]} is not linear in {symbols[column]}")
    extra = rng.standard_normal((2, problem.unknowns))
    ends = [problem.boundary_slopes(place[:, -1], theta) for place, theta in zip(places, extra, strict=True)]
    if not all(np.allclose(a, b, EQUAL_DERIVATIVES, EQUAL_DERIVATIVES) for a, b in zip(*ends, strict=True)):
        raise _refusal(problem.instance, "its terminal cost is not quadratic, or a terminal constraint is not linear")
    return True


def _arcs(problem: TwoPoint) -> Arcs:
    """Return arcs so short that no mode grows or rotates much on an arc, with preliminary values."""
    n, theta = problem.states, problem.theta
    tau = np.linspace(0.0, 1.0, PLACES)
    slopes = problem.jacobian(tau, np.ones((2 * n, PLACES)), theta).transpose(2, 0, 1)
    fastest = float(np.abs(np.linalg.eigvals(np.nan_to_num(slopes))).max()) * problem.duration
    mesh = np.linspace(0.0, 1.0, int(np.clip(np.ceil(fastest / TURN), 1, MOST_ARCS)) + 1)
    nodes = np.ones((2 * n, len(mesh)))
    if problem.instance.model.spec.autonomous:
        return Exponential(problem, mesh, nodes, theta)
    arcs = Arcs(problem, mesh, nodes, theta)
    return sufficient(arcs, ACCURACY) or arcs.with_steps(MOST_STEPS)


def _violation(arcs: Arcs) -> float:
    """Return the largest violation of continuity, initial and final conditions."""
    wrong = residual(arcs, arcs.ends())
    return float(max(np.abs(part).max() for part in (wrong.defects, wrong.start, wrong.finish)))


def _refusal(instance: Instance, reason: str) -> BadInput:
    return BadInput(
        f"{instance.called}: solver.method: {instance.model.spec.name} is not linear: {reason}; use method "
        '"collocation"'
    )
