"""Exact arcs from smoothed extremals: structures that are recognised while less and less is smoothed."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.solvers.failures import FAILURES
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.chattering import NARROW, Look, look, shows
from satsym.solvers.switching.cold_start import homotopy
from satsym.solvers.switching.cold_start.recognition import Sample, guess, inside, sample
from satsym.solvers.switching.structure import Course, Guess
from satsym.status import Status

STEADY = 0.5
"""Share of the time off the bounds that is left after smoothing less, where that time is a singular arc's."""


def smoothed(instance: Instance, course: Course | None, limits: Limits) -> Exact | homotopy.Stopped:
    """Exact arcs with a structure that is recognised where less and less is smoothed, or why there are none.

    Structures without an arc that seems to be singular seldom lead anywhere, so they are tried once all smoothed
    extremals show no better one.

    Parameters
    ----------
    course
        A motion near which the first smoothed extremal is looked for.
    """
    if course is None:
        return homotopy.Stopped(Status.NOT_CONVERGED, "")
    before: Sample | None = None
    levels: list[homotopy.Smoothed] = []
    unlikely: list[tuple[Guess, float]] = []
    looks: list[Look] = []
    endless = bool(instance.model.spec.chattering)
    most = homotopy.LEVELS * (2 if endless else 1)
    try:
        for level, near in enumerate(homotopy.path(instance, course, limits, most)):
            seen = sample(near.problem, near.curve)
            levels.append(near)
            smoothing = near.problem.control_set.smoothing
            if endless:
                looks.append(look(instance, near, seen))
                if level >= homotopy.LEVELS and (looks[-1].width <= NARROW or not shows(looks)):
                    break
            likeliest, *plainer = _candidates(instance, seen, before)
            exact = attempt(instance, likeliest, limits) if level <= homotopy.LEVELS else None
            if exact is not None:
                return replace(exact, origin=Origin.SMOOTHED, smoothing=smoothing)
            unlikely += [(one, smoothing) for one in plainer]
            before = seen
            if limits.expired:
                break
    except homotopy.Stopped as stopped:
        last_seen = stopped
    except FAILURES as error:
        last_seen = homotopy.Stopped(Status.NOT_CONVERGED, f"no regularised solution was found ({error})")
    else:
        message = "no structure recognised in regularised solutions satisfies Pontryagin's minimum principle"
        last_seen = homotopy.Stopped(Status.NOT_CONVERGED, message, levels[-1].problem, levels[-1].curve)
    if shows(looks) and not limits.expired:
        return replace(last_seen, chattering=tuple(levels))
    for one, smoothing in unlikely:
        if limits.expired:
            break
        if exact := attempt(instance, one, limits):
            return replace(exact, origin=Origin.SMOOTHED, smoothing=smoothing)
    if limits.expired:
        return replace(last_seen, status=Status.TIME_LIMIT, message=f"time was up: {last_seen.message}")
    return last_seen


def _candidates(instance: Instance, seen: Sample, before: Sample | None) -> list[Guess]:
    """Structures of a smoothed extremal, the likeliest first."""
    plain = guess(instance, seen)
    free = inside(instance, seen)
    if before is None or not free.any():
        return [plain]
    was = inside(instance, before)
    steady = [_time(seen, now) >= STEADY * _time(before, then) for now, then in zip(free, was, strict=True)]
    spec = instance.model.spec
    joined = [name not in spec.chattering for name in spec.control_names]
    singular = free & np.array(steady)[:, None] & np.array(joined)[:, None]
    if not singular.any():
        return [plain]
    return [guess(instance, seen, singular), plain]


def _time(seen: Sample, where: NDArray[np.bool_]) -> float:
    return float(np.trapezoid(where.astype(float), seen.times))
