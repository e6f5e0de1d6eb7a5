"""What is tried after what: starts one after the other, the cheapest on finer meshes, its arcs, and Newton's method.

1. Each start of a fixed list (:mod:`~satsym.solvers.search.starts`) is solved on a coarse mesh.
2. It ends when as many starts as :data:`AGREE` came to the cheapest, or all are tried.
3. From the cheapest on, what was found is solved on finer meshes until its cost settles.
4. Its arcs are read after each mesh (:mod:`~satsym.solvers.search.reading`, :mod:`~satsym.solvers.search.levels`), and
   the first that Newton's method makes exact are the answer.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import TypeVar

import numpy as np

from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.search import nlp, starts
from satsym.solvers.search.controls import controls_of
from satsym.solvers.search.durations import first_duration
from satsym.solvers.search.mesh import refined
from satsym.solvers.search.motion import Motion, motion
from satsym.solvers.search.nlp import Found
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import sizes_of

Answer = TypeVar("Answer")

INTERVALS, SHORTEST = 40, 8
"""Number of intervals of the coarse mesh, and the least number in a phase."""

STARTS, AGREE, PATIENCE = 48, 3, 24
"""Starts that are tried at most; how many of them must come to the cheapest where no end is drawn; and how many in turn
may find nothing new where ends are."""

FAILING = 8
"""Starts in turn after which it ends where none has come to anything."""

FIRST = 0.5
"""Share of the work within which starts are tried."""

ITERATIONS, AGAIN = 300, 200
"""Of the interior-point code for a start, and for a finer mesh."""

SAME = 1e-4
"""Relative difference of costs on a coarse mesh that may be of one motion."""

MESHES, SETTLED, SMOOTHINGS = 5, 1e-6, (1e-3, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4)
"""Finer meshes at most, the change of cost from one to the next that is none, and smoothings of norms on each."""

TRIED = 3
"""Of the cheapest, how many are made exact one after the other until one is."""


def searched(
    instance: Instance,
    limits: Limits,
    exact: Callable[[Motion, Limits], Answer | None],
    below: float = np.inf,
    probe: float = np.inf,
    loose: str = "",
) -> Answer | None:
    """The cheapest extremal that is found; ``None`` without one.

    Parameters
    ----------
    limits
        Work is counted in unknowns times iterations.
    exact
        Makes a motion an exact extremal, where it can.
    below
        A cost; what does not cost less on the coarse mesh is not looked at any further.
    probe
        Work within which the starts must come to more than one motion for more of them to be tried.
    loose
        A state whose given end follows from those of the others.
    """
    for found in _cheapest_first(_tried(instance, limits, probe, loose)):
        if not found.objective < below:
            return None
        for at in _finer(found, limits):
            answer = exact(at, limits)
            if answer is not None:
                return answer
            if limits.expired:
                return None
    return None


def _tried(instance: Instance, limits: Limits, probe: float, loose: str) -> list[Found]:
    """What starts came to, those that were solved."""
    controls = controls_of(instance)
    if controls is None:
        return []
    phases = len(instance.model.spec.interior) + 1
    meshes = [np.linspace(0.0, 1.0, max(INTERVALS // phases, SHORTEST) + 1)] * phases
    found: list[Found] = []
    with np.errstate(all="ignore"):
        duration = first_duration(instance, controls)
        programme = Programme(instance, controls, meshes, sizes_of(instance, controls, duration), loose=loose)
        plans = starts.plans(instance, controls, duration)[:STARTS]
        drawn, known, within = any(plan.drawn for plan in plans), 0, replace(limits, work=min(probe, limits.work))
        for number, plan in enumerate(plans):
            one = nlp.solve(programme, starts.begun(programme, plan), within, ITERATIONS)
            if one.solved and not any(_same(one.objective, other.objective) for other in found):
                known = number
                within = limits if found else within
            found += [one] if one.solved else []
            least = min((other.objective for other in found), default=0.0)
            if not found and number + 1 >= FAILING:
                break
            agreed = sum(_same(other.objective, least) for other in found) >= AGREE
            agreed = number - known >= PATIENCE if drawn else agreed
            if agreed or within.expired or limits.meter.spent > FIRST * limits.work:
                break
    return found


def _same(one: float, other: float) -> bool:
    return abs(one - other) <= SAME * max(abs(one), abs(other))


def _cheapest_first(found: list[Found]) -> Iterator[Found]:
    """One of each cost, the cheapest first."""
    kept: list[Found] = []
    for one in sorted(found, key=lambda each: each.objective):
        if not any(_same(one.objective, other.objective) for other in kept):
            kept.append(one)
    yield from kept[:TRIED]


def _finer(found: Found, limits: Limits) -> Iterator[Motion]:
    """What was found, on meshes that are ever finer."""
    yield motion(found)
    for number in range(MESHES):
        old = found.programme
        meshes, _ = refined(found)
        if sum(len(mesh) - 1 for mesh in meshes) == old.intervals:
            return
        programme = Programme(old.instance, old.controls, meshes, old.sizes, SMOOTHINGS[number], old.loose)
        start = starts.carried(programme, old, found.unknown)
        with np.errstate(all="ignore"):
            one = nlp.solve(programme, start, limits, AGAIN, near=True)
            if not one.solved and not limits.expired:
                one = nlp.solve(programme, start, limits, ITERATIONS)
        if not one.solved:
            return
        settled = abs(one.objective - found.objective) <= SETTLED * abs(one.objective)
        found = one
        yield motion(found)
        if settled:
            return
