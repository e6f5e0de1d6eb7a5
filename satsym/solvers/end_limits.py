"""Limits of the end: which of them are met is found, and other choices of them are competitors.

Final states may lie in ranges, and inequalities hold at the end. The problem with some of these limits met and no other
one stated is one like any other. From that with none met, limits are taken where the answer is beyond them, and left
where their multipliers pull. Where that leads nowhere, all choices are tried. Each of these problems may do so much
work, whatever the clock says: that with none met may be singular, or have no answer at all. Where no choice has one
they may do more.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace

from satsym.instance import Instance
from satsym.instance.ends import Side
from satsym.solution import Kind, Progress, Solution
from satsym.solvers import iteration
from satsym.solvers.certificate.competitors.comparison import summed
from satsym.solvers.certificate.end_limits import BEYOND_LIMIT, SIGN, beyond, pushes
from satsym.status import BadInput, Status, Verdict
from satsym.wording import counted

CHOICES = 27
"""Of ends that are tried, at most; where there are more, competitors are those that differ in one state."""

CHANGES, ROUNDS = 20, 3
"""Changes of ends from one start, and competitors that are taken for the solution, at most."""

BUDGETS = (250_000, 2_500_000)
"""Columns that each search of a trial problem may linearise, and again where no choice of ends has an answer."""

CHEAPER = 1e-9
"""Share of the cost by which a competitor is cheaper, at least."""

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
        Solves with ends given or free, for one choice of ends after the other.
    last
        The same for the answer, with its certificate where one is asked for.

    Raises
    ------
    BadInput
        If the problem is refused whatever ends are given.
    """
    began = time.perf_counter()
    trials = Trials(instance, progress, quick, iteration.deadline_of(instance))
    for trials.work in BUDGETS:
        found = _found(trials, {})
        if found.status.answered or trials.late or not trials.cut_short:
            break
    compared: list[Solution] | None = None
    for _ in range(ROUNDS):
        if not found.status.answered:
            break
        solution = trials.by(last, found.instance.met, instance.work)
        if solution.status.answered and (instead := changed(solution)) is not None:
            found = _found(trials, instead)  # what the certificate prefers leaves its ranges, or is held by none
            continue
        found = solution
        if found.status.answered and found.certificate is None:
            break
        compared = [trials(met) for met in _others(instance, found.instance.met)]
        cheapest = min(filter(_inside, compared), key=lambda one: one.objective, default=found)
        margin = CHEAPER * abs(found.objective)
        if cheapest is found or (found.status.answered and not cheapest.objective < found.objective - margin):
            break
        found = _found(trials, cheapest.instance.met)
    own = replace(found.instance, solver=instance.solver, work=instance.work)
    solved = replace(found, instance=own, message=_message(found))
    solved = replace(solved, wall_s=time.perf_counter() - began)
    return solved if compared is None or solved.certificate is None else _with_others(solved, compared, trials.late)


@dataclass(eq=False)
class Trials:
    """Solves with one choice of ends after the other, and remembers what came of it."""

    instance: Instance
    progress: Progress | None
    quick: Solver
    deadline: float
    known: dict[frozenset[tuple[str, Side]], Solution] = field(default_factory=dict)
    refused: dict[frozenset[tuple[str, Side]], BadInput] = field(default_factory=dict)
    work: float = float("inf")
    """Columns that each of their searches may linearise."""
    cut_short: dict[frozenset[tuple[str, Side]], float] = field(default_factory=dict)
    """Those without an answer for want of work, and how much they could do."""
    late: bool = False
    """Whether time was up before all that was wanted was solved."""

    def __call__(self, met: Met) -> Solution:
        """The solution with these ends, without a certificate."""
        key = frozenset(met.items())
        if key not in self.known or self.cut_short.get(key, self.work) < self.work:
            self.known[key] = self.by(self.quick, met, self.work)
            self.cut_short.pop(key, None)
            if self.known[key].status is Status.TIME_LIMIT:
                self.cut_short[key] = self.work
        return self.known[key]

    def by(self, solver: Solver, met: Met, work: float) -> Solution:
        """The solution with these ends by a solver; no answer where time is up, or such an end is refused."""
        begun = iteration.hurried(self.instance, self.deadline)
        nothing = iteration.unsolved(self.instance, self.instance.solver.method, 0.0)
        if begun is None:
            self.late = True
            return replace(nothing, status=Status.TIME_LIMIT, message="time ran out before all ends were tried")
        try:
            found = solver(replace(begun.meeting(met), work=work), self.progress)
        except BadInput as error:  # of this choice, which may be none where the start is an end with others free
            self.refused[frozenset(met.items())] = error
            return replace(nothing, status=Status.NOT_CONVERGED, message=str(error))
        self.late = self.late or iteration.computed() > self.deadline
        return found


def changed(solution: Solution) -> dict[str, Side] | None:
    """Other limits that a solution asks for: one that it is beyond, or none that pulls; ``None`` where these do."""
    met = dict(solution.instance.met)
    violated = {place: by for place, by in beyond(solution).items() if by > BEYOND_LIMIT}
    if violated:
        name, side = max(violated, key=lambda place: violated[place])
        return {**met, name: side}
    pulling = {name: push for name, push in pushes(solution).items() if push < -SIGN}
    if not pulling:
        return None
    return {name: side for name, side in met.items() if name != min(pulling, key=lambda one: pulling[one])}


def _inside(solution: Solution) -> bool:
    """Whether it is an answer, all of whose final states are in their ranges."""
    return solution.status.answered and max(beyond(solution).values(), default=0.0) <= BEYOND_LIMIT


def _found(trials: Trials, met: Met) -> Solution:
    """The solution that asks for no other ends than its own, from a choice on; no answer where there is none."""
    first, seen = trials(met), list[Met]()
    current: dict[str, Side] | None = dict(met)
    while current is not None and current not in seen and len(seen) < CHANGES:
        seen.append(current)
        solution = trials(current)
        if not solution.status.answered:
            break
        if (current := changed(solution)) is None:
            return solution
    for choice in itertools.islice(choices(trials.instance), CHOICES):
        solution = trials(choice)
        if solution.status.answered and changed(solution) is None:
            return solution
        if trials.late:
            return replace(iteration.unsolved(first.instance, first.method, 0.0), status=Status.TIME_LIMIT)
    return _unanswered(trials, first)


def _unanswered(trials: Trials, first: Solution) -> Solution:
    """No answer, and why; what is refused with any ends is refused."""
    if trials.refused.keys() == trials.known.keys():
        raise next(iter(trials.refused.values()))
    count = counted(len(trials.known), "choice")
    nothing = iteration.unsolved(trials.instance, first.method, 0.0)
    if first.status is Status.INFEASIBLE:  # with fewer conditions, so that more of them have no answer either
        return replace(nothing, status=first.status, message=first.message)
    reasons = [one.message for one in trials.known.values() if not one.status.answered]
    message = f"none of {count} of limits that the end meets has a solution that satisfies the others"
    return replace(nothing, status=Status.NOT_CONVERGED, message=f"{message}: {reasons[-1]}" if reasons else message)


def choices(instance: Instance) -> Iterator[dict[str, Side]]:
    """All choices of ends, those with few of them first."""
    sides = instance.end_limits
    for count in range(len(sides) + 1):
        for names in itertools.combinations(sides, count):
            for chosen in itertools.product(*(sides[name] for name in names)):
                yield dict(zip(names, chosen, strict=True))


def _others(instance: Instance, met: Met) -> list[dict[str, Side]]:
    """Choices of ends to compare one with: all of them, or those that differ in one state."""
    found = [one for one in itertools.islice(choices(instance), CHOICES + 1) if one != met]
    if len(found) <= CHOICES:
        return found
    names = instance.end_limits
    return [one for one in choices(instance) if sum(one.get(name) != met.get(name) for name in names) == 1]


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


def _with_others(solution: Solution, others: list[Solution], late: bool) -> Solution:
    """With other ends among the competitors of the certificate."""
    certificate = solution.certificate
    assert certificate is not None
    kind = summed(solution, Kind.ENDS, len(others), [one.objective for one in filter(_inside, others)], late)
    missing = (Kind.ENDS,) if late or not any(one.status.answered for one in others) else ()
    passed = all(check.passed for check in kind.checks)
    lesser = certificate.verdict is Verdict.CERTIFIED and not passed
    more = replace(
        certificate,
        verdict=Verdict.EXTREMAL_ONLY if lesser else certificate.verdict,
        checks=(*certificate.checks, *kind.checks),
        competitors=(*certificate.competitors, kind.summary),
        not_checked=(*certificate.not_checked, *missing),
    )
    return replace(solution, certificate=more)
