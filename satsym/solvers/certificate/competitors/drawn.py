"""Randomly drawn controls, with which a solution is compared as well as with other starts of the search.

If no final state is prescribed, all controls are admissible, and no control costs less than the optimum. Solvers find
extremals by descent, which need not leave the region of attraction of a local minimum. A simulation has no such
restriction: if one of many random controls costs less, the solution is not the optimum.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.solution import Solution
from satsym.solvers.certificate.competitors.simulations import Simulations, simulations_of
from satsym.solvers.certificate.end_form import fixed_states
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.simulation.together import costs_together

GROUPS, DRAWN, WAVES = 8, 96, 4
"""Number of independent groups of random controls, which keeps them from gathering about one local minimum; number of
controls in each group; number of harmonics of each control."""

SMALLEST_AMPLITUDE, LARGEST_AMPLITUDE = 0.5, 60.0
"""Amplitudes of the first and the last group, relative to the largest magnitude of a control."""

ROUNDS, ELITE = 4, 6
"""Number of rounds after the first, and number of the cheapest controls of each group about which the next round draws
others, with half the spread each time."""

LONGER = 0.7
"""Standard deviation of the logarithm of the factor by which free durations are multiplied."""

STEPS = 48
"""Number of integration steps of each random motion."""

CERTAIN = 0.1
"""Largest change of the cost that twice as many steps may cause, relative to the saving of a control. A control with a
larger change does not count as cheaper."""

WORTH = 1e-3
"""Minimum saving, relative to the cost, of a control that counts as cheaper. Smaller savings may be errors of the
grid."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """The cheapest of the randomly drawn controls, which costs less than a solution."""

    simulations: Simulations
    grid: Grid
    """Time grid of the motion, whose duration may differ from that of the solution."""
    control: Array
    """Control at nodes and midpoints, shape (m, 2 N + 1)."""
    stated: Array
    """Control of the solution at the same fractions of its duration, shape (m, 2 N + 1)."""
    states: Array
    """States at the nodes, shape (n, N + 1)."""
    cost: float


def drawable(solution: Solution) -> bool:
    """Return whether controls can be drawn for a solution: its final states are free and it has no path constraints."""
    return _simulated(solution) is not None


def _simulated(solution: Solution) -> Simulations | None:
    spec = solution.instance.model.spec
    tied = spec.in_arcs or spec.multipliers or fixed_states(solution.instance).any()
    return None if tied else simulations_of(solution)


def drawn_below(solution: Solution, seed: int = 0) -> Drawn | None:
    """Return the cheapest of the controls drawn about that of a solution, or ``None`` if none of them costs less.

    Parameters
    ----------
    solution
        Solution of a smooth problem with free final states and without path constraints; otherwise nothing is drawn.
    seed
        Seed of the random controls.
    """
    instance, simulations = solution.instance, _simulated(solution)
    if simulations is None:
        return None
    with np.errstate(all="ignore"):
        change, longer = _cheapest_change(solution, seed)
        grid = simulations.grid(longer)
        tau = (interleave(grid.nodes, grid.midpoints) - grid.t0) / (grid.tf - grid.t0)
        stated = _stated(solution, tau)
        control = instance.control_set.project(stated + change @ _waves(tau))
        cost, _ = simulations(control, grid)
        states, _ = simulations.motion(control, grid)
        found = Drawn(simulations, grid, control, stated, states, cost)
        below = cost < solution.objective and np.isfinite(states).all() and instance.model.in_domain(states)
        return found if below and _certain(found, solution.objective) else None


def _cheapest_change(solution: Solution, seed: int) -> tuple[Array, float]:
    """Draw random changes of the control in rounds and return the cheapest change.

    Returns amplitudes of the harmonics, shape (m, WAVES), to add to the control, and the change of the duration. Both
    are drawn, the latter as the logarithm of the ratio of durations.
    """
    rng, m = np.random.default_rng(seed), len(solution.u)
    sizes = np.repeat(np.maximum(np.abs(solution.u).max(axis=1), natural(solution)), WAVES)
    far = np.geomspace(SMALLEST_AMPLITUDE, LARGEST_AMPLITUDE, GROUPS)[:, None, None] * np.append(sizes, 0.0)
    far[1::2, :, -1] = LONGER if solution.instance.tf is None else 0.0  # the other groups keep the duration
    drawn = far * rng.normal(size=(GROUPS, DRAWN, m * WAVES + 1))
    costs = _costs(solution, drawn)
    for k in range(ROUNDS):
        best = np.argsort(costs, axis=1)[:, :ELITE]
        kept = np.take_along_axis(drawn, best[:, :, None], axis=1)
        parents = np.resize(np.arange(ELITE), DRAWN)
        children = kept[:, parents] + 0.5 ** (k + 1) * far * rng.normal(size=(GROUPS, DRAWN, m * WAVES + 1))
        drawn = np.concatenate([kept, children], axis=1)
        costs = np.concatenate([np.take_along_axis(costs, best, axis=1), _costs(solution, children)], axis=1)
    cheapest = drawn.reshape(-1, m * WAVES + 1)[np.argmin(costs)]
    lasting = float(solution.times[-1] - solution.times[0])
    return cheapest[:-1].reshape(m, WAVES), lasting * float(np.expm1(cheapest[-1]))


def _waves(tau: Array) -> Array:
    return np.asarray(np.cos(np.pi * np.arange(WAVES)[:, None] * tau))


def _stated(solution: Solution, tau: Array) -> Array:
    """Return the control of a solution at given fractions of its duration, shape (m, number of fractions)."""
    times = solution.times[0] + (solution.times[-1] - solution.times[0]) * tau
    return np.array([np.interp(times, solution.times, row) for row in solution.u])


def _costs(solution: Solution, drawn: Array) -> Array:
    """Return approximate costs of many changes of a control, shape (..., m WAVES + 1); infinite if one fails."""
    m, changes = len(solution.u), drawn.reshape(-1, drawn.shape[-1])
    tau = np.linspace(0.0, 1.0, 2 * STEPS + 1)
    waves = np.moveaxis(changes[:, :-1].reshape(-1, m, WAVES) @ _waves(tau), 0, -1)
    controls = _stated(solution, tau)[:, :, None] + waves
    lasting = (solution.times[-1] - solution.times[0]) * np.exp(changes[:, -1])
    return costs_together(solution.instance, controls, lasting).reshape(drawn.shape[:-1])


def natural(solution: Solution) -> Array:
    """Return the control magnitudes that move the state by its own magnitude over the duration, shape (m,).

    Controls that do not act on the state have the magnitude 1.
    """
    instance, lasting = solution.instance, float(solution.times[-1] - solution.times[0])
    u, x, t = (np.asarray(row)[..., :1] for row in (solution.u, solution.x, solution.times))
    by_control = np.abs(instance.model.jacobian_u_batch(t, x, u, instance.parameters))
    size = unit_sizes(solution)[: len(solution.x), None, None]
    response = np.broadcast_to(by_control / size, (len(solution.x), len(solution.u), 1)).max(axis=(0, 2)) * lasting
    return np.where(response > 0.0, 1.0 / np.where(response > 0.0, response, 1.0), 1.0)


def _certain(drawn: Drawn, objective: float) -> bool:
    """Return whether the saving of a drawn control exceeds the error of its simulation."""
    saved = objective - drawn.cost
    twice = replace(drawn.simulations, steps=2 * drawn.grid.nodes.size - 2, end=drawn.grid.tf)
    fine, coarse = twice.grid(), interleave(drawn.grid.nodes, drawn.grid.midpoints)
    times = interleave(fine.nodes, fine.midpoints)
    control = np.array([np.interp(times, coarse, row) for row in drawn.control])
    again, _ = twice(control, fine)
    return saved > WORTH * abs(objective) and abs(again - drawn.cost) < CERTAIN * saved
