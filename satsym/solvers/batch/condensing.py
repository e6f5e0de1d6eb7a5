"""Condensing for many problems: nodes are expressed by the first node, in compiled code or by NumPy."""

from __future__ import annotations

from functools import lru_cache
from typing import Protocol

import numpy as np

from satsym.arrays import Array
from satsym.kernels.batch import compiling
from satsym.kernels.batch.workspace import (
    LANES,
    Workspace,
    element,
    function,
    indented,
    lanes_of,
    over_blocks,
    over_lanes,
)


class Condensing(Protocol):
    """Function that propagates columns through transition matrices of shape (2n, 2n, N, M)."""

    def __call__(self, transition: Array, start: Array, gaps: Array | None) -> Array:
        """Return columns at all nodes, shape (2n, c, N+1, M), from those at the first node, shape (2n, c, M).

        Gaps of shape (2n, N, M) are added to the last column at the end of each segment.
        """

    def combine(self, columns: Array, weights: Array, found: Array) -> None:
        """Add the first k columns (2n, c, N+1, M), times weights (k, M), to `found`, shape (2n, N+1, M), in place."""


@lru_cache(maxsize=16)
def condensing(states: int, compiled: bool) -> Condensing:
    """Return the condensing function for a number of states."""
    return _Compiled(2 * states) if compiled else _OnArrays()


class _OnArrays:
    """Condensing (elimination of inner nodes) by NumPy."""

    def __call__(self, transition: Array, start: Array, gaps: Array | None) -> Array:
        found = np.empty((*start.shape[:2], transition.shape[2] + 1, start.shape[2]))
        found[:, :, 0] = start
        for s in range(transition.shape[2]):
            before, after = found[:, :, s], found[:, :, s + 1]
            np.multiply(transition[:, 0, None, s], before[0], out=after)
            for k in range(1, len(before)):
                after += transition[:, k, None, s] * before[k]
            if gaps is not None:
                after[:, -1] += gaps[:, s]
        return found

    def combine(self, columns: Array, weights: Array, found: Array) -> None:
        for k, weight in enumerate(weights):
            found += columns[:, k] * weight


class _Compiled:
    """Condensing (elimination of inner nodes) by compiled code."""

    def __init__(self, rows: int) -> None:
        name = f"condensing_{rows}"
        functions = compiling.compiled(name, text(rows))
        self._function, self._combine = functions["many"], functions["combine"]
        with compiling.alone(name):  # made or read by a call with no problems
            found = self(np.zeros((rows, rows, 1, 0)), np.zeros((rows, 1, 0)), None)
            self.combine(found, np.zeros((1, 0)), found[:, 0].copy())

    def __call__(self, transition: Array, start: Array, gaps: Array | None) -> Array:
        rows, columns = start.shape[:2]
        segments, count = transition.shape[2:]
        found = np.empty((rows * columns, segments + 1, count))
        given = np.zeros((rows, segments, 0)) if gaps is None else np.ascontiguousarray(gaps)
        self._function(
            np.ascontiguousarray(transition).reshape(rows * rows, segments, count),
            np.ascontiguousarray(start).reshape(rows * columns, count),
            given,
            columns,
            found,
        )
        return found.reshape(rows, columns, segments + 1, count)

    def combine(self, columns: Array, weights: Array, found: Array) -> None:
        rows, count = columns.shape[:2]
        given = np.ascontiguousarray(columns).reshape(rows * count, *found.shape[1:])
        self._combine(given, count, weights, found)


def text(rows: int) -> str:
    """Return the source of the compiled module for a number of rows; columns are processed one after the other."""
    own = Workspace()
    slopes, now, after, added = (
        own.place(name, size)
        for name, size in (("slopes", rows * rows), ("now", rows), ("after", rows), ("gaps", rows))
    )

    def rowwise(count: int, into: int, source: str) -> list[str]:
        return [f"for i in range({count}):", *indented(lanes_of(f"w[{into} + i * {LANES} + j]", source))]

    product: list[str] = [f"v{k} = {element(now, k)}" for k in range(rows)]
    for i in range(rows):
        terms = " + ".join(f"{element(slopes, i * rows + k)} * v{k}" for k in range(rows))
        product.append(f"{element(after, i)} = {terms} + {element(added, i)}")
    step = [
        *rowwise(rows * rows, slopes, "transition[i, s, {column}]"),
        *rowwise(rows, added, "0.0"),
        "for c in range(columns):",
        *indented(
            [
                "if c == columns - 1 and gaps.shape[2]:",
                *indented(rowwise(rows, added, "gaps[i, s, {column}]")),
                *rowwise(rows, now, "found[i * columns + c, s, {column}]"),
                *over_lanes(product),
                f"for i in range({rows}):",
                "    for j in range(width):",
                f"        found[i * columns + c, s + 1, at + j] = w[{after} + i * {LANES} + j]",
            ]
        ),
    ]
    block = [
        "for i in range(len(start)):",
        "    for j in range(width):",
        "        found[i, 0, at + j] = start[i, at + j]",
        "for s in range(transition.shape[1]):",
        *indented(step),
    ]
    body = [f"w = np.zeros({own.size})", *over_blocks("start.shape[1]", block)]
    adding = [
        "for i in range(len(found)):",
        "    for s in range(found.shape[1]):",
        "        for k in range(len(weights)):",
        "            for m in range(found.shape[2]):",
        "                found[i, s, m] += given[i * columns + k, s, m] * weights[k, m]",
    ]
    lines = [*compiling.HEAD, *function("many(transition, start, gaps, columns, found)", body)]
    lines += function("combine(given, columns, weights, found)", adding)
    return "\n".join(lines) + "\n"
