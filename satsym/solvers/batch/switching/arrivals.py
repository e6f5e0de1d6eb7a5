"""Minimum times of many linear motions under saturated controls, each with its extremal of exact arcs."""

from __future__ import annotations

import ast
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.batch import compiling
from satsym.solvers.batch.switching import arcs, planes, soonest
from satsym.solvers.collocation.scaling import final_argument

DRAWN = 3
"""Number of random points at which the coefficients of each motion are compared."""

EQUAL_COEFFICIENTS = 1e-12
"""Relative difference of coefficients below which they are equal up to rounding."""

FOLLOWED = 1e-7
"""Relative difference below which the reference, by finite differences, is an uncontrolled motion."""

STEP = 1e-5
"""Step of the finite differences, relative to the time."""


@dataclass(frozen=True, eq=False)
class Arrivals:
    """Minimum times and extremals of M instances."""

    instances: Sequence[Instance]
    solved: NDArray[np.bool_]
    """Whether an extremal was found, shape (M,); the other instances are left to other solvers."""
    durations: Array
    costs: Array
    """Durations and costs, shapes (M,)."""
    costates: Array
    ends: Array
    """Initial costates and final states, shapes (n, M)."""
    times: Array
    controls: NDArray[np.int64]
    """Switching times in increasing order, and indices of the switched controls, shape (S, M).

    Unused entries are the final time and -1.
    """

    def only(self, chosen: NDArray[np.intp]) -> Arrivals:
        """Return the results of the instances with the given indices."""
        arrays = {one.name: getattr(self, one.name) for one in fields(self) if one.name != "instances"}
        own = {name: table[..., chosen] for name, table in arrays.items()}
        return replace(self, instances=[self.instances[k] for k in chosen], **own)


def stated(instances: Sequence[Instance]) -> Array:
    """Return the final conditions, shape (3, M, n): whether given, whether on the reference, and given values."""
    known: dict[int, tuple[float, ...]] = {}  # most share their end
    rows = [known.get(id(one.final)) or known.setdefault(id(one.final), final_argument(one)) for one in instances]
    return np.array(rows).reshape(len(rows), 3, -1).swapaxes(0, 1)


def applies(instance: Instance) -> bool:
    """Return whether an instance is a minimum-time problem with a given final state and bounds on each control."""
    spec = instance.model.spec
    plain = spec.switching and spec.control_set == "box" and not (spec.throttled or spec.multipliers)
    plain = plain and spec.autonomous and not spec.has_terminal_cost and not spec.in_arcs
    bounded = np.isfinite(instance.lower).all() and np.isfinite(instance.upper).all()
    return bool(plain and bounded and instance.tf is None and len(instance.final) == len(instance.initial))


def first_arrivals(instances: Sequence[Instance], compiled: bool) -> Arrivals:
    """Return the minimum times of instances of one model, whose order places neighbours next to each other.

    Parameters
    ----------
    instances
        Instances of one model, to each of which :func:`applies`.
    compiled
        Whether to use compiled code.
    """
    count, n, m = len(instances), len(instances[0].initial), len(instances[0].lower)
    boxes = np.array([[one.lower, one.upper] for one in instances])
    rates, prices, linear = _coefficients(instances)
    x, end, linear = _ends(instances, rates, linear)
    apart, acting = np.abs(x - end), np.abs(rates[:, :, n : n + m]) @ np.abs(boxes).max(axis=1)[:, :, None]
    change = np.abs(rates[:, :, :n] @ x[:, :, None] + rates[:, :, n + m :])[:, :, 0] + acting[:, :, 0]
    with np.errstate(all="ignore"):
        scales = np.where(change > 0.0, apart / change, 0.0).max(axis=1)
        scales = np.where(scales > 0.0, scales, apart.any(axis=1))  # from rest to rest at first nothing changes
        sizes = np.maximum(np.abs(x), np.abs(end))
        guesses = (x - end) / np.where(sizes > 0.0, sizes, 1.0) ** 2
    chosen = np.flatnonzero(linear & (scales > 0.0) & np.isfinite(scales) & np.isfinite(rates).all(axis=(1, 2)))
    found = np.full((count, n), np.nan), np.full(count, -1), np.full(count, np.nan), *_no_switches(count)
    if len(chosen):
        given = (table[chosen] for table in (rates, x, end, boxes, scales, guesses))
        own = [np.ascontiguousarray(table[chosen]) for table in found]
        with np.errstate(all="ignore"):
            _many(compiled)(*map(np.ascontiguousarray, given), *own)
        for table, part in zip(found, own, strict=True):
            table[chosen] = part
    begins, counts, durations, times, controls = found
    starts = np.array([one.t0 for one in instances])
    return Arrivals(
        instances,
        counts >= 0,
        durations,
        prices * durations,
        (begins * prices[:, None]).T,
        _states_there(instances, end, starts + durations).T,
        *_in_order(counts, starts, durations, times, controls),
    )


def _no_switches(count: int) -> tuple[Array, NDArray[np.int64]]:
    """Return arrays for the switching times and the indices of the switched controls."""
    return np.zeros((count, soonest.SWITCHES)), np.zeros((count, soonest.SWITCHES), dtype=np.int64)


def _in_order(
    counts: NDArray[np.int64], starts: Array, durations: Array, times: Array, controls: NDArray[np.int64]
) -> tuple[Array, NDArray[np.int64]]:
    """Return switching times of all controls in increasing order, and the indices of the switched controls.

    The arguments contain these times counted backwards from the final time.
    """
    switches = max(int(counts.max()), 0)
    used = np.arange(switches) < counts[:, None]
    forward = np.where(used, durations[:, None] - times[:, :switches], np.inf)
    order = np.argsort(forward, axis=1, kind="stable")
    passed = starts[:, None] + np.minimum(np.take_along_axis(forward, order, axis=1), durations[:, None])
    return passed.T, np.take_along_axis(np.where(used, controls[:, :switches], -1), order, axis=1).T


def _states_there(instances: Sequence[Instance], end: Array, t: Array) -> Array:
    """Return the final states, shape (M, n)."""
    _, on_reference, _ = stated(instances)
    if not on_reference.any():
        return end
    p = tuple(np.array([one.parameters for one in instances]).reshape(len(end), -1).T)
    curve = np.broadcast_to(instances[0].model.reference_batch(t, p), end.T.shape).T
    return np.where(on_reference > 0.0, curve, end)


@lru_cache(maxsize=1)
def _machine() -> Callable[..., None]:
    """Return the compiled function for minimum times of many motions, the same for all models."""
    trees = [ast.parse(Path(str(one.__file__)).read_text(encoding="utf-8")).body for one in (planes, arcs, soonest)]
    ours = ("__future__", "satsym")
    body = [n for tree in trees for n in tree if not str(getattr(n, "module", "")).startswith(ours)]
    function: Callable[..., None] = compiling.compiled("least_times", ast.unparse(ast.Module(body, [])))["many"]
    none = (np.zeros(shape) for shape in ((0, 1, 3), (0, 1), (0, 1), (0, 2, 1), (0,), (0, 1), (0, 1)))
    times, controls = _no_switches(0)
    with compiling.alone("least_times"):
        function(*none, np.zeros(0, dtype=np.int64), np.zeros(0), times, controls)
    return function


def _many(compiled: bool) -> Callable[..., None]:
    return _machine() if compiled else soonest.many


def _coefficients(instances: Sequence[Instance]) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return A, B and d of each motion side by side, its cost per unit time, and whether it is linear."""
    first = instances[0]
    model, count, n, m = first.model, len(instances), len(first.initial), len(first.lower)
    rng, p = np.random.default_rng(0), tuple(np.array([one.parameters for one in instances]).reshape(count, -1).T)
    size = np.maximum(np.abs(np.array([one.initial for one in instances]).T), 1.0)
    at_x = [size * rng.normal(size=(n, count)) for _ in range(DRAWN)]
    low, high = (np.array([getattr(one, side) for one in instances]).T for side in ("lower", "upper"))
    at_u = [low + (high - low) * rng.random((m, count)) for _ in range(DRAWN)]
    t, none = np.full(count, first.t0), np.zeros((n, count))

    def drawn(function: Callable[..., Any], shape: tuple[int, ...], *more: Array) -> list[Array]:
        places = zip(at_x, at_u, strict=True)
        return [np.broadcast_to(function(t, x, u, *more, p), (*shape, count)).reshape(-1, count) for x, u in places]

    with np.errstate(all="ignore"):
        by_x, by_u = drawn(model.jacobian_x_batch, (n, n)), drawn(model.jacobian_u_batch, (n, m))
        cost = drawn(model.running_cost_batch, ())
        linear = _same(by_x) & _same(by_u) & _same(cost) & (cost[0][0] > 0.0)
        weight = np.broadcast_to(model.magnitude_weight_batch(t, at_x[0], none, p), (m, count))
        drift = np.broadcast_to(model.dynamics_batch(t, none, np.zeros((m, count)), p), (n, count))
    tables = by_x[0].T.reshape(count, n, n), by_u[0].T.reshape(count, n, m), drift.T[:, :, None]
    return np.concatenate(tables, axis=2), cost[0][0], linear & ~weight.any(axis=0) & (not model.spec.moving_magnitudes)


def _same(drawn: list[Array]) -> NDArray[np.bool_]:
    """Return whether values are the same at all random points, shape (M,)."""
    spread, size = np.ptp(drawn, axis=0).max(axis=0), np.abs(drawn).max(axis=(0, 1))
    return np.asarray(np.isfinite(size) & (spread <= EQUAL_COEFFICIENTS * size))


def _ends(
    instances: Sequence[Instance], rates: Array, linear: NDArray[np.bool_]
) -> tuple[Array, Array, NDArray[np.bool_]]:
    """Return initial and final states, shapes (M, n), and for which instances the motion remains linear.

    If the final state is on a reference that is itself an uncontrolled motion, the difference from the reference is
    used: its final state is zero, and its drift is removed from ``rates``.
    """
    n, first = len(instances[0].initial), instances[0]
    x = np.array([one.initial for one in instances])
    _, on_reference, target = stated(instances)
    if not on_reference.any():
        return x, target, linear
    p, t = tuple(np.array([one.parameters for one in instances]).reshape(len(x), -1).T), np.full(len(x), first.t0)
    followed = on_reference.all(axis=1)
    for later in (0.0, 1.0, 2.7):
        now, step = t + later, STEP * np.maximum(np.abs(t + later), 1.0)
        before, here, after = (
            np.broadcast_to(first.model.reference_batch(at, p), (n, len(x))).T for at in (now - step, now, now + step)
        )
        own = (rates[:, :, :n] @ here[:, :, None])[:, :, 0] + rates[:, :, -1]
        off = np.abs((after - before) / (2.0 * step)[:, None] - own).max(axis=1)
        followed &= off <= FOLLOWED * np.maximum(np.abs(own).max(axis=1), np.abs(here).max(axis=1))
        x = np.where((followed & (later == 0.0))[:, None], x - here, x)
    rates[followed, :, -1] = 0.0
    return x, np.where(followed[:, None], 0.0, target), linear & (followed | ~on_reference.any(axis=1))
