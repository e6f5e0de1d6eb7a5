"""Polynomials of the states, up to the second degree, that the motion conserves for all controls.

They are found numerically: at random states, times and controls, the gradient of such a polynomial is orthogonal to the
rates of the states. If its value at the required final state differs from the initial one, the final state cannot be
reached.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations_with_replacement

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.status import LEAVE_FREE

DRAWN = 4
"""Number of random points, as a multiple of the number of monomials."""

SPREAD = 0.4
"""Range of random states about the initial state, relative to their magnitudes."""

CANCELS = 1e-11
"""Singular value, relative to the largest, below which a polynomial counts as conserved."""

EQUAL_QUANTITY = 1e-6
"""Largest relative difference between initial and final value of a conserved quantity that rounded input may cause."""

SEEN = 1e-8
"""Magnitude of a coefficient, relative to the largest, below which it counts as rounding."""


@dataclass(frozen=True)
class Conserved:
    """A polynomial of the states that is constant for all controls."""

    names: tuple[str, ...]
    """Monomials as formulas of state names."""
    powers: Array
    """Powers of the states in each monomial, shape (K, n)."""
    coefficients: Array

    @property
    def formula(self) -> str:
        """Return the polynomial as a formula."""
        text = ""
        for value, name in zip(self.coefficients.tolist(), self.names, strict=True):
            size = "" if abs(abs(value) - 1.0) < SEEN else f"{abs(value):.6g}*"
            text += (" - " if value < 0.0 else " + ") + size + name
        return text.removeprefix(" + ").strip()

    def terms(self, x: Array) -> Array:
        """Return the terms of the polynomial at given states."""
        return np.asarray(self.coefficients * np.prod(x**self.powers, axis=1))


def contradiction(instance: Instance) -> str:
    """Return why the required final state cannot follow from the initial one, by a conserved quantity; else empty."""
    names = instance.model.spec.state_names
    fixed = [i for i, name in enumerate(names) if isinstance(instance.final.get(name), float | int)]
    fixed = [i for i in fixed if names[i] not in instance.solver.free_angles]
    if instance.free or not fixed:
        return ""
    start, end = np.array(instance.initial), np.array(instance.initial)
    end[fixed] = [float(instance.final[names[i]]) for i in fixed]
    for one in sorted(conserved(instance, fixed, start, end), key=lambda one: len(one.names)):
        before, after = one.terms(start), one.terms(end)
        if abs(after.sum() - before.sum()) > EQUAL_QUANTITY * max(np.abs(before).sum(), np.abs(after).sum()):
            return (
                f"no control changes {one.formula}: its initial value is {before.sum():.8g}, but the final "
                f"states require {after.sum():.8g}; {LEAVE_FREE}"
            )
    return ""


def conserved(instance: Instance, states: list[int], start: Array, end: Array) -> list[Conserved]:
    """Return independent conserved polynomials of the given states.

    Parameters
    ----------
    states
        Indices of these states.
    start, end
        All initial and final states, which set the scales of the states.
    """
    n, rng = len(start), np.random.default_rng(0)
    kinds = [(i,) for i in states] + list(combinations_with_replacement(states, 2))
    powers = np.array([np.bincount(kind, minlength=n) for kind in kinds])
    size = np.maximum(np.abs(start), np.abs(end))
    size = np.where(size > 0.0, size, 1.0)
    x = start[:, None] + SPREAD * size[:, None] * rng.uniform(-1.0, 1.0, (n, DRAWN * len(kinds)))
    with np.errstate(all="ignore"):
        rates = _rates(instance, x, rng) / size[:, None]
    x = x / size[:, None]
    whole = np.isfinite(rates).all(axis=0)
    if whole.sum() < 2 * len(kinds):
        return []
    table = np.zeros((int(whole.sum()), len(kinds)))
    for column, power in enumerate(powers):
        for i in np.flatnonzero(power):
            less = power - (np.arange(n) == i)
            table[:, column] += power[i] * np.prod(x.T[whole] ** less, axis=1) * rates[i, whole]
    norms = np.linalg.norm(table, axis=0)
    table = table / np.where(norms > 0.0, norms, 1.0)
    _, values, rows = np.linalg.svd(table, full_matrices=False)
    kernel = rows[values <= CANCELS * values[0]]
    units = np.where(norms > 0.0, norms, 1.0) * np.prod(size**powers, axis=1)
    labels = [_label(instance.model.spec.state_names, power) for power in powers.tolist()]
    return [_tidied(labels, powers, row / units) for row in _reduced(kernel)]


def _rates(instance: Instance, x: Array, rng: np.random.Generator) -> Array:
    """Return rates of the given states, under random controls and at random times."""
    count = len(instance.model.spec.controls)
    low, high = instance.control_set.around(count)
    largest = np.maximum(np.abs(low), np.abs(high))
    largest = np.where(np.isfinite(largest) & (largest > 0.0), largest, 1.0)
    u = instance.control_set.project(largest * rng.normal(size=(count, x.shape[1])))
    last = instance.t0 + 1.0 if instance.tf is None else instance.tf
    t = rng.uniform(instance.t0, last, x.shape[1])
    return np.asarray(instance.model.dynamics_batch(t, x, u, instance.parameters))


def _reduced(rows: Array) -> Array:
    """Return a basis of the given rows' span in which each row has a monomial that the others lack."""
    found = rows.copy()
    for k in range(len(found)):
        place = int(np.abs(found[k]).argmax())
        found[k] /= found[k, place]
        for other in range(len(found)):
            if other != k:
                found[other] -= found[other, place] * found[k]
    return found


def _label(names: tuple[str, ...], powers: list[int]) -> str:
    return "*".join(
        name if power == 1 else f"{name}**{power}" for name, power in zip(names, powers, strict=True) if power
    )


def _tidied(labels: list[str], powers: Array, coefficients: Array) -> Conserved:
    """Return a conserved quantity without coefficients that are rounding, scaled to a first coefficient of 1."""
    seen = np.flatnonzero(np.abs(coefficients) > SEEN * np.abs(coefficients).max())
    return Conserved(tuple(labels[i] for i in seen), powers[seen], coefficients[seen] / coefficients[seen[0]])
