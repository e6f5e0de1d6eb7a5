"""What the certificate of exact arcs says of path constraints: whether they hold, and whether they press strictly."""

from __future__ import annotations

import numpy as np

from satsym.solution import Check, Solution
from satsym.solvers.certificate.switching.junction_times import curvature
from satsym.solvers.certificate.switching.replay import Piece, Replay
from satsym.solvers.switching.boundaries import values
from satsym.solvers.switching.boundary import BoundaryField
from satsym.solvers.switching.structure import SINGULAR

VIOLATED, PULLING, STRICT = 1e-9, 1e-8, 1e-6
"""Largest violation of a constraint relative to its size, largest multiplier of the wrong sign, and least share of the
largest multiplier that is strict."""

CURVED = 1e-7
"""Least relative curvature in the switching times."""

BESIDE = 0.05
"""Share of a boundary arc beside a singular one, next to which its multiplier may vanish."""


def on_boundary(again: Replay) -> bool:
    """Whether any arc is on a boundary."""
    return any(isinstance(piece.field, BoundaryField) for piece in again.pieces)


def necessary(solution: Solution, again: Replay) -> list[Check]:
    """Constraints hold along the replay, and multipliers of those on their boundaries have the right sign."""
    instance = solution.instance
    derived = np.array([one.order > 0 for one in instance.model.spec.path_constraints])
    g = values(instance, again.times, again.z)[derived]
    room = np.maximum(np.abs(g).max(axis=1, keepdims=True), 1e-300)
    checks = [Check("path constraint violated", float(np.maximum(g / room, 0.0).max()), VIOLATED)]
    if on_boundary(again):
        checks.append(Check("multiplier on a boundary is negative", max(0.0, -_pressure(again, 0.0)), PULLING))
    return checks


def sufficient(solution: Solution, again: Replay) -> list[Check]:
    """Multipliers press strictly, and the second variation in the times is positive."""
    pressed, curved = _pressure(again, BESIDE), curvature(solution.instance, again)
    return [
        Check("multiplier vanishes on a boundary", float(not pressed > STRICT), 0.0),
        Check("second variation in the switching times", float(not curved > CURVED), 0.0),
    ]


def _pressure(again: Replay, beside: float) -> float:
    """The least multiplier on boundaries, relative to the largest; this share of an arc beside a singular one apart."""
    found = []
    for k, piece in enumerate(again.pieces):
        if isinstance(piece.field, BoundaryField):
            singular = [_singular(again.pieces[i]) if 0 <= i < len(again.pieces) else False for i in (k - 1, k + 1)]
            low, high = (beside * flag * (piece.end - piece.start) for flag in singular)
            inside = (again.times >= piece.start + low) & (again.times <= piece.end - high)
            found.append(piece.field.multiplier(again.times[inside], again.z[:, inside]))
    every = np.concatenate(found)
    return float(every.min() / max(np.abs(every).max(), 1e-300))


def _singular(piece: Piece) -> bool:
    return SINGULAR in piece.field.levels
