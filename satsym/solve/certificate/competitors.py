"""Competitors: feasible controls that might be cheaper. The certificate names each kind it has tried.

Each gives a margin: how much dearer the cheapest competitor is, relative to the cost; negative where one is cheaper.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from satsym.instance import Instance
from satsym.solution import Solution
from satsym.solve import control_set
from satsym.solve.certificate.flow import products
from satsym.solve.iteration import Limits
from satsym.solve.revolutions import shifted

if TYPE_CHECKING:
    from satsym.solve.collocation.problem import TwoPoint
    from satsym.solve.collocation.sqp import Found

Attempt = Callable[[Any, Limits], Any]
"""From a two-point problem without bounds to what was found, or nothing."""

EARLIER = (0.6, 0.8, 0.95)
"""Shares of the duration after which a competitor has arrived, and coasts."""

SHORTER_AND_LONGER = (0.8, 0.95, 1.05, 1.25)
"""Durations beside one that was chosen, as shares of it."""

SECONDS = 3.0
"""For each competitor."""

HIDDEN = 1e-14
"""Share of their size by which states are rounded in the end: costs differ by what that is worth, whatever they are."""

ROUGH, SAME = 1e-2, 1e-9
"""Relative errors of costs, on the mesh of a cold start and refined; the latter makes no difference."""


def none_conceivable(solution: Solution) -> bool:
    """Whether no control can cost less: the state costs nothing, and the control is the least of the running cost.

    So it is where all costates vanish, and with them the terminal cost's gradient, and the running cost does not
    depend on the state; the latter is looked at for states drawn around those of the solution.
    """
    if solution.lam.any():
        return False
    instance, model = solution.instance, solution.instance.model
    rng = np.random.default_rng(0)
    x = solution.x * rng.uniform(0.5, 2.0, solution.x.shape)
    slopes = model.costate_rate_batch(solution.times, x, solution.u, solution.lam, instance.parameters)
    ends = [model.terminal_gradient(float(solution.times[-1]), tuple(row), instance.parameters) for row in x.T[:20]]
    return not np.any(slopes) and not np.any(ends)


def other_starts(solution: Solution) -> float:
    """The minimum to which a path of easier problems leads, where that is another way than the solution came."""
    from satsym.solve.collocation.path_of_problems import along_problems, geometric

    if solution.instance.tf is None:
        return float("inf")

    def attempt(problem: TwoPoint, limits: Limits) -> Found | None:
        return along_problems(problem, geometric, limits)

    return _dearer(solution, [solution.instance], attempt)


def other_revolutions(solution: Solution) -> float:
    """A turn more and a turn less of each final angle that counts modulo a turn."""
    at = solution.instance
    if at.tf is None:
        return float("inf")
    angles = [name for name in at.solver.free_angles if name in at.final]
    turned = [shifted(at, {name: turns}) for name in angles for turns in (-1, 1)]
    return _dearer(solution, turned, _from_nothing)


def other_durations(solution: Solution) -> float:
    """Shorter and longer durations where the final time is free."""
    instance = solution.instance
    if instance.tf is not None:
        return float("inf")
    lasting = float(solution.times[-1]) - instance.t0
    durations = [instance.t0 + share * lasting for share in SHORTER_AND_LONGER]
    return _dearer(solution, [replace(instance, tf=tf, tf_guess=None) for tf in durations], _from_nothing)


def earlier_arrivals(solution: Solution) -> float:
    """Arriving earlier on the reference, and coasting on it: possible where the whole end is on it."""
    instance = solution.instance
    if instance.tf is None or not _on_reference(solution):
        return float("inf")
    final: dict[str, float | Literal["reference"]] = dict.fromkeys(instance.model.spec.state_names, "reference")
    times = [instance.t0 + share * (instance.tf - instance.t0) for share in EARLIER]
    return _dearer(solution, [replace(instance, tf=tf, final=final) for tf in times], _from_nothing)


def _dearer(solution: Solution, rivals: list[Instance], attempt: Attempt) -> float:
    """How much dearer the cheapest rival is, all with given final times; infinite where none is found."""
    from satsym.solve.collocation.scaling import two_point

    cheapest = float("inf")
    for rival in rivals:
        assert rival.tf is not None
        problem, limits = two_point(rival, rival.tf - rival.t0), Limits(200, time.perf_counter() + SECONDS)
        with np.errstate(all="ignore"):
            found = attempt(problem.widened(float("inf")), limits)
            if found is not None and found.minimum:
                cheapest = min(cheapest, _accurately(problem, found, solution.objective, limits))
    return margin(cheapest, solution.objective, coarse=SAME, hidden=hidden(solution))


def hidden(solution: Solution) -> float:
    """The difference of costs that rounding hides."""
    return HIDDEN * products(solution)


def _from_nothing(problem: TwoPoint, limits: Limits) -> Found | None:
    from satsym.solve.collocation.cold_start import cold_start

    start = cold_start(problem, limits)
    return None if start.way == "none" else start.found


def _accurately(problem: TwoPoint, found: Found, cost: float, limits: Limits) -> float:
    """The cost of a minimum within the bounds, as rough as its mesh where it is clearly dearer than another cost.

    What is dearer without the bounds is so within them.
    """
    from satsym.solve.collocation.continuation import tighten
    from satsym.solve.collocation.gauss import STAGES
    from satsym.solve.collocation.refinement import refine
    from satsym.solve.collocation.system import System

    rough = found.cost * problem.scale.cost
    if rough > cost + ROUGH * abs(cost):
        return rough
    refined = refine(problem.widened(float("inf")), found.curve, SAME)
    bounded = tighten(problem, refined.curve, STAGES, limits)
    if bounded.iterations:
        if not bounded.converged:
            return float("inf")
        refined = refine(problem, bounded.curve, SAME, keep_nodes=True)
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


def margin(competitor: float, cost: float, coarse: float = 0.0, hidden: float = 0.0) -> float:
    """How much dearer a competitor is, relative to the cost.

    Differences below ``coarse``, or of costs below ``hidden``, are its own error.
    """
    if not np.isfinite(competitor):
        return float("inf")
    margin = (competitor - cost) / max(abs(cost), 1e-300)
    return 0.0 if abs(margin) < coarse or abs(competitor - cost) < hidden else margin
