"""Linear motions in steps, and planes that separate the reachable set from a given final state.

This source is compiled.

Every motion is x' = A x + B u + d with low <= u <= high, from x(0) to a given final state. ``rates`` contains A, B and
d side by side, shape (n, n + m + 1). ``powers`` contains the effect of k steps, shape (count + 1, n, n + m + 1): the
transition matrix, the effect of controls equal to one, and the effect of the drift. ``box`` has low and high as rows. A
plane is given by its normal, the costates at the final time: a final state is not reached if the whole reachable set
lies on the other side of the plane. The module imports only others that are compiled with it, and its functions also
run uncompiled. All loops run over numbers, because array expressions are no faster here and take much longer to
compile.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TERMS = 14
"""Number of terms of the exponential series, sufficient for steps of at most an eighth of the time scale."""

CORNERS = 80
"""Largest number of support points in the search for a plane."""

THERE = 1e-6
"""Distance of the final state from the reachable set, relative to the size of the set, below which it is zero."""

DIP = 0.02
"""Fraction of the second difference of a distance, below which its minimum between two steps counts as zero."""


def put(into: Array, values: Array) -> None:
    """Copy values into an array, row by row."""
    for i in range(len(into)):
        into[i] = values[i]


def add(into: Array, share: float, values: Array) -> None:
    """Add a multiple of values to an array, in place."""
    for i in range(len(into)):
        into[i] += share * values[i]


def product(one: Array, other: Array) -> float:
    """Return the scalar product of two vectors."""
    found = 0.0
    for i in range(len(one)):
        found += one[i] * other[i]
    return found


def solved(matrix: Array, right: Array) -> bool:
    """Solve linear equations in place of the right-hand side; return whether the matrix is regular."""
    count = len(right)
    for k in range(count):
        best = k
        for i in range(k + 1, count):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if not abs(matrix[best, k]) > 1e-13:
            return False
        for j in range(count):
            matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
        right[k], right[best] = right[best], right[k]
        for i in range(k + 1, count):
            share = matrix[i, k] / matrix[k, k]
            if share != 0.0:
                for j in range(k + 1, count):
                    matrix[i, j] -= share * matrix[k, j]
                right[i] -= share * right[k]
    for k in range(count - 1, -1, -1):
        for j in range(k + 1, count):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]
    return True


def after(rates: Array, start: Array, length: float) -> Array:
    """Return the effect of a motion prolonged by a short time, by the exponential series."""
    n, width = start.shape
    found, term, following = np.zeros((n, width)), np.zeros((n, width)), np.zeros((n, width))
    for i in range(n):
        put(found[i], start[i])
    for order in range(1, TERMS):
        largest = 0.0
        for i in range(n):
            for j in range(width):
                value = rates[i, j] if order == 1 and j >= n else 0.0
                for k in range(n):
                    value += rates[i, k] * (start[k, j] if order == 1 else term[k, j])
                following[i, j] = value * length / order
                found[i, j] += following[i, j]
                largest = max(largest, abs(following[i, j]))
        term, following = following, term
        if largest == 0.0:
            break
    return found


def powers_of(rates: Array, length: float, count: int) -> Array:
    """Return the effects of 0, 1, ... `count` steps."""
    n, width = rates.shape
    found = np.zeros((count + 1, n, width))
    for i in range(n):
        found[0, i, i] = 1.0
    one = after(rates, found[0], length)
    for step in range(count):
        for i in range(n):
            for j in range(width):
                value = one[i, j] if j >= n else 0.0
                for k in range(n):
                    value += one[i, k] * found[step, k, j]
                found[step + 1, i, j] = value
    return found


def at(rates: Array, powers: Array, length: float, time: float) -> Array:
    """Return the effect of the motion after any time."""
    step = min(int(time / length), len(powers) - 1)
    return after(rates, powers[step], time - step * length)


def passed(
    costate: Array, rates: Array, powers: Array, length: float, x: Array, end: Array, box: Array, since: float
) -> float:
    """Return the first time, not before `since`, at which a plane no longer separates the final state.

    The plane separates it from the reachable set before. The result is negative if this time is beyond all steps.
    """
    n, m = len(x), box.shape[1]
    first, gained, before, earlier = int(np.ceil(since / length - 1e-9)), 0.0, 0.0, 0.0
    sigma, pushed, goal = np.zeros(m), np.zeros(m), 0.0
    for i in range(n):
        goal += costate[i] * end[i]
    for k in range(len(powers)):
        table, value = powers[k], -goal
        for i in range(n):
            value += costate[i] * table[i, n + m]
            for j in range(n):
                value += costate[i] * table[i, j] * x[j]
        for c in range(m):
            push, now = 0.0, 0.0
            for i in range(n):
                push += costate[i] * table[i, n + c]
                for j in range(n):
                    now += costate[i] * table[i, j] * rates[j, n + c]
            if k:
                area = push - pushed[c]
                if sigma[c] * now < 0.0:
                    part = 0.5 * length * sigma[c] * sigma[c] / (sigma[c] - now)
                    gained += minimum(part, box[0, c], box[1, c]) + minimum(area - part, box[0, c], box[1, c])
                else:
                    gained += minimum(area, box[0, c], box[1, c])
            sigma[c], pushed[c] = now, push
        value += gained
        if k >= first and not value > 0.0:
            return max(since, length * (k - 1 + before / (before - value))) if before > 0.0 else since
        if k > first + 1 and earlier > before < value:  # it may be passed for a moment between two steps
            slope, curve = 0.5 * (value - earlier), value - 2.0 * before + earlier
            if before - 0.5 * slope * slope / curve <= DIP * curve:
                return max(since, length * (k - 1 - slope / curve))
        earlier, before = before, value
    return -1.0


def minimum(area: float, low: float, high: float) -> float:
    """Return the minimum of a control times the integral of its switching function."""
    return min(area * low, area * high)


def nearest(powers: Array, steps: int, x: Array, end: Array, box: Array, tight: float, found: Array) -> float:
    """Return the distance of the final state from the set reached in `steps`; the separating plane is put into `found`.

    Wolfe's minimum-norm-point algorithm is used, in coordinates in which the set is approximately a ball. The result is
    negative if the final state is not separated from the set.
    """
    n, m = len(x), box.shape[1]
    lower = rounding(powers, steps, box)
    if not lower[0, 0] > 0.0:
        return -1.0
    middle, moved, point, plane = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
    for i in range(n):
        middle[i] = powers[steps, i, n + m] - end[i]
        for j in range(n):
            middle[i] += powers[steps, i, j] * x[j]
        for c in range(m):
            middle[i] += 0.5 * (box[0, c] + box[1, c]) * powers[steps, i, n + c]
    corners, weights = np.zeros((n + 1, n)), np.zeros(n + 1)
    towards(lower, middle)
    put(point, middle)
    put(corners[0], middle)
    weights[0], held, best = 1.0, min(1, n), -np.inf
    for _ in range(CORNERS):
        size = np.sqrt(product(point, point))
        if size <= THERE:
            break
        for i in range(n - 1, -1, -1):  # the direction in the coordinates of states
            plane[i] = point[i]
            for j in range(i + 1, n):
                plane[i] -= lower[j, i] * plane[j]
            plane[i] /= lower[i, i]
        for i in range(n):
            moved[i] = 0.0
        for k in range(steps):
            for c in range(m):
                pushed = 0.0
                for i in range(n):
                    pushed += plane[i] * (powers[k + 1, i, n + c] - powers[k, i, n + c])
                half = 0.0 if pushed == 0.0 else 0.5 * (box[1, c] - box[0, c])
                half = -half if pushed > 0.0 else half
                for i in range(n):
                    moved[i] += half * (powers[k + 1, i, n + c] - powers[k, i, n + c])
        towards(lower, moved)
        add(moved, 1.0, middle)
        distance = product(point, moved) / size
        if distance > best:
            best = distance
            put(found, plane)
        if best >= (1.0 - tight) * size or size * (size - distance) <= 1e-13 * size * size:
            break
        held = joined(corners, weights, held, moved)
        if held < 0:
            break
        for i in range(n):
            point[i] = 0.0
        for k in range(held):
            add(point, weights[k], corners[k])
    return best


def rounding(powers: Array, steps: int, box: Array) -> Array:
    """Return the Cholesky factor of the second moments of the steps' effects.

    Zero if they do not span the state space.
    """
    n, m = powers.shape[1], box.shape[1]
    found = np.zeros((n, n))
    for k in range(steps):
        for c in range(m):
            width = 0.5 * (box[1, c] - box[0, c])
            for i in range(n):
                for j in range(i + 1):
                    one = powers[k + 1, i, n + c] - powers[k, i, n + c]
                    other = powers[k + 1, j, n + c] - powers[k, j, n + c]
                    found[i, j] += one * other * width * width * steps
    for i in range(n):
        for j in range(i + 1):
            value = found[i, j]
            for k in range(j):
                value -= found[i, k] * found[j, k]
            if i == j:
                if not value > 1e-18 * found[i, i]:
                    found[0, 0] = 0.0
                    return found
                found[i, i] = np.sqrt(value)
            else:
                found[i, j] = value / found[j, j]
    return found


def towards(lower: Array, point: Array) -> None:
    """Transform a point into the coordinates in which the set is approximately a ball, in place."""
    for i in range(len(point)):
        for j in range(i):
            point[i] -= lower[i, j] * point[j]
        point[i] /= lower[i, i]


def joined(corners: Array, weights: Array, held: int, new: Array) -> int:
    """Add a corner to a simplex and remove those that its nearest point does not need; return the number, or -1.

    -1 means that the linear equations are singular or that the simplex is full.
    """
    if held == len(corners):
        return -1
    put(corners[held], new)
    weights[held] = 0.0
    held += 1
    n = corners.shape[1]
    while True:
        matrix, right, wanted = np.zeros((held - 1, held - 1)), np.zeros(held - 1), np.zeros(held)
        wanted[0] = 1.0
        for i in range(held - 1):
            for j in range(held - 1):
                for k in range(n):
                    matrix[i, j] += (corners[i + 1, k] - corners[0, k]) * (corners[j + 1, k] - corners[0, k])
            for k in range(n):
                right[i] -= (corners[i + 1, k] - corners[0, k]) * corners[0, k]
        if not solved(matrix, right):
            return -1
        for i in range(held - 1):
            wanted[i + 1] = right[i]
            wanted[0] -= right[i]
        share, leaving = 1.0, -1
        for i in range(held):
            if wanted[i] <= 0.0 and weights[i] / max(weights[i] - wanted[i], 1e-300) <= share:
                share, leaving = weights[i] / max(weights[i] - wanted[i], 1e-300), i
        for i in range(held):
            weights[i] += share * (wanted[i] - weights[i])
        if leaving < 0:
            return held
        for i in range(leaving, held - 1):
            put(corners[i], corners[i + 1])
            weights[i] = weights[i + 1]
        held -= 1
