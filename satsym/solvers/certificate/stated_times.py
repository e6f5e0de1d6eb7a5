"""Comparison of the stated times of an answer, of events and of switching, with its trajectory."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from satsym.methods import BOUNDARY_ARCS
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.constrained.arcs import sizes, values
from satsym.solvers.constrained.violation import between
from satsym.solvers.failures import tried
from satsym.status import Verdict

ARCS = ("bang-bang", BOUNDARY_ARCS)
"""Names of the methods whose answers consist of arcs."""

TIMES = "stated times of events"
SATURATION = "stated times of saturation"
TO_A_NODE = "stated switching times, to the spacing of the nodes"
TIMES_APART, MET = 1e-8, 1e-6
"""Largest distance of a stated time from a junction, relative to the duration; and largest distance of the control law
from its bound at a stated time, relative to the range of the control."""

ACTIVE, ROUNDED_OFF = 1e-9, 1e-12
"""Largest magnitude of a path constraint, relative to its largest value along the motion, at which the constraint
counts as active; and the smallest magnitude at which it counts as inactive on an interval. The latter is small since a
constraint hardly leaves its boundary between a touch point and an arc soon after it."""


def with_stated_times(certificate: Certificate, solution: Solution) -> Certificate:
    """Return a certificate with checks of the stated times of an answer; its verdict is "failed" if one is wrong."""
    with np.errstate(all="ignore"):
        found = tried(lambda: checks(solution)) or []
    verdict = certificate.verdict if all(check.passed for check in found) else Verdict.FAILED
    return replace(certificate, verdict=verdict, checks=(*certificate.checks, *found))


def checks(solution: Solution) -> list[Check]:
    """Compare stated times with the trajectory; the list is empty if the answer has no such times.

    If a control switches infinitely often, no control law reproduces its switching times; only the nodes show them.

    The trajectory of an answer in arcs has two nodes at each junction, and each junction has an event or a switching
    time. If the control is continuous, the unbounded control law reaches a bound at each stated time.
    """
    if solution.interval is not None:
        return [Check(TO_A_NODE, _off_changes(solution), 0.0)]
    in_arcs = solution.method in ARCS or any(one.kind != "jump" for one in solution.events)
    if in_arcs:
        return [Check(TIMES, _off_junctions(solution), TIMES_APART)]
    bounded = solution.instance.control_set.bounded and not solution.instance.model.spec.switching
    found = [Check(TIMES, _off_jumps(solution), TIMES_APART)] if solution.events else []
    return [*found, Check(SATURATION, _off_bounds(solution), MET)] if bounded else found


def _off_junctions(solution: Solution) -> float:
    """Return the largest distance between stated times and junctions, relative to the duration."""
    if not all(_shown(solution, event.kind, event.name, event.t) for event in solution.events):
        return 1.0
    times = solution.times
    begin, end = float(times[0]), float(times[-1])
    junctions = times[:-1][(np.diff(times) == 0.0) & (times[:-1] > begin) & (times[:-1] < end)]
    stated = np.array([t for row in solution.switching_times for t in row] + [one.t for one in solution.events])
    stated = stated[(stated > begin) & (stated < end)]
    if not len(junctions) or not len(stated):
        return float(len(junctions) != len(stated))
    apart = np.abs(stated[:, None] - junctions)
    return float(max(apart.min(axis=0).max(), apart.min(axis=1).max())) / (end - begin)


def _shown(solution: Solution, kind: str, name: str, t: float) -> bool:
    """Return whether the trajectory shows a stated event: a constraint becomes active or inactive, or is touched."""
    instance, times = solution.instance, solution.times
    if kind == "interior":
        return name in [one.name for one in instance.model.spec.interior]
    if kind == "jump":
        return name in instance.model.spec.control_names
    names = [one.name for one in instance.model.spec.path_constraints]
    if name not in names or kind not in ("entry", "exit", "touch"):
        return False
    row = values(instance, times, solution.x, solution.u)[names.index(name)]
    size = max(float(sizes(instance, times, solution.x, solution.u)[names.index(name)]), float(np.abs(row).max()))
    off, near = np.abs(row) / size, TIMES_APART * float(times[-1] - times[0])
    if not (off[np.abs(times - t) <= near] <= ACTIVE).any():
        return False
    stated = [float(times[0]), *(one.t for one in solution.events if one.name == name), float(times[-1])]
    before = (times < t - near) & (times > max((one for one in stated if one < t - near), default=t) + near)
    after = (times > t + near) & (times < min((one for one in stated if one > t + near), default=t) - near)
    shown = {"entry": (False, True), "exit": (True, False), "touch": (False, False)}[kind]
    return all(
        not side.any() or (float(off[side].max()) <= ACTIVE if on else float(off[side].max()) > ROUNDED_OFF)
        for side, on in zip((before, after), shown, strict=True)
    )


def _off_changes(solution: Solution) -> float:
    """Return 1 if a control is constant around a time at which it is stated to switch, otherwise 0."""
    for row, stated in zip(solution.u, solution.switching_times, strict=True):
        for t in stated:
            k = int(np.searchsorted(solution.times, t))
            if np.ptp(row[max(k - 2, 0) : k + 2]) == 0.0:
                return 1.0
    return 0.0


def _off_jumps(solution: Solution) -> float:
    """Return the largest distance of a stated jump from the nearest node, relative to the duration."""
    names, times = solution.instance.model.spec.control_names, solution.times
    if any(one.name not in names for one in solution.events):
        return 1.0
    return max(float(np.abs(times - one.t).min()) for one in solution.events) / float(times[-1] - times[0])


def _off_bounds(solution: Solution) -> float:
    """Return the largest distance of the control law from a bound at stated times, relative to its range.

    Returns 1 if the law reaches a bound without a stated time. Between nodes, states and costates are cubic Hermite
    polynomials. The time of a jump from bound to bound, where the law is on neither bound, is compared elsewhere.
    """
    instance, times = solution.instance, solution.times
    within, lasting = instance.control_set, float(times[-1] - times[0])
    stated = np.unique([t for row in solution.switching_times for t in row])
    at = np.concatenate([times, stated])
    problem = two_point(replace(instance, t0=float(times[0]), tf=float(times[-1]), tf_guess=None), lasting)
    scaled, tau = between(solution, at) / problem.scale.both, (at - times[0]) / lasting
    room = within.excess(problem.control(tau, scaled, problem.theta, bounded=False))
    for event in solution.events:
        room[:, len(times) :][:, np.abs(stated - event.t) <= TIMES_APART * lasting] = 0.0
    low, high = (np.asarray(one).ravel() for one in within.around(len(solution.u)))
    size = float(np.max(np.where(np.isfinite(high - low), high - low, 0.0), initial=0.0)) or 1.0
    nodes, met = room[:, : len(times)], np.abs(room[:, len(times) :]).min(axis=0, initial=np.inf)
    signs = np.sign(np.where(np.abs(nodes) <= MET * size, 0.0, nodes))
    for row in signs:
        place = np.flatnonzero(row)
        for k, after in pairwise(place):
            if row[k] != row[after] and not ((stated >= times[k]) & (stated <= times[after])).any():
                return 1.0
    return float(met.max(initial=0.0)) / size
