"""What the certificate of exact arcs says of path constraints: whether they hold, and whether they press strictly."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.solution import Check, Solution
from satsym.solvers.certificate.switching.replay import Piece, Replay
from satsym.solvers.switching.boundaries import jump, values
from satsym.solvers.switching.boundary import BoundaryField, off_boundary, pushed
from satsym.solvers.switching.structure import SINGULAR

VIOLATED, PULLING, STRICT, JUMP = 1e-9, 1e-8, 1e-6, 1e-7
"""Largest violation of a constraint relative to its size, largest multiplier of the wrong sign, least share of the
largest multiplier that is strict, and largest jump of states and costates that is none."""

BESIDE = 0.05
"""Share of a boundary arc beside a singular one, next to which its multiplier may vanish."""


def on_boundary(again: Replay) -> bool:
    """Whether any arc is on a boundary."""
    return any(isinstance(piece.field, BoundaryField) for piece in again.pieces)


def still(again: Replay) -> bool:
    """Whether the boundaries do not move by themselves, so that H is constant along them."""
    fields = ((piece.field, piece.end, piece.after.tolist()) for piece in again.pieces)
    return not any(
        isinstance(one, BoundaryField) and off_boundary(one.instance, one.constraint, t, z)[2] for one, t, z in fields
    )


def necessary(solution: Solution, again: Replay) -> list[Check]:
    """Constraints hold along the replay, and multipliers of those on their boundaries have the right sign."""
    instance = solution.instance
    derived = np.array([one.order > 0 for one in instance.model.spec.path_constraints])
    g = values(instance, again.times, again.z)
    room = np.maximum(np.abs(g).max(axis=1, keepdims=True), 1e-300)
    checks = [Check("path constraint violated", float(np.maximum(g / room, 0.0)[derived].max()), VIOLATED)]
    if on_boundary(again):
        checks.append(Check("off the boundary on its arcs", _off(again, room[:, 0]), VIOLATED))
        checks.append(Check("multiplier on a boundary is negative", max(0.0, -_pressure(again, 0.0)), PULLING))
        jumps = _jumps(again)
        checks.append(Check("multiplier at a junction is negative", max([0.0, *(-by for by, _ in jumps)]), PULLING))
        checks.append(Check("jump of the costates", max([0.0, *(off for _, off in jumps)]), JUMP))
    return checks


def _off(again: Replay, room: Array) -> float:
    """Largest distance from boundaries along arcs on these, relative to sizes of constraints, shape (h,)."""
    found = [0.0]
    for piece in again.pieces:
        if isinstance(piece.field, BoundaryField):
            k = piece.field.constraint
            found.append(float(np.abs(values(piece.field.instance, *again.along(piece))[k]).max() / room[k]))
    return max(found)


def _jumps(again: Replay) -> list[tuple[float, float]]:
    """Multipliers where boundary arcs begin and end, and what states and costates jump besides, relative to sizes."""
    found = []
    for before, after in pairwise(again.pieces):
        for field in (before.field, after.field):
            if isinstance(field, BoundaryField):
                by, size = jump(field, before.end, before.after, after.before)
                pushed_to = pushed(field.instance, field.constraint, before.end, before.after, by)[0]
                rest, sizes = np.abs(after.before - pushed_to), np.abs(before.after) + np.abs(after.before)
                found.append((by / size, float((rest / np.maximum(sizes, sizes.max() * JUMP)).max())))
    return found


def jumping(again: Replay) -> bool:
    """Whether costates jump where boundary arcs begin or end."""
    return any(by > JUMP for by, _ in _jumps(again))


def strict(again: Replay) -> list[Check]:
    """Whether multipliers press strictly."""
    return [Check("a multiplier vanishes on a boundary arc", float(not _pressure(again, BESIDE) > STRICT), 0.0)]


def _pressure(again: Replay, beside: float) -> float:
    """The least multiplier on boundaries, relative to the largest; this share of an arc beside a singular one apart."""
    found = []
    for k, piece in enumerate(again.pieces):
        if isinstance(piece.field, BoundaryField):
            singular = [_singular(again.pieces[i]) if 0 <= i < len(again.pieces) else False for i in (k - 1, k + 1)]
            low, high = (beside * flag * (piece.end - piece.start) for flag in singular)
            times, z = again.along(piece)
            inside = (times >= piece.start + low) & (times <= piece.end - high)
            found.append(piece.field.multiplier(times[inside], z[:, inside]))
    every = np.concatenate(found)
    return float(every.min() / max(np.abs(every).max(), 1e-300))


def _singular(piece: Piece) -> bool:
    return SINGULAR in piece.field.levels
