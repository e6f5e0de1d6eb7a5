"""Solution of the rows of a chunk one after the other, each from its neighbour's answer where that is possible."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import lru_cache

from satsym import methods, solvers
from satsym.instance import Instance
from satsym.instance.numbers import Table
from satsym.kernels.batch.compiling import able
from satsym.solution import Certificate, Solution
from satsym.solvers.improving import goes_on
from satsym.solvers.repeated import Repeated
from satsym.status import BadInput, Verdict
from satsym.studies import rows
from satsym.studies.asked import Checked, Task
from satsym.studies.rows import Cases, Row, Work
from satsym.studies.together import plain, rows_together, together

ROWS_PER_COMPARISON = 100
"""Average number of rows per row that is compared with competing extremals, if only a sample is compared."""

SINGLE_ORIGIN = "single solver"
"""The recorded origin of solutions that were found without those of neighbouring rows."""


def solving(task: Task) -> Work:
    """Return the function that computes a chunk of optima."""
    if task.checked is Checked.SAMPLE:
        return lambda cases: _sampled(task, cases)
    single = _single(task)
    solve = together(task)
    if solve is not None and (able() or not task.compiled):
        return lambda cases: rows_together(task, solve, single, cases)
    if task.checked is Checked.FULL or not warm(task):
        return rows.one_by_one(single)
    try:
        repeated = _repeated(task).branched()
    except BadInput:
        return rows.one_by_one(single)
    return lambda cases: _from_neighbours(task, repeated, single, cases)


def _sampled(task: Task, cases: Cases) -> list[Row]:
    """Compute rows without competitors, and those that their keys select again with competitors."""
    done = solving(_less(task, Checked.LOCAL))(cases)
    drawn = [k for k, (key, _) in enumerate(cases) if drawn_for_competitors(task.checked, key)]
    again = solving(_less(task, Checked.FULL))([cases[k] for k in drawn])
    for k, row in zip(drawn, again, strict=True):
        done[k] = row
    return done


def drawn_for_competitors(checked: Checked, key: str) -> bool:
    """Tell whether a row is compared with competitors: all rows are, a sample of them, or none."""
    return checked is Checked.FULL or (checked is Checked.SAMPLE and int(key, 16) % ROWS_PER_COMPARISON == 0)


@lru_cache(maxsize=8)
def _less(task: Task, checked: Checked) -> Task:
    """Return a study with another certificate; the same object each time, because caches depend on it."""
    return replace(task, checked=checked)


def _single(task: Task) -> Callable[[str, Instance], Row]:
    """Return the function that computes a single row."""
    return lambda key, instance: rows.of_solution(key, alone(instance, task.checked), SINGLE_ORIGIN, task.trajectories)


def warm(task: Task) -> bool:
    """Tell whether rows may start from neighbours: the varied numbers leave scales and ends unchanged."""
    fitting = task.instance.solver.method in (methods.AUTO, "collocation")
    return fitting and plain(task) and all(key.table in (Table.INITIAL, Table.PARAMETERS) for key in task.keys)


def alone(instance: Instance, checked: Checked) -> Solution:
    """Solve one instance from a cold start."""
    if checked is Checked.FULL:
        return solvers.solve(instance)
    found = solvers.solve(instance, examined=False)
    if checked is Checked.NONE:
        return replace(found, certificate=None)
    found = certified(found)
    return solvers.solve(instance) if goes_on(found) else found


def certified(solution: Solution) -> Solution:
    """Return an answer with its certificate, without competitors."""
    from satsym.solvers.certificate import certify

    if not solution.status.answered or not methods.METHODS[solution.method].certified:
        return replace(solution, certificate=None)
    return replace(solution, certificate=certify(solution, compared=False))


@lru_cache(maxsize=1)
def _repeated(task: Task) -> Repeated:
    """Return the repeated solver of the study's own instance, solved from a cold start."""
    return Repeated(task.instance, task.compiled)


def _from_neighbours(task: Task, repeated: Repeated, single: Callable[[str, Instance], Row], cases: Cases) -> list[Row]:
    """Solve each row from the last answer, the first one from that of the study's own instance.

    A row that does not lead to a minimum is left to the single solver.
    """
    from satsym.solvers.certificate import certify

    answers = [_again(repeated, instance) for _, instance in cases]
    found = [answer for answer in answers if answer is not None]
    certificates: list[Certificate | None] = [None] * len(found)
    if task.checked is Checked.LOCAL:
        certificates = [certify(solution, compared=False) for solution, _ in found]
    certified = iter(zip(found, certificates, strict=True))
    done: list[Row] = []
    for (key, instance), answer in zip(cases, answers, strict=True):
        if answer is not None:
            (solution, origin), certificate = next(certified)
            minimum = certificate is not None and certificate.verdict is Verdict.LOCAL_MINIMUM
            if minimum or task.checked is Checked.NONE:
                solution = replace(solution, certificate=certificate)
                done.append(rows.of_solution(key, solution, origin, task.trajectories))
                continue
        done.append(rows.tried(single, key, instance))
    return done


def _again(repeated: Repeated, instance: Instance) -> tuple[Solution, str] | None:
    """Return the answer near the last one, and from which row it was found."""
    try:
        answer = repeated.solve(instance.initial, instance.parameters)
        if not answer.status.answered:
            return None
        return replace(repeated.solution(answer), instance=instance), answer.origin.value
    except Exception:  # the single solver says what it is
        return None
