"""An instance as a two-point boundary value problem in scaled variables, for collocation and shooting.

States are divided by their magnitude along the motion, costates by the unit of cost over that of the state, so that
kilometres and seconds at geostationary height become a radius of one: all quantities are of order one, and the response
of the states to the costates over the duration is at most of order one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import UNSMOOTHED, ControlSet, Row
from satsym.instance import Instance
from satsym.solvers.control.jumps import Jump, Saltation, beside, saltation
from satsym.solvers.control.regularised import sloping, smoothed_cost, smoothed_law

ROUNDING = 1e-10
"""Change of a control beyond a bound, relative to the control, that counts as rounding."""

ROUNDED_MISS = 1e-9
"""Scaled residual of the end conditions that counts as rounding."""


@dataclass(frozen=True, eq=False)
class Scale:
    """Units of the scaled problem."""

    state: Array
    """Unit of each state, shape (n,)."""
    cost: float
    """Unit of the cost; the unit of a costate is that of the cost divided by that of the state."""

    @cached_property
    def both(self) -> Array:
        """Units of states and costates, shape (2n, 1)."""
        return np.concatenate([self.state, self.cost / self.state])[:, None]

    @cached_property
    def ratio(self) -> Array:
        """Factors that convert a Jacobian into the scaled one, shape (2n, 2n, 1)."""
        return (self.both.T / self.both)[:, :, None]


@dataclass(frozen=True, eq=False)
class TwoPoint:
    """The canonical equations from the given initial state to the end conditions of an instance.

    Unknowns are z = (states, costates), scaled, over tau in [0, 1], and ``theta``: the multipliers of terminal
    constraints (scaled by the cost), and the duration if it is free.
    """

    instance: Instance
    """The instance that is solved."""
    final: tuple[float, ...]
    """The ``final`` argument of the boundary functions: for all states whether given, whether on the reference, and
    target."""
    duration: float
    """Duration tf - t0; an initial guess if it is free."""
    scale: Scale
    """Units of the scaled problem."""
    relaxation: float = 0.0
    """Distance by which every bound of the control is relaxed; infinite without bounds."""

    @cached_property
    def states(self) -> int:
        """Number n of states."""
        return len(self.instance.model.spec.states)

    @cached_property
    def free_time(self) -> bool:
        """Whether the duration is unknown."""
        return self.instance.tf is None

    @cached_property
    def homogeneous(self) -> bool:
        """Whether costates are determined up to a factor only, except by the residual of a free duration.

        This is so if the control law depends on the direction of the costates alone, as for controls that are
        directions or that switch.
        """
        return self.free_time and self.instance.model.spec.directional and self.control_set.smoothing <= UNSMOOTHED

    @cached_property
    def unknowns(self) -> int:
        """Number of extra unknowns."""
        return len(self.instance.model.spec.multipliers) + self.free_time

    @cached_property
    def theta(self) -> Array:
        """Initial guess of the extra unknowns: zero multipliers, and the guess of the duration."""
        start = np.zeros(self.unknowns)
        if self.free_time:
            start[-1] = self.duration
        return start

    @cached_property
    def initial(self) -> Array:
        """The scaled initial state."""
        return np.array(self.instance.initial) / self.scale.state

    @cached_property
    def positive(self) -> tuple[int, ...]:
        """Indices of the states that must stay positive."""
        return tuple(i for i, v in enumerate(self.instance.model.spec.states) if v.positive)

    @cached_property
    def control_set(self) -> ControlSet:
        """The admissible controls, with relaxed bounds."""
        return self.instance.control_set.relaxed(self.relaxation)

    def relaxed(self, by: float) -> TwoPoint:
        """Return this problem with bounds relaxed by the given distance, or itself if it has no bounds."""
        moved = self.instance.control_set.relaxed(by)
        return self if moved == self.control_set else replace(self, relaxation=by)

    def elapsed(self, theta: Array) -> float:
        """Return the duration."""
        return float(theta[-1]) if self.free_time else self.duration

    def _arguments(self, tau: Array, z: Array, theta: Array) -> tuple[Array, Array, Array, tuple[float, ...]]:
        t = self.instance.t0 + self.elapsed(theta) * tau
        physical = z * self.scale.both
        return t, physical[: self.states], sloping(self.instance, physical[self.states :]), self.instance.parameters

    def rates(self, tau: Array, z: Array, theta: Array) -> Array:
        """Return dz/dt, shape (2n, N), at ``tau`` (N,) and ``z`` (2n, N)."""
        return self._of(self.instance.model.canonical_batch, z.shape, tau, z, theta) / self.scale.both

    def rates_beyond(self, tau: Array, z: Array, theta: Array) -> Array:
        """Return the rates without control bounds.

        If the model has no closed control law, H may have no minimum then: controls are one Newton step beyond the
        bounds.
        """
        model = self.instance.model
        if not model.spec.stationary:
            return self.relaxed(float("inf")).rates(tau, z, theta)
        t, x, lam, p = self._arguments(tau, z, theta)
        u = self._beyond(t, x, lam, p)
        rates = [model.dynamics_batch(t, x, u, p), model.costate_rate_batch(t, x, u, lam, p)]
        return np.asarray(np.concatenate(rates) / self.scale.both)

    def jacobian(self, tau: Array, z: Array, theta: Array) -> Array:
        """Return the derivatives of the rates with respect to z, shape (2n, 2n, N)."""
        shape = (len(z), *z.shape)
        return self._of(self.instance.model.canonical_jacobian_batch, shape, tau, z, theta) * self.scale.ratio

    def _of(self, kernel: Any, shape: tuple[int, ...], tau: Array, z: Array, theta: Array) -> Array:
        """Return the values of a kernel of the canonical equations."""
        arguments = self._arguments(tau, z, theta)
        found = np.empty(shape, z.dtype)  # given, so that kernels need not find out shapes and types
        kernel(*arguments, self.control_set.arguments, out=found)
        return found

    def drift(self, tau: Array, z: Array, theta: Array) -> Array | float:
        """Return the derivatives of the rates with respect to explicit time, shape (2n, N), or 0."""
        if self.instance.model.spec.autonomous:
            return 0.0
        slopes: Array = self.instance.model.canonical_drift_batch(
            *self._arguments(tau, z, theta), self.control_set.arguments
        )
        return slopes / self.scale.both

    def saltation(self, tau: float, z: Array, theta: Array, jump: Jump) -> Saltation:
        """Return the effect of a jump at ``tau`` and ``z`` (2n,) on neighbouring extremals."""
        t, unit = self.instance.t0 + self.elapsed(theta) * tau, self.scale.both[:, 0]
        return saltation(self.instance, t, z * unit, jump, unit, self.scale.cost)

    def between(self, tau: float, z: Array, theta: Array, jump: Jump) -> float:
        """Return the distance between the minimisers of H on both sides of a jump, at ``tau`` and ``z`` (2n,)."""
        t, physical = self.instance.t0 + self.elapsed(theta) * tau, z * self.scale.both[:, 0]
        before, after = (beside(self.instance, t, physical, u) for u in (jump.before, jump.after))
        return float(np.abs(after - before).max())

    def running_cost(self, tau: Array, z: Array, theta: Array) -> Array:
        """Return the scaled running cost under the control law, shape (N,)."""
        t, x, lam, p = self._arguments(tau, z, theta)
        model = self.instance.model
        if model.spec.switching:
            u = smoothed_law(self.instance, self.control_set, t, x, lam)
            return smoothed_cost(self.instance, self.control_set, t, x, u) / self.scale.cost
        if model.spec.directional:
            return np.asarray(model.regularised_cost_batch(t, x, lam, p, self.control_set.arguments)) / self.scale.cost
        u = self._law(t, x, lam, p, self.control_set)
        found = np.empty(x.shape[1:], x.dtype)
        model.running_cost_batch(t, x, u, p, out=found)
        return np.asarray(found / self.scale.cost)

    def _law(self, t: Array, x: Array, lam: Array, p: Row, within: ControlSet) -> Array:
        """Return the control law within a set, by its batch form, shape (m, N)."""
        found = np.empty((len(self.instance.model.spec.controls), *x.shape[1:]), x.dtype)
        self.instance.model.control_law_batch(t, x, lam, p, within.arguments, out=found)
        return found

    def terminal_cost(self, end: Array, theta: Array) -> float:
        """Return the scaled terminal cost S."""
        x = tuple((end[: self.states] * self.scale.state).tolist())
        tf = self.instance.t0 + self.elapsed(theta)
        return float(self.instance.model.terminal_cost(tf, x, self.instance.parameters)) / self.scale.cost

    @property
    def at_once(self) -> float:
        """Return the cost of a motion of no duration; infinite if it does not meet the end conditions."""
        end, theta = np.concatenate([self.initial, np.zeros(self.states)]), np.zeros(self.unknowns)
        constrained = np.ones(self.unknowns - self.free_time, dtype=bool)
        missed = self.boundary(end, theta)[: self.unknowns - self.free_time + self.states]
        if (np.abs(missed[np.concatenate([self.fixed, constrained])]) > ROUNDED_MISS).any():
            return float("inf")
        return self.terminal_cost(end, theta) * self.scale.cost

    def control(self, tau: Array, z: Array, theta: Array, bounded: bool = True) -> Array:
        """Return the control law in the model's units, shape (m, N)."""
        control_set = self.control_set if bounded else self.instance.control_set.without_bounds
        if self.instance.model.spec.switching:
            t, x, lam, _ = self._arguments(tau, z, theta)
            return smoothed_law(self.instance, control_set, t, x, lam)
        arguments = self._arguments(tau, z, theta)
        if self.instance.model.spec.stationary and not bounded:
            return self._beyond(*arguments)
        return self._law(*arguments, control_set)

    def _beyond(self, t: Array, x: Array, lam: Array, p: Row) -> Array:
        """Return the control law moved by a Newton step for H, and thus beyond bounds at which H holds it.

        Without bounds H may have no minimiser, and an angle may differ by a turn.
        """
        model = self.instance.model
        law = np.array(model.control_law_batch(t, x, lam, p, self.control_set.arguments))
        curved = np.einsum("iik->ik", np.asarray(model.control_hessian_batch(t, x, law, lam, p)))
        slope = np.broadcast_to(model.stationarity_batch(t, x, law, lam, p), law.shape)
        step = slope / np.where(np.abs(curved) > 0.0, np.abs(curved), 1.0)
        within = np.where(np.abs(step) > ROUNDING * np.abs(law), step, 0.0)
        for places, part in self.instance.control_set.parts:
            if part.kind not in ("free", "box"):
                within[list(places)] = 0.0
        return np.asarray(law - within)

    def boundary(self, end: Array, theta: Array) -> Array:
        """Return the scaled residuals of the final conditions, shape (n + e,).

        Parameters
        ----------
        end
            Scaled final values z, shape (2n,).
        theta
            Extra unknowns, shape (e,).
        """
        return self._missed(self._at_the_end(end, theta))

    def _missed(self, at: tuple[Any, ...]) -> Array:
        residual: Array = ended(self.instance, *at)[: len(self._row_scale)] / self._row_scale
        return residual

    def ending(self, end: Array, theta: Array) -> tuple[Array, Array, Array]:
        """Return the residuals of the final conditions, and their derivatives by ``end`` and ``theta``."""
        at = self._at_the_end(end, theta)
        return self._missed(at), *self._sloping(at)

    def boundary_slopes(self, end: Array, theta: Array) -> tuple[Array, Array]:
        """Return the derivatives of the final residuals by ``end`` and ``theta``, (n + e, 2n) and (n + e, e)."""
        return self._sloping(self._at_the_end(end, theta))

    def _sloping(self, at: tuple[Any, ...]) -> tuple[Array, Array]:
        n, e = self.states, self.unknowns
        slopes = ended(self.instance, *at, by="jacobian")
        # The kernel has a row and a column for the duration, free or not.
        shown = slopes.reshape(n + e + 1 - self.free_time, -1)[: n + e, : 2 * n + e]
        scaled = shown * self._slope_scale[:, : 2 * n + e]
        return scaled[:, : 2 * n], scaled[:, 2 * n :]

    def _at_the_end(self, end: Array, theta: Array) -> tuple[Any, ...]:
        """Return the arguments of the boundary functions."""
        n, multipliers = self.states, self.unknowns - self.free_time
        physical = (end * self.scale.both[:, 0]).tolist()
        if self.instance.model.spec.throttled:
            physical[n:] = sloping(self.instance, np.array(physical[n:])[:, None])[:, 0].tolist()
        tf = self.instance.t0 + self.elapsed(theta)
        nu = tuple((theta[:multipliers] * self.scale.cost).tolist())
        return (
            tf,
            tuple(physical[:n]),
            tuple(physical[n:]),
            nu,
            self.instance.parameters,
            self.control_set.arguments,
            self.final,
        )

    @cached_property
    def fixed(self) -> NDArray[np.bool_]:
        """Whether each final state is given or prescribed by the reference, shape (n,)."""
        n = self.states
        return np.array(self.final[:n]) + np.array(self.final[n : 2 * n]) > 0

    @cached_property
    def _slope_scale(self) -> Array:
        multipliers = np.full(self.unknowns - self.free_time, self.scale.cost)
        columns: Array = np.concatenate([self.scale.both[:, 0], multipliers, [1.0]])
        return columns / self._row_scale[:, None]

    @cached_property
    def _row_scale(self) -> Array:
        own = np.where(self.fixed, self.scale.state, self.scale.cost / self.scale.state)
        rest = np.ones(self.unknowns)
        if self.free_time:
            rest[-1] = self.scale.cost / self.duration
        return np.concatenate([own, rest])


def ended(instance: Instance, tf: float, x: Row, lam: Row, *others: Any, by: Literal["", "jacobian"] = "") -> Array:
    """Return the boundary residuals of an instance or their derivatives; NaN where the control law is undefined.

    With scalar kernels an exception may be raised there.
    """
    model = instance.model
    if not model.spec.stationary:
        return np.array((model.boundary_jacobian if by else model.boundary)(tf, x, lam, *others))
    kernel = model.boundary_jacobian_batch if by else model.boundary_batch
    with np.errstate(all="ignore"):
        return np.array(kernel(tf, np.array(x), np.array(lam), *others))
