"""Newton's method for the initial costates, switching times, final time and multipliers of a structure."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.failures import FAILURES
from satsym.solvers.switching.boundary import BoundaryField, off_boundary
from satsym.solvers.switching.extremal_arcs import ROUGH, TOLERANCE, Accuracy, Arc, Stop, Unknowns, extremal, jumped
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import BOUNDARY, SINGULAR, Structure, constraint_of, jumps

MOST_STEPS = 20
NEAR_CORRECTION = 1e-2
"""Size of a correction below which arcs are integrated at full accuracy; above it rough accuracy is enough."""

SETTLED_CORRECTION = 1e-7
"""Size of a correction below which no further correction follows."""

LOST = 1e4
"""Size of a correction above which the iteration is given up."""

FREE, GROWN = 4, 2.0
"""``FREE`` is the number of corrections after which none may exceed the previous one by more than the factor
``GROWN``."""

STEADY, EVEN = 3, 0.8
"""``STEADY`` is the number of successive reduction factors of corrections that are compared; corrections decrease
evenly if each factor is at least ``EVEN`` times the one before."""

BOLD = 0.5
"""Largest change of times in one correction, relative to the duration."""

TURNED = 2.0
"""Largest change of costates in one correction, relative to their scales."""

RANK = 1e-11
"""Smallest relative singular value of a direction that the equations determine."""


@dataclass(frozen=True, eq=False)
class Refined:
    """An extremal of a structure."""

    structure: Structure
    at: Unknowns
    """Levels of the controls, and the unknowns that solve the equations."""
    arcs: list[Arc]
    """Arcs of the extremal."""
    residual: float
    """Largest residual, relative to its scale."""
    iterations: int
    """Number of corrections."""
    sizes: Array
    """Scales of states and costates that residuals are relative to, shape (2n,)."""
    stops: tuple[Stop, ...] = ()
    """Restarts of the integration."""


@dataclass(frozen=True, eq=False)
class Equations:
    """The equations at the end of an extremal and at its switches, each scaled."""

    instance: Instance
    structure: Structure
    """The instance, and the levels of its controls."""
    sizes: Array
    """Scales of states and costates, shape (2n,)."""
    duration: float
    """Typical duration."""
    stops: tuple[Stop, ...] = ()
    """Restarts of the integration."""

    @property
    def free_time(self) -> bool:
        """Return whether the final time is free."""
        return self.instance.tf is None

    def start(
        self, costates: Array, times: Array, end: float, stops: Array | None = None, jumps: Array | None = None
    ) -> Unknowns:
        """Return unknowns with zero multipliers of terminal constraints."""
        none = np.zeros(len(self.instance.model.spec.multipliers))
        values = np.zeros((0, len(self.sizes))) if stops is None else stops
        jumps = np.zeros(len(self.structure.jumps)) if jumps is None else jumps
        return Unknowns(np.asarray(costates), np.asarray(times), end, none, values, jumps)

    def arcs(self, at: Unknowns, slopes: bool = True, tolerance: float = TOLERANCE) -> list[Arc]:
        """Return the arcs of the extremal; raises the same errors as :func:`extremal`."""
        return extremal(self.instance, self.structure, at, Accuracy(self.sizes, slopes, tolerance), self.stops)

    def residual(self, at: Unknowns, arcs: list[Arc]) -> tuple[Array, Array]:
        """Return residuals and their derivatives by all unknowns, in units of :attr:`scale`, shapes (r,) and (r, v)."""
        values, slopes = self._end(at, arcs[-1])
        inner = [row for before, after in pairwise(arcs) for row in self._junction(at, before, after)]
        inner += self._singular_start(arcs[0])
        table = np.zeros((len(inner), slopes.shape[1]))
        for k, (_, row) in enumerate(inner):
            own = self._known(row)
            table[k, : len(own)] = own
        both = np.concatenate([slopes, table]) * self.scale
        return np.concatenate([values, [value for value, _ in inner]]), both

    @property
    def scale(self) -> Array:
        """Return the scales of the unknowns."""
        n = len(self.instance.initial)
        times = np.full(self.structure.switches + self.free_time, self.duration)
        cost = float((self.sizes[:n] * self.sizes[n:]).max())
        multipliers = np.full(len(self.instance.model.spec.multipliers), cost)
        jumps = [cost / self._room(constraint) for *_, constraint in self.structure.jumps]
        return np.concatenate([self.sizes[n:], times, np.tile(self.sizes, len(self.stops)), jumps, multipliers])

    def _room(self, constraint: int) -> float:
        """Return the typical magnitude of a path constraint, the unit of its jumps.

        It is the value at the initial state or, if larger, the change of the constraint with the scales of the states.
        """
        start = [*self.instance.initial, *np.zeros(len(self.instance.initial))]
        value, gradient, _ = off_boundary(self.instance, constraint, self.instance.t0, start)
        return max(abs(value), float(np.abs(gradient) @ self.sizes), 1e-300)

    def moved(self, at: Unknowns, step: Array) -> Unknowns:
        """Return the unknowns after a step in units of :attr:`scale`."""
        n, k = len(at.costates), len(at.times)
        change = step * self.scale
        end = at.end + float(change[n + k]) if self.free_time else at.end
        ends = np.cumsum([at.stops.size, len(at.jumps)])
        stops, jumps, multipliers = np.split(change[n + k + self.free_time :], ends)
        at = replace(at, stops=at.stops + stops.reshape(at.stops.shape), multipliers=at.multipliers + multipliers)
        at = replace(at, jumps=at.jumps + jumps)
        return replace(at, costates=at.costates + change[:n], times=at.times + change[n : n + k], end=end)

    def _end(self, at: Unknowns, last: Arc) -> tuple[Array, Array]:
        """Return the residuals of the generated boundary function with the control of the last arc, and derivatives."""
        instance, n = self.instance, len(self.instance.initial)
        model, z = instance.model, last.after.tolist()
        point = (at.end, tuple(z[:n]), tuple(z[n:]), tuple(at.multipliers))
        arguments = (*point, instance.parameters, last.field.kept_at(at.end, z), final_argument(instance))
        residual = np.array(model.boundary(*arguments))
        by = np.array(model.boundary_jacobian(*arguments)).reshape(len(residual), -1)
        count = len(at.multipliers)
        by_end, by_multipliers, by_time = by[:, : 2 * n], by[:, 2 * n : 2 * n + count], by[:, -1]
        slopes = by_end @ last.slopes
        slopes[:, n + self.structure.switches] += by_time
        if not self.free_time:
            slopes, residual, by_multipliers = self._known(slopes[:-1]), residual[:-1], by_multipliers[:-1]
        sizes = np.abs(by_end) @ self.sizes
        rows = np.maximum(sizes[: len(residual)], 1e-300)
        if self.free_time:
            rates = np.abs(last.field.rates(at.end, z))
            rows[-1] = max(float(self.sizes[n:] @ rates[:n]), 1e-300)
        together = np.concatenate([slopes, by_multipliers], axis=1)
        return residual / rows, together / rows[:, None]

    def _known(self, row: Array) -> Array:
        """Return derivatives without the column of a final time that is given."""
        place = len(self.instance.initial) + self.structure.switches
        return row if self.free_time else np.delete(row, place, axis=-1)

    def _junction(self, at: Unknowns, before: Arc, after: Arc) -> list[tuple[float, Array]]:
        """Return the conditions between two arcs: the gap at a restart, or the conditions of a switch."""
        if before.stop is None:
            return self._switch(at, before, after)
        slopes, size = before.slopes.copy(), len(self.sizes)
        begin = len(self.instance.initial) + self.structure.switches + 1 + before.stop * size
        slopes[:, begin : begin + size] -= np.eye(size)
        gap = (before.after - after.before) / self.sizes
        return list(zip(gap.tolist(), slopes / self.sizes[:, None], strict=True))

    def _switch(self, at: Unknowns, before: Arc, after: Arc) -> list[tuple[float, Array]]:
        """Return the conditions of a switch; none at the end of singular arcs and boundary arcs without jump."""
        event = before.event
        assert event is not None
        i = event.control
        levels = (before.field.levels[i], after.field.levels[i])
        switch = _Switch(before.field, before.end, before.after.tolist(), before.slopes, i, event.column)
        later = self._after_jump(at, switch, before, after)
        rows = [] if levels[0] >= SINGULAR else [(later if jumps(levels[1])[0] else switch).row(levels, self.sizes)]
        if levels[1] == SINGULAR:
            rows.append(later.rate_row(self.sizes))
        if levels[1] >= BOUNDARY:
            which = constraint_of(levels[1])
            second = self.instance.model.spec.path_constraints[which].order > 1
            for rate in (False, True) if second else (False,):
                rows.append(
                    switch.vanishing_row(*off_boundary(self.instance, which, switch.t, switch.z, rate), self.sizes)
                )
            rows += [later.rate_row(self.sizes)] if second else []
        for field, jumping, other in (
            (before.field, jumps(levels[0])[1], after),
            (after.field, jumps(levels[1])[0], before),
        ):
            if jumping and isinstance(field, BoundaryField) and field.order == 1:
                rows.append(switch.vanishing_row(*field.off_bound(other.field.saturated[i], switch.t, switch.z)))
        return rows

    def _after_jump(self, at: Unknowns, switch: _Switch, before: Arc, after: Arc) -> _Switch:
        """Return the switch with the values after a jump, as the next arc sees it."""
        later = replace(switch, field=after.field, t=after.start, z=after.before.tolist())
        for k, (control, number, constraint) in enumerate(self.structure.jumps):
            assert before.event is not None
            if (control, number) == (before.event.control, before.event.number):
                n, count = len(self.instance.initial), before.slopes.shape[1]
                moving = np.eye(count)[n + before.event.column]
                column = count - len(self.structure.jumps) + k
                slopes = jumped(self.instance, constraint, before, at.jumps[k], moving, column)
                return replace(later, slopes=slopes)
        return later

    def _singular_start(self, first: Arc) -> list[tuple[float, Array]]:
        """Return the conditions at the initial time if the first arc is singular or on a boundary."""
        kept = first.field.kept
        if kept is None:
            return []
        n = len(self.instance.initial)
        slopes = np.zeros((2 * n, first.slopes.shape[1]))
        slopes[n:, :n] = np.eye(n)
        start = _Switch(first.field, first.start, first.before.tolist(), slopes, kept, None)
        rows = [start.row((SINGULAR, SINGULAR), self.sizes)]
        if isinstance(first.field, BoundaryField):  # nothing moves the start to the boundary
            value, gradient, _ = off_boundary(self.instance, first.field.constraint, start.t, start.z)
            size = max(float(np.abs(gradient) @ self.sizes), abs(value), 1e-300)
            return [*rows, (value / size, np.zeros(first.slopes.shape[1]))]
        return [*rows, start.rate_row(self.sizes)]


@dataclass(frozen=True, eq=False)
class _Switch:
    """A switch of a control: its time and values, and their derivatives by the unknowns."""

    field: Field
    t: float
    z: list[float]
    """Equations of an adjacent arc, the time, and states and costates there."""
    slopes: Array
    """Derivatives of the states and costates by all unknowns, shape (2n, v)."""
    control: int
    column: int | None
    """Index of the control, and position of the time among the switching times; ``None`` if it is not unknown."""

    def row(self, levels: tuple[int, int], sizes: Array) -> tuple[float, Array]:
        """Return the scaled switching condition between two levels, and its derivatives by the unknowns."""
        field, place = self.field, (self.t, self.z, self.control)
        ratio = field.ratio(self.control, levels)
        target = ratio * field.weight(*place) if ratio else 0.0
        value, rate = field.passing(*place, ratio)
        size = max(float(np.abs(field.gradient(*place)) @ sizes), abs(target), 1e-300)
        return value / size, self._moving(field.passing_gradient(*place, ratio), rate) / size

    def rate_row(self, sizes: Array) -> tuple[float, Array]:
        """Return the scaled rate of the switching function at the switch, and its derivatives by the unknowns."""
        field, place = self.field, (self.t, self.z, self.control)
        gradient = field.rate_gradient(*place)
        _, rate = field.switching(*place)
        size = max(float(np.abs(gradient) @ sizes), 1e-300)
        return rate / size, self._moving(gradient, 0.0) / size

    def vanishing_row(
        self, value: float, gradient: Array, by_time: float, sizes: Array | None = None
    ) -> tuple[float, Array]:
        """Return a function of states and time, scaled if ``sizes`` are given, and its derivatives by the unknowns."""
        size = 1.0 if sizes is None else max(float(np.abs(gradient) @ sizes), 1e-300)
        rate = by_time + float(gradient @ np.array(self.field.rates(self.t, self.z)))
        return value / size, self._moving(gradient, rate) / size

    def _moving(self, gradient: Array, rate: float) -> Array:
        """Return derivatives by all unknowns of a function of time and z whose time is an unknown."""
        row = gradient @ self.slopes
        if self.column is not None:
            place = len(self.z) // 2 + self.column
            row[place] += rate - gradient @ np.array(self.field.rates(self.t, self.z))
        return np.asarray(row)


def solve(equations: Equations, start: Unknowns, watch: Callable[[float, float], None] | None = None) -> Refined | None:
    """Solve the equations by Newton's method, damped for large steps only; ``None`` if the iteration fails.

    Parameters
    ----------
    watch
        Function that is told NaN for the cost, which is not known yet, and the size of each correction.
    """
    at, seen = start, [float("inf")]
    for iteration in range(1, MOST_STEPS + 1):
        before = seen[-1]
        try:
            close = before < NEAR_CORRECTION
            arcs = equations.arcs(at, tolerance=TOLERANCE if close else ROUGH)
            residual, slopes = equations.residual(at, arcs)
            step = _least_squares(slopes, -residual)
        except FAILURES:
            return None
        size = float(np.abs(step).max(initial=0.0))
        if watch:
            watch(math.nan, size)
        seen.append(size)
        if not size < LOST or (iteration > FREE and size > GROWN * before) or _too_slow(seen):
            return None
        if close and size < SETTLED_CORRECTION:  # what is left to correct is about its square
            at = equations.moved(at, step)
            arcs = equations.arcs(at, slopes=False)
            values, _ = equations.residual(at, arcs)
            worst = float(np.abs(values).max(initial=0.0))
            return Refined(equations.structure, at, arcs, worst, iteration, equations.sizes, equations.stops)
        n = len(at.costates)
        span = float(np.abs(step[n : n + len(at.times) + equations.free_time]).max(initial=0.0))
        turn = float(np.abs(step[:n]).max(initial=0.0))
        at = equations.moved(at, step * min(1.0, BOLD / max(span, 1e-300), TURNED / max(turn, 1e-300)))
        if equations.free_time and not at.end > equations.instance.t0:
            return None
        equations = replace(equations, sizes=_resized(equations.sizes, arcs))
    return None


def _too_slow(seen: list[float]) -> bool:
    """Return whether corrections decrease evenly, as if an arc vanishes, and too slowly to converge in time."""
    if len(seen) < STEADY + 2 or not SETTLED_CORRECTION <= seen[-1] < NEAR_CORRECTION:  # none came before the first
        return False
    factors = [after / before for before, after in pairwise(seen[-STEADY - 1 :])]
    even = all(after > EVEN * before for before, after in pairwise(factors))
    return even and seen[-1] * factors[-1] ** (MOST_STEPS + 1 - len(seen)) > SETTLED_CORRECTION


def _least_squares(matrix: Array, right: Array) -> Array:
    found: Array = np.linalg.lstsq(matrix, right, rcond=RANK)[0]
    return found


def _resized(sizes: Array, arcs: list[Arc]) -> Array:
    """Return the scales of the states, and the scales of the costates updated from the arcs."""
    n = len(sizes) // 2
    seen = np.max([np.abs(arc.after[n:]) for arc in arcs] + [np.abs(arcs[0].before[n:])], axis=0)
    cost = float((sizes[:n] * seen).max())
    return np.concatenate([sizes[:n], np.maximum(seen, 1e-3 * cost / sizes[:n]) if cost > 0.0 else sizes[n:]])
