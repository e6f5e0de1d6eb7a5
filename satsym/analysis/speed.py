"""Speed of this machine for a model: integration steps a second, and the time of one solution."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.kernels.batch.compiling import able
from satsym.status import Status

COLUMNS, STEPS = 4096, 10
"""Number of motions at once, and of steps between two readings of the clock."""

STEP_LENGTH, START_DISTANCE = 1e-4, 1e-3
"""Length of a step, in the unit of time, and distance between neighbouring starts."""

RUNS = 3
"""Number of runs, of which the fastest counts, since other processes slow the others down."""


@dataclass(frozen=True)
class Speed:
    """The number of steps of the classical Runge-Kutta method a second, each step of one motion.

    Attributes
    ----------
    backend
        ``"numpy"`` or ``"numba"``.
    cores
        That took part.
    steps
        A second.
    """

    backend: str
    cores: int
    steps: float


@dataclass(frozen=True)
class Solved:
    """The time that one solution took.

    Attributes
    ----------
    status, method
        How it ended, and by what.
    seconds, certificate_seconds
        Until the answer, and for its certificate with all competitors; the latter ``None`` without an answer.
    """

    status: Status
    method: str
    seconds: float
    certificate_seconds: float | None


def cores() -> int:
    """Return the number of processor cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def speeds(subject: Instance | Kernels, seconds: float) -> Iterator[Speed]:
    """Measure the steps a second of many motions at once, by NumPy and by machine code, on one core and on all.

    Parameters
    ----------
    subject
        A model, or an instance of one, about whose initial state the motions begin.
    seconds
        That each is measured for; making machine code comes before that.
    """
    from satsym.kernels.blocks import block_step
    from satsym.solvers.simulation.batch import simulate

    model = subject if isinstance(subject, Kernels) else subject.model
    x, p = _columns(subject)
    until = [0.0, STEP_LENGTH * STEPS]
    yield Speed("numpy", 1, _rate(lambda: simulate(model, until, x, list(p), STEPS), seconds))
    if not able():
        return
    advance, controls = block_step(model.compiled()), np.zeros((len(model.spec.controls), COLUMNS))
    for count in sorted({1, cores()}):
        ends = np.linspace(0, COLUMNS, count + 1).astype(int)
        parts = [
            tuple(np.ascontiguousarray(rows[:, low:high]) for rows in (x, controls, p)) for low, high in pairwise(ends)
        ]
        with ThreadPoolExecutor(count) as pool:

            def run(pool: ThreadPoolExecutor = pool, parts: list[tuple[Array, ...]] = parts) -> None:
                list(
                    pool.map(lambda part: advance(0.0, STEP_LENGTH, STEPS * REPEATED, part[0].copy(), *part[1:]), parts)
                )

            yield Speed("numba", count, REPEATED * _rate(run, seconds))


REPEATED = 20
"""Factor of the steps of machine code between two readings of the clock, since starting a thread takes time."""


def _columns(subject: Instance | Kernels) -> tuple[Array, Array]:
    """Return states about a start, and parameters, in a column for each motion."""
    if isinstance(subject, Kernels):
        start = [1.0] * len(subject.spec.states)
        parameters = [1.0 if one.default is None else float(one.default) for one in subject.spec.parameters]
    else:
        start, parameters = list(subject.initial), list(subject.parameters)
    rng, x = np.random.default_rng(0), np.array(start)[:, None]
    apart = START_DISTANCE * np.maximum(np.abs(x), 1.0) * rng.uniform(-1.0, 1.0, (len(x), COLUMNS))
    return x + apart, np.repeat(np.array(parameters).reshape(-1, 1), COLUMNS, axis=1)


def _rate(run: Callable[[], object], seconds: float) -> float:
    """Return the steps a second of the fastest of several runs."""
    with np.errstate(all="ignore"):
        run()  # what is made when it is first called is made now
        best = 0.0
        for _ in range(RUNS):
            count, began = 0, time.perf_counter()
            while (took := time.perf_counter() - began) < seconds / RUNS or not count:
                run()
                count += 1
            best = max(best, count * COLUMNS * STEPS / took)
    return best


def solved(instance: Instance) -> Solved:
    """Measure the time of one solution, and of its certificate."""
    from satsym import solvers
    from satsym.solvers.certificate import certify

    solvers.solve(instance, examined=False)  # so that what is loaded is there
    began = time.perf_counter()
    found = solvers.solve(instance, examined=False)
    took = time.perf_counter() - began
    if not found.status.answered:
        return Solved(found.status, found.method, took, None)
    began = time.perf_counter()
    certify(replace(found, wall_s=took))
    return Solved(found.status, found.method, took, time.perf_counter() - began)
