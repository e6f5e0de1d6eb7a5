"""Switches at the initial or final time, where a free final state makes a switching function vanish.

Such an extremal has strict switching if the condition holds at these switches too. Each of them is represented by an
arc of no length, whose end may vary like any other.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.certificate.switching.replay import Piece, Replay
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.magnitudes import effective
from satsym.solvers.switching.structure import LOWER, REST, SINGULAR, UPPER
from satsym.solvers.switching.throttled import equations

AT_SWITCH = 1e-9
"""Relative distance of a switching function from its switching value below which a control switches at an end."""


def with_end_switches(again: Replay, sizes: list[float]) -> Replay:
    """Return the replay with an arc of no length added at an end where a control is about to switch.

    Parameters
    ----------
    sizes
        Magnitudes of the switching functions.
    """
    pieces = list(again.pieces)
    first, last = pieces[0], pieces[-1]
    for control, size in enumerate(sizes):
        if (level := _beyond(last.field, last.end, last.after, control, size)) is not None:
            field = _at(pieces[-1].field, control, level)
            pieces[-1] = replace(pieces[-1], switched=control)
            pieces.append(
                Piece(field, last.end, last.end, last.after, last.after, None, np.eye(len(last.after)), last.spread)
            )
        if (level := _beyond(first.field, first.start, first.before, control, size)) is not None:
            field = _at(pieces[0].field, control, level)
            same = np.eye(len(first.before))
            pieces.insert(0, Piece(field, first.start, first.start, first.before, first.before, control, same, same))
    return replace(again, pieces=pieces)


def _beyond(field: Field, t: float, z: Array, control: int, size: float) -> int | None:
    """Return the level of a control beyond the switch at the given time; ``None`` if it does not switch then."""
    here, level = z.tolist(), field.levels[control]
    low, high = field.instance.control_set.switching
    if level >= SINGULAR or low[control] == high[control]:
        return None
    given = low[control], high[control], field.sigma(t, here, control), field.weight(t, here, control)
    sigma, weight = map(float, effective(*map(np.array, given)))
    if abs(abs(sigma) - weight) > AT_SWITCH * size:
        return None
    if weight == 0.0:
        return UPPER if level == LOWER else LOWER
    return (LOWER if sigma > 0.0 else UPPER) if level == REST else REST


def _at(field: Field, control: int, level: int) -> Field:
    levels = (*field.levels[:control], level, *field.levels[control + 1 :])
    return equations(field.instance, levels)
