"""Competitors: feasible controls that might be cheaper. The certificate names each kind it has tried.

Each gives a margin: how much dearer the cheapest competitor is, relative to the cost; negative where one is cheaper.
"""

from __future__ import annotations

import time
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solve import control_set
from satsym.solve.iteration import Limits

if TYPE_CHECKING:
    from satsym.solve.collocation.problem import TwoPoint
    from satsym.solve.collocation.sqp import Found

EARLIER = (0.6, 0.8, 0.95)
"""Shares of the duration after which a competitor has arrived, and coasts."""

SECONDS = 10.0

ROUGH, SAME = 1e-2, 1e-9
"""Relative errors of costs, on the mesh of a cold start and refined; the latter makes no difference."""


def other_starts(solution: Solution) -> float:
    """The minimum to which a path of easier problems leads, where that is another way than the solution came."""
    from satsym.solve.collocation.path_of_problems import along_problems, geometric
    from satsym.solve.collocation.scaling import two_point

    instance = solution.instance
    if instance.tf is None or _bounded(instance):
        return float("inf")
    problem = two_point(instance, instance.tf - instance.t0).widened(float("inf"))
    with np.errstate(all="ignore"):
        found = along_problems(problem, geometric, Limits(200, time.perf_counter() + SECONDS))
    if found is None or not found.minimum:
        return float("inf")
    return margin(_accurately(problem, found, solution.objective), solution.objective, coarse=SAME)


def earlier_arrivals(solution: Solution) -> float:
    """Arriving earlier on the reference, and coasting on it: possible where the whole end is on it."""
    from satsym.solve.collocation.cold_start import cold_start
    from satsym.solve.collocation.scaling import two_point

    instance = solution.instance
    if instance.tf is None or not _on_reference(solution) or _bounded(instance):
        return float("inf")
    cheapest = float("inf")
    for share in EARLIER:
        tf = instance.t0 + share * (instance.tf - instance.t0)
        sooner = replace(instance, tf=tf, final=dict.fromkeys(instance.model.spec.state_names, "reference"))
        problem = two_point(sooner, tf - instance.t0)
        with np.errstate(all="ignore"):
            start = cold_start(problem, Limits(100, time.perf_counter() + SECONDS))
        if start.way != "none":
            cheapest = min(cheapest, _accurately(problem, start.found, solution.objective))
    return margin(cheapest, solution.objective, coarse=SAME)


def _accurately(problem: TwoPoint, found: Found, rival: float) -> float:
    """The cost of a minimum, which is as rough as its mesh unless it comes near that of its rival or below it."""
    from satsym.solve.collocation.refinement import refine
    from satsym.solve.collocation.system import System

    cost = found.cost * problem.scale.cost
    if cost > rival + ROUGH * abs(rival):
        return cost
    refined = refine(problem, found.curve, SAME)
    if not refined.converged:
        return float("inf")
    return System(problem, refined.curve.mesh, refined.curve.order).cost(refined.curve) * problem.scale.cost


def _on_reference(solution: Solution) -> bool:
    """Whether the whole final state is the reference's, and coasting on it is admissible."""
    instance, spec = solution.instance, solution.instance.model.spec
    if not spec.has_reference or instance.final.keys() != set(spec.state_names):
        return False
    curve = np.array(instance.model.reference(float(solution.times[-1]), instance.parameters))
    none = np.zeros((len(spec.controls), 1))
    there = np.allclose(solution.x[:, -1], curve, rtol=1e-9, atol=1e-12)
    return bool(there and (control_set.project(instance, none) == none).all())


def _bounded(instance: Instance) -> bool:
    return bool(np.isfinite(instance.bounds).any())


def margin(competitor: float, cost: float, coarse: float = 0.0) -> float:
    """How much dearer a competitor is, relative to the cost; differences below ``coarse`` are its own error."""
    if not np.isfinite(competitor):
        return float("inf")
    margin = (competitor - cost) / max(abs(cost), 1e-300)
    return 0.0 if abs(margin) < coarse else margin
