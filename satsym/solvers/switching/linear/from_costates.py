"""Structures from costates at the end of a linear motion, as a set of ends that are reached shows them.

A control whose switching function never leaves the value at which it switches is undecided: others do as well. It is
given the arcs that bring the motion to its end with the least effort, weighed so that few do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.cold_start.recognition import Sample, guess
from satsym.solvers.switching.linear.reach import Reach, cheapest
from satsym.solvers.switching.structure import Guess

UNDECIDED = 2e-3
"""Share of its size by which a switching function that decides on nothing is off its value."""

RANK = 1e-7
"""Relative size of what undecided controls move at all."""


def guessed(instance: Instance, reach: Reach, costate: Array) -> Guess:
    """The structure that minimises H with costates at the end, shape (n,)."""
    open_ = undecided(reach, costate)
    if open_.any():
        costate = _exactly(reach, costate, open_)
    sigma, weight = reach.switching(costate)
    if open_.any():
        sigma, weight = _with_least_effort(reach, sigma, weight, open_)
    times = np.linspace(instance.t0, instance.t0 + reach.duration, reach.count + 1)
    z = np.repeat(np.concatenate([instance.initial, reach.powers[-1].T @ costate])[:, None], len(times), axis=1)
    return guess(instance, Sample(times, z, np.zeros_like(sigma), sigma, weight))


def undecided(reach: Reach, costate: Array) -> NDArray[np.bool_]:
    """Controls whose switching functions are all along where they switch, shape (m,)."""
    sigma, weight = reach.switching(costate)
    room = np.array(reach.instance.upper) - np.array(reach.instance.lower)
    acting = (np.abs(sigma) + weight).max(axis=1) * room
    off = np.abs(np.abs(sigma) - weight).max(axis=1) * room
    size = np.where(weight[:, 0] > 0.0, acting, acting.max(initial=0.0))
    return np.asarray((off <= UNDECIDED * size) & (room > 0.0))


def _exactly(reach: Reach, costate: Array, open_: NDArray[np.bool_]) -> Array:
    """Costates next to those given with which undecided controls are so exactly."""
    sigma, weight = reach.switching(costate)
    by_costate = (reach.powers[::-1] @ reach.motion.controls)[:, reach.rows][:, :, open_].transpose(2, 0, 1)
    missing = (np.sign(sigma) * weight - sigma)[open_].ravel()
    found = costate.copy()
    found[reach.rows] += np.linalg.lstsq(by_costate.reshape(len(missing), -1), missing, rcond=RANK)[0]
    return found


def _with_least_effort(reach: Reach, sigma: Array, weight: Array, open_: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Switching functions and weights of |u|, so changed that undecided controls take the values of least effort."""
    m, count = len(sigma), reach.count
    levels = reach.levels.reshape(3, m, count)
    middle = (sigma[:, 1:] + sigma[:, :-1]) / 2.0
    values = np.array([middle * u + weight[:, :1] * np.abs(u) for u in levels])
    decided = np.where(open_[:, None], 0.0, np.take_along_axis(levels, values.argmin(axis=0)[None], 0)[0])
    towards, effects, base = reach.round
    base = base + effects @ decided.ravel()
    own = effects.reshape(-1, m, count)[:, open_].reshape(len(base), -1)
    axes, sizes, _ = np.linalg.svd(own, full_matrices=False)
    axes = axes[:, sizes > RANK * sizes[0]]
    side = np.where(weight[:, 0] > 0.0, np.sign(middle[:, 0]), 0.0)  # |u| may not cost more on the other side
    choices = levels.copy()
    choices[0, side < 0.0], choices[2, side > 0.0] = levels[1, side < 0.0], levels[1, side > 0.0]
    offered = choices[:, open_].reshape(3, -1)
    effort = np.exp(np.linspace(0.0, 1.0, 2 * count + 1))
    prices = np.tile(effort[1::2], int(open_.sum())) * np.abs(offered) * (reach.duration / count)
    found = cheapest(axes.T @ own, axes.T @ base, offered, prices)
    if found is None:
        return sigma, weight
    pushing, side = reach.pushing(reach.in_full(towards.T @ (axes @ found[1]))), side[:, None]
    pushing = np.where(side < 0.0, np.minimum(pushing, 0.0), np.where(side > 0.0, np.maximum(pushing, 0.0), pushing))
    return np.where(open_[:, None], pushing, sigma), np.where(open_[:, None], effort[::2], weight)
