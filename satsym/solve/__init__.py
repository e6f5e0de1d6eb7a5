"""Solvers. They see kernels only: functions of numbers, whatever model these came from."""

from __future__ import annotations

from satsym.instance import Instance
from satsym.solution import Flight, Progress, Solution
from satsym.status import BadInput

__all__ = ["simulate", "solve"]

METHODS = ("sweep",)


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by the method it names, or by the one that fits.

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
    from satsym.solve import forward_backward

    spec, method = instance.model.spec, instance.solver.method
    if not spec.has_cost:
        raise BadInput(f"{instance.name}: model {spec.name} has no cost, so there is nothing to solve; try simulate")
    if method not in ("auto", *METHODS):
        raise BadInput(f'{instance.name}: solver.method: "{method}" is not available; use "auto" or "sweep"')
    if instance.tf is None or instance.final:
        given = "a free final time" if instance.tf is None else f"a given final {', '.join(instance.final)}"
        raise BadInput(
            f"{instance.name}: {given} cannot be swept for; give the final time, leave the final state free and weigh "
            "its error in the terminal cost"
        )
    return forward_backward.solve(instance, progress)


def simulate(instance: Instance, feedback: str = "none") -> Flight:
    """Simulate an instance under a feedback; see :func:`satsym.solve.flight.simulate`."""
    from satsym.solve import flight

    return flight.simulate(instance, feedback)
