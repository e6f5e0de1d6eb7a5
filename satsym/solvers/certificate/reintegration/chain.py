"""What gaps between steps that follow one another add up to."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.lapack import lapack


class Chain:
    """Steps from station to station, each a matrix.

    Parameters
    ----------
    transition
        From each station to the next, shape (K, s, s).
    """

    def __init__(self, transition: Array) -> None:
        count, size = transition.shape[:2]
        band = np.zeros((count, size, 2 * size))  # below the diagonal, column by column, as LAPACK has it
        for k in range(size):
            np.negative(transition[1:, :, k], out=band[:-1, k, size - k : 2 * size - k])
        self._band = band.reshape(-1, 2 * size).T

    def carried(self, gaps: Array) -> Array:
        """Sums of the gaps up to each station but the first, each carried on by the steps after it.

        Parameters
        ----------
        gaps
            At the ends of the steps, shape (K, s, columns); so is what is given back.
        """
        found, _ = lapack().dtbtrs(self._band, gaps.reshape(-1, gaps.shape[2]), uplo="L", diag="U")
        return np.asarray(found.reshape(gaps.shape))
