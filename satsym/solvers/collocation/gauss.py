"""Gauss collocation schemes: s stages, order 2s, symplectic.

Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from satsym.arrays import Array

STAGES = 5
"""Number of stages of the collocation equations, which gives order 10 at the nodes of a mesh."""


@dataclass(frozen=True, eq=False)
class Scheme:
    """Tables of a scheme with s stages on [0, 1]."""

    nodes: Array
    weights: Array
    """Gauss points and weights, shape (s,)."""
    matrix: Array
    inverse: Array
    """Integrals of the Lagrange polynomials up to each node, shape (s, s), and the inverse of this matrix."""
    end: Array
    """``weights @ inverse``: factors from differences at the stages to the difference at the end."""
    coefficients: Array
    """Matrix from values at 0 and at the stages to Legendre coefficients on [-1, 1], shape (s + 1, s + 1)."""
    known: Array
    """Points at which values are known: 0 and the stages, shape (s + 1,)."""
    barycentric: Array
    """Weights of Lagrange's formula through 0 and the stages, shape (s + 1,)."""


@lru_cache
def interpolation(stages: int, onto: int) -> Array:
    """Return the matrix from values at 0 and at the stages to values at another scheme's stages, (onto, stages + 1)."""
    return lagrange(stages, scheme(onto).nodes)


def lagrange(stages: int, places: Array) -> Array:
    """Return the matrix from values at 0 and at the stages to values at points in [0, 1], shape (M, stages + 1).

    It uses the second barycentric formula (Berrut and Trefethen, Barycentric Lagrange Interpolation, 2004).
    """
    table, total = barycentric(stages, places)
    table /= total
    return np.ascontiguousarray(table.T)


def barycentric(stages: int, places: Array) -> tuple[Array, Array]:
    """Return transposed weights of :func:`lagrange` before division, (stages + 1, M), and the divisors, (M,)."""
    own = scheme(stages)
    table: Array = places - own.known[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        np.divide(own.barycentric[:, None], table, out=table)
        total = np.ones(stages + 1) @ table
    at = np.flatnonzero(np.isinf(total))  # a place at which the value is known
    table[:, at], total[at] = np.isinf(table[:, at]), 1.0
    return table, total


@lru_cache
def scheme(stages: int) -> Scheme:
    """Return the Gauss scheme with the given number of stages."""
    x, w = legendre.leggauss(stages)
    to_coefficients = np.linalg.inv(legendre.legvander(x, stages - 1))
    integrals = [legendre.legval(x, legendre.legint(unit, lbnd=-1)) for unit in np.eye(stages)]
    matrix = np.array(integrals).T @ to_coefficients / 2
    inverse = np.linalg.inv(matrix)
    with_start = np.concatenate([[-1.0], x])
    distances = with_start[:, None] - with_start + np.eye(stages + 1)
    return Scheme(
        nodes=(x + 1) / 2,
        weights=w / 2,
        matrix=matrix,
        inverse=inverse,
        end=w / 2 @ inverse,
        coefficients=np.linalg.inv(legendre.legvander(with_start, stages)),
        known=(with_start + 1) / 2,
        barycentric=1.0 / distances.prod(axis=1),
    )
