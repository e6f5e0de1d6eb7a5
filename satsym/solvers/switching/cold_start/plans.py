"""Controls that are constant on arcs: at random, with switches as many as they may be, from every first level."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.switching.magnitudes import moving, resting
from satsym.solvers.switching.structure import LOWER, REST, UPPER


@dataclass(frozen=True, eq=False)
class Plans:
    """Controls that are constant on arcs."""

    levels: NDArray[np.int64]
    """Of each control on each arc, shape (K, m, M)."""
    lengths: Array
    """Of the arcs, shape (K, M)."""


@dataclass(frozen=True, eq=False)
class Scout:
    """A motion that arrives, roughly."""

    number: int
    """Of its plan."""
    levels: NDArray[np.int64]
    lengths: Array
    """Of each control on each arc, shape (K, m), and of the arcs, (K,)."""
    cost: float
    """Of the motion, as far as fixed steps tell."""


def seeded(
    instance: Instance, switches: Sequence[int], durations: Array, rng: np.random.Generator, opposite: bool = False
) -> Plans:
    """Random plans, one for each duration.

    Parameters
    ----------
    switches
        Most of each control.
    durations
        Shape (M,).
    opposite
        Whether first levels are taken in the other order.
    """
    moves = moving(instance)
    choices = [
        (LOWER,) if low == high else (LOWER, REST, UPPER) if rests else (LOWER, UPPER)
        for low, high, rests in zip(instance.lower, instance.upper, resting(instance), strict=True)
    ]
    rows = []
    for number, duration in enumerate(durations.tolist()):
        times, tables = [], []
        for control, most in enumerate(switches):
            count = int(rng.integers(0, most + 1))
            own = _walk(choices[control], count, number + opposite, moves[control], rng)
            tables.append((np.sort(rng.uniform(0.0, duration, len(own) - 1)), own))
            times.append(tables[-1][0])
        edges = np.concatenate([[0.0], np.sort(np.concatenate(times)), [duration]])
        middle = (edges[1:] + edges[:-1]) / 2.0
        rows.append((np.diff(edges), np.array([[own[np.searchsorted(t, s)] for t, own in tables] for s in middle])))
    most = max(len(lengths) for lengths, _ in rows)
    lengths = np.array([np.pad(own, (0, most - len(own))) for own, _ in rows]).T
    levels = np.array([np.pad(own, ((0, most - len(own)), (0, 0)), mode="edge") for _, own in rows])
    return Plans(levels.transpose(1, 2, 0), lengths)


def _walk(choices: tuple[int, ...], switches: int, number: int, direct: bool, rng: np.random.Generator) -> list[int]:
    """Levels of a control one after the other; where its magnitude costs through rest, unless it may pass directly."""
    found = [choices[number % len(choices)]]
    for _ in range(switches if len(choices) > 1 else 0):
        now = found[-1]
        if direct:
            found.append(int(rng.choice([level for level in choices if level != now])))
            continue
        found.append(-now if REST not in choices else (int(rng.choice([LOWER, UPPER])) if now == REST else REST))
    return found


def together(*plans: Plans) -> Plans:
    """Several sets of plans as one."""
    most = max(len(one.lengths) for one in plans)
    levels = [np.pad(one.levels, ((0, most - len(one.levels)), (0, 0), (0, 0)), mode="edge") for one in plans]
    lengths = [np.pad(one.lengths, ((0, most - len(one.lengths)), (0, 0))) for one in plans]
    return Plans(np.concatenate(levels, axis=2), np.concatenate(lengths, axis=1))
