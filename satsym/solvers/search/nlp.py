"""Interface to the interior-point code that solves nonlinear programmes; no other module depends on its choice."""

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
"""Tolerance of the optimality conditions, and the looser one that is accepted if rounding allows no better."""

RESTORED = 2
"""Maximum number of all iterations, relative to that of iterations outside the restoration of feasibility."""

SHORT_STEP, STALLED, RESTORING, DIVERGED = 0.05, 40, 60, 1e15
"""A programme is given up after STALLED steps in a row of which less than the fraction SHORT_STEP was taken, after
RESTORING iterations that restore feasibility, or if the dual infeasibility exceeds DIVERGED. Of 491 programmes that
could be solved 6 met one of these limits first. Programmes that could not be solved took half of all iterations, of
which the limits save 40 %.
"""

FALLBACK = "mu_strategy_fallback"
SECOND_ATTEMPTS = (
    FALLBACK,
    "infeasibility_mu_strategy_retry",
    "infeasibility_perturbed_start_retry",
    "feral_infeasibility_scaling_retry",
)
"""Options of the solver that make it start again after a failure, the first one with the other strategy for the barrier
parameter. Near a solution, the monotone strategy comes first and the adaptive one second. Elsewhere only the adaptive
one is tried, because the search has other starts, which find more."""

SOLVED, ACCEPTED = 0, 1
"""Status codes that the solver returns for a solved and for an acceptably solved programme."""


@dataclass(frozen=True, eq=False)
class Found:
    """Result of the solution of a nonlinear programme.

    Attributes
    ----------
    solved
        Whether it is optimal, at least within the acceptable tolerance.
    multipliers
        Multipliers of the constraint rows.
    pressures
        Multipliers of the lower and upper bounds of the unknowns, nonnegative, shape (2, unknowns).
    objective
        The cost without the contribution of smoothing.
    smoother
        Solution of the same problem with more smoothing, from which this one was started; otherwise ``None``.
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
    """A programme in the form that the solver calls, which ends the iteration at the limits of time and work."""

    def __init__(self, programme: Programme, limits: Limits | None, most: int) -> None:
        self.programme, self.limits, self.iterations, self.most = programme, limits, 0, most
        self.elsewhere = _elsewhere()
        self.short = self.restoring = 0
        self.objective, self.gradient, self.constraints = programme.objective, programme.gradient, programme.values
        self.jacobian = programme.jacobian

    def jacobianstructure(self) -> tuple[Places, Places]:
        """Return rows and columns of the Jacobian's entries."""
        return self.programme.jacobian_places

    def hessianstructure(self) -> tuple[Places, Places]:
        """Return rows and columns of the Hessian's entries."""
        return self.programme.hessian_places

    def hessian(self, w: Array, multipliers: Array, factor: float) -> Array:
        """Return the entries of the Hessian of the Lagrangian."""
        return self.programme.hessian(np.asarray(w), np.asarray(multipliers), factor)

    def intermediate(self, mode: int, number: int, objective: float, infeasibility: float, *others: float) -> bool:
        """Count an iteration, and return whether to continue.

        Parameters
        ----------
        mode
            1 while feasibility is restored, otherwise 0.
        others
            Dual infeasibility, barrier parameter, length of the step, regularisation, fractions of the dual and of the
            primal step that are taken, and number of trial steps.
        """
        self.iterations += 1
        self.short = self.short + 1 if others[5] < SHORT_STEP else 0
        self.restoring += mode
        if self.short > STALLED or self.restoring > RESTORING or others[0] > DIVERGED:
            return False
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
"""Programmes that are being solved at the moment, in any thread."""


def _elsewhere() -> float:
    """Return the processor time in seconds of other threads of this process, in which matrices are factored."""
    return time.process_time() - time.thread_time()


def solve(
    programme: Programme, start: Array, limits: Limits | None = None, most: int = 500, near: bool = False
) -> Found:
    """Solve a nonlinear programme.

    Parameters
    ----------
    start
        Initial values of the unknowns.
    most
        Maximum number of iterations, not counting those that restore feasibility.
    near
        Whether the initial values are close to a solution.
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
    options |= dict.fromkeys(SECOND_ATTEMPTS, "no")
    if near:
        options |= {"mu_init": 1e-4, FALLBACK: "yes"}
    else:
        options["mu_strategy"] = "adaptive"
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
