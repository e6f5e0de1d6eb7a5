"""Free final time: the cost over the duration, and its minimum.

Given durations make problems that the cold start solves. Their costs, and the residual of the final time (which is
the derivative of the cost by it), bracket the minima over the duration; from the cheapest ones Newton's method goes
on with the duration as an unknown. Where nothing weighs time the cost may fall for ever: that is said, with costs.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.solve.collocation import paths
from satsym.solve.collocation.cold_start import Start, cold_start
from satsym.solve.collocation.curve import Curve, stage_times
from satsym.solve.collocation.newton import newton
from satsym.solve.collocation.problem import TwoPoint
from satsym.solve.collocation.scaling import two_point
from satsym.solve.collocation.second_variation import negative_directions
from satsym.solve.collocation.sqp import Found
from satsym.solve.collocation.system import System
from satsym.solve.control_set import without_bounds
from satsym.solve.iteration import Limits
from satsym.status import Status

Array = NDArray[np.floating[Any]]

RATIO = 2.0**0.5
"""Of neighbouring durations."""

AROUND_GUESS = (-2, 2)
AROUND_SCALE = (-2, 8)
FEWER = (3, 5)
"""Powers of the ratio that are tried at first: around the stated guess, and around the motion's own time scale."""

MOST_SCALES, LEAST_SCALES = 64.0, 1e-7
"""Durations, in units of the first one, at which a search gives up that has no reason of its own to end."""

MOST_INTERVALS = 300
"""Mesh beyond which no longer durations are tried: about fifty revolutions."""

FAR_DEARER, RISES = 3.0, 3
"""No longer durations are tried either once the cost has risen that many times running, and so far."""

FAILURES = 3
"""Nor once that many durations running have given no extremal, after one that has."""

POLISHED = 3
"""Brackets, the cheapest first, in which a minimum is looked for."""

BISECTIONS = 12
FLAT = 1e-12
"""Costs at all durations that differ by less, relative to the problem's own scale, leave the duration open."""


@dataclass(frozen=True, eq=False)
class Chosen:
    """What came of the choice of a duration.

    Attributes
    ----------
    problem
        With the free duration, which starts at the one that was found.
    start
        The extremal found for it, or the last attempt.
    status, message
        ``CONVERGED``, or why there is no minimum, and a sentence.
    """

    problem: TwoPoint
    start: Start
    status: Status
    message: str


@dataclass(frozen=True, eq=False)
class Try:
    """The problem of a given duration, solved: its cost and the derivative of that by the duration."""

    duration: float
    start: Start
    cost: float
    slope: float
    floor: float
    """What every unit of time costs at least along this motion, without any control."""


def free_duration(instance: Instance, limits: Limits, effort: bool = True) -> Chosen:
    """Find the duration that costs least, without bounds; with effort, also where the straight line leads nowhere."""
    search = _Search(instance, limits)
    search.scan()
    if effort and not search.tries:
        search.thorough()
        search.scan()
    tries = search.tries
    if not tries and limits.expired:
        return search.none(Status.TIME_LIMIT, "time was up before any duration was solved for")
    if not tries:
        return search.none(Status.NOT_CONVERGED, "no extremal found at any duration that was tried")
    if flat := search.nothing_decides():
        return flat
    best: tuple[float, TwoPoint, Start] | None = None
    brackets = [(a, b) for a, b in pairwise(tries) if a.slope <= 0.0 < b.slope]
    for a, b in sorted(brackets, key=lambda pair: min(t.cost for t in pair))[:POLISHED]:
        found = search.polished(a, b)
        if found and (best is None or found[0] < best[0]):
            best = found
    best = best and search.confirmed(best)
    cheapest = min(tries, key=lambda t: t.cost)
    if best and best[0] <= cheapest.cost * (1.0 + 1e-9) + FLAT * search.unit:
        others = f"cheapest of {len(brackets)} minima over the duration" if len(brackets) > 1 else "minimum over time"
        return Chosen(best[1], best[2], Status.CONVERGED, others)
    if limits.expired:
        return search.none(Status.TIME_LIMIT, "time was up before a duration was found")
    if cheapest is tries[-1] and tries[-1].floor <= 0.0:
        return search.none(Status.NO_MINIMISER, f"longer is always cheaper: {_costs(_records(tries))}")
    if cheapest is tries[0] and tries[0].slope > 0.0:
        return search.none(Status.NO_MINIMISER, f"shorter is always cheaper: {_costs(tries[:3])}")
    if cheapest is tries[-1]:
        message = f"the cost still falls at the longest duration tried: {_costs(_records(tries))}; give a tf_guess"
        return search.none(Status.NOT_CONVERGED, message)
    return search.none(Status.NOT_CONVERGED, f"no minimum over the duration settles near {cheapest.duration:g}")


def time_scale(instance: Instance) -> float:
    """One over the largest rate of the motion at the start: of the eigenvalues of f_x without control; one if zero."""
    n = len(instance.initial)
    nothing = tuple([0.0] * n)
    slopes = instance.model.canonical_jacobian(
        instance.t0, instance.initial, nothing, instance.parameters, without_bounds(instance)
    )
    fastest = np.abs(np.linalg.eigvals(np.array(slopes).reshape(2 * n, 2 * n)[:n, :n])).max()
    return 1.0 / float(fastest) if np.isfinite(fastest) and fastest > 0.0 else 1.0


class _Search:
    """Durations tried so far, in order."""

    def __init__(self, instance: Instance, limits: Limits) -> None:
        self.instance, self.limits = instance, limits
        guess = instance.tf_guess
        self.first = time_scale(instance) if guess is None else guess - instance.t0
        self.powers = AROUND_SCALE if guess is None else AROUND_GUESS
        self.tries: list[Try] = []
        self.quick, self.failures = True, 0
        self.steps, self.duration = 0, self.first
        self.last: Curve | None = None
        self.unit = self.problem(self.first).scale.cost

    def thorough(self) -> None:
        """Try harder from now on, at fewer durations."""
        self.quick = False
        self.powers = FEWER if self.instance.tf_guess is None else (0, 0)

    def problem(self, duration: float) -> TwoPoint:
        """The problem with the duration free, and this one to start from; without bounds."""
        return two_point(self.instance, duration).widened(float("inf"))

    def none(self, status: Status, message: str) -> Chosen:
        """No minimum; the last attempt is kept for the record."""
        problem = self.problem(self.first)
        curve = self.last or paths.curve(problem, paths.first(problem))
        if len(curve.theta) < problem.unknowns:
            curve = replace(curve, theta=np.append(curve.theta, self.duration))
        found = Found(curve, message, float("nan"), 0, True)
        return Chosen(problem, Start(found, "none", self.steps, {}), status, message)

    def scan(self) -> None:
        """Solve for durations upwards, then downwards, as far as that may pay."""
        power, high = self.powers
        while not self.limits.expired and self._longer_may_pay(power, high):
            self._solve(self.first * RATIO**power)
            power += 1
        fall = 1
        while self.tries and not self.limits.expired:
            shortest = self.tries[0]
            if shortest.slope <= 0.0 or shortest.cost > min(t.cost for t in self.tries):
                break
            if shortest.duration < LEAST_SCALES * self.first:
                break
            self._solve(shortest.duration * RATIO**-fall)
            if self.tries[0] is shortest:
                break
            fall *= 2

    def nothing_decides(self) -> Chosen | None:
        """Where every duration costs the same."""
        costs = [t.cost for t in self.tries]
        if len(costs) < 3 or max(costs) - min(costs) > FLAT * self.unit:
            return None
        return self.none(Status.NO_MINIMISER, f"nothing decides the final time: {_costs(self.tries[-3:])}")

    def polished(self, a: Try, b: Try) -> tuple[float, TwoPoint, Start] | None:
        """The minimum between two durations: its cost, its problem and the extremal."""
        for _ in range(BISECTIONS):
            near = a if abs(a.slope) <= abs(b.slope) else b
            problem = self.problem(near.duration)
            found = self._newton(problem, near)
            if found and a.duration * (1.0 - 1e-9) <= found.curve.theta[-1] <= b.duration * (1.0 + 1e-9):
                start = Start(found, near.start.way, self.steps, {})
                return found.cost * problem.scale.cost, problem, start
            if self.limits.expired:
                return None
            middle = self._tried((a.duration * b.duration) ** 0.5, self.quick)
            if middle is None:
                return None
            a, b = (middle, b) if middle.slope <= 0.0 else (a, middle)
        return None

    def confirmed(self, best: tuple[float, TwoPoint, Start]) -> tuple[float, TwoPoint, Start]:
        """That minimum, or a cheaper one from where the second way of the cold start leads with the same duration."""
        duration = float(best[2].found.curve.theta[-1])
        again = self._tried(duration, quick=False) if self.quick and best[2].found.hard else None
        if again is None or again.cost >= best[0] * (1.0 - 1e-6):
            return best
        problem = self.problem(duration)
        found = self._newton(problem, again)
        if not found or found.cost * problem.scale.cost >= best[0]:
            return best
        return found.cost * problem.scale.cost, problem, replace(again.start, found=found)

    def _newton(self, problem: TwoPoint, near: Try) -> Found | None:
        curve = near.start.found.curve
        curve = replace(curve, theta=np.append(curve.theta, near.duration))
        system = System(problem, curve.mesh, curve.order)
        outcome = newton(system, curve, tolerance=1e-9)
        if outcome is None:
            return None
        self.steps += outcome.iterations
        try:
            final = system.linearised(outcome.curve, system.residual(outcome.curve), system.jacobian(outcome.curve))
            minimum = outcome.converged and not negative_directions(problem, outcome.curve, final.matching)
        except np.linalg.LinAlgError:
            return None
        cost = system.cost(outcome.curve)
        return Found(outcome.curve, "minimum", cost, outcome.iterations, near.start.found.hard) if minimum else None

    def _solve(self, duration: float) -> None:
        found = self._tried(duration, self.quick)
        self.failures = 0 if found else self.failures + 1
        if found:
            self.tries = sorted([*self.tries, found], key=lambda t: t.duration)

    def _tried(self, duration: float, quick: bool) -> Try | None:
        """The problem with a given duration."""
        tf = self.instance.t0 + duration
        fixed = two_point(replace(self.instance, tf=tf, tf_guess=None), duration)
        start = cold_start(fixed, self.limits, quick)
        self.steps += start.steps
        self.last, self.duration = start.found.curve, duration
        if start.way == "none":
            return None
        free, curve = self.problem(duration), start.found.curve
        residual = free.boundary(curve.nodes[:, -1], np.append(curve.theta, duration))
        idle = curve.flat.copy()
        idle[fixed.states :] = 0.0
        tau = stage_times(curve.mesh, curve.order).ravel()
        floor = fixed.widened(float("inf")).running_cost(tau, idle, curve.theta).min() * fixed.scale.cost
        slope = float(residual[-1]) * free.scale.cost / duration
        return Try(duration, start, start.found.cost * fixed.scale.cost, slope, float(floor))

    def _longer_may_pay(self, power: int, high: int) -> bool:
        """Whether the next longer duration may be the cheapest so far."""
        if not self.tries:
            return power <= high
        last, costs = self.tries[-1], [t.cost for t in self.tries]
        if self.failures >= FAILURES or len(last.start.found.curve.mesh) > MOST_INTERVALS:
            return False
        rising = len(costs) > RISES and all(a < b for a, b in pairwise(costs[-RISES - 1 :]))
        if rising and last.cost > FAR_DEARER * min(costs):
            return False
        if last.floor > 0.0:  # no motion of that duration costs less than this
            return last.floor * self.first * RATIO**power < min(costs)
        falls = last.cost <= min(costs) and last.duration >= 8.0 * self.tries[0].duration
        return power <= high or (not falls and RATIO**power <= MOST_SCALES)


def _records(tries: list[Try]) -> list[Try]:
    """The last three that were cheaper than all shorter ones."""
    records: list[Try] = []
    for found in tries:
        if not records or found.cost < records[-1].cost:
            records.append(found)
    return records[-3:]


def _costs(tries: list[Try]) -> str:
    durations = ", ".join(f"{t.duration:.4g}" for t in tries)
    return f"cost {', '.join(f'{t.cost:.4g}' for t in tries)} at durations {durations}"
