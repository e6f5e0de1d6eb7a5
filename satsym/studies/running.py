"""Computing the chunks of a study that are missing, by any executor, and keeping each as soon as it is there."""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from typing import TypeAlias

from satsym.studies import chunks, rows
from satsym.studies.asked import Chunk, Study
from satsym.studies.parts import Parts
from satsym.studies.rows import Failure, Row

MOST_DEATHS = 3
"""Workers that may die of a chunk before it is given up."""


@dataclass(frozen=True)
class Advance:
    """How far a study is.

    Attributes
    ----------
    done, failures, total
        Rows that are kept, those among them without an answer, and all.
    begun, seconds
        Rows that were kept before this run, and how long it has been going on.
    """

    done: int
    failures: int
    total: int
    begun: int
    seconds: float

    @property
    def rate(self) -> float:
        """Rows a second in this run; 0 where there are none yet."""
        return (self.done - self.begun) / self.seconds if self.seconds > 0.0 else 0.0

    @property
    def left(self) -> float:
        """Seconds to go; infinite where that is not known yet."""
        return (self.total - self.done) / self.rate if self.rate > 0.0 else float("inf")


Work: TypeAlias = Callable[[bytes, Chunk], list[Row]]
Watch: TypeAlias = Callable[[Advance], None]


def run(
    study: Study,
    parts: Parts,
    executor: Executor,
    at_once: int,
    watch: Watch = lambda _: None,
    work: Work = chunks.computed,
    log: Callable[[str], None] = lambda _: None,
) -> None:
    """Compute what is missing.

    Parameters
    ----------
    study
        What is asked.
    parts
        What is there, to which the rest is added.
    executor
        Runs chunks somewhere.
    at_once
        Chunks that are under way at a time.
    watch
        Told after each chunk how far the study is.
    work
        What computes a chunk.
    log
        Told of each chunk when it was kept, and of each worker that died.

    Raises
    ------
    OSError
        If a chunk cannot be kept.
    """
    packed, total, before, began = chunks.pack(study), study.design.count, parts.rows, time.monotonic()
    waiting = deque(number for number in range(study.chunks) if number not in parts.done)
    deaths: Counter[int] = Counter()
    under_way: dict[Future[list[Row]], tuple[Chunk, float]] = {}

    def told() -> None:
        watch(Advance(parts.rows, parts.failures, total, before, time.monotonic() - began))

    told()
    while waiting or under_way:
        while waiting and len(under_way) < at_once:
            chunk = study.chunk(waiting.popleft())
            under_way[executor.submit(work, packed, chunk)] = chunk, time.monotonic()
        for future in wait(under_way, timeout=PAUSE, return_when=FIRST_COMPLETED).done:
            chunk, since = under_way.pop(future)
            found = _result(future)
            if isinstance(found, int):
                deaths[chunk.number] += found
                log(f"chunk {chunk.number}: its worker died ({deaths[chunk.number]})")
                if deaths[chunk.number] < MOST_DEATHS:
                    waiting.appendleft(chunk.number)
                    continue
                found = _given_up(chunk)
            parts.append(chunk.number, chunk.start, found)
            log(f"chunk {chunk.number}: {len(found)} rows in {time.monotonic() - since:.3f} s")
        told()


PAUSE = 0.5
"""Seconds after which it is told anew how far a study is, though nothing is new."""

DEADLY = "KilledWorker"
"""What Dask calls a task of which so many workers died that it tries no other."""


def _result(future: Future[list[Row]]) -> Sequence[Row] | int:
    """The rows of a chunk, or how many workers died of it. Anything else that a worker raises is raised here."""
    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, BrokenExecutor):
        return 1
    if type(error).__name__ == DEADLY:
        return MOST_DEATHS
    raise error


def _given_up(chunk: Chunk) -> Sequence[Row]:
    """The rows of a chunk that no worker survives."""
    message = f"{MOST_DEATHS} workers died while they computed these {len(chunk.values)} rows; solve them one by one"
    return [rows.failed("", Failure.WORKER_DIED, message) for _ in chunk.values]
