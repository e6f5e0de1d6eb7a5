"""An instance as a nonlinear programme, by Radau collocation of degree three on a mesh.

The unknowns are, in units of their scales, the states at all points, the control variables at collocation points, the
durations of the phases between waypoints, and the other free quantities of the instance. See Betts, Practical Methods
for Optimal Control and Estimation Using Nonlinear Programming (2010), chapter 4.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numpy.polynomial import Polynomial
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.search.controls import Controls
from satsym.solvers.search.points import Points

DEGREE = 3
"""Number of collocation points of an interval."""

RADAU = np.array([(4.0 - np.sqrt(6.0)) / 10.0, (4.0 + np.sqrt(6.0)) / 10.0, 1.0])
"""Positions of the collocation points in an interval, from 0 to 1."""

SHORTEST_DURATION, LONGEST_DURATION = 1e-3, 100.0
"""Smallest and largest value of a free duration, relative to its initial guess."""

ROUGHLY = 0.5
"""Relative tolerance for a given final state that follows from the others."""

FREE = np.inf

Places: TypeAlias = NDArray[np.intp]
Function: TypeAlias = Callable[[Array], Array]


def basis(nodes: Array) -> list[Polynomial]:
    """Return the Lagrange polynomials, which are 1 at one node and 0 at the others."""
    found = []
    for j, node in enumerate(nodes):
        others = np.delete(nodes, j)
        one = Polynomial.fromroots(others)
        found.append(one / one(node))
    return found


NODES = np.concatenate([[0.0], RADAU])
SLOPES = np.array([[one.deriv()(tau) for tau in RADAU] for one in basis(NODES)])
"""Derivatives (degree + 1, degree) of the polynomials through all nodes, at the collocation points."""
WEIGHTS = np.array([one.integ()(1.0) - one.integ()(0.0) for one in basis(RADAU)])
"""Quadrature weights of the collocation points."""


@dataclass(frozen=True)
class Sizes:
    """Scales of the unknowns."""

    states: Array
    variables: Array
    duration: float
    cost: float
    free: Array
    """Scales of the free parameters."""


@dataclass(frozen=True)
class Rows:
    """Constraint rows of one kind: index of the first row, and lower and upper limits."""

    first: int
    lower: Array
    upper: Array

    @property
    def places(self) -> slice:
        """Positions of the rows of this kind among all constraint rows."""
        return slice(self.first, self.first + len(self.lower))


@dataclass(eq=False)
class Transcription:
    """The unknowns of a nonlinear programme, their bounds, and the values of its cost and constraint rows.

    Parameters
    ----------
    meshes
        Edges of the intervals of each phase, from 0 to 1.
    smoothing
        Square root of the amount by which the squared norm of a control is less than the square of its bounding
        variable.
    loose
        A state whose given final value follows from the others: it is prescribed loosely, which only decides its sign.
    """

    instance: Instance
    controls: Controls
    meshes: Sequence[Array]
    sizes: Sizes
    smoothing: float = 1e-3
    loose: str = ""
    kinds: dict[str, Rows] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.phases = len(self.meshes)
        lengths = [np.diff(mesh) for mesh in self.meshes]
        self.fractions = np.concatenate(lengths)
        self.intervals = len(self.fractions)
        self.count = self.intervals * DEGREE
        phase = np.repeat(np.arange(self.phases), [len(one) for one in lengths])
        self.phase = np.repeat(phase, DEGREE)
        begin = np.concatenate([mesh[:-1] for mesh in self.meshes])
        place = (begin[:, None] + self.fractions[:, None] * RADAU).ravel()
        before = np.tril(np.ones((self.phases, self.phases)), -1)
        own = np.equal.outer(self.phase, np.arange(self.phases))
        self.shares = before[self.phase] + own * place[:, None]
        """Fractions of the durations of all phases that make up the time of each point, one row for each point."""
        self.steps = own * np.repeat(self.fractions, DEGREE)[:, None]
        self.weights = np.tile(WEIGHTS, self.intervals)
        unknown = self.instance.free
        self.free = [one for one in unknown if one.place is Place.PARAMETER]
        self.starts = any(one.place is Place.TIME for one in unknown)
        size = np.concatenate(
            [self.sizes.states, self.sizes.variables, [self.sizes.duration], self.sizes.free[: len(self.free)]]
        )
        self.points = Points(self.instance, self.controls, tuple(one.index for one in self.free), size)
        self._last_local: tuple[bytes, tuple[Array, Array, Array]] | None = None
        self._last_rates: tuple[bytes, Array] | None = None
        self._last_slopes: tuple[bytes, Array] | None = None
        self._placed()
        self._listed()

    def _placed(self) -> None:
        n, k, points = self.points.states, self.controls.count, self.count
        self.first_variable = n * (points + 1)
        self.first_duration = self.first_variable + k * points
        self.first_free = self.first_duration + self.phases
        self.first_start = self.first_free + len(self.free)
        self.unknowns = self.first_start + self.starts
        self.globals = np.arange(self.first_duration, self.unknowns)

    def unpacked(self, w: Array) -> tuple[Array, Array, Array, Array, float]:
        """Return states (n, N + 1), variables (k, N), durations (P,), free parameters, and the initial time."""
        n, k = self.points.states, self.controls.count
        x = w[: self.first_variable].reshape(self.count + 1, n).T * self.sizes.states[:, None]
        v = w[self.first_variable : self.first_duration].reshape(self.count, k).T * self.sizes.variables[:, None]
        return x, v, *self._shared(w)

    def _shared(self, w: Array) -> tuple[Array, Array, float]:
        """Return durations (P,), free parameters, and the initial time."""
        durations = w[self.first_duration : self.first_free] * self.sizes.duration
        free = w[self.first_free : self.first_start] * self.sizes.free[: len(self.free)]
        start = w[-1] * self.sizes.duration if self.starts else self.instance.t0
        return durations, free, start

    def packed(self, x: Array, v: Array, durations: Array, free: Array, start: float) -> Array:
        """Return the vector of unknowns, the inverse of :meth:`unpacked`."""
        return np.concatenate(
            [
                (x / self.sizes.states[:, None]).T.ravel(),
                (v / self.sizes.variables[:, None]).T.ravel(),
                durations / self.sizes.duration,
                free / self.sizes.free[: len(self.free)],
                [start / self.sizes.duration] * self.starts,
            ]
        )

    def times(self, durations: Array, start: float) -> Array:
        """Return the times of all points, the initial time first."""
        return start + np.concatenate([[0.0], self.shares @ durations])

    def _local(self, w: Array) -> tuple[Array, Array, Array]:
        """Return local variables (l, N) of collocation points, steps (N,), and states (n, N + 1).

        The values for the last unknowns are cached.
        """
        key = w.tobytes()
        if self._last_local is None or self._last_local[0] != key:
            x, v, durations, free, start = self.unpacked(w)
            times = self.times(durations, start)[1:]
            rows = [x[:, 1:], v, times[None], np.repeat(free[:, None], self.count, 1)]
            self._last_local = key, (np.concatenate(rows), self.steps @ durations, x)
        return self._last_local[1]

    def _rates(self, w: Array) -> Array:
        """Return the rates (n + 1, N) at collocation points, cached for the last unknowns."""
        key = w.tobytes()
        if self._last_rates is None or self._last_rates[0] != key:
            self._last_rates = key, self.points.rates(self._local(w)[0])
        return self._last_rates[1]

    def _at(self, w: Array, points: Sequence[int]) -> Array:
        """Return local variables (l, K) at some points, counted from the initial point; control variables are zero."""
        durations, free, start = self._shared(w)
        n, places = self.points.states, np.asarray(points)
        x = w[: self.first_variable].reshape(self.count + 1, n)[places].T * self.sizes.states[:, None]
        v = np.zeros((self.controls.count, len(points)))
        times = self.times(durations, start)[places]
        return np.concatenate([x, v, times[None], np.repeat(free[:, None], len(points), 1)])

    def _listed(self) -> None:
        n, first = self.points.states, 0
        probe = self._at(np.ones(self.unknowns), [0])
        kinds: list[tuple[str, Array, Array]] = [("defects", np.zeros(n * self.count), np.zeros(n * self.count))]
        if held := len(self.points.kept):
            kinds.append(("path", np.full(held * self.count, -FREE), np.zeros(held * self.count)))
        for number, norm in enumerate(self.controls.norms):
            outer, inner = norm.outer, norm.inner
            unit = self._unit(number)
            least = (inner / unit) ** 2 if inner > 0.0 and norm.spot is None else -FREE
            most = 0.0 if norm.spot is not None else (outer / unit) ** 2 if np.isfinite(outer) else FREE
            kinds.append((f"norm{number}", np.full(self.count, least), np.full(self.count, most)))
        ends = len(self.points.ends(probe))
        if ends:
            low = np.zeros(ends)
            low[ends - self.points.inequalities :] = -FREE
            kinds.append(("ends", low, np.zeros(ends)))
        if self.phases > 1:
            count = len(self.points.on_the_way(probe))
            kinds.append(("way", np.zeros(count), np.zeros(count)))
        if self.instance.tf is not None and (self.phases > 1 or self.starts):
            kinds.append(("time", np.zeros(1), np.zeros(1)))
        for name, lower, upper in kinds:
            self.kinds[name] = Rows(first, lower, upper)
            first += len(lower)
        self.rows = first

    def _unit(self, number: int) -> float:
        norm = self.controls.norms[number]
        return float(norm.outer if np.isfinite(norm.outer) else norm.inner or 1.0)

    @cached_property
    def limits(self) -> tuple[Array, Array]:
        """Lower and upper limits of the constraint rows."""
        rows = self.kinds.values()
        return np.concatenate([one.lower for one in rows]), np.concatenate([one.upper for one in rows])

    @cached_property
    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper bounds of the unknowns."""
        instance, spec = self.instance, self.instance.model.spec
        n, points = self.points.states, self.count
        low, high = np.full((n, points + 1), -FREE), np.full((n, points + 1), FREE)
        for i, state in enumerate(spec.states):
            if state.positive:
                low[i] = 1e-4 * self.sizes.states[i]
        start = np.array(instance.initial)
        for i in range(n):
            low[i, 0] = high[i, 0] = start[i]
        for one in instance.free:
            if one.place is Place.INITIAL:
                low[one.index, 0], high[one.index, 0] = (1e-6 * self.sizes.states[one.index], FREE)
                if not one.positive:
                    low[one.index, 0] = -FREE
        for i, name in enumerate(spec.state_names):
            value = instance.final.get(name)
            if isinstance(value, float | int):
                room = ROUGHLY * abs(value) if name == self.loose else 0.0
                low[i, -1], high[i, -1] = value - room, value + room
            if name in instance.ranges:
                low[i, -1], high[i, -1] = instance.ranges[name]
        v_low, v_high = (np.repeat(row[:, None], points, 1) for row in (self.controls.lower, self.controls.upper))
        for norm in self.controls.norms:
            if norm.spot is not None:  # no smoothing takes anything from the largest norm
                v_high[norm.spot] = np.hypot(norm.outer, self.smoothing * norm.outer)
        given = instance.tf is not None and self.phases == 1 and not self.starts
        scale = self.sizes.duration
        exact = 0.0 if instance.tf is None else instance.tf - instance.t0
        shortest = exact if given else SHORTEST_DURATION * scale / self.phases
        longest = exact if given else LONGEST_DURATION * scale
        unlimited = np.full(len(self.free), FREE)
        units = self.sizes.free[: len(self.free)]
        positive = np.array(
            [1e-9 * size if one.positive else -FREE for one, size in zip(self.free, units, strict=True)]
        )
        ends = np.full(self.phases, shortest), np.full(self.phases, longest)
        return (
            self.packed(low, v_low, ends[0], positive, -FREE),
            self.packed(high, v_high, ends[1], unlimited, FREE),
        )

    def values(self, w: Array) -> Array:
        """Return the values of the constraint rows."""
        y, steps, x = self._local(w)
        n, d = self.points.states, DEGREE
        index = np.arange(self.intervals)[:, None] * d + np.arange(d + 1)
        slopes = np.einsum("nkr,rj->nkj", x[:, index], SLOPES).reshape(n, -1)
        defects = (slopes - steps * self._rates(w)[:n]) / self.sizes.states[:, None]
        rows = [defects.T.ravel()]
        if "path" in self.kinds:
            rows.append(self.points.constraints(y).T.ravel())
        rows += [self._norm(number, y) for number in range(len(self.controls.norms))]
        end = self._at(w, [self.count])
        if "ends" in self.kinds:
            rows.append(self.points.ends(end)[:, 0])
        if "way" in self.kinds:
            rows.append(self._way(self._at(w, self._places())))
        if "time" in self.kinds:
            assert self.instance.tf is not None
            rows.append((end[self._time] - self.instance.tf) / self.sizes.duration)
        return np.concatenate(rows)

    @property
    def _time(self) -> int:
        return self.points.states + self.controls.count

    def _places(self) -> list[int]:
        """Return the indices of the waypoints among the points."""
        return (DEGREE * np.cumsum([len(mesh) - 1 for mesh in self.meshes])[:-1]).tolist()

    def _way(self, y: Array) -> Array:
        every, first, rows = self.points.on_the_way(y), 0, []
        for k, one in enumerate(self.instance.model.spec.interior):
            rows.append(every[first : first + one.conditions, k])
            first += one.conditions
        return np.concatenate(rows)

    def _norm(self, number: int, y: Array) -> Array:
        norm, n = self.controls.norms[number], self.points.states
        unit = self._unit(number)
        length = sum((y[n + place] / unit) ** 2 for place in norm.places)
        if norm.spot is None:
            return np.asarray(length)
        return np.asarray(length - (y[n + norm.spot] / unit) ** 2 + self.smoothing**2)

    def raised(self, multipliers: Array) -> float:
        """Return by how much smoothing of norms raises the scaled cost, to first order.

        The derivative with respect to the squared smoothing is the sum of the multipliers of the norms' rows (envelope
        theorem). If norms vanish, the cost rises linearly with the smoothing, so that this derivative counts twice.
        """
        rows = [self.kinds[f"norm{k}"] for k, norm in enumerate(self.controls.norms) if norm.spot is not None]
        return 2.0 * self.smoothing**2 * float(sum(multipliers[row.places].sum() for row in rows))

    def objective(self, w: Array) -> float:
        """Return the cost in units of its scale."""
        _, steps, _ = self._local(w)
        running = self._rates(w)[-1] @ (steps * self.weights)
        return float(running + self.points.cost(self._at(w, [self.count]))[0, 0]) / self.sizes.cost
