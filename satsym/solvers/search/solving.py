"""The search as solvers call it: where nothing else found an answer, and where something may be cheaper."""

from __future__ import annotations

import time
from dataclasses import replace

from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solution import Progress, Solution
from satsym.solvers.certificate.verdict import examined
from satsym.solvers.iteration import MOST, Limits, deadline_of, watched
from satsym.solvers.search import order
from satsym.solvers.search.answer import answered
from satsym.status import Status

WORK, COMPARED, PROBE = 4_000_000, 2_000_000, 80_000
"""Unknowns times iterations that a search may take, for an answer and for a cheaper one; and within which it must come
to more than one motion to go on for a cheaper one."""

CHEAPER = 1e-6
"""Share of its size, or of that of its terms, by which something must be cheaper to be taken."""


def applies(instance: Instance) -> bool:
    """Whether the search knows the kinds of arcs that an instance may have, and whether it may change its start."""
    spec = instance.model.spec
    plain = not (spec.in_arcs or spec.switching or spec.chattering or instance.end_limits or instance.guess)
    timed = any(one.place is Place.TIME for one in instance.free)
    return plain and not timed and not instance.continuation


def instead(unsolved: Solution, progress: Progress | None, certified: bool) -> Solution:
    """The answer of a search in place of none; what was there where the search has none either.

    Parameters
    ----------
    certified
        Whether it is examined.
    """
    instance, began = unsolved.instance, time.perf_counter()
    if unsolved.status is not Status.NOT_CONVERGED or not applies(instance):
        return unsolved
    limits, history = watched(instance, progress)
    extremal = order.searched(instance, replace(limits, work=WORK))
    if extremal is None:
        return unsolved
    found = answered(instance, extremal)
    certificate = examined(found, limits.deadline)[0] if certified else None
    lasted = unsolved.wall_s + time.perf_counter() - began
    return replace(found, certificate=certificate, history=tuple(history), wall_s=lasted)


def _doubtful(solution: Solution) -> bool:
    """Whether competitors say little of an answer: ends are free, or some of them led to nothing."""
    certificate, instance = solution.certificate, solution.instance
    if not solution.status.answered or certificate is None:
        return False
    partly = 0 < len(instance.final) < len(instance.initial)
    return bool(instance.free) or partly or any(kind.unanswered for kind in certificate.competitors)


def cheaper(solution: Solution, progress: Progress | None) -> Solution:
    """An answer, or another one that the search finds and that costs less."""
    instance, began = solution.instance, time.perf_counter()
    if instance.model.spec.linear_quadratic or not applies(instance) or not _doubtful(solution):
        return solution
    limits = Limits(MOST, deadline_of(instance), work=COMPARED)
    least = solution.objective - CHEAPER * abs(solution.objective)
    extremal = order.searched(instance, limits, below=least, probe=PROBE)
    if extremal is None or not extremal.cost < least:
        return solution
    found = answered(instance, extremal)
    message = f"{found.message}; the first extremal found costs {solution.objective:.6g}"
    certificate = examined(found, limits.deadline)[0]
    lasted = solution.wall_s + time.perf_counter() - began
    return replace(found, message=message, certificate=certificate, history=solution.history, wall_s=lasted)
