"""Computation of the missing chunks of a study by any executor; each is saved as soon as it arrives."""

from __future__ import annotations

import time
from collections import Counter, deque
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from typing import TypeAlias

from satsym.studies import chunks, rows
from satsym.studies.asked import Chunk, Study
from satsym.studies.parts import Parts
from satsym.studies.rows import Failure, Row

MOST_DEATHS = 3
"""Number of workers that may die while computing a chunk before its rows are computed singly.

It is also the number of workers that may die while computing a row before the row is abandoned.
"""


@dataclass(frozen=True)
class Advance:
    """The progress of a study.

    Attributes
    ----------
    done, failures, total
        Numbers of rows that are kept, of those among them without an answer, and of all rows.
    begun, seconds
        Number of rows that were kept before this run, and the seconds that this run has taken.
    compiling
        Whether kernels may be being compiled.
    """

    done: int
    failures: int
    total: int
    begun: int
    seconds: float
    compiling: bool = False

    @property
    def rate(self) -> float:
        """Return rows a second in this run; 0 where none is computed yet."""
        return (self.done - self.begun) / self.seconds if self.seconds > 0.0 else 0.0

    @property
    def left(self) -> float:
        """Return the seconds that are left; infinite where that is not known yet."""
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
    """Compute the missing chunks of a study.

    A chunk that workers die of is computed row by row, so that only the row they die of is lost.

    Parameters
    ----------
    study
        The statement of the study.
    parts
        The chunks that are saved already, to which the others are added.
    executor
        Executor that computes chunks.
    at_once
        Number of chunks that are computed at a time.
    watch
        Function that is called with the progress of the study after each chunk, and from time to time.
    work
        Function that computes a chunk.
    log
        Function that is called with a line for each chunk that was kept, and for each worker that died.

    Raises
    ------
    OSError
        If a chunk cannot be kept.
    """
    packed, total, before, began = chunks.pack(study), study.design.count, parts.rows, time.monotonic()
    missing = deque(number for number in range(study.chunks) if number not in parts.done)
    again: deque[Chunk] = deque()
    apart: dict[int, dict[int, Row]] = {}
    deaths: Counter[Chunk] = Counter()
    under_way: dict[Future[list[Row]], tuple[Chunk, float]] = {}

    def report() -> None:
        compiling = study.compiled and parts.rows == before
        watch(Advance(parts.rows, parts.failures, total, before, time.monotonic() - began, compiling))

    report()
    while missing or again or under_way:
        while (missing or again) and len(under_way) < at_once:
            chunk = again.popleft() if again else study.chunk(missing.popleft())
            under_way[executor.submit(work, packed, chunk)] = chunk, time.monotonic()
        for future in wait(under_way, timeout=PAUSE, return_when=FIRST_COMPLETED).done:
            chunk, since = under_way.pop(future)
            found = _result(future)
            if isinstance(found, int):
                deaths[chunk] += found
                log(f"chunk {chunk.number}: its worker died ({deaths[chunk]})")
                if deaths[chunk] < MOST_DEATHS:
                    again.appendleft(chunk)
                    continue
                if len(chunk.values) > 1:
                    again.extend(chunk.apart())
                    continue
                found = [_lost()]
            start, count = study.place(chunk.number)
            whole = found if len(found) == count else _joined(apart, chunk, found[0], count)
            if whole:
                parts.append(chunk.number, start, whole)
                log(f"chunk {chunk.number}: {len(whole)} rows in {time.monotonic() - since:.3f} s")
        report()


PAUSE = 0.5
"""Seconds between reports of progress if nothing is new."""

DEADLY = "KilledWorker"
"""Name of the error that Dask raises for a task of which several workers died."""


def _result(future: Future[list[Row]]) -> list[Row] | int:
    """Return the rows of a chunk, or the number of workers that died of it; raise any other error of a worker."""
    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, BrokenExecutor):
        return 1
    if type(error).__name__ == DEADLY:
        return MOST_DEATHS
    raise error


def _joined(apart: dict[int, dict[int, Row]], chunk: Chunk, row: Row, count: int) -> list[Row]:
    """Return the rows of a chunk that is computed row by row, once all are there; empty before."""
    found = apart.setdefault(chunk.number, {})
    found[chunk.start] = row
    return [row for _, row in sorted(apart.pop(chunk.number).items())] if len(found) == count else []


def _lost() -> Row:
    """Return the row that stands for one whose workers died."""
    message = f"{MOST_DEATHS} workers died while they computed this case; --resume tries it again"
    return rows.failed("", Failure.WORKER_DIED, message)
