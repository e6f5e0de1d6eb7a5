"""Extremals with throttled vectors of other numbers of revolutions than one that is known, in its duration.

What is found elsewhere, such as along a path that is drawn, goes round as often as the start did: each number of
revolutions has a minimum of its own, and the cheapest is not next to the others.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from satsym.arrays import Array
from satsym.instance import Guess, Instance
from satsym.solvers.cold_start.directions import directed_from
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.cold_start.path_of_problems import along_turns
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.control.regularised import regularised
from satsym.solvers.control.slopes import full_length_smoothing
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact
from satsym.solvers.switching.cold_start.arcs_of_norms import arcs
from satsym.solvers.symmetry import Spiral, other_spirals

MOST = 4
"""Numbers of revolutions that are tried, that of the known one among them."""

WORK = 150_000
"""Columns that may be linearised for each of them: an extremal of three revolutions takes some 120 000."""


def other_turns(instance: Instance, states: Array, limits: Limits) -> Iterator[Exact | None]:
    """An extremal for each other number of revolutions, or ``None``; nothing where no symmetry tells how to go round.

    Parameters
    ----------
    instance
        With a given final time.
    states
        Of the extremal that is known, shape (n, M).
    """
    if instance.tf is None:
        return
    plain = replace(instance, guess=Guess())
    eased = regularised(plain, full_length_smoothing(instance), 0.0)  # at first norms cost nothing
    problem = two_point(eased, instance.tf - instance.t0)
    for spiral in other_spirals(problem, states, MOST):
        yield None if limits.expired else tried(partial(_around, plain, problem, spiral, limits))


def _around(instance: Instance, problem: TwoPoint, spiral: Spiral, limits: Limits) -> Exact | None:
    """The extremal to which a spiral leads."""
    few = replace(limits, work=min(limits.work, limits.meter.spent + WORK))
    near = along_turns(problem.relaxed(float("inf")), spiral, few)
    if not near.minimum or not near.curve.in_domain(problem.positive):
        return None
    found = directed_from(problem, Start(near, Origin.SPIRAL, near.iterations, spiral.turns), instance, few, arcs)
    return found if isinstance(found, Exact) else None
