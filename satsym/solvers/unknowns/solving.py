"""Free initial states, a free initial time and free parameters: where the minimum cost with them given is least.

The problem with these given is solved by the instance's method, whatever that is. Its minimum cost has a slope that the
solution itself tells (:mod:`satsym.solvers.certificate.start`); the way down along it is that of
:mod:`satsym.solvers.unknowns.descent`.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Check, Competitors, Kind, Progress, Solution
from satsym.solvers.certificate.scope import with_scope
from satsym.solvers.certificate.start import STATIONARY, Curvature, with_start
from satsym.solvers.failures import tried
from satsym.solvers.improving import starting_from
from satsym.solvers.iteration import MOST_ITERATIONS, Limits, deadline_of, unsolved
from satsym.solvers.search import nearest
from satsym.solvers.unknowns.descent import NOISE, met_beside, minimum_from
from satsym.solvers.unknowns.trials import Late, Solver, Trial, Trials, unit_of
from satsym.status import Status
from satsym.wording import counted

ELSEWHERE = (1.0, -1.0, 3.0, -3.0, 0.3, -0.3)
"""Units by which unknowns are changed, one after the other, where the first guess has no answer."""

EQUAL_COST = 1e-9
"""Relative margin by which another choice may seem cheaper: its own error."""

SLACK = 0.7
"""Share of the room between its bounds that a control is given: what is just reached has no answer nearby."""

WORK = 400_000
"""Unknowns times iterations that the searches may take."""


def solve(instance: Instance, progress: Progress | None, solver: Solver, certified: Solver) -> Solution:
    """Solve an instance that leaves initial states, the initial time or parameters free.

    Parameters
    ----------
    instance
        With numbers to begin with in their place.
    solver
        Of the problem with everything given.
    certified
        The same with a certificate; what it improves on is taken up.

    Raises
    ------
    BadInput
        If neither the cost nor an end depends on one of them.
    """
    began = time.perf_counter()
    units = np.array([unit_of(unknown, instance) for unknown in instance.free])
    trials = Trials(instance, solver, progress, deadline_of(instance), units)
    try:
        found = _solved(trials, certified)
    except Late:
        found = _unanswered(trials, Status.TIME_LIMIT, f"time was up after {trials.count}")
    found = replace(
        found, instance=replace(found.instance, free=instance.free, guess=instance.guess, solver=instance.solver)
    )
    return replace(found, wall_s=time.perf_counter() - began, iterations=max(trials.iterations, found.iterations))


def _solved(trials: Trials, certified: Solver) -> Solution:
    """The search, and the answer with its certificate; once more where the latter knows a cheaper one."""
    instance, here = trials.instance, _begin(trials)
    if isinstance(here, Solution):
        return here
    curvature = Curvature(math.nan)
    for again in (True, False):
        reached = minimum_from(trials, here)
        if isinstance(reached, Solution):
            return reached
        here, curvature = reached
        if here.residual > STATIONARY:
            beside = met_beside(trials, here) or f"has a slope of {here.residual:.0e} still, after {trials.count},"
            return _unanswered(trials, Status.NOT_CONVERGED, f"the minimum cost {beside} at {trials.values(here.at)}")
        chosen = trials.chosen(here.at)
        assert chosen is not None
        final = certified(replace(chosen, guess=instance.guess), trials.progress)
        if not final.status.answered:
            return final
        cheaper = here.cost - final.objective > NOISE * here.size
        if not (cheaper and again):
            break
        trials.instance = replace(instance, guess=starting_from(final).guess)
        moved = trials(here.at)
        here = here if moved is None else moved
    message = f"{final.message}; {trials.values(here.at)} from {trials.count}"
    final = replace(final, message=message, instance=replace(final.instance, free=trials.unknowns))
    if final.certificate is None:
        return final
    others = Competitors(Kind.UNKNOWNS, trials.tried, len(trials.costs), min(trials.costs))
    less = float(max(0.0, final.objective - others.cheapest) / here.size)
    cheaper_by = Check(f"cheaper by: {others.kind.value}", less, EQUAL_COST)
    certificate = with_scope(with_start(final.certificate, final, [*curvature.checks, cheaper_by]), final)
    return replace(final, certificate=replace(certificate, competitors=(*certificate.competitors, others)))


def _begin(trials: Trials) -> Trial | Solution:
    """The first trial that has an answer, with units that fit it."""
    count = len(trials.unknowns)
    here = trials(np.zeros(count))
    if here is None and (arriving := tried(lambda: _reaching(trials))) is not None:
        here = trials(arriving)
    for step in ELSEWHERE:
        for axis in np.eye(count):
            here = here or trials(step * axis)
    if here is None:
        names = ", ".join(unknown.name for unknown in trials.unknowns)
        message = f"no answer with any of {counted(trials.tried, 'choice')} of {names}; give initial guesses"
        return _unanswered(trials, Status.NOT_CONVERGED, message)
    return here


def _unanswered(trials: Trials, status: Status, message: str) -> Solution:
    """No answer, and why."""
    last = trials.last or unsolved(trials.instance, trials.instance.solver.method, 0.0)
    reason = "" if last.status.answered or last.status is status else f": {last.message}"
    return replace(last, status=status, message=message + reason, objective=float("nan"), certificate=None)


def _reaching(trials: Trials) -> Array | None:
    """A choice with which the end can be reached, in units; ``None`` where none was found, or no end is given."""
    instance = trials.instance
    if not instance.final or any(isinstance(value, str) for value in instance.final.values()):
        return None
    found = nearest.reaching(_with_slack(instance), Limits(MOST_ITERATIONS, trials.deadline, work=WORK))
    if found is None:
        return None
    return np.array([one.of(found) - one.of(instance) for one in trials.unknowns]) / trials.unit


def _with_slack(instance: Instance) -> Instance:
    """An instance with less room for its controls."""

    def nearer(bounds: tuple[float, ...]) -> tuple[float, ...]:
        rest = (min(max(0.0, a), b) for a, b in zip(instance.lower, instance.upper, strict=True))
        return tuple(r + SLACK * (v - r) if np.isfinite(v) else v for v, r in zip(bounds, rest, strict=True))

    norms = {name: (low, max(low, SLACK * high)) for name, (low, high) in instance.norms.items()}
    return replace(
        instance,
        lower=nearer(instance.lower),
        upper=nearer(instance.upper),
        max_norm=SLACK * instance.max_norm,
        norms=norms,
    )
