"""Solvers, which know a model by its kernels only: functions of numbers, whatever model these were generated from."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, TypeAlias

from satsym import methods
from satsym.instance import Instance
from satsym.instance.unknowns import Place
from satsym.methods import Method
from satsym.solution import Progress, Simulation, Solution
from satsym.solvers.iteration import TimeUp, deadline_of, hurried
from satsym.status import BadInput, Status, Verdict

if TYPE_CHECKING:
    from satsym.solvers.redundant_ends import Redundant
    from satsym.solvers.simulation.closed_loop import Law

__all__ = ["simulate", "solve"]

QUICK = 150_000
"""Maximum number of points at which equations may be linearised before a direct search is tried."""

Solver: TypeAlias = Callable[[Instance, Progress | None], Solution]


def solve(instance: Instance, progress: Progress | None = None, *, examined: bool = True) -> Solution:
    """Solve an instance by the method it names and certify the answer.

    By default the method is collocation, or exact arcs if controls switch between their bounds; collocation again if
    vectors might switch but have their full norms all the time. If collocation finds an extremal that is not accurate
    enough, multiple shooting is tried. If it finds nothing and no final state is given, the forward-backward sweep is
    tried. The sweep is only as accurate as its steps; a certificate requires more, so its answers have none.

    Parameters
    ----------
    instance
        What to solve, in the model's units.
    progress
        Called after each iteration.
    examined
        Whether the answer is certified, and replaced by a cheaper one if the certificate finds one.

    Raises
    ------
    BadInput
        If the model has no cost, or no method here can solve such an instance.
    """
    spec, name = instance.model.spec, instance.solver.method
    if not spec.has_cost:
        raise BadInput(f"{instance.called}: model {spec.name} has no cost, so there is nothing to solve; try simulate")
    if refusal := methods.refusal(name, instance):
        raise BadInput(f"{instance.called}: {refusal}")
    if spec.in_arcs and (parameters := [one for one in instance.free if one.place is Place.PARAMETER]):
        key, beside = parameters[0].key, "waypoints" if spec.interior else "path constraints"
        raise BadInput(f'{instance.called}: {key}: "free" cannot be combined with {beside}; give a number')
    found = partial(_with_free, examined=examined)
    return _solved_in_steps(instance, progress, found) if instance.continuation else found(instance, progress)


def _solved_in_steps(instance: Instance, progress: Progress | None, last: Solver) -> Solution:
    """Solve an instance by continuation."""
    from satsym.solvers import continued

    quick = _with_free if instance.free else _uncertified
    return continued.solve(instance, progress, quick, last)


def _with_free(instance: Instance, progress: Progress | None, examined: bool = True) -> Solution:
    """Solve an instance and, if other quantities than its end are free, minimise the cost over these."""
    found = partial(_found, examined=examined)
    if instance.end_limits:
        from satsym.solvers import end_limits

        return end_limits.solve(instance, progress, partial(_found, examined=False), found)
    if not instance.free:
        return found(instance, progress)
    from satsym.solvers.certificate import free_start
    from satsym.solvers.search import solving as search
    from satsym.solvers.unknowns import solving

    searched = instance.solver.method == methods.AUTO and search.applies(instance)
    if not (examined and searched and free_start.tells(instance)):
        found = partial(solving.solve, solver=_uncertified, certified=found)
        return _with_search(found, instance, progress, examined) if searched else found(instance, progress)
    from satsym.solvers.improving import improved

    def quickly(one: Instance, watching: Progress | None) -> Solution:
        descended = partial(solving.solve, solver=_uncertified, certified=partial(_found, examined=False))
        return descended(one, watching) if one.guess else _with_search(descended, one, watching, examined=False)

    return improved(quickly, instance, progress)


def _with_search(solver: Solver, instance: Instance, progress: Progress | None, examined: bool) -> Solution:
    """Return the solution of a solver with limited work for free quantities, otherwise that of a direct search."""
    from satsym.solvers import by_search

    deadline = deadline_of(instance)
    solution = solver(replace(instance, work=min(QUICK, instance.work)), progress)
    solution = replace(solution, instance=replace(solution.instance, work=instance.work))
    at_minimum = partial(_at_minimum, instance=instance, solver=solver, progress=progress)
    if solution.status.answered:
        return at_minimum(by_search.cheaper(instance, solution, deadline)) or solution if examined else solution
    if solution.status not in (Status.NOT_CONVERGED, Status.TIME_LIMIT):
        return solution
    left = hurried(instance, deadline)
    found = None if left is None else by_search.instead(left, progress, examined)
    found = None if found is None else at_minimum(found)
    if found is not None:
        left = hurried(instance, deadline)
        found = found if left is None or not examined else _resolved(found, solver, left, progress)
        found = replace(_in_full(found, instance), wall_s=found.wall_s + solution.wall_s)
        return at_minimum(by_search.cheaper(instance, found, deadline)) or found if examined else found
    left = hurried(instance, deadline) if solution.status is Status.TIME_LIMIT else None
    return solution if left is None else _in_full(solver(left, progress), instance)


def _at_minimum(found: Solution, instance: Instance, solver: Solver, progress: Progress | None) -> Solution | None:
    """Return what a search found, solved again if the free initial states still have the values of a coarse mesh.

    ``None`` if no minimum is found near these values.
    """
    if not instance.free or found.instance.free:
        return found
    again = solver(replace(instance, initial=found.instance.initial), progress)
    again = replace(again, instance=replace(again.instance, work=instance.work))
    return again if again.status.answered and again.objective <= found.objective else None


def _resolved(found: Solution, solver: Solver, instance: Instance, progress: Progress | None) -> Solution:
    """Return the extremal of a search, solved again for free quantities if that certifies it, else unchanged."""
    from satsym.solvers.improving import starting_from

    if found.certificate is None or found.certificate.verdict is Verdict.CERTIFIED:
        return found
    again = solver(replace(starting_from(found), solver=instance.solver, work=instance.work), progress)
    better = again.certificate is not None and again.certificate.verdict is Verdict.CERTIFIED
    if not better or not again.objective <= found.objective + 1e-9 * abs(found.objective):
        return found
    return replace(again, instance=replace(again.instance, guess=instance.guess, work=instance.work))


def _in_full(found: Solution, instance: Instance) -> Solution:
    """Return a solution whose instance has the options of the original problem, not the remaining time limit."""
    return replace(found, instance=replace(found.instance, solver=instance.solver))


def _uncertified(instance: Instance, progress: Progress | None) -> Solution:
    """Solve an instance by its method alone, without a certificate."""
    return _in_time(_named(instance))(instance, progress)


def _named(instance: Instance) -> Method:
    """Return the method that an instance names, or the automatic one for its model."""
    name = instance.solver.method
    return methods.automatic(instance.model.spec) if name == methods.AUTO else methods.METHODS[name]


def _found(instance: Instance, progress: Progress | None, examined: bool = True) -> Solution:
    """Solve an instance, leaving out a final state that follows from the others by a conserved quantity."""
    from satsym.solvers import iteration
    from satsym.solvers.conserved import contradiction
    from satsym.solvers.redundant_ends import redundant

    began = time.perf_counter()
    less = redundant(instance)
    if less is None:
        return _by_method(instance, progress, examined)
    if why := contradiction(instance):
        nothing = iteration.unsolved(instance, _named(instance).name, time.perf_counter() - began)
        return replace(nothing, status=Status.INFEASIBLE, message=why)
    solution = _by_method(less.instance, progress, examined)
    if not less.met(solution) and not instance.model.spec.switching:
        again = _by_method(less.towards, progress, examined, instance)
        solution = again if again.status.answered else solution
    if solution.status.answered and not less.met(solution):
        less, solution = _beside(less, solution, progress, examined, instance)
    if not solution.status.answered or less.met(solution):
        return replace(solution, message=f"{solution.message}; {less.note}")
    nothing = iteration.unsolved(instance, solution.method, solution.wall_s)
    return replace(nothing, status=Status.NOT_CONVERGED, message=less.missed(solution))


def _beside(
    less: Redundant, found: Solution, progress: Progress | None, examined: bool, asked: Instance
) -> tuple[Redundant, Solution]:
    """Return the solution with another final state left out that ends as required; otherwise the given solution."""
    for other in less.others:
        solution = _by_method(other.instance, progress, examined, asked)
        if other.met(solution):
            return other, solution
    return less, found


def _by_method(
    instance: Instance, progress: Progress | None, examined: bool, asked: Instance | None = None
) -> Solution:
    """Solve an instance by its method or, if that fails, by multiple shooting or the sweep in the remaining time.

    Parameters
    ----------
    asked
        The problem whose conditions competitors have to meet, if it has more final conditions than the instance.
    """
    method, deadline = _named(instance), deadline_of(instance)
    automatic = instance.solver.method == methods.AUTO
    solution = _solved(method, instance, progress, examined, asked)
    if not automatic or solution.status is not Status.NOT_CONVERGED:
        return solution
    left = hurried(instance, deadline)
    if left and method.name == "collocation" and _nearly(solution) and not methods.refusal("shooting", instance):
        shot = _solved(methods.METHODS["shooting"], left, progress, examined)
        if shot.status.answered and not _refuted(shot):
            return replace(_in_full(shot, instance), message=f"{shot.message}; by collocation: {solution.message}")
        left = hurried(instance, deadline)
    if left and not methods.refusal(methods.SWEEP.name, instance):
        return _in_full(_confirmed(_solved(methods.SWEEP, left, progress), method, progress, deadline), instance)
    return solution


def _refuted(solution: Solution) -> bool:
    """Return whether a solution has a certificate that refutes it."""
    return solution.certificate is not None and solution.certificate.verdict is Verdict.FAILED


def _nearly(solution: Solution) -> bool:
    """Return whether a solver found an extremal that is not accurate enough to be an answer."""
    return solution.status is Status.NOT_CONVERGED and not any(
        math.isnan(value) for value in solution.x[:, -1].tolist()
    )


def _solved(
    method: Method,
    instance: Instance,
    progress: Progress | None,
    examined: bool = True,
    asked: Instance | None = None,
) -> Solution:
    """Solve an instance by a method, with a certificate if the method has one and it is required."""
    solver = _in_time(method)
    if not (method.certified and examined):
        return solver(instance, progress)
    from satsym.solvers.improving import improved

    return improved(solver, instance, progress, asked)


def _confirmed(swept: Solution, method: Method, progress: Progress | None, deadline: float) -> Solution:
    """Return the certified solution near a result of the sweep, or no answer if none is confirmed there."""
    from satsym.solvers.improving import starting_from

    if not swept.status.answered or not swept.lam.any():
        return swept
    left = hurried(starting_from(swept), deadline)
    if left is None:
        late = "the time limit was reached before the result of the sweep was confirmed"
        return replace(swept, status=Status.TIME_LIMIT, message=late)
    again = _solved(method, left, progress)
    if again.status.answered or again.status is Status.NO_MINIMISER:
        return replace(again, instance=swept.instance)
    message = f"{swept.message}, at the cost {swept.objective:.6g}, but {method.name} confirms no extremal there"
    return replace(swept, status=Status.NOT_CONVERGED, message=message)


def _in_time(method: Method) -> Solver:
    """Return the solver of a method, loading no other method; it returns no trajectory if the time limit is reached."""
    module, _, function = method.solver.partition(":")
    solver: Solver = getattr(import_module(module), function)

    def solved(instance: Instance, progress: Progress | None) -> Solution:
        began = time.perf_counter()
        try:
            if instance.solver.free_angles:
                from satsym.solvers.revolutions import with_cheapest_turns

                return with_cheapest_turns(solver, instance, progress)
            return solver(instance, progress)
        except TimeUp:
            from satsym.solvers import iteration

            return iteration.unsolved(instance, method.name, time.perf_counter() - began)

    return solved


def simulate(instance: Instance, law: Law | None = None) -> Simulation:
    """Simulate an instance under a control law; see :func:`satsym.solvers.simulation.simulating.simulate`."""
    from satsym.solvers.simulation import simulating

    instance.require_numbers()
    return simulating.simulate(instance, law)
