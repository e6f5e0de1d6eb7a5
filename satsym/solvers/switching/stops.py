"""Where arcs begin anew: as often as the growth of their flow asks for, along something near an extremal.

Along a long singular arc, or beside an unstable motion, initial values that are nearly right lead anywhere: Newton's
method for one flow from the start to the end diverges. Between stops, whose values are unknowns, deviations grow little
(multiple shooting: Bulirsch and Stoer, Introduction to Numerical Analysis, 7.3.5).
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
"""By so much deviations may grow between stops."""

HALVINGS = 5
"""Halvings of an arc at most: what grows in so small a part as well is no flow that stops would tame."""


def stops(instance: Instance, at: Guess, course: Course, sizes: Array) -> tuple[tuple[Stop, ...], tuple[float, ...]]:
    """Places of stops and their times; none where flows grow little, or without end.

    Parameters
    ----------
    instance, at
        The structure of what problem, and its times.
    course
        Where it leads, roughly.
    sizes
        Of states and costates, in which growth is measured, shape (2n,).
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
    """Shares of an arc after which it begins anew: halved until no part grows more than it may, ``None`` if in vain."""
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
