"""Conditions on path constraints for extremals in exact arcs: whether they hold and have strict multipliers."""

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
"""Largest relative violation of a constraint; largest relative multiplier of the wrong sign that counts as zero;
minimum multiplier, relative to the largest one, that counts as strict; largest relative jump of states and costates
that counts as zero."""

BESIDE = 0.05
"""Fraction of a boundary arc, next to a singular arc, on which its multiplier may vanish."""


def on_boundary(again: Replay) -> bool:
    """Return whether any arc is on the boundary of a path constraint."""
    return any(isinstance(piece.field, BoundaryField) for piece in again.pieces)


def still(again: Replay) -> bool:
    """Return whether the active path constraints do not depend on time explicitly, so that H is constant."""
    fields = ((piece.field, piece.end, piece.after.tolist()) for piece in again.pieces)
    return not any(
        isinstance(one, BoundaryField) and off_boundary(one.instance, one.constraint, t, z)[2] for one, t, z in fields
    )


def necessary(solution: Solution, again: Replay) -> list[Check]:
    """Return checks that constraints hold along the replay and that boundary multipliers have the right sign."""
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
    """Return the largest distance from the boundary on boundary arcs, relative to constraint magnitudes, shape (h,)."""
    found = [0.0]
    for piece in again.pieces:
        if isinstance(piece.field, BoundaryField):
            k = piece.field.constraint
            found.append(float(np.abs(values(piece.field.instance, *again.along(piece))[k]).max() / room[k]))
    return max(found)


def _jumps(again: Replay) -> list[tuple[float, float]]:
    """Return multipliers at the ends of boundary arcs, and the part of jumps that multipliers do not explain."""
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
    """Return whether costates jump at the entry or exit of a boundary arc."""
    return any(by > JUMP for by, _ in _jumps(again))


def strict(again: Replay) -> list[Check]:
    """Return a check that multipliers on boundaries are strictly positive."""
    return [Check("a multiplier vanishes on a boundary arc", float(not _pressure(again, BESIDE) > STRICT), 0.0)]


def _pressure(again: Replay, beside: float) -> float:
    """Return the smallest multiplier on boundary arcs, relative to the largest.

    A fraction ``beside`` of an arc next to a singular arc is left out.
    """
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
