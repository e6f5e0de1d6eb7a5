"""Random extremals from both ends that may combine to a cheaper motion than a known extremal, for given or free times.

A cheaper motion needs no larger controls, so that random costates have about the magnitudes of the known ones; if the
duration is free, they are scaled such that H vanishes, as it does along the whole motion then, and motions may meet
after any time.

If an extremal from the initial state comes close to one integrated backwards from the final state, the two nearly form
a motion between both ends, and each is extremal for its part. If motions oscillate, only controls with the right timing
arrive, as costates provide it; and motions that are unstable forwards are stable backwards.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.solution import Solution
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import straight
from satsym.solvers.spare_time import longest

STEPS, LONGER = 100, 2.4
"""Number of Runge-Kutta steps in the known duration, and largest ratio of a free duration to the known one."""

DRAWN, SIZES = 512, (-1.5, 0.7)
"""Number of random extremals from each end, and range of the decimal logarithm of their costates' magnitudes, relative
to the largest known one."""

ROUNDS, CHILDREN, PARENTS, NEAR_GAP = (0.3, 0.1), 256, 48, 0.15
"""Relative changes of costates for further extremals in successive rounds; number of these extremals in each round;
number of the cheapest pairs from which they are derived; largest gap of these pairs."""

TIMES, ANY_TIMES, NEIGHBOURS = 8, 40, 4
"""Number of times at which extremals may meet, for a given and for a free duration; number of nearest extremals from
the other end that are compared."""

CLOSE_GAP, FEWEST, MOST_PAIRS = 0.1, 64, 4000
"""Gap that counts as small, relative to the range of the known states; number of pairs that are used if none has a
small gap; maximum number of pairs."""

KEPT, SEPARATION, SHOWN = 4, 0.3, 21
"""Maximum number of motions that are returned; minimum difference between these and from the known one, relative to the
range of the states or, for durations, as a difference of logarithms; number of times at which motions are compared."""

SEARCHED, HALVINGS = np.geomspace(1e-3, 1e2, 26), 12
"""Magnitudes of costates, relative to the known ones, between which a sign change of H is searched for, and number of
bisections."""

SAMPLES = 401
"""Number of evenly spaced times at which a known extremal is sampled."""


@dataclass(frozen=True, eq=False)
class Known:
    """A known extremal in scaled variables; its problem has the same duration."""

    states: Array
    """States at evenly spaced times, shape (n, M)."""
    costates: Array
    """Costates at the same times, shape (n, M)."""
    cost: float
    longest: float
    """Longest duration of other motions, equal to its own if that is given."""
    free: bool = False
    """Whether other motions may have any duration up to the longest one."""

    @property
    def size(self) -> float:
        """Return the largest norm of the costates."""
        return float(np.linalg.norm(self.costates, axis=0).max())


@dataclass(frozen=True, eq=False)
class Beside:
    """A motion other than the known extremal that is approximately an extremal."""

    duration: float
    z: Array
    """Scaled states and costates at evenly spaced times, shape (2n, M); the gap between both parts is distributed over
    them."""

    @property
    def states(self) -> Array:
        """Return the scaled states at evenly spaced times, shape (n, M)."""
        return self.z[: len(self.z) // 2]


def about(solution: Solution, problem: TwoPoint, seed: int) -> list[Beside]:
    """Return motions near a solution that may cost less, as :func:`beside` does."""
    even = np.linspace(solution.times[0], solution.times[-1], SAMPLES)
    z = [np.interp(even, solution.times, row) for row in (*solution.x, *solution.lam)] / problem.scale.both
    n, free = problem.states, solution.instance.tf is None
    known = Known(z[:n], z[n:], solution.objective / problem.scale.cost, longest(solution), free)
    return beside(problem, known, np.random.default_rng(seed))


def beside(problem: TwoPoint, known: Known, rng: np.random.Generator) -> list[Beside]:
    """Return different motions that nearly meet and would cost less if they did, the cheapest first.

    Parameters
    ----------
    problem
        Problem with its bounds, and with the duration of the known extremal.
    """
    if problem.unknowns or not problem.fixed.any() or not known.size > 0.0:
        return []
    given = np.array(problem.final[: problem.states]) > 0.0
    if problem.fixed.all():  # what the end costs is no part of either motion
        end = np.concatenate([straight(problem)[:, 1], np.zeros(problem.states)])
        known = replace(known, cost=known.cost - problem.terminal_cost(end, problem.theta))
    free = known.free and problem.instance.model.spec.autonomous and bool(given.all())
    with np.errstate(all="ignore"):
        field = (_of_any_duration if free else _of_given)(problem, known, rng)
        for size in ROUNDS:
            field = field.refined(size, rng)
        return field.different()


def _directions(n: int, count: int, rng: np.random.Generator) -> Array:
    found = rng.standard_normal((n, count))
    return np.asarray(found / np.linalg.norm(found, axis=0))


def _of_given(problem: TwoPoint, known: Known, rng: np.random.Generator) -> _Field:
    """Return random extremals with the known duration."""
    first, last = (
        _directions(problem.states, DRAWN, rng) * known.size * 10.0 ** rng.uniform(*SIZES, DRAWN) for _ in range(2)
    )
    onwards = _from_start(problem, first, STEPS)
    backwards = _to_end(problem, onwards, last, rng, STEPS)
    return _Field(problem, known, problem.duration, False, onwards, backwards)


def _of_any_duration(problem: TwoPoint, known: Known, rng: np.random.Generator) -> _Field:
    """Return random extremals with vanishing H, up to the longest duration."""
    steps = int(np.ceil(STEPS * min(known.longest / problem.duration, LONGER)))
    nothing = Bundle(np.zeros((steps + 1, 2 * problem.states, 0)), np.zeros((steps + 1, 0)))
    field = _Field(problem, known, known.longest, True, nothing, nothing)
    return field.joined(_directions(problem.states, DRAWN, rng), _directions(problem.states, DRAWN, rng), rng)


def _vanishing(problem: TwoPoint, state: Array, directions: Array, size: float) -> Array:
    """Return costates in given directions for which H vanishes at a state, without directions that have none."""
    state = np.repeat(state[:, None], directions.shape[1], axis=1)
    model, p = problem.instance.model, problem.instance.parameters
    tau = np.zeros(directions.shape[1])

    def hamiltonian(sizes: Array) -> Array:
        z = np.concatenate([state, directions * sizes])
        physical, u = z * problem.scale.both, problem.control(tau, z, problem.theta)
        x, lam = physical[: problem.states], physical[problem.states :]
        t = np.full(len(tau), problem.instance.t0)
        return np.asarray(np.broadcast_to(model.hamiltonian_batch(t, x, u, lam, p), tau.shape))

    values = np.array([hamiltonian(np.full(len(tau), size * share)) for share in SEARCHED])
    changes = values[:-1] * values[1:] <= 0.0
    fit, at = np.flatnonzero(changes.any(axis=0)), changes.argmax(axis=0)
    low, high = size * SEARCHED[at], size * SEARCHED[at + 1]
    begin = np.take_along_axis(values, at[None], axis=0)[0]
    for _ in range(HALVINGS):
        middle = np.sqrt(low * high)
        same = hamiltonian(middle) * begin > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return np.asarray((directions * np.sqrt(low * high))[:, fit])


@dataclass(frozen=True, eq=False)
class _Field:
    """Random extremals from both ends.

    A pair of them is a row of six numbers: node on the forward extremal, node on the backward extremal, indices of the
    two extremals, gap, and cost.
    """

    problem: TwoPoint
    known: Known
    longest: float
    free: bool
    onwards: Bundle
    backwards: Bundle

    def joined(self, first: Array, last: Array, rng: np.random.Generator) -> _Field:
        """Return the field with extremals of given costates added, scaled for vanishing H if durations are free."""
        problem, steps = self.problem, len(self.onwards.z) - 1
        if not self.free:
            onwards = _from_start(problem, first, steps)
            backwards = _to_end(problem, onwards, last, rng, steps)
        else:
            ends = problem.initial, straight(problem)[:, 1]
            bundles = []
            for state, costates, sign in zip(ends, (first, last), (1.0, -1.0), strict=True):
                lam = _vanishing(problem, state, costates / np.linalg.norm(costates, axis=0), self.known.size)
                z = np.concatenate([np.repeat(state[:, None], lam.shape[1], axis=1), lam])
                bundles.append(simulated(problem, z, sign * self.longest, steps))
            onwards, backwards = bundles
        return replace(self, onwards=self.onwards.joined(onwards), backwards=self.backwards.joined(backwards))

    def refined(self, size: float, rng: np.random.Generator) -> _Field:
        """Return the field with further extremals added, near the cheapest and the closest pairs."""
        n, pairs = self.problem.states, self.cheapest(NEAR_GAP)
        pairs = pairs[:PARENTS]
        if not len(pairs):
            return self
        of = pairs[rng.integers(len(pairs), size=CHILDREN)].astype(int)
        first, last = (
            one + size * np.linalg.norm(one, axis=0) * rng.standard_normal(one.shape) / np.sqrt(n)
            for one in (self.onwards.z[0][n:, of[:, 2]], self.backwards.z[-1][n:, of[:, 3]])
        )
        return self.joined(first, last, rng)

    @property
    def unit(self) -> Array:
        """Return the ranges of the known states, shape (n,)."""
        found = np.ptp(self.known.states, axis=1)
        return np.asarray(np.where(found > 0.0, found, max(float(found.max()), 1e-300)))

    def cheapest(self, gap: float) -> Array:
        """Return pairs cheaper than the known extremal with gaps below a limit, at least some; cheapest first."""
        found = self._pairs
        found = found[found[:, 5] < self.known.cost]
        found = found[np.argsort(found[:, 4])]
        found = found[: max(FEWEST, int(np.searchsorted(found[:, 4], gap)))]
        return np.asarray(found[np.argsort(found[:, 5])])

    @property
    def _pairs(self) -> Array:
        """Return pairs of extremals that are close to each other, shape (P, 6)."""
        from scipy.spatial import cKDTree

        steps, found = len(self.onwards.z) - 1, [np.zeros((0, 6))]
        nodes = np.linspace(0, steps, (ANY_TIMES if self.free else TIMES) + 1)[1:].astype(int)
        for group in [nodes] if self.free else nodes[:, None]:
            here, there = (
                self._points(self.onwards, group),
                self._points(self.backwards, steps - group if self.free else group),
            )
            near = min(NEIGHBOURS, there.places.shape[1])
            if not (here.places.shape[1] and near):
                continue
            gaps, places = cKDTree(there.states.T).query(here.states.T, k=np.arange(1, near + 1))
            met = np.isfinite(gaps)  # else so far apart that their distance overflows
            row = np.broadcast_to(np.arange(here.places.shape[1])[:, None], met.shape)[met]
            one, other = here.places[:, row], there.places[:, places[met]]
            cost, gap = here.costs[row] + there.costs[places[met]], gaps[met]
            found.append(np.column_stack([one[0], other[0], one[1], other[1], gap, cost]))
        return np.concatenate(found)

    def _points(self, side: Bundle, nodes: NDArray[np.int64]) -> _Points:
        """Return the states through which the extremals from one end pass at given nodes."""
        n, costs = self.problem.states, side.costs[nodes]
        at, which = np.nonzero(np.isfinite(costs) & (costs < self.known.cost))
        states = side.z[nodes[at], :n, which].T / self.unit[:, None]
        return _Points(states, costs[at, which], np.array([nodes[at], which]))

    def different(self) -> list[Beside]:
        """Return the cheapest pairs as motions that differ from each other and from the known extremal."""
        pairs, n = self.cheapest(CLOSE_GAP)[:MOST_PAIRS], self.problem.states
        motions, durations = self._motions(pairs, SHOWN)
        motions = motions[:, :n]
        shares = np.linspace(0.0, 1.0, self.known.states.shape[1])
        shown = np.linspace(0.0, 1.0, SHOWN)
        own = np.array([np.interp(shown, shares, row) for row in self.known.states])

        def apart(states: Array, duration: float) -> NDArray[np.bool_]:
            far = np.abs((motions - states) / self.unit[:, None]).max(axis=(1, 2)) >= SEPARATION
            return np.asarray(far | (np.abs(np.log(durations / duration)) >= SEPARATION))

        kept: list[Beside] = []
        left = apart(own, self.problem.duration)
        while left.any() and len(kept) < KEPT:
            k = int(left.argmax())
            others = apart(motions[k], float(durations[k]))
            kept.append(Beside(float(durations[k]), self._motions(pairs[k : k + 1])[0][0]))
            left &= others
        return kept

    def _motions(self, pairs: Array, count: int = 0) -> tuple[Array, Array]:
        """Return states and costates at fractions of pairs' durations, or at all nodes of one, and the durations."""
        steps = len(self.onwards.z) - 1
        first, second, one, other = pairs[:, :4].astype(int).T
        lasting = first + steps - second
        at = np.rint(np.linspace(0.0, 1.0, count or int(lasting[0]) + 1) * lasting[:, None]).astype(int)
        before, after = np.minimum(at, first[:, None]), np.clip(second[:, None] + at - first[:, None], 0, steps)
        ahead = at <= first[:, None]
        early = self.onwards.z[before, :, one[:, None]]
        late = self.backwards.z[after, :, other[:, None]]
        jump = (self.backwards.z[second, :, other] - self.onwards.z[first, :, one])[:, None]
        rest = np.maximum(lasting - first, 1)[:, None]
        halves = np.where(ahead, at / np.maximum(first, 1)[:, None], (at - lasting[:, None]) / rest) / 2.0
        found = np.where(ahead[:, :, None], early, late) + jump * halves[:, :, None]
        return found.transpose(0, 2, 1), lasting / steps * self.longest


@dataclass(frozen=True, eq=False)
class _Points:
    """States of random extremals at given nodes, divided by the ranges of the known states.

    ``costs`` are the costs of these extremals up to these nodes or, from the other end, after them.
    """

    states: Array
    costs: Array
    places: NDArray[np.int64]
    """Node and index of each extremal, shape (2, P)."""


@dataclass(frozen=True, eq=False)
class Bundle:
    """Random extremals from the initial state, or backwards from the final state."""

    z: Array
    """Scaled states and costates at the nodes in order of time, shape (STEPS + 1, 2n, S)."""
    costs: Array
    """Costs up to the nodes, or from the nodes to the end, shape (STEPS + 1, S); infinite after the motion has left the
    domain."""

    def joined(self, other: Bundle) -> Bundle:
        """Return both bundles as one."""
        return Bundle(np.concatenate([self.z, other.z], axis=2), np.concatenate([self.costs, other.costs], axis=1))


def _from_start(problem: TwoPoint, costates: Array, steps: int) -> Bundle:
    """Return extremals from the initial state with given costates, shape (n, S), over the whole duration."""
    start = np.repeat(problem.initial[:, None], costates.shape[1], axis=1)
    return simulated(problem, np.concatenate([start, costates]), problem.duration, steps)


def _to_end(problem: TwoPoint, onwards: Bundle, costates: Array, rng: np.random.Generator, steps: int) -> Bundle:
    """Return extremals to the final state; free final states come from forward motions, with transversality."""
    n, free, reached = problem.states, ~problem.fixed, np.flatnonzero(np.isfinite(onwards.costs[-1]))
    count = costates.shape[1]
    end, terminal = np.repeat(straight(problem)[:, 1:], count, axis=1), np.zeros(count)
    if free.any() and len(reached):
        end[free] = onwards.z[-1][:n, rng.choice(reached, count)][free]
        for k, z in enumerate(np.concatenate([end, costates]).T):
            costates[free, k] -= problem.boundary(z, problem.theta)[:n][free]
            terminal[k] = problem.terminal_cost(z, problem.theta)
    found = simulated(problem, np.concatenate([end, costates]), -problem.duration, steps)
    return Bundle(found.z, found.costs + terminal)


def simulated(problem: TwoPoint, z: Array, lasting: float, steps: int) -> Bundle:
    """Return extremals through given states and costates, (2n, S), over a duration; backwards if it is negative."""
    backwards, theta = lasting < 0.0, problem.theta
    tau = lasting / problem.duration * np.linspace(0.0, 1.0, 2 * steps + 1) + backwards
    times, h = np.repeat(tau[:, None], z.shape[1], axis=1), lasting / steps
    found = [z]
    for first, middle, last in zip(times[:-2:2], times[1::2], times[2::2], strict=True):
        f1 = problem.rates(first, z, theta)
        f2 = problem.rates(middle, z + h / 2.0 * f1, theta)
        f3 = problem.rates(middle, z + h / 2.0 * f2, theta)
        z = z + h / 6.0 * (f1 + 2.0 * (f2 + f3) + problem.rates(last, z + h * f3, theta))
        found.append(z)
    nodes = np.array(found)
    flat = nodes.transpose(1, 0, 2).reshape(len(z), -1)
    running = problem.running_cost(times[::2].ravel(), flat, theta).reshape(len(nodes), -1)
    costs = np.zeros_like(running)
    costs[1:] = abs(h) * np.cumsum((running[1:] + running[:-1]) / 2.0, axis=0)
    inside = np.isfinite(nodes).all(axis=1) & (nodes[:, list(problem.positive)] > 0.0).all(axis=1)
    costs[~np.logical_and.accumulate(inside & np.isfinite(costs), axis=0)] = np.inf
    return Bundle(nodes[::-1], costs[::-1]) if backwards else Bundle(nodes, costs)
