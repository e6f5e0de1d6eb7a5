"""Solving the rows of a chunk one after the other, each from its neighbour's answer where that is possible."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache

from satsym import methods, solvers
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solvers.repeated import Repeated
from satsym.status import BadInput, Verdict
from satsym.studies import rows
from satsym.studies.asked import Checked, Task
from satsym.studies.keys import Table
from satsym.studies.rows import Row, Work

ALONE = "single solver"
"""The origin of answers that were found without their neighbours."""


def solving(task: Task) -> Work:
    """The work of a chunk of optima."""
    if task.checked is Checked.FULL or not warm(task):
        return lambda key, instance: rows.of_solution(key, alone(instance, task.checked), ALONE, task.trajectories)
    return _from_neighbours(task)


def warm(task: Task) -> bool:
    """Whether rows may start from their neighbours: what varies leaves scales and ends as they are."""
    instance, spec = task.instance, task.instance.model.spec
    fitting = instance.solver.method in (methods.AUTO, "collocation") and not (instance.free or instance.continuation)
    smooth = not (spec.switching or spec.throttled or spec.stationary or spec.directional)
    stays = all(key.table in (Table.INITIAL, Table.PARAMETERS) for key in task.keys)
    return fitting and smooth and stays and not instance.solver.free_angles and not instance.guess


def alone(instance: Instance, checked: Checked) -> Solution:
    """One optimum from a cold start."""
    if checked is Checked.FULL:
        return solvers.solve(instance)
    found = solvers.solve(instance, examined=False)
    if checked is Checked.NONE:
        return replace(found, certificate=None)
    found = certified(found)
    if found.certificate is None or found.certificate.verdict is Verdict.LOCAL_MINIMUM:
        return found
    return solvers.solve(instance)  # which goes on from what is no minimum


def certified(solution: Solution) -> Solution:
    """An answer with all of its certificate but competitors."""
    from satsym.solvers.certificate import certify

    if not solution.status.answered or not methods.METHODS[solution.method].certified:
        return replace(solution, certificate=None)
    return replace(solution, certificate=certify(solution, compared=False))


@lru_cache(maxsize=1)
def _repeated(task: Task) -> Repeated:
    """The study's own instance, solved from a cold start."""
    return Repeated(task.instance, task.compiled)


def _from_neighbours(task: Task) -> Work:
    """From the last answer, the first of a chunk from that of the study's own instance."""
    checked = task.checked is Checked.LOCAL
    try:
        repeated = _repeated(task).branched()
    except BadInput:
        return lambda key, instance: rows.of_solution(key, alone(instance, task.checked), ALONE, task.trajectories)

    def solved(key: str, instance: Instance) -> Row:
        answer = repeated.solve(instance.initial, instance.parameters)
        if answer.status.answered:
            found = replace(repeated.solution(answer), instance=instance)
            if checked:
                found = certified(found)
            if not checked or (found.certificate and found.certificate.verdict is Verdict.LOCAL_MINIMUM):
                return rows.of_solution(key, found, answer.origin.value, task.trajectories)
        return rows.of_solution(key, alone(instance, task.checked), ALONE, task.trajectories)

    return solved
