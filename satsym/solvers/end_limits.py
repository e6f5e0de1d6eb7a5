"""Limits of the end: final states in ranges, and inequalities that hold at the end.

The problem with some of these limits met and no other one stated is one like any other. Which are met is read from a
motion that the search finds; from there, limits are taken where the answer is beyond them, and left where their
multipliers pull. Competitors are motions that end anywhere within the limits.
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
from satsym.solvers.search.reading.limits import guessed_end, limits_met
from satsym.solvers.search.solving import searched
from satsym.status import BadInput, Status
from satsym.wording import counted

CHANGES = 20
"""Choices of limits that follow from one another, at most."""

WORK, STARTS = 2_500_000, 3
"""Columns that the method may linearise for limits that may be the wrong ones, as such a problem may have no answer.
And starts for the motion from which limits are read."""

ROUNDS = 3
"""Answers that ask for other limits once they have a certificate, at most."""

Met = Mapping[str, Side]
Solver = Callable[[Instance, Progress | None], Solution]


def solve(instance: Instance, progress: Progress | None, quick: Solver, last: Solver) -> Solution:
    """Solve an instance whose end has limits.

    Parameters
    ----------
    instance
        What to solve.
    progress
        Called after each iteration.
    quick
        Solves with ends given or free, for one choice of limits after the other.
    last
        The same for the answer, with its certificate where one is asked for.

    Raises
    ------
    BadInput
        If the problem is refused whatever limits are met.
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
        solution = trials.by(last, found.instance.met, instance.work)
        met = others_asked(solution) if solution.status.answered else None
        if met is None:
            found = solution
            break
        found = trials.following(met)  # what the certificate prefers leaves its ranges, or is held by none
    if found is None:
        found = trials.unanswered()
    own = replace(found.instance, solver=instance.solver, work=instance.work, tf_guess=instance.tf_guess)
    return replace(found, instance=own, message=_message(found), wall_s=time.perf_counter() - began)


@dataclass(eq=False)
class Trials:
    """Solves with one choice of limits after the other, and remembers what came of it."""

    instance: Instance
    progress: Progress | None
    quick: Solver
    deadline: float
    known: dict[frozenset[tuple[str, Side]], Solution] = field(default_factory=dict)
    refused: list[BadInput] = field(default_factory=list)
    late: bool = False
    """Whether time was up before all that was wanted was solved."""

    def following(self, met: Met) -> Solution | None:
        """The first solution that asks for no other limits than its own, from a choice on; ``None`` without one."""
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

    def by(self, solver: Solver, met: Met, work: float) -> Solution:
        """The solution with these limits by a solver; no answer where time is up, or such an end is refused."""
        begun = iteration.hurried(self.instance, self.deadline)
        nothing = iteration.unsolved(self.instance, self.instance.solver.method, 0.0)
        if begun is None:
            self.late = True
            late = "the time limit was reached before all combinations of active limits were tried"
            return replace(nothing, message=late)
        try:
            found = solver(replace(begun.meeting(met), work=work), self.progress)
        except BadInput as error:  # of this choice, which may be none where the start is an end with others free
            self.refused.append(error)
            return replace(nothing, status=Status.NOT_CONVERGED, message=str(error))
        self.late = self.late or iteration.computed() > self.deadline
        return found

    def unanswered(self) -> Solution:
        """No answer, and why.

        Raises
        ------
        BadInput
            What is refused with all limits that were tried.
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
    """The solver's, and which limits of the end are met."""
    if not solution.status.answered:
        return solution.message
    met = solution.instance.met
    where = ", ".join(
        f"{name} ends at its {met[name].value} limit" if name in met else f"{name} ends within its limits"
        for name in solution.instance.end_limits
    )
    return f"{solution.message}; {where}"
