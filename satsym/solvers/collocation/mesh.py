"""Meshes that fit the motion: in each interval the fastest mode turns by at most a given angle."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solvers.collocation.curve import Curve, stage_times
from satsym.solvers.collocation.problem import TwoPoint

TURN = 1.0
"""Largest angle, in rad, by which the fastest mode turns in one interval. With fewer than about six intervals per turn
the collocation equations have spurious solutions."""

COARSEST = 2.5 * TURN
"""Angle in one interval, in rad, above which a new mesh is used."""

FEWEST, MOST_INTERVALS = 6, 400


def laid(problem: TwoPoint, curve: Curve) -> Array:
    """Return the mesh for the states of a curve, shape (N+1,)."""
    n = problem.states
    tau = np.concatenate([curve.mesh[:-1, None], stage_times(curve.mesh, curve.order)], axis=1)
    x = np.concatenate([curve.nodes[:n, :-1, None], curve.stages[:n]], axis=2)
    return along(problem, tau.ravel(), x.reshape(n, -1), curve.theta)


def along(problem: TwoPoint, tau: Array, x: Array, theta: Array) -> Array:
    """Return the mesh for a path of states.

    Parameters
    ----------
    tau
        Increasing times in [0, 1], shape (M,).
    x
        Scaled states there, shape (n, M).
    theta
        Extra unknowns.
    """
    n = problem.states
    coasting = np.concatenate([x, np.zeros_like(x)])
    with np.errstate(all="ignore"):
        slopes = problem.jacobian(tau, coasting, theta)[:n, :n]
        if np.isfinite(problem.rates(tau, coasting, theta)).all():
            slopes = np.where(np.isfinite(slopes), slopes, 0.0)  # some laws have no derivatives where costates vanish
    speed = np.abs(np.linalg.eigvals(slopes.transpose(2, 0, 1))).max(axis=1)
    speed = np.maximum(speed, speed.mean() / 2.0)
    speed[1:-1] = np.maximum(speed[1:-1], np.maximum(speed[:-2], speed[2:]))
    angle = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2.0 * np.diff(tau))])
    wanted = angle[-1] * problem.elapsed(theta) / TURN
    count = int(min(max(FEWEST, np.ceil(wanted)), MOST_INTERVALS)) if np.isfinite(wanted) else FEWEST
    mesh = (
        np.interp(np.linspace(0.0, angle[-1], count + 1), angle, tau) if angle[-1] > 0 else np.linspace(0, 1, count + 1)
    )
    mesh[0], mesh[-1] = 0.0, 1.0
    return mesh
