"""From a cold start to exact arcs at bounds, singular ones, and arcs on the boundaries of path constraints."""

from __future__ import annotations

import time
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.instance import Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Event, Progress, Solution
from satsym.solvers.constrained.levels.recognition import BRIEF, recognised
from satsym.solvers.constrained.regularised.interior_point import Path
from satsym.solvers.constrained.regularised.search import searched
from satsym.solvers.constrained.regularised.starts import drawn, first, straight
from satsym.solvers.constrained.regularised.transcription import Program
from satsym.solvers.constrained.violation import VIOLATED, violation
from satsym.solvers.iteration import Limits, deadline_of, history_of, watched
from satsym.solvers.switching import solving
from satsym.solvers.switching.answers import answered, without
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.homotopy import Stopped
from satsym.solvers.switching.structure import BOUNDARY, constraint_of
from satsym.status import Status

INTERVALS = (100, 250, 500)
"""Of the regularised path: of more where no structure that it shows is an extremal."""

DRAWN, WORK = 2, 20_000
"""Pairs of paths that are drawn by the solver, and columns for one of the certificate's."""

LONGER = 5
"""Intervals up to which a singular arc between bounds may as well be none."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve a switching problem with path constraints.

    Parameters
    ----------
    instance
        Of a model whose controls enter the Hamiltonian linearly, with both bounds for each.
    progress
        Called while the problem without constraints is solved.

    Returns
    -------
    Solution
        As :func:`satsym.solvers.switching.solving.solve` returns it; where no constraint is ever met, that one's.

    Raises
    ------
    BadInput
        If a bound is missing, or a constraint is violated where the motion is to start or to end.
    """
    began, until = time.perf_counter(), deadline_of(instance)
    relaxed = solving.solve(instance, progress)
    if relaxed.status.answered and violation(relaxed) <= VIOLATED:
        return replace(relaxed, message=f"{relaxed.message}; no path constraint is ever active")
    if relaxed.status is Status.INFEASIBLE:
        return replace(relaxed, method=BOUNDARY_ARCS)
    limits = replace(watched(instance, None)[0], deadline=until)
    with np.errstate(all="ignore"):
        found = _best(instance, relaxed, limits)
        if isinstance(found, Stopped):
            return replace(without(instance, found, relaxed.history, began), method=BOUNDARY_ARCS)
        last = found.trajectory.cost(instance), found.refined.residual
        history = history_of((*found.passed, last))
        return _with_events(instance, found, answered(instance, found, history, began))


def others(solution: Solution, seed: int, deadline: float) -> tuple[int, list[float], bool]:
    """How many paths were tried, costs of the extremals they led to, and whether time was up before all of them.

    Parameters
    ----------
    solution
        About which paths are drawn, and about the straight line.
    seed
        Of the paths.
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`.
    """
    instance = replace(solution.instance, tf_guess=float(solution.times[-1]))  # paths last as long as the solution does
    program, limits = Program(instance, INTERVALS[0]), replace(watched(instance, None)[0], deadline=deadline)
    starts = [one for about in (straight(program), first(program, solution)) for one in drawn(program, about, 1, seed)]
    with np.errstate(all="ignore"):
        found = list(
            searched(program, starts, solution.objective, replace(limits, work=WORK), partial(_exact, program))
        )
    return len(found), [one.trajectory.cost(instance) for one in found if one], limits.late


def _best(instance: Instance, relaxed: Solution, limits: Limits) -> Exact | Stopped:
    """The cheapest extremal to which regularised paths lead."""
    worth = relaxed.objective if relaxed.status.answered and relaxed.objective else 1.0
    for intervals in INTERVALS:
        program = Program(instance, intervals)
        begun = first(program, relaxed)
        starts = [begun, *drawn(program, begun, DRAWN, 0)]
        found = [one for one in searched(program, starts, worth, limits, partial(_exact, program), begun) if one]
        if found:
            return min(found, key=lambda one: one.trajectory.cost(instance))
        if limits.late:
            return Stopped(Status.TIME_LIMIT, "time was up before an extremal was found")
    message = "no structure of bounds, singular arcs and boundaries that a regularised path shows is an extremal"
    return Stopped(Status.NOT_CONVERGED, message)


def _exact(program: Program, path: Path, limits: Limits) -> Exact | None:
    """The first extremal among structures that a regularised path shows."""
    for shortest in (BRIEF, LONGER) if path.solved else ():
        own, history = watched(program.instance, None)
        guess = recognised(program, path, shortest)
        found = attempt(program.instance, guess, replace(limits, watch=own.watch))
        if found:
            passed = (*path.passed, *((one.objective, one.residual) for one in history))
            return replace(found, origin=Origin.PATH, passed=passed)
    return None


def _with_events(instance: Instance, exact: Exact, solution: Solution) -> Solution:
    """With entries to boundaries and exits from them."""
    names, events = [one.name for one in instance.model.spec.path_constraints], list[Event]()
    structure, at = exact.refined.structure, exact.refined.at
    for row, own in zip(structure.levels, structure.by_control(at.times), strict=True):
        begins, ends = [instance.t0, *own.tolist()], [*own.tolist(), at.end]
        for level, begin, end in zip(row, begins, ends, strict=True):
            if level >= BOUNDARY:
                name = names[constraint_of(level)]
                events += [Event("entry", name, begin)]
                events += [Event("exit", name, end)] if end < at.end else []
    return replace(solution, method=BOUNDARY_ARCS, events=tuple(sorted(events, key=lambda one: one.t)))
