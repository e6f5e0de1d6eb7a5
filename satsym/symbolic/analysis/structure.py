"""What inputs reach and what outputs show: ranks, modes that are out of reach, and Kalman's form.

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
    """A mode that no input reaches, or no output shows."""

    eigenvalue: sp.Expr
    """Eigenvalue of the mode."""
    vector: sp.ImmutableMatrix
    """Out of reach: w with w'A = eigenvalue w' and w'B = 0, so that w'x goes its own way. Out of sight: v with A v =
    eigenvalue v and C v = 0, so that no output shows a motion along v."""


@dataclass(frozen=True)
class KalmanForm:
    """A change of basis, x = basis z, that separates what is reached, or shown, from what is not."""

    basis: sp.ImmutableMatrix
    """T."""
    state: sp.ImmutableMatrix
    port: sp.ImmutableMatrix
    """T^-1 A T, and T^-1 B or C T. The first ``rank`` coordinates are those reached, or shown."""


@dataclass(frozen=True)
class Reach:
    """Controllability by some inputs, or observability by some outputs."""

    matrix: sp.ImmutableMatrix
    """[B, AB, A^2 B, ...] or [C; CA; CA^2; ...]."""
    rank: int
    """Rank of the matrix."""
    assumed: tuple[sp.Expr, ...]
    """What must not vanish for the rank to be that, where this is not certain."""
    pbh: tuple[tuple[sp.Expr, int], ...]
    """For each distinct eigenvalue (or, where it has no closed form, its irreducible polynomial): the rank of [s I - A,
    B], or of s I - A above C, there (Popov, Belevitch, Hautus)."""
    lost: tuple[Mode, ...]
    """Modes out of reach, or out of sight, as far as their eigenvalues have closed forms."""
    kalman: KalmanForm | None
    """Kalman's form where the rank is not full."""

    @property
    def full(self) -> bool:
        """Whether the rank is full."""
        return self.kalman is None


def controllability(of: Spectrum, b: sp.MatrixBase) -> Reach:
    """What the inputs of x' = A x + B u reach.

    Parameters
    ----------
    of
        A, with its spectrum.
    b
        B, shape (n, m).
    """
    return _reach(of.field.matrix(of.matrix), of.factors, sp.ImmutableMatrix(b))


def observability(of: Spectrum, c: sp.MatrixBase) -> Reach:
    """What the outputs y = C x of x' = A x show.

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
    """[B, AB, A^2 B, ...], ``count`` times."""
    return DomainMatrix.hstack(*images(matrix, port, count))


def _pbh(
    field: Field, matrix: DomainMatrix, port: DomainMatrix, factor: Factor, coefficients: DomainMatrix
) -> list[tuple[sp.Expr, int]]:
    """The rank at the roots of a factor f: it falls by the left null vectors of f(A), B, AB, ... over the degree."""
    f = field.polynomial(coefficients.to_list()[0], LAMBDA)
    stacked = DomainMatrix.hstack(field.at(f, matrix), _krylov(matrix, port, factor.degree))
    size = matrix.shape[0]
    rank = size - (size - stacked.rank()) // factor.degree
    return [(root, rank) for root in factor.roots or (polynomial_of(factor.coefficients, LAMBDA),)]


def _lost(field: Field, matrix: DomainMatrix, columns: DomainMatrix) -> tuple[Mode, ...]:
    """Eigenvectors of A' to which all columns are perpendicular, for eigenvalues with a closed form."""
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
    """In a basis of independent columns, filled up with unit vectors."""
    size = matrix.shape[0]
    whole_space = DomainMatrix.hstack(columns, DomainMatrix.eye(size, field.domain).to_dense())
    _, pivots = whole_space.rref()
    basis = whole_space.extract(list(range(size)), list(pivots))
    inverse = basis.inv()
    return KalmanForm(field.matrix(basis), field.matrix(inverse * matrix * basis), field.matrix(inverse * port))


@dataclass(frozen=True)
class LinearSystem:
    """x' = A x + B u, y = C x + D u."""

    a: sp.ImmutableMatrix
    b: sp.ImmutableMatrix
    c: sp.ImmutableMatrix
    d: sp.ImmutableMatrix
    """Shapes (n, n), (n, m), (number of outputs, n), (number of outputs, m)."""
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    """Names, in order."""

    def __post_init__(self) -> None:
        n, m, k = len(self.states), len(self.inputs), len(self.outputs)
        shapes = [self.a.shape, self.b.shape, self.c.shape, self.d.shape]
        if not n or shapes != [(n, n), (n, m), (k, n), (k, m)]:
            raise ValueError(f"a linear system with {n} states, {m} inputs and {k} outputs has no matrices {shapes}")


def linear_system(a: sp.MatrixBase, b: sp.MatrixBase | None = None, c: sp.MatrixBase | None = None) -> LinearSystem:
    """A system from its matrices alone, named x1, x2, ..., u1, ... and y1, ...; what is left out is empty."""
    a = sp.ImmutableMatrix(a)
    b = sp.ImmutableMatrix(sp.zeros(a.rows, 0) if b is None else b)
    c = sp.ImmutableMatrix(sp.zeros(0, a.rows) if c is None else c)
    names = [tuple(f"{letter}{k + 1}" for k in range(n)) for letter, n in (("x", a.rows), ("u", b.cols), ("y", c.rows))]
    return LinearSystem(a, b, c, sp.ImmutableMatrix(sp.zeros(c.rows, b.cols)), *names)
