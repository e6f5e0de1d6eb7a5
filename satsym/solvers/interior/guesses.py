"""Paths that pass the points at given times, from which Newton's method starts, and the times that are tried."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.constrained.arcs import Arcs, conditions, gradient, missed
from satsym.solvers.constrained.newton import begun
from satsym.solvers.constrained.regularised.starts import AMPLITUDE, straight
from satsym.solvers.constrained.regularised.transcription import Program
from satsym.solvers.constrained.structure import Passage, Structure

SAMPLES = 61
"""Of a path."""

PROJECTED = 8
"""Steps at most by which a state is moved onto a point."""

SINGLE = (0.02, 0.07, 0.2, 0.35, 0.5, 0.65, 0.8, 0.93, 0.98)
"""Fractions of the duration at which a single point is passed."""

RATIOS = {2: (1.0, 3.0, 9.0), 3: (1.0, 4.0)}
"""What the durations between several points are to each other; of more points they are alike, or one is longer."""

SPREAD, LASTING = 1.2, 0.5
"""Standard deviations of logarithms: of durations between points that are drawn, and of a whole one that is free."""


@dataclass(frozen=True, eq=False)
class Base:
    """A path that knows nothing of the points, over fractions of its duration."""

    fractions: Array
    """Shape (N,)."""
    x: Array
    lam: Array
    """Shape (n, N)."""
    lasting: float


def bases(instance: Instance, relaxed: Solution) -> list[Base]:
    """The path without the points, where it is known, and a straight line."""
    program = Program(instance, SAMPLES - 1)
    x = straight(program).x
    found = [Base(np.linspace(0.0, 1.0, SAMPLES), x, np.zeros_like(x), program.guessed)]
    if relaxed.status.answered:
        lasting = float(relaxed.times[-1] - relaxed.times[0])
        fractions = (relaxed.times - relaxed.times[0]) / lasting
        found.insert(0, Base(fractions, relaxed.x, relaxed.lam, lasting))
    return found


def bent(base: Base, rng: np.random.Generator) -> Base:
    """A path beside another, without its costates."""
    size = np.abs(base.x).max(axis=1, keepdims=True)
    bump = rng.normal(size=size.shape) * size * AMPLITUDE * np.sin(np.pi * base.fractions)
    return Base(base.fractions, base.x + bump, np.zeros_like(base.lam), base.lasting)


def weights(points: int) -> list[Array]:
    """Fractions of the duration from the start to the first point, from there to the next, and so on."""
    if points == 1:
        return [np.array([fraction, 1.0 - fraction]) for fraction in SINGLE]
    if points in RATIOS:
        tried = [row for row in product(RATIOS[points], repeat=points + 1) if min(row) == 1.0]
    else:
        tried = [tuple(row) for row in np.ones((points + 2, points + 1)) + 3.0 * np.eye(points + 2, points + 1)]
    return [np.array(row) / sum(row) for row in tried]


def drawn_weights(points: int, rng: np.random.Generator) -> Array:
    """Fractions of any order of magnitude."""
    found = np.exp(SPREAD * rng.normal(size=points + 1))
    return np.asarray(found / found.sum())


def passing(instance: Instance, base: Base, fractions: Array, lasting: float) -> Arcs:
    """The unknowns of a motion that passes the points after fractions of a duration, its times fixed."""
    passed = instance.t0 + lasting * np.cumsum(fractions)[:-1]
    fixed = [*passed.tolist(), *([instance.t0 + lasting] if instance.tf is None else [])]
    which = conditions(instance)
    passages = tuple(Passage(t, tuple((k, 0.0) for k in own)) for t, own in zip(passed.tolist(), which, strict=True))
    tau = np.union1d(np.linspace(0.0, 1.0, SAMPLES), np.cumsum(fractions)[:-1])
    x, lam = (np.array([np.interp(tau, base.fractions, row) for row in rows]) for rows in (base.x, base.lam))
    program = Program(instance, 1)
    end = x[:, -1].copy()
    end[program.given] = program.target(lasting)[program.given]
    moved = [
        _onto(instance, own, t, _at(tau, x, t, instance.t0, lasting)) for t, own in zip(passed, which, strict=True)
    ]
    knots = np.array([0.0, *np.cumsum(fractions)[:-1], 1.0])
    by = np.array([0.0 * end, *(found - known for known, found in moved), end - x[:, -1]])
    x = x + np.array([np.interp(tau, knots, column) for column in by.T])
    nu = np.zeros(len(instance.model.spec.multipliers))
    near = instance.t0 + lasting * tau, np.concatenate([x, lam]), nu
    arcs = begun(instance, Structure((), passages), near, instance.t0 + lasting)
    return Arcs(instance, arcs.structure, arcs.intervals, arcs.unknown, tuple(fixed))


def _at(tau: Array, x: Array, time: float, t0: float, lasting: float) -> Array:
    return np.array([np.interp((time - t0) / lasting, tau, row) for row in x])


def _onto(instance: Instance, which: range, time: float, x: Array) -> tuple[Array, Array]:
    """A state, and the one near it that meets conditions; measured by the sizes of its components."""
    t, found = np.array([time]), x.copy()
    size = np.where(x != 0.0, np.abs(x), max(float(np.abs(x).max()), 1.0)) ** 2
    for _ in range(PROJECTED):
        off = missed(instance, which, t, found[:, None])[0][:, 0]
        slopes = np.array([gradient(instance, k, t, found[:, None])[:, 0] for k in which])
        found = found - size * (slopes.T @ np.linalg.lstsq((slopes * size) @ slopes.T, off, rcond=None)[0])
    return x, found if np.isfinite(found).all() else x
