"""Rows of a study's table: how each row ended, and its numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance.unknowns import Place
from satsym.solution import Simulation, Solution
from satsym.status import BadInput, Status

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.spec import ProblemSpec

Scalar = float | str | None


class Column(str, Enum):
    """Names of table columns that other modules refer to."""

    ROW = "row"
    KEY = "key"
    STATUS = "status"
    MESSAGE = "message"
    OBJECTIVE = "objective"
    T_FINAL = "t_final"
    T_INITIAL = "t_initial"
    VERDICT = "verdict"
    METHOD = "method"
    ORIGIN = "origin"
    BRANCH = "branch"
    COST_LOWER = "cost_interval.lower"
    COST_UPPER = "cost_interval.upper"
    COST_FROM_INITIAL = "cost_from_initial"


TEXTS = (Column.KEY, Column.STATUS, Column.MESSAGE, Column.VERDICT, Column.METHOD, Column.ORIGIN)
"""Columns that contain texts; all others contain numbers."""


class Failure(str, Enum):
    """Ways in which a row may end besides the statuses of solvers."""

    BAD_INPUT = "bad input"
    UNFORESEEN = "unforeseen"
    WORKER_DIED = "worker died"


PASSING = (Failure.WORKER_DIED.value, Status.TIME_LIMIT.value)
"""Statuses that do not depend on the row itself, so that the row may be solved in another run."""


@dataclass(frozen=True, eq=False)
class Row:
    """A row of a study's table.

    Attributes
    ----------
    key
        Digest of everything that the result depends on, see :func:`satsym.studies.asked.keys_of`.
    status, message
        The status of the solver, or of :class:`Failure`, and its explanation.
    numbers
        Entries by the name of the column; ``None`` for missing ones.
    trajectory
        Arrays by name; empty without a trajectory, or where trajectories are not kept.
    """

    key: str
    status: str
    message: str
    numbers: Mapping[str, Scalar] = field(default_factory=dict)
    trajectory: Mapping[str, Array] = field(default_factory=dict)

    @property
    def answered(self) -> bool:
        """Tell whether the row has an answer."""
        return self.status == Status.CONVERGED.value


Cases: TypeAlias = "Sequence[tuple[str, Instance]]"
"""The keys and the instances of some rows."""

Work: TypeAlias = Callable[[Cases], list[Row]]
"""Function from rows of a chunk, in the order of computation, to their entries in the table."""


def one_by_one(single: Callable[[str, Instance], Row]) -> Work:
    """Return the function that computes independent rows one by one."""
    return lambda cases: [tried(single, key, instance) for key, instance in cases]


def tried(single: Callable[[str, Instance], Row], key: str, instance: Instance) -> Row:
    """Compute a row, and turn any failure into a failed row, so that other rows are not affected."""
    try:
        return single(key, instance)
    except BadInput as error:
        return failed(key, Failure.BAD_INPUT, str(error))
    except Exception as error:
        return failed(key, Failure.UNFORESEEN, f"{type(error).__name__}: {error}")


def failed(key: str, failure: Failure, message: str) -> Row:
    """Return a row without an answer."""
    return Row(key, failure.value, " ".join(message.split()))


def of_solution(key: str, solution: Solution, origin: str, kept: bool) -> Row:
    """Make the row of an optimum, or of an instance that has none."""
    spec = solution.instance.model.spec
    numbers: dict[str, Scalar] = {}
    if solution.status.answered:
        verdict = solution.certificate.verdict.value if solution.certificate else None
        numbers = {
            Column.OBJECTIVE: _plain(spec.objective(solution.objective)),
            Column.T_FINAL: _plain(solution.times[-1]),
            Column.VERDICT: verdict,
            **_each("x_final", spec.state_names, solution.x, -1),
            **_each("costate_initial", spec.state_names, solution.lam, 0),
            **dict(_found(solution.instance)),
            "switching_times": float(len({t for times in solution.switching_times for t in times})),
            **dict(_interval(solution)),
            "events": float(len(solution.events)),
            Column.METHOD: solution.method,
            Column.ORIGIN: origin,
        }
    message = "" if solution.status.answered else solution.status.explain(solution.message)
    trajectory = _kept(solution, solution.lam) if kept and solution.status.answered else {}
    return Row(key, solution.status.value, message, numbers, trajectory)


@dataclass(frozen=True, eq=False)
class Found:
    """The results of M rows that were computed together."""

    minimum: NDArray[np.bool_]
    """Whether each row has the required minimum, shape (M,); the other rows are left to the single solver."""
    method: str
    origins: Sequence[str]
    costs: Array
    """Costs of the optima, as they are minimised, shape (M,)."""
    t_final: Array
    x_final: Array
    costates: Array
    """Final states and initial costates, shapes (n, M)."""
    switches: Array
    """Number of switches of the controls, shape (M,)."""
    unreachable: Mapping[int, str] = field(default_factory=dict)
    """Row -> reason why it has no solution, for rows whose final state cannot be reached."""


def of_extremal(key: str, spec: ProblemSpec, found: Found, k: int, verdict: str | None) -> Row:
    """Make the row of the k-th of many optima that were solved together."""
    names = spec.state_names
    numbers: dict[str, Scalar] = {
        Column.OBJECTIVE: _plain(spec.objective(found.costs[k])),
        Column.T_FINAL: _plain(found.t_final[k]),
        Column.VERDICT: verdict,
        **_each("x_final", names, found.x_final, k),
        **_each("costate_initial", names, found.costates, k),
        "switching_times": float(found.switches[k]),
        "events": 0.0,
        Column.METHOD: found.method,
        Column.ORIGIN: found.origins[k],
    }
    return Row(key, Status.CONVERGED.value, "", numbers)


def infeasible(key: str, message: str) -> Row:
    """Make the row of an end that cannot be reached."""
    return Row(key, Status.INFEASIBLE.value, Status.INFEASIBLE.explain(message))


def of_simulation(key: str, simulation: Simulation, kept: bool) -> Row:
    """Make the row of a simulated motion."""
    spec = simulation.instance.model.spec
    numbers: dict[str, Scalar] = {}
    if simulation.status.answered:
        numbers = {Column.T_FINAL: _plain(simulation.times[-1]), **_each("x_final", spec.state_names, simulation.x, -1)}
        numbers |= {f"metrics.{name}": _plain(value) for name, value in simulation.metrics.items()}
        numbers |= {f"drift.{name}": _plain(each.drift) for name, each in simulation.invariants.items()}
    message = "" if simulation.status.answered else simulation.message
    trajectory = _kept(simulation, None) if kept and simulation.status.answered else {}
    return Row(key, simulation.status.value, message, numbers, trajectory)


def of_regulator(
    key: str,
    names: tuple[Sequence[str], Sequence[str]],
    K: Array,
    eigenvalues: NDArray[np.complexfloating],
    residual: float,
    cost: float | None,
) -> Row:
    """Make the row of a linear feedback, with the names of its inputs and of the states."""
    numbers: dict[str, Scalar] = {Column.COST_FROM_INITIAL: None if cost is None else _plain(cost)}
    for name, row in zip(names[0], K.tolist(), strict=True):
        numbers |= {f"K.{name}.{state}": _plain(k) for state, k in zip(names[1], row, strict=True)}
    for i, value in enumerate(eigenvalues.tolist(), 1):
        numbers |= {f"eigenvalue_{i}.re": _plain(value.real), f"eigenvalue_{i}.im": _plain(value.imag)}
    numbers["riccati_residual"] = _plain(residual)
    return Row(key, Status.CONVERGED.value, "", numbers)


def _kept(found: Solution | Simulation, lam: Array | None) -> dict[str, Array]:
    arrays = {"t": found.times, "x": found.x, "u": found.u}
    return arrays if lam is None else arrays | {"lam": lam}


def _found(instance: Instance) -> Iterator[tuple[str, Scalar]]:
    """Return the values found for the numbers that the instance left free, except those at the end."""
    for unknown in instance.free:
        name = Column.T_INITIAL.value if unknown.place is Place.TIME else f"found.{unknown.name}"
        yield name, _plain(unknown.of(instance))


def _interval(solution: Solution) -> Iterator[tuple[str, Scalar]]:
    """Return the interval of the best objective, in the author's sense, where only that is known."""
    if solution.interval is not None:
        spec, ends = solution.instance.model.spec, (solution.interval.lower, solution.interval.upper)
        yield from zip((Column.COST_LOWER, Column.COST_UPPER), sorted(map(spec.objective, ends)), strict=True)


def _each(name: str, states: tuple[str, ...], rows: Array, place: int) -> dict[str, Scalar]:
    return {f"{name}.{state}": _plain(row[place]) for state, row in zip(states, rows, strict=True)}


def _plain(value: float) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None
