"""One instance at a time: returns to the orbit from all around, their certificates, and CasADi with Ipopt.

Each round has an instance of its own, which all are given shortly after one another.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import cycle
from typing import Any

import numpy as np
from ends import program
from rows import Goal, Row, Table
from timing import Samples, interleaved

ROUNDS, CERTIFIED = 60, 20
"""Instances that are solved, and those of them that are certified."""


def single(cases: Sequence[Any]) -> list[Table]:
    """Solutions, each from the last answer or from a straight line; and what certificates cost beside them."""
    from satsym import instance
    from satsym.solvers import solve
    from satsym.solvers.repeated import Repeated

    warm, cold, alone = "satsym, numba, from the last answer", "satsym, NumPy, all of solve", "CasADi, Ipopt, warm"
    loop, repeated = program(), Repeated(instance.load("return-to-orbit"), compiled=True)
    found = _in_turn(
        {
            warm: lambda case: repeated.solve(initial=case.initial),
            cold: lambda case: solve(case, examined=False),
            alone: lambda case: loop(np.array(case.initial)),
        },
        cases[:ROUNDS],
    )
    goals = {
        warm: (Goal("milliseconds", found[warm].middle * 1e3, 1.0),),
        cold: (Goal("times faster than Ipopt", found[alone].times(found[cold]), 1.5, True),),
    }
    made = [
        Row(name, one.least * 1e3, one.middle * 1e3, one.times(found[cold]), goals.get(name, ()))
        for name, one in found.items()
    ]
    title = f"10. One instance at a time, {ROUNDS} returns to the orbit"
    return [Table(title, "milliseconds", tuple(made)), _certified(cases[:CERTIFIED])]


def _certified(cases: Sequence[Any]) -> Table:
    """What the parts of a certificate take."""
    from satsym.solvers import solve
    from satsym.solvers.certificate import competitors
    from satsym.solvers.certificate.verdict import certify

    answers = [solve(case, examined=False) for case in cases]
    answers = [one for one in answers if one.status.answered]
    counts: list[int] = []

    def compared(answer: Any) -> None:
        comparison = competitors.compared(answer, time.perf_counter() + 60.0)
        counts.append(sum(kind.summary.tried for kind in comparison.kinds))

    solving, measured, each = "all of solve", "conditions, Jacobi's and neighbours", "each competitor"
    found = _in_turn(
        {
            solving: lambda answer: solve(replace(answer.instance), examined=False),
            measured: lambda answer: certify(answer, compared=False),
            each: compared,
        },
        answers,
    )
    tried = counts[-len(answers) :]
    shares = tuple(seconds / count for seconds, count in zip(found[each].seconds, tried, strict=True))
    found[each] = Samples(shares)
    goals = {
        measured: (Goal("of a solution", found[measured].times(found[solving]), 5.0),),
        each: (Goal("of a solution", found[each].times(found[solving]), 1.5),),
    }
    made = [
        Row(name, one.least * 1e3, one.middle * 1e3, one.times(found[solving]), goals.get(name, ()))
        for name, one in found.items()
    ]
    return Table("11. Their certificates", "milliseconds", tuple(made))


def _in_turn(calls: dict[str, Callable[[Any], object]], given: Sequence[Any]) -> dict[str, Samples]:
    """One round for each of what is given, after one that counts for nothing."""

    def over(call: Callable[[Any], object]) -> Callable[[], object]:
        call(given[-1])
        ahead = cycle(given)
        return lambda: call(next(ahead))

    return interleaved({name: over(call) for name, call in calls.items()}, len(given), least=0.0)
