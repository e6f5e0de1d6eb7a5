"""Eigenvectors, chains of them, characteristic polynomials and Routh's array of a system or a matrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.auditing.measurements import measurement
from satsym.auditing.measurements.linear import matrix, numbers, spectrum_of
from satsym.auditing.propositions.relations import is_equal
from satsym.auditing.propositions.values import Record, Undecided, is_exact


@measurement
def eigenspace(eigenvalue: Any, of: Any) -> list[Any]:
    """Columns that span the eigenvectors of an eigenvalue, in the order of their independence; numbers."""
    a = numbers(matrix(of))
    from scipy.linalg import null_space

    return list(null_space(a - complex(eigenvalue) * np.eye(len(a)), rcond=1e-9).T)


@measurement
def jordan(of: Any) -> Record:
    """A basis P of chains of an exact matrix, as columns, and the eigenvalue that belongs to each."""
    from satsym.symbolic.analysis.jordan import jordan_form

    found = jordan_form(spectrum_of(matrix(of)))
    if found is None:
        raise Undecided("no closed form of the eigenvalues")
    return Record("the Jordan form", {"P": found.basis, "values": [found.form[i, i] for i in range(found.form.rows)]})


@measurement
def routh(coefficients: Sequence[Any]) -> list[list[Any]]:
    """The rows of Routh's array by its plain rule, padded with zeros, up to one that begins with zero.

    Coefficients are those of a polynomial, the highest power first, or a matrix of one row.
    """
    given = list(coefficients)
    width = (len(given) + 1) // 2
    zero = given[0] - given[0]
    found = [[*line, *[zero] * (width - len(line))] for line in (given[0::2], given[1::2])]
    while len(found) < len(given) and not is_equal(found[-1][0], 0):
        above, line = found[-2:]
        after = [(line[0] * a - above[0] * b) / line[0] for a, b in zip(above[1:], line[1:], strict=True)]
        found.append([*after, zero])
    return found


@measurement
def characteristic(of: Any) -> list[Any]:
    """Coefficients of det(s I - A), the highest power first."""
    a = matrix(of)
    return list(a.charpoly().all_coeffs()) if is_exact(a) else list(np.poly(a))
