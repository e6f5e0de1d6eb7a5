"""From a cold start to an extremal: a straight line where that goes straight, else a path of easier problems.

Where the uncontrolled motion looks the same after a rotation, spirals of the likeliest numbers of turns come
first. Else first Newton's method from what is guessed, or from the straight line in the state space (or, where nothing
is asked of the end, from the uncontrolled motion), then the minimisation from there. Where neither walks straight
through, the second way decides as well: from a motion that needs no control at all and ends where it should, the
initial state is moved to the given one, each problem starting from the last. The cheaper minimum stands. Where neither
way arrives, the duration is halved until the straight line leads to a minimum, and lengthened from there; at last the
final angles are left free and then moved to where they should be.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.from_path import STRAIGHT_THROUGH, from_path
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.path_of_ends import along_durations, along_ends
from satsym.solvers.cold_start.path_of_problems import along_problems, along_turns, geometric, straight
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.symmetry import spirals

TURNS = 2
"""Spirals that are tried."""

PATHS, AMPLITUDE, MOST = 3, 0.2, 40
"""Paths that are drawn, how far they leave the straight line, and steps from each."""

LAST = (Origin.DRAWN, Origin.STRAIGHT_PROBLEMS, Origin.DURATIONS, Origin.ENDS)
"""From where one starts only if all else led nowhere."""


def cold_start(problem: TwoPoint, limits: Limits, quick: bool = False) -> Start:
    """Find a minimum of a problem without bounds.

    Parameters
    ----------
    problem
        Bounds are ignored.
    quick
        Try the first way only.
    """
    free, guess = problem.relaxed(float("inf")), problem.instance.guess
    path = paths.first(free)
    line = paths.start(free, path)

    def shorter(problem: TwoPoint) -> Attempt:
        return from_path(problem, paths.first(problem), limits)

    attempts: list[tuple[Origin, Callable[[], Attempt | None]]] = [
        (
            Origin.GUESS if guess else Origin.STRAIGHT_LINE,
            lambda: straight_through(free, line, limits) or from_path(free, path, limits),
        ),
        (Origin.PROBLEMS, lambda: along_problems(free, geometric, limits)),
        (Origin.DRAWN, lambda: _drawn(free, limits)),
        (Origin.STRAIGHT_PROBLEMS, lambda: along_problems(free, straight, limits)),
        (Origin.DURATIONS, lambda: along_durations(free, STAGES, limits, shorter)),
        (Origin.ENDS, lambda: along_ends(free, limits, lambda easier: cold_start(easier, limits).found)),
    ]
    turning = [] if guess else spirals(free, TURNS)
    attempts[:0] = [(Origin.SPIRAL, partial(along_turns, free, one, limits)) for one in turning]

    minima: list[Start] = []
    last: Attempt | None = None
    saddle: Attempt | None = None
    steps = 0
    for number, (origin, attempt) in enumerate(attempts):
        if minima and (origin in LAST or number == len(turning)):
            break
        with np.errstate(all="ignore"):
            found = tried(attempt)
        if found is None:
            continue
        last, steps = found, steps + found.iterations
        if found.minimum and found.curve.in_domain(free.positive):
            minima.append(Start(found, origin, steps, turning[number].turns if origin is Origin.SPIRAL else 0.0))
            if not found.hard and number >= len(turning):
                break
        elif free.linear and number == len(turning):
            saddle = _extremal(free, line)
        if limits.expired or quick or saddle:
            break
    if minima:
        return replace(min(minima, key=lambda start: start.found.cost), steps=steps)
    if last is None:
        raise ArithmeticError("the equations of every cold start are singular")
    saddle = saddle or (None if limits.expired or quick else _extremal(free, line))
    if last.minimum:
        last = replace(last, reason=Reason.OUT_OF_DOMAIN)
    return Start(last, Origin.NO_MINIMUM, steps, saddle=saddle)


def _extremal(problem: TwoPoint, start: Curve) -> Attempt | None:
    """What Newton's method finds from a curve, whether a minimum or not."""
    system = System(problem, start.mesh, STAGES)
    outcome = newton(system, start, most=STRAIGHT_THROUGH)
    if outcome is None or not outcome.solved or not outcome.curve.in_domain(problem.positive):
        return None
    return Attempt(outcome.curve, Reason.SADDLE, outcome.iterations, system.cost(outcome.curve))


def _drawn(problem: TwoPoint, limits: Limits) -> Attempt | None:
    """The cheapest minimum to which paths lead that are drawn: the straight line may lie between two minima."""
    rng = np.random.default_rng(0)
    found = [from_path(problem, paths.bent(problem, rng, AMPLITUDE), limits, MOST) for _ in range(PATHS)]
    minima = [one for one in found if one.minimum and one.curve.in_domain(problem.positive)]
    best = min(minima, key=lambda one: one.cost, default=None)
    return None if best is None else replace(best, hard=True, iterations=sum(one.iterations for one in found))
