"""Controllability and observability: ranks, uncontrollable and unobservable modes, and Kalman's decomposition.

Observability is controllability of the transposed system; only the names change.
"""

from __future__ import annotations

from dataclasses import dataclass

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from satsym.symbolic.analysis.components import eigenvector, images, whole, without_common_factor
from satsym.symbolic.analysis.field import Field, certain_rank, exact
from satsym.symbolic.analysis.spectrum import LAMBDA, Factor, Spectrum, polynomial_of, spectrum


@dataclass(frozen=True)
class Mode:
    """A mode of a linear system that is uncontrollable, or unobservable."""

    eigenvalue: sp.Expr
    """Eigenvalue of the mode."""
    vector: sp.ImmutableMatrix
    """For an uncontrollable mode, w with w'A = eigenvalue w' and w'B = 0; for an unobservable one, v with A v =
    eigenvalue v and C v = 0."""


@dataclass(frozen=True)
class KalmanForm:
    """A change of basis, x = basis z, that separates the controllable or observable subspace from the rest."""

    basis: sp.ImmutableMatrix
    """The matrix T of the change of basis."""
    state: sp.ImmutableMatrix
    port: sp.ImmutableMatrix
    """The matrices T^-1 A T, and T^-1 B or C T; the first ``rank`` coordinates are controllable, or observable."""


@dataclass(frozen=True)
class Reach:
    """The controllability of a linear system by some inputs, or its observability by some outputs."""

    matrix: sp.ImmutableMatrix
    """The Kalman matrix [B, AB, A^2 B, ...] or [C; CA; CA^2; ...]."""
    rank: int
    """Rank of the matrix."""
    assumed: tuple[sp.Expr, ...]
    """Expressions that must not vanish for the matrix to have this rank, as far as that could not be decided."""
    pbh: tuple[tuple[sp.Expr, int], ...]
    """For each distinct eigenvalue (or irreducible polynomial without closed-form roots) the rank of [s I - A, B], or
    of s I - A above C (Popov, Belevitch, Hautus)."""
    lost: tuple[Mode, ...]
    """Uncontrollable, or unobservable, modes whose eigenvalues have closed forms."""
    kalman: KalmanForm | None
    """The Kalman decomposition if the rank is not full, otherwise ``None``."""

    @property
    def full(self) -> bool:
        """Tell whether the rank is full."""
        return self.kalman is None


def controllability(of: Spectrum, b: sp.MatrixBase) -> Reach:
    """Analyse the controllability of x' = A x + B u.

    Parameters
    ----------
    of
        A, with its spectrum.
    b
        B, shape (n, m).
    """
    return _reach(of.field.matrix(of.matrix), of.factors, sp.ImmutableMatrix(b))


def observability(of: Spectrum, c: sp.MatrixBase) -> Reach:
    """Analyse the observability of x' = A x from outputs y = C x.

    Parameters
    ----------
    of
        A, with its spectrum.
    c
        C, shape (number of outputs, n).
    """
    dual = _reach(of.field.matrix(of.matrix).T, of.factors, sp.ImmutableMatrix(c).T)
    kalman = dual.kalman
    if kalman:
        kalman = KalmanForm(sp.ImmutableMatrix(kalman.basis.inv().T), kalman.state.T, kalman.port.T)
    return Reach(dual.matrix.T, dual.rank, dual.assumed, dual.pbh, dual.lost, kalman)


def _reach(a: sp.ImmutableMatrix, factors: tuple[Factor, ...], b: sp.ImmutableMatrix) -> Reach:
    coefficients = [sp.Matrix([f.coefficients]) for f in factors]
    field, (matrix, port, *rows) = exact(a, b, *coefficients)
    columns = _krylov(matrix, port, matrix.shape[0])
    size = matrix.shape[0]
    rank, assumed = certain_rank(field.matrix(columns))
    return Reach(
        field.matrix(columns),
        rank,
        assumed,
        tuple(entry for f, row in zip(factors, rows, strict=True) for entry in _pbh(field, matrix, port, f, row)),
        () if rank == size else _lost(field, matrix, columns),
        None if rank == size else _kalman(field, matrix, port, columns),
    )


def _krylov(matrix: DomainMatrix, port: DomainMatrix, count: int) -> DomainMatrix:
    """Return the list [B, AB, A^2 B, ...] of ``count`` matrices."""
    return DomainMatrix.hstack(*images(matrix, port, count))


def _pbh(
    field: Field, matrix: DomainMatrix, port: DomainMatrix, factor: Factor, coefficients: DomainMatrix
) -> list[tuple[sp.Expr, int]]:
    """Return the rank of the Popov-Belevitch-Hautus matrix at the roots of a factor f of the characteristic polynomial.

    The rank is smaller than n by the dimension of the left null space of f(A), B, AB, ..., divided by the degree of f.
    """
    f = field.polynomial(coefficients.to_list()[0], LAMBDA)
    stacked = DomainMatrix.hstack(field.at(f, matrix), _krylov(matrix, port, factor.degree))
    size = matrix.shape[0]
    rank = size - (size - stacked.rank()) // factor.degree
    return [(root, rank) for root in factor.roots or (polynomial_of(factor.coefficients, LAMBDA),)]


def _lost(field: Field, matrix: DomainMatrix, columns: DomainMatrix) -> tuple[Mode, ...]:
    """Return the eigenvectors of A' that are perpendicular to all columns, for eigenvalues with a closed form."""
    left, pivots = columns.transpose().nullspace().rref()
    everything, dual = list(range(left.shape[0])), matrix.transpose()
    within = (left * matrix).extract(everything, list(pivots))  # A', as it acts on them
    found = []
    for factor in spectrum(field.matrix(within)).factors:
        roots = [root for root in factor.roots if not root.has(sp.CRootOf)]
        f = field.polynomial(map(field.element, factor.coefficients), LAMBDA)
        combinations = field.at(f, within).transpose().nullspace() if roots else left.extract([], everything)
        starts: list[DomainMatrix] = []
        spanned: list[DomainMatrix] = []
        for k in range(combinations.shape[0]):
            start = whole(field, (combinations.extract([k], everything) * left).transpose())
            more = images(dual, start, factor.degree)
            if DomainMatrix.hstack(*spanned, *more).rank() == len(spanned) + len(more):
                spanned += more
                starts.append(start)
        for root in roots:
            for start in starts:
                found += [Mode(root, v) for v in without_common_factor([eigenvector(field, factor, root, dual, start)])]
    return tuple(found)


def _kalman(field: Field, matrix: DomainMatrix, port: DomainMatrix, columns: DomainMatrix) -> KalmanForm:
    """Transform a system to a basis of the given independent columns, completed by unit vectors."""
    size = matrix.shape[0]
    whole_space = DomainMatrix.hstack(columns, DomainMatrix.eye(size, field.domain).to_dense())
    _, pivots = whole_space.rref()
    basis = whole_space.extract(list(range(size)), list(pivots))
    inverse = basis.inv()
    return KalmanForm(field.matrix(basis), field.matrix(inverse * matrix * basis), field.matrix(inverse * port))


@dataclass(frozen=True)
class LinearSystem:
    """A linear system x' = A x + B u, y = C x + D u, with the names of its variables."""

    a: sp.ImmutableMatrix
    b: sp.ImmutableMatrix
    c: sp.ImmutableMatrix
    d: sp.ImmutableMatrix
    """The matrices, shapes (n, n), (n, m), (number of outputs, n) and (number of outputs, m)."""
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    """Names of states, inputs and outputs, in order."""

    def __post_init__(self) -> None:
        n, m, k = len(self.states), len(self.inputs), len(self.outputs)
        shapes = [self.a.shape, self.b.shape, self.c.shape, self.d.shape]
        if not n or shapes != [(n, n), (n, m), (k, n), (k, m)]:
            raise ValueError(f"a linear system with {n} states, {m} inputs and {k} outputs has no matrices {shapes}")


def linear_system(a: sp.MatrixBase, b: sp.MatrixBase | None = None, c: sp.MatrixBase | None = None) -> LinearSystem:
    """Build a linear system from its matrices, with names x1, x2, ..., u1, ... and y1, ...

    Matrices that are left out are empty.
    """
    a = sp.ImmutableMatrix(a)
    b = sp.ImmutableMatrix(sp.zeros(a.rows, 0) if b is None else b)
    c = sp.ImmutableMatrix(sp.zeros(0, a.rows) if c is None else c)
    names = [tuple(f"{letter}{k + 1}" for k in range(n)) for letter, n in (("x", a.rows), ("u", b.cols), ("y", c.rows))]
    return LinearSystem(a, b, c, sp.ImmutableMatrix(sp.zeros(c.rows, b.cols)), *names)
