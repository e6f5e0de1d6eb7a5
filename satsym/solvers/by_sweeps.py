"""Method "sweep". A result without any control is only accepted if no control can be cheaper."""

from __future__ import annotations

from dataclasses import replace

from satsym.instance import Instance
from satsym.solution import Progress, Solution
from satsym.solvers.certificate.competitors.comparing import none_conceivable
from satsym.solvers.improving import bottomless
from satsym.solvers.sweep import solving as forward_backward
from satsym.status import Status


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance by forward-backward sweeps.

    Parameters
    ----------
    instance
        Instance with a given final time and a free final state.
    progress
        Called after each sweep.
    """
    found = forward_backward.solve(instance, progress)
    if not found.status.answered or found.lam.any():
        return found
    if none_conceivable(found):
        message = (
            "the optimal control is zero: the final state is free and has no cost, so the costates vanish and "
            "any other control increases the cost; the motion is the uncontrolled one"
        )
        return replace(found, message=message)
    return bottomless(found) or replace(
        found,
        status=Status.NOT_CONVERGED,
        message="its costates vanish, so the uncontrolled motion is stationary, but another control may be cheaper",
    )
