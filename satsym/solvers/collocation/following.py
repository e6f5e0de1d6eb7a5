"""Solutions of a family of problems, from one that is known to one that is wanted, each starting from the last."""

from __future__ import annotations

from collections.abc import Callable

from satsym.solvers.collocation.continuation import corners, through
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits

FOLLOWED = 5
"""Corrections that a step of the continuation usually takes, as its work is counted."""

ROUGHLY = 1e-5
"""Accuracy of solutions on the way."""

SHORTEST = 1.0 / 256.0
"""Shortest step of the continuation, as a share of the way."""

MOST_INTERVALS = 60


def follow(
    problem: Callable[[float], TwoPoint],
    curve: Curve,
    limits: Limits,
    shortest: float = SHORTEST,
    most: int = MOST_INTERVALS,
) -> tuple[Curve, float]:
    """Solutions of a family of problems, from its start to its end, as far as that goes.

    Parameters
    ----------
    problem
        The one at a share of the way.
    curve
        A solution at the start.
    shortest
        Step below which it is given up, as a share of the way.
    most
        Intervals of the mesh, about.

    Returns
    -------
    curve, reached
        The last one, and the share of the way at which it is.
    """
    at, move, count = 0.0, 1.0, max(8, min(len(curve.mesh) - 1, most))
    while at < 1.0 and move >= shortest and not limits.expired:
        there = problem(min(at + move, 1.0))
        mesh = through(corners(there, curve, ROUGHLY), count)
        limits.spend(FOLLOWED * STAGES * len(mesh))
        outcome = newton(System(there, mesh, STAGES), curve.on(mesh, STAGES), tolerance=ROUGHLY, most=10)
        if outcome is None or not outcome.solved or not outcome.curve.in_domain(there.positive):
            move /= 2.0
            continue
        at, curve = min(at + move, 1.0), outcome.curve
        move *= 2.0
        if limits.watch:
            limits.watch(System(there, mesh, STAGES).cost(curve) * there.scale.cost, max(1.0 - at, ROUGHLY))
    return curve, at
