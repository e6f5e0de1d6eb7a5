"""Exact arcs of throttled vectors, as less and less smoothing shows them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from satsym.instance import Instance
from satsym.solvers.cold_start.directions import fraction_between, levels, stopped
from satsym.solvers.cold_start.origin import Start
from satsym.solvers.collocation.curve import Curve
from satsym.solvers.collocation.extremal import Extremal
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.attempt import Exact, Origin, attempt
from satsym.solvers.switching.cold_start.concentrated import concentrated, from_the_start
from satsym.solvers.switching.cold_start.recognition import guess, sample
from satsym.spec import ProblemSpec

SWITCHED = 0.35
"""Share of the time at most for which norms are far from their bounds where a structure is to be recognised."""

LASTING, STEADY = 0.02, 0.5
"""Such a share, and what is left of it where less is smoothed, where that time is no switch: those get as much shorter
as less is smoothed."""


def arcs(problem: TwoPoint, instance: Instance, curve: Curve, _start: Start, limits: Limits) -> Exact | Extremal:
    """Exact arcs as smoothed extremals show them, the first that satisfy the minimum principle."""
    shares: list[float] = []
    for near in levels(problem, instance, curve, limits):
        problem, curve = near
        shares.append(fraction_between(problem, curve))
        if shares[-1] <= SWITCHED:
            seen = sample(problem, curve)
            first = guess(instance, seen)
            short = concentrated(instance, seen, first)
            for one in filter(None, (short, from_the_start(instance, short), first)):
                exact = attempt(instance, one, limits)
                if exact is not None:
                    return replace(exact, origin=Origin.SMOOTHED, smoothing=problem.control_set.smoothing)
        if limits.expired:
            break
    message = "no structure recognised in regularised solutions satisfies Pontryagin's minimum principle"
    if shares[-1] > SWITCHED or _steady(shares):
        message = f"for some time nothing decides {_undecided(instance.model.spec)}, and no law is known there"
    return stopped(problem, instance, curve, message, limits)


def _undecided(spec: ProblemSpec) -> str:
    """What is neither at its least nor at its largest for some time, as far as the kinds of sets tell."""
    single = [c for part in spec.control_parts if part.branch == "switched" for c in part.controls]
    if single and all(part.branch != "throttled" for part in spec.control_parts):
        return f"the value of {' or '.join(single)}"
    return "the value of a control" if single else "the norm of a vector"


def _steady(shares: Sequence[float]) -> bool:
    """Whether norms stay far from their bounds for some time, however little is smoothed."""
    return len(shares) > 1 and shares[-1] > LASTING and shares[-1] >= STEADY * shares[-2]
