"""The multi-point boundary value problem of a structure: Gauss collocation on each arc, and junction conditions."""

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
from satsym.solvers.constrained.active import analytic, control, deciding, field, vanishing
from satsym.solvers.constrained.arcs import Arcs, gradient, holds_control, missed, values, without_bounds
from satsym.solvers.constrained.structure import Active, Event, Junction

if TYPE_CHECKING:
    from scipy.sparse import csc_matrix


DIFFERENCE = 1e-6
"""Relative step of derivatives that need not be exact, because only Newton's steps depend on them."""


class System:
    """Residuals of all equations, optionally with their derivatives."""

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
        """Return all equations as one vector, which is zero at a solution."""
        return np.concatenate(self.residuals)

    @property
    def jacobian(self) -> csc_matrix:
        """Return the derivatives of all equations with respect to all unknowns."""
        from scipy.sparse import csc_matrix

        places = np.concatenate(self.rows), np.concatenate(self.columns)
        return csc_matrix((np.concatenate(self.slopes), places), shape=(self.height, self.arcs.rest.size))

    def _add(self, rows: Any, columns: Any, slopes: Any) -> None:
        parts = np.broadcast_arrays(rows, columns, slopes)
        for kept, part in zip((self.rows, self.columns, self.slopes), parts, strict=True):
            kept.append(part.ravel())

    def _collocation(self, arc: int) -> None:
        """Add z_i - z_0 - h sum a_ij f_j at the stages, and the step to the next node."""
        arcs, d, k = self.arcs, 2 * self.arcs.n, self.arcs.intervals[arc]
        active, gauss = arcs.active[arc], scheme(STAGES)
        a, b = arcs.times[arc : arc + 2]
        t, z = arcs.stages(arc)
        places, values = t.ravel(), z.reshape(-1, d).T
        f = field(arcs.instance, active, places, values).T.reshape(k, STAGES, d)
        table = np.vstack([gauss.matrix, gauss.weights])  # the last row leads to the next node
        h = (b - a) / k
        known = arcs.nodes(arc)
        begins = known[:-1].reshape(k, STAGES + 1, d)[:, 0]
        reached = np.concatenate([z, known[STAGES + 1 :: STAGES + 1][:, None]], axis=1)
        moved = np.einsum("ij,kjd->kid", table, f)
        self.residuals.append((reached - begins[:, None] - h * moved).ravel())
        if not self.sloped:
            return
        f_z, f_t = _derivatives(partial(field, arcs.instance, active), places, values, analytic(arcs.instance, active))
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
        """Add given initial states, and conditions of a boundary on which the first arc lies."""
        arcs, n = self.arcs, self.arcs.n
        self.residuals.append(arcs.node(0, 0)[:n] - np.array(arcs.instance.initial))
        self._add(self.height + np.arange(n), np.arange(n), 1.0)
        self.height += n
        begun, time = arcs.structure.begun, np.array([arcs.instance.t0])
        for constraint in (k for k in begun if not holds_control(arcs.instance, k)):
            what = partial(vanishing, arcs.instance, begun, constraint, time)
            self._conditions(what, list(range(2 * n)), analytic(arcs.instance, begun))

    def _junction(self, k: int, junction: Junction) -> None:
        """Add continuity of states, jumps of costates, tangency, and conditions of the boundaries after a junction."""
        arcs, d = self.arcs, 2 * self.arcs.n
        before, after = arcs.places[k + 1] - d, arcs.places[k + 1]
        time, jumps = arcs.rest.times + k, [arcs.rest.jumps[k, which] for which, _ in junction.jumps]
        columns = [*range(before, before + d), *range(after, after + d), time, *jumps]
        exact = all(analytic(arcs.instance, active) for active in (junction.before, junction.after))
        self._conditions(partial(_met, arcs, junction), columns, exact)

    def _end(self) -> None:
        """Add the final conditions, with costates after jumps caused by constraints at the final time."""
        arcs, one, n, d = self.arcs, self.arcs.instance, self.arcs.n, 2 * self.arcs.n
        rest, last = arcs.rest, arcs.places[-1] - d
        free = [] if rest.end is None else [rest.end]
        columns = [*range(last, last + d), *range(rest.nu, rest.size), *free]
        touched = [c.constraint for c in arcs.structure.contacts if c.closes and c.touches]

        def conditions(v: Array) -> Array:
            z, nu, t = v[:d], v[d : d + rest.constraints], v[-1] if free else np.full(1, one.tf, dtype=v.dtype)
            lam = z[n:]
            for place, constraint in enumerate(arcs.pressed):
                lam = lam - v[d + rest.constraints + place] * gradient(one, constraint, t, z[:n])
            rows = at_end(one, arcs.active[-1], t, np.concatenate([z[:n], lam]), tuple(nu))
            if not free:
                rows = rows[:-1]
            u = np.zeros((len(one.model.spec.controls), 1))
            met = [k for k in touched if k in arcs.pressed]
            return np.concatenate([rows, values(one, t, z[:n], u)[met]])

        self._conditions(conditions, columns)

    def _conditions(self, conditions: Callable[[Array], Array], columns: Sequence[int], exact: bool = True) -> None:
        """Add conditions on a few unknowns, differentiated by complex steps or differences."""
        here = self.arcs.unknown[list(columns)]
        value = np.real(conditions(here[:, None])[:, 0])
        self.residuals.append(value)
        if not self.sloped:
            return
        slopes = _slopes(lambda v: conditions(v), here[:, None], exact)[..., 0]
        self._add(self.height + np.arange(len(value))[:, None], np.array(columns), slopes)
        self.height += len(value)


def _met(arcs: Arcs, junction: Junction, v: Array) -> Array:
    """Return the quantities that vanish at a junction, from values before and after it, its time and multipliers."""
    instance, n, d, constraint = arcs.instance, arcs.n, 2 * arcs.n, junction.constraint
    left, right, t = v[:d], v[d : 2 * d], v[2 * d]
    gap = right - left
    for (which, _), zeta in zip(junction.jumps, v[2 * d + 1 :], strict=True):
        gap[n:] = gap[n:] + zeta * gradient(instance, which, t, left[:n])
    found: list[NDArray[Any]] = [gap]
    if junction.event is Event.INTERIOR:
        return np.concatenate([gap, *_passed(arcs, junction, v)])
    if holds_control(instance, constraint):
        found.append(deciding(instance, junction.before, constraint, t, left)[None])
    elif junction.event is not Event.EXIT:
        closes = arcs.structure.contacts[junction.contact].closes
        if not (closes and constraint in arcs.pinned):
            found.append(_tangency(instance, constraint, t, left[:n]))
        if junction.event is Event.ENTRY:
            found.append(vanishing(instance, junction.after, constraint, t, right))
    for which, _ in junction.jumps:
        if which != constraint:
            found.append(vanishing(instance, junction.after, which, t, right)[1:])
    return np.concatenate(found)


def _passed(arcs: Arcs, junction: Junction, v: Array) -> list[NDArray[Any]]:
    """Return the quantities that vanish at a waypoint: its conditions, and the derivative of the cost by its time.

    The derivative is H(t-) - H(t+) + pi' N_t.
    """
    instance, n, d = arcs.instance, arcs.n, 2 * arcs.n
    left, right, t = v[:d], v[d : 2 * d], v[2 * d]
    conditions, drift = missed(instance, [which for which, _ in junction.jumps], t, left[:n])
    before, after = (
        hamiltonian(instance, active, t, z) for active, z in ((junction.before, left), (junction.after, right))
    )
    return [conditions, (before - after + (v[2 * d + 1 :] * drift).sum(axis=0))[None]]


def hamiltonian(instance: Instance, active: Active, t: Array, z: Array) -> Array:
    """Return the Hamiltonian under the control of an arc, shape (N,)."""
    n, u = len(instance.initial), control(instance, active, t, z)
    return np.asarray(instance.model.hamiltonian_batch(t, z[:n], u, z[n:], instance.parameters))


def at_end(instance: Instance, active: Active, t: Array, z: Array, nu: tuple[Any, ...]) -> Array:
    """Return the boundary residuals after an arc on boundaries or without one, with the final-time condition last.

    In the final-time condition, H is evaluated under the control of this arc.
    """
    model, n, p, bounds = instance.model, len(instance.initial), instance.parameters, without_bounds(instance)
    x, lam = z[:n], z[n:]
    found = np.array(model.boundary_batch(t, x, lam, nu, p, bounds, final_argument(instance)))
    if any(holds_control(instance, k) for k in active):
        law = model.control_law_batch(t, x, lam, p, bounds)
        ours, other = (model.hamiltonian_batch(t, x, u, lam, p) for u in (control(instance, active, t, z), law))
        found[-1] += np.asarray(ours) - np.asarray(other)
    return found


def _tangency(instance: Instance, constraint: int, t: Array, x: Array) -> Array:
    """Return the value of a constraint and, for order two, its first time derivative, shape (q, 1)."""
    model, p = instance.model, instance.parameters
    rest = np.zeros((len(model.spec.controls), 1))
    found = [values(instance, t, x, rest)[constraint]]
    if model.spec.path_constraints[constraint].order > 1:
        found.append(np.asarray(model.path_rates_batch(t, x, rest, p)).reshape(-1, 2, 1)[constraint, 0])
    return np.array(found)


def _derivatives(
    rates: Callable[[NDArray[Any], NDArray[Any]], NDArray[Any]], t: Array, z: Array, exact: bool
) -> tuple[Array, Array]:
    """Return derivatives of a field with respect to its values, shape (2n, 2n, N), and to time."""
    both = np.concatenate([z, t[None]])
    slopes = _slopes(lambda v: rates(v[-1], v[:-1]), both, exact)
    return slopes[:, :-1], slopes[:, -1]


def _slopes(function: Callable[[NDArray[Any]], NDArray[Any]], at: Array, exact: bool) -> Array:
    """Return derivatives of a function by each component of its argument, (rows, d, N).

    They are complex steps if the function allows these, otherwise central differences.
    """
    columns = []
    for j in range(len(at)):
        unit = np.zeros((len(at), 1))
        unit[j] = 1.0
        if exact:
            columns.append(np.imag(function(at + 1j * COMPLEX_STEP * unit)) / COMPLEX_STEP)
            continue
        step = DIFFERENCE * max(float(np.abs(at[j]).max()), 1e-3)
        columns.append((function(at + step * unit) - function(at - step * unit)) / (2.0 * step))
    return np.stack(columns, axis=1)
