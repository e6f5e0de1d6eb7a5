"""Extremals with throttled vectors: arcs of the largest and the least norm, as less and less smoothing shows them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from itertools import chain

import numpy as np

from satsym.instance import Guess, Instance
from satsym.solvers.cold_start.directions import bent, directed
from satsym.solvers.failures import FAILURES, tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.arcs_of_norms import arcs
from satsym.solvers.switching.cold_start.by_duration import by_duration
from satsym.solvers.switching.cold_start.by_easier import followed
from satsym.solvers.switching.cold_start.by_turns import other_turns
from satsym.solvers.switching.cold_start.homotopy import Stopped
from satsym.solvers.switching.structure import LOWER, Structure
from satsym.solvers.switching.structure import Guess as Arcs
from satsym.status import Status

SEED, AMPLITUDES = 5, (0.2, 0.5)
"""Of paths that are drawn, and how far they leave the straight line; certificates draw others."""

POINTS, NEAR, FAINT = 401, 1e-3, 1e-9
"""Times at which a motion without any control is looked at, by how much of its size it may miss an end, and costates
of ends that it meets, relative to sizes."""

NEARER = 0.5
"""By so much nearer to the straight line, or to the duration, further starts are than the ones before."""

BESIDE = (0.6, 1.6)
"""Shares of a free duration that was found at which others are looked for."""

CHEAPER = 1e-9
"""By so much of its cost another extremal has to be cheaper."""


def best(instance: Instance, limits: Limits) -> Exact | Stopped:
    """The cheapest extremal that a cold start and a few others lead to, or why there is none."""
    found = _first(instance, limits)
    if isinstance(found, Stopped):
        return found
    drawn = others(instance, found.refined.at.end - instance.t0, limits, np.random.default_rng(SEED), BESIDE)
    states = np.concatenate([z[: len(instance.initial)] for _, _, z, _ in found.trajectory.points], axis=1)
    around = other_turns(instance, states, limits)
    for other in filter(None, chain(drawn, around)):
        cost, least = (one.trajectory.cost(instance) for one in (other, found))
        if cost < least - CHEAPER * abs(least):
            found = other
    return found


def _first(instance: Instance, limits: Limits) -> Exact | Stopped:
    """The extremal to which a cold start leads; where the time is given, perhaps by way of an easier problem."""
    idle = coasting(instance, limits)
    if idle is not None:
        return idle
    found = _led(instance, limits, False)
    if isinstance(found, Exact):
        return found
    timed = by_duration(instance, limits) if instance.tf is None and not instance.guess else None
    if timed is not None:
        return timed
    message = ""
    near = followed(instance, limits) if instance.tf is not None and not instance.guess else None
    if near is not None and not near.fraction:
        return near.exact
    if near is not None and near.saturated:
        message = f"; norms {near.norms:.6g} times as large are the minimum with which an extremal arrives in time"
    else:
        thorough = _led(instance, limits, True)
        if isinstance(thorough, Exact):
            return thorough
    return replace(found, message=found.message + message)


def _led(instance: Instance, limits: Limits, effort: bool) -> Exact | Stopped:
    """Where the regularised problem leads, or why nowhere; its numbers fail where no slope decides a direction."""
    try:
        found = directed(instance, limits, effort, arcs)
    except FAILURES as error:
        message = f"no regularised solution was found: {error}"
        if limits.expired:
            return Stopped(Status.TIME_LIMIT, f"time was up: {message}")
        return Stopped(Status.NOT_CONVERGED, message)
    return found if isinstance(found, Exact) else Stopped(found.status, found.message, found.problem, found.path)


def coasting(instance: Instance, limits: Limits) -> Exact | None:
    """No norms at all for the whole of a given time, where that arrives and is an extremal."""
    least = instance.control_set.switching[0]
    if instance.tf is None or any(least):
        return None
    n, p, model = len(instance.initial), instance.parameters, instance.model
    times, none = np.linspace(instance.t0, instance.tf, POINTS), np.zeros((len(model.spec.controls), POINTS))
    x, middle, _ = model.forward(times, instance.initial, none, none[:, 1:], p)
    fixed = [(i, instance.final[name]) for i, name in enumerate(model.spec.state_names) if name in instance.final]
    size = np.abs(x).max(axis=1)
    size = np.where(size > NEAR * size.max(), size, size.max())
    if any(isinstance(end, float) and not abs(x[i, -1] - end) <= NEAR * size[i] for i, end in fixed):
        return None
    given = np.array([name in instance.final for name in model.spec.state_names])
    slope = np.array(model.terminal_gradient(instance.tf, tuple(x[:, -1].tolist()), p))
    end = np.where(given, FAINT / size, slope)  # any that are small enough do, but where all vanish nothing has a slope
    lam, _ = model.backward(times, tuple(end.tolist()), x, middle, none, none[:, 1:], p)
    costates = lam[:, 0] if np.isfinite(lam).all() else np.zeros(n)
    found = attempt(instance, Arcs(Structure(((LOWER,),) * len(least)), np.zeros(0), costates, instance.tf), limits)
    return None if found is None else replace(found, origin=Origin.REST)


def others(
    instance: Instance,
    duration: float,
    limits: Limits,
    rng: np.random.Generator,
    shares: tuple[float, float],
    further: int = 0,
) -> Iterator[Exact | None]:
    """Extremals from paths that are drawn; or in other durations, where these are free. ``None`` for each that fails.

    Parameters
    ----------
    shares
        Of the duration, where it is free.
    further
        Starts at most as long as none has led to an extremal: whether a single one does may hang on the last digit.
    """
    plain, answered = replace(instance, guess=Guess()), False
    for number in range(len(AMPLITUDES) + further):
        if number >= len(AMPLITUDES) and answered:
            return
        which, nearer = number % len(AMPLITUDES), NEARER ** (number // len(AMPLITUDES))
        start = partial(bent, plain, rng, nearer * AMPLITUDES[which])
        if instance.tf is None:
            beside = _guessed(plain, (1.0 + nearer * (shares[which] - 1.0)) * duration)
            start = partial(directed, beside, effort=False)
        found = None if limits.expired else tried(partial(start, limits=limits, unsmoothed=arcs))
        answered = answered or isinstance(found, Exact)
        yield found if isinstance(found, Exact) else None


def _guessed(instance: Instance, duration: float) -> Instance:
    return replace(instance, tf_guess=instance.t0 + duration)
