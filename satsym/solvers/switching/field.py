"""The extremal equations with each control at a fixed level, and derivatives of switching functions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import Row
from satsym.instance import Instance
from satsym.solvers.switching.magnitudes import moving, ratio
from satsym.solvers.switching.structure import LOWER, REST, SINGULAR, UPPER

NUDGE = 1e-30
"""Imaginary step of complex-step derivatives, which are exact since no difference is taken."""

BEYOND_RANGE = 10.0
"""Distance of a singular control from the middle of its range, in widths of the range, beyond which it counts as
diverged."""

PLACES, WEIGHTS = np.array([-2.0, -1.0, 1.0, 2.0]), np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
SHIFT = 1e-3
"""Points and weights of a fourth-order central difference, and its step as a fraction of the duration."""


class Field:
    """Rates of states and costates while every control keeps its level.

    Parameters
    ----------
    instance
        Model, parameters and bounds.
    levels
        Level of each control. At most one is singular, so that it keeps its switching function at zero, or on the
        boundary of a path constraint; :attr:`kept` is the index of this control.
    """

    def __init__(self, instance: Instance, levels: tuple[int, ...]) -> None:
        self.instance, self.levels = instance, levels
        self.model, self.p, self.n = instance.model, instance.parameters, len(instance.initial)
        self.saturated = tuple(self._at(i, level) for i, level in enumerate(levels))
        self.singular = levels.index(SINGULAR) if SINGULAR in levels else None
        self.kept = next((i for i, level in enumerate(levels) if level >= SINGULAR), None)
        self.moving = moving(instance)
        if self.singular is not None and self.moving[self.singular]:
            raise ArithmeticError("no law is known on singular arcs of a control whose magnitude stands in the motion")
        if self.singular is not None:
            low, high = instance.lower[self.singular], instance.upper[self.singular]
            self.middle, self.beyond = (low + high) / 2.0, BEYOND_RANGE * (high - low)

    def _at(self, control: int, level: int) -> float:
        """Return the value of a control at its lower bound, at rest or at its upper bound."""
        low, high = (bounds[control] for bounds in self.instance.control_set.switching)
        return high if level == UPPER else low if level == LOWER else min(max(0.0, low), high)

    def kept_at(self, t: float, z: list[float]) -> Row:
        """Return the argument ``bounds`` for which kernels keep the switching controls at their present values."""
        return self.instance.control_set.saturated(self.control(t, z)).arguments

    def control(self, t: float, z: list[float]) -> tuple[float, ...]:
        """Return the controls, shape (m,)."""
        return self.saturated if self.singular is None else self._feedback(t, z)[0]

    def sides(self, t: float, z: list[float]) -> NDArray[np.bool_]:
        """Return at which bounds non-switching controls are; rates have a corner where this changes."""
        return np.zeros(0, bool)

    def rates(self, t: float, z: list[float]) -> list[float]:
        """Return dz/dt as 2n numbers."""
        x, lam, u = z[: self.n], z[self.n :], self.control(t, z)
        return [*self.model.dynamics(t, x, u, self.p), *self.model.costate_rate(t, x, u, lam, self.p)]

    def linearised(self, t: float, z: list[float]) -> tuple[Array, Array]:
        """Return dz/dt, shape (2n,), and its derivatives with respect to z, shape (2n, 2n)."""
        u, by_point, by_control = (self.saturated, None, None) if self.singular is None else self._feedback(t, z)
        x, lam = z[: self.n], z[self.n :]
        rates = np.array([*self.model.dynamics(t, x, u, self.p), *self.model.costate_rate(t, x, u, lam, self.p)])
        fixed = np.array(self.model.extremal_jacobian(t, x, u, lam, self.p)).reshape(2 * self.n, 2 * self.n)
        if by_point is None or by_control is None:
            return rates, fixed
        # The control keeps the second derivative of the switching function at zero: the gradient of the first
        # derivative times the rates, and what time does besides.
        slope = (self._turning(t, z, u, rates) + by_point @ fixed) / (by_point @ by_control)
        return rates, fixed - np.outer(by_control, slope)

    def along(self, t: Array, z: Array) -> tuple[Array, Array]:
        """Return controls (m, N) and rates (2n, N) at many points."""
        x, lam = z[: self.n], z[self.n :]
        u = np.empty((len(self.saturated), z.shape[1]))
        u[:] = np.array(self.saturated)[:, None]
        if self.singular is not None:
            base, slope = self._accelerations(t, z)
            u[self.singular] = -base / slope
        found = np.empty_like(z)  # given, so that kernels need not find out shapes
        self.model.dynamics_batch(t, x, u, self.p, out=found[: self.n])
        self.model.costate_rate_batch(t, x, u, lam, self.p, out=found[self.n :])
        return u, found

    def sigma(self, t: float, z: list[float], control: int) -> float:
        """Return the switching function of a control."""
        return float(self.model.switching_function(t, z[: self.n], z[self.n :], self.p)[control])

    def switching(self, t: float, z: list[float], control: int) -> tuple[float, float]:
        """Return the switching function of a control and its time derivative."""
        x, lam = z[: self.n], z[self.n :]
        rate = self.model.switching_rate(t, x, self.control(t, z), lam, self.p)[control]
        return self.sigma(t, z, control), float(rate)

    def gradient(self, t: float, z: list[float], control: int) -> Array:
        """Return the derivatives of a switching function by states and costates, shape (2n,).

        The derivative by the states is the effect of the control on the costates, averaged over both signs so that a
        weight of |u| cancels; that by the costates is the effect on the states.
        """
        x, lam = z[: self.n], z[self.n :]
        unit = [float(i == control) for i in range(len(self.saturated))]
        there = self.model.costate_rate(t, x, unit, lam, self.p)
        back = self.model.costate_rate(t, x, [-value for value in unit], lam, self.p)
        by_state = [(b - a) / 2.0 for a, b in zip(there, back, strict=True)]
        return np.array([*by_state, *self._column(t, x, self.saturated, control)])

    def weight(self, t: float, z: list[float], control: int) -> float:
        """Return the weight of the magnitude of a control in H."""
        return float(self.model.magnitude_weight(t, z[: self.n], z[self.n :], self.p)[control])

    def weight_gradient(self, t: float, z: list[float], control: int) -> tuple[Array, float]:
        """Return derivatives of the weight of |u| by states and costates, (2n,), and its rate along the extremal."""
        steps = np.concatenate([np.eye(2 * self.n), np.array(self.rates(t, z))[:, None]], axis=1)
        x, lam = np.split(np.array(z)[:, None] + 1j * NUDGE * steps, 2)
        times = t + 1j * NUDGE * np.append(np.zeros(2 * self.n), 1.0)
        found = self.model.magnitude_weight_batch(times, x, lam, self.p)[control]
        slopes = np.broadcast_to(found, times.shape).imag / NUDGE
        return slopes[:-1], float(slopes[-1])

    def ratios(self, control: int) -> tuple[float, ...]:
        """Return the factors of the weight of |u| in the switching conditions from a control's level to the others."""
        now = self.levels[control]
        others = (level for level in (LOWER, REST, UPPER) if level != now)
        return tuple(dict.fromkeys(self.ratio(control, (now, level)) for level in others))

    def ratio(self, control: int, levels: tuple[int, int]) -> float:
        """Return the factor of the weight of |u| in the switching condition between two levels, see :func:`ratio`."""
        if max(levels) >= SINGULAR:
            return 0.0
        return ratio(*(self._at(control, level) for level in levels))

    def passing(self, t: float, z: list[float], control: int, ratio: float) -> tuple[float, float]:
        """Return the value of the switching condition for a factor of the weight of |u|, and its time derivative."""
        sigma, rate = self.switching(t, z, control)
        if not ratio:
            return sigma, rate
        return sigma + ratio * self.weight(t, z, control), rate + ratio * self.weight_gradient(t, z, control)[1]

    def passing_gradient(self, t: float, z: list[float], control: int, ratio: float) -> Array:
        """Return derivatives of the switching condition between two levels by states and costates, shape (2n,)."""
        gradient = self.gradient(t, z, control)
        return gradient + ratio * self.weight_gradient(t, z, control)[0] if ratio else gradient

    def rate_gradient(self, t: float, z: list[float], control: int) -> Array:
        """Return derivatives of the rate of a switching function by states and costates, shape (2n,)."""
        return self._rate_slopes(t, z, self.control(t, z), control)[:-1]

    def legendre(self, t: float, z: list[float]) -> float:
        """Return the generalised Legendre-Clebsch expression of the singular control; positive if it is strict."""
        return -float(self._accelerations(np.array([t]), np.array(z)[:, None])[1][0])

    def _with(self, value: float) -> tuple[float, ...]:
        assert self.singular is not None
        return (*self.saturated[: self.singular], value, *self.saturated[self.singular + 1 :])

    def _column(self, t: float, x: list[float], u: tuple[float, ...], control: int | None = None) -> Array:
        """Return the derivatives of the states' rates with respect to a control, shape (n,)."""
        which = self.singular if control is None else control
        if which is None or not self.moving[which]:
            return np.array(self.model.jacobian_u(t, x, u, self.p)).reshape(self.n, -1)[:, which]
        unit = np.zeros(len(u))
        unit[which] = 1.0
        both = [self.model.jacobian_u(t, x, (side * unit).tolist(), self.p) for side in (1.0, -1.0)]
        return np.array(both).reshape(2, self.n, -1)[:, :, which].mean(axis=0)  # so that its magnitude falls out

    def _accelerations(self, t: Array, z: Array) -> tuple[Array, Array]:
        """Return the second time derivative of the switching function without the singular control, and its factor.

        The rate of the switching function is differentiated along the extremal by an imaginary step.
        """
        assert self.singular is not None
        count = z.shape[1]
        u = np.repeat(np.array([self._with(0.0), self._with(1.0)]).T, count, axis=1)
        times, both = np.concatenate([t, t]), np.concatenate([z, z], axis=1)
        x, lam = both[: self.n], both[self.n :]
        f = self.model.dynamics_batch(times, x, u, self.p)
        g = self.model.costate_rate_batch(times, x, u, lam, self.p)
        ahead = (times + 1j * NUDGE, x + 1j * NUDGE * f, u, lam + 1j * NUDGE * g)
        found = self.model.switching_rate_batch(*ahead, self.p)[self.singular].imag / NUDGE
        return found[:count], found[count:] - found[:count]

    def _rate_slopes(self, t: float, z: list[float], u: tuple[float, ...], control: int) -> Array:
        """Return derivatives of the rate of a switching function by states, costates and explicit time, (2n + 1,)."""
        count = 2 * self.n + 1
        columns = np.array([*z, t], dtype=complex)[:, None] + 1j * NUDGE * np.eye(count)
        x, lam, times = columns[: self.n], columns[self.n : -1], columns[-1]
        same, found = np.repeat(np.array(u)[:, None], count, axis=1), np.empty((len(u), count), dtype=complex)
        self.model.switching_rate_batch(times, x, same, lam, self.p, out=found)
        return np.asarray(found[control].imag / NUDGE)

    def _feedback(self, t: float, z: list[float]) -> tuple[tuple[float, ...], Array, Array]:
        """Return the controls on a singular arc, the gradient of the switching rate, and the control's effect on z."""
        assert self.singular is not None
        x, lam, idle = z[: self.n], z[self.n :], self._with(0.0)
        gradient = self.gradient(t, z, self.singular)
        by_control = np.concatenate([gradient[self.n :], -gradient[: self.n]])
        slopes = self._rate_slopes(t, z, idle, self.singular)
        rates = [*self.model.dynamics(t, x, idle, self.p), *self.model.costate_rate(t, x, idle, lam, self.p), 1.0]
        acting = float(slopes[:-1] @ by_control)
        value = -float(slopes @ rates) / acting if acting else math.nan
        if not math.isfinite(value):
            raise ArithmeticError("the second derivative of the switching function does not determine the control")
        if abs(value - self.middle) > self.beyond:
            raise ArithmeticError("the singular control leaves its bounds for good")
        return self._with(value), slopes[:-1], by_control

    def _turning(self, t: float, z: list[float], u: tuple[float, ...], rates: Array) -> Array:
        """Return the rate of change of the gradient of the switching function's rate on a singular arc, shape (2n,).

        It consists of generated first derivatives, so that an imaginary step along the motion gives it to rounding
        accuracy, as the tight integration tolerance requires. Only an explicit dependence of the control's effect on
        time, which is rare, needs a finite difference.
        """
        assert self.singular is not None
        n, unit, here = self.n, np.zeros(len(u)), np.array(z)
        unit[self.singular] = 1.0
        x, lam = np.repeat((here + 1j * NUDGE * rates)[:, None], 3, axis=1).reshape(2, n, 3)
        controls, times = np.stack([np.array(u), unit, -unit], axis=1), np.full(3, t + 1j * NUDGE)
        f = np.empty((2 * n, 3), dtype=complex)
        self.model.dynamics_batch(times, x, controls, self.p, out=f[:n])
        self.model.costate_rate_batch(times, x, controls, lam, self.p, out=f[n:])
        slopes = self.model.extremal_jacobian_batch(times, x, controls, lam, self.p)
        column = self.model.jacobian_u_batch(times, x, controls, self.p)[:, self.singular, 0]
        by_control = (slopes[:, :, 1] - slopes[:, :, 2]) / 2.0
        curvature = np.concatenate([-by_control[n:], by_control[:n]])
        gradient = np.concatenate([(f[n:, 2] - f[n:, 1]) / 2.0, column])
        found = (curvature @ f[:, 0] + gradient @ slopes[:, :, 0]).imag / NUDGE
        if self.model.spec.autonomous:
            return np.asarray(found)
        end = self.instance.tf if self.instance.tf is not None else self.instance.t0 + max(1.0, abs(t))
        step = SHIFT * (end - self.instance.t0)
        explicit = self._by_time(t + step * PLACES, here[:, None] + step * PLACES * rates[:, None])
        return np.asarray(found + explicit @ WEIGHTS / step)

    def _by_time(self, t: Array, z: Array) -> Array:
        """Return derivatives of the singular control's switching-function gradient by explicit time, shape (2n, N)."""
        assert self.singular is not None
        x, lam, times = z[: self.n].astype(complex), z[self.n :].astype(complex), t + 1j * NUDGE
        unit = np.zeros((len(self.saturated), len(t)))
        unit[self.singular] = 1.0
        there, back = (self.model.costate_rate_batch(times, x, k * unit, lam, self.p) for k in (1.0, -1.0))
        column = np.broadcast_to(self.model.jacobian_u_batch(times, x, unit, self.p), (self.n, len(unit), len(t)))
        return np.concatenate([(back - there).imag / 2.0, column[:, self.singular].imag]) / NUDGE
