"""The interior-point code that solves programmes: the one place that knows which it is."""

from __future__ import annotations

import os
import time
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.solvers.iteration import Limits, count_helpers
from satsym.solvers.search.programme import Programme
from satsym.solvers.search.transcription import Places

TOLERANCE, ACCEPTABLE = 1e-8, 1e-6
"""Tolerance of the optimality conditions, and the one that is taken where rounding allows no more."""

RESTORED = 2
"""Iterations in all, as a multiple of those that do not restore feasibility."""

SOLVED, ACCEPTED = 0, 1
"""What the code says of its end."""


@dataclass(frozen=True, eq=False)
class Found:
    """Where a solution of a programme ended.

    Attributes
    ----------
    solved
        Whether it is optimal, at least acceptably.
    multipliers
        Of the rows.
    pressures
        Multipliers of the lower and of the upper bounds of the unknowns, none below zero, shape (2, unknowns).
    objective
        The cost without what smoothing adds to it.
    smoother
        The solution of the same problem with norms that are smoothed more, at which this one began, if it did.
    """

    programme: Programme
    unknown: Array
    multipliers: Array
    pressures: Array
    objective: float
    iterations: int
    solved: bool
    smoother: Found | None = None


class _Watched:
    """A programme as the code calls it, which ends where time is up."""

    def __init__(self, programme: Programme, limits: Limits | None, most: int) -> None:
        self.programme, self.limits, self.iterations, self.most = programme, limits, 0, most
        self.elsewhere = _elsewhere()
        self.objective, self.gradient, self.constraints = programme.objective, programme.gradient, programme.values
        self.jacobian = programme.jacobian

    def jacobianstructure(self) -> tuple[Places, Places]:
        """Rows and columns."""
        return self.programme.jacobian_places

    def hessianstructure(self) -> tuple[Places, Places]:
        """Rows and columns."""
        return self.programme.hessian_places

    def hessian(self, w: Array, multipliers: Array, factor: float) -> Array:
        """Second derivatives of the Lagrangian."""
        return self.programme.hessian(np.asarray(w), np.asarray(multipliers), factor)

    def intermediate(self, mode: int, number: int, objective: float, infeasibility: float, *_: object) -> bool:
        """Called once an iteration; whether to go on."""
        self.iterations += 1
        elsewhere, before = _elsewhere(), self.elsewhere
        self.elsewhere = elsewhere
        if len(_WATCHED) == 1:  # of several at once nobody can tell whose threads have computed
            count_helpers(elsewhere - before)
        if self.limits is None:
            return self.iterations < self.most
        self.limits.spend(self.programme.unknowns)
        self.limits.tell(objective * self.programme.sizes.cost, infeasibility)
        return self.iterations < self.most and not self.limits.expired


_WATCHED: list[_Watched] = []
"""Programmes that are being solved now, in whatever thread."""


def _elsewhere() -> float:
    """Seconds of a processor that other threads of this process have had: the code factors matrices in such."""
    return time.process_time() - time.thread_time()


def solve(
    programme: Programme, start: Array, limits: Limits | None = None, most: int = 500, near: bool = False
) -> Found:
    """Solve a programme.

    Parameters
    ----------
    start
        Unknowns to begin with.
    most
        Iterations, besides those that restore feasibility.
    near
        Whether the start is near a solution.
    """
    os.environ.setdefault("RUST_LOG", "off")  # it tells on the standard error what it does when steps are hard to find
    import pounce  # type: ignore[import-untyped]

    low, high = programme.bounds
    lower, upper = programme.limits
    watched = _Watched(programme, limits, RESTORED * most)
    problem = pounce.Problem(n=len(low), m=len(lower), problem_obj=watched, lb=low, ub=high, cl=lower, cu=upper)
    options = {"print_level": 0, "sb": "yes", "max_iter": most, "tol": TOLERANCE}
    options |= {"acceptable_tol": ACCEPTABLE, "acceptable_iter": 8}
    options["feral_min_par_flops"] = 1e30  # one thread: sums in another order would be another answer
    if near:
        options["mu_init"] = 1e-4
    for name, value in options.items():
        problem.add_option(name, value)
    _WATCHED.append(watched)
    try:
        with np.errstate(all="ignore"):
            w, report = problem.solve(np.clip(start, low, high))
    finally:
        _WATCHED.remove(watched)
    solved = report["status"] in (SOLVED, ACCEPTED)
    w, multipliers = np.asarray(w), np.asarray(report["mult_g"])
    return Found(
        programme,
        w,
        multipliers,
        np.array([report["mult_x_L"], report["mult_x_U"]]),
        (programme.objective(w) - programme.raised(multipliers)) * programme.sizes.cost,
        watched.iterations,
        solved,
    )
