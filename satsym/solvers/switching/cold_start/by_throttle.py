"""Extremals with throttled vectors: arcs of the largest and the least norm, as less and less smoothing shows them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.instance import Guess, Instance
from satsym.solvers.cold_start.directions import bent, directed, fraction_between, levels, stopped
from satsym.solvers.cold_start.origin import Start
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.homotopy import Stopped
from satsym.solvers.switching.cold_start.recognition import guess, sample

SWITCHED = 0.35
"""Share of the time at most for which norms are far from their bounds where a structure is to be recognised."""

SEED, AMPLITUDES = 5, (0.2, 0.5)
"""Of paths that are drawn, and how far they leave the straight line; certificates draw others."""

BESIDE = (0.6, 1.6)
"""Shares of a free duration that was found at which others are looked for."""

CHEAPER = 1e-9
"""By so much of its cost another extremal has to be cheaper."""


def best(instance: Instance, limits: Limits) -> Exact | Stopped:
    """The cheapest extremal that a cold start and a few others lead to, or why there is none."""
    found = directed(instance, limits, True, arcs)
    if isinstance(found, Extremal):
        return Stopped(found.status, found.message, found.problem, found.path)
    for other in others(instance, found.refined.at.end - instance.t0, limits, np.random.default_rng(SEED), BESIDE):
        cost, least = (one.trajectory.cost(instance) for one in (other, found))
        if cost < least - CHEAPER * abs(least):
            found = other
    return found


def others(
    instance: Instance, duration: float, limits: Limits, rng: np.random.Generator, shares: tuple[float, float]
) -> Iterator[Exact]:
    """Extremals from paths that are drawn; or in other durations, where these are free."""
    plain = replace(instance, guess=Guess())
    starts = [partial(bent, plain, rng, amplitude) for amplitude in AMPLITUDES]
    if instance.tf is None:
        starts = [partial(directed, _guessed(plain, share * duration), effort=False) for share in shares]
    for start in starts:
        found = None if limits.expired else tried(partial(start, limits=limits, unsmoothed=arcs))
        if isinstance(found, Exact):
            yield found


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


def _guessed(instance: Instance, duration: float) -> Instance:
    return replace(instance, tf_guess=instance.t0 + duration)
