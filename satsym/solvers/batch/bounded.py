"""Many problems whose controls meet their bounds: nodes of each lie where its controls come to a bound or leave it.

Between those times the canonical equations are smooth, and at them they have no jump: an error of such a time counts
squared. So they are looked for along what is solved, and solved again with nodes there, until they stay.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solvers.batch.many import Many
from satsym.solvers.batch.newton import Nodes, Outcome, accurate, rough
from satsym.solvers.batch.solving import aim_of

INWARDS, NARROWEST, TRIALS = 0.5, 0.02, 12
"""Share of what controls exceed their bounds by, by which these are moved inwards at first and at least, and how often.
"""

AIMS = (1e-3, 1e-6, 1e-9)
"""Errors that are aimed at while times at which bounds are met are not known well."""

SETTLED_TIMES = 1e-7
"""Share of the duration by which these times may move in the end: the motion changes by its square."""

LOOKED_AT = (np.arange(8) + 0.5) / 8.0
"""Places within each segment at which controls are compared with their bounds."""

MOST_TIMES = 24
"""Times at which an instance meets or leaves a bound, at most."""

POLISHED = 3
"""Corrections of such a time along the motion."""

DIFFERENCE = 1e-6
"""Share of the duration for a difference in time."""


@dataclass(frozen=True, eq=False)
class Met:
    """Times at which controls come to their bounds or leave them."""

    times: Array
    """In each instance's order, then infinite, shape (J, M)."""
    z: Array
    """States and costates there, shape (2n, J, M)."""
    clear: NDArray[np.bool_]
    """Whether there are no others beyond doubt, shape (M,)."""

    @property
    def counts(self) -> NDArray[np.intp]:
        """How many, shape (M,)."""
        return np.asarray(np.isfinite(self.times).sum(axis=0))


def within_bounds(many: Many, z: Array) -> tuple[Many, Nodes, NDArray[np.intp]]:
    """Solve within bounds.

    Parameters
    ----------
    many
        The problems.
    z
        Nodes of their solutions without bounds, shape (2n, N+1, M).

    Returns
    -------
    tuple
        The problems with nodes where bounds are met, the solutions, and how often they are met or left.
    """
    own = many.within_bounds()
    with np.errstate(all="ignore"):
        z, outcome = _eased(own, z)
        met, final, count = _met(own, z), aim_of(many), many.count
        for aim in (*AIMS, final, final):  # twice, for with few controls that are free errors shrink slowly
            laid, start, places = _laid(own, z, met)
            nodes = accurate(laid, start, outcome, aim)
            before, outcome = met, nodes.outcome
            met, z = _met(laid, nodes.z), np.take_along_axis(nodes.z, places[None], axis=1)
        same = (before.counts == met.counts) & met.clear
        moved = np.zeros(count)
        for earlier, later in zip(before.times, met.times, strict=False):
            moved = np.maximum(moved, np.where(np.isfinite(earlier + later), np.abs(later - earlier), 0.0))
        fine = same & (moved <= SETTLED_TIMES * many.problem.duration) & _separate(laid, nodes.z)
        outcome[nodes.solved & ~fine] = Outcome.INACCURATE
    return laid, nodes, met.counts


def _eased(many: Many, z: Array) -> tuple[Array, NDArray[np.object_]]:
    """Nodes by steps of low order, bounds being moved inwards from where they are not met."""
    beyond = np.maximum(-_room(many, many.at_nodes(slice(None)), z.reshape(len(z), -1)), 0.0)
    beyond = np.where(np.isfinite(beyond), beyond, 0.0).reshape(len(beyond), -1, many.count).max(axis=1)
    left, width = np.ones(many.count), np.full(many.count, INWARDS)
    for _ in range(TRIALS):
        on = np.flatnonzero((left > 0.0) & (width >= NARROWEST))
        if not len(on):
            break
        trial = np.maximum(left - width, 0.0)
        reached, outcome = rough(_moved_outwards(many, trial * beyond).only(on), z[:, :, on])
        fine = outcome == Outcome.SOLVED
        z[:, :, on[fine]], left[on[fine]] = reached[:, :, fine], trial[on[fine]]
        width[on] = np.where(fine, np.minimum(2.0 * width[on], left[on]), width[on] / 2.0)
    found = np.full(many.count, Outcome.SOLVED, dtype=object)
    found[left > 0.0] = Outcome.NO_CONVERGENCE
    return z, found


def _moved_outwards(many: Many, by: Array) -> Many:
    """The problems with their bounds moved outwards by so much, shape (b, M)."""
    if many.problem.control_set.kind == "ball":
        return replace(many, radius=many.radius + by[0])
    m = len(many.lower)
    return replace(many, lower=many.lower - by[:m], upper=many.upper + by[m:])


def _room(many: Many, t: Array, z: Array) -> Array:
    """How far controls without bounds would be within these, a row for each bound, shape (b, K)."""
    n, times = many.states, len(t) // many.count
    free = many.instance.control_set.without_bounds.arguments
    (p, _), limits = many.arguments(times), np.tile(many.limits, times)
    u = np.asarray(many.instance.model.control_law_batch(t, z[:n], z[n:], p, free))
    if len(limits) == 1 and many.problem.control_set.kind == "ball":
        return np.asarray(limits - np.linalg.norm(u, axis=0))
    return np.concatenate([u - limits[: len(u)], limits[len(u) :] - u])


def _met(many: Many, z: Array) -> Met:
    """Where along the motions from their nodes bounds are met or left."""
    t, start, h, given = many.segments(z)
    sides, when = [], []
    for share in LOOKED_AT:
        reached = many.motion.accurate(t, start, share * h, given, 1)[:-1]
        sides.append(_room(many, t + share * h, reached).reshape(-1, len(many.mesh) - 1, many.count))
        when.append((t + share * h).reshape(-1, many.count))
    room = np.stack(sides, axis=2).reshape(len(sides[0]), -1, many.count)
    times = np.stack(when, axis=1).reshape(-1, many.count)
    ends = [many.at_nodes(slice(0, 1)), many.at_nodes(slice(-1, None))]
    first, last = (_room(many, at, z[:, k])[:, None] for at, k in zip(ends, (0, -1), strict=True))
    room, times = np.concatenate([first, room, last], axis=1), np.concatenate([ends[:1], times, ends[1:]])
    changed = (room[:, 1:] > 0.0) != (room[:, :-1] > 0.0)
    row, place, which = np.nonzero(changed)
    before, after = room[row, place, which], room[row, place + 1, which]
    early, late = times[place, which], times[place + 1, which]
    found = early + (late - early) * np.where(np.isfinite(before), before / (before - after), 0.5)
    found, there = _polished(many, z, which, row, found, early, late)
    count = np.bincount(which, minlength=many.count)
    kept = np.full((min(int(count.max(initial=0)), MOST_TIMES), many.count), np.inf)
    values = np.repeat(z[:, -1:], len(kept), axis=1)
    for k in np.flatnonzero(count):
        mine = np.flatnonzero(which == k)
        mine = mine[np.argsort(found[mine], kind="stable")][: len(kept)]
        kept[: len(mine), k], values[:, : len(mine), k] = found[mine], there[:, mine]
    lasting = np.repeat(h.reshape(-1, many.count) > DIFFERENCE * many.problem.duration, len(LOOKED_AT), axis=0)
    grazing = [_grazing(room[:, 1:-1][:, own, k]) for k, own in enumerate(lasting.T)]
    return Met(kept, values, (count <= MOST_TIMES) & ~np.array(grazing, dtype=bool))


def _grazing(room: Array) -> bool:
    """Whether a bound may be met or left for a moment between two places, of rooms there, shape (b, K)."""
    before, here, after = (np.abs(part) for part in (room[:, :-2], room[:, 1:-1], room[:, 2:]))
    within = room > 0.0
    one_side = (within[:, :-2] == within[:, 1:-1]) & (within[:, 2:] == within[:, 1:-1])
    lowest = one_side & (here <= before) & (here <= after) & np.isfinite(here)
    return bool((lowest & (2.0 * here <= before - 2.0 * here + after)).any())


def _polished(
    many: Many, z: Array, which: NDArray[np.intp], row: NDArray[np.intp], t: Array, early: Array, late: Array
) -> tuple[Array, Array]:
    """Times at which the room within a bound vanishes, between two others, and states and costates there."""
    if not len(which):
        return t, np.zeros((len(z), 0))
    own, step = many.only(which), DIFFERENCE * many.problem.duration
    times = np.broadcast_to(many.times, (len(many.times), many.count))[:, which]
    every, model, n = np.arange(len(which)), many.instance.model, many.states
    own = replace(own, mesh=own.mesh[:1])
    p, bounds = own.arguments(1)
    for _ in range(POLISHED + 1):
        place = np.minimum((times <= t).sum(axis=0), len(times) - 1) - 1
        begin = times[place, every]
        there = many.motion.accurate(begin, z[:, place, which], t - begin, own.given, 2)[:-1]
        rates = np.asarray(model.canonical_batch(t, there[:n], there[n:], p, bounds))
        here, ahead, behind = (_room(own, t + shift, there + shift * rates)[row, every] for shift in (0.0, step, -step))
        change = -here * (2.0 * step) / (ahead - behind)
        t = np.clip(t + np.where(np.isfinite(change), change, 0.0), early, late)
    return t, there


def _laid(many: Many, z: Array, met: Met) -> tuple[Many, Array, NDArray[np.intp]]:
    """The problems with nodes where bounds are met as well, the nodes' values, and where the others are among them."""
    first, lasting, count = many.instance.t0, many.problem.duration, many.count
    base = np.broadcast_to(many.mesh, (len(many.mesh), count))
    share = np.where(np.isfinite(met.times), (met.times - first) / lasting, 1.0)
    mesh, values = np.concatenate([base, share]), np.concatenate([z, met.z], axis=1)
    order = np.argsort(mesh, axis=0, kind="stable")
    places = np.argsort(order, axis=0, kind="stable")[: len(base)]
    laid = replace(many, mesh=np.take_along_axis(mesh, order, axis=0))
    return laid, np.take_along_axis(values, order[None], axis=1), places


def _separate(many: Many, z: Array) -> NDArray[np.bool_]:
    """Whether H has no terms in which two controls meet, so that each is held by its own bounds alone, shape (M,)."""
    if many.problem.control_set.kind == "ball" or len(many.lower) < 2:
        return np.ones(many.count, dtype=bool)
    n, (p, bounds), t = many.states, many.arguments(z.shape[1]), many.at_nodes(slice(None))
    flat, model = z.reshape(len(z), -1), many.instance.model
    u = np.asarray(model.control_law_batch(t, flat[:n], flat[n:], p, bounds))
    table = np.abs(np.broadcast_to(model.control_hessian_batch(t, flat[:n], u, flat[n:], p), (len(u), *u.shape)))
    off = table[~np.eye(len(u), dtype=bool)].reshape(-1, z.shape[1], many.count)
    return np.asarray((off == 0.0).all(axis=(0, 1)))
