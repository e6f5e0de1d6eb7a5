"""Competitors from the direct search: the costs of motions that other starts than that of an answer lead to."""

from __future__ import annotations

import math
from dataclasses import replace

from satsym.instance import Guess, Instance
from satsym.instance.unknowns import Unknown
from satsym.solution import Kind, Solution
from satsym.solvers.certificate.competitors.comparison import going_round
from satsym.solvers.iteration import Limits
from satsym.solvers.revolutions import shifted
from satsym.solvers.search.tried import Past

WORK = 2_000_000
"""Maximum work of all starts together, in unknowns times iterations."""

TURNED = 400_000
"""Maximum work, in unknowns times iterations, of the search for a final angle that differs by one turn."""


def kinds(instance: Instance) -> list[Kind]:
    """Return the kinds of competitors that an instance allows."""
    round_ = [Kind.REVOLUTIONS] if _angles(instance) else going_round(instance)
    times = [Kind.TIMES] if instance.model.spec.interior else []
    return [Kind.STARTS, *times, *([Kind.DURATIONS] if instance.tf is None else []), *round_]


def searched(
    solution: Solution, limits: Limits, past: Past, free: tuple[Unknown, ...] = ()
) -> tuple[dict[Kind, list[float]], Solution | None, set[Kind]]:
    """Solve again from each start of the search and compare the costs with that of an answer.

    Starts that reach the time limit are left out.

    If final angles count modulo a turn, the search is repeated with one turn less and one turn more. If the final
    conditions hold at the initial state already, the cost of a motion of no duration is compared as well.

    Parameters
    ----------
    past
        Earlier answers.
    free
        Initial states, initial time and parameters that the starts may choose as well as the final state.

    Returns
    -------
    dict
        Costs of each kind that was tried, NaN where a start did not lead to a motion.
    Solution
        A cheaper extremal, ``None`` if none was found. It is the first that was found, since it is compared with all
        starts in turn; if the answer belongs to an initial guess of the user, it is the cheapest.
    set
        Kinds with a motion that seems cheaper, although its cost does not converge as the mesh is refined.
    """
    from satsym.solvers.search import solving

    instance = replace(past.asked or solution.instance, guess=Guess(), free=free)
    within = replace(limits, work=limits.meter.spent + WORK, watch=None)
    costs: dict[Kind, list[float]] = {kind: [] for kind in kinds(instance)}
    better: Solution | None = None
    unsettled = set[Kind]()
    for one in solving.others(instance, solution, within, past):
        if limits.late:
            break
        kind = Kind.REVOLUTIONS if one.plan.turns is not None else Kind.STARTS
        kind = Kind.DURATIONS if instance.tf is None and one.plan.scale != 1.0 and one.plan.turns is None else kind
        kind = Kind.TIMES if one.plan.parts else kind
        kind = kind if kind in costs else Kind.STARTS
        costs[kind].append(one.cost)
        unsettled |= {kind} if one.unsettled else set()
        if one.exact is not None and (better is None or one.exact.objective < better.objective):
            better = one.exact
            if not solution.instance.guess:
                return {kind: own for kind, own in costs.items() if own}, better, unsettled
    for turned in _turned(instance):
        within = replace(within, work=limits.meter.spent + TURNED)
        found = None if limits.late else solving.searched(turned, within)
        costs[Kind.REVOLUTIONS].append(math.nan if found is None else found.objective)
        if found is not None and found.objective < (solution if better is None else better).objective:
            better = found
    if instance.tf is None and math.isfinite(cost := _at_once(solution)):
        costs[Kind.DURATIONS].append(cost)
    return {kind: own for kind, own in costs.items() if own}, better, unsettled


def _angles(instance: Instance) -> list[str]:
    """Return the names of the final angles that count modulo a turn."""
    return [name for name in instance.solver.free_angles if name in instance.final]


def _turned(instance: Instance) -> list[Instance]:
    """Return copies of an instance with one turn less and one more of each final angle that counts modulo a turn."""
    return [shifted(instance, {name: turns}) for name in _angles(instance) for turns in (-1, 1)]


def _at_once(solution: Solution) -> float:
    """Return the cost of a motion of no duration, infinite if the initial state does not meet the final conditions."""
    from satsym.solvers.collocation.scaling import two_point

    lasting = float(solution.times[-1]) - solution.instance.t0
    return two_point(replace(solution.instance, guess=Guess(), free=()), lasting).at_once
