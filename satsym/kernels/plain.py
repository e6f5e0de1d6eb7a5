"""The trajectory loops in textbook form, by calls of functions of one point in time.

They are slow, and serve only to check the generated loops; they also run on arrays of objects with any number of
digits. The fractions of kicks and drifts of symplectic steps, which all of these loops use, are here as well.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction

import numpy as np

from satsym.arrays import Array
from satsym.kernels.core import Kernels


def forward(
    kernels: Kernels, times: Array, x0: Sequence[float], u: Array, u_mid: Array, p: tuple[float, ...]
) -> tuple[Array, Array, float]:
    """Integrate states forward, with the arguments of :meth:`satsym.kernels.Kernels.forward`."""
    n, costs = len(x0), kernels.spec.has_cost

    def rates(t: float, y: Array, u_now: Array) -> Array:
        state, control = tuple(y[:n].tolist()), tuple(u_now.tolist())
        running = [kernels.running_cost(t, state, control, p)] if costs else []
        return np.array([*kernels.dynamics(t, state, control, p), *running])

    y, y_mid = _rk4(rates, times, np.array([*x0, *([0.0] if costs else [])]), u, u_mid)
    return y[:n], y_mid[:n], y[n, -1] if costs else 0.0


def backward(
    kernels: Kernels,
    times: Array,
    lam_f: Sequence[float],
    x: Array,
    x_mid: Array,
    u: Array,
    u_mid: Array,
    p: tuple[float, ...],
) -> tuple[Array, Array]:
    """Integrate costates backward, with the arguments of :meth:`satsym.kernels.Kernels.backward`."""
    n = len(x)

    def rates(t: float, lam: Array, given: Array) -> Array:
        state, control = tuple(given[:n].tolist()), tuple(given[n:].tolist())
        return np.array(kernels.costate_rate(t, state, control, tuple(lam.tolist()), p))

    given, given_mid = np.vstack([x, u])[:, ::-1], np.vstack([x_mid, u_mid])[:, ::-1]
    lam, lam_mid = _rk4(rates, times[::-1], np.array(lam_f), given, given_mid)
    return lam[:, ::-1], lam_mid[:, ::-1]


def symplectic(kernels: Kernels, times: Array, x0: Sequence[float], p: tuple[float, ...]) -> Array:
    """Integrate without control by alternating kicks of the velocities and drifts of the coordinates."""
    spec = kernels.spec
    moved, kicked = (np.isin(spec.state_names, group) for group in (spec.coordinates, spec.velocities))
    kicks, drifts = exact_weights()
    coast = (0.0,) * len(spec.controls)
    y = [np.array(x0)]
    for i, h in enumerate(np.diff(times)):
        now = y[-1]
        for kick, drift in zip(kicks, [*drifts, 0], strict=True):
            now = now + kick * h * kicked * kernels.dynamics(times[i], tuple(now.tolist()), coast, p)
            now = now + drift * h * moved * kernels.dynamics(times[i], tuple(now.tolist()), coast, p)
        y.append(now)
    return np.array(y).T


def _rk4(
    rates: Callable[[float, Array, Array], Array], times: Array, start: Array, given: Array, given_mid: Array
) -> tuple[Array, Array]:
    """Integrate by RK4 with Hermite midpoints; times may run backward."""
    y, middles = [start], []
    for i, h in enumerate(np.diff(times)):
        t, here = times[i], y[-1]
        k1 = rates(t, here, given[:, i])
        k2 = rates(t + h / 2, here + h / 2 * k1, given_mid[:, i])
        k3 = rates(t + h / 2, here + h / 2 * k2, given_mid[:, i])
        k4 = rates(t + h, here + h * k3, given[:, i + 1])
        there = here + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        middles.append((here + there) / 2 + h / 8 * (k1 - rates(t + h, there, given[:, i + 1])))
        y.append(there)
    return np.array(y).T, np.array(middles).T


KICKS = ("0.0414649985182624", "0.198128671918067", "-0.0400061921041533", "0.0752539843015807", "-0.0115113874206879")
DRIFTS = ("0.123229775946271", "0.290553797799558", "-0.127049212625417", "-0.246331761062075", "0.357208872795928")
"""Coefficients of the symplectic method: fractions of the step for the twelve kicks, and for the eleven drifts.

Only the first half is listed, since the method is symmetric; each kind has the sum one.
"""


def weights() -> tuple[list[float], list[float]]:
    """Return the fractions of the step of the twelve kicks, and of the eleven drifts between them."""
    kicks, drifts = exact_weights()
    return [float(k) for k in kicks], [float(d) for d in drifts]


def exact_weights() -> tuple[list[Fraction], list[Fraction]]:
    """Return the fractions of the step of the twelve kicks and the eleven drifts exactly.

    Kicks and drifts whose composition is symplectic and of sixth order: SRKN_11^b of Blanes and Moan, Practical
    symplectic partitioned Runge-Kutta and Runge-Kutta-Nystrom methods, Journal of Computational and Applied Mathematics
    142, 2002, table 3, eleven evaluations a step. At equal work it was at least as exact on orbits of eccentricity 0.02
    to 0.74 as the fourth- and eighth-order compositions in use, but for the last digits on the roundest.
    """
    kicks, drifts = ([Fraction(c) for c in given] for given in (KICKS, DRIFTS))
    kicks.append(Fraction(1, 2) - sum(kicks))
    middle = 1 - 2 * sum(drifts, Fraction(0))
    return [*kicks, *reversed(kicks)], [*drifts, middle, *reversed(drifts)]
