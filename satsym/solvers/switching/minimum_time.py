"""The minimum time to a given end, for any switching problem: evidence that a given final time is too short.

The contributions of a cost to costate rates and switching functions remain if costates vanish, so that subtracting
these values gives the functions of the minimum-time problem with the same motion.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.instance import Instance
from satsym.kernels import Kernels
from satsym.solvers.switching.magnitudes import moving

Function = Callable[..., Any]

STEP = 1e-6
"""Step of the central difference for the rate of the reference, relative to the time."""


def minimum_time(instance: Instance) -> Instance | None:
    """Return the minimum-time problem with the same motion, bounds and ends; ``None`` with terminal constraints."""
    if instance.model.spec.multipliers:
        return None
    if any(moving(instance)):  # what magnitudes do to the motion is not told apart from what they cost
        return None
    spec = replace(instance.model.spec, has_terminal_cost=False, chattering=())
    model = Kernels(spec, _LeastTime(instance.model).functions())
    return replace(instance, model=model, tf=None, tf_guess=instance.tf)


class _LeastTime:
    """Functions that the solver of switching problems calls, for a running cost of 1."""

    def __init__(self, model: Kernels) -> None:
        self.model = model
        self.n, self.m = len(model.spec.states), len(model.spec.controls)
        self.whole: dict[str, Function] = dict(model.functions)
        self.nothing = (0.0,) * self.n
        self.linear: dict[str, Function] = {}
        for name, place in (("costate_rate", 3), ("switching_function", 2), ("switching_rate", 3)):
            self.linear[name] = self._alone(name, place)
            self.linear[f"{name}_batch"] = self._alone_batch(name, place)

    def functions(self) -> dict[str, Function]:
        """Return all functions of the model, with the functions that depend on the cost replaced."""
        n, m = self.n, self.m
        return (
            self.whole
            | self.linear
            | {
                "magnitude_weight": lambda *_: (0.0,) * m,
                "magnitude_weight_batch": lambda t, *_: np.zeros((m, *np.shape(t))),
                "extremal_jacobian": self.extremal_jacobian,
                "extremal_jacobian_batch": self.extremal_jacobian_batch,
                "canonical_batch": self.canonical_batch,
                "canonical_jacobian_batch": self.canonical_jacobian_batch,
                "canonical": _one(self.canonical_batch),
                "canonical_jacobian": _one(self.canonical_jacobian_batch),
                "boundary": lambda *given: tuple(self.ends(*given)[0]),
                "boundary_jacobian": lambda *given: tuple(np.ravel(self.ends(*given)[1]).tolist()),
                "running_cost": lambda *_: 1.0,
                "running_cost_batch": lambda t, *_: np.ones(np.shape(t)),
                "terminal_cost": lambda *_: 0.0,
                "terminal_gradient": lambda *_: (0.0,) * n,
            }
        )

    def _alone(self, name: str, place: int) -> Function:
        """Return a function of the costates (the argument at ``place``) minus its value for vanishing costates."""

        def alone(*given: Any) -> tuple[float, ...]:
            plain, without = self.whole[name], (*given[:place], self.nothing, *given[place + 1 :])
            return tuple(a - b for a, b in zip(plain(*given), plain(*without), strict=True))

        return alone

    def _alone_batch(self, name: str, place: int) -> Function:
        """Return a batch function minus its value for a zero argument at ``place``."""

        def alone(*given: Any, out: Array | None = None) -> Array:
            batch, without = self.whole[f"{name}_batch"], (*given[:place], 0.0 * given[place], *given[place + 1 :])
            return np.subtract(batch(*given), batch(*without), out=out)

        return alone

    def extremal_jacobian_batch(self, t: Array, x: Array, u: Array, lam: Array, p: Sequence[float]) -> Array:
        """Return derivatives of state and costate rates by both for saturated controls, shape (2n, 2n, N)."""
        batch, n = self.whole["extremal_jacobian_batch"], self.n
        found, without = batch(t, x, u, lam, p), batch(t, x, u, 0.0 * lam, p)
        found[n:, :n] -= without[n:, :n]
        return np.asarray(found)

    def extremal_jacobian(self, t: float, x: Any, u: Any, lam: Any, p: Any) -> tuple[float, ...]:
        """Return derivatives of state and costate rates by both at one point for saturated controls, row by row."""
        n, plain = self.n, self.whole["extremal_jacobian"]
        found, without = (np.array(plain(t, x, u, at, p)).reshape(2 * n, 2 * n) for at in (lam, self.nothing))
        found[n:, :n] -= without[n:, :n]
        return tuple(found.ravel().tolist())

    def law(self, t: Array, x: Array, lam: Array, p: Any, bounds: Any) -> tuple[Array, NDArray[np.bool_]]:
        """Return controls of the regularised problem, shape (m, N), and whether they are within their bounds."""
        control_set = ControlSet.from_arguments(self.model.spec, bounds)
        wanted = -self.linear["switching_function_batch"](t, x, lam, p) / control_set.smoothing
        low, high = control_set.box
        return control_set.project(wanted), (wanted > low) & (wanted < high)

    def canonical_batch(self, t: Array, x: Array, lam: Array, p: Any, bounds: Any, out: Array | None = None) -> Array:
        """Return rates of states and costates under the regularised control law."""
        u, _ = self.law(t, x, lam, p, bounds)
        rates = self.whole["dynamics_batch"](t, x, u, p), self.linear["costate_rate_batch"](t, x, u, lam, p)
        return _into(out, np.concatenate(rates))

    def canonical_jacobian_batch(
        self, t: Array, x: Array, lam: Array, p: Any, bounds: Any, out: Array | None = None
    ) -> Array:
        """Return derivatives of the rates of states and costates under the regularised control law, (2n, 2n, N)."""
        n, m = self.n, self.m
        u, free = self.law(t, x, lam, p, bounds)
        smoothing = ControlSet.from_arguments(self.model.spec, bounds).smoothing
        found = self.extremal_jacobian_batch(t, x, u, lam, p)
        acting = self.whole["jacobian_u_batch"](t, x, u, p)
        for i in range(m):
            unit = np.zeros_like(u)
            unit[i] = 1.0
            there, back = (self.linear["costate_rate_batch"](t, x, side * unit, lam, p) for side in (1.0, -1.0))
            gradient = np.concatenate([(back - there) / 2.0, np.broadcast_to(acting[:, i], x.shape)])
            by_control = np.concatenate([gradient[n:], -gradient[:n]])
            found = found - np.where(free[i], 1.0, 0.0) / smoothing * by_control[:, None] * gradient[None]
        return _into(out, found)

    def ends(
        self, t: float, x: Any, lam: Any, _nu: Any, p: Any, bounds: Sequence[float], final: Sequence[float]
    ) -> tuple[list[float], Array]:
        """Return residuals at the end and derivatives: given states, free states' costates, and the Hamiltonian."""
        n = self.n
        given, on_reference, target = np.array(final).reshape(3, -1)
        nothing = np.zeros(n)
        curve, slope = self._reference(t, p) if on_reference.any() else (nothing, nothing)
        fixed = given + on_reference
        u = self.law(np.array([t]), np.array(x)[:, None], np.array(lam)[:, None], p, bounds)[0][:, 0].tolist()
        f = np.array(self.model.dynamics(t, x, u, p))
        rates = np.array(self.linear["costate_rate"](t, x, u, lam, p))
        smoothing = ControlSet.from_arguments(self.model.spec, bounds).smoothing
        value = 1.0 + float(np.array(lam) @ f) + smoothing / 2.0 * sum(v * v for v in u)
        value -= float(on_reference * np.array(lam) @ slope)
        rows = fixed * (np.array(x) - given * target - on_reference * curve) + (1.0 - fixed) * np.array(lam)
        table = np.zeros((n + 1, 2 * n + 1))
        table[range(n), range(n)] = fixed
        table[range(n), range(n, 2 * n)] = 1.0 - fixed
        table[:n, -1] = -on_reference * slope
        table[n, :n], table[n, n : 2 * n] = -rates, f - on_reference * slope
        return [*rows.tolist(), value], table

    def _reference(self, t: float, p: Any) -> tuple[Array, Array]:
        """Return the reference and its time derivative."""
        width = STEP * max(1.0, abs(t))
        before, after = (np.array(self.model.reference(at, p)) for at in (t - width, t + width))
        return np.array(self.model.reference(t, p)), (after - before) / (2.0 * width)


def _into(out: Array | None, found: Array) -> Array:
    """Return values, stored in an output array if there is one."""
    if out is None:
        return found
    out[...] = found
    return out


def _one(batch: Function) -> Function:
    """Return a batch function as a function of one point."""

    def alone(t: float, x: Any, lam: Any, p: Any, bounds: Any) -> tuple[float, ...]:
        found = batch(np.array([t]), np.array(x)[:, None], np.array(lam)[:, None], p, bounds)
        return tuple(np.ravel(found).tolist())

    return alone
