"""Arcs of controls at their bounds, read from a motion by its switching functions, and made exact."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.iteration import Limits
from satsym.solvers.search.motion import Motion
from satsym.solvers.switching.answers import answered
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.recognition import Sample, guess, inside
from satsym.solvers.switching.structure import Guess
from satsym.solvers.switching.throttled import signs


def exact(instance: Instance, at: Motion, limits: Limits) -> Solution | None:
    """The extremal of exact arcs that a motion is near; ``None`` where there is none.

    Controls are taken for bang-bang first; where that leads to no extremal, and they are off their bounds for long,
    for singular there.
    """
    began = time.perf_counter()
    with np.errstate(all="ignore"):
        found = _first(instance, at, limits)
    return None if found is None else answered(instance, replace(found, origin=Origin.SEARCH), (), began)


def _first(instance: Instance, at: Motion, limits: Limits) -> Exact | None:
    known: list[Guess] = []
    for one in _guesses(instance, at):
        if all(one.structure != other.structure for other in known):
            found = attempt(instance, one, limits)
            if found is not None:
                return found
            known.append(one)
    return None


def _guesses(instance: Instance, at: Motion) -> list[Guess]:
    n, z = len(at.x), np.concatenate([at.x, at.lam])
    u = np.concatenate([at.u[:, :1], at.u], axis=1)
    seen = Sample(at.times, z, u, *signs(instance, at.times, z[:n], z[n:]))
    plain = guess(instance, seen)
    if instance.model.spec.throttled:
        return [plain]
    return [plain, guess(instance, seen, inside(instance, seen))]
