"""Branches: rows of a grid whose answers belong to one family of extremals, and rows with a cheaper answer beside them.

A problem with several minima has several families of extremals. Rows are solved in chunks that know nothing of each
other, so one may have the answer of a family that is not the cheapest there, and its neighbour that of another. Where
costs or costates jump from one row to the next, each of the two is solved once more from the other's answer: either it
finds its own answer again, and the jump is only apparent, or another one, which replaces it where it is a minimum and
costs less. A row that has changed may jump against its other neighbours, so this is repeated in rounds. A round depends
on the result of the one before alone, and not on the order of its comparisons. Rows that all follow one family jump
nowhere. So three of them are solved beforehand from cold starts and with competitors, and a cheaper answer there is
passed on to neighbours in the same way.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from satsym import solvers
from satsym.arrays import Array
from satsym.choices import Checked, Command
from satsym.instance import Guess, Instance
from satsym.instance import numbers as keys
from satsym.solution import Solution
from satsym.solvers.failures import FAILURES, tried
from satsym.solvers.simulation.extrapolation import integrate
from satsym.status import Verdict
from satsym.studies import chunks, rows
from satsym.studies.asked import Study, Task
from satsym.studies.reading import Grid
from satsym.studies.rows import Column, Row
from satsym.studies.solving import SINGLE_ORIGIN, certified, drawn_for_competitors
from satsym.studies.together import CLOSED, plain

FEWEST_ROWS_OF_JUMP, MOST_ROWS = 4, 100_000
"""Smallest number of rows on a line for which jumps are recognised, and largest number of rows that are examined."""

JUMP, ROUNDING = 4.0, 1e-6
"""Ratio of a change to nearby changes above which it is a jump, and smallest relevant change.

The latter is a fraction of the largest value.
"""

RELATIVE_GAP = 1e-6
"""Relative difference up to which costs and costates are taken to belong to the same extremal."""

SAMPLES, ACCURACY = 61, 1e-8
"""Number of nodes, and largest error, of a neighbour's trajectory that serves as initial guess."""

ORIGIN = "neighbour's branch"
"""The recorded origin of solutions found from that of a neighbouring row, because their cost is lower."""


@dataclass(frozen=True, eq=False)
class Known:
    """The part of a row's answer that is needed to start from it."""

    number: int
    values: tuple[float, ...]
    """Values of the varied numbers."""
    key: str
    cost: float
    """Cost of the solution, as it is minimised."""
    costates: tuple[float, ...]
    """Initial costates of the solution."""
    t_final: float


@dataclass(frozen=True, eq=False)
class Pair:
    """Two neighbouring rows between which costs or costates jump."""

    first: Known
    second: Known


@dataclass(frozen=True, eq=False)
class Scout:
    """A row that is solved again from a cold start."""

    own: Known


@dataclass(frozen=True, eq=False)
class Compared:
    """The result of comparing two neighbours."""

    one: bool
    """Whether both rows belong to one branch of extremals."""
    first: Row | None
    second: Row | None
    """Solutions of lower cost of both rows, each found from the other row's solution; ``None`` if there is none."""


def looked_for(study: Study) -> bool:
    """Tell whether branches are searched: in smooth problems on a grid with enough rows."""
    grid = (
        isinstance(study.design, Grid)
        and max(study.design.shape) >= FEWEST_ROWS_OF_JUMP
        and study.design.count <= MOST_ROWS
    )
    return grid and study.command is Command.SOLVE and plain(study.task)


@dataclass(eq=False)
class Branches:
    """The rows of a study with their answers so far, and which neighbours are of different branches.

    Attributes
    ----------
    closed
        Numbers of rows with an answer in closed form.
    changed
        Rows that have a neighbour's answer instead of their own, by their numbers.
    """

    study: Study
    known: dict[int, Known]
    closed: set[int]
    changed: dict[int, Row] = field(default_factory=dict)
    _compared: dict[tuple[int, int], tuple[Known, Known, bool]] = field(default_factory=dict)

    @classmethod
    def of(cls, study: Study, found: Iterator[tuple[int, list[float], Row]]) -> Branches:
        """Collect the branches of a study from its computed rows: number, values, and result."""
        known, closed = dict[int, Known](), set[int]()
        for number, values, row in found:
            if one := _known(study, number, values, row):
                known[number] = one
                closed |= {number} if row.numbers.get(Column.ORIGIN) == CLOSED else set()
        return cls(study, known, closed)

    def pairs(self) -> list[Pair]:
        """Return the neighbours between which something jumps and that are still to be compared, in order."""
        found = []
        for before, after in self._jumps():
            pair = Pair(self.known[before], self.known[after])
            done = self._compared.get((before, after))
            if done is None or done[0] is not pair.first or done[1] is not pair.second:
                found.append(pair)
        return found

    def scouts(self) -> list[Scout]:
        """Return the first, the middle and the last answered row, from which other minima are sought.

        Rows answered in closed form are left out, because they have a single minimum.
        """
        numbers = [number for number in self.known if number not in self.closed]
        places = sorted({0, len(numbers) // 2, len(numbers) - 1}) if numbers else []
        return [Scout(self.known[numbers[place]]) for place in places]

    def enter(self, pairs: Sequence[Pair], results: Sequence[Compared]) -> None:
        """Enter the results of comparisons."""
        for pair, result in zip(pairs, results, strict=True):
            self._compared[pair.first.number, pair.second.number] = pair.first, pair.second, result.one
        both = [
            ((pair.first, result.first), (pair.second, result.second))
            for pair, result in zip(pairs, results, strict=True)
        ]
        self.take([each for two in both for each in two])

    def take(self, answers: Sequence[tuple[Known, Row | None]]) -> None:
        """Keep the cheapest of several other answers of a row, of equally cheap ones the first."""
        better: dict[int, tuple[Known, Row]] = {}
        for own, row in answers:
            new = None if row is None else _known(self.study, own.number, list(own.values), row)
            if new is not None and row is not None and new.cost < better.get(own.number, (own,))[0].cost:
                better[own.number] = new, row
        for number, (new, row) in sorted(better.items()):
            self.known[number], self.changed[number] = new, row

    @property
    def borders(self) -> int:
        """Count the pairs of neighbours of different branches."""
        return len(list(self._jumps()))

    @cached_property
    def labels(self) -> dict[int, int]:
        """Return the branch of each answered row, numbered from 1 by first rows; only valid after all comparisons."""
        above = {number: number for number in self.known}

        def top(number: int) -> int:
            while above[number] != number:
                above[number] = above[above[number]]
                number = above[number]
            return number

        apart = set(self._jumps())
        for before, after in self._neighbours():
            if (before, after) not in apart:
                one, other = sorted((top(before), top(after)))
                above[other] = one
        tops = {place: number for number, place in enumerate(sorted({top(number) for number in above}), 1)}
        return {number: tops[top(number)] for number in sorted(above)}

    def _jumps(self) -> Iterator[tuple[int, int]]:
        """Return the neighbours between which something jumps, except those found to be of one branch."""
        for line in self._lines():
            seen = np.array([(self.known[k].cost, *self.known[k].costates) for k in line])
            for place in np.flatnonzero(jumping(np.array(self._places(line)), seen)).tolist():
                before, after = line[place : place + 2]
                done = self._compared.get((before, after))
                as_now = done is not None and done[0] is self.known[before] and done[1] is self.known[after]
                if not (done is not None and as_now and done[2]):
                    yield before, after

    def _neighbours(self) -> Iterator[tuple[int, int]]:
        for line in self._lines():
            yield from pairwise(line)

    def _lines(self) -> Iterator[list[int]]:
        """Return the numbers of answered rows on each line of the grid, axis by axis."""
        assert isinstance(self.study.design, Grid)
        numbers = np.arange(self.study.design.count).reshape(self.study.design.shape)
        for axis in range(numbers.ndim):
            for line in np.moveaxis(numbers, axis, -1).reshape(-1, numbers.shape[axis]).tolist():
                yield [number for number in line if number in self.known]

    def _places(self, line: Sequence[int]) -> list[float]:
        """Return the places of rows on their line, in steps."""
        assert isinstance(self.study.design, Grid)
        places = np.array(np.unravel_index(np.array(line, dtype=int), self.study.design.shape))
        return [float(step) for step in np.abs(places - places[:, :1]).sum(axis=0)] if line else []


def jumping(places: Array, values: Array) -> NDArray[np.bool_]:
    """Tell between which rows of a line a quantity changes far more than nearby, shape (rows - 1,).

    Parameters
    ----------
    places
        Places of the rows on their line, shape (rows,).
    values
        Shape (rows, quantities).
    """
    if len(places) < FEWEST_ROWS_OF_JUMP:
        return np.zeros(max(len(places) - 1, 0), dtype=bool)
    slopes = np.abs(np.diff(values, axis=0)) / np.diff(places)[:, None]
    apart = np.full((2, slopes.shape[1]), np.nan)
    around = np.concatenate([apart, slopes, apart])
    count = len(slopes)
    beside = np.stack([around[k : k + count] for k in (0, 1, 3, 4)])
    usual = np.nanmedian(beside, axis=0)
    return np.asarray((slopes > JUMP * usual + ROUNDING * np.abs(values).max(axis=0)).any(axis=1))


What = TypeVar("What")
Result = TypeVar("Result")
NOTHING = Compared(False, None, None)


@dataclass(frozen=True, eq=False)
class Some(Generic[What]):
    """Some comparisons for one worker, in the form of a chunk."""

    number: int
    of: tuple[What, ...]


AT_A_TIME = 4
"""Number of comparisons that a worker receives at a time."""


def followed(study: Study, found: Iterator[tuple[int, list[float], Row]], executor: Executor) -> Branches:
    """Compare rows with their neighbours as often as something jumps, at most once a row on average.

    A comparison whose worker dies has no result, and changes nothing.

    Parameters
    ----------
    found
        Computed rows: number, values and result of each.
    executor
        Executor that computes comparisons.
    """
    known, packed = Branches.of(study, found), chunks.pack(study)
    scouts = known.scouts()
    ahead = [executor.submit(scouted, packed, Some(k, (one,))) for k, one in enumerate(scouts)]
    known.take([(one.own, _result(future) or None) for one, future in zip(scouts, ahead, strict=True)])
    left = study.design.count
    while pairs := known.pairs()[:left]:
        left -= len(pairs)
        groups = [Some(k, tuple(pairs[k : k + AT_A_TIME])) for k in range(0, len(pairs), AT_A_TIME)]
        futures = [executor.submit(all_compared, packed, group) for group in groups]
        results = [_result(f) or [NOTHING] * len(g.of) for f, g in zip(futures, groups, strict=True)]
        known.enter(pairs, [one for group in results for one in group])
    return known


def all_compared(packed: bytes, group: Some[Pair]) -> list[Compared]:
    """Compare some pairs; called in a worker."""
    task = chunks.unpacked(packed)
    return [compared(task, pair) for pair in group.of]


def scouted(packed: bytes, group: Some[Scout]) -> Row | None:
    """Solve a row from a cold start; called in a worker.

    The answer counts if it is a minimum and costs less.
    """
    task, own = chunks.unpacked(packed), group.of[0].own
    found = tried(partial(solvers.solve, keys.at(task.instance, task.keys, own.values)))
    if found is None or not found.status.answered or not own.cost - found.objective > RELATIVE_GAP * abs(own.cost):
        return None
    return _row(task, own, found.instance, found, SINGLE_ORIGIN)


def _result(future: Future[Result]) -> Result | None:
    try:
        return future.result()
    except BrokenExecutor:
        return None


def compared(task: Task, pair: Pair) -> Compared:
    """Solve both rows of a pair from each other's answers, the second only if the first changes."""
    first, second = (keys.at(task.instance, task.keys, one.values) for one in (pair.first, pair.second))
    found = _again(task, pair.first, first, pair.second, second)
    if isinstance(found, bool) and found:
        return Compared(True, None, None)
    other = _again(task, pair.second, second, pair.first, first)
    one = isinstance(other, bool) and other
    return Compared(one, *(row if isinstance(row, Row) else None for row in (found, other)))


def _again(task: Task, own: Known, instance: Instance, other: Known, theirs: Instance) -> Row | bool:
    """Solve a row from its neighbour's answer; return a cheaper minimum, or whether its own answer was found."""
    try:
        start = _guess(theirs, other)
    except FAILURES:
        return False
    given = replace(instance, guess=start, tf_guess=other.t_final - instance.t0 if instance.tf is None else None)
    full = drawn_for_competitors(task.checked, own.key)
    found = tried(partial(_solved, given, full))
    if found is None or not found.status.answered:
        return False
    apart = found.objective - own.cost
    if abs(apart) <= RELATIVE_GAP * abs(own.cost):
        return bool(
            np.allclose(
                found.lam[:, 0],
                own.costates,
                rtol=RELATIVE_GAP,
                atol=RELATIVE_GAP * np.abs(found.lam[:, 0]).max(),
            )
        )
    return False if apart > 0.0 else _row(task, own, instance, found, ORIGIN) or False


def _row(task: Task, own: Known, instance: Instance, found: Solution, origin: str) -> Row | None:
    """Return a row with a solution that is a minimum; ``None`` for another solution."""
    if found.certificate is None or found.certificate.verdict not in (Verdict.LOCAL_MINIMUM, Verdict.CERTIFIED):
        return None
    certificate = None if task.checked is Checked.NONE else found.certificate
    solution = replace(found, instance=instance, certificate=certificate)
    return rows.of_solution(own.key, solution, origin, task.trajectories)


def _solved(instance: Instance, full: bool) -> Solution:
    return solvers.solve(instance) if full else certified(solvers.solve(instance, examined=False))


def _guess(instance: Instance, known: Known) -> Guess:
    """Return the motion of an answer, integrated from its initial costates."""
    model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
    n, names = len(instance.initial), model.spec.state_names

    def rates(t: float, z: Array) -> Array:
        values = z.tolist()
        return np.array(model.canonical(t, tuple(values[:n]), tuple(values[n:]), p, bounds))

    times = np.linspace(instance.t0, known.t_final, SAMPLES)
    start = np.array([*instance.initial, *known.costates])
    with np.errstate(all="ignore"):
        pieces = integrate(rates, times, start, ACCURACY, np.maximum(np.abs(start), 1e-3 * np.abs(start).max()))
    z = np.array([start, *(piece.end for piece in pieces)]).T.tolist()
    states, costates = (dict(zip(names, map(tuple, part), strict=True)) for part in (z[:n], z[n:]))
    return Guess(states, costates)


def _known(study: Study, number: int, values: list[float], row: Row) -> Known | None:
    """Return the part of a row's answer that others start from; ``None`` where it has no answer."""
    spec = study.instance.model.spec
    costates = [row.numbers.get(f"costate_initial.{name}") for name in spec.state_names]
    found = [row.numbers.get(Column.OBJECTIVE), row.numbers.get(Column.T_FINAL), *costates]
    if not row.answered or not all(isinstance(one, float) for one in found):
        return None
    objective, t_final, *known = (float(one) for one in found if isinstance(one, float))
    return Known(number, tuple(values), row.key, spec.objective(objective), tuple(known), t_final)
