"""Simulation: the motion of an instance from its initial state, as accurate as its tolerance asks."""

from __future__ import annotations

import numpy as np

from satsym.grid import Grid
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.solution import Array, Flight, Invariant
from satsym.solve import control_set
from satsym.status import BadInput, Status

FEEDBACKS = ("none",)
"""Control laws that a simulation can follow."""

ORDER = 4
MARGIN = 0.1
"""Share of the tolerance that the estimated error may take: estimates can be low."""

MOST_STEPS = 2**20


def simulate(instance: Instance, feedback: str = "none") -> Flight:
    """Integrate the motion with RK4, halving the step until two runs agree.

    Parameters
    ----------
    instance
        With a given final time.
    feedback
        ``"none"``: no control, or the admissible one next to it.

    Returns
    -------
    Flight
        At the instance's number of steps; ``metrics`` has the steps that were needed and the estimated
        error (Richardson), relative to the size of each state.

    Raises
    ------
    BadInput
        If the final time is free, or there is no such feedback.
    """
    if feedback not in FEEDBACKS:
        raise BadInput(f"--feedback {feedback}: unknown; this model has {', '.join(FEEDBACKS)}")
    if instance.tf is None:
        raise BadInput(f"{instance.name}: time.tf: a simulation needs a number, not a free final time")
    coarse_steps = instance.solver.steps
    kernels = instance.model
    x = _fly(instance, kernels, coarse_steps)
    steps, error = coarse_steps, float("nan")
    while np.isfinite(x).all() and 2 * steps <= MOST_STEPS:
        finer = _fly(instance, kernels, 2 * steps)
        error = _difference(x, finer[:, ::2]) / (2**ORDER - 1)
        steps, x = 2 * steps, finer
        if error <= MARGIN * instance.solver.tolerance or not np.isfinite(error):
            break
    x = x[:, :: steps // coarse_steps]
    times = Grid.uniform(instance.t0, instance.tf, coarse_steps).nodes
    status = _status(instance, x, error)
    u = np.repeat(_control(instance), len(times), axis=1)
    return Flight(
        instance=instance,
        feedback=feedback,
        status=status,
        message=_message(status, error),
        times=times,
        x=x,
        u=u,
        invariants=_invariants(instance, times, x) if not u.any() else {},
        metrics=_metrics(instance, x) | {"steps": float(steps), "estimated_error": error},
    )


def _control(instance: Instance) -> Array:
    """No control, or the admissible one next to it; shape (m, 1)."""
    return control_set.project(instance, np.zeros((len(instance.model.spec.controls), 1)))


def _fly(instance: Instance, kernels: Kernels, steps: int) -> Array:
    assert instance.tf is not None
    grid = Grid.uniform(instance.t0, instance.tf, steps)
    u = np.repeat(_control(instance), steps + 1, axis=1)
    x, _, _ = kernels.forward(grid.nodes, instance.initial, u, u[:, 1:], instance.parameters)
    return x


def _difference(coarse: Array, fine: Array) -> float:
    """Largest difference of each state, relative to its size."""
    size = np.maximum(np.abs(fine).max(axis=1, keepdims=True), np.finfo(float).tiny)
    return float((np.abs(coarse - fine) / size).max())


def _status(instance: Instance, x: Array, error: float) -> Status:
    if not np.isfinite(x).all():
        return Status.NON_FINITE
    if not instance.model.in_domain(x):
        return Status.LEFT_DOMAIN
    return Status.CONVERGED if error <= instance.solver.tolerance else Status.NOT_CONVERGED


def _message(status: Status, error: float) -> str:
    if status is Status.CONVERGED:
        return f"two runs, one with half the steps, agree to {error:.0e}"
    if status is Status.NOT_CONVERGED:
        return (
            f"even {MOST_STEPS} steps leave an estimated error of {error:.0e}: the motion comes close to a singularity"
        )
    return f"the motion is not finite: {status.advice}" if status is Status.NON_FINITE else status.advice


def _invariants(instance: Instance, times: Array, x: Array) -> dict[str, Invariant]:
    spec = instance.model.spec
    if not spec.invariants or not np.isfinite(x).all():
        return {}
    values = instance.model.invariants_batch(times, x, instance.parameters)
    return {
        v.symbol: Invariant(float(row[0]), float(np.abs(row - row[0]).max()))
        for v, row in zip(spec.invariants, values, strict=True)
    }


def _metrics(instance: Instance, x: Array) -> dict[str, float]:
    """Extremes of each state, and how far from the reference the motion ends."""
    spec = instance.model.spec
    found: dict[str, float] = {}
    for name, row in zip(spec.state_names, x, strict=True):
        found |= {f"{name}_min": float(row.min()), f"{name}_max": float(row.max())}
    if spec.has_reference:
        curve = instance.model.reference(instance.tf, instance.parameters)
        found |= {f"{name}_error": float(row[-1] - c) for name, row, c in zip(spec.state_names, x, curve, strict=True)}
    return found
