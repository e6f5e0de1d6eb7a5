"""Competitors with other boundary arcs: extremals to which other paths lead."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from satsym.solution import Check, Competitors, Kind, Solution
from satsym.solvers.constrained.convexity import convex
from satsym.solvers.constrained.solving import others

MARGIN = 1e-9
"""By so much, relatively, a competitor may seem cheaper."""


@dataclass(frozen=True)
class Comparison:
    """What was compared, what came of it, and what was not."""

    competitors: tuple[Competitors, ...]
    checks: tuple[Check, ...]
    not_checked: tuple[Kind, ...]


def compared(solution: Solution, seed: int) -> Comparison:
    """Hold a solution against extremals from paths that are drawn; a convex problem has no others."""
    if convex(solution.instance):
        return Comparison((), (), ())
    tried, costs = others(solution.instance, solution.objective, seed + 1)
    found = Competitors(Kind.ARCS, tried, len(costs), min(costs, default=float("nan")))
    if not costs:
        return Comparison((found,), (), (Kind.ARCS,))
    size = max(abs(solution.objective), 1e-300)
    cheaper = max(0.0, (solution.objective - float(np.min(costs))) / size)
    return Comparison((found,), (Check(f"cheaper by: {Kind.ARCS.value}", cheaper, MARGIN),), ())
