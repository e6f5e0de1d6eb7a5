"""Solvers. They see kernels only: functions of numbers, whatever model these came from."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

from satsym.instance import Instance
from satsym.solution import Flight, Progress, Solution
from satsym.solvers.iteration import TimeUp
from satsym.status import BadInput, Status

if TYPE_CHECKING:
    from satsym.solvers.simulation.closed_loop import Law

__all__ = ["simulate", "solve"]

Solver: TypeAlias = Callable[[Instance, Progress | None], Solution]

METHODS = ("sweep", "collocation", "shooting", "linear", "bang-bang")
"""What is available of what an instance may name."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by the method it names and certify the answer.

    By default that is collocation, or exact arcs where controls switch between their bounds. Where collocation
    finds nothing and no final state is given, the sweep is tried as well. The sweep is as accurate as its steps
    allow; a certificate asks for more, so its answers have none.

    Parameters
    ----------
    instance
        What to solve, in the model's units.
    progress
        Called after each iteration.

    Raises
    ------
    BadInput
        If the model has no cost, or no method here can solve such an instance.
    """
    spec, method = instance.model.spec, instance.solver.method
    if not spec.has_cost:
        raise BadInput(f"{instance.name}: model {spec.name} has no cost, so there is nothing to solve; try simulate")
    if method not in ("auto", *METHODS):
        available = " or ".join(f'"{name}"' for name in ("auto", *METHODS))
        raise BadInput(f'{instance.name}: solver.method: "{method}" is not available; use {available}')
    if spec.switching != (method == "bang-bang") and method != "auto":
        raise BadInput(f"{instance.name}: solver.method: {_unfit(spec.switching, method)}")
    if method == "sweep" and instance.tf is None:
        raise BadInput(f'{instance.name}: time.tf: a free final time cannot be swept for; use method "collocation"')
    if method == "sweep" and instance.final:
        given = ", ".join(instance.final)
        raise BadInput(
            f"{instance.name}: a given final {given} cannot be swept for; leave it free and weigh its error in the "
            'terminal cost, or use method "collocation"'
        )
    if method == "sweep" and spec.multipliers:
        raise BadInput(
            f'{instance.name}: terminal constraints of {spec.name} cannot be swept for; use method "collocation"'
        )
    if method == "sweep":
        return _swept(instance, progress)
    from satsym.solvers.improving import improved

    if method == "auto" and spec.switching:
        method = "bang-bang"
    solution = improved(_in_time(_solver(method), method), instance, progress)
    swept = not instance.final and instance.tf is not None and not spec.multipliers
    if method == "auto" and solution.status is Status.NOT_CONVERGED and swept:
        return _confirmed(_swept(instance, progress), progress)
    return solution


def _confirmed(swept: Solution, progress: Progress | None) -> Solution:
    """What collocation, which has a certificate, makes of what the sweep found; no answer where it finds none there."""
    from satsym.solvers import two_point
    from satsym.solvers.improving import improved, starting_from

    if not swept.status.answered or not swept.lam.any():
        return swept
    again = improved(_in_time(two_point.solve, "collocation"), starting_from(swept), progress)
    if again.status.answered or again.status is Status.NO_MINIMISER:
        return replace(again, instance=swept.instance)
    message = f"{swept.message}, at the cost {swept.objective:.6g}, but collocation confirms no extremal there"
    return replace(swept, status=Status.NOT_CONVERGED, message=message)


def _unfit(switching: bool, method: str) -> str:
    """Why a method is not one for such controls, and which is."""
    if switching:
        return f'the controls enter without a square and switch, which "{method}" cannot find; use "bang-bang"'
    return '"bang-bang" is for controls that enter without a square; use "collocation"'


def _in_time(solver: Solver, method: str) -> Solver:
    """The same, without a trajectory where time ends while that is computed."""

    def solved(instance: Instance, progress: Progress | None) -> Solution:
        began = time.perf_counter()
        try:
            return solver(instance, progress)
        except TimeUp:
            from satsym.solvers import out_of_time

            name = "collocation" if method == "auto" else method
            return out_of_time.solution(instance, name, time.perf_counter() - began)

    return solved


def _solver(method: str) -> Solver:
    """The one of that name, collocation by default; no other is loaded."""
    if method == "shooting":
        from satsym.solvers import shooting

        return shooting.solve
    if method == "linear":
        from satsym.solvers import linear

        return linear.solve
    if method == "bang-bang":
        from satsym.solvers.switching import solving

        return solving.solve
    from satsym.solvers import two_point

    return two_point.solve


def _swept(instance: Instance, progress: Progress | None) -> Solution:
    """By sweeps. Where these end without any control, that is the answer only if no control can be cheaper."""
    from satsym.solvers.certificate.competitors import none_conceivable
    from satsym.solvers.improving import bottomless
    from satsym.solvers.sweep import solving as forward_backward

    found = _in_time(forward_backward.solve, "sweep")(instance, progress)
    if not found.status.answered or found.lam.any():
        return found
    if none_conceivable(found):
        message = (
            "the best control is none: the final state is free and costs nothing, so the costates vanish and any "
            "control only adds to the cost; the motion is the one without control"
        )
        return replace(found, message=message)
    return bottomless(found) or replace(
        found,
        status=Status.NOT_CONVERGED,
        message="without control the costates vanish, so it is stationary, but another control may be cheaper",
    )


def simulate(instance: Instance, law: Law | None = None) -> Flight:
    """Simulate an instance under a control law; see :func:`satsym.solvers.simulation.simulating.simulate`."""
    from satsym.solvers.simulation import simulating as flight

    return flight.simulate(instance, law)
