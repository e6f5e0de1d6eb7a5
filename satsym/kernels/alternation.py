"""Relations of problems whose controls switch: see :mod:`satsym.kernels.relations` and the smoothed companion there.

The companion's Hamiltonian is H + smoothing/2 u^2 with a share of the weights of |u|.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from satsym.arrays import Array
from satsym.control_set import ControlSet
from satsym.kernels.evaluation import FAINT, Evaluation
from satsym.kernels.relations import Relation


def of_switching(of: Evaluation) -> Iterator[Relation]:
    """Switching functions and weights, their rates, and the exact law."""
    u = of.at["u"]
    sigma, weight = of("switching_function"), _weights(of)
    alone = u[:, None, :] * np.eye(len(u))[:, :, None]
    idle = of("hamiltonian", u=np.zeros_like(u))
    gained = np.array([of("hamiltonian", u=each) - idle for each in alone.swapaxes(0, 1)])
    terms = FAINT * np.abs(idle)
    yield Relation(
        "switching_function", "contribution of each control to H", sigma * u + weight * np.abs(u), gained, terms
    )
    together, claim = of("hamiltonian") - idle, "sum of the contributions of the controls"
    yield Relation("hamiltonian", claim, together, gained.sum(axis=0), terms)
    rates = {"x": of("dynamics"), "lam": of("costate_rate")}
    parts = [of.slope("switching_function", a) * rate for a, rate in rates.items()]
    by_time = of.slope("switching_function", "t")[:, 0]
    total = by_time + sum(part.sum(axis=-2) for part in parts)
    terms = np.abs(by_time) + sum(np.abs(part).sum(axis=-2) for part in parts)
    yield Relation("switching_rate", "rate of change along an extremal", of("switching_rate"), total, terms)
    yield Relation("control_law", "H is minimal there", of("control_law"), _law(of, sigma, weight))
    none = np.zeros_like(of.at["lam"])
    indifferent = of("switching_function", lam=none)
    yield Relation("control_law", "of minimum magnitude", of("control_law", lam=none), _law(of, indifferent, weight))
    for row, name in enumerate(("dynamics", "costate_rate")):
        n = len(of.at["x"])
        block = of("extremal_jacobian")[row * n : (row + 1) * n]
        slopes = np.concatenate([_slope(of, name, a) for a in ("x", "lam")], axis=-2)
        faint = np.concatenate([of.faint(name, a) for a in ("x", "lam")], axis=-2)
        yield Relation("extremal_jacobian", f"derivative of {name}", block, slopes, faint)


def _slope(of: Evaluation, name: str, by: str) -> Array:
    """A derivative, zero where the function does not have the argument."""
    if by in of.signatures[name].arguments:
        return of.slope(name, by)
    value = of(name)
    return np.zeros((len(value), *of.at[by].shape))


def _limits(of: Evaluation) -> tuple[Array, Array, Array, Array]:
    """Lower and upper bounds as tables, smoothing and share."""
    u = of.at["u"]
    bounds = [np.broadcast_to(value, u.shape[-1:]) for value in of.at["bounds"]]
    limits = ControlSet.from_arguments(of.kernels.spec, bounds)
    return np.array(limits.lower), np.array(limits.upper), np.asarray(limits.smoothing), np.asarray(limits.share)


def _law(of: Evaluation, sigma: Array, weight: Array) -> Array:
    """The least of sigma u + weight |u| in the box; where all of an interval is, of minimum magnitude or its middle."""
    low, high, *_ = _limits(of)
    rest = np.where(weight > 0.0, np.minimum(np.maximum(0.0, low), high), 0.5 * (low + high))
    return np.asarray(np.where(sigma > weight, low, np.where(sigma < -weight, high, rest)))


def companion_law(of: Evaluation) -> tuple[Array, Array]:
    """Controls of the companion, and what its costates change by besides."""
    low, high, smoothing, share = _limits(of)
    sigma, width = of("switching_function"), share * _weights(of)
    shrunk = np.maximum(sigma - width, 0.0) + np.minimum(sigma + width, 0.0)
    control = np.minimum(np.maximum(-shrunk / smoothing, low), high)
    by_state = _slope(of, "magnitude_weight", "x")
    return control, (1.0 - share) * np.einsum("mnk,mk->nk", by_state, np.abs(control))


def extra_cost(of: Evaluation, control: Array) -> Array:
    """What the companion's Hamiltonian has besides."""
    *_, smoothing, share = _limits(of)
    return np.asarray((0.5 * smoothing * control**2 - (1.0 - share) * _weights(of) * np.abs(control)).sum(axis=0))


def _weights(of: Evaluation) -> Array:
    return np.broadcast_to(of("magnitude_weight"), of.at["u"].shape)
