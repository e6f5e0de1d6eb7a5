"""Method "boundary-arcs": inequalities on the state, from a cold start to exact arcs, junctions and jumps."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Event, Progress, Solution
from satsym.solvers import iteration, two_point
from satsym.solvers.collocation.scaling import two_point as two_point_of
from satsym.solvers.constrained.arcs import Arcs
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.constrained.feasibility import impossible, refuse
from satsym.solvers.constrained.interior_point import Path, regularised
from satsym.solvers.constrained.newton import from_arcs, from_path, solved
from satsym.solvers.constrained.recognition import recognised
from satsym.solvers.constrained.revision import SLACK, contacts, wrong
from satsym.solvers.constrained.structure import Structure
from satsym.solvers.constrained.transcription import Point, Program
from satsym.solvers.failures import FAILURES, tried
from satsym.solvers.iteration import Limits, watched
from satsym.status import Status

METHOD = "boundary-arcs"

INTERVALS = (100, 250, 800)
"""Of the regularised path: of more where the structure is not seen."""

SAME = 1e-6
"""Relative difference of costs of regularised paths that are one."""

REVISED = 12
"""Structures that are tried at most from one path."""

DRAWN, AMPLITUDE = 3, 0.3
"""Pairs of paths that are drawn where the problem is not convex, and how far they leave the relaxed one."""


@dataclass(frozen=True, eq=False)
class Stopped:
    """No answer, and why."""

    status: Status
    message: str


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
    began = time.perf_counter()
    relaxed = two_point.solve(instance, progress)
    if relaxed.status.answered and _kept(relaxed):
        return replace(relaxed, message=f"{relaxed.message}; no path constraint is ever active")
    limits, _ = watched(instance, None)
    with np.errstate(all="ignore"):
        try:
            found = _best(instance, relaxed, limits)
        except FAILURES as error:
            found = Stopped(Status.NOT_CONVERGED, f"no extremal found: arithmetic fails on the way ({error})")
    if isinstance(found, Stopped):
        status = Status.TIME_LIMIT if limits.expired else found.status
        nothing = iteration.unsolved(instance, METHOD, time.perf_counter() - began)
        return replace(nothing, status=status, message=found.message, history=relaxed.history)
    return _answered(instance, found, relaxed, time.perf_counter() - began)


def _kept(relaxed: Solution) -> bool:
    """Whether a trajectory keeps to all constraints, at its nodes and between them."""
    instance, times = relaxed.instance, relaxed.times
    model, p = instance.model, instance.parameters
    g = np.asarray(model.path_constraints_batch(times, relaxed.x, p))
    rates = np.asarray(model.path_rates_batch(times, relaxed.x, relaxed.u, p)).reshape(len(g), 2, -1)[:, 0]
    steps = np.diff(times)
    rising = np.maximum(g[:, :-1] + np.maximum(rates[:, :-1], 0.0) * steps, g[:, 1:])
    # a bound by slopes at both ends: between two nodes nothing rises higher than along the steeper one
    size = np.maximum(np.abs(g).max(axis=1), 1e-300)
    inside = np.minimum(rising, g[:, 1:] + np.maximum(-rates[:, 1:], 0.0) * steps)
    met = np.maximum(
        np.maximum(g[:, :-1], g[:, 1:]), np.where((rates[:, :-1] > 0) & (rates[:, 1:] < 0), inside, -np.inf)
    )
    return bool((met.max(axis=1) <= SLACK * size).all())


def _best(instance: Instance, relaxed: Solution, limits: Limits) -> Arcs | Stopped:
    """The cheapest extremal to which regularised paths lead."""
    found: list[Arcs] = []
    worth = relaxed.objective if relaxed.status.answered and relaxed.objective else 1.0
    last: Arcs | Stopped = Stopped(Status.NOT_CONVERGED, "")
    for intervals in INTERVALS:
        program, costs = Program(instance, intervals), list[float]()
        for start in _starts(program, relaxed):
            path = regularised(program, start, worth, limits)
            if path.solved and any(abs(path.cost - cost) <= SAME * abs(cost) for cost in costs):
                continue
            costs += [path.cost] if path.solved else []
            last = _exact(program, path, limits) if path.solved else _unsolved(program, path)
            if isinstance(last, Arcs):
                found.append(last)
            if limits.expired:
                break
        if found:
            return min(found, key=lambda one: one.cost())
    return last


def others(instance: Instance, worth: float, seed: int) -> tuple[int, list[float]]:
    """How many paths were drawn about the straight line, and the costs of the extremals to which they led.

    Parameters
    ----------
    worth
        The size of costs.
    seed
        Of the paths.
    """
    limits, found = watched(instance, None)[0], list[float]()
    program, known = Program(instance, INTERVALS[0]), list[tuple[float, float]]()
    starts = _drawn(program, _straight(program), seed)
    with np.errstate(all="ignore"):
        for start in starts:
            path = regularised(program, start, worth, limits)
            same = [cost for near, cost in known if abs(path.cost - near) <= SAME * abs(near)]
            if path.solved and same:
                found.append(same[0])
                continue
            exact = tried(partial(_exact, program, path, limits)) if path.solved else None
            if isinstance(exact, Arcs):
                found.append(exact.cost())
                known.append((path.cost, found[-1]))
    return len(starts), found


def _unsolved(program: Program, path: Path) -> Stopped:
    """Why the regularised problem has no answer."""
    if path.violation > 1e-6 and convex(program.instance):
        return Stopped(Status.INFEASIBLE, impossible(program, path))
    return Stopped(Status.NOT_CONVERGED, "no regularised path keeps to the path constraints")


def _starts(program: Program, relaxed: Solution) -> list[Point]:
    """The path without constraints or a straight line; where the problem is not convex also paths about it."""
    one, count = program.instance, program.intervals
    h = len(one.model.spec.path_constraints)
    tau = np.linspace(0.0, 1.0, count + 1)
    middles = (tau[1:] + tau[:-1]) / 2
    none, v = np.zeros((h, count)), np.zeros(len(program.given) + len(one.model.spec.multipliers))
    if relaxed.status.answered:
        lasting = float(relaxed.times[-1] - relaxed.times[0])
        share = (relaxed.times - relaxed.times[0]) / lasting
        x, u, y = (
            np.array([np.interp(places, share, row) for row in rows]).reshape(len(rows), -1)
            for rows, places in ((relaxed.x, tau), (relaxed.u, middles), (relaxed.lam, middles))
        )
        first = Point(x, u, lasting, y, v, none, none)
    else:
        first = _straight(program)
    return [first] if convex(one) else [first, *_drawn(program, first, 0)]


def _straight(program: Program) -> Point:
    """A straight line to the given end."""
    one, count = program.instance, program.intervals
    h, n, m = len(one.model.spec.path_constraints), len(one.initial), len(one.model.spec.controls)
    begin, given = np.array(one.initial), np.zeros(n, bool)
    given[program.given] = True
    end = np.where(given, program.target(program.guessed), begin)
    x = begin[:, None] + (end - begin)[:, None] * np.linspace(0.0, 1.0, count + 1)
    none, v = np.zeros((h, count)), np.zeros(len(program.given) + len(one.model.spec.multipliers))
    return Point(x, np.zeros((m, count)), program.guessed, np.zeros((n, count)), v, none, none)


def _drawn(program: Program, about: Point, seed: int) -> list[Point]:
    """Paths about another."""
    rng, n = np.random.default_rng(seed), len(about.x)
    unit = two_point_of(program.instance, about.duration).scale.state[:, None]
    size = np.maximum(np.abs(about.x).max(axis=1, keepdims=True), unit)
    tau = np.linspace(0.0, 1.0, program.intervals + 1)
    bumps = [rng.normal(size=(n, 1)) * size * AMPLITUDE * np.sin(np.pi * tau) for _ in range(DRAWN)]
    return [replace(about, x=about.x + side * bump, y=0.0 * about.y) for bump in bumps for side in (1.0, -1.0)]


def _exact(program: Program, path: Path, limits: Limits) -> Arcs | Stopped:
    """Exact arcs from a regularised path, the structure revised until nothing is wrong with it."""
    instance = program.instance
    waiting: list[tuple[Structure, Arcs | None]] = [(recognised(program, path), None)]
    seen: set[tuple[object, ...]] = set()
    reason = "the equations of its arcs are not solved"
    while waiting and len(seen) < REVISED and not limits.expired:
        structure, before = waiting.pop(0)
        if structure.key in seen:
            continue
        seen.add(structure.key)
        begun = from_path(program, path.at, structure) if before is None else from_arcs(before, structure)
        found = solved(begun, limits)
        if found is None and before is not None:
            found = solved(from_path(program, path.at, structure), limits)
        if found is None:
            waiting += [(other, before) for other in _variants(structure)]
            continue
        reason, others = wrong(found)
        if not reason:
            return found
        waiting = [*((other, found) for other in others), *waiting]
    shown = recognised(program, path).name(instance)
    return Stopped(Status.NOT_CONVERGED, f"no structure near ({shown}) is an extremal: {reason}")


def _variants(structure: Structure) -> list[Structure]:
    """With one arc as a touch point."""
    found = []
    for k, one in enumerate(structure.contacts):
        if not one.touches:
            touch = replace(one, start=one.middle, end=one.middle, jumps=(sum(one.jumps), 0.0))
            found.append(replace(structure, contacts=(*structure.contacts[:k], touch, *structure.contacts[k + 1 :])))
    return found


def _answered(instance: Instance, arcs: Arcs, relaxed: Solution, wall_s: float) -> Solution:
    """Exact arcs as a solution."""
    nodes, n = np.linspace(instance.t0, arcs.end, instance.solver.steps + 1), arcs.n
    parts: list[tuple[Array, Array]] = []
    for arc, (a, b) in enumerate(zip(arcs.times[:-1], arcs.times[1:], strict=True)):
        inside = nodes[(nodes > a) & (nodes < b)]
        z = arcs.at(arc, np.concatenate([[a], inside, [b]]))
        z[:, 0], z[:, -1] = arcs.node(arc, 0), arcs.node(arc, -1)
        parts.append((np.concatenate([[a], inside, [b]]), z))
    times, z = np.concatenate([t for t, _ in parts]), np.concatenate([v for _, v in parts], axis=1)
    u = instance.model.control_law_batch(times, z[:n], z[n:], instance.parameters, instance.control_set.arguments)
    status = Status.CONVERGED if instance.model.in_domain(z[:n]) else Status.LEFT_DOMAIN
    names = [one.name for one in instance.model.spec.path_constraints]
    events = tuple(
        Event(one.event.value, names[one.constraint], float(t))
        for one, t in zip(arcs.junctions, arcs.times[1:-1], strict=True)
    )
    lasting = ", ".join(f"{names[c.constraint]} {c.end - c.start:.4g} long" for c in contacts(arcs) if not c.touches)
    message = f"structure {arcs.structure.name(instance)}" + (f" ({lasting})" if lasting else "")
    return Solution(
        instance=instance,
        method=METHOD,
        status=status,
        message=f"{message}, from a regularised path",
        objective=arcs.cost(),
        times=times,
        x=z[:n],
        u=np.broadcast_to(u, (len(instance.model.spec.controls), len(times))).copy(),
        lam=z[n:],
        switching_times=tuple(() for _ in instance.model.spec.controls),
        iterations=len(relaxed.history),
        history=relaxed.history,
        wall_s=wall_s,
        events=events,
    )
