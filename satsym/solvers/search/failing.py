"""Why a search has no answer: longer is always cheaper, or the end is out of reach."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np

from satsym.control_set import stated_constraints
from satsym.instance import Instance
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits, Meter
from satsym.solvers.search import coarse
from satsym.solvers.search.feasibility import contradiction
from satsym.solvers.search.nearest import nearest
from satsym.solvers.switching.linear.by_reach import unreachable
from satsym.solvers.switching.solving import NOT_FOUND
from satsym.solvers.switching.throttled import signs, switched
from satsym.status import Status

BETWEEN, FAINT_SLOPE, LASTING = 0.05, 1e-2, 0.35
"""Share of the width of its range by which a norm is off its bounds, share of the cost of a norm below which its
switching function decides nothing, and share of the time for which nothing decides it."""

LONGER, SHORTER = (4.0, 8.0, 16.0, 32.0), (0.25, 2.0**-4, 2.0**-6, 2.0**-8)
FAR_LONGER = (128.0, 512.0, 2048.0)
"""Multiples of the first guess of a free duration at which costs are looked at where no extremal is found: the last
ones where they fall all along, because a weight on time may only tell where the guess is far too short."""

FAR_OFF = 0.1
"""Relative miss of an end above which hardly any other start arrives."""

ENDLESS, EVEN = 1e-2, 1e-7
"""By what share of it the cost falls from each duration to a longer one where nothing keeps that from growing, and the
share of it, or of the unit of costs, by which costs differ at least that are not one."""


def why(instance: Instance, limits: Limits, early: bool = False) -> tuple[Status, str]:
    """The status of an instance of which no start leads to an extremal, and a message.

    Parameters
    ----------
    early
        Whether other starts are left: then only an end that is missed by far counts as out of reach.
    """
    if limits.late:
        return Status.TIME_LIMIT, "time was up before an extremal was found"
    message, limits = NOT_FOUND, replace(limits, meter=Meter())
    if instance.tf is None:
        message += f"; give {'a' if instance.tf_guess is None else 'another'} tf_guess"
    if instance.tf is not None and (separated := tried(partial(unreachable, instance, limits))):
        return Status.INFEASIBLE, separated
    if stated_constraints(instance.model.spec):
        against = tried(partial(contradiction, instance, limits))
        if against:
            return Status.INFEASIBLE, against
    if instance.tf is None:  # of ends that are out of reach nothing is said: another duration may reach them
        return _endless(instance, limits) or (Status.NOT_CONVERGED, message)
    several = [name for part in instance.model.spec.control_parts if part.ends for name in part.controls]
    near = None if several else tried(partial(nearest, instance, limits))
    if near is None or near.arrives:  # else no start leads to a motion of which anything could be undecided
        by_jumps = f"{message}; {_jumping(several)}" if several else message
        return Status.NOT_CONVERGED, _undecided(instance, limits) or by_jumps
    if limits.expired:
        return Status.NOT_CONVERGED, message
    if near.undecided or (early and near.distance <= FAR_OFF):
        return Status.NOT_CONVERGED, f"{message}; {near.message}, but other controls might reach it"
    return Status.INFEASIBLE, f"{near.message}; {message}"


def _jumping(controls: list[str]) -> str:
    """What is said of controls whose Hamiltonian may have several minimisers."""
    advice = "where two of them stay equally good there is no optimum (chattering)"
    return f"H may have several minimisers in {', '.join(controls)}, and {advice}"


def _endless(instance: Instance, limits: Limits) -> tuple[Status, str] | None:
    """Why no duration is the cheapest; ``None`` where costs at some durations do not show that."""
    longer, shorter = (coarse.costs_by_duration(instance, limits, shares) for shares in (LONGER, SHORTER))
    both = longer + shorter
    if longer and shorter and not any(_clearly_less(a, b) for a in both for b in both):
        return Status.NO_MINIMISER, f"nothing determines the final time: {_listed(longer)}; fix it"
    if _always_cheaper(instance, longer, limits):
        advice = "add a cost of time, or fix the final time"
        return Status.NO_MINIMISER, f"a longer duration is always cheaper: {_listed(longer)}; {advice}"
    if shorter and all(_clearly_less(b, a) for a, b in pairwise(shorter)):
        advice = "give time a smaller weight, constrain the final state, or fix the final time"
        return Status.NO_MINIMISER, f"shorter is always cheaper: {_listed(shorter)}; {advice}"
    return None


def _always_cheaper(instance: Instance, longer: list[coarse.Priced], limits: Limits) -> bool:
    """Whether each duration is clearly cheaper than the one before, and none cheaper than the longest of all.

    Those that are so long that the coarse mesh does not resolve them may have no costs, or too high ones.
    """
    if not longer or not all(_clearly_less(b, a, ENDLESS) for a, b in pairwise(longer)):
        return False
    far = [one for share in FAR_LONGER for one in coarse.costs_by_duration(instance, limits, (share,))]
    return not far or not any(_clearly_less(one, far[-1]) for one in [longer[-1], *far[:-1]])


def _clearly_less(one: coarse.Priced, than: coarse.Priced, share: float = EVEN) -> bool:
    """Whether a motion costs less than another by that share of it, and by more than rounding leaves."""
    return one.cost < than.cost - max(share * abs(than.cost), EVEN * than.unit)


def _listed(tried: list[coarse.Priced]) -> str:
    costs, durations = (
        ", ".join(f"{value:.4g}" for value in row)
        for row in zip(*((one.cost, one.duration) for one in tried), strict=True)
    )
    return f"cost {costs} at durations {durations}"


def _undecided(instance: Instance, limits: Limits) -> str:
    """What is said where norms are between their bounds for long: there no law is known."""
    spec = instance.model.spec
    if not spec.throttled:
        return ""
    at = coarse.first_motion(instance, limits)
    if at is None:
        return ""
    low, high = (np.array(bounds)[:, None] for bounds in instance.control_set.switching)
    filled = (switched(instance, at.u) - low) / np.where(high > low, high - low, 1.0)
    between = (filled > BETWEEN) & (filled < 1.0 - BETWEEN)
    sigma, priced = (signs(instance, at.times, at.x, costates)[0] for costates in (at.lam, np.zeros_like(at.lam)))
    price = np.abs(priced).max(axis=1, keepdims=True)
    with np.errstate(all="ignore"):  # where norms cost nothing, no slope is small beside their price
        faint = (np.abs(sigma) <= FAINT_SLOPE * price) & (price > 0.0)
    if not ((between | faint[:, 1:]) @ at.steps > LASTING * at.steps.sum()).any():
        return ""
    single = [c for part in spec.control_parts if part.branch == "switched" for c in part.controls]
    what = "the norm of a vector"
    if single:
        alone = all(part.branch != "throttled" for part in spec.control_parts)
        what = f"the value of {' or '.join(single)}" if alone else "the value of a control"
    return f"no law is known for {what} on an interval where the minimum principle does not determine it"
