"""The best of many starts of direct collocation, confirmed by simulation."""

from __future__ import annotations

from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.case import Case
from tests.bench.truth.collocate import Found, Start, solved
from tests.bench.truth.simulate import confirmed
from tests.bench.truth.starts import starts

INTERVALS = {"polar_orbit": 24, "polar_orbit_timed": 24, "polar_orbit_ball": 30, "transfer_plane": 40}
BOUNDED, FEW = 36, 20
FINE = 80
"""Intervals on which bounds, which make the control bend within them, are taken up again."""
SAME = 1e-2
HOPELESS = 4
"""How many starts fail until bounds are taken to forbid to arrive; then nothing is said."""
TRIES = 3
"""How many of the best are simulated until one is confirmed."""


def best(case: Case) -> Answer:
    """Solve from every start; the cheapest control that a simulation confirms."""
    intervals = INTERVALS.get(case.model, FEW)
    if case.bounds or case.max_norm is not None:
        intervals = max(intervals, BOUNDED)
    tried = starts(case)
    pairs: list[tuple[Found, Start]] = []
    for count, start in enumerate(tried):
        if not pairs and intervals >= BOUNDED and count == HOPELESS:
            break
        if (found := solved(case, start, intervals)) is not None:
            pairs.append((found, start))
    pairs.sort(key=lambda pair: pair[0].cost)
    how = f"collocation on {intervals} intervals, {len(pairs)} of {len(tried)} starts solved"
    for rough, start in _distinct(pairs)[:TRIES]:
        found = rough
        if intervals >= BOUNDED:
            fine = solved(case, Start(rough.duration, rough.path, start.shift), FINE)
            # From straight lines through the old nodes, the new ones may lead elsewhere.
            if fine is not None and abs(fine.cost - rough.cost) < SAME * abs(rough.cost):
                found = fine
        checked = confirmed(case, found)
        if checked is not None:
            how += f"; simulated: misses {checked.missed:.0e}, worth {checked.worth:.0e}"
            return Answer(Truth.REACHED, checked.cost, how, found.duration)
    return Answer(Truth.UNKNOWN, None, how)


def _distinct(pairs: list[tuple[Found, Start]]) -> list[tuple[Found, Start]]:
    """One of each cost."""
    kept: list[tuple[Found, Start]] = []
    for found, start in pairs:
        if not kept or found.cost > kept[-1][0].cost + 1e-7 * abs(found.cost):
            kept.append((found, start))
    return kept
