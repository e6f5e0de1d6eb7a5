"""Solvers. They see kernels only: functions of numbers, whatever model these came from."""

from __future__ import annotations

from dataclasses import replace

from satsym.instance import Instance
from satsym.solution import Flight, Progress, Solution
from satsym.status import BadInput

__all__ = ["simulate", "solve"]

METHODS = ("sweep", "collocation")
"""What is available of what an instance may name."""


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by the method it names, or by the one that fits, and certify the answer.

    The sweep is as accurate as its steps allow; a certificate asks for more, so only collocation's answers have one.

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
    if method == "sweep" and instance.tf is None:
        raise BadInput(f'{instance.name}: time.tf: a free final time cannot be swept for; use method "collocation"')
    if method == "sweep" and instance.final:
        given = ", ".join(instance.final)
        raise BadInput(
            f"{instance.name}: a given final {given} cannot be swept for; leave it free and weigh its error in the "
            'terminal cost, or use method "collocation"'
        )
    if method == "sweep" or (method == "auto" and not instance.final and instance.tf is not None):
        from satsym.solve import forward_backward

        return forward_backward.solve(instance, progress)
    from satsym.solve import two_point
    from satsym.solve.certificate import certify

    solution = two_point.solve(instance, progress)
    return replace(solution, certificate=certify(solution))


def simulate(instance: Instance, feedback: str = "none") -> Flight:
    """Simulate an instance under a feedback; see :func:`satsym.solve.flight.simulate`."""
    from satsym.solve import flight

    return flight.simulate(instance, feedback)
