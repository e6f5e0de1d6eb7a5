"""Method "bang-bang": from a cold start to exact arcs and switching times."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import chain

import numpy as np

from satsym.instance import Instance
from satsym.solution import Iteration, Progress, Solution
from satsym.solvers.failures import tried, unbroken
from satsym.solvers.iteration import Limits, watched
from satsym.solvers.nearest_end import nearest
from satsym.solvers.switching.answers import answered, without
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.by_meetings import meetings
from satsym.solvers.switching.by_smoothing import smoothed
from satsym.solvers.switching.chattering import at_rest, chattered
from satsym.solvers.switching.cold_start import by_costates, by_scouts, by_throttle, homotopy, minimum_effort
from satsym.solvers.switching.cold_start import saturated as held
from satsym.solvers.switching.cold_start.recognition import guess, sample
from satsym.solvers.switching.linear import by_reach
from satsym.solvers.switching.magnitudes import costs, moving
from satsym.solvers.switching.minimum_time import minimum_time
from satsym.solvers.switching.refusals import refuse, refuse_angles
from satsym.solvers.switching.structure import REST, UPPER, Guess, Structure
from satsym.solvers.switching.variants import neighbours
from satsym.status import Status

ENOUGH = 1e-9
"""By this share of it a given time may fall short of the least."""

COMPARED = 100_000
"""Columns for which at most an extremal that may have more arcs is looked for, where free ends have one already."""

BESIDE, COMPARED_BESIDE = (0.02, 0.05, 0.12, 0.3, 0.7), (0.035, 0.08, 0.2, 0.45, 0.85, 1.3)
"""Shares of a duration that was found, at which others are looked for by the solver and by certificates."""

MEETING = 5
"""Seed of costates that are drawn; certificates draw others."""

ADOPTED = 3
"""Times that something cheaper is looked for, as long as there is."""

GIVEN = np.sqrt(2.0) ** np.arange(-8.0, 5.0)
"""Durations that are given in turn where a free one is not found, as shares of the motion's own time scale."""

LONGER = (1.3, 1.7, 2.5)
"""Durations in which infinitely many switches are looked for, relative to one that was found."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve a switching problem.

    Parameters
    ----------
    instance
        Of a model whose controls enter the Hamiltonian affinely, with both bounds for each.
    progress
        Called after each step of the continuation, and each attempt at exact arcs.

    Returns
    -------
    Solution
        Times hold each switching time twice: the last instant of one arc and the first of the next.

    Raises
    ------
    BadInput
        If a bound is missing, or the motion starts where it is to end.
    """
    if instance.model.spec.throttled:
        return _throttled(instance, progress)
    refuse(instance)
    began = time.perf_counter()
    limits, history = watched(instance, progress)
    with np.errstate(all="ignore"):
        found = _found(instance, limits)
        endless = _endless(instance, found, limits)
        if endless is not None:
            limits.tell(endless.objective, history[-1].residual if history else math.nan)
            return replace(endless, iterations=len(history), history=tuple(history), wall_s=time.perf_counter() - began)
        if isinstance(found, homotopy.Stopped):
            found = _by_least_time(instance, found, limits)
        if isinstance(found, homotopy.Stopped):
            return without(instance, _advised(instance, _out_of_reach(found, limits)), tuple(history), began)
        return _finished(instance, found, limits, history, began)


def _throttled(instance: Instance, progress: Progress | None) -> Solution:
    """Solve a problem of vectors that are throttled, unless they have their full norms all the time."""
    refuse_angles(instance)
    began = time.perf_counter()
    limits, history = watched(instance, progress)
    with np.errstate(all="ignore"):
        found = by_throttle.best(instance, limits)
        found = _out_of_reach(found, limits) if isinstance(found, homotopy.Stopped) else found
    if not isinstance(found, homotopy.Stopped) and all(row == (UPPER,) for row in found.refined.structure.levels):
        found = homotopy.Stopped(Status.NOT_CONVERGED, 'nothing switches: use method "collocation"')
    if isinstance(found, homotopy.Stopped):
        return without(instance, found, tuple(history), began)
    return _finished(instance, found, limits, history, began)


def _finished(instance: Instance, found: Exact, limits: Limits, history: list[Iteration], began: float) -> Solution:
    """The answer, whose cost is told last: on the way other problems were solved, and other arcs."""
    limits.tell(found.trajectory.cost(instance), found.refined.residual)
    return answered(instance, found, tuple(history), began)


def _endless(instance: Instance, found: Exact | homotopy.Stopped, limits: Limits) -> Solution | None:
    """What infinitely many switches lead to; where the final time is free, in a longer one if that is cheaper."""
    if not instance.model.spec.chattering:
        return None
    if isinstance(found, homotopy.Stopped) and found.chattering:
        return chattered(instance, found.chattering, limits)
    if instance.tf is not None:
        return None
    known = None if isinstance(found, homotopy.Stopped) else found
    duration = minimum_effort.first_duration(instance) if known is None else known.refined.at.end - instance.t0
    for factor in LONGER:
        given = replace(instance, tf=instance.t0 + factor * duration, tf_guess=None)
        near = None if limits.expired else smoothed(given, limits)
        if isinstance(near, homotopy.Stopped) and near.chattering:
            endless = chattered(instance, near.chattering, limits)
            if endless is None or not at_rest(endless):
                return None
            cheaper = known is None or endless.objective < known.trajectory.cost(instance)
            return replace(endless, message=f"{endless.message}; a longer time costs the same") if cheaper else None
    return None


def _by_least_time(instance: Instance, stopped: homotopy.Stopped, limits: Limits) -> Exact | homotopy.Stopped:
    """What the least time says: a structure where the given one is hardly longer, or that it is too short.

    The latter where the motion is linear: only there is it known that nothing arrives earlier.
    """
    hurried = minimum_time(instance) if instance.tf is not None and instance.final and not limits.expired else None
    found = _found(hurried, limits) if hurried is not None else stopped
    if isinstance(found, homotopy.Stopped) or instance.tf is None or hurried is None:
        return stopped
    least, given, name = found.refined.at.end - instance.t0, instance.tf - instance.t0, found.refined.structure.name
    if found.origin is Origin.REACH and least > given * (1.0 + ENOUGH):
        message = (
            f"the minimum time to the given end is {least:.10g} (structure {name}), and only {given:.10g} is given"
        )
        return replace(stopped, status=Status.INFEASIBLE, message=message)
    near = attempt(instance, _with_coasts(instance, found), limits) if least < given else None
    if near is not None:
        return replace(near, origin=Origin.MINIMUM_TIME)
    if stopped.status is Status.INFEASIBLE:
        return stopped
    alone = ", and at that only one control arrives, whatever it costs" if abs(given / least - 1.0) <= ENOUGH else ""
    message = f"{stopped.message}; the minimum time to the given end is {least:.10g} (structure {name}){alone}"
    return replace(stopped, message=message)


def _out_of_reach(stopped: homotopy.Stopped, limits: Limits) -> homotopy.Stopped:
    """Why there is no answer: where the final time is given, perhaps that no control arrives."""
    if stopped.status is not Status.NOT_CONVERGED or stopped.problem is None or stopped.curve is None:
        return stopped
    problem, curve = stopped.problem, stopped.curve
    near = tried(lambda: nearest(problem, curve, limits))
    if near is None or near.arrives or near.undecided or limits.expired:
        return stopped
    return replace(stopped, status=Status.INFEASIBLE, message=f"{near.message}; {stopped.message}")


def _advised(instance: Instance, stopped: homotopy.Stopped) -> homotopy.Stopped:
    """With what else may lead to an answer where magnitudes cost: singular arcs are recognised without a weight."""
    if stopped.status is not Status.NOT_CONVERGED or any(moving(instance)) or not any(costs(instance)):
        return stopped
    advice = "singular arcs are found only without |u|; state a control for each sign, both from 0 on"
    return replace(stopped, message=f"{stopped.message}; {advice}")


def others(instance: Instance, duration: float, limits: Limits) -> list[Exact]:
    """Extremals from several starts, many of them one and the same.

    For free ends those of controls saturated at a bound, and what is found by smoothing with moderate effort: it may
    have arcs that no such control leads to. For terminal constraints and a free time those of least effort in shares of
    the duration that was found.
    """
    if held.applies(instance):
        return _compared(instance, _at_corners(instance, limits), limits)
    if instance.tf is not None or not instance.model.spec.multipliers:
        return []
    return _beside(instance, duration, COMPARED_BESIDE, limits)


def _at_corners(instance: Instance, limits: Limits) -> list[Exact]:
    """Extremals that controls saturated at a bound lead to, where the end is free."""
    found = (attempt(instance, start, limits) for start in held.guesses(instance))
    return [replace(exact, origin=Origin.SATURATED) for exact in found if exact]


def _compared(instance: Instance, known: list[Exact], limits: Limits) -> list[Exact]:
    """Extremals that are known, and what smoothing leads to with moderate effort."""
    moderate = replace(limits, work=min(limits.work, limits.meter.spent + COMPARED))
    found = smoothed(instance, moderate, thorough=False)
    return known if isinstance(found, homotopy.Stopped) else [*known, found]


def _signs(instance: Instance, near: minimum_effort.Smoothed) -> Guess:
    """The structure of a motion of least effort, as its signs show it."""
    seen = sample(near.problem, near.curve)
    first = guess(instance, replace(seen, weight=0.0 * seen.weight))
    return replace(first, costates=first.costates * near.scaled, course=None)


def _found(instance: Instance, limits: Limits) -> Exact | homotopy.Stopped:
    """Exact arcs, or why there are none."""
    resting = _resting(instance)
    found = attempt(instance, resting, limits) if resting else None
    rest = [replace(found, origin=Origin.REST)] if found else []
    if held.applies(instance):
        if not (known := rest + _at_corners(instance, limits)):
            return smoothed(instance, limits)
        best = min(_compared(instance, known, limits), key=lambda one: one.trajectory.cost(instance))
        return _adopting(instance, best, limits)
    if rest:
        return rest[0]
    if exact := by_reach.optimum(instance, limits):
        return replace(exact, origin=Origin.REACH)
    if message := by_reach.unreachable(instance, limits):
        return homotopy.Stopped(Status.INFEASIBLE, message)
    return _adopting(instance, _by_effort(instance, limits), limits)


def _adopting(instance: Instance, best: Exact | homotopy.Stopped, limits: Limits) -> Exact | homotopy.Stopped:
    """What was found, or what costs less as long as there is such a thing."""
    for _ in range(ADOPTED):
        if limits.expired or (isinstance(best, homotopy.Stopped) and best.chattering):
            break
        better = _cheaper(instance, None if isinstance(best, homotopy.Stopped) else best, limits)
        if better is None:
            break
        best = better
    return best


def _cheaper(instance: Instance, known: Exact | None, limits: Limits) -> Exact | None:
    """What costs less than an extremal, if that is known, by switching times or costates that are drawn."""
    found = tried(partial(by_scouts.cheaper, instance, known, limits))
    if found is not None:
        return replace(found, origin=Origin.DRAWN)
    if known is None or limits.expired:
        return None
    solution = answered(instance, known, (), 0.0)
    least = solution.objective - by_scouts.APART * abs(solution.objective)
    met = (one for one in meetings(solution, MEETING, limits) if one is not None)
    return next((one for one in met if one.trajectory.cost(instance) < least), None)


def _by_effort(instance: Instance, limits: Limits) -> Exact | homotopy.Stopped:
    """What motions of least effort lead to, the final time being free, else less smoothing, or costates drawn."""
    if instance.tf is None:
        near = chain(minimum_effort.quick(instance, limits), minimum_effort.shortening(instance, limits))
        for start in unbroken(_signs(instance, one) for one in near):
            exact = _first_of(instance, start, limits, thorough=True)
            if exact:
                others = _beside(instance, exact.refined.at.end - instance.t0, BESIDE, limits)
                best = min([exact, *others], key=lambda one: one.trajectory.cost(instance))
                return replace(best, origin=Origin.EFFORT)
    found = smoothed(instance, limits)
    stuck = isinstance(found, homotopy.Stopped) and found.status is Status.NOT_CONVERGED and instance.tf is None
    if stuck and (exact := by_costates.soonest(instance, limits)):
        return replace(exact, origin=Origin.COSTATES)
    return (_in_given_durations(instance, limits) if stuck else None) or found


def _in_given_durations(instance: Instance, limits: Limits) -> Exact | None:
    """The extremal of a free duration to which one of a given duration leads, the shortest in which there is one."""
    for share in (minimum_effort.first_duration(instance) * GIVEN).tolist():
        near = smoothed(replace(instance, tf=instance.t0 + share, tf_guess=None), limits, thorough=False)
        if not isinstance(near, homotopy.Stopped):
            at = near.refined.at
            freed = attempt(instance, Guess(near.refined.structure, at.times, at.costates, at.end), limits)
            if freed is not None:
                return replace(freed, origin=near.origin, smoothing=near.smoothing)
        if limits.expired:
            break
    return None


def _beside(instance: Instance, duration: float, fractions: Sequence[float], limits: Limits) -> list[Exact]:
    """Extremals to which the signs of minimum effort lead in shares of a duration."""
    starts = unbroken(_signs(instance, near) for near in minimum_effort.beside(instance, duration, fractions, limits))
    found = (_first_of(instance, start, limits, thorough=False) for start in starts)
    return [exact for exact in found if exact]


def _resting(instance: Instance) -> Guess | None:
    """No control at all, nor costates, where every |u| costs: the answer if the motion arrives by itself."""
    weights = costs(instance)
    if instance.tf is None or not all(weight > 0.0 for weight in weights):
        return None
    rest = Structure(((REST,),) * len(weights))
    return Guess(rest, np.zeros(0), np.zeros(len(instance.initial)), instance.tf)


def _with_coasts(instance: Instance, hurried: Exact) -> Guess:
    """The structure of the minimum time with a short rest at each switch, where |u| costs and some time is left."""
    at, structure = hurried.refined.at, hurried.refined.structure
    assert instance.tf is not None
    spare = ((instance.tf - at.end) * (instance.tf - instance.t0)) ** 0.5 / max(structure.switches, 1)
    levels, times, rates = [], [], []
    weights = costs(instance)
    for arc in hurried.refined.arcs:
        if arc.event is not None:
            _, rate = arc.field.switching(arc.end, arc.after.tolist(), arc.event.control)
            rates.append(2.0 * weights[arc.event.control] / max(abs(rate) * spare, 1e-300))
    for row, own, weight in zip(structure.levels, structure.by_control(at.times), weights, strict=True):
        if weight > 0.0:
            levels.append((row[0], *(level for after in row[1:] for level in (REST, after))))
            times += [t + k * spare for t in own.tolist() for k in (-0.5, 0.5)]
        else:
            levels.append(row)
            times += own.tolist()
    factor = float(np.mean(rates)) if rates else 1.0
    return Guess(Structure(tuple(levels)), np.array(times), factor * at.costates, instance.tf)


def _first_of(instance: Instance, first: Guess, limits: Limits, thorough: bool) -> Exact | None:
    """The guess made exact, or, with more effort, one with an arc less or more."""
    for one in chain((first,), unbroken(neighbours(instance, first, limits)) if thorough else ()):
        exact = attempt(instance, one, limits)
        if exact or limits.expired:
            return exact
    return None
