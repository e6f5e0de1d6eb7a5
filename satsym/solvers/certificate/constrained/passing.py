"""Checks of waypoints: whether each is passed, and whether passing it earlier or later changes the cost."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Check, Solution
from satsym.solvers.certificate.constrained.replay import Replay
from satsym.solvers.constrained.arcs import conditions, gradient, missed
from satsym.solvers.constrained.equations import hamiltonian
from satsym.solvers.constrained.structure import within

MISSED, STATIONARY = 1e-9, 1e-8
"""Largest admissible distance from a waypoint, relative to the terms of its conditions, and largest admissible
derivative of the cost with respect to the time of the waypoint, relative to the terms of H."""


def places(solution: Solution) -> list[int]:
    """Return the indices of the arcs that end at a waypoint."""
    return [k for k, group in enumerate(within(solution)) if any(one.kind == "interior" for one in group)]


def passing(solution: Solution, again: Replay) -> list[Check]:
    """Return checks of the waypoints; an empty list if there are none."""
    which, found = conditions(solution.instance), places(solution)
    if not which:
        return []
    if len(found) != len(which):
        return [Check("waypoints that are not passed", float(len(which) - len(found)), 0.0)]
    met = [_met(solution, again, k, own) for k, own in zip(found, which, strict=True)]
    return [
        Check("distance of the motion from its waypoints", max(off for off, _ in met), MISSED),
        Check(
            "derivative of the cost with respect to the times at the waypoints",
            max(slope for _, slope in met),
            STATIONARY,
        ),
    ]


def drifting(solution: Solution, again: Replay) -> bool:
    """Return whether waypoints move with time, so that H jumps where they are passed."""
    which = conditions(solution.instance)
    return any(_drift(solution, again, k, own).any() for k, own in zip(places(solution), which, strict=False))


def _drift(solution: Solution, again: Replay, arc: int, which: range) -> Array:
    piece = again.pieces[arc]
    return missed(solution.instance, which, piece.times[-1:], piece.z[: len(solution.x), -1:])[1]


def _met(solution: Solution, again: Replay, arc: int, which: range) -> tuple[float, float]:
    """Return the distance from a waypoint after an arc and the derivative of the cost by its time, both relative."""
    instance, n = solution.instance, len(solution.x)
    left, right = again.pieces[arc], again.pieces[arc + 1]
    t, z = left.times[-1:], left.z[:, -1:]
    off, drift = (rows[:, 0] for rows in missed(instance, which, t, z[:n]))
    typical = np.abs(solution.x).max(axis=1)
    terms = [np.abs(gradient(instance, k, t, z[:n])[:, 0]) @ typical for k in which]
    h = [float(hamiltonian(instance, one.active, t, at)[0]) for one, at in ((left, z), (right, right.z[:, :1]))]
    moved = float(np.array([again.jumps[arc][k] for k in which]) @ drift)
    rates = np.asarray(instance.model.dynamics_batch(t, z[:n], solution.u[:, :1] * 0.0, instance.parameters))[:, 0]
    size = max(np.abs(z[n:, 0] * rates).sum(), *map(abs, h), abs(moved), 1e-300)
    return float((np.abs(off) / np.maximum(terms, 1e-300)).max()), float(abs(h[0] - h[1] + moved) / size)
