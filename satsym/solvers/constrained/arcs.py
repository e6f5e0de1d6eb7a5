"""The unknowns of an extremal with boundary arcs as one vector: values on all arcs, junction times and multipliers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.gauss import STAGES, lagrange, scheme
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.constrained.law import by_newton, stationary
from satsym.solvers.constrained.structure import FREE, Active, Junction, Structure

NONE = -1
"""Value that stands for "no constraint" in place of the index of an active constraint."""

OF_TERMS = 1e-3
"""Minimum scale of a constraint, relative to its terms, for constraints that are almost always on their boundary."""

DRAWN = 20
"""Number of random states at which it is tested which states a constraint depends on."""


def holds_control(instance: Instance, constraint: int) -> bool:
    """Return whether a constraint involves the control directly (order zero); ``NONE`` does not."""
    return constraint != NONE and instance.model.spec.path_constraints[constraint].order == 0


def control(instance: Instance, constraint: int, t: Array, z: Array) -> Array:
    """Return controls, shape (m, N), on the boundary of a constraint or, for ``NONE``, without one."""
    model, n, p = instance.model, len(instance.initial), instance.parameters
    if stationary(instance):
        return by_newton(instance, (constraint,) if holds_control(instance, constraint) else FREE, t, z)[0]
    if holds_control(instance, constraint):
        found = model.boundary_control_batch(t, z[:n], z[n:], p, instance.control_set.arguments)
        return _row(np.asarray(found), len(model.spec.path_constraints), len(t))[constraint]
    found = model.control_law_batch(t, z[:n], z[n:], p, without_bounds(instance))
    return np.broadcast_to(np.asarray(found), (len(model.spec.controls), len(t)))


def without_bounds(instance: Instance) -> tuple[float, ...]:
    """Return the argument ``bounds`` of the unbounded law, or of the bounded law if that is found iteratively."""
    return (instance.control_set if stationary(instance) else instance.control_set.without_bounds).arguments


def field(instance: Instance, constraint: int, t: Array, z: Array) -> Array:
    """Return rates of states and costates, (2n, N), on the boundary of a constraint or, for ``NONE``, without one."""
    if constraint == NONE and not stationary(instance):
        x, lam = np.split(z, 2)
        return np.array(instance.model.canonical_batch(t, x, lam, instance.parameters, without_bounds(instance)))
    return field_and_control(instance, constraint, t, z)[0]


def field_and_control(instance: Instance, constraint: int, t: Array, z: Array) -> tuple[Array, Array]:
    """Return rates of states and costates as :func:`field` does, and the controls, shape (m, N)."""
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    x, lam = z[:n], z[n:]
    eta: Array | None = None
    if stationary(instance) and holds_control(instance, constraint):  # both at once
        u, (eta,) = by_newton(instance, (constraint,), t, z)
    else:
        u = control(instance, constraint, t, z)
    rates = (model.dynamics_batch(t, x, u, p), model.costate_rate_batch(t, x, u, lam, p))
    found = np.concatenate([np.broadcast_to(one, x.shape) for one in rates])
    if constraint != NONE:
        eta = multiplier(instance, constraint, t, z, u) if eta is None else eta
        found[len(x) :] -= eta * gradient(instance, constraint, t, x, u)
    return found, u


def multiplier(instance: Instance, constraint: int, t: Array, z: Array, u: Array | None = None) -> Array:
    """Return the multiplier eta of a constraint on its boundary, shape (N,)."""
    model, n = instance.model, len(instance.initial)
    if stationary(instance) and holds_control(instance, constraint):
        return by_newton(instance, (constraint,), t, z)[1][0]
    u = control(instance, constraint, t, z) if u is None else u
    found = model.path_multiplier_batch(t, z[:n], u, z[n:], instance.parameters, instance.control_set.arguments)
    return np.broadcast_to(np.asarray(found), (len(model.spec.path_constraints), len(t)))[constraint]


def vanishing(instance: Instance, constraint: int, t: Array, z: Array) -> Array:
    """Return the quantities that a constraint keeps at zero on its boundary, (q, N).

    For a control constraint it is the quantity that vanishes where its arc begins and ends.
    """
    model, n = instance.model, len(instance.initial)
    u = control(instance, NONE, t, z)
    found = model.path_vanishing_batch(t, z[:n], u, z[n:], instance.parameters, instance.control_set.arguments)
    every = _row(np.asarray(found), len(model.spec.path_constraints), len(t))
    return every[constraint, : max(1, model.spec.path_constraints[constraint].order)]


def gradient(instance: Instance, constraint: int, t: Array, x: Array, u: Array | None = None) -> Array:
    """Return g_x of one constraint, shape (n, N); constraints on states alone need no controls.

    Conditions at waypoints have the indices after those of the constraints.
    """
    if (place := constraint - len(instance.model.spec.path_constraints)) >= 0:
        return np.asarray(instance.model.interior_gradient_batch(t, x, instance.parameters))[place]
    u = np.zeros((len(instance.model.spec.controls), len(t))) if u is None else u
    return gradients(instance, t, x, u)[constraint]


def gradients(instance: Instance, t: Array, x: Array, u: Array) -> Array:
    """Return g_x of all constraints, shape (h, n, N)."""
    if not instance.model.spec.path_constraints:
        return np.zeros((0, *x.shape))
    found = np.asarray(instance.model.path_gradient_batch(t, x, u, instance.parameters))
    return _row(found, len(instance.model.spec.path_constraints), len(t))


def effects(instance: Instance, t: Array, x: Array, u: Array) -> Array:
    """Return g_u of all constraints, shape (h, m, N)."""
    if not instance.model.spec.path_constraints:
        return np.zeros((0, *u.shape))
    found = np.asarray(instance.model.path_effect_batch(t, x, u, instance.parameters))
    return _row(found, len(instance.model.spec.path_constraints), len(t))


def values(instance: Instance, t: Array, x: Array, u: Array) -> Array:
    """Return the values of all constraints, shape (h, N); infinite bounds count as satisfied with the slack 1."""
    if not instance.model.spec.path_constraints:
        return np.zeros((0, len(t)))
    found = instance.model.path_constraints_batch(t, x, u, instance.parameters, instance.control_set.arguments)
    found = np.broadcast_to(np.asarray(found), (len(instance.model.spec.path_constraints), len(t)))
    return np.where(np.isinf(found), -1.0, found)


def conditions(instance: Instance) -> list[range]:
    """Return the indices of the conditions at each waypoint; they follow the indices of the path constraints."""
    spec = instance.model.spec
    ends = np.cumsum([len(spec.path_constraints), *(point.conditions for point in spec.interior)]).tolist()
    return [range(a, b) for a, b in pairwise(ends)]


def missed(instance: Instance, which: Sequence[int], t: Array, x: Array) -> tuple[Array, Array]:
    """Return conditions at waypoints, by their indices, and their time derivatives, shape (k, N) each."""
    model, p, h = instance.model, instance.parameters, len(instance.model.spec.path_constraints)
    places = [k - h for k in which]
    return np.asarray(model.interior_batch(t, x, p))[places], np.asarray(model.interior_drift_batch(t, x, p))[places]


def sizes(instance: Instance, t: Array, x: Array, u: Array) -> Array:
    """Return the scale of each constraint, shape (h,): its largest magnitude, at least a fraction of its terms."""
    found = np.maximum(np.abs(values(instance, t, x, u)), OF_TERMS * terms(instance, t, x, u))
    return np.asarray(np.maximum(found.max(axis=1), 1e-300))


def terms(instance: Instance, t: Array, x: Array, u: Array) -> Array:
    """Return the sums of the magnitudes of the terms of constraints, shape (h, N), which set the scale of rounding."""
    push = (np.abs(gradients(instance, t, x, u)) * np.abs(x)).sum(axis=1)
    return np.asarray(push + (np.abs(effects(instance, t, x, u)) * np.abs(u)).sum(axis=1))


def depends(instance: Instance) -> NDArray[np.bool_]:
    """Return which states each constraint depends on, shape (h, n).

    A derivative that vanishes at all of several random states counts as zero; one that is not finite counts as nonzero.
    """
    rng, spec = np.random.default_rng(0), instance.model.spec
    magnitudes = 10.0 ** rng.uniform(-2.0, 2.0, (len(spec.states), DRAWN))
    signs = np.array([[1.0] if state.positive else [-1.0] for state in spec.states])
    x = magnitudes * np.where(rng.random(magnitudes.shape) < 0.5, 1.0, signs)
    t, u = rng.uniform(instance.t0, instance.t0 + 1.0, DRAWN), rng.normal(size=(len(spec.controls), DRAWN))
    with np.errstate(all="ignore"):
        found: NDArray[np.bool_] = (gradients(instance, t, x, u) != 0.0).any(axis=2)
    return found


def given_end(instance: Instance, end: float) -> Array:
    """Return the final states (n,) that are given or on the reference at the final time; NaN for others."""
    found = np.full(len(instance.initial), np.nan)
    for i, name in enumerate(instance.model.spec.state_names):
        value = instance.final.get(name)
        if isinstance(value, float | int):
            found[i] = value
        elif value == "reference":
            found[i] = instance.model.reference(end, instance.parameters)[i]
    return found


def decided_at_end(instance: Instance) -> NDArray[np.bool_]:
    """Return whether given final states alone determine each constraint on states at the final time, shape (h,)."""
    free = np.isnan(given_end(instance, instance.t0 + 1.0 if instance.tf is None else instance.tf))
    orders = np.array([one.order for one in instance.model.spec.path_constraints])
    return np.asarray((orders > 0) & ~(depends(instance) & free).any(axis=1))


def _row(found: Array, constraints: int, columns: int) -> Array:
    """Return generated values that have several entries for each constraint as an array of shape (h, entries, N)."""
    table = found.reshape(constraints, -1, found.shape[-1])
    return np.broadcast_to(table, (*table.shape[:2], columns))


@dataclass(frozen=True, eq=False)
class Arcs:
    """The unknowns of the problem of a structure of arcs, as one vector, and their meaning."""

    instance: Instance
    structure: Structure
    intervals: tuple[int, ...]
    """Number of collocation intervals of each arc."""
    unknown: Array
    passed: tuple[tuple[float, float], ...] = ()
    """Pairs of the cost and the size of a step or residual, one for each iteration so far."""

    @property
    def n(self) -> int:
        """Return the number of states."""
        return len(self.instance.initial)

    @cached_property
    def junctions(self) -> list[Junction]:
        """Junctions of the arcs."""
        return self.structure.junctions(self.instance)

    @cached_property
    def places(self) -> list[int]:
        """Positions in the vector of unknowns at which each arc begins, and at which the last one ends."""
        sizes = [(k * (STAGES + 1) + 1) * 2 * self.n for k in self.intervals]
        return [0, *np.cumsum(sizes).tolist()]

    @cached_property
    def active(self) -> list[Active]:
        """Active constraints on each arc."""
        return self.structure.arcs(self.instance)

    @cached_property
    def rest(self) -> Rest:
        """Positions of the unknowns other than the values on arcs."""
        first, count = self.places[-1], len(self.junctions)
        jumps = [(k, which) for k, one in enumerate(self.junctions) for which, _ in one.jumps]
        c = len(self.instance.model.spec.multipliers)
        free = self.instance.tf is None
        after = first + count
        return Rest(
            first,
            after if free else None,
            {one: after + free + i for i, one in enumerate(jumps)},
            after + free + len(jumps),
            c,
            len(self.pressed),
        )

    @cached_property
    def pinned(self) -> Active:
        """Constraints active at the final time whose values are determined by given final states alone."""
        given = np.array(final_argument(self.instance)).reshape(3, -1)[:2].sum(axis=0)
        states = [k for k in self.structure.ended if not holds_control(self.instance, k)]
        return tuple(k for k in states if not (depends(self.instance)[k] & (given == 0.0)).any())

    @property
    def pressed(self) -> Active:
        """Return the constraints that have a multiplier at the final time."""
        states = (k for k in self.structure.ended if not holds_control(self.instance, k))
        return tuple(k for k in states if k not in self.pinned)

    def pressure(self, constraint: int) -> float:
        """Return the multiplier of a constraint at the final time, 0 if it has none."""
        place = self.rest.nu + self.rest.constraints
        return float(self.unknown[place + self.pressed.index(constraint)]) if constraint in self.pressed else 0.0

    def nodes(self, arc: int) -> Array:
        """Return values at beginnings of intervals, at their stages and at the end: (K (stages + 1) + 1, 2n)."""
        return self.unknown[self.places[arc] : self.places[arc + 1]].reshape(-1, 2 * self.n)

    def node(self, arc: int, place: int) -> Array:
        """Return the first or the last value of an arc."""
        return self.nodes(arc)[place]

    @property
    def end(self) -> float:
        """Return the final time."""
        if self.instance.tf is not None:
            return self.instance.tf
        return float(self.unknown[self.places[-1] + len(self.junctions)])

    @property
    def times(self) -> Array:
        """Return the initial time, the junction times and the final time."""
        first = self.places[-1]
        return np.concatenate([[self.instance.t0], self.unknown[first : first + len(self.junctions)], [self.end]])

    def jump(self, junction: int, constraint: int) -> float:
        """Return the multiplier of the jump at a junction along the gradient of a constraint, 0 without such a jump."""
        place = self.rest.jumps.get((junction, constraint))
        return 0.0 if place is None else float(self.unknown[place])

    def stages(self, arc: int) -> tuple[Array, Array]:
        """Return times (K, stages) and values (K, stages, 2n) at the stages of an arc."""
        k, (a, b) = self.intervals[arc], self.times[arc : arc + 2]
        places = (np.arange(k)[:, None] + scheme(STAGES).nodes) / k
        return a + (b - a) * places, self.nodes(arc)[:-1].reshape(k, STAGES + 1, -1)[:, 1:]

    def at(self, arc: int, times: Array) -> Array:
        """Return values (2n, N) on an arc from its polynomials."""
        k, (a, b) = self.intervals[arc], self.times[arc : arc + 2]
        share = np.clip((times - a) / (b - a if b != a else np.inf) * k, 0.0, k)
        which = np.minimum(share.astype(int), k - 1)
        known = self.nodes(arc)[:-1].reshape(k, STAGES + 1, -1)[which]
        return np.asarray(np.einsum("ts,tsd->dt", lagrange(STAGES, share - which), known))


@dataclass(frozen=True)
class Rest:
    """Positions of the unknowns other than the values on arcs."""

    times: int
    """Position of the first junction time."""
    end: int | None
    """Position of a free final time, otherwise ``None``."""
    jumps: dict[tuple[int, int], int]
    """Positions of the multipliers of jumps, by junction and constraint."""
    nu: int
    """Position of the first multiplier of terminal constraints."""
    constraints: int
    pressed: int
    """Number of multipliers of path constraints at the final time, which follow those of terminal constraints."""

    @property
    def size(self) -> int:
        """Return the length of the whole vector."""
        return self.nu + self.constraints + self.pressed

    def bounds(self, arc: int, count: int) -> tuple[int | None, int | None]:
        """Return where the begin and end times of an arc are among the unknowns; ``None`` for times that are given."""
        first = None if arc == 0 else self.times + arc - 1
        return first, self.end if arc == count - 1 else self.times + arc
