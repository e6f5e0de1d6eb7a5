"""Conversion of the results of switching problems into solutions."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Iteration, Solution
from satsym.solvers import iteration
from satsym.solvers.switching.attempt import Exact
from satsym.solvers.switching.cold_start.homotopy import Stopped
from satsym.solvers.switching.throttled import by_control
from satsym.status import Status


def answered(instance: Instance, exact: Exact, history: tuple[Iteration, ...], began: float) -> Solution:
    """Return exact arcs as a solution."""
    at, structure, trajectory = exact.refined.at, exact.refined.structure, exact.trajectory
    nodes = np.linspace(instance.t0, at.end, instance.solver.steps + 1)
    times, z, u = trajectory.grid(nodes)
    n = len(instance.initial)
    status = Status.CONVERGED if instance.model.in_domain(z[:n]) else Status.LEFT_DOMAIN
    plural = "" if structure.switches == 1 else "es"
    message = (
        f"structure {structure.name}, {structure.switches} switch{plural}, residual {exact.refined.residual:.0e}, "
        f"from {exact.origin.value.format(exact.smoothing)}"
    )
    return Solution(
        instance=instance,
        method="bang-bang",
        status=status,
        message=message,
        objective=trajectory.cost(instance),
        times=times,
        x=z[:n],
        u=u,
        lam=z[n:],
        switching_times=by_control(instance, [tuple(own.tolist()) for own in structure.by_control(at.times)]),
        iterations=exact.iterations,
        history=history,
        wall_s=time.perf_counter() - began,
    )


def without(instance: Instance, stopped: Stopped, history: tuple[Iteration, ...], began: float) -> Solution:
    """Return a solution without an answer, with the reason of the failure."""
    nothing = iteration.unsolved(instance, "bang-bang", time.perf_counter() - began)
    message, done = stopped.message, len(history)
    return replace(nothing, status=stopped.status, message=message, iterations=done, history=history)
