"""Method "bang-bang": from a cold start to exact arcs and switching times."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Iteration, Progress, Solution
from satsym.solvers.iteration import Limits, watched
from satsym.solvers.switching.answers import answered, without
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.by_smoothing import smoothed
from satsym.solvers.switching.chattering import at_rest, chattered
from satsym.solvers.switching.cold_start import homotopy
from satsym.solvers.switching.linear import by_reach
from satsym.solvers.switching.linear.linear_motion import linear_motion
from satsym.solvers.switching.magnitudes import costs, moving
from satsym.solvers.switching.minimum_time import minimum_time
from satsym.solvers.switching.refusals import refuse
from satsym.solvers.switching.structure import REST, Course, Guess, Structure
from satsym.status import Status

NOT_FOUND = "no extremal found: no start of the search leads to one"
"""What is said where that is all that is known."""


@dataclass(frozen=True)
class Search:
    """The direct search, as it is asked where the motion is not linear and controls do not chatter.

    Attributes
    ----------
    arcs
        Finds exact arcs from a cold start.
    motion
        Finds a motion on a coarse mesh that is nearly the cheapest, with its costates.
    why
        The status where there are none, and a message.
    """

    arcs: Callable[[Instance, Limits], Exact | None]
    motion: Callable[[Instance, Limits], Course | None]
    why: Callable[[Instance, Limits], tuple[Status, str]]


SHORTFALL = 1e-9
"""By this share of it a given time may fall short of the least."""

LONGER, UNKNOWN = (1.3, 1.7, 2.5), (1.3, 2.5, 5.0, 10.0)
"""Durations in which infinitely many switches are looked for, relative to one that was found, and to that of a coarse
motion where none was."""


def solve(instance: Instance, progress: Progress | None, search: Search) -> Solution:
    """Solve a switching problem.

    Parameters
    ----------
    instance
        Of a model whose controls enter the Hamiltonian affinely, with both bounds for each.
    progress
        Called after each step of the continuation, and each attempt at exact arcs.
    search
        What is asked where controls do not chatter. Where the motion is not linear and it finds nothing, smoothed
        problems may show singular arcs.

    Returns
    -------
    Solution
        Times hold each switching time twice: the last instant of one arc and the first of the next.

    Raises
    ------
    BadInput
        If a bound is missing, or the motion starts where it is to end.
    """
    refuse(instance)
    began = time.perf_counter()
    limits, history = watched(instance, progress)
    with np.errstate(all="ignore"):
        found = _found(instance, limits, search)
        endless = _endless(instance, found, limits, search)
        if endless is not None:
            limits.tell(endless.objective, history[-1].residual if history else math.nan)
            return replace(endless, iterations=len(history), history=tuple(history), wall_s=time.perf_counter() - began)
        if isinstance(found, homotopy.Stopped):
            found = _by_least_time(instance, found, limits, search)
        if isinstance(found, homotopy.Stopped):
            return without(
                instance, _advised(instance, _explained(instance, found, limits, search)), tuple(history), began
            )
        return _finished(instance, found, limits, history, began)


def _finished(instance: Instance, found: Exact, limits: Limits, history: list[Iteration], began: float) -> Solution:
    """The answer, whose cost is told last: on the way other problems were solved, and other arcs."""
    limits.tell(found.trajectory.cost(instance), found.refined.residual)
    return answered(instance, found, tuple(history), began)


def _endless(instance: Instance, found: Exact | homotopy.Stopped, limits: Limits, search: Search) -> Solution | None:
    """What infinitely many switches lead to; where the final time is free, in a longer one if that is cheaper."""
    if not instance.model.spec.chattering:
        return None
    if isinstance(found, homotopy.Stopped) and found.chattering:
        return chattered(instance, found.chattering, limits)
    if instance.tf is not None:
        return None
    known = None if isinstance(found, homotopy.Stopped) else found
    if known is None:
        course = search.motion(instance, limits)
        if course is None:
            return None
        duration = float(np.ptp(course.times))
    else:
        duration = known.refined.at.end - instance.t0
    for factor in UNKNOWN if known is None else LONGER:
        given = replace(instance, tf=instance.t0 + factor * duration, tf_guess=None)
        near = None if limits.expired else smoothed(given, search.motion(given, limits), limits)
        if isinstance(near, homotopy.Stopped) and near.chattering:
            endless = chattered(instance, near.chattering, limits)
            if endless is None or not at_rest(endless):
                if known is None:
                    continue
                return None
            cheaper = known is None or endless.objective < known.trajectory.cost(instance)
            return replace(endless, message=f"{endless.message}; a longer time has the same cost") if cheaper else None
    return None


def _by_least_time(
    instance: Instance, stopped: homotopy.Stopped, limits: Limits, search: Search
) -> Exact | homotopy.Stopped:
    """What the least time says: a structure where the given one is hardly longer, or that it is too short.

    The latter where the motion is linear: only there is it known that nothing arrives earlier.
    """
    hurried = minimum_time(instance) if instance.tf is not None and instance.final and not limits.expired else None
    found = _found(hurried, limits, search) if hurried is not None else stopped
    if isinstance(found, homotopy.Stopped) or instance.tf is None or hurried is None:
        return stopped
    least, given, name = found.refined.at.end - instance.t0, instance.tf - instance.t0, found.refined.structure.name
    if found.origin is Origin.REACH and least > given * (1.0 + SHORTFALL):
        message = (
            f"the minimum time to the given end is {least:.10g} (structure {name}), but only {given:.10g} is allowed"
        )
        return replace(stopped, status=Status.INFEASIBLE, message=message)
    near = attempt(instance, _with_coasts(instance, found), limits) if least < given else None
    if near is not None:
        return replace(near, origin=Origin.MINIMUM_TIME)
    if stopped.status is Status.INFEASIBLE:
        return stopped
    alone = ", and at that only one control arrives, whatever it costs" if abs(given / least - 1.0) <= SHORTFALL else ""
    message = f"{stopped.message}; the minimum time to the given end is {least:.10g} (structure {name}){alone}"
    return replace(stopped, message=message)


def _explained(instance: Instance, stopped: homotopy.Stopped, limits: Limits, search: Search) -> homotopy.Stopped:
    """Why there is no answer: where the final time is given, perhaps that no control arrives."""
    if stopped.status is not Status.NOT_CONVERGED:
        return stopped
    status, message = search.why(instance, limits)
    more = stopped.message.removeprefix(NOT_FOUND).removeprefix("; ")
    return replace(stopped, status=status, message="; ".join(part for part in (message, more) if part))


def _advised(instance: Instance, stopped: homotopy.Stopped) -> homotopy.Stopped:
    """With what else may lead to an answer where magnitudes cost: singular arcs are recognised without a weight."""
    if stopped.status is not Status.NOT_CONVERGED or any(moving(instance)) or not any(costs(instance)):
        return stopped
    advice = (
        "singular arcs are supported only if |u| does not occur; use two controls, one for each sign, both "
        "with the lower bound 0"
    )
    return replace(stopped, message=f"{stopped.message}; {advice}")


def _found(instance: Instance, limits: Limits, search: Search) -> Exact | homotopy.Stopped:
    """Exact arcs, or why there are none."""
    resting = _resting(instance)
    found = attempt(instance, resting, limits) if resting else None
    if found is not None:
        return replace(found, origin=Origin.REST)
    if exact := by_reach.optimum(instance, limits):
        return replace(exact, origin=Origin.REACH)
    if message := by_reach.unreachable(instance, limits):
        return homotopy.Stopped(Status.INFEASIBLE, message)
    found = None if instance.model.spec.chattering else search.arcs(instance, limits)
    if found is None and linear_motion(instance) is not None and not instance.model.spec.chattering:
        return homotopy.Stopped(Status.NOT_CONVERGED, NOT_FOUND)
    return found or smoothed(instance, search.motion(instance, limits), limits)


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
