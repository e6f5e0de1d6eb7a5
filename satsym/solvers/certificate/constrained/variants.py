"""Competitors with a sequence of boundary arcs similar to that of the answer: one contact is removed or replaced.

A contact is a boundary arc or a touch point of a path constraint.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from satsym.solution import Solution
from satsym.solvers.constrained.newton import begun, cost, solved
from satsym.solvers.constrained.revision import wrong
from satsym.solvers.constrained.structure import Contact, Structure, ordered
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits

SHORT_ARC = 0.02
"""Length of an arc that replaces a touch point, before it and after it together, as a fraction of the duration."""

WORK = 20_000
"""Maximum number of points at which equations may be linearised for one variant."""


def near(solution: Solution, deadline: float) -> tuple[int, list[float], bool]:
    """Solve the variants; return their number, the costs of the admissible extremals, and whether time was up."""
    costs, count = list[float](), 0
    for structure in _variants(solution):
        limits = Limits(200, deadline, work=WORK)
        found = tried(partial(_extremal, solution, structure, limits))
        if limits.late:
            return count, costs, True
        count += 1
        costs += [] if found is None else [found]
    return count, costs, False


def _extremal(solution: Solution, structure: Structure, limits: Limits) -> float | None:
    """Return the cost of the admissible extremal with a given structure near a solution, or ``None``."""
    nothing = np.zeros(len(solution.instance.model.spec.multipliers))
    known = solution.times, np.concatenate([solution.x, solution.lam]), nothing
    found = solved(begun(solution.instance, structure, known, float(solution.times[-1])), limits)
    return None if found is None or wrong(found)[0] else cost(found)


def contacts(solution: Solution) -> list[Contact]:
    """Return the contacts with path constraints, from the events of a solution."""
    names, open_since = [one.name for one in solution.instance.model.spec.path_constraints], dict[int, float]()
    begin, end = float(solution.times[0]), float(solution.times[-1])
    found = list[Contact]()
    for event in (one for one in solution.events if one.kind != "interior"):
        which = names.index(event.name)
        if event.kind == "touch":
            found.append(Contact(which, event.t, event.t, closes=event.t >= end))
        elif event.kind == "entry":
            open_since[which] = event.t
        else:
            start = open_since.pop(which)
            found.append(Contact(which, start, event.t, opens=start <= begin))
    lasting = (Contact(k, start, end, opens=start <= begin, closes=True) for k, start in open_since.items())
    return [*found, *lasting]


def _variants(solution: Solution) -> Iterator[Structure]:
    """Yield structures near that of a solution.

    One contact is removed, a touch point replaced by an arc or an arc by a touch point, an arc divided, or two contacts
    are joined.
    """
    known, spec = list(ordered(contacts(solution)).contacts), solution.instance.model.spec.path_constraints
    lasting = float(solution.times[-1] - solution.times[0])
    for k, one in enumerate(known):
        others = [*known[:k], *known[k + 1 :]]
        yield ordered(others)
        if one.touches and not one.closes:
            half = min(SHORT_ARC * lasting, one.start - solution.times[0], solution.times[-1] - one.start) / 2
            yield ordered([*others, replace(one, start=one.start - half, end=one.end + half)])
        if not one.touches and spec[one.constraint].order > 1 and not (one.opens or one.closes):
            yield ordered([*others, Contact(one.constraint, one.middle, one.middle)])
        if not one.touches:
            third = (one.end - one.start) / 3
            parts = replace(one, end=one.start + third, closes=False), replace(one, start=one.end - third, opens=False)
            yield ordered([*others, *parts])
        after = next((each for each in known[k + 1 :] if each.constraint == one.constraint), None)
        if after is not None:
            rest = [each for each in others if each is not after]
            yield ordered([*rest, replace(one, end=after.end, closes=after.closes and not after.touches)])
