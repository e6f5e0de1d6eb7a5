"""Rotations under which the uncontrolled motion is invariant, found from its rates.

A linear map G generates such a rotation if G f(x) = f_x(x) G x for all states: then exp(phi G) maps motions to motions,
and the angular momentum about its axis is conserved. These equations are linear in G, so that a few random states
determine all solutions, in any Cartesian coordinates of the model. Maps that are symmetries except for a small
perturbation, such as the oblateness of a planet, still show how the motion revolves.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.control_set import Row
from satsym.instance import Instance
from satsym.kernels import Kernels

DRAWN = 12
"""Number of random states at which the equations are evaluated, for each state variable."""

NONE = 1e-9
"""Relative difference of derivatives that counts as rounding."""

PERTURBED = 1e-2
"""Relative residual of the symmetry equations that is attributed to a perturbation; that of oblateness is 4e-4 to
1.1e-3."""

ALIKE_AXES = 0.88
"""Cosine of half a radian: rotations with axes closer than this angle count as the same."""


def symmetric(instance: Instance) -> bool:
    """Return whether the uncontrolled motion is invariant under rotations that follow it.

    The rotation that follows the motion best at all given ends is tested, and those that do so at either end. In space
    the first has an axis between those of the angular momenta at start and end, in any coordinates. The final state
    counts as given if all states are that rotations change.
    """
    model, (end, given) = instance.model, _end(instance)
    ends = np.array([instance.initial, end]).T
    sizes = _sizes(model, ends)[:, None]
    rounded = np.ldexp(1.0, np.rint(np.log2(sizes[:, 0])).astype(int))
    about = _about(model, ends[:, 0], rounded)
    found = _generators(model, instance.t0, about, tuple(rounded.tolist()), instance.parameters)
    if found is None:
        return False
    vectors = _vectors(found / sizes * sizes.T)
    if not given[_moved(vectors)].all():
        ends = ends[:, :1]
    here, _ = _motion(model, instance.t0, instance.parameters, ends)
    known: list[Array] = []
    for at in ([*range(ends.shape[1])], [0], [ends.shape[1] - 1]):
        rates, by = here[:, at] / sizes, found @ ends[:, at] / sizes
        weights = np.linalg.lstsq(by.reshape(len(found), -1).T, rates.ravel(), rcond=1e-9)[0]
        matrix = np.tensordot(weights, found, 1)
        unit = matrix / sizes * sizes.T
        unit /= max(float(np.linalg.norm(unit)), 1e-300)
        if all(float((unit * other).sum()) < ALIKE_AXES for other in known):
            known.append(unit)
            # rounding that mixes what is not mixed leaves states that stand still without axes of their own
            if _comes_back(np.where(vectors, matrix, 0.0)):
                return True
    return False


def _comes_back(matrix: Array) -> bool:
    """Return whether a matrix generates a rotation, that is, a periodic motion."""
    angular, axes = np.linalg.eig(matrix)
    fastest = float(np.abs(angular).max())
    turning = fastest > 0.0 and not (np.abs(angular.real) > PERTURBED * fastest).any()
    return turning and not np.linalg.cond(axes) > 1e6


def _vectors(found: Array) -> NDArray[np.bool_]:
    """Return which states are mixed by maps (k, n, n) of scaled states, directly or through others, shape (n, n)."""
    mixed = np.abs(found).max(axis=0) > PERTURBED * np.abs(found).max()
    steps = (mixed | mixed.T | np.eye(len(mixed), dtype=bool)).astype(float)
    return np.asarray(np.linalg.matrix_power(steps, len(steps)) > 0.0)


def _moved(vectors: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Return which states are mixed with other states by the rotations, shape (n,)."""
    return np.asarray(vectors.sum(axis=1) > 1)


def _end(instance: Instance) -> tuple[Array, NDArray[np.bool_]]:
    """Return the final state, shape (n,), and which of it is given; for the others it is the initial state.

    On a moving reference no final state counts as given if the final time is free.
    """
    final, names, end = instance.final, instance.model.spec.state_names, np.array(instance.initial, dtype=float)
    on_curve = "reference" in final.values()
    if on_curve and instance.tf is None:
        return end, np.zeros(len(names), dtype=bool)
    curve = np.array(instance.model.reference(instance.tf or 0.0, instance.parameters)) if on_curve else end
    for i, name in enumerate(names):
        value = final.get(name, end[i])
        end[i] = curve[i] if value == "reference" else value
    return end, np.array([name in final for name in names])


def _sizes(model: Kernels, ends: Array) -> Array:
    """Return the magnitudes of the states at given ends (n, k), equal for states of one unit, as in a vector."""
    sizes = np.sqrt((_of_one_unit(model) @ (ends * ends)).max(axis=1))
    moving = sizes > 0.0  # what is zero at all ends is taken for as large as the rest
    return np.where(moving, sizes, sizes[moving].mean() if moving.any() else 1.0)


@lru_cache(maxsize=32)
def _of_one_unit(model: Kernels) -> Array:
    """Return which states have the same unit, shape (n, n), as ones and zeros."""
    units = np.array([state.unit for state in model.spec.states])
    return (units[:, None] == units).astype(float)


def _about(model: Kernels, start: Array, size: Array) -> Row:
    """Return a rounded point near a state, so that results are shared between similar states."""
    near = np.where(start > 0.0, np.ldexp(1.0, np.rint(np.log2(np.abs(start) + 1e-300)).astype(int)), start)
    positive = np.array([state.positive for state in model.spec.states])
    return tuple(np.where(positive, near, size / 4.0 * np.rint(4.0 * start / size)).tolist())


@lru_cache(maxsize=32)
def _generators(model: Kernels, t0: float, about: Row, sizes: Row, parameters: Row) -> Array | None:
    """Return all maps G of a nonlinear motion, (k, n, n), from states near a given one; ``None`` if none exist."""
    n, size = len(about), np.array(sizes)
    x = np.array(about)[:, None] + size[:, None] * np.random.default_rng(0).uniform(-0.5, 0.5, (n, DRAWN * n))
    rates, slopes = _motion(model, t0, parameters, x)
    if not np.isfinite(rates).all() or not np.isfinite(slopes).all():
        return None
    speed = np.sqrt(((np.abs(rates) + np.abs(slopes * x).sum(axis=1)) ** 2).mean(axis=1))
    speed[speed == 0.0] = speed.max() or 1.0
    if (np.ptp(slopes * size[:, None], axis=2) <= NONE * speed[:, None]).all():
        return None  # linear, or no motion at all
    # One row a component of G f - f_x G x, one column an entry of G; both as large as each other, whatever the units.
    eye = np.eye(n)
    rows = np.einsum("ia,bk->kiab", eye, rates) - np.einsum("iak,bk->kiab", slopes, x)
    rows = (rows / speed[:, None, None]).reshape(-1, n * n)
    entries = np.linalg.norm(rows, axis=0)
    entries[entries == 0.0] = 1.0
    # There are many more equations than entries: their triangular factor has the same null space.
    _, values, basis = np.linalg.svd(np.linalg.qr(rows / entries, mode="r"))
    found = (basis[values <= PERTURBED * values[0]] / entries).reshape(-1, n, n)
    return found if len(found) else None


def _motion(model: Kernels, t0: float, parameters: Row, x: Array) -> tuple[Array, Array]:
    """Return rates of the uncontrolled motion and their derivatives at states (n, M)."""
    none = np.zeros((len(model.spec.controls), x.shape[1]))
    t = np.full(x.shape[1], t0)
    with np.errstate(all="ignore"):
        rates = model.dynamics_batch(t, x, none, parameters)
        slopes = model.jacobian_x_batch(t, x, none, parameters)
    return rates, slopes
