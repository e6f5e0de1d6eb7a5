"""Throttled vectors in a free time: exact arcs in given times, followed to where another would cost more.

The regularised problem, from which cold starts begin, says little of a free time that nothing weighs: it is cheaper
the longer it takes, whatever the problem itself does.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial

from satsym.instance import Instance
from satsym.solvers.cold_start.directions import directed
from satsym.solvers.cold_start.duration_search import LONG, LONGER, RATIO, SHORTER, SMALLEST
from satsym.solvers.cold_start.durations import time_scale
from satsym.solvers.cold_start.own_time import long_time
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.arcs_of_norms import arcs
from satsym.solvers.switching.cold_start.homotopy import Stopped
from satsym.solvers.switching.structure import Guess
from satsym.status import Status

POWERS = range(-1, 6)
"""Of two, by which the motion's own time scale is multiplied until there are exact arcs in so much time."""

FLAT = 1e-9
"""Share of the cost that a change by the whole duration has to make, if the duration is to matter."""


@dataclass(frozen=True, eq=False)
class Timed:
    """Exact arcs in a given time."""

    exact: Exact
    duration: float
    cost: float
    slope: float
    """The derivative of the cost by the duration."""

    @property
    def falls(self) -> bool:
        """Whether a longer time is cheaper."""
        return self.slope * self.duration < -FLAT * abs(self.cost)

    def guess(self, instance: Instance, ratio: float = 1.0) -> Guess:
        """The same, stretched."""
        at = self.exact.refined.at
        times = instance.t0 + ratio * (at.times - instance.t0)
        return Guess(self.exact.refined.structure, times, at.costates, instance.t0 + ratio * self.duration)


def by_duration(instance: Instance, limits: Limits) -> Exact | Stopped | None:
    """The minimum over the duration, or that longer is cheaper as far as that goes; ``None`` without either.

    Parameters
    ----------
    instance
        With a free final time.
    limits
        Of all attempts.
    """
    first = _first(instance, limits)
    if first is None:
        return None
    seen, ratio = [first], RATIO if first.falls else 1.0 / RATIO
    long = long_time(instance, time_scale(instance))
    while not limits.expired and abs(ratio - 1.0) > SMALLEST - 1.0:
        here = seen[-1]
        there = _timed(instance, attempt(_given(instance, ratio * here.duration), here.guess(instance, ratio), limits))
        if there is None:
            ratio **= SHORTER
            continue
        seen.append(there)
        ratio = min(ratio**LONGER, RATIO) if first.falls else max(ratio**LONGER, 1.0 / RATIO)
        if there.falls != first.falls:
            near = min(here, there, key=lambda one: abs(one.slope))
            freed = attempt(instance, near.guess(instance), limits)
            return None if freed is None else replace(freed, origin=Origin.GIVEN)
        if there.falls and there.duration >= max(LONG * first.duration, long):
            return _endless(instance, seen)
    advice = "give a tf_guess, or fix the final time"
    message = f"the cost still falls at the longest duration solved: {_costs(seen)}; {advice}"
    return Stopped(Status.NOT_CONVERGED, message) if seen[-1].falls else None


def _first(instance: Instance, limits: Limits) -> Timed | None:
    scale = time_scale(instance) if instance.tf_guess is None else instance.tf_guess - instance.t0
    for power in POWERS:
        given = _given(instance, scale * 2.0**power)
        found = tried(partial(directed, given, limits, False, arcs))
        timed = _timed(instance, found if isinstance(found, Exact) else None)
        if timed is not None or limits.expired:
            return timed
    return None


def _given(instance: Instance, duration: float) -> Instance:
    return replace(instance, tf=instance.t0 + duration, tf_guess=None)


def _timed(instance: Instance, exact: Exact | None) -> Timed | None:
    """What exact arcs in a given time cost, and how that changes: what the condition for a free final time misses."""
    if exact is None:
        return None
    at, last, n = exact.refined.at, exact.refined.arcs[-1], len(instance.initial)
    z = last.after.tolist()
    point = (at.end, tuple(z[:n]), tuple(z[n:]), tuple(at.multipliers))
    found = instance.model.boundary(
        *point, instance.parameters, last.field.kept_at(at.end, z), final_argument(instance)
    )
    return Timed(exact, at.end - instance.t0, exact.trajectory.cost(instance), float(found[-1]))


def _endless(instance: Instance, seen: list[Timed]) -> Stopped | None:
    """Longer is always cheaper, if time itself costs nothing."""
    last = seen[-1].exact.trajectory.arcs[-1]
    x = tuple(last.after[: len(instance.initial)].tolist())
    idle = (0.0,) * len(instance.model.spec.controls)
    if instance.model.running_cost(last.end, x, idle, instance.parameters) > 0.0:
        return None
    advice = "put a weight on time, or fix the final time"
    return Stopped(Status.NO_MINIMISER, f"longer is always cheaper: {_costs(seen)}; {advice}")


def _costs(seen: list[Timed]) -> str:
    shown = [seen[k] for k in sorted({0, len(seen) // 2, len(seen) - 1})]
    durations = ", ".join(f"{one.duration:.4g}" for one in shown)
    return f"cost {', '.join(f'{one.cost:.4g}' for one in shown)} at durations {durations}"
