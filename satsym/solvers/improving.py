"""A solution with its certificate; where that knows a cheaper competitor, the solution to which this leads instead."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from satsym.instance import Guess, Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Progress, Solution
from satsym.solvers import iteration
from satsym.solvers.certificate.competitors.saddle import departures, fall
from satsym.solvers.certificate.end_limits import others_asked
from satsym.solvers.certificate.verdict import examined
from satsym.status import Status, Verdict

ROUNDS = 3
"""Cheaper competitors that are taken for the solution, one after the other."""

SWITCHED = "bang-bang"
"""A method whose extremals are not departed from, nor those of boundary arcs: descents of other problems keep neither
to controls that switch nor to path constraints."""

SAMPLES = 401
"""Values of a guess."""

Solver = Callable[[Instance, Progress | None], Solution]


def improved(solver: Solver, instance: Instance, progress: Progress | None) -> Solution:
    """Solve an instance, and again from each competitor that is cheaper than what was found.

    An instance with a guess of its own has the solution to which that leads: what is cheaper is only said.

    Parameters
    ----------
    instance
        What to solve.
    progress
        Called after each iteration.
    """
    began = time.perf_counter()
    deadline = iteration.deadline_of(instance)
    solution = solver(instance, progress)
    certificate, better = examined(solution, deadline)
    if better is not None and instance.guess:
        less = f"another extremal costs less, {better.objective:.10g}: leave out [guess] to obtain that extremal"
        message = f"{solution.message}; {less}"
        solution, better = replace(solution, message=message), None
    for seed in range(1, ROUNDS + 1):
        if better is None or others_asked(better) is not None:
            break
        message = f"{better.message}; the first extremal found costs {solution.objective:.6g}"
        own = solution.instance
        own = own if better.instance.met == own.met else own.meeting(better.instance.met)
        solution = replace(better, instance=_begun(own, better), message=message, history=solution.history)
        certificate, better = examined(solution, deadline, seed)
    if certificate is not None and certificate.verdict is Verdict.EXTREMAL_ONLY and solution.method != BOUNDARY_ARCS:
        endless = bottomless(solution)
        if endless is not None:
            return endless
        lower = None if instance.guess else _departed(solver, solution, progress, deadline)
        if lower is not None:
            solution, certificate = lower, examined(lower, deadline, ROUNDS + 1)[0]
    return replace(solution, certificate=certificate, wall_s=time.perf_counter() - began)


def goes_on(solution: Solution) -> bool:
    """Whether :func:`improved` looks for a lower cost than that of a solution whose certificate has no competitors."""
    certificate, lasting = solution.certificate, (BOUNDARY_ARCS, SWITCHED)
    extremal = certificate is not None and certificate.verdict is Verdict.EXTREMAL_ONLY
    return extremal and solution.method not in lasting


def bottomless(solution: Solution) -> Solution | None:
    """No answer, where what was found is stationary and other controls cost ever less; ``None`` where none shows."""
    constrained = solution.instance.model.spec.in_arcs  # of which descents know nothing
    endless = None if constrained or solution.method == SWITCHED else fall(solution)
    if endless is None:
        return None
    advice = "increase the weight of the control or of time, shorten the time, or bound the control"
    spec, within = solution.instance.model.spec, solution.instance.control_set
    if spec.control_set not in (None, "free") and not within.bounded:
        advice += "; the model provides for bounds of the control, but [control] gives none"
    return without_minimiser(solution, f"{endless.message}; {advice}")


def without_minimiser(solution: Solution, message: str) -> Solution:
    """No answer in place of a solution, because there is always a cheaper one."""
    x, u, lam = (np.full_like(row, np.nan) for row in (solution.x, solution.u, solution.lam))
    return replace(
        solution,
        status=Status.NO_MINIMISER,
        message=message,
        objective=float("nan"),
        x=x,
        u=u,
        lam=lam,
        switching_times=tuple(() for _ in solution.switching_times),
        certificate=None,
    )


def starting_from(solution: Solution) -> Instance:
    """The instance of a solution with its states and costates as the guess, resampled evenly."""
    instance, names = solution.instance, solution.instance.model.spec.state_names
    times = np.linspace(float(solution.times[0]), float(solution.times[-1]), SAMPLES)
    rows = [tuple(np.interp(times, solution.times, row).tolist()) for row in (*solution.x, *solution.lam)]
    n = len(names)
    start = Guess(dict(zip(names, rows[:n], strict=True)), dict(zip(names, rows[n:], strict=True)))
    return replace(instance, guess=start)


def _begun(instance: Instance, better: Solution) -> Instance:
    """An instance with what another solution chose of what is free at the start and among the parameters."""
    for unknown in instance.free:
        instance = unknown.at(instance, unknown.of(better.instance))
    return instance


def _departed(solver: Solver, solution: Solution, progress: Progress | None, deadline: float) -> Solution | None:
    """What a saddle's descents lead to; ``None`` where that is not cheaper."""
    if solution.method == SWITCHED or solution.instance.model.spec.in_arcs:
        return None
    for start in departures(solution):
        found = _again(replace(solution.instance, guess=start), solver, solution, progress, deadline)
        if found is not None:
            return found
    return None


def _again(
    start: Instance, solver: Solver, solution: Solution, progress: Progress | None, deadline: float
) -> Solution | None:
    """The solution to which an instance with a guess leads; ``None`` where it is not cheaper, or time is up."""
    instance, begun = solution.instance, iteration.hurried(start, deadline)
    if begun is None:
        return None
    found = solver(begun, progress)
    if not found.status.answered or not found.objective < solution.objective:
        return None
    message = f"{found.message}; the first extremal found costs {solution.objective:.6g}"
    return replace(
        found, instance=_begun(instance, found), message=message, iterations=found.iterations + solution.iterations
    )
