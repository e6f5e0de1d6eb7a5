"""The least time to a given end, whatever a switching problem costs: evidence where a given time is too short.

Everything that a cost adds to costates and switching functions is there for vanishing costates as well, so the
difference is what the motion alone makes of them: the kernels of the problem of least time.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.kernels import Kernels

Array = NDArray[np.floating[Any]]
Function = Callable[..., Any]


def least_time(instance: Instance) -> Instance | None:
    """The problem of least time with the same motion, bounds and ends; ``None`` where constraints tie the end."""
    if instance.model.spec.multipliers:
        return None
    model = Kernels(replace(instance.model.spec, has_terminal_cost=False), _functions(instance.model))
    return replace(instance, model=model, tf=None, tf_guess=instance.tf)


def _functions(model: Kernels) -> dict[str, Function]:
    """What the solver of switching problems calls, for a running cost of one."""
    n, m = len(model.spec.states), len(model.spec.controls)
    nothing = (0.0,) * n
    whole = dict(model.functions)
    costs: dict[str, Function] = {}

    def linear(name: str, place: int) -> tuple[Function, Function]:
        """A function of the costates, the argument at that place, without what it is where they vanish."""
        plain, batch = whole[name], whole[f"{name}_batch"]

        def alone(*given: Any) -> tuple[float, ...]:
            without = (*given[:place], nothing, *given[place + 1 :])
            return tuple(a - b for a, b in zip(plain(*given), plain(*without), strict=True))

        def many(*given: Any, out: Array | None = None) -> Array:
            without = (*given[:place], 0.0 * given[place], *given[place + 1 :])
            return np.subtract(batch(*given), batch(*without), out=out)

        return alone, many

    costs["costate_rate"], costs["costate_rate_batch"] = linear("costate_rate", 3)
    costs["switching_function"], costs["switching_function_batch"] = linear("switching_function", 2)
    costs["switching_rate"], costs["switching_rate_batch"] = linear("switching_rate", 3)

    def magnitude_weight(*_: Any) -> tuple[float, ...]:
        return (0.0,) * m

    def magnitude_weight_batch(t: Array, *_: Any) -> Array:
        return np.zeros((m, *np.shape(t)))

    def extremal_jacobian_batch(t: Array, x: Array, u: Array, lam: Array, p: Sequence[float]) -> Array:
        batch = whole["extremal_jacobian_batch"]
        found, without = batch(t, x, u, lam, p), batch(t, x, u, 0.0 * lam, p)
        found[n:, :n] -= without[n:, :n]
        return np.asarray(found)

    def extremal_jacobian(t: float, x: Sequence[float], u: Sequence[float], lam: Sequence[float], p: Any) -> Any:
        size = 2 * n
        found, without = (
            np.array(whole["extremal_jacobian"](t, x, u, costates, p)).reshape(size, size)
            for costates in (lam, nothing)
        )
        found[n:, :n] -= without[n:, :n]
        return tuple(found.ravel().tolist())

    def law(t: Array, x: Array, lam: Array, p: Any, bounds: Sequence[float]) -> tuple[Array, NDArray[np.bool_]]:
        wanted = -costs["switching_function_batch"](t, x, lam, p) / bounds[2 * m]
        low, high = np.array(bounds[:m])[:, None], np.array(bounds[m : 2 * m])[:, None]
        return np.minimum(np.maximum(wanted, low), high), (wanted > low) & (wanted < high)

    def canonical_batch(t: Array, x: Array, lam: Array, p: Any, bounds: Any, out: Array | None = None) -> Array:
        u, _ = law(t, x, lam, p, bounds)
        found = np.concatenate([whole["dynamics_batch"](t, x, u, p), costs["costate_rate_batch"](t, x, u, lam, p)])
        if out is None:
            return found
        out[...] = found
        return out

    def canonical_jacobian_batch(t: Array, x: Array, lam: Array, p: Any, bounds: Any, out: Any = None) -> Array:
        u, free = law(t, x, lam, p, bounds)
        found = extremal_jacobian_batch(t, x, u, lam, p)
        acting = whole["jacobian_u_batch"](t, x, u, p)
        for i in range(m):
            unit = np.zeros_like(u)
            unit[i] = 1.0
            there, back = (costs["costate_rate_batch"](t, x, side * unit, lam, p) for side in (1.0, -1.0))
            gradient = np.concatenate([(back - there) / 2.0, np.broadcast_to(acting[:, i], x.shape)])
            by_control = np.concatenate([gradient[n:], -gradient[:n]])
            found = found - np.where(free[i], 1.0, 0.0) / bounds[2 * m] * by_control[:, None] * gradient[None]
        if out is None:
            return np.asarray(found)
        out[...] = found
        return np.asarray(out)

    def one(batch: Function) -> Function:
        """The same at one point, on floats."""

        def alone(t: float, x: Any, lam: Any, p: Any, bounds: Any) -> tuple[float, ...]:
            found = batch(np.array([t]), np.array(x)[:, None], np.array(lam)[:, None], p, bounds)
            return tuple(np.ravel(found).tolist())

        return alone

    def boundary(t: float, x: Any, lam: Any, _nu: Any, p: Any, bounds: Any, final: Any) -> tuple[float, ...]:
        return tuple(_ends(model, costs, law, t, x, lam, p, bounds, final)[0])

    def boundary_jacobian(t: float, x: Any, lam: Any, _nu: Any, p: Any, bounds: Any, final: Any) -> tuple[float, ...]:
        return tuple(np.ravel(_ends(model, costs, law, t, x, lam, p, bounds, final)[1]).tolist())

    return (
        whole
        | costs
        | {
            "magnitude_weight": magnitude_weight,
            "magnitude_weight_batch": magnitude_weight_batch,
            "extremal_jacobian": extremal_jacobian,
            "extremal_jacobian_batch": extremal_jacobian_batch,
            "canonical_batch": canonical_batch,
            "canonical_jacobian_batch": canonical_jacobian_batch,
            "canonical": one(canonical_batch),
            "canonical_jacobian": one(canonical_jacobian_batch),
            "boundary": boundary,
            "boundary_jacobian": boundary_jacobian,
            "running_cost": lambda *_: 1.0,
            "running_cost_batch": lambda t, *_: np.ones(np.shape(t)),
            "terminal_cost": lambda *_: 0.0,
            "terminal_gradient": lambda *_: nothing,
        }
    )


def _ends(
    model: Kernels,
    costs: dict[str, Function],
    law: Function,
    t: float,
    x: Sequence[float],
    lam: Sequence[float],
    p: Any,
    bounds: Sequence[float],
    final: Sequence[float],
) -> tuple[list[float], Array]:
    """Residuals at the end and their derivatives: given states, free ones' costates, and the Hamiltonian."""
    n = len(x)
    given, on_reference, target = np.array(final).reshape(3, -1)
    curve, slope = np.zeros(n), np.zeros(n)
    if on_reference.any():
        curve = np.array(model.reference(t, p))
        width = 1e-6 * max(1.0, abs(t))
        slope = (np.array(model.reference(t + width, p)) - np.array(model.reference(t - width, p))) / (2.0 * width)
    fixed = given + on_reference
    u = law(np.array([t]), np.array(x)[:, None], np.array(lam)[:, None], p, bounds)[0][:, 0].tolist()
    f = np.array(model.dynamics(t, x, u, p))
    rates = np.array(costs["costate_rate"](t, x, u, lam, p))
    smoothing = bounds[2 * len(u)]
    value = 1.0 + float(np.array(lam) @ f) + smoothing / 2.0 * sum(v * v for v in u)
    value -= float(on_reference * np.array(lam) @ slope)
    rows = fixed * (np.array(x) - given * target - on_reference * curve) + (1.0 - fixed) * np.array(lam)
    table = np.zeros((n + 1, 2 * n + 1))
    table[range(n), range(n)] = fixed
    table[range(n), range(n, 2 * n)] = 1.0 - fixed
    table[:n, -1] = -on_reference * slope
    table[n, :n], table[n, n : 2 * n] = -rates, f - on_reference * slope
    return [*rows.tolist(), value], table
