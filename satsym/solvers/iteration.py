"""Iteration of solvers (initialise, step, terminate), with history, progress and limits."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Generic, Protocol, TypeVar

import msgspec
import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Iteration, Progress, Simulation, Solution
from satsym.status import Status
from satsym.wording import counted

State = TypeVar("State")

MOST_ITERATIONS = 500
"""Maximum number of iterations if an instance sets none."""


class Method(Protocol[State]):
    """An iterative solver as three pure functions of its state."""

    def init(self) -> State:
        """Return the initial state of the iteration."""

    def step(self, state: State) -> State:
        """Return the state after one iteration."""

    def terminate(self, state: State) -> tuple[Status, str] | None:
        """Return why to stop, or ``None`` to continue."""

    def measure(self, state: State, number: int) -> Iteration:
        """Return the history entry of a state."""


@dataclass
class Meter:
    """Amount of work done, as the number of points (of a mesh or an integration) at which a motion was linearised."""

    spent: int = 0


class TimeUp(Exception):
    """Raised if the time limit is reached in a computation that does not iterate, such as a long trajectory."""


class _Helpers(threading.local):
    """Processor time, in seconds, of library threads that worked for the present thread."""

    seconds = 0.0


_HELPERS = _Helpers()


def computed() -> float:
    """Return the processor time, in seconds, of this thread and of library threads that worked for it.

    It is not the time of day, so that other work of the machine changes no answer.
    """
    return time.thread_time() + _HELPERS.seconds


def count_helpers(seconds: float) -> None:
    """Add the processor time that threads of a library have used for this thread."""
    _HELPERS.seconds += max(seconds, 0.0)


def deadline_of(instance: Instance) -> float:
    """Return the deadline of an instance that is begun now, on the clock of :func:`computed`."""
    return computed() + instance.solver.max_seconds


BLOCK = 10_000
"""Number of grid steps between two checks of the time limit."""


@dataclass(frozen=True)
class Limits:
    """Limits of a computation, and its observer.

    Verdicts depend on limits of work, which are the same on every machine; the time limit serves the user.
    """

    iterations: int
    """Maximum number of iterations of the method."""
    deadline: float
    """Deadline on the clock of :func:`computed`."""
    watch: Callable[[float, float], None] | None = None
    """Function that is told cost and residual after inner steps, for a solver whose phases take long."""
    work: float = float("inf")
    """Maximum number of points at which equations may be linearised, see :class:`Meter`."""
    meter: Meter = field(default_factory=Meter)
    """Meter of the work done, shared by all limits that are derived from these."""

    def tell(self, cost: float, residual: float) -> None:
        """Tell the observer, if there is one."""
        if self.watch:
            self.watch(cost, residual)

    def spend(self, columns: int) -> None:
        """Add to the work done."""
        self.meter.spent += columns

    @property
    def late(self) -> bool:
        """Return whether the time limit is reached."""
        return computed() > self.deadline

    def check(self) -> None:
        """Raise :class:`TimeUp` if the limits are reached."""
        if self.expired:
            raise TimeUp

    def in_blocks(self, function: Callable[[NDArray[Any]], Array], places: NDArray[Any]) -> Array:
        """Return the values of a function at many points, shape (rows, M), checking the limits between blocks.

        Raises
        ------
        TimeUp
            If the limits are reached and more than a block is left; a single block is always computed.
        """
        found = []
        for first in range(0, len(places), BLOCK):
            if first:
                self.check()
            found.append(function(places[first : first + BLOCK]))
        return np.concatenate(found, axis=-1)

    @property
    def expired(self) -> bool:
        """Return whether the limit of time or of work is reached."""
        return self.meter.spent > self.work or self.late


def hurried(instance: Instance, deadline: float) -> Instance | None:
    """Return an instance limited to the time left until a deadline; ``None`` if none is left."""
    left = deadline - computed()
    if left <= 0.0:
        return None
    return replace(instance, solver=msgspec.structs.replace(instance.solver, max_seconds=left))


def watched(instance: Instance, progress: Progress | None) -> tuple[Limits, list[Iteration]]:
    """Return the limits of an instance, counted from now, and the history to which reports are appended."""
    history: list[Iteration] = []

    def watch(objective: float, residual: float) -> None:
        history.append(Iteration(len(history), objective, residual))
        if progress:
            progress(history[-1])

    return Limits(
        instance.solver.max_iterations or MOST_ITERATIONS, deadline_of(instance), watch, instance.work
    ), history


def history_of(passed: Sequence[tuple[float, float]]) -> tuple[Iteration, ...]:
    """Return a history from pairs of cost and residual."""
    return tuple(Iteration(number, *one) for number, one in enumerate(passed))


@dataclass(frozen=True)
class Run(Generic[State]):
    """Result of an iteration."""

    state: State
    status: Status
    message: str
    history: tuple[Iteration, ...]


def iterate(method: Method[State], limits: Limits, progress: Progress | None) -> Run[State]:
    """Iterate until the method terminates or a limit is reached."""
    state = method.init()
    history = [method.measure(state, 0)]
    while True:
        if progress:
            progress(history[-1])
        if verdict := method.terminate(state):
            return Run(state, *verdict, tuple(history))
        if len(history) > limits.iterations:
            message = f"no convergence in {counted(limits.iterations, 'iteration')}"
            return Run(state, Status.NOT_CONVERGED, message, tuple(history))
        if limits.expired:
            message = f"time limit reached after {counted(len(history) - 1, 'iteration')}"
            return Run(state, Status.TIME_LIMIT, message, tuple(history))
        try:
            state = method.step(state)
        except TimeUp:
            continue  # with the last state that is whole; the clock is looked at there
        history.append(method.measure(state, len(history)))


MESSAGE = "time limit reached while {steps} steps were computed"


def unsolved(instance: Instance, method: str, wall_s: float) -> Solution:
    """Return a solution without an answer and without a trajectory."""
    n, m = len(instance.initial), len(instance.lower)
    return Solution(
        instance=instance,
        method=method,
        status=Status.TIME_LIMIT,
        message=MESSAGE.format(steps=instance.solver.steps),
        objective=float("nan"),
        times=np.array([instance.t0, float("nan") if instance.tf is None else instance.tf]),
        x=np.full((n, 2), np.nan),
        u=np.full((m, 2), np.nan),
        lam=np.full((n, 2), np.nan),
        switching_times=((),) * m,
        iterations=0,
        history=(),
        wall_s=wall_s,
    )


def unsimulated(instance: Instance, feedback: str) -> Simulation:
    """Return a simulation without a motion."""
    return Simulation(
        instance=instance,
        feedback=feedback,
        status=Status.TIME_LIMIT,
        message=Status.TIME_LIMIT.explain(MESSAGE.format(steps=instance.solver.steps)),
        times=np.array([instance.t0, instance.t0 + 1.0 if instance.tf is None else instance.tf]),
        x=np.full((len(instance.initial), 2), np.nan),
        u=np.full((len(instance.lower), 2), np.nan),
        invariants={},
        metrics={},
    )
