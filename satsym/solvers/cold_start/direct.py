"""A cold start where the law says nothing at vanishing costates: a direct method first.

Controls are straight lines between a few knots, their motion is simulated, and sequential quadratic programming makes
it cheap and brings it to the end; gradients come from the costates of the motion. The multipliers of the end are those
with which these gradients nearly vanish together, and with them states and costates are so near to an extremal that
Newton's method goes on with the law itself. It starts from controls that are drawn, the nearest to the end first.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache, cached_property

import numpy as np

from satsym.arrays import Array
from satsym.control_set import UNSMOOTHED
from satsym.grid import interleave
from satsym.instance import Instance
from satsym.solvers.cold_start.by_newton import by_newton
from satsym.solvers.cold_start.origin import Origin, Start
from satsym.solvers.collocation.problem import Scale, TwoPoint
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.iteration import Limits

KNOTS, STEPS, FINER = 25, 4, 2
"""Of the controls, steps of the simulation from one to the next, and how often knots are put between them."""

DRAWN, STARTS, WAVES = 60, 4, 2
"""Controls that are drawn, those of them from which one starts, and their waves."""

SMALLER = 0.05
"""Share of them that is drawn where the motion leaves all bounds under the first ones."""

LONGEST, LOOKED = 30.0, 400
"""Free durations are looked for up to so many of the motion's own time scales, at so many times."""

PROGRAMMES, SATISFIED = 300, 1e-6
"""Steps of the programme at most, and by how much of their size ends may be missed after it."""

FLAT = (1e-6, 1e-8)
"""Relative changes of the cost at which it ends: Newton's method mostly goes on from the first, else the second."""

SMALLEST = 1e-9


@dataclass(frozen=True, eq=False)
class Programme:
    """An instance as a problem of finitely many unknowns: controls at knots, then the duration where it is free."""

    instance: Instance
    size: Array
    """Of each state, shape (n,)."""
    knots: int = KNOTS
    """Of the controls."""

    @cached_property
    def fixed(self) -> list[int]:
        """The states whose end is given."""
        return [i for i, v in enumerate(self.instance.model.spec.state_names) if v in self.instance.final]

    @cached_property
    def target(self) -> Array:
        """Their ends."""
        names = self.instance.model.spec.state_names
        return np.array([float(self.instance.final[names[i]]) for i in self.fixed])

    @cached_property
    def scales(self) -> Array:
        """Units of the controls, shape (m,)."""
        low, high = _ends(self.instance)
        return np.array([(b - a) / 2.0 if np.isfinite(b - a) else 1.0 for a, b in zip(low, high, strict=True)])

    def taken(self, unknown: Array) -> tuple[Array, float]:
        """Controls at nodes and midpoints, shape (m, 2 N + 1), and the duration."""
        m, free = len(self.scales), self.instance.tf is None
        duration = float(unknown[-1]) if free else float(self.instance.tf - self.instance.t0)  # type: ignore[operator]
        return (unknown[: m * self.knots].reshape(m, self.knots) * self.scales[:, None]) @ _hats(self.knots), duration

    def simulated(self, u: Array, duration: float) -> tuple[Array, Array, Array, float]:
        """Times, states at nodes and midpoints, and the whole cost."""
        instance = self.instance
        times = instance.t0 + duration * np.linspace(0.0, 1.0, (u.shape[1] + 1) // 2)
        x, x_mid, cost = instance.model.forward(times, instance.initial, u[:, ::2], u[:, 1::2], instance.parameters)
        end = float(instance.model.terminal_cost(times[-1], tuple(x[:, -1].tolist()), instance.parameters))
        if self.smoothing:
            cost += self.smoothing / 2.0 * float((u * u).sum(axis=0) @ self._weights(u.shape[1], duration))
        return times, x, x_mid, cost + end

    @cached_property
    def smoothing(self) -> float:
        """What squares of controls cost besides, if the problem is regularised."""
        smoothing = self.instance.control_set.smoothing
        return smoothing if smoothing > UNSMOOTHED else 0.0

    def finer(self, unknown: Array) -> tuple[Programme, Array]:
        """The same with a knot between any two, and what the unknowns are there."""
        m = len(self.scales)
        halves = interleave(
            controls := unknown[: m * self.knots].reshape(m, -1), (controls[:, 1:] + controls[:, :-1]) / 2
        )
        return replace(self, knots=halves.shape[1]), np.append(halves, unknown[m * self.knots :])

    def along(self, unknown: Array) -> tuple[Array, Array, Array, float]:
        """What :meth:`simulated` finds for the unknowns; the last ones are remembered, as cost and ends both ask."""
        key = unknown.tobytes()
        if key not in self._last:
            self._last.clear()
            self._last[key] = self.simulated(*self.taken(unknown))
        return self._last[key]

    @cached_property
    def _last(self) -> dict[bytes, tuple[Array, Array, Array, float]]:
        return {}

    def _weights(self, count: int, duration: float) -> Array:
        """Simpson's, of nodes and midpoints."""
        weights = np.where(np.arange(count) % 2, 4.0, 2.0) * duration / (3.0 * (count - 1))
        weights[[0, -1]] /= 2.0
        return weights

    def missed(self, x: Array) -> Array:
        """By how much the end is missed, in units of the states."""
        return np.asarray((x[self.fixed, -1] - self.target) / self.size[self.fixed])

    def values(self, unknown: Array) -> Array:
        """The cost, then by how much the end is missed."""
        _, x, _, cost = self.along(unknown)
        return np.concatenate([[cost], self.missed(x)])

    def costates(self, unknown: Array) -> tuple[Array, Array, list[Array], Array]:
        """Times, states, the costates of the cost and of each end, and the derivatives of :meth:`values`."""
        u, duration = self.taken(unknown)
        times, x, x_mid, _ = self.along(unknown)
        model, p = self.instance.model, self.instance.parameters
        n = len(x)
        slope = np.array(model.terminal_gradient(times[-1], tuple(x[:, -1].tolist()), p))
        ends = [np.zeros(n), slope, *(np.eye(n)[i] / self.size[i] for i in self.fixed)]
        tau, states = np.empty(u.shape[1]), np.empty((n, u.shape[1]))
        tau[::2], tau[1::2] = times, (times[1:] + times[:-1]) / 2.0
        states[:, ::2], states[:, 1::2] = x, x_mid
        onto = self._weights(len(tau), duration)[:, None] * _hats(self.knots).T
        rows: list[Array] = []
        nodes: list[Array] = []
        for end in ends:
            if rows and not end.any():  # no terminal cost
                rows, nodes = [*rows, rows[0]], [*nodes, nodes[0]]
                continue
            lam, lam_mid = model.backward(times, tuple(end.tolist()), x, x_mid, u[:, ::2], u[:, 1::2], p)
            both = np.empty_like(states)
            both[:, ::2], both[:, 1::2] = lam, lam_mid
            slopes = self._stationarity(tau, states, u, both)
            rows.append((slopes @ onto * self.scales[:, None]).ravel())
            nodes.append(lam)
        found = np.array([rows[1], *(row - rows[0] for row in rows[2:])])
        if self.instance.tf is None:
            step = 1e-6 * duration
            later, sooner = (self.values(np.append(unknown[:-1], duration + s)) for s in (step, -step))
            found = np.column_stack([found, (later - sooner) / (2.0 * step)])
        return times, x, [nodes[1], *(lam - nodes[0] for lam in nodes[2:])], found

    def _stationarity(self, t: Array, x: Array, u: Array, lam: Array) -> Array:
        """The derivatives of H by the controls, shape (m, N)."""
        model, p = self.instance.model, self.instance.parameters
        if not model.spec.switching:
            return np.broadcast_to(model.stationarity_batch(t, x, u, lam, p), u.shape)
        sigma, weight = model.switching_function_batch(t, x, lam, p), model.magnitude_weight_batch(t, x, lam, p)
        return np.broadcast_to(sigma + weight * np.sign(u) + self.smoothing * u, u.shape)

    def bounds(self) -> list[tuple[float | None, float | None]]:
        """Of the unknowns."""
        both = [
            [None if not np.isfinite(v) else float(v / scale) for v in pair]
            for *pair, scale in zip(*_ends(self.instance), self.scales, strict=True)
        ]
        found = [(low, high) for low, high in both for _ in range(self.knots)]
        return found + ([(SMALLEST, None)] if self.instance.tf is None else [])


@cache
def _hats(knots: int) -> Array:
    """The share of each knot in the control at nodes and midpoints, shape (knots, 2 N + 1)."""
    tau = np.linspace(0.0, 1.0, 2 * STEPS * (knots - 1) + 1)
    return np.array([np.interp(tau, np.linspace(0.0, 1.0, knots), row) for row in np.eye(knots)])


def direct(instance: Instance, limits: Limits, seed: int = 0) -> tuple[TwoPoint, Start] | None:
    """An extremal to which a direct method leads, and its problem; ``None`` where there is none.

    Also where ends are asked for that are neither numbers nor free.

    Parameters
    ----------
    seed
        For the controls that are drawn.
    """
    if instance.model.spec.multipliers or any(isinstance(v, str) for v in instance.final.values()):
        return None
    found: list[tuple[float, Programme, Array]] = []
    for programme, start in _starts(instance, seed):
        if limits.expired:
            break
        limits.spend(KNOTS * STEPS * PROGRAMMES)
        for flat in FLAT:
            solved = _solved(programme, start, flat)
            extremal = None if solved is None else _extremal(programme, solved)
            if extremal is not None:
                return extremal
            start = start if solved is None else solved
        if solved is not None:
            found.append((float(programme.values(solved)[0]), programme, solved))
    return _finer(*min(found, key=lambda one: one[0])[1:], limits) if found else None


def _finer(programme: Programme, unknown: Array, limits: Limits) -> tuple[TwoPoint, Start] | None:
    """The extremal to which more and more knots lead."""
    for _ in range(FINER):
        if limits.expired:
            break
        programme, unknown = programme.finer(unknown)
        limits.spend(programme.knots * STEPS * PROGRAMMES)
        solved = _solved(programme, unknown, FLAT[-1])
        extremal = None if solved is None else _extremal(programme, solved)
        if extremal is not None:
            return extremal
        unknown = unknown if solved is None else solved
    return None


def _starts(instance: Instance, seed: int) -> Iterator[tuple[Programme, Array]]:
    """Controls that are drawn, with a duration; nearest to the end first."""
    rng, tau = np.random.default_rng(seed), np.linspace(0.0, 1.0, KNOTS)
    low, high = _ends(instance)
    found: list[tuple[float, Programme, Array]] = []
    for k in range(2 * DRAWN):
        knots, size = [], 1.0 if k < DRAWN else SMALLER
        if k == DRAWN and found:
            break
        for a, b in zip(low, high, strict=True):
            waves = rng.uniform(-0.5, 0.5) + sum(rng.normal() / (k + 2) * np.cos(k * np.pi * tau) for k in (1, WAVES))
            if np.isfinite(b - a):
                knots.append(np.clip(size * ((a + b) / (b - a) + waves), *_unit(a, b)))
            else:
                knots.append(np.clip(2.0 * size * waves, a, b))
        one = _begun(instance, np.concatenate(knots))
        if one is not None:
            found.append(one)
    yield from ((programme, start) for _, programme, start in sorted(found, key=lambda one: one[0])[:STARTS])


def _begun(instance: Instance, knots: Array) -> tuple[float, Programme, Array] | None:
    """How far from the end a motion ends, at best where its duration is free."""
    plain = Programme(instance, np.ones(len(instance.initial)))
    m = len(instance.model.spec.controls)
    duration = 0.0
    if instance.tf is None:
        first = (knots.reshape(m, KNOTS)[:, 0] * plain.scales).tolist()
        longest = LONGEST * _time_scale(instance, first)
        even = np.interp(np.linspace(0, 1, 2 * LOOKED + 1), np.linspace(0, 1, KNOTS), np.arange(KNOTS) * 1.0)
        u = np.array([np.interp(even, np.arange(KNOTS), row) for row in knots.reshape(m, KNOTS)])
        times, x, _, _ = plain.simulated(u * plain.scales[:, None], longest)
        fit = np.isfinite(x).all(axis=0)
        size = _sizes(instance, x[:, fit])
        missed = np.abs((x[plain.fixed] - plain.target[:, None]) / size[plain.fixed][:, None]).max(axis=0, initial=0.0)
        missed[~fit] = np.inf
        missed[0] = np.inf
        duration = float(times[int(missed.argmin())] - instance.t0)
        # the same controls over the shorter time
        share = np.linspace(0.0, duration / longest, KNOTS)
        knots = np.array([np.interp(share, np.linspace(0, 1, KNOTS), row) for row in knots.reshape(m, KNOTS)]).ravel()
        knots = np.append(knots, duration)
    _, x, _, cost = plain.simulated(*plain.taken(knots))
    if not (np.isfinite(x).all() and np.isfinite(cost) and instance.model.in_domain(x)):
        return None
    programme = Programme(instance, _sizes(instance, x))
    return float(np.abs(programme.missed(x)).max(initial=0.0)), programme, knots


def _solved(programme: Programme, start: Array, flat: float) -> Array | None:
    """The unknowns to which sequential quadratic programming leads until the cost is so flat."""
    from scipy.optimize import minimize

    cost = max(abs(float(programme.values(start)[0])), 1e-3)
    known: dict[bytes, Array] = {}

    def slopes(unknown: Array) -> Array:
        key = unknown.tobytes()
        if key not in known:
            known.clear()
            known[key] = programme.costates(unknown)[-1]
        return known[key]

    unit = np.ones(len(start))
    if programme.instance.tf is None:
        unit[-1] = start[-1]
    ends = {
        "type": "eq",
        "fun": lambda v: programme.values(v * unit)[1:],
        "jac": lambda v: slopes(v * unit)[1:] * unit,
    }
    answer = minimize(
        lambda v: programme.values(v * unit)[0] / cost,
        start / unit,
        jac=lambda v: slopes(v * unit)[0] * unit / cost,
        bounds=[
            tuple(None if b is None else b / one for b in pair)
            for pair, one in zip(programme.bounds(), unit, strict=True)
        ],
        constraints=[ends] if programme.fixed else [],
        method="SLSQP",
        options={"maxiter": PROGRAMMES, "ftol": flat},
    )
    found = np.asarray(answer.x) * unit
    values = programme.values(found)
    return found if np.isfinite(values).all() and np.abs(values[1:]).max(initial=0.0) < SATISFIED else None


def _extremal(programme: Programme, unknown: Array) -> tuple[TwoPoint, Start] | None:
    """What Newton's method finds from there."""
    instance = programme.instance
    times, x, lam, slopes = programme.costates(unknown)
    inside = [
        (low is None or v > low + 1e-7) and (high is None or v < high - 1e-7)
        for v, (low, high) in zip(unknown, programme.bounds(), strict=True)
    ]
    multipliers = np.linalg.lstsq(slopes[1:, inside].T, -slopes[0, inside], rcond=None)[0]
    costates = lam[0] + sum((m * one for m, one in zip(multipliers, lam[1:], strict=True)), np.zeros_like(lam[0]))
    size = _sizes(instance, x)
    scale = Scale(size, max(float(np.abs(costates * size[:, None]).max()), 1e-30))
    duration = float(times[-1] - times[0])
    problem = TwoPoint(instance, final_argument(instance), duration, scale)
    found = by_newton(problem, np.concatenate([x, costates]) / scale.both)
    return None if found is None else (problem, Start(found, Origin.DIRECT, found.iterations, bounded=True))


def _ends(instance: Instance) -> tuple[Array, Array]:
    """Bounds of each control, infinite where there is none."""
    m = len(instance.model.spec.controls)
    none = np.full(m, np.inf)
    low = np.array(instance.lower) if instance.lower else -none
    high = np.array(instance.upper) if instance.upper else none
    return low, high


def _unit(low: float, high: float) -> tuple[float, float]:
    """Bounds in units of half their distance."""
    return 2.0 * low / (high - low), 2.0 * high / (high - low)


def _sizes(instance: Instance, x: Array) -> Array:
    """Of each state along a motion and at the end that is asked for."""
    ends = [abs(float(v)) for v in (instance.final.get(s, 0.0) for s in instance.model.spec.state_names)]
    size = np.maximum(np.abs(x).max(axis=1, initial=0.0), ends)
    return np.where(size > 0.0, size, 1.0)


def _time_scale(instance: Instance, u: list[float]) -> float:
    """One over the largest rate of the motion at the start."""
    n = len(instance.initial)
    slopes = instance.model.jacobian_x(instance.t0, instance.initial, tuple(u), instance.parameters)
    fastest = np.abs(np.linalg.eigvals(np.array(slopes).reshape(n, n))).max()
    return 1.0 / float(fastest) if np.isfinite(fastest) and fastest > SMALLEST else 1.0
