"""How near to the given end a control within its bounds can come: evidence that an instance is infeasible.

The miss is minimised alone, whatever it costs, from several controls, with the gradient by the adjoint equation; first
from motions that nearly meet, the gap between them closed as far as it can be. Where the least miss is not zero, and
most searches end there, no control near these arrives; that is evidence, not a proof, and the distance itself is never
called a solution.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from satsym import activity
from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.grid import Grid
from satsym.solvers.closing_gaps import closed
from satsym.solvers.collocation.curve import Path
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.drawn_motions import STEPS, motions
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits

ROUNDS = 150
"""Iterations from each start."""

ARRIVED, CLOSE = 1e-4, 5e-3
"""Relative miss that the grid and the minimisation may leave of none, and that below which nobody can tell: controls
that switch between nodes of the grid may do better."""

ALIKE, AGREEING = 0.1, 0.5
"""Relative difference of misses that are the same, and the share of the searches that have to find the least one: where
fewer do, others may arrive."""

NO_MOTION = 1e10
"""In place of the miss where a motion is not finite or leaves its domain."""

INSIDE, FAINT = 0.9, 1e-9
"""Share of the largest norm at which vectors start at most, and the size of parameters that stand for none: what the
norm of a vector does has no slope where that is none."""


@dataclass(frozen=True, eq=False)
class Nearest:
    """The nearest end that was found."""

    missed: dict[str, float]
    """By how much each given final state is missed, in the model's units, by its name, and each terminal constraint, by
    its multiplier's."""
    units: dict[str, str]
    """Of states, by their names."""
    distance: float
    """The largest of them, relative to the size of its state along the way."""
    starts: int
    """Controls from which the miss was minimised."""
    agreeing: int
    """How many of them led to this miss."""
    states: Array
    """Of the motion that ends there, scaled, at evenly spaced times, shape (n, STEPS + 1)."""

    @property
    def arrives(self) -> bool:
        """Whether that is no miss, as far as can be told."""
        return self.distance <= ARRIVED

    @property
    def undecided(self) -> bool:
        """Whether it may be no miss, or that of others is none."""
        return self.distance <= CLOSE or self.agreeing < AGREEING * self.starts

    def path(self, tau: Array) -> Array:
        """Scaled states at times tau in [0, 1], shape (n, M)."""
        nodes = np.linspace(0.0, 1.0, STEPS + 1)
        return np.array([np.interp(tau, nodes, row) for row in self.states])

    @property
    def message(self) -> str:
        """One line."""
        misses = ", ".join(
            " ".join(filter(None, [f"{name} by {value:.3g}", self.units.get(name)]))
            for name, value in self.missed.items()
        )
        return (
            f"no control within its bounds was found that reaches the given end: "
            f"the nearest of {self.starts} local searches misses {misses}"
        )


def nearest(problem: TwoPoint, path: Path, limits: Limits) -> Nearest | None:
    """Minimise the miss of the given end.

    Parameters
    ----------
    problem
        With its bounds, and a given final time.
    path
        States and costates whose control law, cut to the bounds, is one of the starts.

    Returns
    -------
    Nearest or None
        ``None`` where the final time is free, where time was up first, or where few of the starts lead to a motion in
        its domain: they say nothing about the others.
    """
    from scipy.optimize import minimize

    if problem.free_time or not (problem.fixed.any() or problem.unknowns):
        return None
    reach = Reach(problem)

    def stop(_: Array) -> None:
        if limits.expired:
            raise StopIteration

    starts = _starts(problem, path, reach.tau)
    best, misses = None, list[float]()
    for k, start in enumerate(starts):
        if limits.expired:
            return None
        activity.tell(f"checking whether the end can be reached: search {k + 1} of {len(starts)} ...")
        with np.errstate(all="ignore"):
            control = tried(start)
            if control is None:
                continue
            found = minimize(
                reach.miss,
                reach.parameters(control).ravel(),
                jac=True,
                method="L-BFGS-B",
                bounds=reach.box,
                callback=stop,
                options={"maxiter": ROUNDS, "maxcor": 20, "ftol": 1e-15, "gtol": 1e-10},
            )
        if not found.fun < NO_MOTION:
            continue
        misses.append(float(np.sqrt(found.fun)))
        if best is None or found.fun < best.fun:
            best = found
        if best is not None and best.fun <= ARRIVED**2 / 2.0:
            break
    if best is None or (2 * len(misses) < len(starts) and best.fun > ARRIVED**2 / 2.0):
        return None
    states, gap, _ = reach.reached(reach.control(best.x))
    spec, units = problem.instance.model.spec, [*problem.scale.state, *(1.0 for _ in range(problem.unknowns))]
    names = [*spec.state_names, *(f"the constraint of {v.symbol}" for v in spec.multipliers)]
    missed = {names[i]: float(gap[k] * units[i]) for k, i in enumerate(reach.rows)}
    agreeing = sum(miss <= (1.0 + ALIKE) * min(misses) for miss in misses)
    scaled = states / problem.scale.state[:, None]
    given = {v.symbol: v.unit for v in spec.states if v.unit != "1"}
    return Nearest(missed, given, float(np.abs(gap).max()), len(misses), agreeing, scaled)


def _starts(problem: TwoPoint, path: Path, tau: Array) -> list[Callable[[], Array]]:
    """Controls from which the miss is minimised: those under which motions nearly meet, and the law of a path."""
    ways = (partial(motions, problem, np.random.default_rng(0), cheapest=cheapest) for cheapest in (True, False))
    drawn = [one for way in ways for one in tried(way) or []]
    law = problem.control(tau, path(tau), path.theta, bounded=False)
    return [
        *(partial(closed, problem, one) for one in drawn),
        *(partial(np.multiply, by, law) for by in (0.0, 1.0, 0.5)),
    ]


def _lengths(part: ControlSet, size: Array) -> tuple[Array, Array]:
    """Norms of vectors that parameters of such sizes stand for, and their derivatives: all that are admissible."""
    if part.directed and not part.throttled:
        return np.full_like(size, part.radius), np.zeros_like(size)
    room = part.radius - part.inner
    return part.inner + room * size / np.sqrt(1.0 + size**2), room / (1.0 + size**2) ** 1.5


class Reach:
    """Where controls lead that are straight between the nodes of a uniform grid."""

    def __init__(self, problem: TwoPoint) -> None:
        instance = problem.instance
        assert instance.tf is not None
        self.problem, self.grid = problem, Grid.uniform(instance.t0, instance.tf, STEPS)
        self.tau = np.linspace(0.0, 1.0, STEPS + 1)
        self.rows = np.append(np.flatnonzero(problem.fixed), problem.states + np.arange(problem.unknowns))
        self.controls = len(instance.model.spec.controls)
        whole = instance.control_set
        parts = whole.parts if whole.kind == "product" else ((tuple(range(self.controls)), whole),)
        self.parts = [(list(places), part) for places, part in parts]
        self.vectors = [(places, part) for places, part in self.parts if part.kind in ("ball", "annulus")]
        self.vectors = [(places, part) for places, part in self.vectors if np.isfinite(part.radius)]

    @property
    def box(self) -> list[tuple[float, float]]:
        """Bounds of the parameters: the controls themselves, but vectors are all mapped to admissible ones."""
        pairs = [(-np.inf, np.inf)] * self.controls
        for places, part in self.parts:
            if part.kind == "box":
                for place, low, high in zip(places, part.lower, part.upper, strict=True):
                    pairs[place] = low, high
        return [pair for pair in pairs for _ in range(STEPS + 1)]

    def parameters(self, u: Array) -> Array:
        """Parameters of a control, cut to its bounds."""
        found = np.array(self.problem.instance.control_set.project(u))
        for places, part in self.vectors:
            length, room = np.linalg.norm(u[places], axis=0), max(part.radius - part.inner, 1e-300)
            share = np.clip((length - part.inner) / room, 0.0, INSIDE)
            size = share / np.sqrt(1.0 - share**2)
            found[places] = u[places] * np.where(length > 0.0, size / np.maximum(length, 1e-300), 0.0)
            found[places[0]] += np.where(np.linalg.norm(found[places], axis=0) > 0.0, 0.0, FAINT)
        return found

    def control(self, parameters: Array) -> Array:
        """The control, shape (m, N + 1)."""
        found = parameters.reshape(self.controls, -1).copy()
        for places, part in self.vectors:
            size = np.maximum(np.linalg.norm(found[places], axis=0), FAINT)
            found[places] *= _lengths(part, size)[0] / size
        return found

    def _by_parameters(self, parameters: Array, slope: Array) -> Array:
        """Derivatives by the parameters, from those by the control."""
        found, v = slope.copy(), parameters.reshape(self.controls, -1)
        for places, part in self.vectors:
            size = np.maximum(np.linalg.norm(v[places], axis=0), FAINT)
            length, growth = _lengths(part, size)
            unit = v[places] / size
            along = (unit * slope[places]).sum(axis=0)
            found[places] = growth * along * unit + length / size * (slope[places] - along * unit)
        return found

    def reached(self, u: Array) -> tuple[Array, Array, Array]:
        """States at the nodes, the scaled miss of what ties the end, and its derivatives by the scaled final state."""
        problem, instance = self.problem, self.problem.instance
        middle = (u[:, 1:] + u[:, :-1]) / 2.0
        x, _, _ = instance.model.forward(self.grid.nodes, instance.initial, u, middle, instance.parameters)
        end = np.append(x[:, -1] / problem.scale.state, np.zeros(problem.states))
        slopes, _ = problem.boundary_slopes(end, problem.theta)
        return x, problem.boundary(end, problem.theta)[self.rows], slopes[self.rows, : problem.states]

    def miss(self, parameters: Array) -> tuple[float, Array]:
        """Half the squared miss, and its gradient."""
        problem, instance = self.problem, self.problem.instance
        u = self.control(parameters)
        x, gap, slopes = self.reached(u)
        if not np.isfinite(x).all() or not instance.model.in_domain(x):
            return NO_MOTION, np.zeros_like(parameters)
        n = problem.states
        by_x = instance.model.jacobian_x_batch(self.grid.nodes, x, u, instance.parameters)
        by_u = instance.model.jacobian_u_batch(self.grid.nodes, x, u, instance.parameters)
        adjoint = np.zeros((n, STEPS + 1))
        adjoint[:, -1] = (gap @ slopes) / problem.scale.state
        width, transposed = self.grid.nodes[1] - self.grid.nodes[0], by_x.transpose(2, 1, 0)
        # Trapezoids: second order is plenty for a direction of descent.
        one = np.eye(n)
        backwards = np.linalg.solve(one - width / 2.0 * transposed[:-1], one + width / 2.0 * transposed[1:])
        for k in range(STEPS, 0, -1):
            adjoint[:, k - 1] = backwards[k - 1] @ adjoint[:, k]
        weights = np.full(STEPS + 1, width)
        weights[[0, -1]] /= 2.0
        slope = np.einsum("ijk,ik->jk", by_u, adjoint) * weights
        return float(gap @ gap) / 2.0, self._by_parameters(parameters, slope).ravel()
