"""Controls that switch infinitely often in finite time: an admissible motion, and bounds of the minimum cost.

A singular arc of even order cannot be joined by a finite number of switches, see
:func:`satsym.symbolic.switching.singular.chattering`. The problem is regularised with ever less smoothing instead. The
motion is admissible, so that its cost is an upper bound of the minimum cost. Its costates obey the equations of the
original problem, so that in a convex problem the minimum cost is at most lower by the integral of the excess of H over
its minimum (the duality gap; Mangasarian, SIAM Journal on Control 4, 1966). In other problems this holds to first
order.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from satsym.arrays import Array, distinct
from satsym.instance import Instance
from satsym.solution import CostInterval, Solution
from satsym.solvers.collocation.accuracy.refinement import refine
from satsym.solvers.collocation.continuation import settled
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.gauss import STAGES, scheme
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.control.corners import enclosed
from satsym.solvers.control.regularised import smoothed_law
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.cold_start.homotopy import Smoothed
from satsym.solvers.switching.cold_start.recognition import FAINT_FUNCTION, Sample
from satsym.solvers.switching.throttled import signs
from satsym.solvers.switching.trajectory import runs
from satsym.status import Status

POINTS = 12
"""Number of Gauss points in each mesh interval; bounds become active or inactive at nodes only."""

LEVELS = 5
"""Number of the least smoothed problems that are tried, until one of them is solved accurately."""

INSIDE = 1e-3
"""Distance of a control from both bounds, relative to its range, above which it counts as intermediate and may
chatter."""

NARROW = 1e-9
"""Width of the cost interval, relative to the cost, at which smoothing is not reduced further."""

DIGITS = 1e-11
"""Relative error of both ends of the cost interval."""


@dataclass(frozen=True)
class Look:
    """Properties of a smoothed extremal that indicate chattering."""

    smoothing: float
    switches: int
    """Number of passages of controls from one bound to the other."""
    longest: float
    """Longest time for which a control that may chatter is off both bounds."""
    width: float
    """Approximate width of the cost interval, relative to the cost."""


def look(instance: Instance, near: Smoothed, seen: Sample) -> Look:
    """Return the properties of one smoothed extremal that indicate chattering."""
    low, high = instance.control_set.box
    off = INSIDE * (high - low)
    free = (seen.u > low + off) & (seen.u < high - off)
    own = [name in instance.model.spec.chattering for name in instance.model.spec.control_names]
    stretches = [seen.times[last] - seen.times[first] for row in free[own] for first, last in runs(row)]
    switches = sum(map(len, _passages(instance, seen.times, seen.u, seen.sigma)))
    n, p, t = len(instance.initial), instance.parameters, seen.times
    gap = float(np.trapezoid(excess(instance, t, seen.z[:n], seen.z[n:], seen.u), t))
    running = np.broadcast_to(instance.model.running_cost_batch(t, seen.z[:n], seen.u, p), len(t))
    cost = float(np.trapezoid(running, t)) + float(instance.model.terminal_cost(t[-1], tuple(seen.z[:n, -1]), p))
    width = gap / max(abs(cost), 1e-300)
    return Look(near.problem.control_set.smoothing, switches, float(max(stretches, default=0.0)), width)


def shows(looks: Sequence[Look]) -> bool:
    """Return whether a sequence of extremals with decreasing smoothing shows chattering.

    This is so if a control that may chatter switches and stays off its bounds, or switches more often, with less
    smoothing. At a single switch the time between the bounds is proportional to the smoothing, at a free end at least
    to its third root. Beside a singular arc of second order it is at first proportional to the fourth root, and does
    not vanish if there is time for rest; more switches may only show with a million times less smoothing if the bounds
    are unequal.
    """
    if not looks:
        return False
    before, last = looks[len(looks) // 2], looks[-1]
    less = last.smoothing / before.smoothing
    slowly = last.longest > less**0.5 * before.longest
    stays = last.switches > 0 and last.longest > less**0.125 * before.longest
    return less < 1.0 and slowly and (stays or last.switches > before.switches)


def chattered(instance: Instance, levels: Sequence[Smoothed], limits: Limits) -> Solution | None:
    """Return the solution of the least regularised problem that can be solved accurately; ``None`` if none can.

    Parameters
    ----------
    levels
        Approximate solutions of regularised problems, the least smoothed last.
    """
    solved = ((one.problem, tried(partial(_accurate, one, limits))) for one in reversed(levels[-LEVELS:]))
    problem, found = next(((one, curve) for one, curve in solved if curve is not None), (None, None))
    if problem is None or found is None:
        return None
    edges = distinct(np.concatenate([found.mesh, _corners(problem, found)]))
    interval = _interval(instance, problem, found, edges)
    tau = distinct(np.concatenate([np.linspace(0.0, 1.0, instance.solver.steps + 1), edges]))
    t, z, u = _along(problem, found, tau)
    times = _passages(instance, t, u, signs(instance, t, z[: problem.states], z[problem.states :])[0])
    message = (
        f"infinitely many switching times: chattering; with a regularisation of {interval.smoothing:.1e}, "
        f"{sum(map(len, times))} of them are resolved and the duality gap is "
        f"{interval.upper - interval.lower:.1e}"
    )
    return Solution(
        instance=instance,
        method="bang-bang",
        status=Status.CONVERGED if instance.model.in_domain(z[: problem.states]) else Status.LEFT_DOMAIN,
        message=message,
        objective=interval.upper,
        times=t,
        x=z[: problem.states],
        u=u,
        lam=z[problem.states :],
        switching_times=times,
        iterations=0,
        history=(),
        wall_s=0.0,
        interval=interval,
    )


def at_rest(solution: Solution) -> bool:
    """Return whether H vanishes at the final time, so that a longer final time has the same cost."""
    model, p = solution.instance.model, solution.instance.parameters
    t, x, u, lam = solution.times, solution.x, solution.u, solution.lam
    terms = np.abs(lam * model.dynamics_batch(t, x, u, p)).sum(axis=0).max()
    return bool(abs(np.broadcast_to(model.hamiltonian_batch(t, x, u, lam, p), t.shape)[-1]) <= FAINT_FUNCTION * terms)


def excess(instance: Instance, t: Array, x: Array, lam: Array, u: Array) -> Array:
    """Return the excess of H over its minimum on the control set, shape (N,)."""
    model, p = instance.model, instance.parameters
    sigma, weight = model.switching_function_batch(t, x, lam, p), model.magnitude_weight_batch(t, x, lam, p)
    low, high = instance.control_set.box
    lowest = np.min([sigma * v + weight * np.abs(v) for v in (low, high, np.clip(0.0, low, high))], axis=0)
    return np.asarray((sigma * u + weight * np.abs(u) - lowest).sum(axis=0))


def _accurate(near: Smoothed, limits: Limits) -> Curve | None:
    """Return an extremal of full accuracy with nodes where bounds become active or inactive; ``None`` on failure."""
    problem, curve = near.problem, near.curve
    tolerance = problem.instance.solver.tolerance
    refined = refine(problem, curve, tolerance, keep_nodes=True)
    if not refined.solved:
        bounded = settled(problem, curve, STAGES, len(curve.mesh) - 1, limits)
        refined = refine(problem, bounded.curve, tolerance, keep_nodes=True)
    return refined.curve if refined.solved else None


def _corners(problem: TwoPoint, curve: Curve) -> Array:
    """Return the zeros of the switching functions, where the excess of H over its minimum has corners."""
    inner = np.linspace(0.0, 1.0, POINTS, endpoint=False)
    tau = np.append((curve.mesh[:-1, None] + np.diff(curve.mesh)[:, None] * inner).ravel(), 1.0)

    def values(at: Array) -> Array:
        t, z, _ = _along(problem, curve, at)
        return signs(problem.instance, t, z[: problem.states], z[problem.states :])[0]

    sigma = values(tau)
    size = np.abs(sigma)
    seen = np.maximum(size[:, :-1], size[:, 1:]) > FAINT_FUNCTION * size.max(axis=1, keepdims=True)
    rows, at = np.nonzero(seen & (np.sign(sigma[:, :-1]) * np.sign(sigma[:, 1:]) < 0))
    own = np.arange(len(rows))
    ends = tau[at], tau[at + 1], sigma[rows, at], sigma[rows, at + 1]
    return enclosed(lambda times: values(times)[rows, own], *ends)


def _interval(instance: Instance, problem: TwoPoint, curve: Curve, edges: Array) -> CostInterval:
    """Return the interval of the minimum cost, from integrals that are smooth between the given edges."""
    gauss, n = scheme(POINTS), problem.states
    widths = np.diff(edges)
    weights = problem.elapsed(curve.theta) * np.outer(widths, gauss.weights).ravel()
    t, z, u = _along(problem, curve, (edges[:-1, None] + widths[:, None] * gauss.nodes).ravel())
    running = np.broadcast_to(instance.model.running_cost_batch(t, z[:n], u, instance.parameters), len(t))
    terminal = problem.terminal_cost(curve.nodes[:, -1], curve.theta) * problem.scale.cost
    cost = float(running @ weights + terminal)
    gap = float(excess(instance, t, z[:n], z[n:], u) @ weights)
    return CostInterval(cost - gap - DIGITS * abs(cost), cost, float(problem.control_set.smoothing))


def _along(problem: TwoPoint, curve: Curve, tau: Array) -> tuple[Array, Array, Array]:
    """Return times, states and costates, and controls along a curve."""
    instance, n = problem.instance, problem.states
    t, z = instance.t0 + problem.elapsed(curve.theta) * tau, curve(tau) * problem.scale.both
    return t, z, smoothed_law(instance, problem.control_set, t, z[:n], z[n:])


def _passages(instance: Instance, times: Array, u: Array, sigma: Array) -> tuple[tuple[float, ...], ...]:
    """Return the times at which each control passes between bounds, where its switching function vanishes."""
    low, high = instance.control_set.box
    found = []
    for row, value in zip(np.where(u >= high, 1, np.where(u <= low, -1, 0)), sigma, strict=True):
        bound = np.flatnonzero(row)
        own = []
        for k in np.flatnonzero(np.diff(row[bound])):
            begin, end = bound[k], bound[k + 1]
            at = begin + int(np.flatnonzero(np.sign(value[begin:end]) != np.sign(value[begin + 1 : end + 1]))[0])
            share = value[at] / (value[at] - value[at + 1])
            own.append(float(times[at] + share * (times[at + 1] - times[at])))
        found.append(tuple(own))
    return tuple(found)
