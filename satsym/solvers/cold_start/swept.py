"""From a control that is guessed, swept until it settles, to the extremal within the bounds.

Where nothing is asked of the end, costates belong to every control, and a sweep begins wherever one likes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import msgspec
import numpy as np

from satsym.arrays import Array
from satsym.instance import Guess, Instance
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.continuation import corners, settled, through
from satsym.solvers.collocation.curve import Curve, stage_times
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.iteration import Limits
from satsym.solvers.sweep import solving as forward_backward

STEPS, SWEEPS = 200, 60
"""Steps of each sweep, and the number of sweeps, which alone limits it: what is found must not depend on the clock."""

ROUGH = 1e-5
"""Residual at which sweeps end: Newton's method goes on from there."""


def loose(problem: TwoPoint) -> bool:
    """Whether nothing is asked of the end, nor of the final time."""
    return not problem.fixed.any() and not problem.unknowns


def from_control(problem: TwoPoint, control: Mapping[str, Sequence[float]], limits: Limits) -> Curve | None:
    """The extremal within the bounds to which sweeps lead from controls by name, evenly spaced values of each."""
    limits.spend(SWEEPS * STEPS)
    found = forward_backward.solve(_starting_at(problem.instance, control))
    if not (np.isfinite(found.x).all() and np.isfinite(found.lam).all()):
        return None
    z = np.concatenate([found.x, found.lam]) / problem.scale.both
    tau = (found.times - found.times[0]) / (found.times[-1] - found.times[0])
    curve = on_mesh(problem, tau, z, meshes.along(problem, tau, z[: problem.states], problem.theta))
    curve = on_mesh(problem, tau, z, through(corners(problem, curve), len(curve.mesh) - 1))
    bounded = settled(problem, curve, STAGES, len(curve.mesh) - 1, limits)
    return bounded.curve if bounded.solved and bounded.curve.in_domain(problem.positive) else None


def on_mesh(problem: TwoPoint, tau: Array, z: Array, mesh: Array) -> Curve:
    """States and costates at times (M,) on a mesh."""
    at = stage_times(mesh, STAGES)
    nodes, stages = (np.array([np.interp(where, tau, row) for row in z]) for where in (mesh, at.ravel()))
    return Curve(mesh, nodes, stages.reshape(len(z), *at.shape), problem.theta)


def _starting_at(instance: Instance, control: Mapping[str, Sequence[float]]) -> Instance:
    """The instance for a quick sweep that begins with a control."""
    options = msgspec.structs.replace(
        instance.solver,
        steps=STEPS,
        max_iterations=SWEEPS,
        max_seconds=float("inf"),
        tolerance=ROUGH,
        relaxation=None,
        backend="python",
    )
    start = Guess(control={name: tuple(values) for name, values in control.items()})
    return replace(instance, solver=options, guess=start)
