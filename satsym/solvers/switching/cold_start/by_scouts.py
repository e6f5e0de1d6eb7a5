"""Extremals from motions that arrive: many switching times are drawn, and what arrives cheaply is made exact."""

from __future__ import annotations

from functools import partial

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, attempt, given
from satsym.solvers.switching.cold_start.minimum_effort import first_duration
from satsym.solvers.switching.cold_start.plans import Plans, Scout, seeded
from satsym.solvers.switching.cold_start.scouts import ROUNDS, Target, scouted
from satsym.solvers.switching.newton import Equations
from satsym.solvers.switching.structure import SINGULAR, Guess, Structure

SEED = 7
"""Of what is drawn; certificates draw otherwise."""

PLANS = 32
"""At once."""

PATIENT = 50
"""Corrections of their arcs, where no extremal is known."""

AROUND, FAR = (0.1, 1.3), (0.2, 10.0)
"""Shares of a known duration, and of one that is only a scale, between which others are drawn."""

MORE, MOST = 2, 4
"""Switches that a structure may have more than the one that is known, and more than states, if none is."""

TRIED = 4
"""Of what arrives, the cheapest first."""

SHAKEN = 0.3
"""Relative change of the lengths of a known extremal's arcs."""

APART = 1e-5
"""Relative difference of costs of two that are not the same."""

BRIEF = 1e-6
"""Share of the duration below which an arc is none."""


def cheaper(instance: Instance, known: Exact | None, limits: Limits) -> Exact | None:
    """The cheapest extremal that is found so; ``None`` where none is cheaper than what is known.

    Parameters
    ----------
    known
        An extremal, if there is one: its durations and its number of switches say what to look at.
    """
    if instance.model.spec.multipliers:
        return None
    rows = None if known is None else [len(row) - 1 for row in known.refined.structure.levels]
    rng = np.random.default_rng(SEED)
    if known is not None and not any(SINGULAR in row for row in known.refined.structure.levels):
        beside = _beside(known, rng)
        found = _cheapest(instance, known, beside, instance.t0 + beside.lengths.sum(axis=0), limits)
        if found is not None:
            return found
    for more in (MORE,) if rows is not None else range(0, MOST + 1, MORE):
        base = rows or [len(instance.initial)] * len(instance.lower)
        found = _drawn(instance, known, [count + more for count in base], rng, limits)
        if found is not None:
            return found
    return None


def _drawn(
    instance: Instance, known: Exact | None, switches: list[int], rng: np.random.Generator, limits: Limits
) -> Exact | None:
    """The cheapest of what one set of plans leads to."""
    if instance.tf is not None:
        ends = np.full(PLANS, instance.tf)
    else:
        scale = first_duration(instance) if known is None else known.refined.at.end - instance.t0
        low, high = np.log(FAR if known is None else AROUND)
        ends = instance.t0 + scale * np.exp(rng.uniform(low, high, PLANS))
    return _cheapest(instance, known, seeded(instance, switches, ends - instance.t0, rng), ends, limits)


def _beside(known: Exact, rng: np.random.Generator) -> Plans:
    """The arcs of an extremal with other lengths: it may be a saddle, from which motions that arrive go downhill."""
    arcs = known.refined.arcs
    levels = np.array([arc.field.levels for arc in arcs])
    lengths = np.array([arc.end - arc.start for arc in arcs])
    changed = lengths[:, None] * np.exp(rng.normal(0.0, SHAKEN, (len(arcs), PLANS)))
    return Plans(np.repeat(levels[:, :, None], PLANS, axis=2), changed * (lengths.sum() / changed.sum(axis=0)))


def _cheapest(instance: Instance, known: Exact | None, plans: Plans, ends: Array, limits: Limits) -> Exact | None:
    """The cheapest extremal to which plans lead that end at these times, where these are given."""
    cost = float("inf") if known is None else known.trajectory.cost(instance)
    sizes = given(instance)
    if known is not None and not sizes.any():
        sizes = known.refined.sizes[: len(sizes)]
    sizes = np.where(sizes > 0.0, sizes, max(float(sizes.max()), 1e-300))
    target = Target(instance, sizes, ends if instance.tf is not None else np.full(PLANS, np.nan))
    seen: list[float] = []
    for scout in scouted(target, plans, limits, ROUNDS if known else PATIENT):
        if scout.cost >= cost - APART * abs(cost) or len(seen) == TRIED:
            break
        if seen and abs(scout.cost - seen[-1]) <= APART * abs(seen[-1]):
            continue
        seen.append(scout.cost)
        first = tried(partial(_guess, instance, scout, sizes))
        exact = None if first is None else attempt(instance, first, limits)
        if exact is not None and exact.trajectory.cost(instance) < cost - APART * abs(cost):
            return exact
    return None


def _guess(instance: Instance, scout: Scout, sizes: Array) -> Guess:
    """The structure of a motion, and the costates that come nearest to making it an extremal."""
    kept = scout.lengths > BRIEF * scout.lengths.sum()
    levels, edges = scout.levels[kept], instance.t0 + np.cumsum(scout.lengths[kept])
    rows, times = [], []
    for own in levels.T:
        change = np.flatnonzero(np.diff(own))
        rows.append((int(own[0]), *own[change + 1].tolist()))
        times.append(edges[change])
    structure, n = Structure(tuple(rows)), len(instance.initial)
    end = float(edges[-1]) if instance.tf is None else instance.tf
    equations = Equations(instance, structure, np.concatenate([sizes, np.ones(n)]), end - instance.t0)
    at = equations.start(np.zeros(n), np.concatenate(times), end)
    residual, slopes = equations.residual(at, equations.arcs(at))
    costates = np.linalg.lstsq(slopes[:, :n], -residual, rcond=None)[0] * equations.scale[:n]
    return Guess(structure, at.times, costates, end)
