"""The multi-point problem of a structure: Gauss collocation on every arc, times and jumps among the unknowns."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.collocation.gauss import STAGES, lagrange, scheme
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.constrained.structure import FREE, Event, Junction, Structure

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


def field(instance: Instance, constraint: int, t: Array, z: Array) -> Array:
    """Rates of states and costates, shape (2n, N), on the boundary of a constraint or on none."""
    model, p, n = instance.model, instance.parameters, len(instance.initial)
    x, lam = z[:n], z[n:]
    rates = np.array(model.canonical_batch(t, x, lam, p, instance.control_set.arguments))
    if constraint != FREE:
        eta = np.asarray(model.path_multiplier_batch(t, x, lam, p))[constraint]
        rates[n:] -= eta * gradient(instance, constraint, t, x)
    return rates


def gradient(instance: Instance, constraint: int, t: Array, x: Array) -> Array:
    """g_x of one constraint, shape (n, N)."""
    return np.asarray(instance.model.path_gradient_batch(t, x, instance.parameters)).reshape(-1, len(x), len(t))[constraint]


def values(instance: Instance, t: Array, x: Array) -> Array:
    """All constraints, shape (h, N)."""
    return np.asarray(instance.model.path_constraints_batch(t, x, instance.parameters))


@dataclass(frozen=True, eq=False)
class Arcs:
    """Unknowns of a structure's problem, all in one row, and what they stand for."""

    instance: Instance
    structure: Structure
    intervals: tuple[int, ...]
    """Of each arc."""
    unknown: Array

    @property
    def n(self) -> int:
        """States."""
        return len(self.instance.initial)

    @cached_property
    def junctions(self) -> list[Junction]:
        """Where arcs meet."""
        return self.structure.junctions(self.instance)

    @cached_property
    def places(self) -> list[int]:
        """Where each arc begins in the row, and where the last one ends."""
        sizes = [(k * (STAGES + 1) + 1) * 2 * self.n for k in self.intervals]
        return [0, *np.cumsum(sizes).tolist()]

    @cached_property
    def rest(self) -> Rest:
        """Where the other unknowns stand."""
        first, count = self.places[-1], len(self.junctions)
        jumps = [k for k, one in enumerate(self.junctions) if one.jump is not None]
        c = len(self.instance.model.spec.multipliers)
        free = self.instance.tf is None
        after = first + count
        return Rest(first, after if free else None, {k: after + free + i for i, k in enumerate(jumps)},
                    after + free + len(jumps), c, self.pressed)

    @cached_property
    def pinned(self) -> bool:
        """Whether given final states keep the constraint of the last contact at the end by themselves."""
        if not self.structure.ends:
            return False
        given = np.array(final_argument(self.instance)).reshape(3, -1)[:2].sum(axis=0)
        end = np.array([self.end]), self.node(len(self.intervals) - 1, -1)[: self.n, None]
        return not (np.abs(gradient(self.instance, self.structure.contacts[-1].constraint, *end)[:, 0]) * (given == 0.0)).any()

    @property
    def pressed(self) -> bool:
        """Whether the constraint of the last contact pushes at the end."""
        return self.structure.ends and not self.pinned

    def nodes(self, arc: int) -> Array:
        """Values at beginnings of intervals with those at their stages, and at the end: (K (stages + 1) + 1, 2n)."""
        return self.unknown[self.places[arc] : self.places[arc + 1]].reshape(-1, 2 * self.n)

    def node(self, arc: int, place: int) -> Array:
        """The first or the last value of an arc."""
        return self.nodes(arc)[place]

    @property
    def end(self) -> float:
        """The final time."""
        if self.instance.tf is not None:
            return self.instance.tf
        return float(self.unknown[self.places[-1] + len(self.junctions)])

    @property
    def times(self) -> Array:
        """Of the start, the junctions and the end."""
        first = self.places[-1]
        return np.concatenate([[self.instance.t0], self.unknown[first : first + len(self.junctions)], [self.end]])

    def jump(self, junction: int) -> float:
        """Multiplier of the jump there."""
        place = self.rest.jumps.get(junction)
        return 0.0 if place is None else float(self.unknown[place])

    def stages(self, arc: int) -> tuple[Array, Array]:
        """Times (K, stages) and values (K, stages, 2n) of an arc."""
        k, (a, b) = self.intervals[arc], self.times[arc : arc + 2]
        places = (np.arange(k)[:, None] + scheme(STAGES).nodes) / k
        return a + (b - a) * places, self.nodes(arc)[:-1].reshape(k, STAGES + 1, -1)[:, 1:]

    def at(self, arc: int, times: Array) -> Array:
        """Values (2n, N) on an arc by its polynomials."""
        k, (a, b) = self.intervals[arc], self.times[arc : arc + 2]
        share = np.clip((times - a) / (b - a) * k, 0.0, k)
        which = np.minimum(share.astype(int), k - 1)
        known = self.nodes(arc)[:-1].reshape(k, STAGES + 1, -1)[which]
        return np.asarray(np.einsum("ts,tsd->dt", lagrange(STAGES, share - which), known))

    def cost(self) -> float:
        """The running cost by Gauss's rule, and the terminal cost."""
        one, n, total = self.instance, self.n, 0.0
        for arc, k in enumerate(self.intervals):
            t, z = self.stages(arc)[0].ravel(), self.stages(arc)[1].reshape(-1, 2 * n).T
            u = one.model.control_law_batch(t, z[:n], z[n:], one.parameters, one.control_set.arguments)
            cost = np.broadcast_to(one.model.running_cost_batch(t, z[:n], u, one.parameters), t.shape)
            weights = np.tile(scheme(STAGES).weights, k) * (self.times[arc + 1] - self.times[arc]) / k
            total += float(cost @ weights)
        end = tuple(self.node(len(self.intervals) - 1, -1)[:n].tolist())
        return total + float(one.model.terminal_cost(self.end, end, one.parameters))


@dataclass(frozen=True)
class Rest:
    """Places of what is unknown besides the values on arcs."""

    times: int
    """Of the first junction's."""
    end: int | None
    """Of a free final time."""
    jumps: dict[int, int]
    """By junction."""
    nu: int
    """Of the first multiplier of terminal constraints."""
    constraints: int
    pressed: bool
    """Whether a multiplier at the end follows them."""

    @property
    def size(self) -> int:
        """Of the whole row."""
        return self.nu + self.constraints + self.pressed

    def bounds(self, arc: int, count: int) -> tuple[int | None, int | None]:
        """Places of the times at which an arc of so many begins and ends; ``None`` where these are given."""
        first = None if arc == 0 else self.times + arc - 1
        return first, self.end if arc == count - 1 else self.times + arc


class System:
    """Residuals of all conditions with their derivatives, or without."""

    def __init__(self, arcs: Arcs, sloped: bool = True) -> None:
        self.arcs, self.sloped = arcs, sloped
        self.residuals: list[Array] = []
        self.rows: list[Array] = []
        self.columns: list[Array] = []
        self.slopes: list[Array] = []
        self.height = 0
        for arc in range(len(arcs.intervals)):
            self._collocation(arc)
        self._start()
        for k, junction in enumerate(arcs.junctions):
            self._junction(k, junction)
        self._end()

    @property
    def residual(self) -> Array:
        """All of them."""
        return np.concatenate(self.residuals)

    @property
    def jacobian(self) -> csc_matrix:
        """By all unknowns."""
        from scipy.sparse import csc_matrix

        places = np.concatenate(self.rows), np.concatenate(self.columns)
        return csc_matrix((np.concatenate(self.slopes), places), shape=(self.height, self.arcs.rest.size))

    def _add(self, rows: Any, columns: Any, slopes: Any) -> None:
        parts = np.broadcast_arrays(rows, columns, slopes)
        for kept, part in zip((self.rows, self.columns, self.slopes), parts, strict=True):
            kept.append(part.ravel())

    def _collocation(self, arc: int) -> None:
        """z_i - z_0 - h sum a_ij f_j at the stages, and the step to the next node."""
        arcs, d, k = self.arcs, 2 * self.arcs.n, self.arcs.intervals[arc]
        constraint, gauss = arcs.structure.arcs[arc], scheme(STAGES)
        a, b = arcs.times[arc : arc + 2]
        t, z = arcs.stages(arc)
        places, values = t.ravel(), z.reshape(-1, d).T
        f = field(arcs.instance, constraint, places, values).T.reshape(k, STAGES, d)
        table = np.vstack([gauss.matrix, gauss.weights])  # the last row leads to the next node
        h = (b - a) / k
        known = arcs.nodes(arc)
        begins = known[:-1].reshape(k, STAGES + 1, d)[:, 0]
        reached = np.concatenate([z, known[STAGES + 1 :: STAGES + 1][:, None]], axis=1)
        moved = np.einsum("ij,kjd->kid", table, f)
        self.residuals.append((reached - begins[:, None] - h * moved).ravel())
        if not self.sloped:
            return
        f_z, f_t = _derivatives(lambda at, y: field(arcs.instance, constraint, at, y), places, values)
        f_t = f_t.T.reshape(k, STAGES, d)
        f_z = f_z.transpose(2, 0, 1).reshape(k, STAGES, d, d)
        first, rows = arcs.places[arc], self.height + np.arange(k * (STAGES + 1) * d).reshape(k, STAGES + 1, d)
        begin = first + (np.arange(k)[:, None] * (STAGES + 1)) * d + np.arange(d)
        stage = begin[:, None, :] + (np.arange(1, STAGES + 2) * d)[None, :, None]
        self._add(rows, stage, 1.0)
        self._add(rows, begin[:, None, :], -1.0)
        slopes = -h * table[None, :, :, None, None] * f_z[:, None]  # interval, row, stage, component, by which
        self._add(rows[:, :, None, :, None], stage[:, None, :STAGES, None, :], slopes)
        share = (np.arange(k)[:, None] + gauss.nodes) / k
        bounds = arcs.rest.bounds(arc, len(arcs.intervals))
        for place, sign, passing in zip(bounds, (-1.0, 1.0), (1.0 - share, share), strict=True):
            if place is not None:
                later = h * np.einsum("ij,kjd->kid", table, f_t * passing[:, :, None])
                self._add(rows, place, -(sign * moved / k + later))
        self.height += rows.size

    def _start(self) -> None:
        """Given states; what is held where the first arc is on a boundary."""
        arcs, n = self.arcs, self.arcs.n
        self.residuals.append(arcs.node(0, 0)[:n] - np.array(arcs.instance.initial))
        self._add(self.height + np.arange(n), np.arange(n), 1.0)
        self.height += n
        if arcs.structure.starts:
            constraint = arcs.structure.contacts[0].constraint
            time = np.array([arcs.instance.t0])
            self._conditions(lambda v: _held(arcs.instance, constraint, time, v), np.arange(2 * n))

    def _junction(self, k: int, junction: Junction) -> None:
        """States continue, costates jump; tangency, and what is held on a boundary after it."""
        arcs, n, d, constraint = self.arcs, self.arcs.n, 2 * self.arcs.n, junction.constraint
        before, after = arcs.places[k + 1] - d, arcs.places[k + 1]
        time, jump = arcs.rest.times + k, arcs.rest.jumps.get(k)
        columns = np.concatenate([np.arange(before, before + d), np.arange(after, after + d), [time]])
        columns = columns if jump is None else np.append(columns, jump)

        def conditions(v: Array) -> Array:
            left, right, t = v[:d], v[d : 2 * d], v[2 * d]
            gap = right - left
            if jump is not None:
                gap[n:] = gap[n:] + v[2 * d + 1] * gradient(arcs.instance, constraint, t, left[:n])
            if junction.event is Event.EXIT:
                return gap
            pinned = junction.event is Event.ENTRY and arcs.pinned and k == len(arcs.junctions) - 1
            found = [gap] if pinned else [gap, _tangency(arcs.instance, constraint, t, left[:n])]
            if junction.event is Event.ENTRY:
                found.append(_held(arcs.instance, constraint, t, right))
            return np.concatenate(found)

        self._conditions(conditions, columns)

    def _end(self) -> None:
        """The boundary residuals; where a constraint pushes at the end, with costates after its jump."""
        arcs, one, n, d = self.arcs, self.arcs.instance, self.arcs.n, 2 * self.arcs.n
        rest, last = arcs.rest, arcs.places[-1] - d
        free = [] if rest.end is None else [rest.end]
        columns = np.array([*range(last, last + d), *range(rest.nu, rest.size), *free])
        final = final_argument(one)

        def conditions(v: Array) -> Array:
            z, nu, t = v[:d], v[d : d + rest.constraints], v[-1] if free else np.full(1, one.tf, dtype=complex)
            lam = z[n:]
            if rest.pressed:
                constraint = arcs.structure.contacts[-1].constraint
                lam = lam - v[d + rest.constraints] * gradient(one, constraint, t, z[:n])
            bounds = one.control_set.arguments
            found = np.asarray(one.model.boundary_batch(t, z[:n], lam, tuple(nu), one.parameters, bounds, final))
            return found if free else found[:-1]

        self._conditions(conditions, columns)

    def _conditions(self, conditions: Callable[[Array], Array], columns: Array) -> None:
        """Conditions on a few unknowns, each a row of one column, by complex steps."""
        here = self.arcs.unknown[columns].astype(complex)
        value = np.real(conditions(here[:, None])[:, 0])
        if not self.sloped:
            self.residuals.append(value)
            return
        moved = here[:, None] + 1j * COMPLEX_STEP * np.eye(len(here))
        slopes = np.column_stack([np.imag(conditions(moved[:, j : j + 1])[:, 0]) for j in range(len(here))]) / COMPLEX_STEP
        self.residuals.append(value)
        self._add(self.height + np.arange(len(value))[:, None], columns, slopes)
        self.height += len(value)


def _tangency(instance: Instance, constraint: int, t: Array, x: Array) -> Array:
    """g, and its first rate where the order is two, shape (q, 1)."""
    model, p = instance.model, instance.parameters
    found = [values(instance, t, x)[constraint]]
    if model.spec.path_constraints[constraint].order > 1:
        rest = np.zeros((len(model.spec.controls), 1))
        found.append(np.asarray(model.path_rates_batch(t, x, rest, p)).reshape(-1, 2, 1)[constraint, 0])
    return np.array(found)


def _held(instance: Instance, constraint: int, t: Array, z: Array) -> Array:
    """What vanishes besides on a boundary, shape (q, 1)."""
    model, n = instance.model, len(instance.initial)
    found = np.asarray(model.path_held_batch(t, z[:n], z[n:], instance.parameters)).reshape(-1, 2, 1)[constraint]
    return found[: model.spec.path_constraints[constraint].order]


def _derivatives(rates: Callable[[Array, Array], Array], t: Array, z: Array) -> tuple[Array, Array]:
    """Derivatives of a field by the values, shape (2n, 2n, N), and by time."""
    slopes = np.empty((len(z), *z.shape))
    for j in range(len(z)):
        moved = z.astype(complex)
        moved[j] += 1j * COMPLEX_STEP
        slopes[:, j] = np.imag(rates(t, moved)) / COMPLEX_STEP
    by_time = np.imag(rates(t + 1j * COMPLEX_STEP, z.astype(complex))) / COMPLEX_STEP
    return slopes, by_time
