"""Method "boundary-arcs": inequalities on the state, from a cold start to exact arcs, junctions and jumps."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.control_set import bound_names
from satsym.instance import Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Event, Progress, Solution
from satsym.solvers import iteration, two_point
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.constrained.active import control, field
from satsym.solvers.constrained.arcs import Arcs
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.constrained.newton import cost, from_arcs, from_path, solved
from satsym.solvers.constrained.recognition import recognised
from satsym.solvers.constrained.regularised.feasibility import impossible, refuse
from satsym.solvers.constrained.regularised.interior_point import Path
from satsym.solvers.constrained.regularised.search import searched
from satsym.solvers.constrained.regularised.starts import drawn, first, straight
from satsym.solvers.constrained.regularised.transcription import Program
from satsym.solvers.constrained.revision import ROUNDED, SLACK, contacts, without_idle, wrong
from satsym.solvers.constrained.structure import Contact, Structure, ordered
from satsym.solvers.constrained.structure import Event as Happening
from satsym.solvers.constrained.violation import violation
from satsym.solvers.failures import FAILURES, tried
from satsym.solvers.iteration import Limits, computed, deadline_of, history_of, watched
from satsym.solvers.simulation.extrapolation import leap
from satsym.status import Status

INTERVALS = (100, 250, 800)
"""Of the regularised path: of more where the structure is not seen."""

DRAWN, COMPARED = 4, 2
"""Pairs of paths that are drawn where the problem is not convex, by the solver and by the certificate."""

WORK = 20_000
"""Columns that may be linearised for one path of the certificate."""

PATH = "a regularised path"
"""Where arcs come from."""

REVISED, AGAIN = 12, 2
"""Structures that are tried at most from one path, and times that one of them is, from other junctions."""


@dataclass(frozen=True, eq=False)
class Stopped:
    """No answer, and why."""

    status: Status
    message: str


LATE = Stopped(Status.TIME_LIMIT, "time was up before an extremal was found")
NO_NUMBERS = Stopped(Status.NOT_CONVERGED, "no extremal found: arithmetic fails on the way")


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance with constraints on the state along the way.

    Parameters
    ----------
    instance
        Of a model with path constraints.
    progress
        Called as :func:`satsym.solvers.two_point.solve` calls it while the problem without constraints is solved.

    Returns
    -------
    Solution
        Times hold each junction twice: the last instant of one arc and the first of the next. Where no constraint is
        ever met it is the solution without them, by collocation.

    Raises
    ------
    BadInput
        If a constraint is violated where the motion is to start or to end.
    """
    refuse(instance)
    if instance.model.spec.switching:
        from satsym.solvers.constrained.levels import solving as levels

        return levels.solve(instance, progress)
    began, until = time.perf_counter(), deadline_of(instance)
    relaxed = two_point.solve(instance, progress)
    if relaxed.status.answered and violation(relaxed) <= SLACK:
        return replace(relaxed, message=f"{relaxed.message}; no path constraint is ever active")
    limits = replace(watched(instance, None)[0], deadline=until)
    with np.errstate(all="ignore"):
        try:
            found = _best(instance, relaxed, limits)
        except FAILURES as error:
            found = Stopped(Status.NOT_CONVERGED, f"no extremal found: arithmetic fails on the way ({error})")
    if isinstance(found, Stopped):
        nothing = iteration.unsolved(instance, BOUNDARY_ARCS, time.perf_counter() - began)
        return replace(nothing, status=found.status, message=found.message, history=relaxed.history)
    return answered(instance, found, time.perf_counter() - began, PATH)


def cheaper(solution: Solution, deadline: float) -> Solution | None:
    """The extremal to which paths about an answer without boundary arcs lead; ``None`` where none is cheaper."""
    began = time.perf_counter()
    if computed() >= deadline or convex(solution.instance):
        return None
    with np.errstate(all="ignore"):
        limits = replace(watched(solution.instance, None)[0], deadline=deadline)
        found = tried(partial(_best, solution.instance, solution, limits))
    if not isinstance(found, Arcs) or not cost(found) < solution.objective:
        return None
    return answered(solution.instance, found, time.perf_counter() - began, PATH)


def near(motion: Solution, limits: Limits) -> Solution | None:
    """The extremal near a motion that keeps to the constraints; ``None`` where there is none."""
    began, instance = time.perf_counter(), motion.instance
    program, worth = Program(instance, INTERVALS[0]), motion.objective or 1.0
    found = next(searched(program, [first(program, motion)], worth, limits, _exactly(program, worth)), None)
    return answered(instance, found, time.perf_counter() - began, PATH) if isinstance(found, Arcs) else None


def _best(instance: Instance, relaxed: Solution, limits: Limits) -> Arcs | Stopped:
    """The cheapest extremal to which regularised paths lead."""
    worth = relaxed.objective if relaxed.status.answered and relaxed.objective else 1.0
    found: list[Arcs | Stopped] = []
    for intervals in INTERVALS:
        program = Program(instance, intervals)
        begun = first(program, relaxed)
        starts = [begun, *([] if convex(instance) else drawn(program, begun, DRAWN, 0))]
        found = [one or NO_NUMBERS for one in searched(program, starts, worth, limits, _exactly(program, worth), begun)]
        exact = [one for one in found if isinstance(one, Arcs)]
        if exact or limits.late or _impossible(found[0]):
            return min(exact, key=cost, default=LATE if limits.late else found[0])
    return found[0]


def _impossible(one: Arcs | Stopped) -> bool:
    return isinstance(one, Stopped) and one.status is Status.INFEASIBLE


def others(instance: Instance, answer: Solution, seed: int, deadline: float) -> tuple[int, list[float], bool]:
    """How many paths were followed, costs of the extremals to which they led, and whether time was up before all.

    They are drawn about the straight line and, where none of these leads anywhere, about the answer: without given
    ends, or where states grow fast, there may be no motion near any straight line.

    Parameters
    ----------
    answer
        Its cost is the size of costs.
    seed
        Of the paths.
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`.
    """
    program, limits = Program(instance, INTERVALS[0]), replace(watched(instance, None)[0], deadline=deadline, work=WORK)
    count, worth, costs = 0, answer.objective, list[float]()
    with np.errstate(all="ignore"):
        for about in (straight(program), first(program, answer)):
            starts = drawn(program, about, COMPARED, seed)
            found = list(searched(program, starts, worth, limits, _exactly(program, worth)))
            count += len(found)
            costs = [cost(one) for one in found if isinstance(one, Arcs)]
            if costs or limits.late:
                break
    return count, costs, limits.late


def _exactly(program: Program, worth: float) -> Callable[[Path, Limits], Arcs | Stopped]:
    """Exact arcs from a regularised path, or why it has none."""

    def exact(path: Path, limits: Limits) -> Arcs | Stopped:
        if path.solved:
            first = [recognised(program, path, resting=resting) for resting in (False, True)]
            return revised(first, partial(from_path, program, path), limits)
        if convex(program.instance) and (reason := impossible(program, worth)):
            return Stopped(Status.INFEASIBLE, reason)
        return Stopped(Status.NOT_CONVERGED, "no regularised path keeps to the path constraints")

    return exact


def revised(first: list[Structure], fresh: Callable[[Structure], Arcs], limits: Limits) -> Arcs | Stopped:
    """Exact arcs, the structure revised until nothing is wrong with it.

    Parameters
    ----------
    first
        Structures to begin with.
    fresh
        The unknowns of a structure near which no arcs are known.
    limits
        When to give up.
    """
    waiting: list[tuple[Structure, Arcs | None]] = [(one, None) for one in first]
    seen: Counter[tuple[object, ...]] = Counter()
    reason = "the equations of its arcs are not solved"
    while waiting and seen.total() < REVISED and not limits.expired:
        structure, before = waiting.pop(0)
        if seen[structure.key] >= AGAIN:
            continue
        seen[structure.key] += 1
        begun = fresh(structure) if before is None else from_arcs(before, structure)
        instance, found = begun.instance, solved(begun, limits)
        if found is None and before is not None:
            found = solved(fresh(structure), limits)
        if found is None:
            waiting += [(other, before) for other in _variants(instance, structure)]
            continue
        reason, others = wrong(found)
        if not reason:
            return _lean(found, limits)
        waiting = [*((other, found) for other in others), *waiting]
    near = first[0].name(begun.instance)
    return Stopped(Status.NOT_CONVERGED, f"no structure near ({near}) is an extremal: {reason}")


def _lean(arcs: Arcs, limits: Limits) -> Arcs:
    """Without arcs that nothing needs, where what is left is an extremal as well."""
    if (structure := without_idle(arcs)) is None:
        return arcs
    found = solved(from_arcs(arcs, structure), limits)
    return arcs if found is None or wrong(found)[0] else found


def _variants(instance: Instance, structure: Structure) -> list[Structure]:
    """With one arc as a touch point, or without it where its order is one."""
    found = []
    for k, one in enumerate(structure.contacts):
        second = instance.model.spec.path_constraints[one.constraint].order > 1
        if not one.touches:
            touch = Contact(one.constraint, one.middle, one.middle, (sum(one.jumps), 0.0))
            others = [*structure.contacts[:k], *([touch] if second else []), *structure.contacts[k + 1 :]]
            found.append(ordered(others, structure.passages))
    return found


def _events(arcs: Arcs, times: Array) -> tuple[Event, ...]:
    """What happens at these times of arcs, where one boundary follows another the exit too."""
    instance, known = arcs.instance, arcs.structure.contacts
    names = [one.name for one in instance.model.spec.path_constraints]
    points = [one.name for one in instance.model.spec.interior]
    found = [Event("entry", names[k], instance.t0) for k in arcs.structure.begun]
    for one, t in zip(arcs.junctions, times[1:-1].tolist(), strict=True):
        if one.event is Happening.INTERIOR:
            found += [Event("exit", names[k], t) for k in one.before if k not in one.after]
            found.append(Event(one.event.value, points[one.constraint], t))
            found += [Event("entry", names[k], t) for k in one.after if k not in one.before]
            continue
        found += [] if one.left is None else [Event("exit", names[known[one.left].constraint], t)]
        found.append(Event(one.event.value, names[one.constraint], t))
    touched = (one.constraint for one in known if one.closes and one.touches)
    return (*found, *(Event("touch", names[k], float(arcs.end)) for k in touched))


def _at_nodes(arcs: Arcs, arc: int, times: Array) -> Array:
    """Values (2n, N) on an arc, from where its intervals begin: more accurate than its polynomials within these."""
    k, (a, b) = arcs.intervals[arc], arcs.times[arc : arc + 2]
    which = np.clip(((times - a) / (b - a) * k).astype(int), 0, k - 1)
    begins, starts = a + (b - a) * which / k, arcs.nodes(arc)[:: STAGES + 1][which].T
    z = leap(partial(field, arcs.instance, arcs.active[arc]), begins, starts, times - begins)
    z[:, 0], z[:, -1] = arcs.node(arc, 0), arcs.node(arc, -1)
    return z


def answered(instance: Instance, arcs: Arcs, wall_s: float, source: str) -> Solution:
    """Exact arcs, from what the source says, as a solution; junctions that come at once have one time.

    Its history is that of the path and of the arcs that led here, not of the problem without constraints.
    """
    nodes, n = np.linspace(instance.t0, arcs.end, instance.solver.steps + 1), arcs.n
    parts: list[tuple[Array, Array, Array]] = []
    brief = ROUNDED * (arcs.end - instance.t0)
    edges = [instance.t0]
    for a, b in pairwise(arcs.times):
        edges.append(edges[-1] if b - a <= brief else float(b))
    for arc, (a, b) in enumerate(pairwise(edges)):
        if a == b:
            continue
        times = np.concatenate([[a], nodes[(nodes > a) & (nodes < b)], [b]])
        z = _at_nodes(arcs, arc, times)
        parts.append((times, z, control(instance, arcs.active[arc], times, z)))
    times, z, u = (np.concatenate([part[k] for part in parts], axis=-1) for k in range(3))
    status = Status.CONVERGED if instance.model.in_domain(z[:n]) else Status.LEFT_DOMAIN
    events = _events(arcs, np.array(edges))
    names = [one.name for one in instance.model.spec.path_constraints]
    lasting = ", ".join(f"{names[c.constraint]} {c.end - c.start:.4g} long" for c in contacts(arcs) if not c.touches)
    message = f"structure {arcs.structure.name(instance)}" + (f" ({lasting})" if lasting else "")
    return Solution(
        instance=instance,
        method=BOUNDARY_ARCS,
        status=status,
        message=f"{message}, from {source}",
        objective=cost(arcs),
        times=times,
        x=z[:n],
        u=u,
        lam=z[n:],
        switching_times=tuple(
            tuple(dict.fromkeys(one.t for one in events if one.name in bounds and instance.t0 < one.t))
            for bounds in bound_names(instance.model.spec)
        ),
        iterations=len(arcs.passed),
        history=history_of(arcs.passed),
        wall_s=wall_s,
        events=events,
    )
