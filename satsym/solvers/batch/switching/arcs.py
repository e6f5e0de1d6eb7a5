"""Newton's method for the switching times of time-optimal linear motions; this source is compiled.

Motions are given as in :mod:`satsym.solvers.batch.switching.planes`. Switching times are counted backwards from the
final time, one control after the other.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.solvers.batch.switching.planes import add, at, product, put, solved

Array = NDArray[np.float64]
Places = NDArray[np.int64]

CORRECTIONS = 30

FIRST_LENGTH = 1e-3
"""Initial length, as a fraction of the duration, of an arc that is added if the signs show one arc too few."""

SETTLED_STEP, DIVERGED_STEP = 1e-11, 1e6
"""Relative size of a correction after which one more correction follows as the last, and of one that has diverged."""


def switches_of(
    costate: Array, rates: Array, powers: Array, length: float, duration: float, times: Array, controls: Places
) -> int:
    """Write the times at which switching functions change sign, control by control; return their number, or -1.

    -1 means that there are more sign changes than `times` can hold.
    """
    n, count = len(costate), 0
    for c in range(rates.shape[1] - n - 1):
        before = 0.0
        for k in range(len(powers)):
            now = 0.0
            for i in range(n):
                for j in range(n):
                    now += costate[i] * powers[k, i, j] * rates[j, n + c]
            if k and before * now < 0.0:
                time = length * (k - 1 + before / (before - now))
                if time < duration:
                    if count == len(times):
                        return -1
                    times[count], controls[count] = time, c
                    count += 1
            if k * length >= duration:
                break
            before = now
    return count


def last_levels(costate: Array, rates: Array, box: Array) -> Array:
    """Return the controls at the final time; if a switching function vanishes there, its derivatives decide."""
    n, m = len(costate), box.shape[1]
    found = np.zeros(m)
    column, following = np.zeros(n), np.zeros(n)
    for c in range(m):
        for i in range(n):
            column[i] = rates[i, n + c]
        for _ in range(n):
            sigma, size = 0.0, 0.0
            for i in range(n):
                sigma += costate[i] * column[i]
                size += abs(costate[i] * column[i])
            if abs(sigma) > 1e-12 * size:
                break
            for i in range(n):
                following[i] = product(column, rates[i])
            put(column, following)
        found[c] = box[0, c] if sigma > 0.0 else box[1, c]
    return found


def outermost(costate: Array, rates: Array, table: Array) -> float:
    """Return the magnitude of the first control's switching function at one end of the motion."""
    found = 0.0
    for i in range(len(costate)):
        for j in range(len(costate)):
            found += costate[i] * table[i, j] * rates[j, len(costate)]
    return abs(found)


def missing(costate: Array, rates: Array, powers: Array, whole: Array, times: Array, count: int, final: Array) -> int:
    """Add a switching time near the end where the switching function of a single control is smaller.

    Return the number.
    """
    if outermost(costate, rates, powers[0]) < outermost(costate, rates, whole):
        for s in range(count, 0, -1):
            times[s] = times[s - 1]
        times[0], final[0] = FIRST_LENGTH, -1.0
    else:
        times[count] = 1.0 - FIRST_LENGTH
    return count + 1


def slopes(table: Array, rates: Array, column: int) -> Array:
    """Return the effect of a control impulse on the final state, and its derivative in the time to go, shape (2, n)."""
    n = len(table)
    found = np.zeros((2, n))
    for i in range(n):
        for j in range(n):
            found[0, i] += table[i, j] * rates[j, column]
            for k in range(n):
                found[1, i] += table[i, j] * rates[j, k] * rates[k, column]
    return found


def begun(rates: Array, x: Array, u: Array) -> Array:
    """Return the time derivatives of the states, shape (n,)."""
    n = len(x)
    found = np.zeros(n)
    for i in range(n):
        found[i] = rates[i, n + len(u)]
        for c in range(len(u)):
            found[i] += rates[i, n + c] * u[c]
        for j in range(n):
            found[i] += rates[i, j] * x[j]
    return found


def equations(
    matrix: Array,
    right: Array,
    costate: Array,
    duration: float,
    rates: Array,
    powers: Array,
    length: float,
    x: Array,
    end: Array,
    box: Array,
    final: Array,
    times: Array,
    controls: Places,
) -> None:
    """Set up Newton's equations for switching times, costates and duration, with times in units of the duration.

    The conditions are that the final state is reached, that each switching function vanishes at its switching times,
    and that the norm of the costates is unchanged.
    """
    n, count, m = len(x), len(times), len(final)
    whole, level = at(rates, powers, length, duration), np.zeros(m)
    put(level, final)
    for i in range(len(right)):
        right[i] = 0.0
        for j in range(len(right)):
            matrix[i, j] = 0.0
    for s in range(count):
        c, table = controls[s], at(rates, powers, length, times[s])
        jump = 2.0 * level[c] - box[0, c] - box[1, c]
        level[c] -= jump
        by = slopes(table, rates, n + c)
        for i in range(n):
            right[i] -= jump * table[i, n + c]
            matrix[i, s] = jump * by[0, i] * duration
            matrix[n + s, count + i] = by[0, i]
            right[n + s] -= costate[i] * by[0, i]
            matrix[n + s, s] += costate[i] * by[1, i] * duration
    rate = begun(rates, x, level)
    for i in range(n):
        right[i] += end[i] - whole[i, n + m]
        for c in range(m):
            right[i] -= level[c] * whole[i, n + c]
        for j in range(n):
            right[i] -= whole[i, j] * x[j]
            matrix[i, count + n] += whole[i, j] * rate[j] * duration
        matrix[n + count, count + i] = costate[i]
    for i in range(len(right)):
        largest = 0.0
        for j in range(len(right)):
            largest = max(largest, abs(matrix[i, j]))
        for j in range(len(right)):
            matrix[i, j] /= max(largest, 1e-300)
        right[i] /= max(largest, 1e-300)


def shrunk(share: float, now: float, change: float) -> float:
    """Return the largest fraction of a correction that leaves at least a quarter of a positive quantity."""
    return min(share, -0.75 * now / change) if now + change < 0.25 * now else share


def room(times: Array, controls: Places, duration: float, change: Array, longer: float) -> float:
    """Return the largest fraction of a correction for which every arc keeps at least a quarter of its length."""
    share, count = shrunk(1.0, duration, longer), len(times)
    for s in range(count):
        after_another = s > 0 and controls[s - 1] == controls[s]
        begin, moved = (times[s - 1], change[s - 1]) if after_another else (0.0, 0.0)
        share = shrunk(share, times[s] - begin, change[s] - moved)
        if s == count - 1 or controls[s + 1] != controls[s]:
            share = shrunk(share, duration - times[s], longer - change[s])
    return share


def magnitude(values: Array) -> float:
    """Return the largest magnitude; NaN if one value is NaN."""
    found = 0.0
    for value in values:
        if found == found and not abs(value) <= found:
            found = abs(value)
    return found


def scaled(values: Array, unit: float) -> None:
    """Divide values by a unit, in place."""
    for i in range(len(values)):
        values[i] /= unit


def exact(
    costate: Array,
    duration: float,
    rates: Array,
    powers: Array,
    length: float,
    x: Array,
    end: Array,
    box: Array,
    times: Array,
    controls: Places,
) -> tuple[int, float]:
    """Compute switching times and final costates, in place, and the duration by Newton's method.

    Returns
    -------
    tuple
        Number of switching times, -1 if the method fails; and the duration.
    """
    n, m = len(x), box.shape[1]
    count = switches_of(costate, rates, powers, length, duration, times, controls)
    side = np.zeros(m)
    for c in range(m):
        side[c] = 1.0
    if count == n - 2 and m == 1:
        count = missing(costate, rates, powers, at(rates, powers, length, duration), times, count, side)
        times[0 if side[0] < 0.0 else count - 1] *= duration
        for s in range(count):
            controls[s] = 0
    if count < n - 1:
        return -1, duration
    final, settled = last_levels(costate, rates, box), False
    for c in range(m):
        final[c] = final[c] if side[c] > 0.0 else box[0, c] + box[1, c] - final[c]
    scaled(costate, magnitude(costate))
    matrix, right = np.zeros((count + n + 1, count + n + 1)), np.zeros(count + n + 1)
    change = np.zeros(count)
    own, which = times[:count], controls[:count]
    for _ in range(CORRECTIONS):
        equations(matrix, right, costate, duration, rates, powers, length, x, end, box, final, own, which)
        if not solved(matrix, right):
            return -1, duration
        size = magnitude(right)
        if not size <= DIVERGED_STEP:
            return -1, duration
        for s in range(count):
            change[s] = right[s] * duration
        longer = right[count + n] * duration
        share = room(own, which, duration, change, longer)
        add(own, share, change)
        add(costate, share, right[count : count + n])
        duration += share * longer
        if duration > length * (len(powers) - 1):
            return -1, duration
        if settled:
            break
        settled = share == 1.0 and size <= SETTLED_STEP
    falling = product(costate, begun(rates, end, final))
    if not settled or not falling < 0.0:  # else it is the last moment at which the end is reached, not the first
        return -1, duration
    scaled(costate, -falling)
    return count, duration
