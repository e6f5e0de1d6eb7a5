"""Free initial states, a free initial time and free parameters: minimisation of the minimum cost over their values.

For given values the problem is solved by the instance's own method. The derivative of its minimum cost follows from the
solution (:mod:`satsym.solvers.certificate.start`); a trust-region method descends along it. Symmetric rank-one updates
can represent negative curvature; differences of derivatives at the end show whether the point is a minimum or a saddle
point, which is left in both directions.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Check, Competitors, Kind, Progress, Solution
from satsym.solvers.certificate.free_start import second_derivative
from satsym.solvers.certificate.scope import with_scope
from satsym.solvers.certificate.start import FLAT, STATIONARY, STILL, Curvature, softest, with_start
from satsym.solvers.failures import tried
from satsym.solvers.improving import starting_from, without_minimiser
from satsym.solvers.iteration import MOST_ITERATIONS, Limits, deadline_of, unsolved
from satsym.solvers.search import nearest
from satsym.solvers.unknowns.trials import Late, Solver, Trial, Trials, unit_of
from satsym.status import BadInput, Status
from satsym.wording import counted

ELSEWHERE = (1.0, -1.0, 3.0, -3.0, 0.3, -0.3)
"""Changes of each free quantity, relative to its scale, that are tried in turn if the initial guess has no solution."""

EQUAL_COST = 1e-9
"""Relative difference of costs that is within their error. Values of the free quantities that save less are no
better."""

SLACK = 0.7
"""Factor by which the ranges of controls are reduced in the search for first values of the free quantities. Values that
need the full ranges may have no solutions nearby."""

WORK = 400_000
"""Maximum work of the searches for first values of the free quantities, in unknowns times iterations."""

SETTLED_SLOPE = 1e-11
"""Relative derivative of the minimum cost at which the iteration has converged."""

ITERATIONS, POLISHING, DEPARTURES = 60, 4, 3
"""Maximum numbers of steps of the trust-region method, of final Newton steps, and of saddle points that are left."""

FIRST = 0.05
"""First change of each free quantity, relative to its scale, which shows how strongly the cost depends on it."""

NEAR_UNITS = 1e-3
"""Change of each free quantity, relative to its scale, in the finite differences for the curvature."""

FAR_UNITS = 1e5
"""Change of a free quantity, relative to its scale, beyond which a cost that still falls counts as unbounded below."""

SMALLEST_RADIUS = 1e-10
"""Radius of the trust region, relative to the scales of the free quantities, below which the iteration ends."""

IDLE = 1e-9
"""Relative derivative and change of the cost below which the cost does not depend on an unknown."""

NOISE = 1e-10
"""Relative difference of costs that two solutions may have by numerical error."""

AGREEMENT = 0.05
"""Relative difference between curvatures from costs and from derivatives above which the curvature counts as
unknown."""


def solve(instance: Instance, progress: Progress | None, solver: Solver, certified: Solver) -> Solution:
    """Solve an instance with free initial states, a free initial time or free parameters.

    Parameters
    ----------
    instance
        Instance with initial guesses of these quantities.
    solver
        Solver of the problem with all of them given.
    certified
        The same solver with certificates; a cheaper competitor that it finds is used.

    Raises
    ------
    BadInput
        If neither the cost nor the end conditions depend on one of these quantities.
    """
    began = time.perf_counter()
    units = np.array([unit_of(unknown, instance) for unknown in instance.free])
    trials = Trials(instance, solver, progress, deadline_of(instance), units)
    try:
        found = _solved(trials, certified)
    except Late:
        found = _unanswered(trials, Status.TIME_LIMIT, f"time limit reached after {trials.count}")
    found = replace(
        found, instance=replace(found.instance, free=instance.free, guess=instance.guess, solver=instance.solver)
    )
    return replace(found, wall_s=time.perf_counter() - began, iterations=max(trials.iterations, found.iterations))


def _solved(trials: Trials, certified: Solver) -> Solution:
    """Return the answer with its certificate; repeat the search once if the certificate's answer is cheaper."""
    instance, here = trials.instance, _begin(trials)
    if isinstance(here, Solution):
        return here
    curvature = Curvature(math.nan)
    for again in (True, False):
        reached = _minimum_from(trials, here)
        if isinstance(reached, Solution):
            return reached
        here, curvature = reached
        if here.residual > STATIONARY:
            beside = _met_beside(trials, here) or f"has a slope of {here.residual:.0e} still, after {trials.count},"
            return _unanswered(trials, Status.NOT_CONVERGED, f"the minimum cost {beside} at {trials.values(here.at)}")
        chosen = trials.chosen(here.at)
        assert chosen is not None
        final = certified(replace(chosen, guess=instance.guess), trials.progress)
        if not final.status.answered:
            return final
        cheaper = here.cost - final.objective > NOISE * here.size
        if not (cheaper and again):
            break
        trials.instance, trials.last = replace(instance, guess=starting_from(final).guess), final
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
    """Return the first trial that has a solution, or a solution without an answer if none has."""
    count = len(trials.unknowns)
    here = trials(np.zeros(count))
    if here is None and (arriving := tried(lambda: _reaching(trials))) is not None:
        here = trials(arriving)
    for step in ELSEWHERE:
        for axis in np.eye(count):
            here = here or trials(step * axis)
    if here is None:
        names = ", ".join(unknown.name for unknown in trials.unknowns)
        message = f"no solution with any of {counted(trials.tried, 'choice')} of {names}; give initial guesses"
        return _unanswered(trials, Status.NOT_CONVERGED, message)
    return here


def _unanswered(trials: Trials, status: Status, message: str) -> Solution:
    """Return a solution without an answer, with the reason in its message."""
    last = trials.last or unsolved(trials.instance, trials.instance.solver.method, 0.0)
    reason = "" if last.status.answered or last.status is status else f": {last.message}"
    return replace(last, status=status, message=message + reason, objective=float("nan"), certificate=None)


def _reaching(trials: Trials) -> Array | None:
    """Return scaled values of the free quantities for which the end can be reached; ``None`` if none are found."""
    instance = trials.instance
    if not instance.final or any(isinstance(value, str) for value in instance.final.values()):
        return None
    found = nearest.reaching(_with_slack(instance), Limits(MOST_ITERATIONS, trials.deadline, work=WORK))
    if found is None:
        return None
    return np.array([one.of(found) - one.of(instance) for one in trials.unknowns]) / trials.unit


def _with_slack(instance: Instance) -> Instance:
    """Return an instance with reduced ranges of its controls."""

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


def _minimum_from(trials: Trials, here: Trial) -> tuple[Trial, Curvature] | Solution:
    """Descend from a trial to a minimum of the minimum cost.

    Returns the trial there with the curvature of the minimum cost, or a solution without an answer.
    """
    form = _first_form(trials, here)
    for _ in range(DEPARTURES):
        descended = _descended(trials, here, form)
        if isinstance(descended, Solution):
            return descended
        here = descended
        if here.residual > STATIONARY:
            return here, Curvature(math.nan)
        form, believed = _form(trials, here)
        here = _polished(trials, here, form)
        least, direction = softest(form, STILL * here.size)
        if not believed or not least < -FLAT:
            return here, Curvature(least if believed else math.nan)
        beside = [trials(here.at + sign * share * direction) for share in (0.1, 0.5) for sign in (1.0, -1.0)]
        lower = [one for one in beside if one is not None and one.cost < here.cost]
        if not lower:
            break
        here = min(lower, key=lambda one: one.cost)
    return here, Curvature(least)


def _descended(trials: Trials, here: Trial, form: Array) -> Trial | Solution:
    """Descend by the trust-region method, and return the last trial or a solution without an answer."""
    radius, start = 1.0, here.at
    for _ in range(ITERATIONS):
        if here.residual <= SETTLED_SLOPE or radius < SMALLEST_RADIUS:
            break
        step = _step(form, here.slope, radius)
        new = trials(here.at + step)
        length = float(np.linalg.norm(step))
        if new is None:
            radius = length / 4.0
            continue
        form = _updated(form, step, new.slope - here.slope)
        change, expected = new.cost - here.cost, float(here.slope @ step + step @ form @ step / 2.0)
        drowned = abs(change) <= NOISE * here.size
        if new.residual < here.residual if drowned else change < 0.0:
            if not drowned and length > 0.8 * radius and change < 0.5 * expected:
                radius *= 2.5
            here = new
            if float(np.abs(here.at - start).max()) > FAR_UNITS:
                message = f"the cost decreases without bound; it is {here.cost:.4g} with {trials.values(here.at)}"
                return without_minimiser(here.solution, f"{message}; give numbers, or weigh them in the cost")
        elif drowned:
            break
        else:
            radius = length / 4.0
    return here


def _first_form(trials: Trials, here: Trial) -> Array:
    """Return second derivatives by first differences; raise an error if the cost does not depend on an unknown."""
    count = len(here.at)
    form, idle = np.diag(np.maximum(np.abs(here.slope), NOISE * here.size)), []
    for k, axis in enumerate(np.eye(count)):
        for step in (FIRST, -FIRST):
            beside = trials(here.at + step * axis)
            if beside is not None:
                form[:, k] = (beside.slope - here.slope) / step
                most = max(abs(here.slope[k]), abs(beside.slope[k]), abs(beside.cost - here.cost))
                still = most <= IDLE * here.size
                idle += [trials.unknowns[k]] if still else []
                break
    for unknown in idle:
        reason = "neither the cost nor the final conditions depend on it; give it a number"
        raise BadInput(f'{trials.instance.called}: {unknown.key}: "free", but {reason}')
    return np.asarray((form + form.T) / 2.0)


def _form(trials: Trials, here: Trial) -> tuple[Array, bool]:
    """Return second derivatives of the minimum cost, and whether they are reliable.

    With respect to initial states they follow from neighbouring extremals. Others are central differences of first
    derivatives, which count as reliable if differences of costs agree with them.
    """
    exact = second_derivative(replace(here.solution, instance=replace(here.solution.instance, free=trials.unknowns)))
    if exact is not None:
        return exact * np.outer(trials.unit, trials.unit), True
    count = len(here.at)
    form, by_costs = np.zeros((count, count)), np.zeros(count)
    for k, axis in enumerate(np.eye(count)):
        ahead, behind = trials(here.at + NEAR_UNITS * axis), trials(here.at - NEAR_UNITS * axis)
        if ahead is None or behind is None:
            return np.eye(count), False
        form[:, k] = (ahead.slope - behind.slope) / (2.0 * NEAR_UNITS)
        by_costs[k] = (ahead.cost - 2.0 * here.cost + behind.cost) / NEAR_UNITS**2
    own = np.diag(form)
    blurred = 4.0 * NOISE * here.size / NEAR_UNITS**2
    believed = bool((np.abs(by_costs - own) <= AGREEMENT * np.abs(own) + blurred).all())
    return (form + form.T) / 2.0, believed


def _polished(trials: Trials, here: Trial, form: Array) -> Trial:
    """Improve a trial by Newton's method with the computed second derivatives."""
    for _ in range(POLISHING):
        if here.residual <= SETTLED_SLOPE or softest(form, STILL * here.size)[0] <= FLAT:
            break
        new = trials(here.at - np.linalg.solve(form, here.slope))
        if new is None or not new.residual < here.residual:
            break
        here = new
    return here


def _step(form: Array, slopes: Array, radius: float) -> Array:
    """Return the minimiser of the quadratic model within the trust region."""
    values, axes = np.linalg.eigh(form)
    along = axes.T @ slopes
    if values[0] > 0.0:
        newton = -along / values
        if np.linalg.norm(newton) <= radius:
            return np.asarray(axes @ newton)

    def length(shift: float) -> float:
        return float(np.linalg.norm(along / (values + shift)))

    low = max(0.0, -float(values[0])) * (1.0 + 1e-12) + 1e-300
    high = low + max(float(np.linalg.norm(along)) / radius, 1e-300)
    for _ in range(200):
        middle = (low + high) / 2.0
        low, high = (middle, high) if length(middle) > radius else (low, middle)
    found = -along / (values + high)
    size = float(np.linalg.norm(found))
    return np.asarray(axes @ found) * min(1.0, radius / size if size > 0.0 else 1.0)


def _updated(form: Array, step: Array, change: Array) -> Array:
    """Return the second derivatives after a symmetric rank-one update, which may be indefinite."""
    missing = change - form @ step
    weight = float(missing @ step)
    if abs(weight) <= 1e-8 * float(np.linalg.norm(missing) * np.linalg.norm(step)):
        return form
    return np.asarray(form + np.outer(missing, missing) / weight)


def _met_beside(trials: Trials, here: Trial) -> str | None:
    """Return why the derivative of the minimum cost does not vanish although no step decreases it, or ``None``."""
    length = max(float(np.linalg.norm(here.slope)), 1e-300)
    beside = [trials(here.at + sign * NEAR_UNITS * here.slope / length) for sign in (1.0, -1.0)]
    if beside[1] is None:
        return "decreases towards the limit of the values that have a solution,"
    if all(one is None or one.cost > here.cost for one in beside):
        return "has a corner, where costates are not unique,"
    return None
