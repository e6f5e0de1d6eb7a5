"""Points on the way: the cheapest of the motions to which many times lead, then exact arcs with times and jumps."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Progress, Solution
from satsym.solvers import iteration, two_point
from satsym.solvers.constrained.arcs import Arcs
from satsym.solvers.constrained.newton import converged, cost, from_arcs
from satsym.solvers.constrained.revision import passages
from satsym.solvers.constrained.solving import LATE, Stopped, answered, revised
from satsym.solvers.constrained.structure import Structure
from satsym.solvers.failures import tried
from satsym.solvers.interior.descent import optimum
from satsym.solvers.interior.guesses import LASTING, Base, bases, bent, drawn_weights, passing, weights
from satsym.solvers.iteration import Limits, Meter, deadline_of, watched
from satsym.status import Status

KEPT = 4
"""Times from which the cost is minimised: those that cost least."""

DURATIONS = (0.6, 1.2, 2.5)
"""Of a free one, over that without the points."""

DRAWN = 6
"""Times and paths that the certificate draws."""

WORK = 60_000
"""Columns that may be linearised for one of these."""

SAME = 1e-7
"""Relative difference of costs of motions that are one."""

Start = tuple[Base, Array, float]
"""A path, fractions of the duration between points, and the duration."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance that passes points on the way at free times.

    Parameters
    ----------
    instance
        Of a model with points on the way.
    progress
        Called as :func:`satsym.solvers.two_point.solve` calls it while the problem without the points is solved.

    Returns
    -------
    Solution
        Times hold each junction twice: the last instant before it and the first after it.
    """
    began, until = time.perf_counter(), deadline_of(instance)
    relaxed = two_point.solve(instance, progress)
    limits = replace(watched(instance, None)[0], deadline=until)
    found: Arcs | Stopped | None = None
    with np.errstate(all="ignore"):
        for base in bases(instance, relaxed):
            found = _best(instance, _starts(instance, base), limits)
            if isinstance(found, Arcs) or limits.late:
                break
    if not isinstance(found, Arcs):
        stopped = LATE if limits.late or found is None else found
        nothing = iteration.unsolved(instance, BOUNDARY_ARCS, time.perf_counter() - began)
        return replace(nothing, status=stopped.status, message=stopped.message, history=relaxed.history)
    return answered(instance, found, time.perf_counter() - began, "a search of the times")


def others(solution: Solution, seed: int, deadline: float) -> tuple[int, list[float], bool]:
    """How many times and paths that are drawn led to what, costs of the extremals, and whether time was up.

    Parameters
    ----------
    solution
        About which paths are drawn.
    seed
        Of what is drawn.
    deadline
        On the clock of :func:`~satsym.solvers.iteration.computed`.
    """
    instance, rng, costs = solution.instance, np.random.default_rng(seed), list[float]()
    points, lasting = len(instance.model.spec.interior), float(solution.times[-1]) - instance.t0
    straight = bases(instance, replace(solution, status=Status.NOT_CONVERGED))[-1]
    limits, count = replace(watched(instance, None)[0], deadline=deadline, work=WORK), 0
    with np.errstate(all="ignore"):
        for _ in range(DRAWN):
            longer = np.exp(LASTING * rng.normal()) if instance.tf is None else 1.0
            start = bent(straight, rng), drawn_weights(points, rng), lasting * longer
            found = _best(instance, [start], replace(limits, meter=Meter()))
            if limits.late:
                break
            count += 1
            costs += [cost(found)] if isinstance(found, Arcs) else []
    return count, costs, limits.late


def _starts(instance: Instance, base: Base) -> Iterator[Start]:
    """Times of all orders of magnitude along a path."""
    for fractions in weights(len(instance.model.spec.interior)):
        for longer in (1.0,) if instance.tf is not None else DURATIONS:
            yield base, fractions, base.lasting * longer


def _best(instance: Instance, starts: Iterable[Start], limits: Limits) -> Arcs | Stopped:
    """The cheapest extremal to which starts lead."""
    rough = [one for start in starts if (one := tried(partial(_at_times, instance, start, limits))) is not None]
    if limits.late:
        return LATE
    found: list[Arcs] = []
    for fixed in sorted(rough, key=cost)[:KEPT]:
        one = tried(partial(optimum, fixed, limits))
        if one is not None and not any(abs(cost(one) - cost(other)) <= SAME * abs(cost(other)) for other in found):
            found.append(one)
    if not found:
        what = "passes the points at times in order" if rough else "passes the points at any times that were tried"
        return Stopped(Status.NOT_CONVERGED, f"no extremal found that {what}")
    exact = [tried(partial(_exact, one, limits)) for one in sorted(found, key=cost)]
    solved = [one for one in exact if isinstance(one, Arcs)]
    stopped = next((one for one in exact if isinstance(one, Stopped)), LATE)
    return min(solved, key=cost, default=stopped)


def _at_times(instance: Instance, start: Start, limits: Limits) -> Arcs | None:
    """The extremal with the times of a start, on a coarse mesh."""
    return converged(passing(instance, *start), limits)


def _exact(arcs: Arcs, limits: Limits) -> Arcs | Stopped:
    """Exact arcs from an extremal that knows no bounds."""
    return revised([Structure((), passages(arcs))], partial(from_arcs, arcs), limits)
