"""Continuation from an easy problem to the required one, with each solution as the initial guess of the next.

Steps grow as long as they succeed. Where the path of solutions turns back, it is followed by arc length past the fold,
if it leads to the end of the path (:mod:`satsym.solvers.collocation.arclength`).
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation.arclength import Point, extremals
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import final_argument, two_point
from satsym.solvers.collocation.system import System
from satsym.solvers.failures import FAILURES
from satsym.solvers.improving import starting_from
from satsym.status import Status
from satsym.wording import counted

FIRST, LONGER, SHORTER = 0.2, 1.7, 0.3
"""First step, as a fraction of the path; factors of the next step after a success and after a failure."""

SHORTEST, MOST_STEPS = 1e-3, 200
"""Step below which the continuation is given up, and maximum number of steps."""

MOST_POINTS = 300
"""Maximum number of solutions that are followed past folds."""

JUMP = 0.5
"""Largest relative difference of the states of two neighbouring solutions."""

Solver = Callable[[Instance, Progress | None], Solution]


@dataclass(frozen=True)
class _Reached:
    """Progress of a continuation."""

    share: float
    answers: tuple[Solution, ...]
    folds: int = 0
    failed: Solution | None = None
    """Last problem for which no solution nearby was found, otherwise ``None``."""

    @property
    def last(self) -> Solution:
        """Return the last solution."""
        return self.answers[-1]


def solve(instance: Instance, progress: Progress | None, quick: Solver, certified: Solver) -> Solution:
    """Solve an instance by continuation.

    Parameters
    ----------
    instance
        Instance with the values that change along the path.
    quick
        Solver for intermediate problems.
    certified
        Solver for both ends of the path, with a certificate.
    """
    began = time.perf_counter()
    first = certified(at(instance, 0.0), progress)
    if not first.status.answered:
        reason = f"the first problem of the continuation, {_values(instance, 0.0)}, has no solution: {first.message}"
        return _told(instance, first, reason, (), began)
    reached = _stepped(instance, _Reached(0.0, (first,)), progress, quick)
    if reached.share < 1.0:
        reached = _past_folds(instance, reached, progress, quick)
    count = len(reached.answers)
    if reached.share < 1.0:
        where = f"continuation stops at {_values(instance, reached.share)} after {counted(count, 'solution')}"
        failed = reached.failed
        lost = replace(reached.last, status=Status.NOT_CONVERGED, objective=float("nan"), certificate=None)
        if failed is not None and not failed.status.answered:
            lost, where = replace(lost, status=failed.status), f"{where}: {failed.message}"
        return _told(instance, lost, where, reached.answers, began)
    final = certified(_guessed(instance, 1.0, reached.last), progress)
    folded = f", past {counted(reached.folds, 'fold')}" if reached.folds else ""
    begin, end = (_values(instance, share) for share in (0.0, 1.0))
    how = f"continued from {begin} to {end} through {counted(count, 'solution')}{folded}"
    return _told(instance, final, f"{final.message}; {how}", reached.answers, began)


def at(instance: Instance, share: float) -> Instance:
    """Return the problem at a fraction of the path."""
    found = replace(instance, continuation=())
    for one in instance.continuation:
        found = one.at(found, share)
    return found


def _stepped(instance: Instance, reached: _Reached, progress: Progress | None, quick: Solver) -> _Reached:
    """Continue in steps while successive solutions are close to each other, and return the progress made."""
    step = FIRST
    for _ in range(MOST_STEPS):
        if reached.share >= 1.0 or step < SHORTEST:
            break
        there = min(1.0, reached.share + step)
        found = quick(_guessed(instance, there, reached.last), progress)
        if found.status.answered and _near(reached.last, found):
            reached = replace(reached, share=there, answers=(*reached.answers, found))
            step *= LONGER
        else:
            reached = replace(reached, failed=found)
            step *= SHORTER
    return reached


def _past_folds(instance: Instance, reached: _Reached, progress: Progress | None, quick: Solver) -> _Reached:
    """Continue by arc length past folds; the progress is unchanged if that fails or does not apply."""
    spec = instance.model.spec
    if spec.switching or spec.directional or instance.free:
        return reached
    with np.errstate(all="ignore"):
        try:
            followed = _followed(instance, reached)
        except FAILURES:
            followed = None
    if followed is None:
        return reached
    point, folds = followed
    z = point.curve.nodes * point.problem.scale.both
    n, duration = point.problem.states, point.problem.elapsed(point.curve.theta)
    seen = replace(reached.last, times=duration * point.curve.mesh, x=z[:n], lam=z[n:])
    found = quick(_guessed(instance, 1.0, seen), progress)
    if not found.status.answered:
        return reached
    return _Reached(1.0, (*reached.answers, found), folds)


def _followed(instance: Instance, reached: _Reached) -> tuple[Point, int] | None:
    """Return a minimum at the end of the path of extremals, and the number of folds passed, or ``None``."""
    left = 1.0 - reached.share
    start = _guessed(instance, reached.share, reached.last)
    times = reached.last.times
    here = two_point(start, float(times[-1] - times[0]))

    def path(share: float) -> TwoPoint:
        case = at(instance, reached.share + share * left)
        lasting = here.duration if case.tf is None else case.tf - case.t0
        return replace(here, instance=case, final=final_argument(case), duration=lasting)

    begun = paths.start(here)
    outcome = newton(System(here, begun.mesh, STAGES), begun)
    if outcome is None or not outcome.solved:
        return None
    folds, before, rising = 0, 0.0, True
    for count, point in enumerate(extremals(path, outcome.curve)):
        if (point.fraction > before) != rising:
            folds, rising = folds + 1, not rising
        before = point.fraction
        if point.fraction == 1.0 and point.minimum:
            return point, folds
        if count > MOST_POINTS or not -1.0 / left < point.fraction < 2.0:
            break
    return None


def _guessed(instance: Instance, share: float, last: Solution) -> Instance:
    """Return the problem at a fraction of the path with the last solution as its initial guess."""
    case = at(instance, share)
    for unknown in case.free:
        case = unknown.at(case, unknown.of(last.instance))
    guess = starting_from(replace(last, instance=case)).guess
    tf_guess = case.t0 + float(last.times[-1] - last.times[0]) if case.tf is None else case.tf_guess
    return replace(case, guess=guess, tf_guess=tf_guess)


def _near(before: Solution, after: Solution) -> bool:
    """Return whether two solutions are close, comparing their states at equal fractions of the duration."""
    share = np.linspace(0.0, 1.0, 101)
    rows = [
        np.array([np.interp(share, (one.times - one.times[0]) / np.ptp(one.times), row) for row in one.x])
        for one in (before, after)
    ]
    size = np.maximum(*(np.abs(one).max(axis=1) for one in rows))
    apart = np.abs(rows[1] - rows[0]).max(axis=1)
    return bool((apart <= JUMP * np.maximum(size, 1e-3 * size.max())).all())


def _values(instance: Instance, share: float) -> str:
    return ", ".join(f"{one.key.short} = {one.value(share):.6g}" for one in instance.continuation)


def _told(instance: Instance, found: Solution, message: str, answers: tuple[Solution, ...], began: float) -> Solution:
    """Return a solution with a message, intermediate solutions and totals, for the instance as it was given."""
    asked = replace(at(instance, 1.0), continuation=instance.continuation)
    for unknown in instance.free:
        asked = unknown.at(asked, unknown.of(found.instance))
    wall, spent = time.perf_counter() - began, found.iterations + sum(one.iterations for one in answers)
    return replace(found, instance=asked, message=message, intermediate=answers, wall_s=wall, iterations=spent)
