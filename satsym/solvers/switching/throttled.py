"""Extremal equations for vectors with throttled norms, and for controls that switch in a product of control sets.

A generated function gives the derivative of H with respect to the norm along the best direction of such a vector; where
it changes its sign, the norm switches between its bounds, and so does a single control where its derivative of H does.
On an arc each of them keeps its level, and the other controls follow the costates: these are the canonical equations
with fixed levels.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import ControlSet, Row
from satsym.instance import Instance
from satsym.solvers.switching import magnitudes
from satsym.solvers.switching.boundary import BoundaryField
from satsym.solvers.switching.field import NUDGE, Field
from satsym.solvers.switching.magnitudes import effective
from satsym.solvers.switching.structure import BOUNDARY

NOTHING = 1e-300
"""Tiny level of a norm in place of zero: levels must differ from the margin that decides them, which is zero at a
switch."""

ON_BOUND = 1e-12
"""Distance from a bound below which a control counts as being at the bound."""


class ThrottledField(Field):
    """Rates of states and costates while every switching norm and control keeps its level; see :class:`Field`."""

    def __init__(self, instance: Instance, levels: tuple[int, ...]) -> None:
        super().__init__(instance, levels)
        if self.singular is not None:
            raise ArithmeticError("no law is known for a level that nothing decides")
        throttled = [places for places, part in instance.control_set.parts if part.throttled]
        self.steered = [one for one in instance.control_set.parts if not one[1].throttled and one[1].bounded]
        self.none = [i for places, level in zip(throttled, self.saturated, strict=True) for i in places if not level]
        self.arguments = instance.control_set.saturated(tuple(level or NOTHING for level in self.saturated)).arguments

    def kept_at(self, t: float, z: list[float]) -> Row:
        return self.arguments

    def control(self, t: float, z: list[float]) -> tuple[float, ...]:
        u = self.model.control_law(t, z[: self.n], z[self.n :], self.p, self.arguments)
        return tuple(0.0 if i in self.none else value for i, value in enumerate(u))

    def sides(self, t: float, z: list[float]) -> NDArray[np.bool_]:
        if not self.steered:
            return np.zeros(0, bool)
        u = self.control(t, z)
        rows = [part.excess(np.array([[u[i]] for i in places]))[:, 0] for places, part in self.steered]
        return np.abs(np.concatenate(rows)) <= ON_BOUND

    def rates(self, t: float, z: list[float]) -> list[float]:
        return list(self.model.canonical(t, z[: self.n], z[self.n :], self.p, self.arguments))

    def linearised(self, t: float, z: list[float]) -> tuple[Array, Array]:
        slopes = self.model.canonical_jacobian(t, z[: self.n], z[self.n :], self.p, self.arguments)
        return np.array(self.rates(t, z)), np.array(slopes).reshape(2 * self.n, 2 * self.n)

    def drift(self, t: float, z: list[float]) -> tuple[float, ...]:
        """Return derivatives of the rates of states and costates by explicit time."""
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
        return float(self.model.throttle_slope(t, z[: self.n], z[self.n :], self.p, self.arguments)[control])

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
        """Return derivatives of a switching function by states, costates and explicit time, shape (2n + 1,)."""
        columns = np.array([*z, t], dtype=complex)[:, None] + 1j * NUDGE * np.eye(2 * self.n + 1)
        x, lam = columns[: self.n], columns[self.n : -1]
        found = np.asarray(self.model.throttle_slope_batch(columns[-1], x, lam, self.p, self.arguments))
        return np.asarray(found[control].imag / NUDGE)


def equations(instance: Instance, levels: tuple[int, ...]) -> Field:
    """Return the equations of an arc with the given levels."""
    if max(levels) >= BOUNDARY:
        return BoundaryField(instance, levels)
    return (ThrottledField if instance.model.spec.throttled else Field)(instance, levels)


def signs(instance: Instance, t: Array, x: Array, lam: Array) -> tuple[Array, Array]:
    """Return switching functions and nonnegative weights of magnitudes at many points, shapes (r, N)."""
    model, p = instance.model, instance.parameters
    if model.spec.throttled:
        sigma = np.asarray(model.throttle_slope_batch(t, x, lam, p, instance.control_set.arguments))
        return sigma, np.zeros_like(sigma)
    sigma = model.switching_function_batch(t, x, lam, p)
    return effective(*instance.control_set.box, sigma, model.magnitude_weight_batch(t, x, lam, p))


def switched(instance: Instance, u: Array) -> Array:
    """Return the quantities that switch: controls or, in products of sets, single controls and norms, (r, N)."""
    if not instance.model.spec.throttled:
        return u

    def level(places: tuple[int, ...], part: ControlSet) -> Array:
        return u[places[0]] if part.kind == "box" else np.asarray(np.linalg.norm(u[list(places)], axis=0))

    return np.array([level(*one) for one in instance.control_set.parts if one[1].throttled])


def by_control(instance: Instance, times: list[tuple[float, ...]]) -> tuple[tuple[float, ...], ...]:
    """Return the switching times of each control, from those of the controls and norms that switch."""
    if not instance.model.spec.throttled:
        return tuple(times)
    throttled = [places for places, part in instance.control_set.parts if part.throttled]
    own = {i: row for places, row in zip(throttled, times, strict=True) for i in places}
    return tuple(own.get(i, ()) for i in range(len(instance.model.spec.controls)))


def shown_by(instance: Instance) -> list[int]:
    """Return for each switching control or norm the index of a control that has its switching times."""
    if not instance.model.spec.throttled:
        return list(range(len(instance.lower)))
    return [places[0] for places, part in instance.control_set.parts if part.throttled]


def resting(instance: Instance) -> tuple[bool, ...]:
    """Return for each switching control or norm whether it can optimally be at rest."""
    if instance.model.spec.throttled:
        return (False,) * len(instance.control_set.switching[0])
    return magnitudes.resting(instance)
