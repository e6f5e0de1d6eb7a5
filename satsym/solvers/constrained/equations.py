"""The multi-point problem of a structure: Gauss collocation on every arc, and what holds where arcs meet."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.collocation.gauss import STAGES, scheme
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.constrained.arcs import (
    Arcs,
    control,
    field,
    gradient,
    holds_control,
    values,
    vanishing,
    without_bounds,
)
from satsym.solvers.constrained.structure import FREE, Event, Junction

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


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
        f_z, f_t = _derivatives(partial(field, arcs.instance, constraint), places, values)
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
        if arcs.structure.starts and not holds_control(arcs.instance, arcs.structure.contacts[0].constraint):
            constraint = arcs.structure.contacts[0].constraint
            time = np.array([arcs.instance.t0])
            self._conditions(lambda v: vanishing(arcs.instance, constraint, time, v), list(range(2 * n)))

    def _junction(self, k: int, junction: Junction) -> None:
        """States continue, costates jump; tangency, and what is held on a boundary after it."""
        arcs, n, d, constraint = self.arcs, self.arcs.n, 2 * self.arcs.n, junction.constraint
        before, after = arcs.places[k + 1] - d, arcs.places[k + 1]
        time, jump = arcs.rest.times + k, arcs.rest.jumps.get(k)
        columns = [*range(before, before + d), *range(after, after + d), time, *([] if jump is None else [jump])]

        def conditions(v: Array) -> Array:
            left, right, t = v[:d], v[d : 2 * d], v[2 * d]
            gap = right - left
            if jump is not None:
                gap[n:] = gap[n:] + v[2 * d + 1] * gradient(arcs.instance, constraint, t, left[:n])
            if holds_control(arcs.instance, constraint):
                return np.concatenate([gap, changing(arcs.instance, arcs.structure.arcs[k], constraint, t, left)])
            if junction.event is Event.EXIT:
                return gap
            pinned = junction.event is Event.ENTRY and arcs.pinned and k == len(arcs.junctions) - 1
            found: list[NDArray[Any]] = [gap]
            if not pinned:
                found.append(_tangency(arcs.instance, constraint, t, left[:n]))
            if junction.event is Event.ENTRY:
                found.append(vanishing(arcs.instance, constraint, t, right))
            return np.concatenate(found)

        self._conditions(conditions, columns)

    def _end(self) -> None:
        """The boundary residuals; where a constraint pushes at the end, with costates after its jump."""
        arcs, one, n, d = self.arcs, self.arcs.instance, self.arcs.n, 2 * self.arcs.n
        rest, last = arcs.rest, arcs.places[-1] - d
        free = [] if rest.end is None else [rest.end]
        columns = [*range(last, last + d), *range(rest.nu, rest.size), *free]

        def conditions(v: Array) -> Array:
            z, nu, t = v[:d], v[d : d + rest.constraints], v[-1] if free else np.full(1, one.tf, dtype=complex)
            lam = z[n:]
            if rest.pressed:
                constraint = arcs.structure.contacts[-1].constraint
                lam = lam - v[d + rest.constraints] * gradient(one, constraint, t, z[:n])
            rows = at_end(one, arcs.structure.arcs[-1], t, np.concatenate([z[:n], lam]), tuple(nu))
            rows = rows if free else rows[:-1]
            if not (rest.pressed and arcs.structure.contacts[-1].touches):
                return rows
            u = np.zeros((len(one.model.spec.controls), 1))
            return np.concatenate([rows, values(one, t, z[:n], u)[arcs.structure.contacts[-1].constraint][None]])

        self._conditions(conditions, columns)

    def _conditions(self, conditions: Callable[[Array], Array], columns: Sequence[int]) -> None:
        """Conditions on a few unknowns, each a row of one column, by complex steps."""
        here = self.arcs.unknown[list(columns)].astype(complex)
        value = np.real(conditions(here[:, None])[:, 0])
        if not self.sloped:
            self.residuals.append(value)
            return
        moved = here[:, None] + 1j * COMPLEX_STEP * np.eye(len(here))
        slopes = (
            np.column_stack([np.imag(conditions(moved[:, j : j + 1])[:, 0]) for j in range(len(here))]) / COMPLEX_STEP
        )
        self.residuals.append(value)
        self._add(self.height + np.arange(len(value))[:, None], np.array(columns), slopes)
        self.height += len(value)


def changing(instance: Instance, before: int, constraint: int, t: Array, z: Array) -> Array:
    """What vanishes where a constraint that holds a control becomes active after an arc, or inactive, shape (1, N).

    Where another one is active before, that is the constraint itself under the control that keeps the other.
    """
    if before in (FREE, constraint):
        return vanishing(instance, constraint, t, z)
    u = control(instance, before, t, z)
    return values(instance, t, z[: len(instance.initial)], u)[[constraint]]


def at_end(instance: Instance, constraint: int, t: Array, z: Array, nu: tuple[Any, ...]) -> Array:
    """The boundary residuals, that of a free final time last, after an arc on the boundary of a constraint or on none.

    In that one H stands under the control of that arc.
    """
    model, n, p, bounds = instance.model, len(instance.initial), instance.parameters, without_bounds(instance)
    x, lam = z[:n], z[n:]
    found = np.array(model.boundary_batch(t, x, lam, nu, p, bounds, final_argument(instance)))
    if holds_control(instance, constraint):
        law = model.control_law_batch(t, x, lam, p, bounds)
        ours, other = (model.hamiltonian_batch(t, x, u, lam, p) for u in (control(instance, constraint, t, z), law))
        found[-1] += np.asarray(ours) - np.asarray(other)
    return found


def _tangency(instance: Instance, constraint: int, t: Array, x: Array) -> Array:
    """g, and its first rate where the order is two, shape (q, 1)."""
    model, p = instance.model, instance.parameters
    rest = np.zeros((len(model.spec.controls), 1))
    found = [values(instance, t, x, rest)[constraint]]
    if model.spec.path_constraints[constraint].order > 1:
        found.append(np.asarray(model.path_rates_batch(t, x, rest, p)).reshape(-1, 2, 1)[constraint, 0])
    return np.array(found)


def _derivatives(
    rates: Callable[[NDArray[Any], NDArray[Any]], NDArray[Any]], t: Array, z: Array
) -> tuple[Array, Array]:
    """Derivatives of a field by the values, shape (2n, 2n, N), and by time."""
    slopes = np.empty((len(z), *z.shape))
    for j in range(len(z)):
        moved = z.astype(complex)
        moved[j] += 1j * COMPLEX_STEP
        slopes[:, j] = np.imag(rates(t, moved)) / COMPLEX_STEP
    by_time = np.imag(rates(t + 1j * COMPLEX_STEP, z.astype(complex))) / COMPLEX_STEP
    return slopes, by_time
