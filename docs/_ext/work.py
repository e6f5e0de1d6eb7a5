"""What takes time, done by as many processes as there are processors, before pages are read."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import Future, ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any

import figures
import gallery
import notebooks
from sphinx.application import Sphinx

FIRST, LAST = 400, 900
"""Priorities of its beginning and its end; what has Sphinx's own, 500, is done meanwhile."""


class Work:
    """Jobs in processes of their own, and what is done with what they return."""

    def __init__(self) -> None:
        # as the command line does: threads cost more than they save
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
        self.pool = ProcessPoolExecutor(os.cpu_count() or 1, get_context("spawn"))
        self.begun: list[tuple[list[Future[Any]], Callable[[list[Any]], None]]] = []

    def begin(
        self, jobs: Iterable[tuple[Callable[..., Any], tuple[Any, ...]]], done: Callable[[list[Any]], None]
    ) -> None:
        """Begin jobs, each a function with its arguments; in the end, tell what they returned."""
        self.begun.append(([self.pool.submit(job, *arguments) for job, arguments in jobs], done))

    def end(self) -> None:
        """Wait for all jobs; the first that failed raises what it raised."""
        with self.pool:
            for futures, done in self.begun:
                done([future.result() for future in futures])


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the extension with Sphinx."""
    begun: list[Work] = []

    def begin(app: Sphinx) -> None:
        work = Work()
        begun.append(work)
        for part in (notebooks, gallery, figures):  # what takes longest comes first
            part.begin(app, work)

    app.connect("builder-inited", begin, priority=FIRST)
    app.connect("builder-inited", lambda _: begun[0].end(), priority=LAST)
    return {"parallel_read_safe": True}
