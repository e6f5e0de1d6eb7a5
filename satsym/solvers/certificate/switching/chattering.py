"""The certificate of a motion whose optimal controls would switch infinitely often: its distance from the optimum.

The motion and its costates are integrated again from node to node, since neighbouring extremals of a weakly regularised
problem diverge too quickly for an integration from the initial costates alone. The excess of the cost over the minimum
is integrated with them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array, distinct
from satsym.instance import Instance
from satsym.solution import Certificate, Check, CostInterval, Solution
from satsym.solvers.certificate import conditions
from satsym.solvers.certificate.competitors.comparison import Comparison
from satsym.solvers.certificate.competitors.searched import kinds
from satsym.solvers.certificate.conclusion import BOUNDARY, OF_SEGMENTS, STATIONARITY, concluded, unmeasured
from satsym.solvers.certificate.reintegration.segments import segments, values
from satsym.solvers.certificate.switching.convexity import convex
from satsym.solvers.control.regularised import regularised, smoothed_law
from satsym.solvers.failures import FAILURES
from satsym.solvers.simulation.extrapolation import leap

RESIDUAL, DEFECT, STATIONARY, COST = 1e-9, 1e-7, 1e-8, 1e-8
"""Largest boundary residual, defect, violation of the regularised control law and error of the stated cost,
relative."""

NARROW = 1e-3
"""Largest width of the cost interval, relative to the cost."""

SAME_WIDTH = 1e-2
"""Largest error of the lower end of the cost interval, relative to its width."""

PARTS = 8
"""Number of integration steps between two nodes. The excess of H over its minimum is tiny and has corners of its
own."""


def certify(solution: Solution, interval: CostInterval) -> Certificate:
    """Certify the solution of a regularised problem; at best as an extremal, since it is not the optimum itself."""
    smooth = _smooth(solution, interval)
    along = segments(smooth)
    reached = None if along is None else conditions.node_by_node(smooth, along)
    measured = _integrated(smooth)
    if along is None or reached is None or measured is None:
        return unmeasured("flow from node to node is finite")
    cost, gap = measured
    size = max(abs(cost), 1e-300)
    width = max(cost - interval.lower, 0.0)
    first = [
        Check(BOUNDARY, conditions.boundary_residual(smooth, reached), RESIDUAL),
        Check(OF_SEGMENTS, conditions.dynamics_defect(smooth, reached), DEFECT),
        Check("correction of the nodes", conditions.correction(smooth, along, reached), DEFECT),
        Check(STATIONARITY, _off_law(smooth), STATIONARY),
        Check("cost", abs(cost - solution.objective) / size, COST),
        Check("cost interval too narrow", max(interval.lower - (cost - gap), 0.0), SAME_WIDTH * width),
        Check("domain violation", float(not solution.instance.model.in_domain(reached.x)), 0.0),
    ]
    proved = convex(solution)
    second = [Check("width of the cost interval", width / size, NARROW)]
    second += [Check("infinitely many switching times: chattering", 1.0, 0.0)]
    if not proved:
        second.append(
            Check("the lower end of the cost interval is only an estimate, because the problem is not convex", 1.0, 0.0)
        )
    others = Comparison((), () if proved else tuple(kinds(solution.instance)))
    return concluded(first, second, float("nan"), others)


def _smooth(solution: Solution, interval: CostInterval) -> Solution:
    """Return a motion as a solution of the regularised problem, with the times at which bounds are met and left."""
    instance, t = solution.instance, solution.times
    low, high = instance.control_set.box
    changes = np.diff((solution.u >= high).astype(int) - (solution.u <= low), axis=1) != 0
    met = tuple(tuple(distinct([t[:-1][row], t[1:][row]]).tolist()) for row in changes)
    return replace(solution, instance=regularised(instance, interval.smoothing, 1.0), switching_times=met)


def _off_law(smooth: Solution) -> float:
    """Return the largest difference of a control from the minimiser of the regularised H, relative to its range."""
    instance = smooth.instance
    law = smoothed_law(instance, instance.control_set, smooth.times, smooth.x, smooth.lam)
    low, high = instance.control_set.box
    return float((np.abs(law - smooth.u) / np.maximum(high - low, 1e-300)).max())


def _integrated(smooth: Solution) -> tuple[float, float] | None:
    """Return the cost, and the integral of the excess of H over its minimum; ``None`` if it is not finite."""
    instance, n, times, start = smooth.instance, len(smooth.x), smooth.times, values(smooth)
    apart = np.diff(times) > 0.0

    def rates(t: Array, y: Array) -> Array:
        return np.concatenate([_canonical(instance, t, y[: 2 * n]), _costs(instance, t, y[: 2 * n])])

    found = np.append(start[:, :-1][:, apart], np.zeros((2, int(apart.sum()))), axis=0)
    try:
        ends, begin, length = found, times[:-1][apart], np.diff(times)[apart] / PARTS
        for part in range(PARTS):
            ends = leap(rates, begin + part * length, ends, length)
        terminal = instance.model.terminal_cost(float(times[-1]), tuple(smooth.x[:, -1].tolist()), instance.parameters)
    except FAILURES:
        return None
    cost, gap = ends[2 * n :].sum(axis=1)
    return (float(cost + terminal), float(gap)) if np.isfinite(ends).all() else None


def _canonical(instance: Instance, t: Array, z: Array) -> Array:
    n = len(z) // 2
    arguments = instance.parameters, instance.control_set.arguments
    return np.asarray(instance.model.canonical_batch(t, z[:n], z[n:], *arguments))


def _costs(instance: Instance, t: Array, z: Array) -> Array:
    """Return the running cost, and the excess of H over its minimum, shape (2, N)."""
    n = len(z) // 2
    x, lam = z[:n], z[n:]
    u = smoothed_law(instance, instance.control_set, t, x, lam)
    running = np.broadcast_to(instance.model.running_cost_batch(t, x, u, instance.parameters), t.shape)
    return np.array([running, _excess(instance, t, x, lam, u)])


def _excess(instance: Instance, t: Array, x: Array, lam: Array, u: Array) -> Array:
    """Return the excess of H over its minimum, shape (N,), control by control.

    H is affine in each control, except for a term in its magnitude.
    """
    model, p = instance.model, instance.parameters
    here, total = np.asarray(model.hamiltonian_batch(t, x, u, lam, p)), np.zeros(len(t))
    for i, places in enumerate(zip(instance.lower, instance.upper, instance.control_set.rest, strict=True)):
        moved, best = u.copy(), here
        for value in places:
            moved[i] = value
            best = np.minimum(best, model.hamiltonian_batch(t, x, moved, lam, p))
        total += here - best
    return total
