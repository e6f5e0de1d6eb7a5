"""One instance at a time: returns to the orbit from all around, their certificates, and CasADi with Ipopt.

Each round has instances of its own, a few at a time as one solves again and again, which all are given shortly after
one another.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any
from unittest.mock import patch

import numpy as np
from ends import DEGREE, INTERVALS, program
from msgspec import structs
from rows import Goal, Row, Table
from timing import Samples, interleaved

COUNT, CERTIFIED, BLOCK = 100, 60, 5
"""Instances that are solved, those of them that are certified, and how many at a time."""


def single(cases: Sequence[Any]) -> list[Table]:
    """Solutions, each from the last answer or from a straight line; and what certificates cost beside them."""
    from satsym import instance
    from satsym.solvers import solve
    from satsym.solvers.repeated import Repeated

    warm, cold, alone = "satsym, numba, from the last answer", "satsym, NumPy, all of solve", "CasADi, Ipopt, warm"
    coarse = "  at as many points of time as CasADi's program has"
    loop, repeated = program(), Repeated(instance.load("return-to-orbit"), compiled=True)
    found = _in_turn(
        {
            warm: lambda case: repeated.solve(initial=case.initial),
            cold: lambda case: solve(case, examined=False),
            coarse: lambda case: solve(_coarse(case), examined=False),
            alone: lambda case: loop(np.array(case.initial)),
        },
        cases,
    )
    goals = {
        warm: (Goal("milliseconds", found[warm].middle * 1e3, 1.0),),
        cold: (Goal("times faster than Ipopt", found[alone].times(found[cold]), 1.5, True),),
    }
    made = [
        Row(name, one.least * 1e3, one.middle * 1e3, one.times(found[cold]), goals.get(name, ()))
        for name, one in found.items()
    ]
    title = f"10. One instance at a time, {len(cases)} returns to the orbit"
    return [Table(title, "milliseconds", tuple(made)), _certified(cases[:CERTIFIED])]


def _coarse(case: Any) -> Any:
    """The same at as many points of time as CasADi's program has; it answers at a thousand as it stands."""
    return replace(case, solver=structs.replace(case.solver, steps=DEGREE * INTERVALS))


def _certified(cases: Sequence[Any]) -> Table:
    """What the parts of a certificate take."""
    from satsym.solvers import solve
    from satsym.solvers.certificate.competitors import comparing
    from satsym.solvers.certificate.jacobi import conjugate
    from satsym.solvers.certificate.kernel_consistency import with_kernels_examined
    from satsym.solvers.certificate.reintegration.segments import segments
    from satsym.solvers.certificate.verdict import certify
    from satsym.solvers.iteration import MOST_ITERATIONS, Limits

    answers = [solve(case, examined=False) for case in cases]
    answers = [one for one in answers if one.status.answered]
    counts: dict[int, int] = {}

    def compared(answer: Any) -> None:
        comparison = comparing.compared(answer, Limits(MOST_ITERATIONS, time.perf_counter() + 60.0))
        counts[id(answer)] = sum(kind.summary.tried for kind in comparison.kinds)

    def examined(answer: Any) -> None:
        with_kernels_examined(blank, answer)

    def jacobi(answer: Any) -> None:
        conjugate(answer, segments(answer))

    blank = certify(answers[0], compared=False)
    solving, measured, each = "all of solve", "conditions, Jacobi's among them", "each competitor"
    found = _in_turn(
        {
            solving: lambda answer: solve(replace(answer.instance), examined=False),
            measured: lambda answer: certify(answer, compared=False),
            "  of that Jacobi's condition": jacobi,
            "  whether kernels contradict each other": examined,
            each: compared,
        },
        answers,
    )
    of_all = sum(counts.values())
    found[each] = Samples(tuple(seconds * len(answers) / of_all for seconds in found[each].seconds))
    # what Newton's method takes is a number of linear systems, whoever asks for it: from far off there are more
    systems = "{:.1f} linear systems"
    notes = {
        solving: systems.format(_systems(lambda: [solve(one, examined=False) for one in cases]) / len(cases)),
        each: systems.format(_systems(lambda: [compared(one) for one in answers]) / of_all),
    }
    goals = {
        measured: (Goal("of a solution", found[measured].times(found[solving]), 5.0),),
        each: (Goal("of a solution", found[each].times(found[solving]), 1.5),),
    }
    made = [
        Row(
            name, one.least * 1e3, one.middle * 1e3, one.times(found[solving]), goals.get(name, ()), notes.get(name, "")
        )
        for name, one in found.items()
    ]
    return Table("11. Their certificates", "milliseconds", tuple(made))


def _systems(action: Callable[[], object]) -> int:
    """Linear systems of collocation that are factored meanwhile."""
    from satsym.solvers.collocation.linearised import Linearised

    made: list[Linearised] = []
    own = Linearised.__init__

    def counted(self: Linearised, *given: Any) -> None:
        made.append(self)
        own(self, *given)

    with patch.object(Linearised, "__init__", counted):
        action()
    return len(made)


def _in_turn(calls: dict[str, Callable[[Any], object]], given: Sequence[Any]) -> dict[str, Samples]:
    """Seconds for one of what is given: rounds of so many at a time, after one call that counts for nothing."""
    blocks = [given[at : at + BLOCK] for at in range(0, len(given), BLOCK)]

    def over(call: Callable[[Any], object]) -> Callable[[], object]:
        call(given[-1])
        ahead = iter(blocks)
        return lambda: [call(one) for one in next(ahead)]

    found = interleaved({name: over(call) for name, call in calls.items()}, len(blocks), least=0.0)
    sizes = [len(block) for block in blocks]
    return {
        name: Samples(tuple(seconds / size for seconds, size in zip(one.seconds, sizes, strict=True)))
        for name, one in found.items()
    }
