"""Test at random states whether a problem is convex along an extremal of exact arcs."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.solution import Solution

DRAWN = 200
"""Number of random states, around those of the solution, at which convexity is tested."""

ROUNDING = 1e-12
"""Largest relative violation of convexity that counts as rounding."""


def convex(solution: Solution) -> bool:
    """Return whether the problem is convex at all random states, so that the extremal is a global minimum.

    If the Hamiltonian is convex in states and controls, the terminal cost is convex and final states are given or free,
    no admissible motion is cheaper. With singular arcs that satisfy the strict generalised Legendre-Clebsch condition
    and strict bounds elsewhere, no other motion has the same cost either (Mangasarian, Sufficient conditions for the
    optimal control of nonlinear systems, SIAM Journal on Control 4, 1966). Only problems with a given final time are
    tested.
    """
    instance, model = solution.instance, solution.instance.model
    if instance.tf is None or model.spec.multipliers or "reference" in instance.final.values():
        return False
    rng, p, n = np.random.default_rng(0), instance.parameters, len(instance.initial)
    nodes = rng.integers(0, len(solution.times), DRAWN)
    t, lam = solution.times[nodes], solution.lam[:, nodes]
    size = np.abs(solution.x).max(axis=1, keepdims=True) + 1e-300
    x = solution.x[:, nodes] + size * rng.uniform(-2.0, 2.0, (n, DRAWN))
    u = rng.uniform(*instance.control_set.box, (len(solution.u), DRAWN))
    hessian = -model.extremal_jacobian_batch(t, x, u, lam, p)[n:, :n].transpose(2, 0, 1)
    scaled = hessian * (size * size.T)
    least = float(np.linalg.eigvalsh(scaled + scaled.transpose(0, 2, 1)).min())
    # What a control does to the rates of the costates is the mixed derivative; a weight of |u| must not vary either.
    still = model.costate_rate_batch(t, x, np.zeros_like(u), lam, p)
    moved = model.costate_rate_batch(t, x, u, lam, p)
    largest = max(float(np.abs(scaled).max()), float(np.abs(still * size).max()), 1e-300)
    mixed = float(np.abs((moved - still) * size).max())
    return least >= -ROUNDING * largest and mixed <= ROUNDING * largest and _convex_end(solution, x, size)


def _convex_end(solution: Solution, x: Array, size: Array) -> bool:
    """Return whether the gradient of the terminal cost is monotone along lines between the random states."""
    model, p, tf = solution.instance.model, solution.instance.parameters, float(solution.times[-1])
    slopes = np.array([model.terminal_gradient(tf, tuple(column), p) for column in x.T.tolist()]).T
    growth = (np.diff(slopes, axis=1) * np.diff(x, axis=1)).sum(axis=0)
    return bool(growth.min() >= -ROUNDING * max(float(np.abs(slopes * size).max()), 1e-300))
