"""Searches for one competitor: from a path of states, within bounds, made accurate where it may be cheaper."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from satsym.arrays import Array
from satsym.instance import Guess
from satsym.solution import Solution
from satsym.solvers.certificate.comparison import SAME, Competitor
from satsym.solvers.iteration import Limits

if TYPE_CHECKING:
    from satsym.solvers.certificate.seeded.answer import Answer
    from satsym.solvers.collocation.attempt import Attempt
    from satsym.solvers.collocation.curve import Curve
    from satsym.solvers.collocation.linearised import Linearised
    from satsym.solvers.collocation.problem import TwoPoint

ROUGH = 1e-2
"""Relative error of costs on the mesh of a cold start."""

Search = Callable[[Limits], Competitor | None]
"""Looks for a competitor that is cheaper than a cost, or says what it costs roughly."""


def at_its_duration(solution: Solution) -> TwoPoint:
    """The problem of a solution at its duration, without its guess."""
    from satsym.solvers.collocation.scaling import two_point

    instance, lasting = solution.instance, float(solution.times[-1]) - solution.instance.t0
    return two_point(replace(instance, tf=instance.t0 + lasting, tf_guess=None, guess=Guess()), lasting)


def from_path(
    problem: TwoPoint,
    path: Callable[[Any], Any],
    softness: float,
    cost: float,
    most: int | None = None,
    answer: Answer | None = None,
) -> Search:
    """The minimum within the bounds to which a path of states leads.

    Parameters
    ----------
    softness
        Of the bounds at first.
    cost
        That of the solution.
    most
        Steps of the minimisation.
    answer
        The solution, of the same problem: a search that is led to it need not find it once more.
    """
    from satsym.solvers.cold_start.soft_bounds import TRIED, within_bounds
    from satsym.solvers.collocation.attempt import Reason

    def attempt(limits: Limits) -> Competitor | None:
        known = answer.near if answer and softness == 1.0 else None
        found = within_bounds(problem, path, limits, softness, most or TRIED, known.leads if known else None)
        if answer and found.reason is Reason.KNOWN:
            return answer.once_more
        at_hand = None if problem.control_set.bounded else found.linearised
        return accurate(problem, found.curve, cost, at_hand) if found.solved else None

    return attempt


def from_near(problem: TwoPoint, z: Array, cost: float) -> Search:
    """The extremal next to states and costates, shape (2n, M), that are nearly one of the problem's duration."""
    from satsym.solvers.cold_start.by_newton import by_newton

    def attempt(limits: Limits) -> Competitor | None:
        found = by_newton(problem, z / problem.scale.both)
        return None if found is None else accurate(problem, found.curve, cost)

    return attempt


def bounded(problem: TwoPoint, found: Attempt, cost: float, limits: Limits) -> Competitor | None:
    """The minimum within the bounds to which one without them leads."""
    from satsym.solvers.cold_start.soft_bounds import within_found

    if not found.minimum or not found.curve.in_domain(problem.positive):
        return None
    rough = Competitor(problem, found.curve, found.cost * problem.scale.cost)
    if rough.cost > cost + ROUGH * abs(cost):  # what costs more without the bounds does so within them
        return rough
    inside = within_found(problem, found, limits)
    return accurate(problem, inside.curve, cost) if inside.solved else None


def accurate(problem: TwoPoint, curve: Curve, cost: float, known: Linearised | None = None) -> Competitor | None:
    """A minimum with its cost, as rough as its mesh where it clearly exceeds another cost.

    Parameters
    ----------
    known
        The linearised equations there, if they are at hand and no bound is met.
    """
    from satsym.solvers.collocation.accuracy.refinement import refine
    from satsym.solvers.collocation.continuation import kept
    from satsym.solvers.collocation.system import System

    rough = System(problem, curve.mesh, curve.order).cost(curve) * problem.scale.cost
    if rough > cost + ROUGH * abs(cost):
        return Competitor(problem, curve, rough)
    refined = refine(problem, curve, SAME, keep_nodes=not kept(problem, curve), known=known)
    if not refined.solved or not refined.curve.in_domain(problem.positive):
        return None
    return Competitor(problem, refined.curve, refined.cost * problem.scale.cost)
