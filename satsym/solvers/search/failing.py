"""Why a search has no answer: longer is always cheaper, or the end is out of reach."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from satsym.control_set import stated_constraints
from satsym.instance import Instance
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits, Meter
from satsym.solvers.search import order
from satsym.solvers.search.feasibility import contradiction
from satsym.solvers.switching.linear.by_reach import unreachable
from satsym.solvers.switching.solving import NOT_FOUND
from satsym.solvers.switching.throttled import switched
from satsym.status import Status

if TYPE_CHECKING:
    from satsym.solvers.nearest_end import Nearest

BETWEEN, LASTING = 0.05, 0.35
"""Share of the width of its range by which a norm is off its bounds, and of the time for which nothing decides it."""

LONGER, ENDLESS = (4.0, 8.0, 16.0, 32.0), 1e-2
"""Multiples of the first guess of a free duration at which costs are looked at where no extremal is found, and by what
share of it the cost falls from each to the next where nothing keeps the duration from growing."""


def why(instance: Instance, limits: Limits) -> tuple[Status, str]:
    """The status of an instance of which no start leads to an extremal, and a message."""
    if limits.late:
        return Status.TIME_LIMIT, "time was up before an extremal was found"
    message, limits = NOT_FOUND, replace(limits, meter=Meter())
    if instance.tf is not None and (separated := tried(partial(unreachable, instance, limits))):
        return Status.INFEASIBLE, separated
    if stated_constraints(instance.model.spec):
        against = tried(partial(contradiction, instance, limits))
        if against:
            return Status.INFEASIBLE, against
    if instance.tf is None:
        costs = order.costs_by_duration(instance, limits, LONGER)
        if len(costs) == len(LONGER) and all(b < a - ENDLESS * abs(a) for (_, a), (_, b) in pairwise(costs)):
            values = ", ".join(f"{cost:.4g}" for _, cost in costs)
            durations = ", ".join(f"{duration:.4g}" for duration, _ in costs)
            advice = "put a weight on time, or fix the final time"
            return Status.NO_MINIMISER, f"longer is always cheaper: cost {values} at durations {durations}; {advice}"
        return Status.NOT_CONVERGED, f"{message}; give {'a' if instance.tf_guess is None else 'another'} tf_guess"
    if reason := _undecided(instance, limits):
        return Status.NOT_CONVERGED, reason
    if compared := [name for part in instance.model.spec.control_parts if part.ends for name in part.controls]:
        several = f"H may have several minimisers in {', '.join(compared)}"
        advice = "where two of them stay equally good there is no optimum (chattering)"
        return Status.NOT_CONVERGED, f"{message}; {several}, and {advice}"
    near = tried(partial(_nearest, instance, limits))
    if near is None or near.arrives or limits.expired:
        return Status.NOT_CONVERGED, message
    if near.undecided:
        return Status.NOT_CONVERGED, f"{message}; {near.message}, but other controls may reach it"
    return Status.INFEASIBLE, f"{near.message}; {message}"


def _undecided(instance: Instance, limits: Limits) -> str:
    """What is said where norms are between their bounds for long: there no law is known."""
    spec = instance.model.spec
    if not spec.throttled:
        return ""
    at = order.first_motion(instance, limits)
    if at is None:
        return ""
    low, high = (np.array(bounds)[:, None] for bounds in instance.control_set.switching)
    filled = (switched(instance, at.u) - low) / np.where(high > low, high - low, 1.0)
    between = (filled > BETWEEN) & (filled < 1.0 - BETWEEN)
    if not (between @ at.steps > LASTING * at.steps.sum()).any():
        return ""
    single = [c for part in spec.control_parts if part.branch == "switched" for c in part.controls]
    what = "the norm of a vector"
    if single:
        alone = all(part.branch != "throttled" for part in spec.control_parts)
        what = f"the value of {' or '.join(single)}" if alone else "the value of a control"
    return f"for some time nothing decides {what}, and no law is known there"


def _nearest(instance: Instance, limits: Limits) -> Nearest | None:
    """How near to the end controls come that start from the extremal without bounds, or from the straight line."""
    from satsym.solvers.cold_start.first_minimum import cold_start
    from satsym.solvers.cold_start.paths import start
    from satsym.solvers.collocation.scaling import two_point
    from satsym.solvers.control.regularised import regularised
    from satsym.solvers.nearest_end import nearest

    spec = instance.model.spec
    if spec.switching or spec.throttled or spec.directional:
        instance = regularised(instance, 1.0, 1.0)
    assert instance.tf is not None
    with np.errstate(all="ignore"):
        problem = two_point(instance, instance.tf - instance.t0)
        free = tried(partial(cold_start, problem, limits))
        path = start(problem) if free is None or not free.found.minimum else free.found.curve
        return nearest(problem, path, replace(limits, work=math.inf))
