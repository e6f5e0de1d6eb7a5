"""Starts for free ends: controls held at a corner of the box; the costates follow from the end, and from these levels.

Such a problem may have several extremals, and without bounds often none: nothing of less smoothing leads to them.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import islice, product

import numpy as np

from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solvers.failures import tried
from satsym.solvers.switching.cold_start.recognition import Sample, guess
from satsym.solvers.switching.structure import Guess
from satsym.solvers.switching.throttled import signs

STEPS = 400
"""RK4 steps of such a motion."""

MOST = 64
"""Corners that are tried: controls beyond the sixth stay at their lower bounds."""


def applies(instance: Instance) -> bool:
    """Whether the time is given and nothing else at the end."""
    return instance.tf is not None and not instance.final and not instance.model.spec.multipliers


def guesses(instance: Instance) -> Iterator[Guess]:
    """Where to look, one guess for each corner whose motion is finite; none where anything is given at the end."""
    if instance.tf is None or not applies(instance):
        return
    pairs = [sorted({low, high}) for low, high in zip(instance.lower, instance.upper, strict=True)]
    for corner in islice(product(*reversed(pairs)), MOST):
        seen = tried(partial(_motion, instance, instance.tf, corner[::-1]))
        if seen is not None:
            yield guess(instance, seen)


def _motion(instance: Instance, tf: float, held: tuple[float, ...]) -> Sample | None:
    """The motion under constant controls with its costates; ``None`` where it leaves the domain."""
    model, p, times = instance.model, instance.parameters, Grid.uniform(instance.t0, tf, STEPS).nodes
    u = np.repeat(np.array(held)[:, None], STEPS + 1, axis=1)
    x, x_mid, _ = model.forward(times, instance.initial, u, u[:, 1:], p)
    if not np.isfinite(x).all() or not model.in_domain(x):
        return None
    last = model.terminal_gradient(tf, tuple(x[:, -1].tolist()), p)
    lam, _ = model.backward(times, last, x, x_mid, u, u[:, 1:], p)
    if not np.isfinite(lam).all():
        return None
    return Sample(times, np.concatenate([x, lam]), u, *signs(instance, times, x, lam))
