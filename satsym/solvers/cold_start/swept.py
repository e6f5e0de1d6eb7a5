"""Extremals within bounds from a guessed control, by forward-backward sweeps followed by Newton's method.

If neither final state nor final time is constrained, every control has its costates, and a sweep can begin anywhere.
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
"""Number of steps of each sweep, and number of sweeps.

Only this number limits the sweeps, because the result must not depend on computing time.
"""

ROUGH = 1e-5
"""Residual at which sweeps end and Newton's method takes over."""


def loose(problem: TwoPoint) -> bool:
    """Return whether neither the final state nor the final time is constrained."""
    return not problem.fixed.any() and not problem.unknowns


def from_control(problem: TwoPoint, control: Mapping[str, Sequence[float]], limits: Limits) -> Curve | None:
    """Return the extremal within bounds to which sweeps lead from guessed controls; ``None`` if there is none.

    `control` contains equidistant values of each control by name.
    """
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
    """Return states and costates at M times, interpolated to a mesh as a curve."""
    at = stage_times(mesh, STAGES)
    nodes, stages = (np.array([np.interp(where, tau, row) for row in z]) for where in (mesh, at.ravel()))
    return Curve(mesh, nodes, stages.reshape(len(z), *at.shape), problem.theta)


def _starting_at(instance: Instance, control: Mapping[str, Sequence[float]]) -> Instance:
    """Return the instance with the options of a quick sweep that begins with a guessed control."""
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
