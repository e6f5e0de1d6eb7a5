"""Arithmetic with sums of two floats, for the few computations on orbits that double precision cannot resolve.

A number is a pair (head, tail) that stands for the sum, with a tail below half a unit in the last place of the head:
some 32 digits, for scalars and arrays alike. Sums and products of floats are exact (Dekker, A Floating-Point Technique
for Extending the Available Precision, Numerische Mathematik 18, 1971); quotients and roots are accurate up to the last
bits.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from satsym.arrays import Array

Pair: TypeAlias = tuple[Any, Any]

SPLITTER = 134217729.0
"""2^27 + 1: splits a float into two halves whose products are exact."""


def total(a: Any, b: Any) -> Pair:
    """Return the exact sum a + b of two floats as a pair."""
    head = a + b
    part = head - a
    return head, (a - (head - part)) + (b - part)


def product(a: Any, b: Any) -> Pair:
    """Return the exact product a b of two floats as a pair, unless it under- or overflows."""
    head = a * b
    a_high, a_low = _halves(a)
    b_high, b_low = _halves(b)
    return head, ((a_high * b_high - head) + a_high * b_low + a_low * b_high) + a_low * b_low


def add(x: Pair, y: Pair) -> Pair:
    """Return x + y of two pairs, also where they nearly cancel."""
    head, tail = total(x[0], y[0])
    low, lowest = total(x[1], y[1])
    head, tail = _joined(head, tail + low)
    return _joined(head, tail + lowest)


def negative(x: Pair) -> Pair:
    """Return -x of a pair."""
    return -x[0], -x[1]


def multiply(x: Pair, y: Pair) -> Pair:
    """Return the product x y of two pairs."""
    head, tail = product(x[0], y[0])
    return _joined(head, tail + (x[0] * y[1] + x[1] * y[0]))


def divide(x: Pair, y: Pair) -> Pair:
    """Return the quotient x / y of two pairs, by a first quotient and two corrections."""
    first = x[0] / y[0]
    left = add(x, negative(multiply(y, (first, np.zeros_like(first)))))
    second = left[0] / y[0]
    left = add(left, negative(multiply(y, (second, np.zeros_like(second)))))
    head, tail = _joined(first, second)
    return _joined(head, tail + left[0] / y[0])


def root(x: Pair) -> Pair:
    """Return the square root of a pair x > 0, by one step of Newton's method from the root of its head."""
    first = np.sqrt(x[0])
    left = add(x, negative(product(first, first)))
    return _joined(first, left[0] / (2.0 * first))


def dot(a: Array, b: Array) -> Pair:
    """Return the scalar product of vectors of floats as a pair, along the first axis."""
    found = product(a[0], b[0])
    for x, y in zip(a[1:], b[1:], strict=True):
        found = add(found, product(x, y))
    return found


def cross(a: Array, b: Array) -> Array:
    """Return the vector product of vectors of floats, shape (3, ...), each component rounded once."""
    rows = ((1, 2), (2, 0), (0, 1))
    return np.array([add(product(a[i], b[j]), negative(product(a[j], b[i])))[0] for i, j in rows])


def _halves(a: Any) -> Pair:
    shifted = SPLITTER * a
    high = shifted - (shifted - a)
    return high, a - high


def _joined(head: Any, tail: Any) -> Pair:
    """Join a larger and a smaller part to a pair with the same sum, whose parts do not overlap."""
    found = head + tail
    return found, tail - (found - head)
