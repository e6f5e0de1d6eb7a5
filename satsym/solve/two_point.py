"""Given ends: collocation from a cold start, refined until the error estimate is small enough, within bounds."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count

import numpy as np

from satsym.instance import Instance
from satsym.solution import Array, Iteration, Progress, Solution
from satsym.solve import revolutions
from satsym.solve.collocation.cold_start import STAGES, Start, cold_start
from satsym.solve.collocation.continuation import Bounded, by_bound, tighten
from satsym.solve.collocation.durations import free_duration
from satsym.solve.collocation.problem import TwoPoint
from satsym.solve.collocation.refinement import Refined, refine
from satsym.solve.collocation.scaling import two_point
from satsym.solve.collocation.system import System
from satsym.solve.iteration import Limits
from satsym.solve.revolutions import TURN, Best
from satsym.status import Status


@dataclass(frozen=True, eq=False)
class Extremal:
    """What solving came to.

    Attributes
    ----------
    problem
        The two-point problem, with its bounds.
    refined
        The curve, with its error estimate.
    status, message
        Outcome.
    iterations
        Linear systems that were solved.
    """

    problem: TwoPoint
    refined: Refined
    status: Status
    message: str
    iterations: int


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by collocation.

    Parameters
    ----------
    instance
        With final states given, on the reference or free, and a final time that is given or free.
    progress
        Called after each step of the minimisation, and each phase.

    Returns
    -------
    Solution
        With status ``converged`` when the estimated error is within the instance's tolerance.
    """
    began = time.perf_counter()
    history: list[Iteration] = []
    inner = count()

    def watch(objective: float, residual: float) -> None:
        if progress:
            progress(Iteration(next(inner), objective, residual))

    limits = Limits(instance.solver.max_iterations or 500, began + instance.solver.max_seconds, watch)

    def report(objective: float, residual: float) -> None:
        history.append(Iteration(len(history), objective, residual))
        watch(objective, residual)

    with np.errstate(all="ignore"):
        best = revolutions.cheapest(
            instance, limits, lambda one, effort: _extremal(one, limits, report, effort), _objective
        )
    return _solution(instance, best, tuple(history), time.perf_counter() - began)


def _extremal(instance: Instance, limits: Limits, report: Callable[[float, float], None], effort: bool) -> Extremal:
    if instance.tf is not None:
        problem = two_point(instance, instance.tf - instance.t0)
        start, way = cold_start(problem, limits), ""
        if start.way == "none":
            return _nowhere(problem, start, limits)
    else:
        chosen = free_duration(instance, limits, effort)
        problem, start, way = chosen.problem.widened(0.0), chosen.start, f", {chosen.message}"
        if not chosen.status.answered:
            unknown = Refined(start.found.curve, float("inf"), False, 0)
            return Extremal(problem, unknown, chosen.status, chosen.message, start.steps)
    return _accurate(problem, start, way, limits, report)


def _accurate(
    problem: TwoPoint, start: Start, way: str, limits: Limits, report: Callable[[float, float], None]
) -> Extremal:
    """From an extremal of low order without bounds to an accurate one within them."""
    tolerance = problem.instance.solver.tolerance
    free = problem.widened(float("inf"))
    report(start.found.cost * problem.scale.cost, 1.0)
    refined = refine(free, start.found.curve, tolerance)
    report(_cost(free, refined), refined.error)
    steps = start.steps + refined.iterations
    bounded = tighten(problem, refined.curve, STAGES, limits)
    if bounded.iterations:
        steps += bounded.iterations
        if not bounded.converged:
            return _unfinished(problem, refined, _stuck(problem, bounded), steps, limits)
        refined = refine(problem, bounded.curve, tolerance, keep_nodes=True)
        steps += refined.iterations
        report(_cost(problem, refined), refined.error)
    if not refined.converged:
        message = f"the estimated error stays at {refined.error:.0e} on {len(refined.curve.mesh) - 1} intervals"
        return _unfinished(problem, refined, message, steps, limits)
    where = f"{len(refined.curve.mesh) - 1} intervals, from the {start.way}{way}"
    message = f"estimated error {refined.error:.0e} on {where}"
    return Extremal(problem, refined, Status.CONVERGED, message, steps)


def _nowhere(problem: TwoPoint, start: Start, limits: Limits) -> Extremal:
    refined = Refined(start.found.curve, float("inf"), False, 0)
    return _unfinished(problem, refined, f"no extremal found: {start.found.reason}", start.steps, limits)


def _unfinished(problem: TwoPoint, refined: Refined, message: str, steps: int, limits: Limits) -> Extremal:
    if limits.expired:
        return Extremal(problem, refined, Status.TIME_LIMIT, f"time was up: {message}", steps)
    return Extremal(problem, refined, Status.NOT_CONVERGED, message, steps)


def _stuck(problem: TwoPoint, bounded: Bounded) -> str:
    if bounded.reached < 1.0:
        return f"bounds could be brought in only {bounded.reached:.0%} of the way from where they do not bind"
    return "the times at which bounds are met do not settle"


def _objective(extremal: Extremal) -> float:
    """The cost, infinite where there is no answer."""
    return _cost(extremal.problem, extremal.refined) if extremal.status.answered else float("inf")


def _cost(problem: TwoPoint, refined: Refined) -> float:
    system = System(problem, refined.curve.mesh, refined.curve.order)
    return system.cost(refined.curve) * problem.scale.cost


def _solution(instance: Instance, best: Best[Extremal], history: tuple[Iteration, ...], wall_s: float) -> Solution:
    extremal = best.answer
    problem, curve = extremal.problem, extremal.refined.curve
    n, m = problem.states, len(instance.model.spec.controls)
    tau = np.unique(np.concatenate([np.linspace(0.0, 1.0, instance.solver.steps + 1), curve.mesh]))
    scaled = curve(tau)
    z = scaled * problem.scale.both
    for name, turns in best.turns.items():
        z[instance.model.spec.state_names.index(name)] += turns * TURN
    elapsed = problem.elapsed(curve.theta)
    status, message = extremal.status, "; ".join(part for part in (extremal.message, best.message) if part)
    if best.endless and instance.tf is None:
        costs = ", ".join(f"{value:.4g}" for value in best.endless)
        status, message = Status.NO_MINIMISER, f"more turns are always cheaper: the last three numbers cost {costs}"
    met = by_bound(problem, curve) if status.answered else []
    return Solution(
        instance=instance,
        method="collocation",
        status=status,
        message=message,
        objective=_objective(extremal) if status.answered else float("nan"),
        times=instance.t0 + elapsed * tau,
        x=z[:n],
        u=problem.control(tau, scaled, curve.theta),
        lam=z[n:],
        switching_times=tuple(_times(met, i, m, instance.t0, elapsed) for i in range(m)),
        iterations=extremal.iterations,
        history=history,
        wall_s=wall_s,
    )


def _times(met: list[Array], control: int, controls: int, t0: float, elapsed: float) -> tuple[float, ...]:
    """Switching times of a control; on a ball the bound is everyone's."""
    rows = met[control::controls] if len(met) > 1 else met
    return tuple(sorted(t0 + elapsed * float(tau) for row in rows for tau in row))
