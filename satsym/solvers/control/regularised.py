"""The regularised problem of a switching problem, with a small quadratic cost of the control added.

Its control law is continuous, so that collocation solves it; as the smoothing parameter tends to zero, its solutions
tend to those of the original problem. The weight of |u| is increased from zero, since with it the law is constant where
the costates vanish, as at every cold start (Bertrand and Epenoy, New smoothing techniques for solving bang-bang optimal
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
"""Costate that is negligible but has a sign."""


@dataclass(frozen=True)
class Regularised(Instance):
    """An instance with ``smoothing``/2 times the squared control added to its running cost."""

    smoothing: float = 1.0
    """Smoothing parameter, in the unit of the running cost divided by that of the squared control."""
    fraction: float = 1.0
    """Fraction of the weight of |u| that is included, 0 to 1."""

    @cached_property
    def control_set(self) -> ControlSet:
        return super().control_set.regularised(self.smoothing, self.fraction)


def sloping(instance: Instance, lam: Array) -> Array:
    """Return costates with zeros replaced, shape (n, N), since a law with |u| has no slope where they vanish."""
    if not instance.model.spec.regularising or lam.all():
        return lam
    tiny = TINY_COSTATE * np.arange(1.0, len(lam) + 1.0)[:, None]
    return np.where(lam == 0.0, tiny, lam)


def regularised(instance: Instance, smoothing: float, fraction: float) -> Regularised:
    """Return the regularised problem of an instance."""
    stated = {f.name: getattr(instance, f.name) for f in fields(Instance)}
    return Regularised(**stated, smoothing=smoothing, fraction=fraction)


def smoothed_law(instance: Instance, control_set: ControlSet, t: Array, x: Array, lam: Array) -> Array:
    """Return the control that minimises the Hamiltonian of the regularised problem, shape (m, N).

    Parameters
    ----------
    instance
        Instance of a switching problem.
    control_set
        Bounds, smoothing parameter, and included fraction of the weight of |u|.
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
    """Return the running cost of the regularised problem, shape (N,)."""
    model, p, smoothing, fraction = instance.model, instance.parameters, control_set.smoothing, control_set.fraction
    weight = model.magnitude_weight_batch(t, x, np.zeros_like(x), p)
    exact = model.running_cost_batch(t, x, u, p)
    return np.asarray(
        exact + smoothing / 2.0 * (u * u).sum(axis=0) - (1.0 - fraction) * (weight * np.abs(u)).sum(axis=0)
    )
