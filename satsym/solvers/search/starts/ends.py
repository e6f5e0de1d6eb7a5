"""Random values of free initial and final states for starts of nonlinear programmes."""

from __future__ import annotations

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import wanted

BASE = 3
"""Base of the sequence that spreads deviations between their smallest and largest values; starts alternate in pairs, so
that it must be odd."""


def random(instance: Instance) -> bool:
    """Return whether initial states are free or final states partly free or in ranges; random ones are tried then."""
    end = wanted(instance, instance.t0)
    begins = any(one.place is Place.INITIAL for one in instance.free)
    return begins or bool(instance.ranges) or bool(np.isnan(end).any() and not np.isnan(end).all())


def drawn(programme: Programme, seed: int, start: Array, end: Array) -> tuple[Array, Array]:
    """Return initial and final states in which those that are free have random values."""
    start, end, rng = start.copy(), end.copy(), np.random.default_rng(seed)
    instance, deviations = programme.instance, spread(programme, seed)
    for one in instance.free:
        if one.place is Place.INITIAL:
            value = deviations[one.index] * rng.normal()
            start[one.index] = abs(value) if one.positive else value
    if np.isnan(end).any() and not np.isnan(end).all():
        values = deviations * rng.normal(size=len(end))
        positive = np.array([state.positive for state in instance.model.spec.states])
        end = np.where(np.isnan(end), np.where(positive, np.abs(values), values), end)
    for name, (low, high) in instance.ranges.items():
        if np.isfinite(low) and np.isfinite(high):
            end[instance.model.spec.state_names.index(name)] = rng.uniform(low, high)
    return start, end


def spread(programme: Programme, seed: int) -> Array:
    """Return standard deviations (n,) of random states, which differ from start to start.

    They lie between the scales of the states and the ranges of the uncontrolled motions from both ends, because neither
    shows by itself how far cheap motions lead: a pendulum may start near its rest and turn over.
    """
    sizes = programme.sizes.states
    wide = np.maximum(programme.ranges / sizes, 1.0)
    return np.asarray(sizes * wide ** _share(seed))


def _share(number: int) -> float:
    """Return the entry of van der Corput's sequence with that number, which lies between 0 and 1."""
    value, share = 0.0, 1.0 / BASE
    while number:
        number, digit = divmod(number, BASE)
        value, share = value + digit * share, share / BASE
    return value
