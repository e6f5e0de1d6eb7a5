"""Method "bang-bang": exact arcs and switching times from a cold start."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Iteration, Progress, Solution
from satsym.solvers.failures import FAILURES
from satsym.solvers.iteration import Limits, watched
from satsym.solvers.switching.answers import answered, without
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.chattering import NARROW, Look, at_rest, chattered, look, shows
from satsym.solvers.switching.cold_start import homotopy
from satsym.solvers.switching.cold_start.recognition import guess, sample
from satsym.solvers.switching.linear import by_reach
from satsym.solvers.switching.magnitudes import costs, moving
from satsym.solvers.switching.minimum_time import minimum_time
from satsym.solvers.switching.structure import REST, Course, Guess, Structure
from satsym.status import BadInput, Status

NOT_FOUND = "no extremal found: no start of the search leads to one"
"""Message if nothing else is known about a failure."""

SHORTFALL = 1e-9
"""Relative amount by which a given final time may fall short of the minimum time."""

LONGER, UNKNOWN = (1.3, 1.7, 2.5), (1.3, 2.5, 5.0, 10.0)
"""Durations in which infinitely many switches are looked for, relative to a duration that was found, and to that of a
motion on a coarse mesh if none was found."""


@dataclass(frozen=True)
class Search:
    """The direct search, which is used if the reachable set does not give a solution.

    Attributes
    ----------
    arcs
        Function that finds exact arcs from a cold start.
    motion
        Function that finds a motion of nearly minimum cost on a coarse mesh, with its costates.
    why
        Function that returns status and message if no arcs are found.
    """

    arcs: Callable[[Instance, Limits], Exact | None]
    motion: Callable[[Instance, Limits], Course | None]
    why: Callable[[Instance, Limits], tuple[Status, str]]


def solve(instance: Instance, progress: Progress | None, search: Search) -> Solution:
    """Solve a switching problem.

    Parameters
    ----------
    instance
        Instance of a model whose controls enter the Hamiltonian affinely, with both bounds for each.
    progress
        Function that is called after each step of the continuation, and each attempt at exact arcs.
    search
        The direct search: it finds exact arcs, or an initial motion if controls may chatter.

    Returns
    -------
    Solution
        Solution whose times contain each switching time twice: as the last time of one arc and the first of the next.

    Raises
    ------
    BadInput
        If a bound is missing, or the initial state satisfies the final conditions.
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
    """Return the answer, and report its cost last, since costs of other problems and arcs were reported before."""
    limits.tell(found.trajectory.cost(instance), found.refined.residual)
    return answered(instance, found, tuple(history), began)


def _endless(instance: Instance, found: Exact | homotopy.Stopped, limits: Limits, search: Search) -> Solution | None:
    """Return the solution with infinitely many switches, or ``None``; a free time is increased if this is cheaper."""
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
        near = None if limits.expired else _smoothed(given, search.motion(given, limits), limits)
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
    """Return arcs from the structure of minimum time, or the failure with the minimum time in its message.

    The structure is used if the given time is hardly longer. For linear motions, a longer minimum time proves that the
    given time is too short; for others earlier arrivals cannot be excluded.
    """
    hurried = minimum_time(instance) if instance.tf is not None and instance.final and not limits.expired else None
    found = _found(hurried, limits, search) if hurried is not None else stopped
    if isinstance(found, homotopy.Stopped) or instance.tf is None or hurried is None:
        return stopped
    least, given, name = found.refined.at.end - instance.t0, instance.tf - instance.t0, found.refined.structure.name
    if found.origin is Origin.REACH and least > given * (1.0 + SHORTFALL):
        message = (
            f"the minimum time to the given final state is {least:.10g} (structure {name}), but only {given:.10g} is "
            f"allowed"
        )
        return replace(stopped, status=Status.INFEASIBLE, message=message)
    near = attempt(instance, _with_coasts(instance, found), limits) if least < given else None
    if near is not None:
        return replace(near, origin=Origin.MINIMUM_TIME)
    if stopped.status is Status.INFEASIBLE:
        return stopped
    alone = (
        ", and in that time only one control reaches it, whatever its cost"
        if abs(given / least - 1.0) <= SHORTFALL
        else ""
    )
    message = f"{stopped.message}; the minimum time to the given final state is {least:.10g} (structure {name}){alone}"
    return replace(stopped, message=message)


def _explained(instance: Instance, stopped: homotopy.Stopped, limits: Limits, search: Search) -> homotopy.Stopped:
    """Return the failure with the reason that the search finds, for example that no control reaches the end."""
    if stopped.status is not Status.NOT_CONVERGED:
        return stopped
    status, message = search.why(instance, limits)
    more = stopped.message.removeprefix(NOT_FOUND).removeprefix("; ")
    return replace(stopped, status=status, message="; ".join(part for part in (message, more) if part))


def _advised(instance: Instance, stopped: homotopy.Stopped) -> homotopy.Stopped:
    """Return the failure with advice if |u| has a cost, since singular arcs are only found for problems without |u|."""
    if stopped.status is not Status.NOT_CONVERGED or any(moving(instance)) or not any(costs(instance)):
        return stopped
    advice = (
        "singular arcs are supported only if |u| does not occur; use two controls, one for each sign, both "
        "with the lower bound 0"
    )
    return replace(stopped, message=f"{stopped.message}; {advice}")


def _found(instance: Instance, limits: Limits, search: Search) -> Exact | homotopy.Stopped:
    """Return exact arcs from rest, the reachable set or the direct search, or the reason of the failure."""
    resting = _resting(instance)
    found = attempt(instance, resting, limits) if resting else None
    if found is not None:
        return replace(found, origin=Origin.REST)
    if exact := by_reach.optimum(instance, limits):
        return replace(exact, origin=Origin.REACH)
    if message := by_reach.unreachable(instance, limits):
        return homotopy.Stopped(Status.INFEASIBLE, message)
    if instance.model.spec.chattering:
        return _smoothed(instance, search.motion(instance, limits), limits)
    return search.arcs(instance, limits) or homotopy.Stopped(Status.NOT_CONVERGED, NOT_FOUND)


def _resting(instance: Instance) -> Guess | None:
    """Return a guess of zero controls and costates if every |u| has a cost and the time is given, else ``None``."""
    weights = costs(instance)
    if instance.tf is None or not all(weight > 0.0 for weight in weights):
        return None
    rest = Structure(((REST,),) * len(weights))
    return Guess(rest, np.zeros(0), np.zeros(len(instance.initial)), instance.tf)


def _with_coasts(instance: Instance, hurried: Exact) -> Guess:
    """Return the structure of minimum time with a short rest at each switch of controls whose magnitude costs."""
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


def refuse(instance: Instance) -> None:
    """Refuse an instance that is no solvable switching problem, before any computation.

    Raises
    ------
    BadInput
        If a bound is missing, if no control can be chosen, if nothing has a cost, or if the initial state satisfies the
        final conditions.
    """
    names = instance.model.spec.control_names
    for name, low, high in zip(names, instance.lower, instance.upper, strict=True):
        if not np.isfinite([low, high]).all():
            raise BadInput(
                f"{instance.called}: [control] {name}: the cost has no term in the square of this control, so "
                f"it needs both bounds; write {name} = [lower, upper]"
            )
    if instance.lower == instance.upper:
        raise BadInput(
            f"{instance.called}: [control]: the lower and upper bounds of every control are equal, so there is "
            "nothing to choose; widen the bounds of one control"
        )
    if instance.tf is not None and _free_of_charge(instance):
        raise BadInput(
            f'{instance.called}: [time] tf: with a given final time, all controls have the same cost; write tf = "free"'
        )
    if instance.tf is None and instance.final and _there(instance):
        raise BadInput(
            f"{instance.called}: [initial]: the initial state satisfies the final conditions, so the optimal final "
            f"time is zero; change the initial state, or give a final time"
        )


def _free_of_charge(instance: Instance) -> bool:
    """Return whether neither controls nor states have a cost, tested at random states."""
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    rng = np.random.default_rng(0)
    assert instance.tf is not None
    x = np.array([value or 1.0 for value in instance.initial])[:, None] * rng.uniform(0.5, 2.0, (n, 20))
    t = rng.uniform(instance.t0, instance.tf, 20)
    none, u = np.zeros((n, 20)), np.array(instance.upper)[:, None] * rng.uniform(0.0, 1.0, (len(instance.upper), 20))
    ends = [model.terminal_gradient(instance.tf, tuple(column), p) for column in x.T]
    costs = (
        model.switching_function_batch(t, x, none, p),
        model.magnitude_weight_batch(t, x, none, p),
        model.costate_rate_batch(t, x, u, none, p),
        ends,
    )
    return not any(np.any(cost) for cost in costs)


def _there(instance: Instance) -> bool:
    """Return whether the initial state has all given final values."""
    for name, x in zip(instance.model.spec.state_names, instance.initial, strict=True):
        wanted = instance.final.get(name)
        if isinstance(wanted, str) or (wanted is not None and abs(wanted - x) > 1e-12 * max(abs(wanted), abs(x))):
            return False
    return True


def _smoothed(instance: Instance, course: Course | None, limits: Limits) -> Exact | homotopy.Stopped:
    """Return exact arcs whose structure is recognised in regularised extremals, or why none were found.

    Parameters
    ----------
    instance
        Instance with a control that may chatter.
    course
        Motion near which the first smoothed extremal is searched for.
    """
    if course is None:
        return homotopy.Stopped(Status.NOT_CONVERGED, "")
    levels: list[homotopy.Smoothed] = []
    looks: list[Look] = []
    try:
        for level, near in enumerate(homotopy.path(instance, course, limits, 2 * homotopy.LEVELS)):
            seen = sample(near.problem, near.curve)
            levels.append(near)
            looks.append(look(instance, near, seen))
            if level >= homotopy.LEVELS and (looks[-1].width <= NARROW or not shows(looks)):
                break
            exact = attempt(instance, guess(instance, seen), limits) if level <= homotopy.LEVELS else None
            if exact is not None:
                return replace(exact, origin=Origin.SMOOTHED, smoothing=near.problem.control_set.smoothing)
            if limits.expired:
                break
    except homotopy.Stopped as stopped:
        last_seen = stopped
    except FAILURES as error:
        last_seen = homotopy.Stopped(Status.NOT_CONVERGED, f"no regularised solution was found ({error})")
    else:
        message = "no structure recognised in regularised solutions satisfies Pontryagin's minimum principle"
        last_seen = homotopy.Stopped(Status.NOT_CONVERGED, message)
    if limits.expired:
        return replace(last_seen, status=Status.TIME_LIMIT, message=f"time limit reached: {last_seen.message}")
    return replace(last_seen, chattering=tuple(levels)) if shows(looks) else last_seen
