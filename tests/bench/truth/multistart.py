"""The best of many starts of direct collocation, confirmed by simulation."""

from __future__ import annotations

import math

import numpy as np

from tests.bench.truth.answer import Answer, Truth
from tests.bench.truth.case import Case
from tests.bench.truth.collocate import Found, Start, solved
from tests.bench.truth.physics import MODELS
from tests.bench.truth.simulate import confirmed
from tests.bench.truth.starts import starts

INTERVALS = {"polar_orbit": 24, "polar_orbit_timed": 24, "polar_orbit_ball": 30, "transfer_plane": 40}
BOUNDED, FEW = 36, 20
FINE = 80
"""Intervals on which bounds, which make the control bend within them, are taken up again."""
SAME = 1e-2
HOPELESS = 4
"""How many starts fail until bounds are taken to forbid to arrive; then nothing is said."""
MESHES, SETTLED = (20, 67, 211, 631, 1279), 5e-6
"""Intervals of problems with constraints along the way, and change of the cost from one to the next that is none."""
VIOLATED, DIVIDED, MOST = 1e-9, 8, 12
"""Violation of these, relative to the size of the state, that is none; how often meshes are divided, at how many."""
TRIES = 6
"""How many of the best are simulated until one costs what it seemed to."""


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
    least: tuple[float, float, str] | None = None
    for rough, start in _distinct(pairs)[:TRIES]:
        found = _finer(case, rough, start) if intervals >= BOUNDED else rough
        checked = confirmed(case, found)
        if checked is None:
            continue
        if least is None or checked.cost < least[0]:
            least = checked.cost, found.duration, f"misses {checked.missed:.0e}, worth {checked.worth:.0e}"
        if abs(checked.cost - found.cost) < SAME * abs(found.cost):
            break  # the others cost more; but for those that go through the centre, where nothing is resolved
    if least is None:
        return Answer(Truth.UNKNOWN, None, how)
    return Answer(Truth.REACHED, least[0], f"{how}; simulated: {least[2]}", least[1])


def settled(case: Case) -> Answer:
    """Solve from every start, the cheapest on ever finer meshes until its cost settles.

    Constraints along the way are kept at some points of each interval. Where they are violated between these, intervals
    are divided until that is nothing.
    """
    tried = starts(case)
    found = [pair for start in tried if (pair := (solved(case, start, MESHES[0]), start))[0] is not None]
    if not found:
        return Answer(Truth.UNKNOWN, None, "no start solved")
    least, start = min(found, key=lambda pair: pair[0].cost)
    how = f"{len(found)} of {len(tried)} starts solved"
    for intervals in MESHES[1:]:
        finer = _kept(case, least, start, intervals)
        if finer is None:
            return Answer(Truth.UNKNOWN, None, f"{how}, not on {intervals} intervals")
        change, over = abs(finer.cost - least.cost) / max(abs(finer.cost), 1e-12), _violated(case, finer)[1].max()
        least = finer
        if change < SETTLED and over < VIOLATED:
            said = f"{how}; {intervals} intervals changed {change:.0e}, violation {over:.0e}"
            return Answer(Truth.REACHED, least.cost, said, least.duration)
    return Answer(Truth.UNKNOWN, None, f"{how}; {intervals} intervals still changed {change:.0e}, violation {over:.0e}")


def _kept(case: Case, rough: Found, start: Start, intervals: int) -> Found | None:
    """On another mesh, with more edges where constraints would be violated most."""
    edges = np.linspace(0.0, 1.0, intervals + 1)
    found = None
    for _ in range(DIVIDED):
        finer = solved(case, Start(rough.duration, rough.path, start.shift), len(edges) - 1, edges)
        if finer is None:
            return found
        found = rough = finer
        at, over = _violated(case, found)
        peaks = np.flatnonzero((over > VIOLATED) & (over >= np.roll(over, 1)) & (over >= np.roll(over, -1)))
        if not len(peaks):
            break
        more = at[peaks[np.argsort(over[peaks])[-MOST:]]]
        edges = np.unique(np.concatenate([edges, more]))
        edges = edges[np.append(True, np.diff(edges) > 1e-9)]
    return found


def _violated(case: Case, found: Found) -> tuple[np.ndarray, np.ndarray]:
    """Fractions of the duration, and by how much constraints are violated there, relative to the states."""
    physics, (at, x) = MODELS[case.model], found.dense()
    p, t = physics.given(case.parameters), case.t0 + at * found.duration
    g = np.array([physics.kept(math, *place, p) for place in zip(t.tolist(), x.T.tolist(), strict=True)])
    return at, np.maximum(g.max(axis=1), 0.0) / max(1.0, float(np.abs(x).max()))


def _finer(case: Case, rough: Found, start: Start) -> Found:
    """On more intervals; from straight lines through the old nodes these may lead elsewhere, and then the old ones."""
    fine = solved(case, Start(rough.duration, rough.path, start.shift), FINE)
    return fine if fine is not None and abs(fine.cost - rough.cost) < SAME * abs(rough.cost) else rough


def _distinct(pairs: list[tuple[Found, Start]]) -> list[tuple[Found, Start]]:
    """One of each cost."""
    kept: list[tuple[Found, Start]] = []
    for found, start in pairs:
        if not kept or found.cost > kept[-1][0].cost + 1e-7 * abs(found.cost):
            kept.append((found, start))
    return kept
