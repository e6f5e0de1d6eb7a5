"""Newton's method with the control law itself, from states and costates that are nearly an extremal."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.swept import on_mesh
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.accuracy.jumping import found, located
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.continuation import settled
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.system import System
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits

MESHES = (30, 60, 120)
"""Numbers of intervals of the meshes that are tried."""

SAMPLES = 401
"""Number of values at which a guess is sampled."""


def by_newton(problem: TwoPoint, z: Array) -> Attempt | None:
    """Return the extremal near a guess, with nodes at jumps of its control; ``None`` if none is found in the domain.

    Parameters
    ----------
    problem
        The two-point problem, with its duration.
    z
        Scaled states and costates at equidistant times, shape (2n, M).
    """
    tau = np.linspace(0.0, 1.0, z.shape[1])
    for intervals in MESHES:
        mesh = np.linspace(0.0, 1.0, intervals + 1)
        curve = on_mesh(problem, tau, z, mesh)
        if found(problem, curve):
            outcome = located(problem, curve, STAGES, intervals)
        else:
            outcome = newton(System(problem, mesh, STAGES), curve, most=40)
        if outcome is not None and outcome.solved and outcome.curve.in_domain(problem.positive):
            cost = System(problem, outcome.curve.mesh, STAGES).cost(outcome.curve)
            return Attempt(outcome.curve, Reason.MINIMUM, outcome.iterations, cost)
    return None


def _settled(problem: TwoPoint, z: Array, limits: Limits) -> Attempt | None:
    """Return the extremal with nodes at the times when bounds are met; ``None`` if it is not found."""
    tau = np.linspace(0.0, 1.0, z.shape[1])
    curve = on_mesh(problem, tau, z, meshes.along(problem, tau, z[: problem.states], problem.theta))
    found = tried(lambda: settled(problem, curve, STAGES, max(len(curve.mesh) - 1, MESHES[0]), limits))
    if found is None or not found.solved or not found.curve.in_domain(problem.positive):
        return None
    return replace(found, cost=System(problem, found.curve.mesh, found.curve.order).cost(found.curve))


def from_guess(instance: Instance, limits: Limits) -> tuple[TwoPoint, Start] | None:
    """Return the problem and the extremal near a complete guess of states and costates; ``None`` if there is none."""
    names, guess = instance.model.spec.state_names, instance.guess
    end = instance.tf_guess if instance.tf is None else instance.tf
    if end is None or not all(name in guess.state and name in guess.costate for name in names):
        return None
    problem = two_point(instance, end - instance.t0)
    even, both = np.linspace(0.0, 1.0, SAMPLES), (guess.state, guess.costate)
    z = np.array([paths.series(table[name], even) for table in both for name in names]) / problem.scale.both
    found = _settled(problem, z, limits) if problem.control_set.bounded else None
    found = found or by_newton(problem, z)
    return None if found is None else (problem, Start(found, Origin.GUESS, found.iterations, bounded=True))
