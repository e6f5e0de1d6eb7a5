"""Recognition of the structure of a smoothed extremal (bound, coast and singular arcs) from its switching functions."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.collocation.curve import Path
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.switching.magnitudes import effective
from satsym.solvers.switching.structure import LOWER, REST, SINGULAR, UPPER, Course, Guess, Structure
from satsym.solvers.switching.throttled import signs

SAMPLES = 12
"""Number of points in each mesh interval at which switching functions are evaluated."""

FAINT_FUNCTION = 1e-9
"""Magnitude of a switching function, relative to its largest value, below which it counts as zero."""

LONG_ARC = 0.02
"""Minimum length of a singular arc, relative to the duration; shorter ones are smoothed switches."""


@dataclass(frozen=True, eq=False)
class Sample:
    """Values of a smoothed extremal at many times."""

    times: Array
    z: Array
    u: Array
    """Times, states above costates, and controls, shapes (N,), (2n, N), (m, N), in the model's units."""
    sigma: Array
    weight: Array
    """Switching functions, and weights of |u|, shapes (m, N)."""


def sample(problem: TwoPoint, path: Path) -> Sample:
    """Return the values of a smoothed extremal at many times."""
    fractions = np.linspace(0.0, 1.0, SAMPLES, endpoint=False)
    tau = np.append((path.mesh[:-1, None] + np.diff(path.mesh)[:, None] * fractions).ravel(), 1.0)
    scaled = path(tau)
    z, n, instance = scaled * problem.scale.both, problem.states, problem.instance
    times = instance.t0 + problem.elapsed(path.theta) * tau
    u = problem.control(tau, scaled, path.theta)
    return Sample(times, z, u, *signs(instance, times, z[:n], z[n:]))


def guess(instance: Instance, seen: Sample, singular: NDArray[np.bool_] | None = None) -> Guess:
    """Return the structure of a sample as a guess of exact arcs.

    Parameters
    ----------
    singular
        Where controls are assumed to be singular, shape (m, N); by default nowhere.
    """
    rows: list[tuple[int, ...]] = []
    times: list[float] = []
    for i, (sigma, weight) in enumerate(zip(seen.sigma, seen.weight, strict=True)):
        here = levels(instance, i, sigma, weight)
        if singular is not None:
            here = np.where(singular[i], SINGULAR, here)
        row, switches = _passages(seen.times, here, sigma, weight)
        rows.append(row)
        times += switches
    n = len(instance.initial)
    course = Course(seen.times, seen.z)
    return Guess(Structure(tuple(rows)), np.array(times), seen.z[n:, 0], float(seen.times[-1]), course)


def levels(instance: Instance, control: int, sigma: Array, weight: Array) -> NDArray[np.int64]:
    """Return the levels that minimise H for given values of a switching function."""
    low, high = (bounds[control] for bounds in instance.control_set.switching)
    if low == high:
        return np.full(len(sigma), LOWER)
    sigma, weight = effective(np.array(low), np.array(high), sigma, weight)
    found = np.where(sigma > weight, LOWER, np.where(sigma < -weight, UPPER, REST))
    if not weight.any():  # a zero between two signs belongs to either
        return np.where(sigma > 0.0, LOWER, UPPER)
    if low >= 0.0:
        return np.where(found == LOWER, REST, found)
    return np.where(found == UPPER, REST, found) if high <= 0.0 else found


def _passages(
    times: Array, here: NDArray[np.int64], sigma: Array, weight: Array
) -> tuple[tuple[int, ...], list[float]]:
    """Return successive levels, and the times between them; between the bounds there is a rest if |u| has a cost."""
    row, switches = [int(here[0])], []
    for k in np.flatnonzero(np.diff(here)):
        before, after = int(here[k]), int(here[k + 1])
        if SINGULAR in (before, after):
            switches.append(float(times[k] + times[k + 1]) / 2.0)
            row.append(after)
            continue
        through = [after]
        if weight[k] > 0.0 and before * after < 0:
            through = [REST, after]
        for level in through:
            target = float(weight[k]) * -np.sign(row[-1] + level) if weight[k] > 0.0 else 0.0
            a, b = float(sigma[k]) - target, float(sigma[k + 1]) - target
            fraction = min(max(a / (a - b), 0.0), 1.0) if a != b else 0.5
            switches.append(float(times[k] + fraction * (times[k + 1] - times[k])))
            row.append(level)
    return tuple(row), switches
