"""The search as solvers call it: where nothing else found an answer, and where something may be cheaper."""

from __future__ import annotations

import math
import time
from dataclasses import replace
from functools import partial

from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solution import Progress, Solution
from satsym.solvers.certificate.verdict import examined
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.iteration import MOST, Limits, deadline_of, watched
from satsym.solvers.redundant_ends import Redundant, redundant
from satsym.solvers.search import boundaries, levels, order, reading
from satsym.solvers.search.answer import answered
from satsym.solvers.search.motion import Motion
from satsym.status import Verdict

WORK, COMPARED = 4_000_000, 2_000_000
"""Unknowns times iterations that a search may take, for an answer and for a cheaper one."""

PROBE, AROUND = 160_000, 600_000
"""Unknowns times iterations within which the starts must come to more than one motion for a search for a cheaper
answer to go on. It is more where there are path constraints, because motions may pass these on several sides."""

CHEAPER = 1e-6
"""Share of its size, or of that of its terms, by which something must be cheaper to be taken."""


def applies(instance: Instance) -> bool:
    """Whether the search knows the kinds of arcs that an instance may have, and whether it may change its start."""
    spec = instance.model.spec
    plain = not (spec.chattering or instance.end_limits or instance.guess)
    arcs = not (spec.in_arcs and (spec.interior or spec.switching or spec.throttled or instance.free))
    timed = any(one.place is Place.TIME for one in instance.free)
    return plain and arcs and not timed and not instance.continuation


def exact(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """The extremal that a motion is near, as an answer without a certificate."""
    spec = instance.model.spec
    if spec.path_constraints:
        return boundaries.exact(instance, at, limits)
    extremal = None if spec.switching else reading.exact(instance, at, limits)
    if extremal is not None:
        return answered(instance, extremal)
    in_levels = (spec.switching or spec.throttled) and not instance.free
    return levels.exact(instance, at, limits) if in_levels else None


def _found(instance: Instance, limits: Limits, below: float = math.inf, probe: float = math.inf) -> Solution | None:
    """What the search finds, without a final state that follows from the others."""
    less = redundant(instance)
    if less is None:
        return order.searched(instance, limits, partial(exact, instance), below, probe)
    found = order.searched(instance, limits, partial(_met, less), below, probe, less.state)
    return None if found is None else replace(found, message=f"{found.message}; {less.note}")


def _met(less: Redundant, at: Motion, limits: Limits) -> Solution | None:
    """The extremal that a motion is near, if it ends as is asked."""
    found = exact(less.instance, at, limits)
    return found if found is not None and less.met(found) else None


def instead(instance: Instance, progress: Progress | None, certified: bool) -> Solution | None:
    """The answer of a search; ``None`` without one, or where the certificate of what it found fails.

    Parameters
    ----------
    certified
        Whether it is examined.
    """
    began = time.perf_counter()
    limits, history = watched(instance, progress)
    found = _found(instance, replace(limits, work=WORK))
    if found is None:
        return None
    certificate = examined(found, limits.deadline)[0] if certified else None
    if certificate is not None and certificate.verdict is Verdict.FAILED:
        return None
    return replace(found, certificate=certificate, history=tuple(history), wall_s=time.perf_counter() - began)


def _doubtful(solution: Solution) -> bool:
    """Whether competitors say little of an answer, for free ends, path constraints or starts that led nowhere."""
    certificate, instance = solution.certificate, solution.instance
    if certificate is None:
        return False
    partly = 0 < len(instance.final) < len(instance.initial)
    parted = bool(instance.model.spec.path_constraints) and not convex(instance)
    return bool(instance.free) or partly or parted or any(kind.unanswered for kind in certificate.competitors)


def cheaper(stated: Instance, solution: Solution) -> Solution:
    """An answer, or another one that the search finds and that costs less.

    Parameters
    ----------
    stated
        What was asked: the answer's own instance may lack a final state that follows from others.
    """
    began = time.perf_counter()
    instance = solution.instance if stated.free else stated
    if instance.model.spec.linear_quadratic or not applies(instance) or not _doubtful(solution):
        return solution
    limits = Limits(MOST, deadline_of(instance), work=COMPARED)
    least = solution.objective - CHEAPER * abs(solution.objective)
    probe = AROUND if instance.model.spec.path_constraints else PROBE
    found = _found(instance, limits, least, probe)
    if found is None or not found.objective < least:
        return solution
    message = f"{found.message}; the first extremal found costs {solution.objective:.6g}"
    certificate = examined(found, limits.deadline)[0]
    if certificate is None or certificate.verdict is Verdict.FAILED:
        return solution
    lasted = solution.wall_s + time.perf_counter() - began
    return replace(found, message=message, certificate=certificate, history=solution.history, wall_s=lasted)
