"""Methods that combine the direct search with other solvers, depending on the model.

The search is also used if another solver finds nothing, and to look for cheaper solutions than that of another solver.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.certificate.verdict import examined
from satsym.solvers.constrained.refusals import refuse
from satsym.solvers.constrained.revision import SLACK
from satsym.solvers.constrained.violation import violation
from satsym.solvers.iteration import MOST_ITERATIONS, Limits, deadline_of, hurried, unsolved, watched
from satsym.solvers.search import failing, solving
from satsym.solvers.search.reading import collocated
from satsym.solvers.search.reading.boundaries import UNMET
from satsym.status import Status, Verdict

Solver = Callable[[Instance, Progress | None], Solution]

RELAXED = 20_000
"""Maximum number of points at which equations may be linearised for the extremal without path constraints."""

COMPARED = 2_000_000
"""Maximum work of a search for a cheaper answer, in unknowns times iterations."""

LITTLE = 200_000
"""Work limit of an instance, in linearised points, below which a free final time is not left to the search."""

CHEAPER = 1e-6
"""Relative difference of costs above which a cheaper solution is taken."""


def bang_bang(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance whose controls, or norms of vectors, switch between their bounds.

    Parameters
    ----------
    instance
        Instance of a model with such controls.
    progress
        Called after each iteration.
    """
    if instance.model.spec.throttled:
        return solving.solve(instance, progress)
    from satsym.solvers.switching import solving as switching

    return switching.solve(instance, progress, switching.Search(solving.exact_arcs, solving.course, failing.why))


def collocation(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by collocation, from a straight line or a guess, else from what the search finds.

    Parameters
    ----------
    instance, progress
        See :func:`satsym.solvers.two_point.solve`.
    """
    from satsym.solvers import two_point

    return _with_search(two_point.solve, instance, progress)


def shooting(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by multiple shooting, from a straight line or a guess, else from what the search finds.

    Parameters
    ----------
    instance, progress
        See :func:`satsym.solvers.shooting.solving.solve`.
    """
    from satsym.solvers.shooting import solving as by_shooting

    found = _with_search(by_shooting.solve, instance, progress)
    if found.method == "shooting" or not found.status.answered:
        return replace(found, method="shooting")
    known = collocated.guessing(instance, found.times, found.x, found.lam)
    return replace(by_shooting.solve(known, progress), instance=instance)


def boundary_arcs(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance with path constraints or waypoints by extremals in arcs.

    If the extremal without path constraints is found quickly and satisfies them, it is the answer.

    Parameters
    ----------
    instance
        Instance of a model with path constraints or waypoints.
    progress
        Called after each iteration.

    Raises
    ------
    BadInput
        If a path constraint is violated at the given initial or final state.
    """
    spec = instance.model.spec
    if spec.path_constraints:
        refuse(instance)
    if not (spec.interior or spec.switching):
        from satsym.solvers import two_point

        relaxed = two_point.solve(replace(instance, work=RELAXED), progress)
        if relaxed.status.answered and violation(relaxed) <= SLACK:
            return replace(relaxed, instance=instance, message=f"{relaxed.message}; {UNMET}")
    return solving.solve(instance, progress)


def _with_search(solver: Solver, instance: Instance, progress: Progress | None) -> Solution:
    """Solve an instance from a straight line or a guess, otherwise by the search, unless little work is allowed.

    If the final time is free there is no straight line, and only the search is left.

    If the search has no answer either, an extremal that is not accurate enough is returned.
    """
    began, deadline = time.perf_counter(), deadline_of(instance)
    found = solver(instance, progress)
    little = instance.work < (LITTLE if instance.tf is None else math.inf)
    if found.status is not Status.NOT_CONVERGED or little:
        return found
    left = hurried(instance, deadline)
    if left is None:
        late = "the time limit was reached before an extremal was found"
        return replace(found, status=Status.TIME_LIMIT, message=late)
    again = solving.solve(left, progress)
    if again.status in (Status.NOT_CONVERGED, Status.TIME_LIMIT) and np.isfinite(found.x).all():
        return found
    again = replace(again, instance=replace(again.instance, solver=instance.solver))
    return replace(again, wall_s=time.perf_counter() - began)


def instead(instance: Instance, progress: Progress | None, certified: bool) -> Solution | None:
    """Return the answer of a direct search, or a cheaper one from its certificate; ``None`` without an answer.

    Parameters
    ----------
    certified
        Whether the answer is certified.
    """
    from satsym.solvers.improving import improved

    def found(one: Instance, watching: Progress | None) -> Solution:
        began = time.perf_counter()
        limits, history = watched(one, watching)
        answer = solving.searched(one, replace(limits, work=solving.WORK))
        if answer is None:
            return unsolved(one, "collocation", time.perf_counter() - began)
        return replace(answer, history=tuple(history), wall_s=time.perf_counter() - began)

    answer = improved(found, instance, progress) if certified else found(instance, progress)
    certificate = answer.certificate
    failed = certificate is not None and certificate.verdict is Verdict.FAILED
    return answer if answer.status.answered and not failed else None


def cheaper(stated: Instance, solution: Solution, deadline: float) -> Solution:
    """Return a solution, or a cheaper one that the search finds.

    Parameters
    ----------
    stated
        The original problem; the solution's own instance may lack a final state that follows from others.
    deadline
        Deadline on the clock of :func:`~satsym.solvers.iteration.computed`.
    """
    began = time.perf_counter()
    instance = solution.instance if stated.free else stated
    spec = instance.model.spec
    alone = spec.linear_quadratic and not spec.in_arcs  # its one extremal is the minimum
    if not instance.free or alone or not solving.applies(instance):
        return solution
    limits = Limits(MOST_ITERATIONS, deadline, work=COMPARED)
    least = solution.objective - CHEAPER * abs(solution.objective)
    found = min(
        (one.exact for one in solving.others(instance, solution, limits) if one.exact is not None),
        key=lambda one: one.objective,
        default=None,
    )
    if found is None or not found.objective < least:
        return solution
    message = f"{found.message}; the first extremal found costs {solution.objective:.6g}"
    certificate = examined(found, limits.deadline)[0]
    if certificate is None or certificate.verdict is Verdict.FAILED:
        return solution
    lasted = solution.wall_s + time.perf_counter() - began
    return replace(found, message=message, certificate=certificate, history=solution.history, wall_s=lasted)
