"""RK4 on arrays with as few NumPy calls as possible, since each call moves whole arrays through memory.

Half a step is the unit of time, so that slopes are added unscaled; states whose rates are themselves states need no
slopes of their own. Which states are multiplied by that unit, and which quotients by a number, is tried beforehand. The
result of a step is a sum of rows, of states and slopes, formed by matrix products.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TypeVar

import numpy as np

from satsym.arrays import Array
from satsym.kernels.batch import compiling
from satsym.kernels.batch.factored import INVERSE, UNIT, Arithmetic, Factored
from satsym.kernels.batch.tape import Bound, Buffers, Moved, Operation, Tape, aligned, bound
from satsym.kernels.batch.workspace import inlined
from satsym.kernels.core import Kernels
from satsym.spec import ProblemSpec

T = TypeVar("T")

STAGES = (("now", 0.0), ("middle", 1.0), ("middle", 1.0), ("end", 2.0))
"""For each stage, its time within the step and the multiple of the unit (half a step) for the preceding slope."""

WEIGHTS = (1.0, 2.0, 2.0, 1.0)
"""Weights of the slopes of the four stages, in thirds of a unit."""

SCALES = (2.0, 0.5)
"""Factors of quotients that are tried in the search for the step with fewest operations."""

BLOCK, SMALLEST_BLOCK, CACHE = 8192, 2048, 2.5e6
"""Largest and smallest number of columns processed at a time, and size of the reused rows in bytes.

They are small enough for the processor's cache, and large enough for the overhead of calls to be negligible.
"""

MOST_TRIED, MOST_OPERATIONS = 6, 400
"""Limits of the search for factors: largest number of quotients, and largest number of operations of a step."""


@dataclass(frozen=True)
class Choice:
    """The form in which a step is written."""

    powers: tuple[int, ...]
    """Powers of the unit by which states are multiplied."""
    scales: tuple[float, ...] = ()
    """Powers of the unit by which quotients are multiplied."""
    late: bool = True
    """Whether constant factors are applied as late as possible."""


@dataclass(frozen=True)
class Slope:
    """The rate of a state: a value of its own, or a state times a number."""

    rate: Factored
    state: int | None

    @property
    def row(self) -> int | None:
        """Return the value of a slope that has one of its own."""
        return self.rate.value if self.state is None else None


@dataclass(frozen=True, eq=False)
class Step:
    """An RK4 step on a tape."""

    tape: Tape
    powers: tuple[int, ...]
    """Powers of the unit by which states are multiplied."""
    slopes: tuple[tuple[Slope, ...], ...]
    """Slopes of the states in each stage."""
    ahead: tuple[int | None, ...]
    """For each state, the value of the last stage to which two slopes were added in place; ``None`` if there is
    none."""
    quotients: int
    """Number of quotients whose scales may be chosen."""

    @property
    def rows(self) -> list[int]:
        """Return the slopes that are values of their own."""
        every = (slope.row for stage in self.slopes for slope in stage)
        return list(dict.fromkeys(row for row in every if row is not None))

    @property
    def operations(self) -> int:
        """Count the operations in each step."""
        return self.tape.operations(self.rows)

    @property
    def moved(self) -> list[int]:
        """Return the states that the last stage moves in place."""
        needed = set(self.tape.needed(self.rows))
        return [i for i, value in enumerate(self.ahead) if value in needed]

    def ends(self, unit: float) -> Array:
        """Return the final states as sums of states and rows after the last stage, shape (n, n + rows)."""
        start = now = np.eye(len(self.powers), len(self.powers) + len(self.rows))
        for _ in self.moved:  # each may follow from others
            change = STAGES[-1][1] * self._rates(start, unit)[-2][self.moved]
            start = now.copy()
            start[self.moved] -= change
        rates = self._rates(start, unit)
        return np.asarray(start + sum(weight / 3.0 * one for weight, one in zip(WEIGHTS, rates, strict=True)))

    def _rates(self, start: Array, unit: float) -> list[Array]:
        """Return slopes times the unit, stage by stage, as sums of states and rows, from states in this form."""
        n, places = len(self.powers), {value: k for k, value in enumerate(self.rows)}
        basis, point, found = np.eye(n + len(places))[n:], start, list[Array]()
        for (_, by), slopes in zip(STAGES, self.slopes, strict=True):
            point = start + by * found[-1] if found else start
            rates = np.zeros_like(start)
            for i, (slope, power) in enumerate(zip(slopes, self.powers, strict=True)):
                row = basis[places[slope.row]] if slope.row is not None else point[slope.state]
                rates[i] = slope.rate.factor * unit ** (slope.rate.power + 1 + power) * row
            found.append(rates)
        return found


def fewest(kernels: Kernels) -> Step:
    """Return the step of a model with the fewest operations among those tried.

    Raises
    ------
    Unsuited
        If the dynamics are no straight line of operations.
    """
    names = ("x", "u", "p")
    loads: dict[str, Callable[[int], str]] = {name: _numbered(name) for name in names} | {"t": lambda _: "t"}
    body = inlined(compiling.module_text(kernels), "dynamics", loads, "a_")
    results = [f"result_{i} = {result}" for i, result in enumerate(body.results)]
    statements, spec = ast.parse("\n".join([*body.lines, *results])).body, kernels.spec
    n = len(spec.states)

    def written(choice: Choice) -> Step:
        return _written(spec, statements, choice)

    idle = written(Choice((0,) * n))
    velocities = {slope.state for slope in idle.slopes[0] if slope.row is None and slope.rate.factor}
    scaled = tuple(int(i in velocities) for i in range(n))
    begun = [Choice(powers, late=late) for powers in dict.fromkeys([(0,) * n, scaled]) for late in (True, False)]
    if idle.operations <= MOST_OPERATIONS:
        begun = [_improved(written, choice, min(idle.quotients, MOST_TRIED)) for choice in begun]
    return min(map(written, begun), key=lambda step: step.operations)


def _improved(written: Callable[[Choice], Step], choice: Choice, quotients: int) -> Choice:
    """Return a better choice that differs in one place, repeatedly, as long as there is one."""
    best = replace(choice, scales=(1.0,) * quotients)
    fewest, powers = written(best).operations, range(len(choice.powers))
    for scale, k in [(scale, k) for k in range(quotients) for scale in SCALES] + [(None, i) for i in powers]:
        if scale is None:
            other = replace(best, powers=_with(best.powers, k, 1 - best.powers[k]))
        else:
            other = replace(best, scales=_with(best.scales, k, scale))
        if (count := written(other).operations) < fewest:
            best, fewest = other, count
    return best


def _with(values: tuple[T, ...], place: int, value: T) -> tuple[T, ...]:
    """Return values with one of them replaced."""
    return (*values[:place], value, *values[place + 1 :])


def _numbered(name: str) -> Callable[[int], str]:
    return lambda k: f"{name}_{k}"


def _written(spec: ProblemSpec, statements: Sequence[ast.stmt], choice: Choice) -> Step:
    """Return a step in the chosen form."""
    tape, powers = Tape(), choice.powers
    arithmetic = Arithmetic(tape, choice.scales, choice.late)
    counts = {"u": len(spec.controls), "p": len(spec.parameters)}
    given = {f"{name}_{k}" for name, count in counts.items() for k in range(count)}
    names = {name: Factored(tape.given(name, False)) for name in sorted(given)}
    start = [Factored(tape.given(f"x_{i}", True), 1.0, -power) for i, power in enumerate(powers)]
    point, moved, found = start, list[int | None](), list[tuple[Slope, ...]]()
    for stage, (time, by) in enumerate(STAGES):
        if found:
            pairs = list(zip(start, found[-1], strict=True))
            point = [arithmetic.sum(x, slope.rate.times(by, 1)) for x, slope in pairs]
        if stage == len(STAGES) - 1:
            moved = [_in_place(tape, x, slope.rate.times(by, 1)) for x, slope in pairs]
            point = [
                one if value is None else replace(one, value=value) for one, value in zip(point, moved, strict=True)
            ]
        own = names | {"t": Factored(tape.given(time, True))} | {f"x_{i}": value for i, value in enumerate(point)}
        known = arithmetic.lines(statements, own)
        rates = [known[f"result_{i}"] for i in range(len(powers))]
        found.append(tuple(_slope(arithmetic, rate, point, i) for i, rate in enumerate(rates)))
    return Step(tape, powers, tuple(found), tuple(moved), arithmetic.quotients)


def _in_place(tape: Tape, x: Factored, rate: Factored) -> int | None:
    """Return a state moved in place by the previous slope; ``None`` where the slope must be scaled first."""
    suited = rate.value in tape.changing and rate.fixed is None and rate.power == x.power
    if not suited or x.value is None or rate.value is None:
        return None
    return tape.apply(Moved(rate.factor / x.factor), x.value, rate.value)


def _slope(arithmetic: Arithmetic, rate: Factored, point: Sequence[Factored], state: int) -> Slope:
    """Return the rate of a state at a point."""
    tape, values = arithmetic.tape, [one.value for one in point]
    if not rate.factor:
        return Slope(rate, 0)
    if rate.value in values and rate.fixed is None:
        return Slope(rate, values.index(rate.value))
    if rate.fixed is not None:
        return Slope(arithmetic.like(rate, point[state].times(1.0, -1)), None)
    if rate.value is None or not isinstance(tape.made[rate.value], Operation):  # a number, or what was given
        value = tape.constant(1.0) if rate.value is None else rate.value
        rate = replace(rate, value=tape.apply(np.positive, value))
    return Slope(rate, None)


@dataclass(frozen=True, eq=False)
class Group:
    """Sums of the same shape: states that depend on each other, and the slopes in these sums."""

    states: tuple[tuple[int, ...], ...]
    rows: tuple[tuple[int, ...], ...]
    """States of each weighted sum, and the rows of the step's slopes that the sum depends on."""
    weights: Array
    """Weights of states and rows in the sums, shape (sums, states, states + rows)."""
    now: Array
    after: Array
    """Two alternating buffers of states and rows, before and after a step, shape (sums, states + rows, columns)."""


class OnTape:
    """RK4 under constant controls: ``advance(t, h, steps, y, u, p)`` moves every column of y, in place.

    Raises
    ------
    Unsuited
        If the dynamics are no straight line of operations.
    """

    def __init__(self, kernels: Kernels) -> None:
        self.step = fewest(kernels)
        needed = {self.step.tape.made[value] for value in self.step.tape.needed(self.step.rows)}
        counts = (("u", len(kernels.spec.controls)), ("p", len(kernels.spec.parameters)))
        self._given = [(name, k) for name, count in counts for k in range(count) if f"{name}_{k}" in needed]
        self._sums = _sums(self.step)
        self._times = [name for name in dict.fromkeys(name for name, _ in STAGES) if name in needed]
        self._ends = lru_cache(maxsize=8)(self.step.ends)
        self._kept: dict[int, Arranged] = {}

    def advance(self, t: float, h: float, steps: int, y: Array, u: Array, p: Array) -> None:
        """Take steps of size h from t, in place."""
        if not h:
            return
        columns, unit = y.shape[1], 0.5 * h
        # taken away while it is in use: another thread makes its own
        arranged = self._kept.pop(columns, None) or self.arranged(columns)
        for name, k in self._given:
            arranged.given[f"{name}_{k}"][...] = (u if name == "u" else p)[k]
        scales = unit ** np.array(self.step.powers, dtype=float)
        arranged.begin(self._ends(unit), unit)
        for row, value, scale in zip(arranged.states(0), y, scales, strict=True):
            np.multiply(value, scale, out=row)
        ahead = {"now": 0.0, "middle": unit, "end": h}
        for i in range(steps):
            for name in self._times:
                arranged.given[name][()] = t + i * h + ahead[name]
            arranged.turns[i % 2].run()
        for row, value, scale in zip(arranged.states(steps), y, scales, strict=True):
            np.divide(row, scale, out=value)
        self._kept = {columns: arranged}

    @property
    def block(self) -> int:
        """Return how many columns are best taken at a time."""
        rows, found = 2 * (len(self.step.powers) + len(self.step.rows)), BLOCK
        while found > SMALLEST_BLOCK and 8 * found * rows > CACHE:
            found //= 2
        return found

    def arranged(self, columns: int) -> Arranged:
        """Return arrays for a number of columns, reused for later motions, with the tape bound to them."""
        given = {f"{name}_{k}": aligned(columns) for name, k in self._given}
        given |= {name: np.empty(()) for name in (*self._times, UNIT, INVERSE)}
        groups = [_group(shape, sums, columns) for shape, sums in self._sums.items()]
        buffers, values, turns = Buffers(columns), self.step.rows, []
        for k in range(2):
            own = dict(given)
            results: dict[int, Array] = {}
            for group in groups:
                table, after = (group.now, group.after)[:: 1 - 2 * k]
                count = group.weights.shape[1]
                for states, rows, part in zip(group.states, group.rows, table, strict=True):
                    own |= {f"x_{i}": part[place] for place, i in enumerate(states)}
                    results |= {values[row]: part[count + place] for place, row in enumerate(rows)}
            made = bound(self.step.tape, own, results, buffers)
            for group in groups:
                table, after = (group.now, group.after)[:: 1 - 2 * k]
                made.each.append((np.matmul, (group.weights, table, after[:, : group.weights.shape[1]])))
            turns.append(made)
        return Arranged(given, groups, tuple(turns))


@dataclass(frozen=True, eq=False)
class Arranged:
    """The arrays of a step: given values by name, groups of sums, and alternating calls of steps."""

    given: dict[str, Array]
    groups: list[Group]
    turns: tuple[Bound, ...]

    def begin(self, ends: Array, unit: float) -> None:
        """Prepare the arrays for the first of some steps."""
        self.given[UNIT][()], self.given[INVERSE][()] = unit, 1.0 / unit
        for group in self.groups:
            for weights, states, rows in zip(group.weights, group.states, group.rows, strict=True):
                weights[...] = ends[np.ix_(states, [*states, *(len(ends) + row for row in rows)])]
        for turn in self.turns:
            turn.begin()

    def states(self, steps: int) -> list[Array]:
        """Return the rows of the states after some steps, in the model's order."""
        found = dict[int, Array]()
        for group in self.groups:
            for states, part in zip(group.states, (group.now, group.after)[steps % 2], strict=True):
                found |= dict(zip(states, part, strict=False))
        return [found[i] for i in range(len(found))]


Sums = dict[tuple[int, int], list[tuple[tuple[int, ...], tuple[int, ...]]]]
"""(Number of dependent states, number of rows) -> the states and the rows of each sum of this size."""


def _sums(step: Step) -> Sums:
    """Collect the sums that a step consists of."""
    ends = step.ends(0.7) != 0.0
    n, left = len(ends), set(range(len(ends)))
    found: Sums = {}
    while left:
        states = {min(left)}
        while True:
            used = ends[sorted(states)].any(axis=0)
            more = states | {i for i in range(n) if used[i] or (ends[i] & used).any()}
            if more == states:
                break
            states = more
        rows = tuple(np.flatnonzero(used[n:]).tolist())
        found.setdefault((len(states), len(rows)), []).append((tuple(sorted(states)), rows))
        left -= states
    return found


def _group(shape: tuple[int, int], sums: list[tuple[tuple[int, ...], tuple[int, ...]]], columns: int) -> Group:
    (states, rows), count = shape, len(sums)
    tables = [aligned(count, states + rows, columns) for _ in range(2)]
    for table in tables:
        table[...] = 0.0
    weights = np.zeros((count, states, states + rows))
    return Group(tuple(one for one, _ in sums), tuple(one for _, one in sums), weights, *tables)
