"""Several constraints active at the same time: the control, the multipliers, and the rates of states and costates.

For one active constraint these are derived and generated. For several they follow from the generated functions of each;
beside a constraint on states alone only if H is quadratic in the controls. Let W = H_uu, and let each row E_k be the
derivative with respect to the controls of g_k if g_k involves the controls, else of its last time derivative (the first
one that involves them). Active control constraints shift the controls by -W^-1 E' eta from the minimum of H. On
boundaries of constraints on states the last time derivatives vanish under that control and stay zero: the multipliers
follow from derivatives of these; those of constraints of order one appear in the first of them, those of order two in
the second. Time derivatives along the extremal are taken by complex steps and, where these are no longer analytic, by
differences.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained import arcs as one_by_one
from satsym.solvers.constrained.law import by_newton, stationary
from satsym.solvers.constrained.structure import Active

STEP = 1e-2
"""Step of differences, relative to the time in which a state or a costate changes by its magnitude."""

EIGHTH = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))
"""Offsets and weights of central differences of order eight."""

Rates = Callable[[NDArray[Any], NDArray[Any]], Array]


def order(instance: Instance, constraint: int) -> int:
    """Return the order of a constraint: how often it is differentiated with respect to time until a control appears."""
    return instance.model.spec.path_constraints[constraint].order


def analytic(instance: Instance, active: Active) -> bool:
    """Return whether quantities under several active constraints are analytic, so that complex steps are possible."""
    orders = {order(instance, k) for k in active}
    return len(active) < 2 or len(orders) == 1


def control(instance: Instance, active: Active, t: Array, z: Array) -> Array:
    """Return controls, shape (m, N), that minimise H among the controls that satisfy the active control constraints."""
    held = tuple(k for k in active if order(instance, k) == 0)
    if len(held) < 2:
        return one_by_one.control(instance, held[0] if held else one_by_one.NONE, t, z)
    return Together(instance, held, t, z).control


def field(instance: Instance, active: Active, t: Array, z: Array) -> Array:
    """Return the rates of states and costates, shape (2n, N), under active constraints."""
    if len(active) < 2:
        return one_by_one.field(instance, active[0] if active else one_by_one.NONE, t, z)
    return field_and_control(instance, active, t, z)[0]


def field_and_control(instance: Instance, active: Active, t: Array, z: Array) -> tuple[Array, Array]:
    """Return the rates of states and costates, shape (2n, N), and the controls, shape (m, N)."""
    if len(active) < 2:
        return one_by_one.field_and_control(instance, active[0] if active else one_by_one.NONE, t, z)
    if stationary(instance) and any(order(instance, k) for k in active):
        raise np.linalg.LinAlgError("constraints on states beside others, where H is not quadratic in the controls")
    here = Together(instance, active, t, z)
    return here.along(here.multipliers), here.control


def multipliers(instance: Instance, active: Active, t: Array, z: Array) -> Array:
    """Return the multipliers eta of the active constraints, shape (k, N)."""
    if len(active) < 2:
        return np.array([one_by_one.multiplier(instance, k, t, z) for k in active]).reshape(len(active), len(t))
    return Together(instance, active, t, z).multipliers


def vanishing(instance: Instance, active: Active, constraint: int, t: Array, z: Array) -> Array:
    """Return the quantities that a constraint on states keeps at zero while constraints are active, shape (q, N).

    They are its last time derivative and, for order two, the time derivative of that.
    """
    if active == (constraint,):
        return one_by_one.vanishing(instance, constraint, t, z)
    return Together(instance, active, t, z).vanishing(constraint)


def deciding(instance: Instance, active: Active, constraint: int, t: Array, z: Array) -> Array:
    """Return the value of a control constraint under the other active constraints, shape (N,).

    Its sign decides whether the constraint is active.
    """
    others = tuple(k for k in active if k != constraint)
    x = z[: len(instance.initial)]
    return one_by_one.values(instance, t, x, control(instance, others, t, z))[constraint]


@dataclass(frozen=True, eq=False)
class Together:
    """Several active constraints at times (N,), with states and costates (2n, N)."""

    instance: Instance
    active: Active
    t: NDArray[Any]
    z: NDArray[Any]

    @property
    def n(self) -> int:
        """Return the number of states."""
        return len(self.instance.initial)

    def _of_order(self, *wanted: int) -> list[int]:
        return [k for k in self.active if order(self.instance, k) in wanted]

    @cached_property
    def curvature(self) -> Array:
        """H_uu, shape (N, m, m), from differences of H_u, which is linear in the controls."""
        x, lam = self.z[: self.n], self.z[self.n :]
        model, m = self.instance.model, len(self.instance.model.spec.controls)

        def slope(u: Array) -> Array:
            u = np.broadcast_to(u[:, None], (m, len(self.t)))
            return np.broadcast_to(model.stationarity_batch(self.t, x, u, lam, self.instance.parameters), u.shape)

        rest = slope(np.zeros(m))
        return np.moveaxis(np.array([slope(unit) - rest for unit in np.eye(m)]), -1, 0).swapaxes(1, 2)

    def effects(self, which: list[int]) -> Array:
        """Return the rows E of constraints, (N, k, m): derivatives of their last time derivatives by the controls."""
        found, x, m = [], self.z[: self.n], len(self.instance.model.spec.controls)
        held = one_by_one.effects(self.instance, self.t, x, np.zeros((m, len(self.t))))
        rest = self._last_rates(which, np.zeros((m, len(self.t))))
        rows = [self._last_rates(which, np.repeat(unit[:, None], len(self.t), axis=1)) - rest for unit in np.eye(m)]
        for place, k in enumerate(which):
            found.append(held[k] if order(self.instance, k) == 0 else np.array([row[place] for row in rows]))
        return np.moveaxis(np.array(found), -1, 0)

    def _last_rates(self, which: list[int], u: Array) -> Array:
        """Return last time derivatives of constraints for given controls, (k, N); values for control constraints."""
        x, model = self.z[: self.n], self.instance.model
        h = len(model.spec.path_constraints)
        rates = np.asarray(model.path_rates_batch(self.t, x, u, self.instance.parameters))
        rates = np.broadcast_to(rates.reshape(h, 2, -1), (h, 2, len(self.t)))
        own, orders = one_by_one.values(self.instance, self.t, x, u), [order(self.instance, k) for k in which]
        rows = [own[k] if q == 0 else rates[k, q - 1] for k, q in zip(which, orders, strict=True)]
        return np.array(rows).reshape(len(which), len(self.t))

    @cached_property
    def _holding(self) -> tuple[Array, Array]:
        """Return the control, shape (m, N), and the multipliers of the active control constraints, shape (k, N)."""
        which = self._of_order(0)
        if stationary(self.instance):
            return by_newton(self.instance, tuple(which), self.t, self.z)
        free = one_by_one.control(self.instance, one_by_one.NONE, self.t, self.z)
        if not which:
            return free, np.zeros((0, len(self.t)))
        effect = self.effects(which)
        turned = np.linalg.solve(self.curvature, effect.swapaxes(1, 2))  # (N, m, k)
        missed = self._last_rates(which, free)
        eta = np.linalg.solve(effect @ turned, missed.T[..., None])
        return free - (turned @ eta)[..., 0].T, eta[..., 0].T

    @property
    def control(self) -> Array:
        """Return the control, shape (m, N)."""
        return self._holding[0]

    def along(self, eta: Array) -> Array:
        """Return rates of states and costates, (2n, N), with given multipliers of all active constraints, (k, N)."""
        model, p, u = self.instance.model, self.instance.parameters, self.control
        x, lam = self.z[: self.n], self.z[self.n :]
        push = one_by_one.gradients(self.instance, self.t, x, u)[list(self.active)]
        rates = (model.dynamics_batch(self.t, x, u, p), model.costate_rate_batch(self.t, x, u, lam, p))
        moved, turned = (np.broadcast_to(rate, x.shape) for rate in rates)
        return np.concatenate([moved, turned - np.einsum("kN,knN->nN", eta, push)])

    @cached_property
    def multipliers(self) -> Array:
        """Multipliers eta of all active constraints, shape (k, N)."""
        if self._of_order(1, 2) and analytic(self.instance, self.active):
            return self._of_one_order
        found = dict(zip(self._of_order(0), self._holding[1], strict=True))
        found |= dict(zip(self._of_order(1), self._of_first_order, strict=True))
        found |= dict(zip(self._of_order(2), self._of_second_order, strict=True))
        return np.array([found[k] for k in self.active])

    @property
    def _of_one_order(self) -> Array:
        """Return multipliers of constraints on states of equal order from those that each would have alone.

        For a single constraint M_kk eta_k = -a_k, for all together M eta = -a.
        """
        effect = self.effects(list(self.active))
        gram = effect @ np.linalg.solve(self.curvature, effect.swapaxes(1, 2))
        alone = np.array([one_by_one.multiplier(self.instance, k, self.t, self.z) for k in self.active])
        needed = np.einsum("Nkk,kN->Nk", gram, alone)
        return np.linalg.solve(gram, needed[..., None])[..., 0].T

    @cached_property
    def _partial(self) -> Array:
        """Rates of states and costates with the multipliers of control constraints only."""
        return self.along(self._eta(self._holding[1], self._of_order(0)))

    def _eta(self, found: Array, which: list[int]) -> Array:
        """Return a table of the multipliers of all active constraints, with the given ones set and the others zero."""
        table = np.zeros((len(self.active), len(self.t)), np.result_type(found, float))
        table[[self.active.index(k) for k in which]] = found
        return table

    def _pushes(self, which: list[int]) -> list[Array]:
        """Return the directions in which multipliers change the costates, shape (2n, N) each."""
        push = one_by_one.gradients(self.instance, self.t, self.z[: self.n], self.control)
        return [np.concatenate([0.0 * push[k], -push[k]]) for k in which]

    @cached_property
    def _of_first_order(self) -> Array:
        """Multipliers of constraints of order one, which keep the first time derivatives of these constant."""
        if not (which := self._of_order(1)):
            return np.zeros((0, len(self.t)))
        rates = self._rates_of(which)
        by_eta = np.array([_derivative(rates, self.t, self.z, 0.0, push) for push in self._pushes(which)])
        drift = _derivative(rates, self.t, self.z, 1.0, self._partial)
        return np.linalg.solve(by_eta.transpose(2, 1, 0), -drift.T[..., None])[..., 0].T

    def _rates_of(self, which: list[int]) -> Rates:
        """Return a function that gives the last time derivatives of some constraints at other points."""

        def rates(t: NDArray[Any], z: NDArray[Any]) -> Array:
            there = Together(self.instance, self.active, t, z)
            return there._last_rates(which, there.control)

        return rates

    @cached_property
    def _without_second(self) -> Array:
        """Rates of states and costates without the multipliers of constraints of order two."""
        first = self._eta(self._of_first_order, self._of_order(1))
        return self.along(self._eta(self._holding[1], self._of_order(0)) + first)

    def _next(self, which: list[int]) -> Array:
        """Return the time derivatives of the last time derivatives of constraints of order two, shape (k, N)."""
        if not self._of_order(0, 1) and set(which) <= set(self.active):
            known = [one_by_one.vanishing(self.instance, k, self.t, self.z)[1] for k in which]
            return np.array(known).reshape(len(which), len(self.t))
        return _derivative(self._rates_of(which), self.t, self.z, 1.0, self._without_second)

    @cached_property
    def _of_second_order(self) -> Array:
        """Multipliers of constraints of order two, which keep the third time derivatives of these constant."""
        if not (which := self._of_order(2)):
            return np.zeros((0, len(self.t)))

        def rates(t: NDArray[Any], z: NDArray[Any]) -> Array:
            return Together(self.instance, self.active, t, z)._next(which)

        by_eta = np.array([_difference(rates, self.t, self.z, 0.0, push) for push in self._pushes(which)])
        drift = _difference(rates, self.t, self.z, 1.0, self._without_second)
        return np.linalg.solve(by_eta.transpose(2, 1, 0), -drift.T[..., None])[..., 0].T

    def vanishing(self, constraint: int) -> Array:
        """Return the last time derivative of a constraint on states and, for order two, its time derivative, (q, N)."""
        last = self._last_rates([constraint], self.control)
        return last if order(self.instance, constraint) < 2 else np.concatenate([last, self._next([constraint])])


def _derivative(function: Rates, t: Array, z: Array, dt: float, dz: Array) -> Array:
    """Return the derivative of a function along a direction, by a complex step."""
    step = COMPLEX_STEP
    return np.imag(function(t + 1j * step * dt, z + 1j * step * dz)) / step


def _difference(function: Rates, t: Array, z: Array, dt: float, dz: Array) -> Array:
    """Return the derivative of a function along a direction, by central differences."""
    n = len(z) // 2
    size = np.abs(z).max(axis=1, keepdims=True)
    for half in (slice(0, n), slice(n, 2 * n)):
        size[half] = np.maximum(size[half], 1e-3 * max(float(size[half].max()), 1e-300))
    step = STEP / max(float((np.abs(dz) / size).max()), 1e-300)
    sides = ((w, function(t + s * k * step * dt, z + s * k * step * dz) * s) for k, w in EIGHTH for s in (1, -1))
    return np.asarray(sum(w * value for w, value in sides) / step)
