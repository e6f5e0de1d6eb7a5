"""What may be met instead of a chunk of a study, and who computes it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, Future
from typing import Any

import numpy as np

from satsym.studies import rows
from satsym.studies.asked import Chunk
from satsym.studies.rows import Row

Made = Callable[[bytes, Chunk], list[Row]]


def made(packed: bytes, chunk: Chunk) -> list[Row]:
    """Rows that say their first values, at once."""
    return [
        Row(
            f"{chunk.start + k}",
            "converged",
            "",
            {"objective": 2.0 * value, "verdict": "local minimum"},
            _arrays(value),
        )
        for k, (value, *_) in enumerate(chunk.values.tolist())
    ]


def _arrays(value: float) -> dict[str, Any]:
    return {"t": np.linspace(0.0, 1.0, 3), "x": np.full((4, 3), value), "u": np.zeros((2, 3)), "lam": np.ones((4, 3))}


def failing(packed: bytes, chunk: Chunk) -> list[Row]:
    """The same, the last of a chunk a failure."""
    return [*made(packed, chunk)[:-1], rows.failed("", rows.Failure.BAD_INPUT, "no")]


def raising(packed: bytes, chunk: Chunk) -> list[Row]:
    """A mistake of ours."""
    raise RuntimeError("a mistake")


class Here(Executor):
    """Computes at once and here, by another function where one is given; knows which chunks it was given."""

    def __init__(self, work: Made | None = made) -> None:
        self.work, self.given = work, list[int]()

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.given.append(args[1].number)
        future: Future[Any] = Future()
        try:
            future.set_result((self.work or fn)(*args))
        except Exception as error:
            future.set_exception(error)
        return future


class Deadly(Here):
    """Dies of the row with the value 5."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        if 5.0 not in args[1].values[:, 0]:
            return super().submit(fn, *args, **kwargs)
        future: Future[Any] = Future()
        future.set_exception(BrokenExecutor())
        return future


class Backwards(Here):
    """Holds chunks back, and gives out the one that it was given last whenever it is asked how far it is."""

    def __init__(self, work: Made | None = made) -> None:
        super().__init__(work)
        self.waiting: list[tuple[Future[Any], tuple[Any, ...]]] = []

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        self.given.append(args[1].number)
        self.waiting.append((Future(), args))
        return self.waiting[-1][0]

    def release(self, _: object) -> None:
        """Compute one."""
        if self.waiting:
            future, args = self.waiting.pop()
            future.set_result((self.work or made)(*args))
