"""LU factors of a stack of matrices: the stages of all intervals, eliminated and kept for further right-hand sides."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating[Any]]


class Blocks:
    """Factored square matrices.

    NumPy's stacked solver factors anew for each right-hand side; a substitution alone costs a tenth of that.

    Parameters
    ----------
    matrices
        Shape (N, k, k), in rows; overwritten.

    Raises
    ------
    numpy.linalg.LinAlgError
        If one of them is singular.
    """

    def __init__(self, matrices: Array) -> None:
        from scipy.linalg.lapack import dgetrf

        # LAPACK reads columns, so it is handed the transposes, without a copy.
        factored = [dgetrf(matrix.T, overwrite_a=True) for matrix in matrices]
        if any(info for _, _, info in factored):
            raise np.linalg.LinAlgError("singular")
        self._factors = [(factors, pivots) for factors, pivots, _ in factored]

    def solve(self, right: Array) -> Array:
        """Solutions for right-hand sides, both of shape (N, columns, k): a column of the system is a row here."""
        from scipy.linalg.lapack import dgetrs

        solutions = np.array(right)
        for (factors, pivots), columns in zip(self._factors, solutions, strict=True):
            dgetrs(factors, pivots, columns.T, trans=1, overwrite_b=True)
        return solutions
