"""Method "boundary-arcs": extremals in arcs, between boundaries of path constraints or points on the way."""

from __future__ import annotations

from satsym.instance import Instance
from satsym.solution import Progress, Solution


def solve(instance: Instance, progress: Progress | None = None) -> Solution:
    """Solve an instance with path constraints, or with points on the way.

    Parameters
    ----------
    instance
        Of a model with some of either.
    progress
        Called after each iteration while the problem without them is solved.
    """
    if instance.model.spec.interior:
        from satsym.solvers.interior import solving as through_points

        return through_points.solve(instance, progress)
    from satsym.solvers.constrained import solving as along_boundaries

    return along_boundaries.solve(instance, progress)
