"""Solution of many problems whose controls reach their bounds, with nodes where a control enters or leaves a bound.

Between these times the canonical equations are smooth. The right-hand side is continuous at them, so that an error of
such a time has only a quadratic effect. The times are located along the solution of the nodes, the nodes are solved
again on a mesh that contains these times, and both steps are repeated until the times no longer change.

Linear motions may be unable to reach their final states within the bounds, as separating planes show. The search for a
plane takes long, but to test on which side of a known plane another final state lies does not. Motions for which no
plane is found are left open.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.batch.many import Many
from satsym.solvers.batch.newton import Nodes, Outcome, accurate, rough
from satsym.solvers.batch.solving import aim_of
from satsym.solvers.switching.linear.by_reach import separated_by, separating

INWARDS, NARROWEST, TRIALS = 0.5, 0.02, 12
"""Parameters of the continuation in the bounds: first and smallest step, and largest number of steps.

The steps are fractions of the amount by which the unbounded controls exceed their bounds.
"""

AIMS = (1e-3, 1e-6, 1e-9)
"""Tolerances that are used in turn while the times at which bounds are entered or left are still inaccurate."""

SETTLED_TIMES = 1e-7
"""Largest final change of times at which bounds are entered or left, as a fraction of the duration.

The effect on the motion is proportional to the square of the change. Solutions with a larger change are rejected.
"""

LOOKED_AT = (np.arange(8) + 0.5) / 8.0
"""Positions within each segment, as fractions, at which controls are compared with their bounds."""

MOST_TIMES = 24
"""Largest number of times at which an instance may enter or leave a bound."""

POLISHED = 3
"""Number of Newton corrections of a time at which a bound is entered or left."""

DIFFERENCE = 1e-6
"""Step of finite differences in time, as a fraction of the duration."""


@dataclass(frozen=True, eq=False)
class Met:
    """Times at which controls enter or leave their bounds."""

    times: Array
    """Times of each instance in increasing order, followed by infinity, shape (J, M)."""
    z: Array
    """States and costates at the times when bounds are entered or left, shape (2n, J, M)."""
    clear: NDArray[np.bool_]
    """Whether the list of times is clearly complete, shape (M,), for each instance."""

    @property
    def counts(self) -> NDArray[np.intp]:
        """Number of times at which bounds are entered or left for each instance, shape (M,)."""
        return np.asarray(np.isfinite(self.times).sum(axis=0))


def within_bounds(many: Many, z: Array) -> tuple[Many, Nodes, NDArray[np.intp]]:
    """Solve problems within the bounds on their controls.

    Parameters
    ----------
    many
        The problems.
    z
        Values at the nodes of their solutions without bounds, shape (2n, N+1, M).

    Returns
    -------
    tuple
        The problems on meshes with nodes where bounds are entered or left, their solutions, and the numbers of these
        times.
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
    """Return nodes within gradually tightened bounds, by steps of low order, and the outcomes."""
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
    """Return the problems with their bounds moved outwards by given amounts, shape (b, M)."""
    if many.problem.control_set.kind == "ball":
        return replace(many, radius=many.radius + by[0])
    m = len(many.lower)
    return replace(many, lower=many.lower - by[:m], upper=many.upper + by[m:])


def _room(many: Many, t: Array, z: Array) -> Array:
    """Return the distance of the unbounded controls from each bound, negative outside, shape (b, K)."""
    n, times = many.states, len(t) // many.count
    free = many.instance.control_set.without_bounds.arguments
    (p, _), limits = many.arguments(times), np.tile(many.limits, times)
    u = np.asarray(many.instance.model.control_law_batch(t, z[:n], z[n:], p, free))
    if len(limits) == 1 and many.problem.control_set.kind == "ball":
        return np.asarray(limits - np.linalg.norm(u, axis=0))
    return np.concatenate([u - limits[: len(u)], limits[len(u) :] - u])


def _met(many: Many, z: Array) -> Met:
    """Locate the times at which bounds are entered or left along the motions from the nodes."""
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
    """Return whether a bound may be reached for an instant between two sampled positions.

    `room` are the distances from the bounds at these positions, shape (b, K).
    """
    before, here, after = (np.abs(part) for part in (room[:, :-2], room[:, 1:-1], room[:, 2:]))
    within = room > 0.0
    one_side = (within[:, :-2] == within[:, 1:-1]) & (within[:, 2:] == within[:, 1:-1])
    lowest = one_side & (here <= before) & (here <= after) & np.isfinite(here)
    return bool((lowest & (2.0 * here <= before - 2.0 * here + after)).any())


def _polished(
    many: Many, z: Array, which: NDArray[np.intp], row: NDArray[np.intp], t: Array, early: Array, late: Array
) -> tuple[Array, Array]:
    """Return the times between `early` and `late` at which a bound is reached, with states and costates there."""
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
    """Return the problems on meshes with additional nodes where bounds are met, the values there, and the old nodes.

    The old nodes are given as indices into the new meshes.
    """
    first, lasting, count = many.instance.t0, many.problem.duration, many.count
    base = np.broadcast_to(many.mesh, (len(many.mesh), count))
    share = np.where(np.isfinite(met.times), (met.times - first) / lasting, 1.0)
    mesh, values = np.concatenate([base, share]), np.concatenate([z, met.z], axis=1)
    order = np.argsort(mesh, axis=0, kind="stable")
    places = np.argsort(order, axis=0, kind="stable")[: len(base)]
    laid = replace(many, mesh=np.take_along_axis(mesh, order, axis=0))
    return laid, np.take_along_axis(values, order[None], axis=1), places


def _separate(many: Many, z: Array) -> NDArray[np.bool_]:
    """Return whether the Hamiltonian has no mixed terms in two controls, shape (M,); bounds then act independently."""
    if many.problem.control_set.kind == "ball" or len(many.lower) < 2:
        return np.ones(many.count, dtype=bool)
    n, (p, bounds), t = many.states, many.arguments(z.shape[1]), many.at_nodes(slice(None))
    flat, model = z.reshape(len(z), -1), many.instance.model
    u = np.asarray(model.control_law_batch(t, flat[:n], flat[n:], p, bounds))
    table = np.abs(np.broadcast_to(model.control_hessian_batch(t, flat[:n], u, flat[n:], p), (len(u), *u.shape)))
    off = table[~np.eye(len(u), dtype=bool)].reshape(-1, z.shape[1], many.count)
    return np.asarray((off == 0.0).all(axis=(0, 1)))


def unreachable(many: Many, instances: Sequence[Instance], which: NDArray[np.intp]) -> dict[int, str]:
    """Return the reasons why motions have no solution, by index, as far as this is shown.

    Parameters
    ----------
    many, instances
        Linear motions of one system with given final states and times.
    which
        Indices of the motions to be examined; planes are searched in this order.
    """
    found: dict[int, str] = {}
    left = which
    while len(left):
        plane = separating(instances[left[0]])
        if plane is None:
            left = left[1:]
            continue
        wanted = plane.costate[:, None] * many.end[:, left]
        beyond = plane.beyond(many.initial[:, left], wanted, many.lower[:, left], many.upper[:, left])
        for k in left[beyond].tolist():
            one = instances[k]
            assert one.tf is not None
            found[k] = (
                f"no control within its bounds reaches the given final state in {one.tf - one.t0:.10g}: "
                f"{separated_by(one, plane.costate)}"
            )
        beyond[0] = True
        left = left[~beyond]
    return found
