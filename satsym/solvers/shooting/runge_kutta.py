"""One step of the explicit Runge-Kutta method of order 8 by Dormand and Prince, for many arcs at once."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from satsym.arrays import Array

Slope = Callable[[Array, Array], Array]

ORDER = 8


@lru_cache
def tableau() -> tuple[Array, Array, Array]:
    """Return the coefficients A, b, c of the 12 stages.

    They are those of Hairer, Norsett and Wanner, Solving Ordinary Differential Equations I, II.5.
    """
    from scipy.integrate import DOP853

    return DOP853.A, DOP853.B, DOP853.C


def advance(slope: Slope, tau: Array, values: Array, width: Array) -> Array:
    """Return the values after one step.

    Parameters
    ----------
    slope
        Function of times and values that returns the time derivatives.
    tau, width
        Initial times and lengths of the steps, shape (M,).
    values
        Initial values, shape (..., M).
    """
    a, b, c = tableau()
    stages = np.empty((len(b), *values.shape), values.dtype)
    for i, row in enumerate(a):
        inner = values + width * np.tensordot(row[:i], stages[:i], 1) if i else values
        stages[i] = slope(tau + c[i] * width, inner)
    reached: Array = values + width * np.tensordot(b, stages, 1)
    return reached
