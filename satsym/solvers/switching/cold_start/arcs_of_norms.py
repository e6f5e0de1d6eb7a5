"""Exact arcs of throttled vectors, as less and less smoothing shows them."""

from __future__ import annotations

from dataclasses import replace

from satsym.instance import Instance
from satsym.solvers.cold_start.directions import fraction_between, levels, stopped
from satsym.solvers.cold_start.origin import Start
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.recognition import guess, sample

SWITCHED = 0.35
"""Share of the time at most for which norms are far from their bounds where a structure is to be recognised."""


def arcs(problem: TwoPoint, instance: Instance, curve: Curve, _start: Start, limits: Limits) -> Exact | Extremal:
    """Exact arcs as smoothed extremals show them, the first that satisfy the minimum principle."""
    for near in levels(problem, instance, curve, limits):
        problem, curve = near
        if fraction_between(problem, curve) <= SWITCHED:
            exact = attempt(instance, guess(instance, sample(problem, curve)), limits)
            if exact is not None:
                return replace(exact, origin=Origin.SMOOTHED, smoothing=problem.control_set.smoothing)
        if limits.expired:
            break
    message = "no structure recognised in regularised solutions satisfies Pontryagin's minimum principle"
    if fraction_between(problem, curve) > SWITCHED:
        message = "for some time nothing decides the norm of a vector, and no law is known there"
    return stopped(problem, instance, curve, message, limits)
