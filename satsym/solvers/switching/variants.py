"""Structures next to a guessed one: with an arc less or more at either end."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from satsym.instance import Instance
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import nearest
from satsym.solvers.switching.structure import LOWER, REST, UPPER, Guess

SHORT = 0.2
"""Share of the first or last arc that an arc before or after it is given."""

BRIEF = 0.01
"""Share of the duration below which a first or last arc may be none."""

NEARLY = 1e-2
"""Residual of a structure that lacks no more than an arc of little length."""


def neighbours(instance: Instance, guess: Guess, limits: Limits) -> Iterator[Guess]:
    """All of them, the likeliest first.

    An extremal next to one with fewer switches has an arc so short that only the longer arcs are recognised: what
    comes nearest without it is the start for one more.
    """
    yield from _without_short(guess, instance.t0)
    for fewer in _without_ends(guess):
        yield fewer
        near = nearest(instance, fewer, limits)
        if near is not None and near.residual < NEARLY:
            at = Guess(near.structure, near.at.times, near.at.costates, near.at.end)
            yield from _with_one_more(instance, at)
    yield from _with_one_more(instance, guess)


def _without_ends(guess: Guess) -> Iterator[Guess]:
    """Without the first or the last arc of a control."""
    for control, row in enumerate(guess.structure.levels):
        for arc in (0, len(row) - 1) if len(row) > 1 else ():
            structure, kept = guess.structure.without_arc(control, arc)
            yield replace(guess, structure=structure, times=guess.times[kept])


def _with_one_more(instance: Instance, guess: Guess) -> list[Guess]:
    """The same with one more short arc at the start or at the end of a control."""
    found = []
    for control, row in enumerate(guess.structure.levels):
        low, high = instance.control_set.switching
        if low[control] == high[control]:
            continue
        own = guess.structure.by_control(guess.times)
        begin, end = min([*own[control], guess.end]), max([instance.t0, *own[control]])
        early = instance.t0 + SHORT * (begin - instance.t0)
        late = guess.end - SHORT * (guess.end - end)
        for place, time, beside in ((0, early, row[0]), (len(row), late, row[-1])):
            for level in {LOWER: (UPPER,), UPPER: (LOWER,), REST: (LOWER, UPPER)}.get(beside, ()):
                levels = (*row[:place], level, *row[place:])
                times = [*own]
                times[control] = np.insert(own[control], 0 if place == 0 else len(own[control]), time)
                structure = guess.structure.with_levels(control, levels)
                found.append(replace(guess, structure=structure, times=np.concatenate(times)))
    return found


def _without_short(guess: Guess, start: float) -> list[Guess]:
    """The same without arcs at the ends that may be none, if there are any."""
    at, lasting = guess, guess.end - start
    for control in range(len(guess.structure.levels)):
        for last in (False, True):
            lengths = at.structure.durations(at.times, start, at.end)[control]
            if len(lengths) > 1 and lengths[-1 if last else 0] < BRIEF * lasting:
                structure, kept = at.structure.without_arc(control, len(lengths) - 1 if last else 0)
                at = replace(at, structure=structure, times=at.times[kept])
    return [at] if at is not guess else []
