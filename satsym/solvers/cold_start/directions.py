"""From a cold start to an extremal whose controls are directions: angles, or vectors of full length in a ball.

The law of a direction says nothing where costates vanish, which is where every cold start begins. In the regularised
problem, directions may be shorter and their squares cost a little: without bounds it is one of least effort, which is
solved from a cold start. Its bounds are then brought in and the smoothing is taken away, each step from the last
solution, until every direction has its full length: that is an extremal of the problem itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import TypeVar

import numpy as np

from satsym.arrays import Array
from satsym.instance import Guess, Instance
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.duration_trials import Trials
from satsym.solvers.cold_start.durations import free_duration, time_scale
from satsym.solvers.cold_start.first_minimum import cold_start
from satsym.solvers.cold_start.from_path import from_path
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.following import follow
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.newton import newton
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.collocation.system import System
from satsym.solvers.control.regularised import regularised
from satsym.solvers.control.slopes import full_length_smoothing, gain, slope
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.status import Status

LEVELS = 16
TIGHTER = 4.0
"""By so much less is smoothed at each level."""

SMOOTHER = (1.0, 30.0, 1e3)
"""Factors of the first smoothing that are tried."""

SAMPLES = 401
"""Times at which the length of directions is looked at."""

DIRECTIONS, TIMES = 24, (1e-3, 1e3)
"""Directions in which motions are simulated, and for how long, in units of the motion's own time scale."""

NEARER = 1e-6
"""By this share a motion has to come nearer to the end than one that is known, to be taken instead."""

FAR = 0.03
"""Share of the width of its range by which a norm is far from a bound."""

FULL, BRIEF = 1e-9, 0.03
"""By this share a direction may be short of its length, and for this share of the time it may be shorter: where the
slope of H vanishes for an instant only, such as at an end that leaves velocities free, smoothing never ends to show."""

FINER, FINELY = (30, 60), 3
"""Intervals that are tried besides those of a smoothed extremal, and how often: a direction that turns round where the
slope of H is small does so in less time than these take, and Newton's method then finds nothing on them."""


Exact = TypeVar("Exact")

Unsmoothed = Callable[[TwoPoint, Instance, Curve, Start, Limits], Exact | Extremal]
"""From an extremal within the bounds that is smoothed to one that is not."""


def directed(instance: Instance, limits: Limits, effort: bool, unsmoothed: Unsmoothed[Exact]) -> Exact | Extremal:
    """An extremal of the problem itself within the bounds, or how far one got.

    Parameters
    ----------
    instance
        Of a problem in which some controls are directions.
    limits, effort
        When to stop, and whether free durations are looked for with great effort.
    unsmoothed
        What makes a smoothed extremal one of the problem.
    """
    found: Exact | Extremal | None = None
    for one, much, factor in _begun(instance, effort):
        if limits.expired:
            break
        smoothing = factor * full_length_smoothing(instance)
        again = tried(partial(_directed, one, instance, smoothing, limits, much, unsmoothed))
        if again is not None and not isinstance(again, Extremal):
            return again
        found = found or again
    if found is None:
        raise ArithmeticError("the equations of the regularised problem are singular")
    return found


def _begun(instance: Instance, effort: bool) -> Iterator[tuple[Instance, bool, float]]:
    """What one starts from, and by which factor more is smoothed: a motion in one direction where a state is free.

    The straight line does not move such a state, and where nothing moves directions may do nothing. More is smoothed
    where that leads nowhere: what directions of any length may do together with states can be worth more than their
    squares cost. What takes great effort comes last. The motion is simulated when its turn comes.
    """
    starts: list[Callable[[], Instance | None]] = [lambda: instance, cache(partial(steered, instance))]
    if len(instance.final) < len(instance.initial):
        starts.reverse()
    turns = [(False, factor) for factor in SMOOTHER] + ([(True, 1.0)] if effort else [])
    for much, factor in turns:
        for start in starts:
            if (one := start()) is not None:
                yield one, much, factor


def _directed(
    started: Instance, instance: Instance, smoothing: float, limits: Limits, effort: bool, unsmoothed: Unsmoothed[Exact]
) -> Exact | Extremal:
    """The same from what one instance guesses, and this smoothing."""
    eased = regularised(started, smoothing, _first_share(instance))
    if eased.tf is None:
        chosen = free_duration(eased, limits, effort)
        if isinstance(chosen, Extremal):
            return _without_duration(chosen, instance)
        problem, start = chosen.problem, chosen.start
    else:
        problem = two_point(eased, eased.tf - eased.t0)
        start = cold_start(problem, limits, quick=not effort)
        if not start.found.minimum:
            return stopped(problem, instance, start.found.curve, f"no extremal found: {start.found.message}", limits)
    return directed_from(problem, start, instance, limits, unsmoothed)


def _without_duration(chosen: Extremal, instance: Instance) -> Extremal:
    """No duration of the regularised problem, which says little about the problem itself."""
    status, message = chosen.status, chosen.message
    if status is Status.NO_MINIMISER:
        status, message = Status.NOT_CONVERGED, "no duration was found; give a tf_guess"
    message = f"of the regularised problem from which one starts: {message}"
    return replace(chosen, problem=_exact(chosen.problem, instance), status=status, message=message)


def steered(instance: Instance) -> Instance | None:
    """An instance that starts from the motion in one direction which comes nearest to the end, at the time it does.

    ``None`` with a guess of its own, where nothing is asked of the end, or where no direction comes nearer to it.
    """
    fixed = [i for i, name in enumerate(instance.model.spec.state_names) if isinstance(instance.final.get(name), float)]
    if instance.guess or not fixed:
        return None
    times = instance.t0 + _times(instance)
    target = np.array([instance.final[instance.model.spec.state_names[i]] for i in fixed], dtype=float)
    unit = np.maximum(np.abs(target), np.abs(np.array(instance.initial)[fixed]))
    unit = np.where(unit > 0.0, unit, unit.max(initial=0.0) or 1.0)
    best: tuple[float, int, Array] | None = None
    for direction in np.linspace(0.0, 2.0 * np.pi, DIRECTIONS, endpoint=False):
        u = np.repeat(_in_direction(instance, direction)[:, None], len(times), axis=1)
        x = np.array(instance.model.forward(times, instance.initial, u, u[:, 1:], instance.parameters)[0])
        missed = np.abs((x[fixed] - target[:, None]) / unit[:, None]).max(axis=0)
        missed[~np.isfinite(missed)] = np.inf
        at = int(missed[1:].argmin()) + 1 if instance.tf is None else len(times) - 1
        nearer = (best is None or missed[at] < (1.0 - NEARER) * best[0]) and at > 1
        if nearer and np.isfinite(x[:, : at + 1]).all():
            best = float(missed[at]), at, x[:, : at + 1]
    if best is None:
        return None
    _, at, x = best
    even = np.linspace(times[0], times[at], SAMPLES)
    rows = [tuple(np.interp(even, times[: at + 1], row).tolist()) for row in x]
    guess = Guess(state=dict(zip(instance.model.spec.state_names, rows, strict=True)))
    return replace(instance, guess=guess, tf_guess=None if instance.tf is not None else float(times[at]))


def _times(instance: Instance) -> Array:
    """From the start to the end, or, where that is free, far beyond what the motion's own scale and a guess tell."""
    if instance.tf is not None:
        return np.linspace(0.0, instance.tf - instance.t0, SAMPLES)
    if instance.tf_guess is not None:
        return np.linspace(0.0, 2.0 * (instance.tf_guess - instance.t0), SAMPLES)
    eased = regularised(instance, full_length_smoothing(instance), 1.0)
    return np.append(0.0, time_scale(eased) * np.geomspace(*TIMES, 2 * SAMPLES))


def _in_direction(instance: Instance, direction: float) -> Array:
    """Controls with all directions turned by an angle, in the plane of their first two components, others at rest."""
    u = np.zeros(len(instance.model.spec.controls))
    for places, part in instance.control_set.parts:
        if part.kind == "angle":
            u[places[0]] = direction
        elif part.directed and part.kind == "box":
            u[places[0]] = part.levels[int(np.cos(direction) > 0.0)]
        elif part.directed:
            both = part.radius * np.array([np.cos(direction), np.sin(direction)])
            u[list(places[:2])] = both[: len(places)]
    return np.asarray(instance.control_set.project(u[:, None])[:, 0])


def bent(
    instance: Instance,
    rng: np.random.Generator,
    amplitude: float,
    limits: Limits,
    unsmoothed: Unsmoothed[Exact],
    lasting: float | None = None,
    known: Callable[[Curve], Exact | Extremal | None] = lambda _: None,
) -> Exact | Extremal:
    """The same from a path that is drawn.

    Parameters
    ----------
    lasting
        Its duration, where the final time is free.
    known
        To what an extremal without bounds in that duration has led before, if it has.
    """
    lasting = instance.tf - instance.t0 if instance.tf is not None else lasting
    assert lasting is not None
    waves = rng.integers(2**32)
    for factor in SMOOTHER:
        eased = regularised(instance, factor * full_length_smoothing(instance), _first_share(instance))
        trials = Trials(eased, limits, lasting)
        problem = trials.given(lasting)
        found = from_path(problem, paths.bent(problem, np.random.default_rng(waves), amplitude), limits)
        if not found.minimum:
            continue
        if (before := known(found.curve)) is not None:
            return before
        start = Start(found, Origin.DRAWN, found.iterations)
        if instance.tf is not None:
            return directed_from(problem, start, instance, limits, unsmoothed)
        chosen = trials.freed_from(problem, start)
        if chosen is None:
            break
        return directed_from(chosen.problem, chosen.start, instance, limits, unsmoothed)
    return stopped(problem, instance, found.curve, found.message, limits)


def directed_from(
    problem: TwoPoint, start: Start, instance: Instance, limits: Limits, unsmoothed: Unsmoothed[Exact]
) -> Exact | Extremal:
    """The same from a minimum of the regularised problem without bounds."""
    curve = start.found.curve
    longest = max(_longest(problem, curve), 0.0)

    def bounded(fraction: float) -> TwoPoint:
        return problem.relaxed((1.0 - fraction) * longest)

    curve, reached = follow(bounded, curve, limits)
    if reached < 1.0:
        return stopped(problem, instance, curve, Reason.BLOCKED.value.format(min(reached, 0.99)), limits)
    problem = problem.relaxed(0.0)
    smoothing = problem.control_set.smoothing

    def weighed(fraction: float) -> TwoPoint:
        return replace(problem, instance=regularised(instance, smoothing, fraction))

    if instance.model.spec.throttled:
        curve, reached = follow(weighed, curve, limits)
        if reached < 1.0:
            message = f"what the norm of a vector costs could be brought in only {reached:.0%}"
            return stopped(problem, instance, curve, message, limits)
        problem = weighed(1.0)
    return unsmoothed(problem, instance, curve, replace(start, bounded=True), limits)


def _first_share(instance: Instance) -> float:
    """Of what norms cost, at first: with it the law is flat where costates vanish."""
    return 0.0 if instance.model.spec.throttled else 1.0


def levels(problem: TwoPoint, instance: Instance, curve: Curve, limits: Limits) -> Iterator[tuple[TwoPoint, Curve]]:
    """Extremals that are smoothed less and less, from one that is smoothed, as far as that leads."""
    yield problem, curve
    smoothing = problem.control_set.smoothing
    for _ in range(LEVELS):
        before = smoothing

        def sharper(fraction: float, before: float = before, problem: TwoPoint = problem) -> TwoPoint:
            return replace(problem, instance=regularised(instance, before * TIGHTER**-fraction, 1.0))

        curve, reached = follow(sharper, curve, limits)
        if reached == 0.0:
            return
        smoothing *= TIGHTER**-reached
        problem = replace(problem, instance=regularised(instance, smoothing, 1.0))
        yield problem, curve


def full_length(
    problem: TwoPoint, instance: Instance, curve: Curve, start: Start, limits: Limits
) -> tuple[TwoPoint, Start] | Extremal:
    """An extremal of low order with directions of full length all the time, and its problem, from a smoothed one."""
    exact, count, brief = _exact(problem, instance), 0, 0
    for near in levels(problem, instance, curve, limits):
        (problem, curve), count = near, count + 1
        if _share_short(problem, curve) <= BRIEF:
            brief += 1
            found = _nearby(exact, curve, (0, *FINER) if brief <= FINELY else (0,))
            if found is not None:
                return exact, replace(start, found=found, steps=start.steps + found.iterations)
    message = "the slope of H by a direction vanishes for some time, and no law is known there"
    if count <= LEVELS:
        message = f"a regularisation below {problem.control_set.smoothing:.1e} was not reached"
        if 0.0 < _share_short(problem, curve) < 1.0:
            message = f"a direction seems to turn round where the slope of H passes through zero; {message}"
    if instance.model.spec.throttled:
        message = 'a vector has not its full length all the time: use method "bang-bang"'
    return stopped(problem, instance, curve, message, limits)


def _nearby(exact: TwoPoint, curve: Curve, intervals: tuple[int, ...]) -> Attempt | None:
    """The extremal next to a smoothed one, on its own mesh or on one of so many intervals."""
    for count in intervals:
        mesh = np.linspace(0.0, 1.0, count + 1) if count else curve.mesh
        outcome = newton(System(exact, mesh, STAGES), curve.on(mesh, STAGES))
        if outcome is not None and outcome.solved:
            return Attempt(
                outcome.curve, Reason.MINIMUM, outcome.iterations, System(exact, mesh, STAGES).cost(outcome.curve)
            )
    return None


def _exact(problem: TwoPoint, instance: Instance) -> TwoPoint:
    """The problem itself, in the units of the regularised one, with its final time as that has it."""
    tf, tf_guess = problem.instance.tf, problem.instance.tf_guess
    return replace(problem, instance=replace(instance, tf=tf, tf_guess=tf_guess), relaxation=0.0)


@dataclass(frozen=True, eq=False)
class _Length:
    """The length of a direction along a curve, or a single control that switches, and the bounds of it."""

    low: float
    high: float
    values: Array


def _lengths(problem: TwoPoint, curve: Curve) -> list[_Length]:
    """Those of all directions."""
    tau = np.linspace(0.0, 1.0, SAMPLES)
    within = problem.control_set
    z, t = curve(tau) * problem.scale.both, problem.instance.t0 + problem.elapsed(curve.theta) * tau
    n = problem.states
    stated = problem.instance.control_set
    found = []
    for k, (places, part) in enumerate(within.parts):
        if not part.directed:
            continue
        by = slope(problem.instance, places, t, z[:n], z[n:])[0] if part.kind == "box" else None
        longer = gain(problem.instance, places, t, z[:n], z[n:]) if by is None else -by
        (low, high), whole = (one.levels if one.throttled else (0.0, one.radius) for one in (part, stated.parts[k][1]))
        found.append(_Length(*whole, np.clip(longer / stated.smoothing, low, high)))
    return found


def _longest(problem: TwoPoint, curve: Curve) -> float:
    """By how much directions without bounds exceed their length at most, or single controls their bounds."""
    found = _lengths(problem.relaxed(float("inf")), curve)
    return max(max(float(one.values.max()) - one.high, one.low - float(one.values.min())) for one in found)


def fraction_between(problem: TwoPoint, curve: Curve) -> float:
    """The largest share of the time for which what switches, such as a norm, is far from both of its bounds."""

    def share(one: _Length) -> float:
        off = FAR * (one.high - one.low)
        return float(((one.values > one.low + off) & (one.values < one.high - off)).mean())

    return max(map(share, _lengths(problem, curve)), default=0.0)


def _share_short(problem: TwoPoint, curve: Curve) -> float:
    """The largest share of the time for which a direction has not its full length."""
    found = (float((one.values < (1.0 - FULL) * one.high).mean()) for one in _lengths(problem, curve))
    return max(found, default=0.0)


def stopped(problem: TwoPoint, instance: Instance, curve: Curve, message: str, limits: Limits) -> Extremal:
    """No extremal, and why."""
    status = Status.TIME_LIMIT if limits.expired else Status.NOT_CONVERGED
    words = f"time was up: {message}" if limits.expired else message
    return Extremal(_exact(problem, instance), curve, float("inf"), status, words, 0)
