"""Small deviations from a motion, carried along it by the variational equations: state and transition matrix."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from satsym.arrays import Array
from satsym.kernels import Kernels
from satsym.solvers.simulation.extrapolation import integrate

ACCURACY = 1e-14
"""Largest error of a step, relative to the size of the states: what is below is lost in rounding."""


def transition(
    model: Kernels, p: Sequence[float], start: Array, duration: float, t0: float = 0.0, size: Array | None = None
) -> tuple[Array, Array]:
    """The state after a time without control, and its derivative by the state before.

    Both are integrated together with the generated ``dynamics`` and ``jacobian_x``, to the last digits.

    Parameters
    ----------
    model, p
        Which, and its parameters.
    start
        State at t0, shape (n,).
    duration
        Positive or negative.
    t0
        Where the model knows the time.
    size
        Typical sizes of the states, shape (n,); 1 by default. Errors are counted in them.

    Returns
    -------
    end : array of shape (n,)
    Phi : array of shape (n, n)
        d(end)/d(start).

    Raises
    ------
    satsym.solvers.simulation.extrapolation.NotFinite
        If the motion does not last as long.
    """
    n, rest = len(start), (0.0,) * len(model.spec.controls)
    unit = np.ones(n) if size is None else np.asarray(size, dtype=float)

    def rates(t: float, y: Array) -> Array:
        x = (y[:n] * unit).tolist()
        try:
            slope, A = model.dynamics(t, x, rest, p), model.jacobian_x(t, x, rest, p)
        except ArithmeticError:
            return np.full_like(y, np.nan)
        # the matrix is carried in the units as well, and so of size one
        scaled = np.array(A).reshape(n, n) * unit / unit[:, None]
        return np.concatenate([slope / unit, (scaled @ y[n:].reshape(n, n)).ravel()])

    begin = np.concatenate([np.asarray(start, dtype=float) / unit, np.eye(n).ravel()])
    (piece,) = integrate(rates, np.array([t0, t0 + duration]), begin, ACCURACY, np.ones(n + n * n))
    return piece.end[:n] * unit, piece.end[n:].reshape(n, n) * unit[:, None] / unit
