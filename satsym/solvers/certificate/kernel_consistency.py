"""Check that the kernels agree with each other near a solution; otherwise the certificate would prove nothing.

Kernels are the generated functions of a model. They are evaluated close to nodes of the solution, but not at them, so
that no number is zero by chance: once with the instance's own bounds and twice with bounds near the control, once of
these with reversed costates, so that every bound is reached. The regularised problem of a switching problem is used
with smoothing.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels import consistency
from satsym.solution import Certificate, Check, Solution
from satsym.solvers.control.slopes import slope
from satsym.status import Verdict

NODES = 4
"""Number of nodes near which kernels are evaluated; each is used three times, with different bounds."""

ASIDE_OF_NODES = 1e-3
"""Distance of the evaluated points from the nodes, relative to the largest value of each component."""

FAINT_COMPONENT = 1e-20
"""Magnitude of a component, relative to the largest one, below which it counts as rounding."""

WIDE, NARROW = 1e3, 0.5
"""Bounds, relative to the largest control, in place of absent ones; and narrow bounds."""


def with_kernels_examined(certificate: Certificate, solution: Solution) -> Certificate:
    """Return a certificate with an additional check that fails if the kernels contradict each other."""
    worst = consistency.worst(solution.instance.model, _places(solution))
    deviation = float("inf") if worst is None else worst.deviation
    check = Check("kernels contradict each other", deviation, consistency.LIMIT)
    verdict = certificate.verdict if check.passed else Verdict.FAILED
    return replace(certificate, verdict=verdict, checks=(*certificate.checks, check))


def _places(solution: Solution) -> dict[str, Any]:
    """Return arguments of all kernels near nodes of a solution."""
    instance, spec = solution.instance, solution.instance.model.spec
    rng = np.random.default_rng(consistency.SEED)
    chosen = np.tile(np.linspace(0, len(solution.times) - 1, NODES).astype(int), 3)
    columns = len(chosen)

    def aside(values: Array, unit: Array) -> Array:
        unit = np.where(unit > FAINT_COMPONENT * unit.max(initial=0.0), unit, 0.0)
        return values + ASIDE_OF_NODES * np.where(unit > 0.0, unit, 1.0) * rng.uniform(0.5, 1.0, (len(unit), columns))

    def near(table: Array, unit: Array | None = None) -> Array:
        return aside(table[:, chosen], np.abs(table).max(axis=-1, keepdims=True) if unit is None else unit)

    x, u, lam = near(solution.x), near(solution.u, _control_sizes(solution)), near(solution.lam)
    lam[:, 2 * NODES :] *= -1.0
    t = near(solution.times[None, :])[0]
    given = np.array(instance.parameters).reshape(-1, 1)
    p = tuple(aside(given, np.abs(given)))
    final = (*rng.uniform(0.2, 0.6, (2 * len(x), columns)), *x * rng.uniform(0.5, 1.5, x.shape))
    found = {"t": t, "x": x, "u": u, "lam": lam, "p": p, "final": final}
    found["nu"] = tuple(rng.uniform(0.5, 1.5, (len(spec.multipliers), columns)))
    return found | {"bounds": _bounds(instance, found)}


def _control_sizes(solution: Solution) -> Array:
    """Return the largest magnitude of each control, shape (m, 1); for a vector that of its largest component.

    If a component is negligible beside the others, second derivatives of a norm lose most of their digits.
    """
    size, instance = np.abs(solution.u).max(axis=-1, keepdims=True), solution.instance
    for places, part in instance.control_set.parts if instance.model.spec.control_parts else ():
        if part.kind in ("ball", "annulus"):
            size[list(places)] = size[list(places)].max()
    return size


def _bounds(instance: Instance, at: dict[str, Any]) -> tuple[Array, ...]:
    """Return the instance's own bounds for the first nodes and narrow bounds for the others."""
    model, u = instance.model, at["u"]
    kind = model.spec.control_set
    if model.spec.control_parts:
        return _bounds_of_sets(instance, at)
    if kind not in ("box", "ball"):
        return ()
    size = np.maximum(np.abs(u).max(axis=-1, keepdims=True), 1e-300)
    owned = np.arange(u.shape[-1]) < NODES
    if kind == "ball":
        radius = float(np.linalg.norm(size))
        return (np.where(owned, min(instance.max_norm, WIDE * radius), NARROW * radius),)
    low, high = instance.control_set.box
    low, high = np.maximum(low, -WIDE * size), np.minimum(high, WIDE * size)
    box = (*np.where(owned, low, -NARROW * size), *np.where(owned, high, NARROW * size))
    if not model.spec.switching:
        around = consistency.about_the_law(model, at | {"bounds": box})
        return tuple(np.where(owned, own, narrow) for own, narrow in zip(box, around, strict=True))
    sigma = np.abs(model.switching_function_batch(at["t"], at["x"], at["lam"], at["p"]))
    smoothing = float(np.maximum(sigma / size, 1e-300).max())
    return (*box, np.full(u.shape[-1], smoothing), np.full(u.shape[-1], NARROW))


def _bounds_of_sets(instance: Instance, at: dict[str, Any]) -> tuple[Array, ...]:
    """Return bounds for a product of control sets; the regularisation has the magnitude of the slopes of H."""
    u, spec, found = at["u"], instance.model.spec, list[Array]()
    owned = np.arange(u.shape[-1]) < NODES
    for places, part in instance.control_set.parts:
        size = np.maximum(np.abs(u[list(places)]).max(axis=-1, keepdims=True), 1e-300)
        radius = float(np.linalg.norm(size))
        if part.kind == "box":
            low, high = part.box
            least = -NARROW if part.turned_by is None else 0.0
            found += [*np.where(owned, np.maximum(low, -WIDE * size), least * size)]
            found += [*np.where(owned, np.minimum(high, WIDE * size), NARROW * size)]
        elif part.kind == "annulus":
            found.append(np.where(owned, part.inner, NARROW**2 * radius))
        if part.kind == "angle":
            found.append(np.where(owned, 1.0, NARROW))
        elif part.kind in ("ball", "annulus"):
            found.append(np.where(owned, min(part.radius, WIDE * radius), NARROW * radius))
    if spec.directional:
        met = [
            np.median(np.linalg.norm(slope(instance, places, at["t"], at["x"], at["lam"]), axis=0)) / part.reach
            for places, part in instance.control_set.parts
            if part.directed
        ]
        found.append(np.full(u.shape[-1], max(float(np.mean(met)), 1e-300)))
    if spec.throttled:
        found.append(np.full(u.shape[-1], NARROW))
        balls = sum(part.throttled and part.kind == "ball" for _, part in instance.control_set.parts)
        found += [np.zeros(u.shape[-1])] * balls
    return tuple(found)
