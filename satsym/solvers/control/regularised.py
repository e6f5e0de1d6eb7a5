"""The regularised problem of a switching problem: the same with a small quadratic cost of the control.

Its control law is continuous, so collocation solves it; as the smoothing goes to zero its solutions tend to those of
the problem itself. The weight of |u| is brought in from zero, for with it the law is flat where the costates vanish,
which is where every cold start begins (Bertrand and Epenoy, New smoothing techniques for solving bang-bang optimal
control problems, Optimal Control Applications and Methods 23, 2002).
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.instance import Instance

TINY_COSTATE = 1e-60
"""A costate that does nothing, and yet has a sign."""


@dataclass(frozen=True)
class Regularised(Instance):
    """An instance with ``smoothing``/2 times the squared control added to its running cost."""

    smoothing: float = 1.0
    """In the unit of the running cost over that of the squared control."""
    fraction: float = 1.0
    """Share of the weight of |u| that counts, 0 to 1."""

    @cached_property
    def control_set(self) -> ControlSet:
        return super().control_set.regularised(self.smoothing, self.fraction)


def sloping(instance: Instance, lam: Array) -> Array:
    """Costates without zeros, shape (n, N): where a switching function vanishes, a law with |u| shows no slope."""
    if not instance.model.spec.regularising or lam.all():
        return lam
    tiny = TINY_COSTATE * np.arange(1.0, len(lam) + 1.0)[:, None]
    return np.where(lam == 0.0, tiny, lam)


def regularised(instance: Instance, smoothing: float, fraction: float) -> Regularised:
    """The regularised problem of an instance."""
    stated = {f.name: getattr(instance, f.name) for f in fields(Instance)}
    return Regularised(**stated, smoothing=smoothing, fraction=fraction)


def smoothed_law(instance: Instance, control_set: ControlSet, t: Array, x: Array, lam: Array) -> Array:
    """The control that minimises the regularised problem's Hamiltonian, shape (m, N).

    Parameters
    ----------
    instance
        Of a switching problem.
    control_set
        Bounds, the smoothing, and the share of the weight of |u| that counts.
    t, x, lam
        Times (N,), states and costates, (n, N).
    """
    model, p = instance.model, instance.parameters
    sigma = model.switching_function_batch(t, x, lam, p)
    weight = control_set.fraction * model.magnitude_weight_batch(t, x, lam, p)
    if not model.spec.moving_magnitudes:
        beyond = sigma - np.minimum(np.maximum(sigma, -weight), weight)
        return control_set.project(-beyond / control_set.smoothing)
    smoothing, (low, high) = control_set.smoothing, control_set.box
    rest = np.clip(0.0, low, high)
    above, below = np.clip(-(sigma + weight) / smoothing, rest, high), np.clip(-(sigma - weight) / smoothing, low, rest)
    worse, better = (smoothing / 2.0 * u * u + sigma * u + weight * np.abs(u) for u in (above, below))
    return np.where(worse <= better, above, below)


def smoothed_cost(instance: Instance, control_set: ControlSet, t: Array, x: Array, u: Array) -> Array:
    """The regularised problem's running cost, shape (N,)."""
    model, p, smoothing, fraction = instance.model, instance.parameters, control_set.smoothing, control_set.fraction
    weight = model.magnitude_weight_batch(t, x, np.zeros_like(x), p)
    exact = model.running_cost_batch(t, x, u, p)
    return np.asarray(
        exact + smoothing / 2.0 * (u * u).sum(axis=0) - (1.0 - fraction) * (weight * np.abs(u)).sum(axis=0)
    )
