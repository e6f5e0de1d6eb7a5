"""From nothing to an extremal: a straight line where that goes straight, else a path of easier problems.

Where the motion without control looks the same after a rotation, spirals of the likeliest numbers of turns come
first. Else first Newton's method from what is guessed, or from the straight line in the state space (or, where nothing
is asked of the end, from the motion without control), then the minimisation from there. Where neither walks straight
through, the second way decides as well: from a motion that needs no control at all and ends where it should, the
initial state is moved to the given one, each problem starting from the last. The cheaper minimum stands. Where neither
way arrives, the duration is halved until the straight line leads to a minimum, and lengthened from there; at last the
final angles are left free and then moved to where they should be.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.from_path import STRAIGHT_THROUGH, from_path
from satsym.solvers.cold_start.path_of_durations import along_durations
from satsym.solvers.cold_start.path_of_ends import along_ends
from satsym.solvers.cold_start.path_of_problems import along_problems, geometric, straight
from satsym.solvers.cold_start.path_of_turns import along_turns
from satsym.solvers.cold_start.straight_through import straight_through
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.sqp import Found
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits
from satsym.solvers.symmetry import spirals

TURNS = 2
"""Spirals that are tried."""

PATHS, AMPLITUDE, MOST = 3, 0.2, 40
"""Paths that are drawn, how far they leave the straight line, and steps from each."""

DRAWN = "drawn path"
LAST = (DRAWN, "straight path of problems", "path of durations", "path of ends")
"""Ways that are tried only if the others led nowhere."""


@dataclass(frozen=True, eq=False)
class Start:
    """An extremal found from nothing.

    Attributes
    ----------
    found
        The cheapest minimum, or the last attempt.
    way
        ``"guess"`` or ``"straight line"``, ``"path of problems"``, one of those in ``LAST``, ``"spiral of ..."``, or
        ``"none"``.
    steps
        Steps of all attempts.
    minima
        Scaled costs of all minima that were met, by their way.
    saddle
        An extremal that is no minimum, where no minimum was found.
    within
        Where it was looked for within the bounds at once: the extremal there.
    """

    found: Found
    way: str
    steps: int
    minima: dict[str, float]
    saddle: Found | None = None
    within: Curve | None = None


def cold_start(problem: TwoPoint, limits: Limits, quick: bool = False) -> Start:
    """Find a minimum of a problem without bounds.

    Parameters
    ----------
    problem
        Bounds are ignored.
    limits
        When to stop.
    quick
        Try the first way only.
    """
    free = problem.relaxed(float("inf"))
    line, guess = paths.start(free), problem.instance.guess
    begin = "guess" if guess else "straight line"

    def from_line(problem: TwoPoint) -> Found:
        return from_path(problem, paths.first(problem), limits)

    ways: list[tuple[str, Callable[[], Found | None]]] = [
        (begin, lambda: straight_through(line, System(free, line.mesh, STAGES), limits) or from_line(free)),
        ("path of problems", lambda: along_problems(free, geometric, limits)),
        (DRAWN, lambda: _drawn(free, limits)),
        ("straight path of problems", lambda: along_problems(free, straight, limits)),
        ("path of durations", lambda: along_durations(free, STAGES, limits, from_line)),
        ("path of ends", lambda: along_ends(free, limits, lambda easier: cold_start(easier, limits).found)),
    ]

    turning = [] if guess else spirals(free, TURNS)
    ways[:0] = [(f"spiral of {one.turns:.2g} turns", partial(along_turns, free, one, limits)) for one in turning]

    minima: dict[str, Found] = {}
    last: Found | None = None
    saddle: Found | None = None
    steps = 0
    for number, (way, attempt) in enumerate(ways):
        if minima and (way in LAST or number == len(turning)):
            break
        with np.errstate(all="ignore"):
            found = attempt()
        if found is None:
            continue
        last, steps = found, steps + found.iterations
        if found.minimum and found.curve.in_domain(free.positive):
            minima[way] = found
            if not found.hard and number >= len(turning):
                break
        elif free.linear and number == len(turning):
            saddle = _extremal(free, line)
        if limits.expired or quick or saddle:
            break
    costs = {way: found.cost for way, found in minima.items()}
    if not minima:
        assert last is not None
        saddle = saddle or (None if limits.expired or quick else _extremal(free, line))
        return Start(replace(last, reason=_reason(last)), "none", steps, costs, saddle)
    best = min(minima, key=lambda way: minima[way].cost)
    return Start(minima[best], best, steps, costs)


def _extremal(problem: TwoPoint, start: Curve) -> Found | None:
    """What Newton's method finds from a curve, whether a minimum or not."""
    system = System(problem, start.mesh, STAGES)
    outcome = newton(system, start, most=STRAIGHT_THROUGH)
    if outcome is None or not outcome.converged or not outcome.curve.in_domain(problem.positive):
        return None
    return Found(outcome.curve, "saddle", system.cost(outcome.curve), outcome.iterations, True)


def _drawn(problem: TwoPoint, limits: Limits) -> Found | None:
    """The cheapest minimum to which paths lead that are drawn: the straight line may lie between two minima."""
    rng = np.random.default_rng(0)
    found = [from_path(problem, paths.bent(problem, rng, AMPLITUDE), limits, MOST) for _ in range(PATHS)]
    minima = [one for one in found if one.minimum and one.curve.in_domain(problem.positive)]
    best = min(minima, key=lambda one: one.cost, default=None)
    return None if best is None else replace(best, hard=True, iterations=sum(one.iterations for one in found))


def _reason(found: Found) -> str:
    """Why an attempt is no answer."""
    return "the minimum lies outside the domain" if found.minimum else found.reason
