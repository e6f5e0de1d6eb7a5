"""Restarts of arcs (stops), as many as the growth of errors along a course near an extremal requires.

Along a long singular arc, or in an unstable motion, nearly correct initial values lead to a large miss, and Newton's
method for a single flow diverges. Between stops, whose values are unknowns, deviations grow little (multiple shooting:
Bulirsch and Stoer, Introduction to Numerical Analysis, 7.3.5).
"""

from __future__ import annotations

from itertools import pairwise

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.extremal_arcs import Stop, growth
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import Course, Guess
from satsym.solvers.switching.throttled import equations

GROWS = 30.0
"""Largest growth of deviations between two stops."""

HALVINGS = 5
"""Maximum number of bisections of an arc. If deviations still grow too much, stops do not help and none are set."""


def stops(instance: Instance, at: Guess, course: Course, sizes: Array) -> tuple[tuple[Stop, ...], tuple[float, ...]]:
    """Return the stops and their times; none if deviations grow little, or without limit.

    Parameters
    ----------
    instance, at
        The instance, and the structure with its switching times.
    course
        Approximate states and costates along the motion.
    sizes
        Scales of states and costates, in which growth is measured, shape (2n,).
    """
    found: list[Stop] = []
    times: list[float] = []
    number = [0] * len(at.structure.levels)
    events = at.structure.events(at.times)
    edges = [instance.t0, *(event.time for event in events), at.end]
    for piece, (start, end) in enumerate(pairwise(edges)):
        field = equations(instance, tuple(row[k] for row, k in zip(at.structure.levels, number, strict=True)))
        shares = _shares(field, start, end, course, sizes) if end > start else []
        if shares is None:
            return (), ()
        found += [Stop(piece, share) for share in shares]
        times += [start + share * (end - start) for share in shares]
        if piece < len(events):
            number[events[piece].control] += 1
    return tuple(found), tuple(times)


def _shares(field: Field, start: float, end: float, course: Course, sizes: Array) -> list[float] | None:
    """Return fractions of an arc at which it restarts, by bisection; ``None`` if deviations always grow too much."""
    kept, parts = [0.0], [(0.0, 1.0, HALVINGS)]
    while parts:
        low, high, halvings = parts.pop()
        begin, until = (start + share * (end - start) for share in (low, high))
        if growth(field, begin, until, course.at(begin), sizes) > GROWS:
            if not halvings:
                return None
            middle = (low + high) / 2.0
            parts += [(middle, high, halvings - 1), (low, middle, halvings - 1)]
        else:
            kept.append(high)
    return kept[1:-1]
