"""Extremal equations where vectors are throttled: each keeps its norm, and its direction follows the costates.

H falls along the best direction of such a vector by what a generated function says; where that changes its sign the
norm switches between its bounds. The equations of an arc are the canonical ones with the norm kept.
"""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.control_set import Row
from satsym.instance import Instance
from satsym.solvers.switching.field import NUDGE, Field

NOTHING = 1e-300
"""A norm that is none: right at a switch the margin that decides it is zero as well, and must not be equal to it."""


class ThrottledField(Field):
    """Rates of states and costates while every vector that is throttled keeps its norm; see :class:`Field`."""

    def __init__(self, instance: Instance, levels: tuple[int, ...]) -> None:
        super().__init__(instance, levels)
        if self.singular is not None:
            raise ArithmeticError("no law is known for a vector whose norm nothing decides")
        throttled = [places for places, part in instance.control_set.parts if part.throttled]
        self.none = [i for places, norm in zip(throttled, self.saturated, strict=True) for i in places if not norm]
        norms = tuple(max(norm, NOTHING) for norm in self.saturated)
        self.arguments = instance.control_set.saturated(norms).arguments

    def kept_at(self, t: float, z: list[float]) -> Row:
        return self.arguments

    def control(self, t: float, z: list[float]) -> tuple[float, ...]:
        u = self.model.control_law(t, z[: self.n], z[self.n :], self.p, self.arguments)
        return tuple(0.0 if i in self.none else value for i, value in enumerate(u))

    def rates(self, t: float, z: list[float]) -> list[float]:
        return list(self.model.canonical(t, z[: self.n], z[self.n :], self.p, self.arguments))

    def linearised(self, t: float, z: list[float]) -> tuple[Array, Array]:
        slopes = self.model.canonical_jacobian(t, z[: self.n], z[self.n :], self.p, self.arguments)
        return np.array(self.rates(t, z)), np.array(slopes).reshape(2 * self.n, 2 * self.n)

    def drift(self, t: float, z: list[float]) -> tuple[float, ...]:
        """The rates of states and costates by explicit time."""
        return tuple(self.model.canonical_drift(t, z[: self.n], z[self.n :], self.p, self.arguments))

    def along(self, t: Array, z: Array) -> tuple[Array, Array]:
        x, lam = z[: self.n], z[self.n :]
        u = np.empty((len(self.model.spec.controls), z.shape[1]))
        found = np.empty_like(z)
        self.model.control_law_batch(t, x, lam, self.p, self.arguments, out=u)
        self.model.canonical_batch(t, x, lam, self.p, self.arguments, out=found)
        u[self.none] = 0.0
        return u, found

    def sigma(self, t: float, z: list[float], control: int) -> float:
        return float(self.model.throttle_slope(t, z[: self.n], z[self.n :], self.p)[control])

    def switching(self, t: float, z: list[float], control: int) -> tuple[float, float]:
        slopes = self._slopes(t, z, control)
        return self.sigma(t, z, control), float(slopes[:-1] @ self.rates(t, z) + slopes[-1])

    def gradient(self, t: float, z: list[float], control: int) -> Array:
        return self._slopes(t, z, control)[:-1]

    def weight(self, t: float, z: list[float], control: int) -> float:
        return 0.0

    def weight_gradient(self, t: float, z: list[float], control: int) -> tuple[Array, float]:
        return np.zeros(2 * self.n), 0.0

    def _slopes(self, t: float, z: list[float], control: int) -> Array:
        """A switching function by states, costates and explicit time, shape (2n + 1,)."""
        columns = np.array([*z, t], dtype=complex)[:, None] + 1j * NUDGE * np.eye(2 * self.n + 1)
        x, lam = columns[: self.n], columns[self.n : -1]
        found = np.asarray(self.model.throttle_slope_batch(columns[-1], x, lam, self.p))
        return np.asarray(found[control].imag / NUDGE)


def equations(instance: Instance, levels: tuple[int, ...]) -> Field:
    """The equations of an arc."""
    return (ThrottledField if instance.model.spec.throttled else Field)(instance, levels)


def signs(instance: Instance, t: Array, x: Array, lam: Array) -> tuple[Array, Array]:
    """Switching functions, and weights of magnitudes, at many points, shapes (r, N)."""
    model, p = instance.model, instance.parameters
    if model.spec.throttled:
        sigma = np.asarray(model.throttle_slope_batch(t, x, lam, p))
        return sigma, np.zeros_like(sigma)
    sigma = model.switching_function_batch(t, x, lam, p)
    return sigma, np.broadcast_to(model.magnitude_weight_batch(t, x, p), sigma.shape)


def switched(instance: Instance, u: Array) -> Array:
    """What switches: the controls, or the norms of vectors that are throttled; shape (r, N)."""
    if not instance.model.spec.throttled:
        return u
    parts = instance.control_set.parts
    return np.array([np.linalg.norm(u[list(places)], axis=0) for places, part in parts if part.throttled])


def by_control(instance: Instance, times: list[tuple[float, ...]]) -> tuple[tuple[float, ...], ...]:
    """Switching times of each control, from those of what switches."""
    if not instance.model.spec.throttled:
        return tuple(times)
    throttled = [places for places, part in instance.control_set.parts if part.throttled]
    own = {i: row for places, row in zip(throttled, times, strict=True) for i in places}
    return tuple(own.get(i, ()) for i in range(len(instance.model.spec.controls)))


def shown_by(instance: Instance) -> list[int]:
    """For each of what switches a control that has its switching times."""
    if not instance.model.spec.throttled:
        return list(range(len(instance.lower)))
    return [places[0] for places, part in instance.control_set.parts if part.throttled]


def weights(instance: Instance) -> tuple[float, ...]:
    """Weights of magnitudes at the start."""
    if instance.model.spec.throttled:
        return (0.0,) * len(instance.control_set.switching[0])
    return tuple(instance.model.magnitude_weight(instance.t0, instance.initial, instance.parameters))
