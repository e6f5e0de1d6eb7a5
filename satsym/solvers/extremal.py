"""Common parts of the methods for given ends: limits, history, and the conversion of an extremal into a solution."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np

from satsym.arrays import Array, distinct
from satsym.control_set import ControlSet
from satsym.instance import Instance
from satsym.solution import Event, Iteration, Progress, Solution
from satsym.solvers.collocation.accuracy.jumping import found
from satsym.solvers.collocation.continuation import by_bound
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import Scale, TwoPoint
from satsym.solvers.control.slopes import continued
from satsym.solvers.failures import FAILURES
from satsym.solvers.iteration import Limits, watched
from satsym.status import Status

BESIDE = 1e-9
"""Distance of nodes from a jump on both sides, relative to the duration."""

Method = Callable[[Instance, Limits], Extremal]
"""Function from an instance and limits to an extremal."""


def without_numbers(instance: Instance, error: Exception) -> Extremal:
    """Return no extremal, because the computation failed numerically."""
    return nothing(instance, Status.NON_FINITE, f"an arithmetic operation failed ({error})")


def nothing(instance: Instance, status: Status, message: str) -> Extremal:
    """Return no extremal, and no trajectory either."""
    n, duration = len(instance.initial), 1.0 if instance.tf is None else instance.tf - instance.t0
    problem = TwoPoint(instance, (0.0,) * 3 * n, duration, Scale(np.ones(n), 1.0))
    empty = np.full((2 * n, 2), np.nan)
    path = Curve(np.array([0.0, 1.0]), empty, empty[:, :1, None], problem.theta)
    return Extremal(problem, path, float("inf"), status, message, 0)


def solved(instance: Instance, progress: Progress | None, name: str, method: Method) -> Solution:
    """Solve an instance by a method.

    Parameters
    ----------
    instance
        Instance with final states given, on the reference or free, and a given or free final time.
    progress
        Function that is called after each step of the method, and each phase.
    method
        Function that finds an extremal; numerical warnings are switched off for it.
    """
    began = time.perf_counter()
    limits, history = watched(instance, progress)

    with np.errstate(all="ignore"):
        try:
            extremal = method(instance, limits)
        except FAILURES as error:
            extremal = without_numbers(instance, error)
        return _solution(instance, name, extremal, tuple(history), limits, began)


def _solution(
    instance: Instance,
    method: str,
    extremal: Extremal,
    history: tuple[Iteration, ...],
    limits: Limits,
    began: float,
) -> Solution:
    problem, path = extremal.problem, extremal.path
    n, m = problem.states, len(instance.model.spec.controls)
    tau = distinct(np.concatenate([np.linspace(0.0, 1.0, instance.solver.steps + 1), path.mesh]))
    jumped = found(problem, path) if extremal.status.answered else []
    for jump in jumped:
        tau = np.append(tau[np.abs(tau - jump.time) > 2.0 * BESIDE], [jump.time - BESIDE, jump.time + BESIDE])
    tau.sort()
    scaled = limits.in_blocks(path, tau)
    z = scaled * problem.scale.both
    elapsed = problem.elapsed(path.theta)
    status = extremal.status
    u = problem.control(tau, scaled, path.theta)
    if instance.model.spec.directional:
        u = continued(instance, instance.t0 + elapsed * tau, z[:n], z[n:], u)
    if not status.answered and not (extremal.obeys):
        z, u = np.full_like(z, np.nan), np.full_like(u, np.nan)  # what was tried on the way is no answer
        elapsed = float("nan") if instance.tf is None else elapsed
    met = by_bound(problem, path) if status.answered else []
    return Solution(
        instance=instance,
        method=method,
        status=status,
        message=extremal.message,
        objective=extremal.cost if status.answered else float("nan"),
        times=instance.t0 + elapsed * tau,
        x=z[:n],
        u=u,
        lam=z[n:],
        switching_times=tuple(_times(_own(met, i, instance.control_set), instance.t0, elapsed) for i in range(m)),
        iterations=extremal.iterations,
        history=history,
        wall_s=time.perf_counter() - began,
        events=tuple(
            Event("jump", name, instance.t0 + elapsed * jump.time)
            for jump in jumped
            for name, before, after in zip(instance.model.spec.control_names, jump.before, jump.after, strict=True)
            if before != after
        ),
    )


def _own(met: list[Array], control: int, within: ControlSet) -> list[Array]:
    """Return the times at which the bounds of one control are met, from the times for all bounds.

    The bound of a norm is a bound of all controls of the vector.
    """
    if within.parts:
        return [row for row, places in zip(met, within.limited, strict=False) if control in places]
    return met[control :: len(within.lower)] if within.kind == "box" else met


def _times(rows: list[Array], t0: float, elapsed: float) -> tuple[float, ...]:
    """Return switching times in the model's unit, in ascending order."""
    return tuple(sorted(t0 + elapsed * float(tau) for row in rows for tau in row))
