"""The extremal equations while a control keeps a path constraint on its boundary."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import Row
from satsym.instance import Instance
from satsym.solvers.switching.field import BEYOND_RANGE, NUDGE, Field
from satsym.solvers.switching.structure import BOUNDARY, constraint_of


class BoundaryField(Field):
    """Rates of states and costates while one control keeps a constraint active and the others keep their levels.

    The multiplier of the constraint keeps the switching function of that control at zero.
    """

    def __init__(self, instance: Instance, levels: tuple[int, ...]) -> None:
        super().__init__(instance, levels)
        (self.acting, *more) = [i for i, level in enumerate(levels) if level >= BOUNDARY]
        if more or self.singular is not None:
            raise ArithmeticError("no law is known for two controls that are off their bounds")
        self.constraint = constraint_of(levels[self.acting])
        self.order = instance.model.spec.path_constraints[self.constraint].order
        low, high = instance.lower[self.acting], instance.upper[self.acting]
        self.middle, self.beyond = (low + high) / 2.0, BEYOND_RANGE * (high - low)

    def kept_at(self, t: float, z: list[float]) -> Row:
        return self.instance.control_set.saturated(self.control(t, z)).arguments

    def control(self, t: float, z: list[float]) -> tuple[float, ...]:
        found = self.controls(np.array([t]), np.array(z)[:, None])
        self._refuse_beyond(found)
        return tuple(found[:, 0].tolist())

    def _refuse_beyond(self, u: Array) -> None:
        """Raise an error if the control on the boundary, (m, N), is far beyond its bounds at some point."""
        if not (np.abs(u[self.acting] - self.middle) <= self.beyond).all():
            raise ArithmeticError("the control on the boundary leaves its bounds for good")

    def controls(self, t: NDArray[Any], z: NDArray[Any]) -> NDArray[Any]:
        """Return the controls at many points, shape (m, N)."""
        x, lam = z[: self.n], z[self.n :]
        table = self.model.boundary_control_batch(t, x, lam, self.p, self.instance.control_set.arguments)
        u = np.empty((len(self.levels), len(t)), dtype=z.dtype)
        u[:] = np.array(self.saturated)[:, None]
        u[self.acting] = np.asarray(table)[self.constraint, self.acting]
        return u

    def multiplier(self, t: NDArray[Any], z: NDArray[Any]) -> NDArray[Any]:
        """Return the multiplier that keeps the switching function at zero, shape (N,)."""
        x, lam, bounds = z[: self.n], z[self.n :], self.instance.control_set.arguments
        found = np.asarray(self.model.path_multiplier_batch(t, x, self.controls(t, z), lam, self.p, bounds))
        return np.broadcast_to(found[self.constraint], t.shape)

    def off_bound(self, bound: float, t: float, z: list[float]) -> tuple[float, Array, float]:
        """Return the control minus a bound, relative to its range, and derivatives by z, (2n,), and explicit time."""
        low, high = self.instance.lower[self.acting], self.instance.upper[self.acting]
        found = self.controls(*_moved(t, z))[self.acting] / (high - low)
        return float(found[0].real - bound / (high - low)), found[:-1].imag / NUDGE, float(found[-1].imag / NUDGE)

    def rates(self, t: float, z: list[float]) -> list[float]:
        self.control(t, z)
        return self.along(np.array([t]), np.array(z)[:, None])[1][:, 0].tolist()

    def along(self, t: NDArray[Any], z: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        x, lam, u = z[: self.n], z[self.n :], self.controls(t, z)
        found = np.empty_like(z)
        found[: self.n] = self.model.dynamics_batch(t, x, u, self.p)
        found[self.n :] = self.model.costate_rate_batch(t, x, u, lam, self.p)
        found[self.n :] -= self.multiplier(t, z) * self.model.path_gradient_batch(t, x, u, self.p)[self.constraint]
        return u, found

    def linearised(self, t: float, z: list[float]) -> tuple[Array, Array]:
        rates, slopes = self.linearised_along(np.array([t]), np.array(z)[:, None])
        return rates[:, 0], slopes[0]

    def linearised_along(self, t: Array, z: Array) -> tuple[Array, Array]:
        """Return rates (2n, N) at many points, and their derivatives with respect to z, shape (N, 2n, 2n)."""
        rows, count = z.shape
        moved = z[:, None] + 1j * NUDGE * np.eye(rows)[:, :, None]
        slopes = self.along(np.tile(t, rows), moved.reshape(rows, -1))[1].imag / NUDGE
        u, found = self.along(t, z)
        self._refuse_beyond(u)
        return found, slopes.reshape(rows, rows, count).transpose(2, 0, 1)


def off_boundary(
    instance: Instance, constraint: int, t: float, z: list[float], rate: bool = False
) -> tuple[float, Array, float]:
    """Return a constraint or its first time derivative, and its derivatives by z, shape (2n,), and explicit time."""
    n, (times, moved) = len(instance.initial), _moved(t, z)
    rest, p = np.zeros((len(instance.model.spec.controls), len(times))), instance.parameters
    if rate:
        found = np.asarray(instance.model.path_rates_batch(times, moved[:n], rest, p))[constraint, 0]
    else:
        bounds = instance.control_set.arguments
        found = np.asarray(instance.model.path_constraints_batch(times, moved[:n], rest, p, bounds))[constraint]
    return float(found[0].real), found[:-1].imag / NUDGE, float(found[-1].imag / NUDGE)


def pushed(
    instance: Instance, constraint: int, t: float, z: Array, by: float
) -> tuple[Array, tuple[Array, Array, Array]]:
    """Return states and costates after a jump of the costates by ``-by`` times g_x.

    Also returns g_x, shape (n,), and its derivatives with respect to states and explicit time, shapes (n, n) and (n,).
    """
    n, (times, moved) = len(instance.initial), _moved(t, z.tolist())
    rest = np.zeros((len(instance.model.spec.controls), len(times)))
    table = np.asarray(instance.model.path_gradient_batch(times, moved[:n], rest, instance.parameters))[constraint]
    slope, slopes = table[:, 0].real, table.imag / NUDGE
    return np.concatenate([z[:n], z[n:] - by * slope]), (slope, slopes[:, :n], slopes[:, -1])


def _moved(t: float, z: list[float]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return a point with complex steps in each of its components and in time, shapes (2n + 1,) and (2n, 2n + 1)."""
    step = 1j * NUDGE * np.eye(len(z) + 1)
    return t + step[-1], np.array(z)[:, None] + step[:-1]
