"""Controls and extremals that are drawn: what a solution is compared with beside the starts of the search.

Where no state is asked of the end, all controls are admissible, and none costs less than an optimum. Extremals are
found by descents, which need not leave the basin in which they begin. A simulation knows no basins: where one control
of many costs less, what was found is not the optimum, whatever else it is.

Extremals are drawn where a motion is likely to have several minima that few starts show (:func:`several_likely`).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.instance import Guess, Instance
from satsym.solution import Solution
from satsym.solvers.certificate.competitors.simulations import Simulations, simulations_of
from satsym.solvers.certificate.end_form import fixed_states
from satsym.solvers.certificate.reintegration.flow import unit_sizes
from satsym.solvers.simulation.together import costs_together
from satsym.solvers.spare_time import frequency, longest, rates_by_states
from satsym.solvers.switching.linear.linear_motion import linear_motion

GROUPS, DRAWN, WAVES = 8, 96, 4
"""Groups of controls, apart lest all gather in the basin of the solution; controls of each, and harmonics."""

SMALLEST_AMPLITUDE, LARGEST_AMPLITUDE = 0.5, 60.0
"""Amplitudes of the groups, in sizes of a control."""

ROUNDS, ELITE = 4, 6
"""After the first: each group draws others about the cheapest of its last, half as far away each time."""

LONGER = 0.7
"""Size of the logarithms by which durations that are chosen are multiplied."""

STEPS = 48
"""How many each motion that is drawn has."""

CERTAIN = 0.1
"""Share of what a control saves by which twice as many steps may make it cost something else."""

WORTH = 1e-3
"""What is saved at least, relative to the cost: less may be the error of a grid."""

UNLIKE = 1.0 / 3.0
"""Share of linearised rates by which they depart from their mean along the way, on average, where motions are nearly
linear: one that keeps to an orbit has a seventh, one that leaves a well or falls from the top more than half."""

SWING = np.pi
"""Angle by which the quickest mode turns in time that can be paid for besides."""


@dataclass(frozen=True, eq=False)
class Drawn:
    """The cheapest of the controls that were drawn, which costs less than a solution."""

    simulations: Simulations
    grid: Grid
    """As long as the motion, whose duration may be chosen."""
    control: Array
    """At nodes and midpoints, shape (m, 2 N + 1)."""
    stated: Array
    """The solution's, at the same shares of its duration."""
    states: Array
    """At the nodes, shape (n, N + 1)."""
    cost: float


def drawable(solution: Solution) -> bool:
    """Whether controls are drawn for a solution: where no state is asked of its end."""
    return _simulated(solution) is not None


def _simulated(solution: Solution) -> Simulations | None:
    spec = solution.instance.model.spec
    tied = spec.in_arcs or spec.multipliers or fixed_states(solution.instance).any()
    return None if tied else simulations_of(solution)


def drawn_below(solution: Solution, seed: int = 0) -> Drawn | None:
    """The cheapest of the controls drawn about a solution's, if that costs less; ``None`` where none does.

    Parameters
    ----------
    solution
        Of a smooth problem; nothing is known of controls that are to arrive somewhere, or keep to path constraints.
    seed
        Of the controls.
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
    """Draw in rounds: shares (m, WAVES) of waves that cost least when added, and how much later the cheapest ends.

    What is drawn are these and the logarithm of the duration over the solution's.
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
    """The control of a solution at shares of its duration."""
    times = solution.times[0] + (solution.times[-1] - solution.times[0]) * tau
    return np.array([np.interp(times, solution.times, row) for row in solution.u])


def _costs(solution: Solution, drawn: Array) -> Array:
    """Roughly what a control costs with each of many changes, shape (..., m WAVES + 1); infinite if it fails."""
    m, changes = len(solution.u), drawn.reshape(-1, drawn.shape[-1])
    tau = np.linspace(0.0, 1.0, 2 * STEPS + 1)
    waves = np.moveaxis(changes[:, :-1].reshape(-1, m, WAVES) @ _waves(tau), 0, -1)
    controls = _stated(solution, tau)[:, :, None] + waves
    lasting = (solution.times[-1] - solution.times[0]) * np.exp(changes[:, -1])
    return costs_together(solution.instance, controls, lasting).reshape(drawn.shape[:-1])


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
    twice = replace(drawn.simulations, steps=2 * drawn.grid.nodes.size - 2, end=drawn.grid.tf)
    fine, coarse = twice.grid(), interleave(drawn.grid.nodes, drawn.grid.midpoints)
    times = interleave(fine.nodes, fine.midpoints)
    control = np.array([np.interp(times, coarse, row) for row in drawn.control])
    again, _ = twice(control, fine)
    return saved > WORTH * abs(objective) and abs(again - drawn.cost) < CERTAIN * saved


def extremals_below(solution: Solution, seed: int) -> Iterator[Instance]:
    """The instance of a solution with guesses of its states by extremals that nearly meet and seem to cost less.

    Parameters
    ----------
    seed
        Of what is drawn.
    """
    from satsym.solvers.collocation.scaling import two_point
    from satsym.solvers.drawn_beside import about

    instance, lasting = replace(solution.instance, guess=Guess()), float(np.ptp(solution.times))
    if not instance.final or not several_likely(solution):
        return
    problem = two_point(replace(instance, tf=instance.t0 + lasting, tf_guess=None), lasting)
    for one in about(solution, problem, seed):
        rows = (one.states * problem.scale.state[:, None]).tolist()
        states = dict(zip(instance.model.spec.state_names, map(tuple, rows), strict=True))
        end = instance.t0 + one.duration if instance.tf is None else None
        yield replace(instance, guess=Guess(states), tf_guess=end)


def several_likely(solution: Solution) -> bool:
    """Whether a motion is likely to have several minima that few starts show.

    So it is where it is far from linear, where it is not linear and controls switch, and where a free duration leaves
    time for another swing.
    """
    nonlinear = any(solution.switching_times) and linear_motion(solution.instance) is None
    return nonlinear or far_from_linear(solution) or may_swing(solution)


def far_from_linear(solution: Solution) -> bool:
    """Whether linearised rates change much along a solution.

    Those of a linear motion are the same everywhere, and its least cost has one minimum where costs are convex.
    """
    size = unit_sizes(solution)[: len(solution.x)]
    scaled = rates_by_states(solution, 1) * (size / size[:, None])[:, :, None]
    widths = np.gradient(solution.times)
    mean = (scaled * widths).sum(axis=2, keepdims=True) / widths.sum()
    apart, whole = (float(np.linalg.norm(one, axis=(0, 1)) @ widths) for one in (scaled - mean, scaled))
    return apart > UNLIKE * whole


def may_swing(solution: Solution) -> bool:
    """Whether a free duration leaves time for another swing, which then need not cost more than pushing at once."""
    spare = longest(solution) - float(solution.times[-1] - solution.times[0])
    return spare > 0.0 and spare * frequency(solution) > SWING
