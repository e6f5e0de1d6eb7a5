"""Controls that are drawn, where nothing is asked of the end: all are admissible, and none costs less than an optimum.

Extremals are found by descents, which need not leave the basin in which they begin. A simulation knows no basins: where
one control of many costs less, what was found is not the optimum, whatever else it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.solution import Solution
from satsym.solvers.certificate.neighbours import Simulations, simulations_of, stated_control
from satsym.solvers.certificate.reintegration.flow import unit_sizes

GROUPS, DRAWN, WAVES = 8, 96, 4
"""Groups of controls, apart lest all gather in the basin of the solution; controls of each, and harmonics."""

SMALLEST, LARGEST = 0.5, 60.0
"""Amplitudes of the groups, in sizes of a control."""

ROUNDS, ELITE = 4, 6
"""After the first: each group draws others about the cheapest of its last, half as far away each time."""

STEPS = 48
"""Of each motion that is drawn."""

CERTAIN = 0.1
"""Share of what a control saves by which twice as many steps may make it cost something else."""

WORTH = 1e-3
"""What is saved at least, relative to the cost: less may be the error of a grid."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """The cheapest of the controls that were drawn, which costs less than a solution."""

    simulations: Simulations
    grid: Grid
    control: Array
    """At nodes and midpoints, shape (m, 2 N + 1)."""
    stated: Array
    """The solution's, at the same."""
    states: Array
    """At the nodes, shape (n, N + 1)."""
    cost: float


def drawn_below(solution: Solution, seed: int = 0) -> Drawn | None:
    """The cheapest of the controls drawn about a solution's, if that costs less; ``None`` where none does.

    Parameters
    ----------
    solution
        Of a smooth problem; nothing is known of controls that are to arrive somewhere, or keep to path constraints.
    seed
        Of the controls.
    """
    instance, spec = solution.instance, solution.instance.model.spec
    simulations = None if spec.in_arcs or spec.multipliers else simulations_of(solution)
    if simulations is None or simulations.rows.size:
        return None
    grid = simulations.grid()
    stated = stated_control(solution, grid)
    with np.errstate(all="ignore"):
        control = instance.control_set.project(stated + _cheapest_change(solution, grid, seed))
        cost, _ = simulations(control, grid)
        states, _ = simulations.motion(control, grid)
        found = Drawn(simulations, grid, control, stated, states, cost)
        below = cost < solution.objective and np.isfinite(states).all() and instance.model.in_domain(states)
        return found if below and _certain(found, solution.objective) else None


def _cheapest_change(solution: Solution, grid: Grid, seed: int) -> Array:
    """The change of the control at nodes and midpoints that costs least, of those drawn in all rounds."""
    rng, m = np.random.default_rng(seed), len(solution.u)
    sizes = np.maximum(np.abs(solution.u).max(axis=1), natural(solution))[:, None]
    far = np.geomspace(SMALLEST, LARGEST, GROUPS)[:, None, None, None] * sizes
    shares = far * rng.normal(size=(GROUPS, DRAWN, m, WAVES))
    costs = _costs(solution, shares)
    for k in range(ROUNDS):
        best = np.argsort(costs, axis=1)[:, :ELITE]
        kept = np.take_along_axis(shares, best[:, :, None, None], axis=1)
        parents = np.resize(np.arange(ELITE), DRAWN)
        children = kept[:, parents] + 0.5 ** (k + 1) * far * rng.normal(size=(GROUPS, DRAWN, m, WAVES))
        shares = np.concatenate([kept, children], axis=1)
        costs = np.concatenate([np.take_along_axis(costs, best, axis=1), _costs(solution, children)], axis=1)
    tau = (interleave(grid.nodes, grid.midpoints) - grid.t0) / (grid.tf - grid.t0)
    return np.asarray(shares.reshape(-1, m, WAVES)[np.argmin(costs)] @ _waves(tau))


def _waves(tau: Array) -> Array:
    return np.asarray(np.cos(np.pi * np.arange(WAVES)[:, None] * tau))


def _costs(solution: Solution, shares: Array) -> Array:
    """Roughly what a control costs with each of many changes, shares (..., m, WAVES) of waves; infinite if it fails."""
    instance, model = solution.instance, solution.instance.model
    p, grid = instance.parameters, Grid.uniform(instance.t0, float(solution.times[-1]), STEPS)
    tau = np.linspace(0.0, 1.0, 2 * STEPS + 1)
    times = grid.t0 + (grid.tf - grid.t0) * tau
    own = np.array([np.interp(times, solution.times, row) for row in solution.u])
    change = np.moveaxis(shares.reshape(-1, *shares.shape[-2:]) @ _waves(tau), 0, -1)  # (m, 2 STEPS + 1, S)
    count = change.shape[-1]
    x = np.repeat(np.array(instance.initial)[:, None], count, axis=1)
    h, total, inside = (grid.tf - grid.t0) / STEPS, np.zeros(count), np.ones(count, dtype=bool)
    positive = [i for i, state in enumerate(model.spec.states) if state.positive]
    for k in range(STEPS):
        u = [instance.control_set.project(own[:, j, None] + change[:, j]) for j in (2 * k, 2 * k + 1, 2 * k + 2)]
        z, t = [x], times[2 * k : 2 * k + 3]
        slopes = list[Array]()
        for at, share in ((0, 0.5), (1, 0.5), (1, 1.0), (2, 0.0)):
            slopes.append(np.asarray(model.dynamics_batch(t[at], z[-1], u[at], p)))
            z.append(x + share * h * slopes[-1])
        total += h / 6.0 * (_running(solution, t[0], z[0], u[0]) + _running(solution, t[2], z[3], u[2]))
        total += h / 3.0 * (_running(solution, t[1], z[1], u[1]) + _running(solution, t[1], z[2], u[1]))
        x = x + h / 6.0 * (slopes[0] + 2.0 * (slopes[1] + slopes[2]) + slopes[3])
        inside &= np.isfinite(x).all(axis=0) & (x[positive] > 0.0).all(axis=0)
    ends = [model.terminal_cost(grid.tf, tuple(end), p) if ok else np.inf for end, ok in zip(x.T, inside, strict=True)]
    found = total + np.array(ends)
    return np.where(np.isfinite(found), found, np.inf).reshape(shares.shape[:-2])


def _running(solution: Solution, t: float, x: Array, u: Array) -> Array:
    return np.asarray(solution.instance.model.running_cost_batch(t, x, u, solution.instance.parameters))


def natural(solution: Solution) -> Array:
    """Sizes of the controls that move the state by its own size over the duration, shape (m,); 1 where none does."""
    instance, lasting = solution.instance, float(solution.times[-1] - solution.times[0])
    u, x, t = (np.asarray(row)[..., :1] for row in (solution.u, solution.x, solution.times))
    by_control = np.abs(instance.model.jacobian_u_batch(t, x, u, instance.parameters))
    size = unit_sizes(solution)[: len(solution.x), None, None]
    response = np.broadcast_to(by_control / size, (len(solution.x), len(solution.u), 1)).max(axis=(0, 2)) * lasting
    return np.where(response > 0.0, 1.0 / np.where(response > 0.0, response, 1.0), 1.0)


def _certain(drawn: Drawn, objective: float) -> bool:
    """Whether what a control saves is more than the error of its simulation."""
    saved = objective - drawn.cost
    twice = replace(drawn.simulations, steps=2 * drawn.grid.nodes.size - 2)
    fine, coarse = twice.grid(), interleave(drawn.grid.nodes, drawn.grid.midpoints)
    times = interleave(fine.nodes, fine.midpoints)
    control = np.array([np.interp(times, coarse, row) for row in drawn.control])
    again, _ = twice(control, fine)
    return saved > WORTH * abs(objective) and abs(again - drawn.cost) < CERTAIN * saved
