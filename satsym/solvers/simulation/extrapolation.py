"""Integration to the last digits: extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer).

Used to check solutions by means other than the solver's own, so it shares nothing with collocation. Its order
and step size adapt, and it evaluates nothing but the rates (Hairer, Norsett, Wanner, Solving Ordinary
Differential Equations I, II.9). The library's own integrators take longer to import than a solution to check.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice, pairwise
from typing import Any

import numpy as np

from satsym.arrays import Array

Rates = Callable[[float, Array], Array]

SUBSTEPS = (2, 4, 6, 8, 10, 12, 14, 16)
"""Numbers of midpoint steps in the columns of the extrapolation table; the last has order 16."""

SAFETY, SMALLEST_CHANGE, LARGEST_CHANGE = 0.7, 0.1, 4.0
"""Bounds of the next step: share of what the error allows, and the least and the largest change."""

MOST_STEPS = 100_000


class NotFinite(Exception):
    """The solution ceases to be finite, or the step size goes to zero."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Values at the ends of the steps that were taken."""

    times: Array
    """Shape (K,), from the start to the end."""
    values: Array
    """Shape (K, d)."""
    columns: int = len(SUBSTEPS)
    """Columns of the extrapolation table that the steps needed at most."""

    @property
    def end(self) -> Array:
        """The last value, shape (d,)."""
        return np.asarray(self.values[-1])


def integrate(
    rates: Rates, times: Array, start: Array, tolerance: float, size: Array, first: float = 0.25
) -> list[Trajectory]:
    """Integrate y' = rates(t, y) through given times; each is met exactly, as a corner must be.

    Parameters
    ----------
    rates
        Function of time and value, shape (d,).
    times
        Start, stops, end: shape (S+1,), monotone.
    start
        Value at the first, shape (d,).
    tolerance
        Largest error of a step, relative to ``size``.
    size
        Typical sizes of the components, shape (d,).
    first
        Length of the first step that is tried, as a share of the first piece.

    Returns
    -------
    list of Trajectory
        One for each of the S pieces.

    Raises
    ------
    NotFinite
        If the solution does not reach the end.
    """
    pieces, value = [], np.asarray(start, dtype=float)
    step = first * float(times[1] - times[0])
    for begin, end in pairwise(times):
        piece, step = _piece(rates, float(begin), float(end), value, step, tolerance, size)
        pieces.append(piece)
        value = piece.end
    return pieces


def leap(rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array, columns: int = len(SUBSTEPS)) -> Array:
    """One extrapolated step for many starts at once, each of its own length; of order twice the columns.

    Parameters
    ----------
    rates
        Function of times (M,) and values (d, M).
    t, y
        Starts, shapes (M,) and (d, M).
    h
        Lengths, shape (M,).
    columns
        Of the extrapolation table.

    Returns
    -------
    Array
        Values at the ends, shape (d, M).
    """
    return leap_and_error(rates, t, y, h, columns)[0]


def leap_and_error(
    rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array, columns: int = len(SUBSTEPS)
) -> tuple[Array, Array]:
    """Values at the ends with an estimate of their errors, from the next lower order, both of shape (d, M)."""
    return next(islice(leaps(rates, t, y, h), columns - 1, None))


def leap_varied(
    rates: Callable[[Any, Array], Array],
    slopes: Callable[[Array, Array], Array],
    t: Array,
    y: Array,
    h: Array,
    columns: int = len(SUBSTEPS),
) -> tuple[Array, Array, Array]:
    """Values at the ends and how they follow their starts by the rule for the variations, with the error of those.

    Parameters
    ----------
    slopes
        Derivatives of the rates at times (K,) and values (d, K), shape (K, d, d): asked for once, at all places.

    Returns
    -------
    Array
        Values at the ends, shape (d, M).
    Array
        Their derivatives by the starts, shape (M, d, d).
    Array
        By how much these differ from those of the next lower order, shape (M, d, d).
    """
    places: list[tuple[Array, Array]] = []

    def noted(t: Array, z: Array) -> Array:
        places.append((t, z))
        return rates(t, z)

    ends, _ = next(islice(leaps(noted, t, y, h, columns), columns - 1, None))
    found = slopes(*(np.concatenate(rows, axis=-1) for rows in zip(*places, strict=True)))
    first, *others = np.split(found, np.cumsum([len(times) for times, _ in places])[:-1])
    counts = np.array(SUBSTEPS[:columns])
    width = (h / counts[:, None])[..., None, None]
    unity = np.broadcast_to(np.eye(len(y)), (columns, *first.shape))
    whole = _midpoints(lambda i, now: others[i - 1].reshape(now.shape) @ now, unity, width * first, width)
    table = np.array(whole)
    found = _weights(columns) @ table.reshape(columns, -1)
    last, before = found.reshape(2, *table.shape[1:])
    return ends, last, np.abs(last - before)


@lru_cache
def _weights(columns: int) -> Array:
    """Weights of the columns in the last entry of the table and in that of the next lower order (Aitken, Neville)."""
    squares = np.array(SUBSTEPS[:columns], dtype=float) ** 2
    found = np.zeros((2, columns))
    for row, own in enumerate((squares, squares[1:])):
        apart = np.where(np.eye(len(own)) > 0.0, own, own[:, None] - own)
        found[row, row:] = (own[:, None] / apart).prod(axis=1)
    return found


def leaps(
    rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array, together: int = 1
) -> Iterator[tuple[Array, Array]]:
    """Values at the ends with one column, two, and so on; the first has an infinite error, with nothing to compare.

    Parameters
    ----------
    together
        Columns that are computed side by side, which is quicker where starts are few: rates are asked for at several
        times as many places then.
    """
    slope = rates(t, y)
    first: Sequence[Array] = ()
    if together > 1:
        width = h / np.array(SUBSTEPS[:together])[:, None, None]

        def every(i: int, now: Array) -> Array:
            times, values = (t + i * width[-len(now) :]).ravel(), now.transpose(1, 0, 2)
            found = rates(times, values.reshape(len(y), -1))
            return np.ascontiguousarray(found.reshape(values.shape).transpose(1, 0, 2))

        first = _midpoints(every, np.broadcast_to(y, (together, *y.shape)), width * slope, width)
    table: list[Array] = []
    for k, count in enumerate(SUBSTEPS):
        row = [first[k] if k < len(first) else _midpoint(rates, t, y, slope, h, count)]
        for j in range(k):
            ratio = (count / SUBSTEPS[k - j - 1]) ** 2
            row.append(row[j] + (row[j] - table[j]) / (ratio - 1.0))
        table = row
        yield row[-1], np.abs(row[-1] - row[-2]) if k else np.full_like(y, np.inf)


def _piece(
    rates: Rates, begin: float, end: float, value: Array, step: float, tolerance: float, size: Array
) -> tuple[Trajectory, float]:
    at, times, values, most = begin, [begin], [value], 1
    step = np.copysign(min(abs(step), abs(end - begin)), end - begin)
    for _ in range(MOST_STEPS):
        left = end - at
        if left == 0.0:
            return Trajectory(np.array(times), np.array(values), most), float(step)
        last = abs(step) >= abs(left) * (1.0 - 1e-12)
        h = left if last else step
        reached, error, column = _extrapolated(rates, at, values[-1], h, tolerance, size)
        if error <= 1.0:
            at = end if last else at + h
            times.append(at)
            values.append(reached)
            most = max(most, column + 1)
        factor = SAFETY * (1.0 / max(error, 1e-10)) ** (1.0 / (2 * column + 1))
        grown = h * min(LARGEST_CHANGE, max(SMALLEST_CHANGE, factor))
        step = grown if not last or error > 1.0 else np.copysign(max(abs(grown), abs(step)), h)
        if abs(step) < 1e-14 * max(abs(at), abs(end - begin)):
            break
    raise NotFinite(f"the solution is not finite beyond t = {at:g}")


def _extrapolated(
    rates: Rates, t: float, y: Array, h: float, tolerance: float, size: Array
) -> tuple[Array, float, int]:
    """One extrapolated step; its error in units of the tolerance, and the column that was reached."""
    table: list[Array] = []
    slope = rates(t, y)
    error, best = float("inf"), y
    for k, count in enumerate(SUBSTEPS):
        row = [_midpoint(rates, t, y, slope, h, count)]
        for j in range(k):
            ratio = (count / SUBSTEPS[k - j - 1]) ** 2
            row.append(row[j] + (row[j] - table[j]) / (ratio - 1.0))
        if not np.isfinite(row[-1]).all():
            return y, float("inf"), max(k, 1)
        if k > 0:
            scale = tolerance * np.maximum(size, np.abs(row[-1]))
            error, best = float(np.max(np.abs(row[-1] - row[-2]) / scale)), row[-1]
            if k > 2 and error <= 1.0:
                return best, error, k
        table = row
    return best, error, len(SUBSTEPS) - 1


def _midpoint(rates: Callable[[Any, Array], Array], t: Any, y: Array, slope: Array, h: Any, count: int) -> Array:
    """The modified midpoint rule with that many steps, without its smoothing step."""
    width = h / count
    before, now = y, y + width * slope
    for i in range(1, count):
        before, now = now, before + 2.0 * width * rates(t + i * width, now)
    return now


def _midpoints(rates: Callable[[int, Array], Array], begin: Array, change: Array, width: Array) -> list[Array]:
    """Midpoint values of the first columns of the table side by side.

    Parameters
    ----------
    rates
        Function of the number of the step and of the values of those columns that have so many, as a new array.
    begin, change
        Values at the start, and by how much they change in the first step, a column of the table each.
    """
    before: Array = begin
    now: Array = begin + change
    ended: list[Array] = []
    for i in range(1, SUBSTEPS[len(begin) - 1] + 1):
        if SUBSTEPS[len(ended)] == i:
            ended.append(now[0])
            before, now, width = before[1:], now[1:], width[1:]
        if len(now):
            after = rates(i, now)
            after *= 2.0 * width
            after += before
            before, now = now, after
    return ended
