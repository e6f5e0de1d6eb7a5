"""The reachable set of a linear motion with controls in a box in a given time, and the cost of its points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.switching.linear.linear_motion import LinearMotion

FEWEST, MOST_STEPS, PER_RADIAN = 160, 1600, 16.0
"""Minimum and maximum number of steps of a duration, and number of steps for each unit of the fastest rate times the
duration."""

FLAT = 1e-9
"""Width of the reachable set, relative to its size, in a direction in which no control acts."""

THERE = 1e-6
"""Distance of an end from the reachable set, relative to the size of the set, that counts as zero."""

CHEAPER = 1e-7
"""Relative gap between a cost and its lower bound at which the minimum cost is found."""

TIGHT = 0.1
"""Relative amount by which a separating hyperplane may be closer to the end than the reachable set."""

SEARCHES = 60
"""Maximum number of hyperplanes that are determined for a cost."""

MOST_SUPPORTS = 400
"""Maximum number of support points for a nearest point."""

NO_GAIN = 1e-13
"""Relative gain of a support point below which it counts as rounding."""


@dataclass(frozen=True)
class Priced:
    """The minimum cost of an end, up to the discretisation by steps of equal length."""

    cost: float
    """Lower bound of the cost, equal to it up to the accuracy of the search."""
    costate: Array
    """Final costates of all states, shape (n,), for which the optimum minimises H."""


@dataclass(frozen=True, eq=False)
class Reach:
    """The reachable set of a linear motion in a given time."""

    instance: Instance
    motion: LinearMotion
    """Instance and its motion."""
    duration: float
    """Duration from the start."""
    finer: int = 1
    """Factor of the number of steps; short arcs only show with more steps."""

    @cached_property
    def rows(self) -> NDArray[np.intp]:
        """Indices of the states that are given at the end."""
        return given_rows(self.instance)

    @cached_property
    def count(self) -> int:
        """Number of steps into which the duration is divided."""
        return self.finer * steps(self.motion, self.duration)

    @cached_property
    def powers(self) -> Array:
        """State transition matrices of 0, 1, ... N steps, shape (N + 1, n, n)."""
        return self.motion.powers(self.duration / self.count, self.count)

    def pushing(self, costate: Array) -> Array:
        """Return the effect of controls at each node on the final states, weighted by final costates, (m, N + 1)."""
        return np.asarray((costate @ self.powers[::-1] @ self.motion.controls).T)

    def switching(self, costate: Array) -> tuple[Array, Array]:
        """Return switching functions and weights of |u| at the nodes for final costates, shapes (m, N + 1)."""
        sigma = self.pushing(costate) + self.motion.slope[:, None]
        return sigma, np.broadcast_to(self.motion.weight[:, None], sigma.shape)

    def rate(self, costate: Array) -> float:
        """Return H at the final time for given final costates, with the motion of the given end included."""
        motion, length, t = self.motion, self.duration / self.count, self.instance.t0 + self.duration
        sigma, weight = self.switching(costate)
        low, rest, high = (row[:, None] for row in self.levels.reshape(3, len(sigma), -1)[:, :, 0])
        u = np.where(sigma > weight, low, np.where(sigma < -weight, high, rest))
        _, acting, drift = motion.step(length)
        pushed = acting @ (u[:, 1:] + u[:, :-1]) / 2.0 + drift[:, None]
        end = self.powers[-1] @ np.array(self.instance.initial)
        end = end + np.einsum("kij,jk->i", self.powers[self.count - 1 :: -1], pushed)
        f = motion.states @ end + motion.controls @ u[:, -1] + motion.drift
        cost = motion.rate + float(motion.slope @ u[:, -1] + motion.weight @ np.abs(u[:, -1]))
        before, after = (goal(self.instance, self.rows, at) for at in (t - length, t + length))
        return cost + float(costate @ f) - float(costate[self.rows] @ (after - before)) / (2.0 * length)

    @cached_property
    def steps(self) -> tuple[Array, Array]:
        """Effects of each step's controls on the given final states, (F, m, N), and these states without control."""
        motion, count, powers = self.motion, self.count, self.powers[:, self.rows]
        _, acting, drift = motion.step(self.duration / count)
        effects = (powers[count - 1 :: -1] @ acting).transpose(1, 2, 0)
        base = powers[-1] @ np.array(self.instance.initial) + powers[:-1].sum(axis=0) @ drift
        return effects, base

    @cached_property
    def round(self) -> tuple[Array, Array, Array]:
        """Coordinates in which the reachable set is about as long as wide, and the given end is the origin.

        The matrix from given states to these coordinates, (F, F); the effects of controls in them, (F, m N); and the
        uncontrolled end in them.
        """
        effects, base = self.steps
        flat = effects.reshape(len(self.rows), -1) * (self.levels[2] - self.levels[0]) / 2.0
        size = np.sqrt((flat**2).sum(axis=1))
        scale = np.maximum(np.abs(base), np.abs(self.goal))
        size = np.where(size > 0.0, size, np.where(scale > 0.0, scale, 1.0))
        values, axes = np.linalg.eigh((flat / size[:, None]) @ (flat / size[:, None]).T)
        widths = np.sqrt(np.maximum(values, FLAT**2 * max(float(values.max(initial=0.0)), 1e-300)))
        towards = (axes / widths).T / size / np.sqrt(flat.shape[1])
        return towards, towards @ effects.reshape(len(self.rows), -1), towards @ (base - self.goal)

    @cached_property
    def goal(self) -> Array:
        """Given final states, shape (F,)."""
        return goal(self.instance, self.rows, self.instance.t0 + self.duration)

    def separation(self, tight: float = TIGHT) -> tuple[float, Array]:
        """Return a lower bound of the distance of the end from the reachable set, and the costate that proves it.

        The bound is relative to the size of the set, and not positive if the end is in the set.
        """
        towards, effects, base = self.round
        low, high = self.levels[0], self.levels[2]

        def support(direction: Array) -> Array:
            return np.asarray(base + effects @ np.where(direction @ effects > 0.0, low, high))

        near = nearest_point(support, support(base), THERE, tight)
        return near.distance, self.in_full(towards.T @ near.point)

    @cached_property
    def levels(self) -> Array:
        """Lower bounds, values at rest and upper bounds of the controls in each step, shape (3, m N)."""
        low, high = np.array(self.instance.lower), np.array(self.instance.upper)
        return np.repeat([low, np.clip(0.0, low, high), high], self.count, axis=1)

    def minimum_cost(self) -> Priced | None:
        """Return the minimum cost of the end, which must be in the set; ``None`` if no costate proves it."""
        towards, effects, base = self.round
        length = self.duration / self.count
        slope, weight = (np.repeat(row, self.count) * length for row in (self.motion.slope, self.motion.weight))
        found = cheapest(effects, base, self.levels, slope * self.levels + weight * np.abs(self.levels))
        return None if found is None else Priced(found[0], self.in_full(towards.T @ found[1]))

    def nearest_miss(self) -> Array:
        """Return by how much the nearest reachable end misses the given one, shape (F,), in the model's units.

        The distance is measured in units of the effect of the controls on each state.
        """
        effects, base = self.steps
        low, high = self.levels[0], self.levels[2]
        moved = np.abs(effects.reshape(len(base), -1)) @ np.maximum(np.abs(low), np.abs(high))
        sizes = np.maximum(moved, 1e-12 * max(float(np.abs(self.goal).max(initial=0.0)), 1e-300))
        flat = effects.reshape(len(base), -1) / sizes[:, None]
        from_goal = (base - self.goal) / sizes

        def support(direction: Array) -> Array:
            return np.asarray(from_goal + flat @ np.where(direction @ flat > 0.0, low, high))

        near = nearest_point(support, support(from_goal), 0.0, 1e-9)
        return np.asarray(near.fractions @ near.corners * sizes)

    def in_full(self, costate: Array) -> Array:
        """Return costates of all states from those of the given states, with zeros for the others."""
        found = np.zeros(len(self.instance.initial))
        found[self.rows] = costate
        return found


def cheapest(effects: Array, base: Array, levels: Array, prices: Array) -> tuple[float, Array] | None:
    """Return the minimum price of levels that lead to the origin, and the multipliers that prove it.

    Parameters
    ----------
    effects
        Effects of a unit of each control, shape (F, K).
    base
        The end without controls, shape (F,).
    levels, prices
        Levels available for each control, and their prices, shapes (c, K).

    Returns
    -------
    tuple or None
        A lower bound that is equal to the price up to the accuracy of the search; and multipliers, shape (F,), for
        which each control is at the level that minimises price plus multipliers times effects. ``None`` if no
        multipliers prove a bound.
    """
    lowest, highest = (float(f(prices, axis=0).sum()) for f in (np.min, np.max))
    unit = max(highest - lowest, 1e-300)
    bound = 0.0  # of the price, from its least, in this unit

    def support(direction: Array) -> Array:
        pushed = direction[:-1] @ effects
        best = (pushed * levels + direction[-1] / unit * prices).argmin(axis=0)
        end = base + effects @ np.choose(best, levels)
        return np.append(end, (float(np.choose(best, prices).sum()) - lowest) / unit - bound)

    first, found = support(np.append(base, 0.0)), None
    for _ in range(SEARCHES):
        near = nearest_point(support, first, THERE, TIGHT)
        outwards = float(near.point[-1])
        if near.distance <= THERE or outwards <= FLAT * float(np.linalg.norm(near.point)):
            break
        found = near.point[:-1] * (unit / outwards)
        gain = near.distance * float(np.linalg.norm(near.point)) / outwards
        bound += gain
        first = near.fractions @ near.corners - np.append(np.zeros(len(base)), gain)
        if gain <= CHEAPER:
            break
    return None if found is None else (lowest + bound * unit, found)


def steps(motion: LinearMotion, duration: float) -> int:
    """Return the number of steps that resolves a duration."""
    quickest = float(np.abs(np.linalg.eigvals(motion.states)).max(initial=0.0))
    return int(min(max(FEWEST, np.ceil(PER_RADIAN * quickest * duration)), MOST_STEPS))


def given_rows(instance: Instance) -> NDArray[np.intp]:
    """Return the indices of the states that are given at the end."""
    return np.flatnonzero(np.array(final_argument(instance)).reshape(3, -1)[:2].any(axis=0))


def goal(instance: Instance, rows: NDArray[np.intp], t: float) -> Array:
    """Return the given end values of some states, shape (F,)."""
    given, on_reference, target = np.array(final_argument(instance)).reshape(3, -1)
    wanted = given * target
    if on_reference.any():
        wanted = wanted + on_reference * np.array(instance.model.reference(t, instance.parameters))
    return np.asarray(wanted[rows])


@dataclass(frozen=True, eq=False)
class Near:
    """A point of a convex set that is approximately nearest to the origin."""

    point: Array
    """Point of the set, shape (d,). It is also the direction of a hyperplane that separates the set from the origin, if
    one is known."""
    distance: float
    """Distance of the separating hyperplane from the origin, a lower bound of the set's distance; not positive if no
    hyperplane separates them."""
    corners: Array
    fractions: Array
    """Support points, shape (k, d), and weights with which the point is their mean."""


def nearest_point(support: Callable[[Array], Array], first: Array, close: float, tight: float) -> Near:
    """Return approximately the point of a convex set that is nearest to the origin, from support points of the set.

    Wolfe's algorithm determines the nearest point of the hull of few support points, which are added one at a time
    (Wolfe, Finding the nearest point in a polytope, Mathematical Programming 11, 1976).

    Parameters
    ----------
    support
        Function from a direction to the point of the set with the smallest scalar product with this direction.
    first
        A point of the set.
    close
        Distance that counts as zero.
    tight
        Relative amount by which the hyperplane may be closer to the origin than the point.
    """
    corners: Array = first[None]
    fractions: Array = np.ones(1)
    point, direction, best = first, first, -np.inf
    for _ in range(MOST_SUPPORTS):
        length = float(np.linalg.norm(point))
        if length <= close:
            break
        found = support(point)
        distance = float(point @ found) / length
        if distance > best:
            best, direction = distance, point
        if best >= (1.0 - tight) * length or float(point @ (point - found)) <= NO_GAIN * length * length:
            break
        corners, fractions = _with(corners, fractions, found)
        point = fractions @ corners
    return Near(direction if best > 0.0 else point, best, corners, fractions)


def _with(corners: Array, fractions: Array, new: Array) -> tuple[Array, Array]:
    """Return the nearest point of the hull with one more corner, as corners and weights, without unneeded corners."""
    corners, fractions = np.concatenate([corners, new[None]]), np.append(fractions, 0.0)
    for _ in range(2 * len(corners)):
        wanted = _affine(corners)
        if (wanted > 0.0).all():
            return corners, wanted
        falling = wanted <= 0.0
        steps = fractions[falling] / np.maximum(fractions[falling] - wanted[falling], 1e-300)
        fractions = fractions + min(float(steps.min()), 1.0) * (wanted - fractions)
        kept = fractions > 1e-14
        kept[int(np.argmax(fractions))] = True
        if kept.all():
            kept[np.flatnonzero(falling)[int(np.argmin(steps))]] = False
        corners, fractions = corners[kept], fractions[kept] / fractions[kept].sum()
    return corners, fractions


def _affine(corners: Array) -> Array:
    """Return weights, with sum 1, of the point of smallest norm on the plane through all corners."""
    if len(corners) == 1:
        return np.ones(1)
    sides = corners[1:] - corners[0]
    found = np.linalg.lstsq(sides.T, -corners[0], rcond=1e-13)[0]
    return np.append(1.0 - found.sum(), found)
