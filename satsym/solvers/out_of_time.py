"""What is handed back where time ends before there is any trajectory."""

from __future__ import annotations

import numpy as np

from satsym.instance import Instance
from satsym.solution import Flight, Solution
from satsym.status import Status

MESSAGE = "time was up while {steps} steps were computed"


def solution(instance: Instance, method: str, wall_s: float) -> Solution:
    """No answer, and no trajectory."""
    n, m = len(instance.initial), len(instance.lower)
    return Solution(
        instance=instance,
        method=method,
        status=Status.TIME_LIMIT,
        message=MESSAGE.format(steps=instance.solver.steps),
        objective=float("nan"),
        times=np.array([instance.t0, instance.t0 + 1.0 if instance.tf is None else instance.tf]),
        x=np.full((n, 2), np.nan),
        u=np.full((m, 2), np.nan),
        lam=np.full((n, 2), np.nan),
        switching_times=((),) * m,
        iterations=0,
        history=(),
        wall_s=wall_s,
    )


def flight(instance: Instance, feedback: str) -> Flight:
    """No motion."""
    return Flight(
        instance=instance,
        feedback=feedback,
        status=Status.TIME_LIMIT,
        message=Status.TIME_LIMIT.explain(MESSAGE.format(steps=instance.solver.steps)),
        times=np.array([instance.t0, instance.t0 + 1.0 if instance.tf is None else instance.tf]),
        x=np.full((len(instance.initial), 2), np.nan),
        u=np.full((len(instance.lower), 2), np.nan),
        invariants={},
        metrics={},
    )
