"""What workers may meet instead of a chunk of a study."""

from __future__ import annotations

import os

from satsym.studies import rows
from satsym.studies.asked import Chunk
from satsym.studies.rows import Row


def deadly_in_one(packed: bytes, chunk: Chunk) -> list[Row]:
    """Rows that say their values, but for chunk 1, of which every worker dies."""
    if chunk.number == 1:
        os._exit(9)
    return [Row("", "converged", "", {"twice": 2.0 * value}) for (value,) in chunk.values.tolist()]


def raising(packed: bytes, chunk: Chunk) -> list[Row]:
    """A mistake of ours."""
    raise RuntimeError("a mistake")


def quick(packed: bytes, chunk: Chunk) -> list[Row]:
    """Rows that say their values, the last of a chunk a failure."""
    found = [Row("", "converged", "", {"twice": 2.0 * value}) for (value,) in chunk.values.tolist()]
    found[-1] = rows.failed("", rows.Failure.BAD_INPUT, "no")
    return found
