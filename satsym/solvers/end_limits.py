"""Limits of the final state: ranges of final states, and inequalities at the final time.

With some of these limits active and the others ignored, the problem is one without limits. The active limits are read
from a motion of the direct search; then violated limits are added, and limits with multipliers of the wrong sign
removed. Competitors are motions that end anywhere within the limits.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace

from satsym.instance import Instance
from satsym.instance.end_time import never
from satsym.instance.ends import Side
from satsym.solution import Progress, Solution
from satsym.solvers import iteration
from satsym.solvers.certificate.end_limits import others_asked
from satsym.solvers.constrained.refusals import refuse
from satsym.solvers.search import coarse
from satsym.solvers.search.reading.collocated import guessing
from satsym.solvers.search.reading.limits import guessed_end, limits_met
from satsym.solvers.search.solving import searched
from satsym.status import BadInput, Status
from satsym.wording import counted

CHANGES = 20
"""Maximum number of successive choices of active limits."""

WORK, STARTS = 2_500_000, 3
"""Maximum number of points at which equations may be linearised for one choice of limits, since a wrong choice may have
no solution. Maximum number of starts for the motion from which limits are read."""

ROUNDS = 3
"""Maximum number of answers whose certificate requires other active limits."""

Met = Mapping[str, Side]
Solver = Callable[[Instance, Progress | None], Solution]


def solve(instance: Instance, progress: Progress | None, quick: Solver, last: Solver) -> Solution:
    """Solve an instance whose final state has limits.

    Parameters
    ----------
    instance
        What to solve.
    progress
        Called after each iteration.
    quick
        Solver for given or free final states, used for one choice of limits after the other.
    last
        Solver for the answer, with its certificate if one is required.

    Raises
    ------
    BadInput
        If the problem is refused for every choice of limits.
    """
    began = time.perf_counter()
    if why := never(instance):
        nothing = iteration.unsolved(instance, instance.solver.method, 0.0)
        return replace(nothing, status=Status.INFEASIBLE, message=why)
    if instance.model.spec.path_constraints:
        refuse(instance)
    deadline, (limits, _) = iteration.deadline_of(instance), iteration.watched(instance, None)
    at = coarse.first_motion(instance, limits, STARTS)
    begun = instance if at is None else guessed_end(instance, at)
    trials = Trials(begun, progress, quick, deadline)
    found = trials.following({} if at is None else limits_met(instance, at))
    if found is None and not trials.late and (at is not None or not trials.refused):
        found = searched(instance, replace(limits, work=WORK, meter=iteration.Meter())) or trials.following({})
    for _ in range(ROUNDS):
        if found is None:
            break
        solution, met = _solved_by(last, found, trials)
        if met is None:
            found = solution
            break
        found = trials.following(met)  # what the certificate prefers leaves its ranges, or is held by none
    if found is None:
        found = trials.unanswered()
    own = replace(
        found.instance, solver=instance.solver, work=instance.work, tf_guess=instance.tf_guess, guess=instance.guess
    )
    return replace(found, instance=own, message=_message(found), wall_s=time.perf_counter() - began)


def _solved_by(solver: Solver, found: Solution, trials: Trials) -> tuple[Solution, Met | None]:
    """Return the solution with the active limits of a known one, and other active limits if these are wrong.

    If the solver comes to another solution, which these limits do not suit, it begins again with the known one.
    """
    for near in (None, found):
        solution = trials.by(solver, found.instance.met, trials.instance.work, near)
        met = others_asked(solution) if solution.status.answered else None
        if solution.status.answered and met is None:
            if near is not None:  # the guess was not the user's
                solution = replace(solution, message=near.message)
            break
    return solution, met


@dataclass(eq=False)
class Trials:
    """Solver for one choice of active limits after the other, which keeps the results."""

    instance: Instance
    progress: Progress | None
    quick: Solver
    deadline: float
    known: dict[frozenset[tuple[str, Side]], Solution] = field(default_factory=dict)
    refused: list[BadInput] = field(default_factory=list)
    late: bool = False
    """Whether the time limit was reached before all required problems were solved."""

    def following(self, met: Met) -> Solution | None:
        """Return the first solution with the right active limits, starting from a given choice, or ``None``."""
        asked: Met | None = met
        seen = list[Met]()
        while asked is not None and asked not in seen and len(seen) < CHANGES:
            seen.append(asked)
            key = frozenset(asked.items())
            if key not in self.known:
                self.known[key] = self.by(self.quick, asked, min(WORK, self.instance.work))
            solution = self.known[key]
            if not solution.status.answered:
                return None
            asked = others_asked(solution)
            if asked is None:
                return solution
        return None

    def by(self, solver: Solver, met: Met, work: float, near: Solution | None = None) -> Solution:
        """Return the solution with given active limits; no answer if time is up or the end is refused.

        Parameters
        ----------
        near
            Solution that is the initial guess.
        """
        begun = iteration.hurried(self.instance, self.deadline)
        nothing = iteration.unsolved(self.instance, self.instance.solver.method, 0.0)
        if begun is None:
            self.late = True
            late = "the time limit was reached before all combinations of active limits were tried"
            return replace(nothing, message=late)
        if near is not None:
            begun = guessing(begun, near.times, near.x, near.lam)
        try:
            found = solver(replace(begun.meeting(met), work=work), self.progress)
        except BadInput as error:  # of this choice, which may be none where the start is an end with others free
            self.refused.append(error)
            return replace(nothing, status=Status.NOT_CONVERGED, message=str(error))
        self.late = self.late or iteration.computed() > self.deadline
        return found

    def unanswered(self) -> Solution:
        """Return a solution without an answer, and the reason.

        Raises
        ------
        BadInput
            If the problem was refused for all limits that were tried.
        """
        if len(self.refused) == len(self.known):
            raise self.refused[0]
        nothing = iteration.unsolved(self.instance, self.instance.solver.method, 0.0)
        if self.late:
            return nothing
        first = self.known.get(frozenset())
        if first is not None and first.status is Status.INFEASIBLE:  # no less so with more conditions
            return replace(nothing, status=first.status, message=first.message)
        count = counted(len(self.known), "choice")
        message = f"none of {count} of active limits has a solution that satisfies the other limits"
        reasons = [one.message for one in self.known.values() if not one.status.answered]
        return replace(
            nothing,
            status=Status.NOT_CONVERGED,
            message=f"{message}: {reasons[-1]}" if reasons else message,
        )


def _message(solution: Solution) -> str:
    """Return the solver's message with the active limits added."""
    if not solution.status.answered:
        return solution.message
    met = solution.instance.met
    where = ", ".join(
        f"{name} ends at its {met[name].value} limit" if name in met else f"{name} ends within its limits"
        for name in solution.instance.end_limits
    )
    return f"{solution.message}; {where}"
