"""The companion form: a chain of integrators with the characteristic polynomial in its last row."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import sympy as sp
from sympy.polys.matrices import DomainMatrix

from satsym.symbolic.analysis.field import exact
from satsym.symbolic.analysis.spectrum import Spectrum


@dataclass(frozen=True)
class CompanionForm:
    """A basis in which one input drives a chain of integrators: T^-1 A T = matrix, T^-1 b = the last unit vector."""

    matrix: sp.ImmutableMatrix
    """The companion matrix of the characteristic polynomial."""
    basis: sp.ImmutableMatrix
    """T."""


def companion_matrix(coefficients: Sequence[sp.Expr]) -> sp.ImmutableMatrix:
    """The companion matrix of a monic polynomial, given highest power first: ones above the diagonal, then -a_k."""
    size = len(coefficients) - 1
    last = [-c for c in reversed(list(coefficients)[1:])]
    return sp.ImmutableMatrix(size, size, lambda i, j: last[j] if i == size - 1 else sp.Integer(int(j == i + 1)))


def companion_form(of: Spectrum, b: sp.MatrixBase) -> CompanionForm | None:
    """The companion form for one input; ``None`` if the input does not reach everything.

    Parameters
    ----------
    of
        A, with its spectrum.
    b
        The input's column, shape (n, 1).
    """
    a = of.field.matrix(of.matrix)
    field, (matrix, column, row) = exact(a, b, sp.Matrix([of.coefficients]))
    columns = [column]  # from the last one to the first: b, A b + a_1 b, A (A b + a_1 b) + a_2 b, ...
    for coefficient in row.to_list()[0][1:-1]:
        columns.append(matrix * columns[-1] + column * coefficient)
    basis = DomainMatrix.hstack(*reversed(columns))
    if basis.rank() < a.rows:
        return None
    return CompanionForm(companion_matrix(of.coefficients), field.matrix(basis))
