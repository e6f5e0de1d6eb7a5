"""Integration to rounding accuracy by extrapolation of the modified midpoint rule (Gragg, Bulirsch, Stoer).

It is used to check solutions independently of the solvers and has no code in common with collocation. Order and step
size are adaptive, and only the right-hand side is evaluated (Hairer, Norsett, Wanner, Solving Ordinary Differential
Equations I, II.9). The integrators of SciPy take longer to import than a solution takes to check.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice, pairwise
from typing import Any

import numpy as np

from satsym.arrays import Array

Rates = Callable[[Any, Array], Array]

SUBSTEPS = (2, 4, 6, 8, 10, 12, 14, 16)
"""Numbers of midpoint steps in the columns of the extrapolation table; the last has order 16."""

SAFETY, SMALLEST_CHANGE, LARGEST_CHANGE = 0.7, 0.1, 4.0
"""Step-size control: safety factor, smallest factor and largest factor of the next step."""

MOST_STEPS = 100_000


class NotFinite(Exception):
    """The solution is not finite, or the step size tends to zero."""


@dataclass(frozen=True, eq=False)
class Trajectory:
    """Values at the ends of the integration steps."""

    times: Array
    """Times from start to end, shape (K,)."""
    values: Array
    """Values at the ends of the steps, shape (K, d)."""
    columns: int = len(SUBSTEPS)
    """Largest number of columns of the extrapolation table that a step needed."""

    @property
    def end(self) -> Array:
        """Value at the end of the last step, shape (d,)."""
        return np.asarray(self.values[-1])


def integrate(
    rates: Rates,
    times: Array,
    start: Array,
    tolerance: float,
    size: Array,
    first: float = 0.25,
    together: bool = False,
) -> list[Trajectory]:
    """Integrate y' = rates(t, y) through given times, at each of which a step ends, as is needed at corners.

    Parameters
    ----------
    rates
        Function of time and value that returns the time derivative, shape (d,).
    times
        Initial time, intermediate times and final time in monotonic order, shape (S+1,).
    start
        Initial value, shape (d,).
    tolerance
        Largest error of a step, relative to ``size``.
    size
        Typical magnitudes of the components, shape (d,).
    first
        Length of the first step that is tried, as a fraction of the first piece.
    together
        Whether ``rates`` takes times (M,) and values (d, M) and returns rates (d, M). Several columns of the
        extrapolation table are then computed simultaneously, which is faster if each call has a high fixed cost.

    Returns
    -------
    list of Trajectory
        One trajectory for each of the S pieces.

    Raises
    ------
    NotFinite
        If the solution does not reach the final time.
    """
    pieces, value = [], np.asarray(start, dtype=float)
    step = first * float(times[1] - times[0])
    for begin, end in pairwise(times):
        piece, step = _piece(rates, float(begin), float(end), value, step, tolerance, size, together)
        pieces.append(piece)
        value = piece.end
    return pieces


def integrate_each(
    rates: Rates, begins: Array, ends: Array, starts: Array, tolerance: float, size: Array
) -> list[Trajectory]:
    """Integrate y' = rates(t, y) from many initial values at once, each from its own initial to its own final time.

    Every motion has its own step size; all of them are evaluated together.

    Parameters
    ----------
    rates
        Function of times (M,) and values (d, M) that returns rates (d, M).
    begins, ends
        Initial and final times, shape (M,).
    starts
        Initial values, shape (d, M).
    tolerance, size
        As for :func:`integrate`.

    Returns
    -------
    list of Trajectory
        One trajectory for each of the M motions.

    Raises
    ------
    NotFinite
        If a motion does not reach its final time.
    """
    at, values, steps = begins.astype(float), starts.astype(float), ends - begins
    found = [([t], [value]) for t, value in zip(at.tolist(), values.T.copy(), strict=True)]
    column = together = len(SUBSTEPS) // 2
    for _ in range(MOST_STEPS):
        own = np.flatnonzero(at != ends)
        if not len(own):
            return [Trajectory(np.array(times), np.array(passed)) for times, passed in found]
        left = ends[own] - at[own]
        last = np.abs(steps[own]) >= np.abs(left) * (1.0 - 1e-12)
        h = np.where(last, left, steps[own])
        for column, (reached, change) in enumerate(leaps(rates, at[own], values[:, own], h, together)):
            error = (change / (tolerance * np.maximum(size[:, None], np.abs(reached)))).max(axis=0)
            error = np.where(np.isfinite(error), error, np.inf)
            if column > 2 and (error <= 1.0).all():
                break
        together = column + 1
        taken = error <= 1.0
        at[own[taken]] = np.where(last, ends[own], at[own] + h)[taken]
        values[:, own[taken]] = reached[:, taken]
        for place in own[taken].tolist():
            found[place][0].append(float(at[place]))
            found[place][1].append(values[:, place].copy())
        factor = SAFETY * np.maximum(error, 1e-10) ** (-1.0 / (2 * column + 1))
        grown = h * np.clip(factor, SMALLEST_CHANGE, LARGEST_CHANGE)
        steps[own] = np.where(last & taken, left, grown)
        vanishing = np.abs(grown) < 1e-14 * np.maximum(np.abs(at[own]), np.abs(ends - begins)[own])
        if (vanishing & ~(last & taken)).any():
            break
    raise NotFinite("a motion is not finite")


def leap(rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array, columns: int = len(SUBSTEPS)) -> Array:
    """Return the values after one extrapolated step for many initial values, each with its own step size.

    Parameters
    ----------
    rates
        Function of times (M,) and values (d, M).
    t, y
        Initial times and values, shapes (M,) and (d, M).
    h
        Step sizes, shape (M,).
    columns
        Number of columns of the extrapolation table; the order is twice this number.

    Returns
    -------
    Array
        Values after the step, shape (d, M).
    """
    return leap_and_error(rates, t, y, h, columns)[0]


def leap_and_error(
    rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array, columns: int = len(SUBSTEPS)
) -> tuple[Array, Array]:
    """Return values after one step and an error estimate from the next lower order, both of shape (d, M)."""
    return next(islice(leaps(rates, t, y, h), columns - 1, None))


def leap_varied(
    rates: Callable[[Any, Array], Array],
    slopes: Callable[[Array, Array], Array],
    t: Array,
    y: Array,
    h: Array,
    columns: int = len(SUBSTEPS),
) -> tuple[Array, Array, Array]:
    """Return values after one step, their derivatives with respect to the initial values, and errors of these.

    Parameters
    ----------
    rates, t, y, h, columns
        As for :func:`leap`.
    slopes
        Jacobians of the rates at times (K,) and values (d, K), shape (K, d, d), evaluated once for all points.

    Returns
    -------
    Array
        Values after the step, shape (d, M).
    Array
        Their derivatives with respect to the initial values, shape (M, d, d).
    Array
        Difference of these from those of the next lower order, shape (M, d, d).
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
    """Return the weights of the columns in the last entry of the table, and in that of the next lower order.

    They follow from the recursion of Aitken and Neville.
    """
    squares = np.array(SUBSTEPS[:columns], dtype=float) ** 2
    found = np.zeros((2, columns))
    for row, own in enumerate((squares, squares[1:])):
        apart = np.where(np.eye(len(own)) > 0.0, own, own[:, None] - own)
        found[row, row:] = (own[:, None] / apart).prod(axis=1)
    return found


def leaps(
    rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array, together: int = 1
) -> Iterator[tuple[Array, Array]]:
    """Yield values after one step with one column, two columns, and so on, each with its error; the first is infinite.

    Parameters
    ----------
    rates, t, y, h
        As for :func:`leap`.
    together
        Number of columns that are computed simultaneously, which is faster for few initial values, because rates are
        evaluated at more points at a time.
    """
    table: list[Array] = []
    for k, (count, column) in enumerate(zip(SUBSTEPS, _columns(rates, t, y, h, together), strict=True)):
        row = [column]
        for j in range(k):
            ratio = (count / SUBSTEPS[k - j - 1]) ** 2
            row.append(row[j] + (row[j] - table[j]) / (ratio - 1.0))
        table = row
        yield row[-1], np.abs(row[-1] - row[-2]) if k else np.full_like(y, np.inf)


def _columns(rates: Callable[[Any, Array], Array], t: Array, y: Array, h: Array, together: int) -> Iterator[Array]:
    """Yield the midpoint values (d, M) of each column of the table; the first columns are computed simultaneously."""
    slope = rates(t, y)
    first: Sequence[Array] = ()
    if together > 1:
        width = h / np.array(SUBSTEPS[:together])[:, None, None]

        def every(i: int, now: Array) -> Array:
            times, values = (t + i * width[-len(now) :]).ravel(), now.transpose(1, 0, 2)
            found = rates(times, values.reshape(len(y), -1))
            return np.ascontiguousarray(found.reshape(values.shape).transpose(1, 0, 2))

        first = _midpoints(every, np.broadcast_to(y, (together, *y.shape)), width * slope, width)
    yield from first
    yield from (_midpoint(rates, t, y, slope, h, count) for count in SUBSTEPS[len(first) :])


def _piece(
    rates: Rates, begin: float, end: float, value: Array, step: float, tolerance: float, size: Array, together: bool
) -> tuple[Trajectory, float]:
    at, times, values, most, column = begin, [begin], [value], 1, len(SUBSTEPS) // 2
    step = np.copysign(min(abs(step), abs(end - begin)), end - begin)
    for _ in range(MOST_STEPS):
        left = end - at
        if left == 0.0:
            return Trajectory(np.array(times), np.array(values), most), float(step)
        last = abs(step) >= abs(left) * (1.0 - 1e-12)
        h = left if last else step
        ahead = column + 1 if together else 0
        reached, error, column = _extrapolated(rates, at, values[-1], h, tolerance, size, ahead)
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
    rates: Rates, t: float, y: Array, h: float, tolerance: float, size: Array, ahead: int = 0
) -> tuple[Array, float, int]:
    """Return one extrapolated step, its error in units of the tolerance, and the column that was reached.

    Parameters
    ----------
    ahead
        Number of columns that are computed simultaneously by rates for many points; 0 for rates of one point.
    """
    columns: Iterator[Array]
    if ahead:
        columns = (column[:, 0] for column in _columns(rates, np.array([t]), y[:, None], np.array([h]), ahead))
    else:
        slope = rates(t, y)
        columns = (_midpoint(rates, t, y, slope, h, count) for count in SUBSTEPS)
    table: list[Array] = []
    error, best = float("inf"), y
    for k, (count, column) in enumerate(zip(SUBSTEPS, columns, strict=True)):
        row = [column]
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
    """Return the result of the modified midpoint rule with `count` steps, without its smoothing step."""
    width = h / count
    before, now = y, y + width * slope
    for i in range(1, count):
        before, now = now, before + 2.0 * width * rates(t + i * width, now)
    return now


def _midpoints(rates: Callable[[int, Array], Array], begin: Array, change: Array, width: Array) -> list[Array]:
    """Return the midpoint values of the first columns of the table, computed simultaneously.

    Parameters
    ----------
    rates
        Function of the index of the step and of the values of the columns with that many steps; returns a new array.
    begin, change
        Initial values, and their changes in the first step, for each column of the table.
    width
        Lengths of the midpoint steps of each column.
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
