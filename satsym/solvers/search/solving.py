"""The search as methods call it: the kinds of arcs that it knows, the first extremal, and what other starts come to."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.methods import automatic
from satsym.solution import Progress, Solution
from satsym.solvers.control.slopes import continued
from satsym.solvers.iteration import Limits, Meter, unsolved, watched
from satsym.solvers.multipoint.equations import between
from satsym.solvers.multipoint.newton import Extremal
from satsym.solvers.redundant_ends import Redundant, redundant
from satsym.solvers.search import coarse, failing, order
from satsym.solvers.search.motion import Motion
from satsym.solvers.search.nlp import ACCEPTABLE
from satsym.solvers.search.reading import boundaries, collocated, extremals, levels
from satsym.solvers.search.reading.limits import exact_within
from satsym.solvers.search.tried import Past, Tried
from satsym.solvers.switching.attempt import Exact
from satsym.solvers.switching.structure import Course
from satsym.status import Status

CONCLUSIVE = (Status.INFEASIBLE, Status.NO_MINIMISER)
"""Statuses after which no further start is tried."""

WORK = 4_000_000
"""Unknowns times iterations that a search may take."""

ROUNDING = 1e-16
"""Share of costates near by that those are given which vanish exactly, where kernels divide by their norm."""


def applies(instance: Instance) -> bool:
    """Whether the search knows the kinds of arcs that an instance may have, and whether it may change its start."""
    spec = instance.model.spec
    plain = not (spec.chattering or instance.guess)
    arcs = not (spec.in_arcs and spec.throttled)
    timed = any(one.place is Place.TIME for one in instance.free)
    return plain and arcs and not timed and not instance.continuation


def exact(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """The extremal that a motion is near, as an answer without a certificate.

    With path constraints and waypoints, free initial states keep the values that they have in the motion.

    Where the end has limits, the instance of the answer says which of them are met, whatever is given for these.
    """
    if instance.end_limits:
        return exact_within(instance, at, lambda one: _exact(one, at, limits))
    return _exact(instance, at, limits)


def _exact(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    spec = instance.model.spec
    if spec.in_arcs:
        return boundaries.exact(replace(at.instance, free=()) if instance.free else instance, at, limits)
    extremal = None if spec.switching else extremals.exact(instance, at, limits)
    if extremal is not None:
        return answered(instance, extremal)
    if instance.free:
        return None
    if spec.switching or spec.throttled:
        return levels.exact(instance, at, limits)
    return collocated.exact(instance, at)


def exact_arcs(instance: Instance, limits: Limits) -> Exact | None:
    """The extremal of exact arcs of controls that switch to which the first start leads that leads to one."""
    within = replace(limits, work=WORK, meter=Meter())
    hopeless = partial(_hopeless, instance, limits, [])
    return order.searched(instance, within, partial(levels.arcs, instance), hopeless=hopeless)


def course(instance: Instance, limits: Limits) -> Course | None:
    """States and costates of the first motion on a coarse mesh that a start leads to."""
    at = coarse.first_motion(instance, replace(limits, work=WORK, meter=Meter()))
    return None if at is None else Course(at.times, np.concatenate([at.x, at.lam]))


def _hopeless(instance: Instance, limits: Limits, reasons: list[failing.Reason]) -> bool:
    """Return whether no start will lead to an extremal, as is asked after a few that did not, and add the reason."""
    reason = failing.why(instance, limits, early=True)
    if reason[0] in CONCLUSIVE:
        reasons.append(reason)
    return reason[0] in CONCLUSIVE


def searched(instance: Instance, limits: Limits, reasons: list[failing.Reason] | None = None) -> Solution | None:
    """Return what the search finds, without a final state that follows from the others.

    Parameters
    ----------
    reasons
        Receives the reason why no start will lead to an extremal, if there is one.
    """
    less = redundant(instance)
    hopeless = partial(_hopeless, instance, limits, [] if reasons is None else reasons)
    if less is None:
        return order.searched(instance, limits, partial(exact, instance), hopeless=hopeless)
    found = order.searched(instance, limits, partial(_met, less), less.state, hopeless)
    return None if found is None else replace(found, message=f"{found.message}; {less.note}")


def guessed(instance: Instance, limits: Limits) -> Instance:
    """An instance with states and costates guessed by the search, unless it has a guess or the search finds nothing."""
    if instance.guess:
        return instance
    found = searched(instance, replace(limits, work=WORK))
    return instance if found is None else collocated.guessing(instance, found.times, found.x, found.lam)


def others(
    instance: Instance, solution: Solution, limits: Limits, past: Past | None = None
) -> Iterator[Tried[Solution]]:
    """What other starts come to beside an answer to an instance, as :func:`order.others` has it."""
    less = redundant(instance)
    making, loose = (partial(exact, instance), "") if less is None else (partial(_met, less), less.state)
    way = solution.times, solution.x
    cost, hidden = solution.objective, _hidden(solution)
    return order.others(instance, limits, making, cost, lambda one: one.objective, loose, way, hidden, past)


def _hidden(solution: Solution) -> float:
    """What the cost changes by where states miss what is asked of them by as much as a programme lets them."""
    size, slope = (np.abs(row).max(axis=1) for row in (solution.x, solution.lam))
    return ACCEPTABLE * float(size @ slope)


def _met(less: Redundant, at: Motion, limits: Limits) -> Solution | None:
    """The extremal that a motion is near, if it ends as is asked."""
    found = exact(less.instance, at, limits)
    return found if found is not None and less.met(found) else None


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by the search alone.

    Parameters
    ----------
    instance
        Of a model with path constraints or points on the way, whose vectors are throttled, or whose controls are
        directions or have no law in closed form.
    progress
        Called after each iteration of the interior-point code.

    Returns
    -------
    Solution
        Without a certificate. Times hold each switching time twice: the last instant of one arc and the first of the
        next.
    """
    throttled = instance.model.spec.throttled
    began = time.perf_counter()
    limits, history = watched(instance, progress)
    limits = replace(limits, work=WORK)
    reasons = list[failing.Reason]()
    found = (levels.at_rest(instance, limits) if throttled else None) or searched(instance, limits, reasons)
    if found is not None:
        limits.tell(found.objective, history[-1].residual if history else math.nan)
        return replace(found, history=tuple(history), iterations=len(history), wall_s=time.perf_counter() - began)
    status, message = reasons[0] if reasons else failing.why(instance, limits)
    nothing = unsolved(instance, automatic(instance.model.spec).name, 0.0)
    wall_s = time.perf_counter() - began
    return replace(nothing, status=status, message=message, history=tuple(history), wall_s=wall_s)


def answered(instance: Instance, extremal: Extremal) -> Solution:
    """The solution of an instance that an extremal is; times hold each junction twice where the control jumps.

    Parameters
    ----------
    instance
        As it was stated; the solution has the values that were found for what it leaves free.
    """
    problem = extremal.problem
    given = _with_values(instance, extremal)
    names = "".join(law.name for law in problem.laws)
    structure = f"structure {names}, " if len(names) > 1 else ""
    with np.errstate(all="ignore"):  # where the slope by a direction vanishes its law is not a number
        times, z, u = _grid(extremal, np.linspace(given.t0, float(extremal.times[-1]), instance.solver.steps + 1))
    n, m = problem.n, len(instance.model.spec.controls)
    open_ones = np.asarray(~np.isfinite(u).all(axis=0))
    if open_ones.any() and not open_ones.all():
        z = _beside_poles(z, n, open_ones)
    if (instance.model.spec.directional and not structure) or open_ones.any():
        u = continued(given, times, z[:n], z[n:], u)
    switches = [
        (float(t), place)
        for t, one in zip(extremal.times[1:-1], problem.junctions, strict=True)
        for place in one.controls
    ]
    status = Status.CONVERGED if instance.model.in_domain(z[:n]) else Status.LEFT_DOMAIN
    return Solution(
        instance=given,
        method="bang-bang" if structure else "collocation",
        status=status,
        message=(
            f"{structure}estimated error {extremal.step:.0e} on {sum(problem.intervals)} intervals, "
            "found by the direct search"
        ),
        objective=extremal.cost,
        times=times,
        x=z[:n],
        u=u,
        lam=z[n:],
        switching_times=tuple(tuple(t for t, control in switches if control == k) for k in range(m)),
        iterations=extremal.iterations,
        history=(),
        wall_s=0.0,
    )


def _beside_poles(z: Array, n: int, open_ones: NDArray[np.bool_]) -> Array:
    """Values with costates that decide a direction at all times: as before or after, and as small as rounding."""
    z, known = z.copy(), np.flatnonzero(~open_ones)
    for at in np.flatnonzero(open_ones):
        z[n:, at] += ROUNDING * z[n:, known[np.abs(known - at).argmin()]]
    return z


def _with_values(instance: Instance, extremal: Extremal) -> Instance:
    """The instance with what was found for what is free besides the end."""
    problem, v = extremal.problem, extremal.unknown
    parameters = tuple(float(np.real(value)) for value in problem.given(v))
    initial = list(instance.initial)
    for one in instance.free:
        if one.place is Place.INITIAL:
            initial[one.index] = float(v[one.index])
    return replace(instance, initial=tuple(initial), parameters=parameters, t0=problem.instance.t0)


def _grid(extremal: Extremal, even: Array) -> tuple[Array, Array, Array]:
    """Times, values and controls at even times and at junctions, at both sides where the law changes."""
    problem, v, edges = extremal.problem, extremal.unknown, extremal.times
    p, times, values, controls = problem.given(v), list[Array](), list[Array](), list[Array]()
    near = 1e-9 * (edges[-1] - edges[0])
    for arc, law in enumerate(problem.laws):
        begin, end = edges[arc], edges[arc + 1]
        inside = even[(even > begin + near) & (even < end - near)]
        again = arc > 0 and law is problem.laws[arc - 1]
        t = np.concatenate([[] if again else [begin], inside, [end]])
        z = between(problem, v, arc, np.clip((t - begin) / (end - begin), 0.0, 1.0))
        z[:, -1] = problem.values(v, arc)[0][-1]
        times.append(t)
        values.append(z)
        controls.append(np.asarray(law.control(t, z, p)))
    return np.concatenate(times), np.concatenate(values, axis=1), np.concatenate(controls, axis=1)
