"""What is free chosen so that the end can be reached: where no choice is known, the miss is minimised over them too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.cold_start.durations import time_scale
from satsym.solvers.collocation.scaling import two_point
from satsym.solvers.nearest_end import ARRIVED, NO_MOTION, ROUNDS, Reach
from satsym.solvers.unknowns.trials import Trials

SLACK = 0.7
"""Share of the room between its bounds that a control is given: what is just reached has no answer nearby."""

NUDGE = 1e-6
"""Units by which unknowns are changed for a derivative."""


def reaching(trials: Trials) -> Array | None:
    """A choice with which the end can be reached, in units; ``None`` where none was found, or no end is given."""
    from scipy.optimize import minimize

    instance = trials.instance
    if not instance.final or any(isinstance(value, str) for value in instance.final.values()):
        return None
    first = instance.tf if instance.tf is not None else instance.tf_guess
    lasting = time_scale(instance) if first is None else first - instance.t0
    problem = two_point(_lasting(instance, lasting), lasting)
    count, tied = len(trials.unknowns), instance.tf is not None

    def of(unknown: Array) -> Reach | None:
        chosen = trials.chosen(unknown[:count])
        if chosen is None:
            return None
        given = _with_slack(_lasting(chosen, lasting * float(np.exp(unknown[count]))) if not tied else chosen)
        return Reach(replace(problem, instance=given))

    def miss(both: Array) -> tuple[float, Array]:
        controls, unknown = both[: -count - 1], both[-count - 1 :]
        here = of(unknown)
        if here is None:
            return NO_MOTION, np.zeros_like(both)
        value, slope = here.miss(controls)
        found = []
        for axis in np.eye(count + 1)[: count + (not tied)]:
            there = of(unknown + NUDGE * axis)
            found.append(0.0 if there is None else (there.miss(controls)[0] - value) / NUDGE)
        return value, np.concatenate([slope, found, np.zeros(int(tied))])

    begun = of(np.zeros(count + 1))
    if begun is None:
        return None
    start = begun.parameters(np.zeros((begun.controls, len(begun.tau))))
    with np.errstate(all="ignore"):
        found = minimize(
            miss,
            np.concatenate([start.ravel(), np.zeros(count + 1)]),
            jac=True,
            method="L-BFGS-B",
            bounds=[*begun.box, *[(None, None)] * (count + 1)],
            options={"maxiter": ROUNDS, "maxcor": 20, "ftol": 1e-15, "gtol": 1e-10},
        )
    return np.asarray(found.x[-count - 1 : -1]) if found.fun <= ARRIVED**2 / 2.0 else None


def _lasting(instance: Instance, duration: float) -> Instance:
    return replace(instance, tf=instance.t0 + duration, tf_guess=None)


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
