"""Solutions found once for all tests of this process that look at what is said, drawn or saved of them.

Tests of the act of solving call ``satsym.solvers.solve`` themselves.
"""

from __future__ import annotations

from satsym import solvers
from satsym.instance import Instance
from satsym.solution import Iteration, Progress, Solution

_REALLY = solvers.solve

_KNOWN: list[tuple[Instance, bool, Solution, list[Iteration]]] = []
"""Each instance that was solved, whether its answer was examined, the answer, and the iterations on the way."""


def solve(instance: Instance, progress: Progress | None = None, *, examined: bool = True) -> Solution:
    """Solve an instance, or return what was found for an equal one, having reported the same iterations."""
    for one, certified, solution, iterations in _KNOWN:
        if certified == examined and one == instance:
            for iteration in iterations:
                if progress:
                    progress(iteration)
            return solution
    passed: list[Iteration] = []

    def noted(iteration: Iteration) -> None:
        passed.append(iteration)
        if progress:
            progress(iteration)

    solution = _REALLY(instance, noted, examined=examined)
    _KNOWN.append((instance, examined, solution, passed))
    return solution
