"""Free final time: the cost over the duration, and its minimum.

Given durations make problems that the cold start solves. Their costs, and the residual of the final time (which is
the derivative of the cost by it), bracket the minima over the duration; from the cheapest ones Newton's method goes
on with the duration as an unknown. Where nothing weighs time the cost may fall for ever, where nothing else is asked
for it may fall down to no time at all: that is said, with costs.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solvers.cold_start.duration_search import AROUND_GUESS, AROUND_SCALE, Search
from satsym.solvers.cold_start.duration_trials import Minimum, Trials, Try
from satsym.solvers.cold_start.own_time import long_time, own_time
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.scaling import NO_SLOPE
from satsym.solvers.control.regularised import sloping
from satsym.solvers.iteration import Limits
from satsym.status import Status

POLISHED = 3
"""Brackets, the cheapest first, in which a minimum is looked for."""

APART = 4.0
"""Ratio of two time scales around each of which durations are tried."""

FLAT = 1e-12
"""Costs at all durations that differ by less, relative to the problem's own scale, leave the duration open."""


def free_duration(instance: Instance, limits: Limits) -> Minimum | Extremal:
    """Find the duration that costs least, without bounds, or why there is none."""
    scale = time_scale(instance)
    guess = scale if instance.tf_guess is None else instance.tf_guess - instance.t0
    trials = Trials(instance, limits, guess)
    search = Search(trials, long_time(instance, scale))
    for around, powers in _plans(instance, scale, guess):
        if not search.tries:
            search.scan(around, powers)
    if not search.tries:
        return _unsolved(trials, limits)
    if search.flat(FLAT * trials.unit):
        message = f"nothing determines the final time: {_costs(search.tries[-3:])}; fix it"
        return _none(trials, Status.NO_MINIMISER, message)
    brackets = search.brackets
    found = [minimum for minimum in (search.minimum(a, b) for a, b in brackets[:POLISHED]) if minimum]
    best = min(found, key=lambda minimum: minimum.cost, default=None)
    if best and search.is_cheapest(best, FLAT * trials.unit):
        others = f"cheapest of {len(brackets)} minima over the duration" if len(brackets) > 1 else "minimum over time"
        return replace(best, message=others)
    if limits.expired:
        return _none(trials, Status.TIME_LIMIT, "time was up before a duration was found")
    return _none(trials, *_why(search))


def time_scale(instance: Instance) -> float:
    """One over the largest rate of the motion at the start: of the eigenvalues of f_x without control.

    Where these are zero, what the instance's own numbers tell; one if they tell nothing.
    """
    n = len(instance.initial)
    none = np.zeros((n, 1))
    nothing = tuple((sloping(instance, none) if instance.model.spec.throttled else none)[:, 0].tolist())
    slopes = instance.model.canonical_jacobian(
        instance.t0, instance.initial, nothing, instance.parameters, instance.control_set.without_bounds.arguments
    )
    fastest = np.abs(np.linalg.eigvals(np.array(slopes).reshape(2 * n, 2 * n)[:n, :n])).max()
    if np.isfinite(fastest) and fastest > NO_SLOPE:
        return 1.0 / float(fastest)
    return own_time(instance) or 1.0


def _plans(instance: Instance, scale: float, guess: float) -> list[tuple[float, tuple[int, int]]]:
    """Where durations are looked for, one place after the other: around what, and at which powers."""
    own = own_time(instance) or scale
    if instance.tf_guess is None:
        elsewhere = [(own, AROUND_SCALE)] if max(own / scale, scale / own) > APART else []
        return [(scale, AROUND_SCALE), *elsewhere]
    return [(guess, AROUND_GUESS), (scale, AROUND_SCALE)]


def _unsolved(trials: Trials, limits: Limits) -> Extremal:
    if limits.expired:
        return _none(trials, Status.TIME_LIMIT, "time was up before any duration was solved for")
    message = f"no extremal found at any of the durations tried; {_advice(trials)}"
    return _none(trials, Status.NOT_CONVERGED, message)


def _advice(trials: Trials) -> str:
    return "give a tf_guess" if trials.instance.tf_guess is None else "give another tf_guess"


def _why(search: Search) -> tuple[Status, str]:
    """Why there is no minimum, or none was found."""
    if search.ends_in_a_fall:
        costs = _costs(_records(search.tries))
        return Status.NO_MINIMISER, f"longer is always cheaper: {costs}; put a weight on time, or fix the final time"
    if search.ends_at_nothing:
        advice = "give time a smaller weight, constrain the final state, or fix the final time"
        return Status.NO_MINIMISER, f"shorter is always cheaper: {_costs(_spread(search.tries))}; {advice}"
    advice = _advice(search.trials)
    if search.falls_to_the_longest:
        costs = _costs(_records(search.tries))
        return Status.NOT_CONVERGED, f"the cost still falls at the longest duration solved: {costs}; {advice}"
    if search.falls_to_the_shortest:
        costs = _costs(search.tries[:3])
        return Status.NOT_CONVERGED, f"the cost still falls at the shortest duration solved: {costs}; {advice}"
    return Status.NOT_CONVERGED, f"no minimum over the duration settles near {search.cheapest.duration:g}"


def _none(trials: Trials, status: Status, message: str) -> Extremal:
    """No minimum; the last attempt is kept for the record."""
    problem, curve = trials.last
    return Extremal(problem, curve, float("inf"), status, message, trials.steps)


def _records(tries: list[Try]) -> list[Try]:
    """The last three that were cheaper than all shorter ones."""
    records: list[Try] = []
    for found in tries:
        if not records or found.cost < records[-1].cost:
            records.append(found)
    return records[-3:]


def _spread(tries: list[Try]) -> list[Try]:
    """The shortest, the longest of those over which the cost falls down to it, and one between."""
    falling = next((i for i in range(1, len(tries)) if tries[i].cost < tries[i - 1].cost), len(tries))
    return [tries[i] for i in sorted({0, (falling - 1) // 2, falling - 1})]


def _costs(tries: list[Try]) -> str:
    durations = ", ".join(f"{t.duration:.4g}" for t in tries)
    return f"cost {', '.join(f'{t.cost:.4g}' for t in tries)} at durations {durations}"
