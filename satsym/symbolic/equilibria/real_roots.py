"""All real solutions of polynomial equations with rational coefficients: counted exactly, found in floats.

A Groebner basis gives the finite algebra of polynomials modulo the equations; the number of distinct real solutions is
the signature of its trace form (Hermite), the number of complex ones its rank; the eigenvectors of multiplication by a
generic linear form hold the solutions (Stickelberger).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
import sympy as sp
from sympy.polys.groebnertools import groebner
from sympy.polys.orderings import grevlex
from sympy.polys.rings import ring

from satsym.arrays import Array

Monomial: TypeAlias = tuple[int, ...]

REAL = 1e-6
"""Size of an imaginary part below which a root counts as real, because rounding may have caused it."""
POLISHING = 8
ROOT_TOLERANCE = 1e-7


@dataclass(frozen=True, eq=False)
class Solutions:
    """The real solutions of polynomial equations.

    Attributes
    ----------
    dimension
        Of the set of complex solutions: 0 where they are finitely many, -1 where there is none.
    real, complex
        Numbers of distinct solutions, exactly; ``None`` where they are not finitely many.
    points
        Floats, shape (found, n); as many as `real` unless solutions nearly coincide.
    """

    dimension: int
    real: int | None
    complex: int | None
    points: Array


def solve(equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol]) -> Solutions:
    """Solve polynomial equations with rational coefficients."""
    domain, basis = _basis(equations, unknowns, sp.QQ)
    leading = [g.LM for g in basis]
    size, none = len(unknowns), np.zeros((0, len(unknowns)))
    if any(sum(m) == 0 for m in leading):
        return Solutions(-1, 0, 0, none)
    dimension = _dimension(leading, size)
    if dimension:
        return Solutions(dimension, None, None, none)
    monomials = _below(leading, size)
    matrices = [_multiplication(domain, basis, monomials, k) for k in range(size)]
    real, rank = _signature(_trace_form(monomials, matrices))
    points = _newton(equations, unknowns)(_points([m.astype(float) for m in matrices]))
    return Solutions(0, real, rank, points)


def family(
    equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol], parameter: sp.Symbol
) -> Callable[[float], Array] | None:
    """Return a function that finds the real solutions, in floats, at any value of a parameter.

    One Groebner basis serves all but finitely many values. ``None`` where there are infinitely many solutions for all
    values.
    """
    domain, basis = _basis(equations, unknowns, sp.QQ.frac_field(parameter))
    leading = [g.LM for g in basis]
    if _dimension(leading, len(unknowns)):
        return None
    monomials = _below(leading, len(unknowns))
    matrices = [_multiplication(domain, basis, monomials, k) for k in range(len(unknowns))]
    entries = [domain.domain.to_sympy(domain.domain.convert(e)) for m in matrices for e in m.ravel()]
    values = sp.lambdify(parameter, entries, "math")
    shape = (len(unknowns), len(monomials), len(monomials))
    polish = _newton(equations, [*unknowns, parameter])

    def solutions(value: float) -> Array:
        return polish(_points(list(np.array(values(value), float).reshape(shape))), value)

    return solutions


def _basis(equations: Sequence[sp.Expr], unknowns: Sequence[sp.Symbol], field: Any) -> tuple[Any, Any]:
    """Return a reduced Groebner basis of polynomials over a field, and the ring of the polynomials."""
    domain, *_ = ring(list(unknowns), field, grevlex)
    whole = [sp.expand(e) for e in equations]
    return domain, groebner([domain.from_expr(e) for e in whole if e != 0], domain)


def _dimension(leading: Sequence[Monomial], size: int) -> int:
    """Return the largest number of unknowns of which no leading monomial is made alone."""
    free = [0]
    for chosen in range(1, 2**size):
        if not any(all(chosen >> k & 1 or not e for k, e in enumerate(m)) for m in leading):
            free.append(chosen.bit_count())
    return max(free)


def _below(leading: Sequence[Monomial], size: int) -> list[Monomial]:
    """Return a basis of the algebra: the monomials that no leading monomial divides, by rising degree."""
    found, front = [], [(0,) * size]
    while front:
        front = [m for m in front if not any(all(a >= b for a, b in zip(m, lead, strict=True)) for lead in leading)]
        found += front
        front = sorted({(*m[:k], m[k] + 1, *m[k + 1 :]) for m in front for k in range(size)})
    return found


def _multiplication(domain: Any, basis: Any, monomials: Sequence[Monomial], by: int) -> Any:
    """Return the matrix of multiplication by an unknown, in the basis of monomials."""
    place = {m: k for k, m in enumerate(monomials)}
    zero, one = domain.domain.zero, domain.domain.one
    matrix = np.full((len(monomials), len(monomials)), zero, dtype=object)
    for column, m in enumerate(monomials):
        product = (*m[:by], m[by] + 1, *m[by + 1 :])
        if product in place:
            matrix[place[product], column] = one
            continue
        for monomial, coefficient in domain({product: one}).rem(basis).terms():
            matrix[place[monomial], column] = coefficient
    return matrix


def _trace_form(monomials: Sequence[Monomial], matrices: Sequence[Any]) -> Any:
    """Return the traces of multiplication by the products of two monomials."""
    of = {monomials[0]: np.array([[sp.QQ(int(i == k)) for i in range(len(monomials))] for k in range(len(monomials))])}
    for m in monomials[1:]:
        k = next(k for k, e in enumerate(m) if e)
        of[m] = _product(of[(*m[:k], m[k] - 1, *m[k + 1 :])], matrices[k])
    traces = np.array([sum(of[m].diagonal(), sp.QQ(0)) for m in monomials], dtype=object)
    return np.array([traces.dot(of[m]) for m in monomials], dtype=object)


def _product(left: Any, right: Any) -> Any:
    """Multiply two matrices, the second of which is sparse: most products of basis monomials are monomials."""
    found = np.full(left.shape, sp.QQ(0), dtype=object)
    for column, (row, entry) in ((k, pair) for k in range(len(right)) for pair in enumerate(right[:, k]) if pair[1]):
        found[:, column] += left[:, row] if entry == 1 else left[:, row] * entry
    return found


def _signature(form: Any) -> tuple[int, int]:
    """Return signature and rank of a symmetric matrix, by exact symmetric elimination."""
    rest, signature, rank = form.copy(), 0, 0
    while len(rest):
        pivot = next((k for k in range(len(rest)) if rest[k, k]), None)
        if pivot is None:
            pairs = [(i, k) for i in range(len(rest)) for k in range(i) if rest[i, k]]
            if not pairs:
                break
            i, pivot = pairs[0]
            rest[pivot] = rest[pivot] + rest[i]
            rest[:, pivot] = rest[:, pivot] + rest[:, i]
        signature, rank = signature + (1 if rest[pivot, pivot] > 0 else -1), rank + 1
        kept = [k for k in range(len(rest)) if k != pivot]
        row = rest[pivot, kept] / rest[pivot, pivot]
        rest = rest[np.ix_(kept, kept)] - np.multiply.outer(rest[kept, pivot], row)
    return signature, rank


def _points(matrices: Sequence[Array]) -> Array:
    """Return nearly real solutions from the eigenvectors of a generic combination of multiplication matrices."""
    weights = np.random.default_rng(0).uniform(-1, 1, len(matrices))
    _, vectors = np.linalg.eig(sum(w * m for w, m in zip(weights, matrices, strict=True)).T)
    vectors = vectors / vectors[0]
    found = np.stack([m[:, 0] @ vectors for m in matrices], axis=1)
    return np.asarray(found[np.abs(found.imag).max(axis=1) < REAL].real)


def _newton(equations: Sequence[sp.Expr], symbols: Sequence[sp.Symbol]) -> Callable[..., Array]:
    """Refine points by Newton's method and merge those with the same limit; the last symbol may be given."""
    values = sp.lambdify(list(symbols), list(equations), "numpy")

    def polished(points: Array, *given: float) -> Array:
        unknowns = list(symbols)[: points.shape[1]]
        kept: list[Array] = []
        for point in points:
            for _ in range(POLISHING):
                jacobian = np.array(slopes(*point, *given), float)[:, : len(unknowns)]
                left = np.array(values(*point, *given), float)
                point = point - np.linalg.lstsq(jacobian, left, rcond=None)[0]
            if all(np.abs(point - other).max() > ROOT_TOLERANCE for other in kept):
                kept.append(point)
        return np.array(kept).reshape(-1, points.shape[1])

    slopes = sp.lambdify(list(symbols), sp.Matrix(list(equations)).jacobian(list(symbols)), "numpy")
    return polished
