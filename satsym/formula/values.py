"""Values of formulas over derived and printed expressions: scalars of either engine, matrices, equations."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Generic, TypeAlias, TypeVar

from satsym.status import BadInput

S = TypeVar("S")


@dataclass(frozen=True)
class Matrix(Generic[S]):
    """A matrix as rows of scalars."""

    rows: tuple[tuple[S, ...], ...]

    @classmethod
    def of(cls, rows: int, columns: int, entry: Callable[[int, int], S]) -> Matrix[S]:
        """Return the matrix whose entries a function gives for row and column, counted from zero."""
        return cls(tuple(tuple(entry(i, j) for j in range(columns)) for i in range(rows)))

    @property
    def shape(self) -> tuple[int, int]:
        """Return the numbers of rows and columns."""
        return len(self.rows), len(self.rows[0]) if self.rows else 0

    @property
    def entries(self) -> list[S]:
        """Return all entries of the matrix, row by row."""
        return [entry for row in self.rows for entry in row]

    def mapped(self, function: Callable[[S], S]) -> Matrix[S]:
        """Return the matrix with a function applied to each entry."""
        return Matrix(tuple(tuple(map(function, row)) for row in self.rows))


@dataclass(frozen=True)
class Relation(Generic[S]):
    """An equation between scalars."""

    lhs: S
    rhs: S


@dataclass(frozen=True)
class Roots(Generic[S]):
    """The eigenvalues of a matrix, without an order."""

    of: Matrix[S]


@dataclass(frozen=True)
class Kernel(Generic[S]):
    """The null space of a matrix, whatever basis is chosen for it."""

    of: Matrix[S]


Value: TypeAlias = Any
"""The value of a formula: a scalar, a :class:`Matrix`, a :class:`Relation`, :class:`Roots` or a :class:`Kernel`."""


@dataclass(frozen=True)
class Sources(Generic[S]):
    """The sources of values: names, addresses of derived expressions, and printed rows.

    ``symbol`` gives our symbol for a name by which something is differentiated, or which is replaced.
    """

    name: Callable[[str], S]
    address: Callable[[str], Value]
    row: Callable[[str], Value]
    symbol: Callable[[str], str] = str
    rates: Callable[[], Mapping[str, str]] = dict
    """A function that maps states and costates to the names of their rates."""


def without(matrix: Matrix[S], i: int, j: int) -> Matrix[S]:
    """Return the matrix without a row and a column, counted from zero."""
    return Matrix(
        tuple(tuple(entry for k, entry in enumerate(row) if k != j) for h, row in enumerate(matrix.rows) if h != i)
    )


def stacked(matrices: Sequence[Matrix[S]], beside: bool) -> Matrix[S]:
    """Place matrices beside or below each other."""
    if len({matrix.shape[0 if beside else 1] for matrix in matrices}) > 1:
        raise BadInput("the matrices that form a block matrix differ in size")
    if beside:
        return transposed(stacked(list(map(transposed, matrices)), beside=False))
    return Matrix(tuple(row for matrix in matrices for row in matrix.rows))


def transposed(matrix: Matrix[S]) -> Matrix[S]:
    """Return the transposed matrix."""
    return Matrix(tuple(zip(*matrix.rows, strict=True)))


def plain(value: Value) -> Any:
    """Return the value, which must be a scalar."""
    if isinstance(value, Matrix | Roots | Kernel):
        raise BadInput("a matrix is given where an expression is needed")
    return value


def square(matrix: Matrix[S]) -> int:
    """Return the number of rows of a square matrix."""
    if matrix.shape[0] != matrix.shape[1]:
        raise BadInput(f"a {size_of(matrix)} matrix is given where a square matrix is needed")
    return matrix.shape[0]


def size_of(matrix: Matrix[S]) -> str:
    """Write rows by columns for people."""
    return "{} by {}".format(*matrix.shape)
