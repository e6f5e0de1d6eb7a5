"""From a path of states to a minimum: the mesh is laid anew as the curve takes shape."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from satsym.arrays import Array
from satsym.solvers.cold_start import paths
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.sqp import minimise
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits, Meter

STRAIGHT_THROUGH = 15
"""Steps within which the straight line leads to a minimum if it does so easily."""

ROUGHLY, TOLERANCE = 3e-2, 1e-7
"""Sizes of the last step: after the first the mesh is laid anew if the way was hard, the other ends the minimisation.
"""

FEWER = 3
"""Stages with which it is looked at first whether a path leads to what is known: that need not be found accurately."""


def from_path(
    problem: TwoPoint,
    path: Callable[[Array], Array],
    limits: Limits,
    most: int = STRAIGHT_THROUGH,
    arrived: Callable[[Curve], bool] | None = None,
) -> Attempt:
    """Minimise from a path of states; the mesh is laid anew as the curve takes shape.

    Parameters
    ----------
    path
        Shape (n, M) for M times.
    most
        Steps.
    arrived
        Whether a curve leads to what is known, which then ends the search.
    """
    if arrived is not None:
        led = _minimised(problem, path, replace(limits, meter=Meter()), most, arrived, FEWER)
        if led.reason is Reason.KNOWN:
            limits.spend(led.curve.flat.shape[1] * led.iterations)
            return led
    return _minimised(problem, path, limits, most, arrived, STAGES)


def _minimised(
    problem: TwoPoint,
    path: Callable[[Array], Array],
    limits: Limits,
    most: int,
    arrived: Callable[[Curve], bool] | None,
    order: int,
) -> Attempt:
    """Minimise the cost from the path with so many stages; with fewer than all, what is found is rough."""
    curve = paths.curve(problem, path).with_stages(order)
    steps, hard, tolerance = 0, False, ROUGHLY
    while True:
        system = System(problem, curve.mesh, order)
        found = minimise(system, curve, limits, tolerance, max(most - steps, 1), meshes.COARSEST, arrived)
        steps, hard = steps + found.iterations, hard or found.hard
        found = replace(found, iterations=steps, hard=hard)
        extremal = found.reason in (Reason.MINIMUM, Reason.SADDLE)
        if not (extremal or found.reason is Reason.OUTGROWN) or not found.curve.in_domain(problem.positive):
            return found
        if extremal and (tolerance == TOLERANCE or order == FEWER):
            return found
        if steps >= most or limits.expired:
            return replace(found, reason=Reason.NO_CONVERGENCE, facts=(steps,))
        tolerance = TOLERANCE if extremal else ROUGHLY
        curve = found.curve if extremal and not hard else found.curve.on(meshes.laid(problem, found.curve), order)
