"""Starts that obey the equations of motion: motions under random controls that come close to the final conditions.

Where there are no final conditions, they are the cheapest of the random motions.

Straight lines and waves tell nothing about the dynamics. Where small controls decide where a motion ends, as in a
passage of a moon, no wave leads to the cheapest motion, but some of many random motions come close to it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.sizes import wanted
from satsym.solvers.search.starts import ends
from satsym.solvers.simulation.together import costs_together, steps_together

GROUPS, STEPS = ((3, 1000), (8, 4000), (12, 4000)), 128
"""Numbers of starts in each group, and of the random motions that they are chosen from: a further group is drawn if the
search goes on so far, because the starts before led to several costs. Number of Runge-Kutta steps of each motion."""

WEAKEST, STRONGEST, WAVES = 1e-3, 3.0, 4
"""Smallest and largest amplitude of random controls, relative to half their ranges or to their scales; number of
harmonic waves that they are made of."""

SHORTEST_SAMPLE, LONGEST_SAMPLE = 0.4, 4.0
"""Shortest and longest duration of a random motion, relative to the initial guess, if the duration is free."""

SMALLEST_DISTANCE, COMPARED = 0.15, 8
"""Distance of two motions, relative to the ranges of the states in most of them, from which they are different starts.
It is taken at every step that is a multiple of ``COMPARED``."""


@dataclass(frozen=True, eq=False)
class Sample:
    """A random motion.

    Attributes
    ----------
    times, x, v
        Times (N,), states (n, N) and control variables (k, N).
    """

    times: Array
    x: Array
    v: Array


def sampled(programme: Programme, group: int) -> list[Sample]:
    """Return random motions of a group that differ and come close to the final conditions, the closest first.

    Without final conditions, they are the cheapest ones.
    """
    instance, controls, sizes = programme.instance, programme.controls, programme.sizes
    most, count = GROUPS[group]
    rng = np.random.default_rng(group)
    begun = np.repeat(np.array(instance.initial, float)[:, None], count, 1)
    if instance.free:
        end = wanted(instance, instance.t0 + sizes.duration)
        begun = np.array([ends.drawn(programme, seed, begun[:, 0], end)[0] for seed in range(1, count + 1)]).T
    lasting = np.full(count, sizes.duration)
    if instance.tf is None:
        lasting *= np.exp(rng.uniform(np.log(SHORTEST_SAMPLE), np.log(LONGEST_SAMPLE), count))
    times = instance.t0 + lasting * np.linspace(0.0, 1.0, STEPS + 1)[:, None]
    u = _controls(programme, rng, count)
    halves = np.empty((2 * STEPS + 1, *u.shape[1:]))
    halves[::2], halves[1::2] = u, 0.5 * (u[:-1] + u[1:])
    with np.errstate(all="ignore"):
        x = np.array([begun, *(step.end for step in steps_together(instance, begun, halves, lasting))])
        if instance.final or instance.model.spec.multipliers:
            missed = _missed(programme, times[-1], x[-1])
        else:
            missed = costs_together(instance, halves.transpose(1, 0, 2), lasting, begun)
    order = [m for m in np.argsort(missed) if np.isfinite(missed[m])]
    chosen = _different(x[::COMPARED].transpose(2, 0, 1), order, most)
    return [Sample(times[:, m], x[:, :, m].T, controls.variables(u[:, :, m].T)) for m in chosen]


def _controls(programme: Programme, rng: np.random.Generator, count: int) -> Array:
    """Return random controls within their set, shape (STEPS + 1, m, count)."""
    controls, m = programme.controls, programme.controls.given
    share = np.linspace(0.0, 1.0, STEPS + 1)
    waves = np.array([np.cos(np.pi * k * share) / max(k, 1) for k in range(WAVES)])
    amplitudes = np.exp(rng.uniform(np.log(WEAKEST), np.log(STRONGEST), count))
    low, high = controls.lower[:m], controls.upper[:m]
    bounded = np.isfinite(low) & np.isfinite(high)
    middle, scale = np.zeros(m), programme.sizes.variables[:m].copy()
    low, high = low[bounded], high[bounded]
    middle[bounded], scale[bounded] = 0.5 * (low + high), 0.5 * (high - low)
    waved = (rng.normal(size=(m, count, WAVES)) @ waves).transpose(2, 0, 1)
    u = middle[:, None] + scale[:, None] * amplitudes * waved
    for place in controls.angles:
        u[:, place] += rng.uniform(-np.pi, np.pi, count)
    within = programme.instance.control_set.project(u.transpose(1, 0, 2).reshape(m, -1))
    return np.asarray(within).reshape(m, STEPS + 1, count).transpose(1, 0, 2)


def _missed(programme: Programme, t: Array, x: Array) -> Array:
    """Return the distance (M,) of states (n, M) from the final conditions, each relative to its spread over motions."""
    instance, n = programme.instance, len(x)
    y = np.zeros((programme.points.local, len(t)))
    y[:n], y[n + programme.controls.count] = x, t
    for row, one in enumerate(programme.free):
        y[n + programme.controls.count + 1 + row] = one.of(instance)
    total = np.zeros(len(t))
    for row in programme.points.misses(y):
        finite = row[np.isfinite(row)]
        spread = float(np.subtract(*np.quantile(finite, (0.75, 0.25)))) if len(finite) else 0.0
        total = total + (row / (spread or 1.0)) ** 2
    return total


def _different(shapes: Array, order: Sequence[int], most: int) -> list[int]:
    """Return the first motions of an order that are apart from each other; shapes are states (M, times, n)."""
    if order:
        low, high = np.quantile(shapes[order], (0.1, 0.9), axis=(0, 1))
        shapes = shapes / np.where(high > low, high - low, 1.0)
    chosen = list[int]()
    for m in order:
        if all(np.abs(shapes[m] - shapes[other]).max() > SMALLEST_DISTANCE for other in chosen):
            chosen.append(m)
            if len(chosen) == most:
                break
    return chosen


def begun_from(programme: Programme, sample: Sample) -> Array:
    """Return the initial unknowns of a programme from a random motion."""
    duration = sample.times[-1] - sample.times[0]
    share = (sample.times - sample.times[0]) / duration
    times = programme.times(np.full(programme.phases, duration / programme.phases), sample.times[0])
    at = (times - times[0]) / duration
    x = np.array([np.interp(at, share, row) for row in sample.x])
    v = np.array([np.interp(at[1:], share, row) for row in sample.v]).reshape(programme.controls.count, len(at) - 1)
    free = np.array([one.of(programme.instance) for one in programme.free])
    return programme.packed(x, v, np.full(programme.phases, duration / programme.phases), free, sample.times[0])
