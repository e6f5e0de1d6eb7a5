"""Init, step, terminate: how the iterative solvers run, with history, progress and limits."""

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
"""Iterations where an instance sets no limit."""


class Method(Protocol[State]):
    """An iterative solver as three pure functions of its state."""

    def init(self) -> State:
        """The starting point."""

    def step(self, state: State) -> State:
        """One iteration."""

    def terminate(self, state: State) -> tuple[Status, str] | None:
        """Why to stop, or ``None`` to go on."""

    def measure(self, state: State, number: int) -> Iteration:
        """The line of this state in the history."""


@dataclass
class Meter:
    """Work that was done, in columns (points of a mesh, steps of an integration) at which a motion was linearised."""

    spent: int = 0


class TimeUp(Exception):
    """The time is over in the midst of what does not iterate, such as a long trajectory."""


class _Helpers(threading.local):
    """Seconds of a processor that threads of libraries have had, which worked for the thread that asks."""

    seconds = 0.0


_HELPERS = _Helpers()


def computed() -> float:
    """Seconds of a processor that this thread has had, and threads of libraries for it.

    It is not the time of day: what else a machine does must change no answer.
    """
    return time.thread_time() + _HELPERS.seconds


def count_helpers(seconds: float) -> None:
    """Count what threads of a library have computed for this thread."""
    _HELPERS.seconds += max(seconds, 0.0)


def deadline_of(instance: Instance) -> float:
    """When the time of an instance that is begun now will be over, on that clock."""
    return computed() + instance.solver.max_seconds


BLOCK = 10_000
"""Steps of a grid between two looks at the clock."""


@dataclass(frozen=True)
class Limits:
    """When to give up, and who watches until then.

    What a verdict depends on is limited by work, which is the same on every machine; time is there for people.
    """

    iterations: int
    """Iterations of the method."""
    deadline: float
    """On the clock of :func:`computed`."""
    watch: Callable[[float, float], None] | None = None
    """Told cost and residual after inner steps, for a solver whose phases take long."""
    work: float = float("inf")
    """Columns that may be linearised, see :class:`Meter`."""
    meter: Meter = field(default_factory=Meter)
    """Shared by all limits that are derived from these."""

    def tell(self, cost: float, residual: float) -> None:
        """Tell who watches, if anyone does."""
        if self.watch:
            self.watch(cost, residual)

    def spend(self, columns: int) -> None:
        """Count work."""
        self.meter.spent += columns

    @property
    def late(self) -> bool:
        """Whether the time is over."""
        return computed() > self.deadline

    def check(self) -> None:
        """Raise :class:`TimeUp` if the time is over."""
        if self.expired:
            raise TimeUp

    def in_blocks(self, function: Callable[[NDArray[Any]], Array], places: NDArray[Any]) -> Array:
        """Values of a function at many places, shape (rows, M), with a look at the clock now and then.

        Raises
        ------
        TimeUp
            If the time is over and more than a block is left: few places are never too late.
        """
        found = []
        for first in range(0, len(places), BLOCK):
            if first:
                self.check()
            found.append(function(places[first : first + BLOCK]))
        return np.concatenate(found, axis=-1)

    @property
    def expired(self) -> bool:
        """Whether the time is over, or all work done that may be."""
        return self.meter.spent > self.work or self.late


def hurried(instance: Instance, deadline: float) -> Instance | None:
    """An instance that may take as long as is left until a deadline; ``None`` where nothing is left."""
    left = deadline - computed()
    if left <= 0.0:
        return None
    return replace(instance, solver=msgspec.structs.replace(instance.solver, max_seconds=left))


def watched(instance: Instance, progress: Progress | None) -> tuple[Limits, list[Iteration]]:
    """The limits that an instance sets, counted from now, and the history that is written by whoever tells them."""
    history: list[Iteration] = []

    def watch(objective: float, residual: float) -> None:
        history.append(Iteration(len(history), objective, residual))
        if progress:
            progress(history[-1])

    return Limits(
        instance.solver.max_iterations or MOST_ITERATIONS, deadline_of(instance), watch, instance.work
    ), history


def history_of(passed: Sequence[tuple[float, float]]) -> tuple[Iteration, ...]:
    """A history from cost and residual, one by one."""
    return tuple(Iteration(number, *one) for number, one in enumerate(passed))


@dataclass(frozen=True)
class Run(Generic[State]):
    """How an iteration ended."""

    state: State
    status: Status
    message: str
    history: tuple[Iteration, ...]


def iterate(method: Method[State], limits: Limits, progress: Progress | None) -> Run[State]:
    """Step until the method terminates or a limit is reached."""
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
    """No answer, and no trajectory."""
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
    """No motion."""
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
