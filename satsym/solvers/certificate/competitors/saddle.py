"""What lies below an extremal that is no minimum: motions to descend from, or a cost that falls without end.

The control is changed along the direction in which the second variation is least, or towards a control far away that
costs less, to both sides. Where twice as large a
change, again and again, leaves the end as it is asked for and the cost falls at least in proportion, no control is the
best one: of linear problems with quadratic costs this decides, of others it is evidence.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import gcd

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid, interleave
from satsym.instance import Guess
from satsym.solution import Solution
from satsym.solvers.certificate.competitors.drawn import drawn_below, natural
from satsym.solvers.certificate.competitors.simulations import Simulations, simulations_of, stated_control
from satsym.solvers.certificate.second_variation import Arc, Quadratic, quadratic, scaled_units

DOUBLINGS = 12
"""How often a change is doubled, from the size of the control on that moves the state by its own size."""

FALLS = 6
"""Last ones of these over which the cost must fall at least in proportion."""

PROPORTIONAL = 1.9
"""Growth of the fall from one doubling to the next that counts so."""

KEPT = 1e-6
"""Relative miss of the end beside what the change would have moved it."""

DEPARTED = (0.5, -0.5, 0.1, -0.1)
"""Shares of that size by which a motion departs from a saddle."""

PIECES = 50
"""Most pieces of the motion on each of which the control's change is constant."""

NUDGE = 1e-6
"""Relative change of states and costates that shows how the control law follows them."""


@dataclass(frozen=True)
class Fall:
    """A cost that falls without end."""

    sizes: tuple[float, ...]
    """The largest control of each motion."""
    costs: tuple[float, ...]
    """What these cost."""

    @property
    def message(self) -> str:
        """One line."""
        costs, sizes = (", ".join(f"{value:.4g}" for value in row[-3:]) for row in (self.costs, self.sizes))
        return f"the cost is unbounded below: controls up to {sizes} have the costs {costs}"


def fall(solution: Solution) -> Fall | None:
    """The fall of the cost from an extremal that is no minimum; ``None`` where none shows.

    Parameters
    ----------
    solution
        With a given final time; controls that have bounds are not asked.
    """
    if solution.instance.control_set.bounded:
        return None
    found = _downhill(solution) or _far(solution)
    if found is None:
        return None
    simulations, grid, u, change = found
    falls = (_doubled(simulations, grid, u, sign * change) for sign in (1.0, -1.0))
    return next(filter(None, falls), None)


def departures(solution: Solution) -> list[Guess]:
    """Motions to both sides of an extremal that is no minimum, along which the cost falls at first; none elsewhere."""
    found = _downhill(solution)
    if found is None:
        return []
    simulations, grid, u, change = found
    names, guesses = solution.instance.model.spec.state_names, []
    for fraction in DEPARTED:
        x, _ = simulations.motion(solution.instance.control_set.project(u + fraction * change), grid)
        if np.isfinite(x).all() and solution.instance.model.in_domain(x):
            guesses.append(Guess(state=dict(zip(names, map(tuple, x.tolist()), strict=True))))
    return guesses


def _downhill(solution: Solution) -> tuple[Simulations, Grid, Array, Array] | None:
    """The control of an extremal on a grid, and the change along which the second variation is most negative."""
    simulations = simulations_of(solution)
    if solution.instance.tf is None or simulations is None:
        return None
    grid = simulations.grid()
    found = along(solution, grid)
    if found is None or found.second.drowned:
        return None
    curvature, direction = found.second.steepest()
    shape = found.controls(direction)
    largest = float(np.abs(shape).max(initial=0.0))
    if not (curvature < 0.0 and largest > 0.0):
        return None
    unit = max(float(np.abs(solution.u).max()), float(natural(solution).min())) / largest
    u = stated_control(solution, grid)
    return simulations, grid, u, _keeping_the_end(simulations, grid, u, unit * shape, found)


def _keeping_the_end(simulations: Simulations, grid: Grid, u: Array, change: Array, found: Along) -> Array:
    """A change without what the grid makes of the end, to first order: on its steps changes are no constants."""
    ties = found.second.ties[:-1]  # the last keeps the duration
    if not len(ties):
        return change
    others = [found.controls(one) for one in np.linalg.pinv(ties).T]
    size = float(np.abs(change).max())
    others = [one * size / max(float(np.abs(one).max()), 1e-300) for one in others]
    _, end = simulations(u, grid)
    response = np.array([simulations(u + one, grid)[1] - end for one in others]).T
    added = np.linalg.lstsq(response, end - simulations(u + change, grid)[1], rcond=None)[0]
    return change + np.einsum("c,cmN->mN", added, np.array(others))


def _far(solution: Solution) -> tuple[Simulations, Grid, Array, Array] | None:
    """The control of a minimum on a grid, and the change to one far from it that costs less."""
    drawn = drawn_below(solution) if solution.instance.tf is not None else None
    return None if drawn is None else (drawn.simulations, drawn.grid, drawn.stated, drawn.control - drawn.stated)


def _doubled(simulations: Simulations, grid: Grid, u: Array, change: Array) -> Fall | None:
    """What changes of a control by more and more cost, where they fall without end."""
    instance = simulations.instance
    cost, end = simulations(u, grid)
    _, pushed = simulations(u + change, grid)
    falls, sizes, costs = [], [], []
    for k in range(DOUBLINGS):
        control = u + 2.0**k * change
        now, reached = simulations(control, grid)
        x, _ = simulations.motion(control, grid)
        if not np.isfinite(now) or not instance.model.in_domain(x):
            return None
        moved = 2.0**k * max(1.0, float(np.abs(pushed).max(initial=0.0)))
        if np.abs(reached - end).max(initial=0.0) > KEPT * moved:
            return None
        falls.append(cost - now)
        sizes.append(float(np.abs(control).max()))
        costs.append(now)
    last = np.array(falls[-FALLS - 1 :])
    endless = (last > 0.0).all() and (last[1:] >= PROPORTIONAL * last[:-1]).all()
    return Fall(tuple(sizes), tuple(costs)) if endless else None


@dataclass(frozen=True, eq=False)
class Along:
    """The second variation along a smooth extremal as one arc, and how its control follows changes."""

    second: Quadratic
    feedback: Array
    direct: Array
    """The control by the states and by what changes by itself, in units, shapes (2 N + 1, m, n)."""

    def controls(self, direction: Array) -> Array:
        """What a direction does to the controls at nodes and midpoints of the grid, shape (m, 2 N + 1)."""
        (arc,), n = self.second.arcs, self.feedback.shape[2]
        (h, per), x, found = arc.widths, np.zeros(n + 1), []
        length, unit = direction[0] * arc.lasting, np.sqrt(2.0 / (h * per))
        for k in range(len(self.feedback) // 2):
            first = 1 + (n + 1) * (k // per)
            w = unit * direction[first : first + n + 1]
            middle, after = arc.stepped(k, x, w, np.asarray(length / arc.lasting))
            found += [
                self.feedback[at] @ y[:n] + self.direct[at] @ w[:n] for at, y in ((2 * k, x), (2 * k + 1, middle))
            ]
            x = after
        found.append(self.feedback[-1] @ x[:n] + self.direct[-1] @ w[:n])
        return np.array(found).T


def along(solution: Solution, grid: Grid) -> Along | None:
    """The second variation of a solution; ``None`` where numbers fail.

    Parameters
    ----------
    grid
        On which the linearised motion is integrated.
    """
    instance, n, t = solution.instance, len(solution.x), interleave(grid.nodes, grid.midpoints)
    model, p, bounds = instance.model, instance.parameters, instance.control_set.arguments
    z = np.array([np.interp(t, solution.times, row) for row in np.concatenate([solution.x, solution.lam])])
    state, cost = scaled_units(solution)
    scale = np.concatenate([state[:-1], cost / state[:-1]])
    slopes = np.zeros((len(t), 2 * n, 2 * n + 1))
    slopes[:, :, :-1] = model.canonical_jacobian_batch(t, z[:n], z[n:], p, bounds).transpose(2, 0, 1)
    law, rates = _law_slopes(solution, t, z, scale), np.asarray(model.canonical_batch(t, z[:n], z[n:], p, bounds))
    if not (np.isfinite(slopes).all() and np.isfinite(law).all() and np.isfinite(rates).all()):
        return None
    still = np.zeros(len(t)), np.zeros(len(t))  # the final time is given
    arc = Arc.of(t, slopes, rates, still, state, cost, gcd(grid.steps, PIECES))
    # the law follows the costates as -K B', where push is the root of B K B'
    direct = -law[:, :, n:] @ np.linalg.pinv(arc.push[:, :n, :n], rcond=NUDGE, hermitian=True)
    return Along(quadratic(solution, [arc], state, cost), law[:, :, :n], direct)


def _law_slopes(solution: Solution, t: Array, z: Array, scale: Array) -> Array:
    """The control law by scaled states and costates, by differences, shape (M, m, 2n)."""
    instance, n = solution.instance, len(z) // 2
    size = np.maximum(np.abs(z).max(axis=1), NUDGE * scale)
    change = NUDGE * size[:, None] * np.concatenate([np.eye(2 * n), -np.eye(2 * n)], axis=1)
    moved = (z[:, None] + change[:, :, None]).reshape(2 * n, -1)
    p, bounds = instance.parameters, instance.control_set.arguments
    law = np.asarray(instance.model.control_law_batch(np.tile(t, 4 * n), moved[:n], moved[n:], p, bounds))
    ahead, behind = np.split(law.reshape(len(law), 4 * n, len(t)), 2, axis=1)
    return np.asarray((ahead - behind).transpose(2, 0, 1) * (scale / (2.0 * NUDGE * size)))
