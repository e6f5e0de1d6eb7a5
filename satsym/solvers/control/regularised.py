"""The smoothed companion of a switching problem: the same problem with a small quadratic cost of the control.

Its control law is continuous, so collocation solves it; as the smoothing goes to zero its solutions tend to those of
the problem itself. The weight of |u| is brought in from zero, for with it the law is flat where the costates vanish,
which is where every cold start begins (Bertrand and Epenoy, New smoothing techniques for solving bang-bang optimal
control problems, Optimal Control Applications and Methods 23, 2002).
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance

TINY = 1e-60
"""A costate that does nothing, and yet has a sign."""


@dataclass(frozen=True)
class Companion(Instance):
    """An instance with ``smoothing``/2 times the squared control added to its running cost.

    Attributes
    ----------
    smoothing
        In the unit of the running cost over that of the squared control.
    share
        Of the weight of |u| that counts, 0 to 1.
    """

    smoothing: float = 1.0
    share: float = 1.0

    @property
    def bounds(self) -> tuple[float, ...]:
        return (*self.lower, *self.upper, self.smoothing, self.share)


def sloping(instance: Instance, lam: Array) -> Array:
    """Costates without zeros, shape (n, N): where a switching function vanishes, a law with |u| shows no slope."""
    if not instance.model.spec.switching:
        return lam
    tiny = TINY * np.arange(1.0, len(lam) + 1.0)[:, None]
    return np.where(lam == 0.0, tiny, lam)


def companion(instance: Instance, smoothing: float, share: float) -> Companion:
    """The companion of an instance."""
    stated = {f.name: getattr(instance, f.name) for f in fields(Instance)}
    return Companion(**stated, smoothing=smoothing, share=share)


def smoothed_law(instance: Instance, bounds: tuple[float, ...], t: Array, x: Array, lam: Array) -> Array:
    """The control that minimises the companion's Hamiltonian, shape (m, N).

    Parameters
    ----------
    bounds
        Lower and upper bounds, the smoothing, and the share of the weight of |u| that counts.
    t, x, lam
        Times (N,), states and costates, (n, N).
    """
    model, p = instance.model, instance.parameters
    m = len(model.spec.controls)
    smoothing, share = bounds[2 * m :]
    sigma = np.asarray(model.switching_function_batch(t, x, lam, p))
    weight = share * np.asarray(model.magnitude_weight_batch(t, x, p))
    beyond = sigma - np.minimum(np.maximum(sigma, -weight), weight)
    low, high = np.array(bounds[:m])[:, None], np.array(bounds[m : 2 * m])[:, None]
    return np.asarray(np.minimum(np.maximum(-beyond / smoothing, low), high))


def smoothed_cost(instance: Instance, bounds: tuple[float, ...], t: Array, x: Array, u: Array) -> Array:
    """The companion's running cost, shape (N,)."""
    model, p = instance.model, instance.parameters
    smoothing, share = bounds[2 * len(u) :]
    weight = np.asarray(model.magnitude_weight_batch(t, x, p))
    exact = np.asarray(model.running_cost_batch(t, x, u, p))
    return np.asarray(exact + smoothing / 2.0 * (u * u).sum(axis=0) - (1.0 - share) * (weight * np.abs(u)).sum(axis=0))
