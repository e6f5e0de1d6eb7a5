"""What is free chosen so that the end can be reached, where no choice is known."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import MOST_ITERATIONS, Limits
from satsym.solvers.search import nearest
from satsym.solvers.unknowns.trials import Trials

SLACK = 0.7
"""Share of the room between its bounds that a control is given: what is just reached has no answer nearby."""

WORK = 400_000
"""Unknowns times iterations that the searches may take."""


def reaching(trials: Trials) -> Array | None:
    """A choice with which the end can be reached, in units; ``None`` where none was found, or no end is given."""
    instance = trials.instance
    if not instance.final or any(isinstance(value, str) for value in instance.final.values()):
        return None
    found = nearest.reaching(_with_slack(instance), Limits(MOST_ITERATIONS, trials.deadline, work=WORK))
    if found is None:
        return None
    return np.array([one.of(found) - one.of(instance) for one in trials.unknowns]) / trials.unit


def _with_slack(instance: Instance) -> Instance:
    """With less room for controls."""

    def nearer(bounds: tuple[float, ...]) -> tuple[float, ...]:
        rest = (min(max(0.0, a), b) for a, b in zip(instance.lower, instance.upper, strict=True))
        return tuple(r + SLACK * (v - r) if np.isfinite(v) else v for v, r in zip(bounds, rest, strict=True))

    norms = {name: (low, max(low, SLACK * high)) for name, (low, high) in instance.norms.items()}
    return replace(
        instance,
        lower=nearer(instance.lower),
        upper=nearer(instance.upper),
        max_norm=SLACK * instance.max_norm,
        norms=norms,
    )
