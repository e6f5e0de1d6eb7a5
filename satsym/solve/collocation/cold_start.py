"""From nothing to an extremal: a straight line where that goes straight, else a path of easier problems.

First Newton's method from the straight line in the state space, then the minimisation from there. Where neither
walks straight through, the second way decides as well: from a motion that needs no control at all and ends where it
should, the initial state is moved to the given one, each problem starting from the last. The cheaper minimum
stands. Where neither way arrives, the duration is halved until the straight line leads to a minimum, and lengthened
from there.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.grid import Grid
from satsym.solve.collocation import mesh as meshes
from satsym.solve.collocation.curve import Curve, stage_times
from satsym.solve.collocation.gauss import STAGES
from satsym.solve.collocation.longer import along_durations
from satsym.solve.collocation.problem import TwoPoint
from satsym.solve.collocation.scaling import straight
from satsym.solve.collocation.sqp import OUTGROWN, Found, minimise
from satsym.solve.collocation.straight_through import straight_through
from satsym.solve.collocation.system import System
from satsym.solve.iteration import Limits

Array = NDArray[np.floating[Any]]

STRAIGHT_THROUGH = 15
"""Steps within which the straight line leads to a minimum if it does so easily."""

TOLERANCES = (3e-2, 1e-3, 1e-7)
"""Sizes of the last step after which the mesh is laid anew; the last one ends the minimisation."""

FIRST_MOVE, SMALLEST_MOVE, MOST_STEPS = 0.25, 2e-3, 500
SAMPLES = 201
POINTS = 41
"""Points of a path at which the mesh is laid."""


@dataclass(frozen=True, eq=False)
class Start:
    """An extremal found from nothing.

    Attributes
    ----------
    found
        The cheapest minimum, or the last attempt.
    way
        ``"straight line"``, ``"path of problems"``, ``"path of durations"`` or ``"none"``.
    steps
        Steps of all attempts.
    minima
        Scaled costs of all minima that were met, by their way.
    """

    found: Found
    way: str
    steps: int
    minima: dict[str, float]


def cold_start(problem: TwoPoint, limits: Limits, quick: bool = False) -> Start:
    """Find a minimum of a problem without bounds.

    Parameters
    ----------
    problem
        Bounds are ignored.
    limits
        When to stop.
    quick
        Try the first way only.
    """
    free = problem.widened(float("inf"))
    line = straight_curve(free)

    def from_line(problem: TwoPoint) -> Found:
        return from_path(problem, straight_path(problem), limits)

    ways: list[tuple[str, Callable[[], Found | None]]] = [
        ("straight line", lambda: straight_through(line, System(free, line.mesh, STAGES)) or from_line(free)),
        ("path of problems", lambda: along_problems(free, limits)),
        ("path of durations", lambda: along_durations(free, STAGES, limits, from_line)),
    ]

    minima: dict[str, Found] = {}
    last: Found | None = None
    steps = 0
    for way, attempt in ways:
        if way == "path of durations" and minima:
            break
        with np.errstate(all="ignore"):
            found = attempt()
        if found is None:
            continue
        last, steps = found, steps + found.iterations
        if found.minimum and _in_domain(free, found.curve):
            minima[way] = found
            if not found.hard:
                break
        if limits.expired or quick:
            break
    costs = {way: found.cost for way, found in minima.items()}
    if not minima:
        assert last is not None
        return Start(replace(last, reason=_reason(last)), "none", steps, costs)
    best = min(minima, key=lambda way: minima[way].cost)
    return Start(minima[best], best, steps, costs)


def straight_path(problem: TwoPoint) -> Callable[[Array], Array]:
    """States on a straight line from start to end, as a function of tau."""
    line = straight(problem)
    return lambda tau: line[:, :1] + (line[:, 1:] - line[:, :1]) * tau


def straight_curve(problem: TwoPoint) -> Curve:
    """The same as a curve."""
    return _without_costates(problem, straight_path(problem))


def from_path(problem: TwoPoint, path: Callable[[Array], Array], limits: Limits, most: int = STRAIGHT_THROUGH) -> Found:
    """Minimise from a path of states, shape (n, M) for M times; the mesh is laid anew as the curve takes shape."""
    curve = _without_costates(problem, path)
    steps, hard, stage = 0, False, 0
    while True:
        system = System(problem, curve.mesh, STAGES)
        found = minimise(system, curve, limits, TOLERANCES[stage], max(most - steps, 1), meshes.COARSEST)
        steps, hard = steps + found.iterations, hard or found.hard
        found = replace(found, iterations=steps, hard=hard)
        extremal = found.reason in ("minimum", "saddle")
        if not (extremal or found.reason == OUTGROWN) or not _in_domain(problem, found.curve):
            return found
        if extremal and stage == len(TOLERANCES) - 1:
            return found
        if steps >= most or limits.expired:
            return replace(found, reason=f"no convergence in {steps} steps")
        if extremal:
            stage = stage + 1 if hard else len(TOLERANCES) - 1
        curve = found.curve if extremal and not hard else _remeshed(problem, found.curve)


def along_problems(problem: TwoPoint, limits: Limits) -> Found | None:
    """Move the initial state from a motion without control to the given one; ``None`` where there is no such motion.

    It coasts backwards from an end that is given, or costs nothing.
    """
    coasting = _coasting_to_the_end(problem)
    if coasting is None:
        return None
    curve = _without_costates(problem, coasting)
    away, home = coasting(np.zeros(1))[:, 0], problem.initial
    at, move, steps = 0.0, FIRST_MOVE, 0
    tangent: tuple[Array, Array] | None = None
    while steps < MOST_STEPS and move >= SMALLEST_MOVE and not limits.expired:
        there = min(1.0, at + move)
        moved = problem.starting_at(between(away, home, there))
        guess = _predicted(problem, curve, tangent, there - at)
        system = System(moved, curve.mesh, STAGES)
        last = there == 1.0
        found = minimise(
            system, guess, limits, 1e-7 if last else 1e-3, (6 if move > 0.03 else 14) + 4 * last, meshes.COARSEST
        )
        steps += max(found.iterations, 1)
        if found.reason == OUTGROWN:
            if _in_domain(problem, found.curve):
                curve, tangent = curve.on(meshes.laid(problem, found.curve), STAGES), None
            move *= 0.7
        elif found.minimum:
            at, curve = there, found.curve
            if last:
                return replace(found, iterations=steps, hard=True)
            tangent = _tangent(moved, curve, away, home, at)
            mesh = meshes.laid(problem, curve)
            if abs(len(mesh) - len(curve.mesh)) > 0.15 * len(curve.mesh):
                curve, tangent = curve.on(mesh, STAGES), None
            move *= 1.6 if found.iterations <= 5 else 1.0
        else:
            move *= 0.4
    return Found(curve, f"the path of problems ends after {at:.0%} of its way", float("inf"), steps, True)


def between(a: Array, b: Array, share: float) -> Array:
    """From one state to another: geometrically where both have the same sign, else straight."""
    same = a * b > 0.0
    ratio = np.where(same, b, 1.0) / np.where(same, a, 1.0)
    found: Array = np.where(same, a * np.abs(ratio) ** share, a + (b - a) * share)
    return found


def _coasting_to_the_end(problem: TwoPoint) -> Callable[[Array], Array] | None:
    """The motion without control that arrives at the end, as a function of tau."""
    instance, end = problem.instance, _end_without_costates(problem)
    if end is None:
        return None
    grid = Grid.uniform(0.0, 1.0, 20 * SAMPLES)
    times = instance.t0 + problem.duration * (1.0 - grid.nodes)
    none = np.zeros((len(instance.model.spec.controls), grid.steps + 1))
    x, _, _ = instance.model.forward(times, tuple(end.tolist()), none, none[:, 1:], instance.parameters)
    backwards = x[:, ::-1] / problem.scale.state[:, None]
    if not np.isfinite(backwards).all() or not instance.model.in_domain(x):
        return None
    return lambda tau: np.array([np.interp(tau, grid.nodes, row) for row in backwards])


def _end_without_costates(problem: TwoPoint) -> Array | None:
    """A final state where costates may be zero: where a state is free, the terminal cost must not depend on it."""
    instance, free = problem.instance, ~problem.fixed
    if problem.free_time or instance.model.spec.multipliers:
        return None
    end = straight(problem)[:, 1] * problem.scale.state
    candidates = [end]
    tf = instance.t0 + problem.duration
    if instance.model.spec.has_reference:
        curve = np.array(instance.model.reference(tf, instance.parameters))
        candidates.insert(0, np.where(free, curve, end))
    for candidate in candidates:
        gradient = instance.model.terminal_gradient(tf, tuple(candidate.tolist()), instance.parameters)
        slopes = np.array(gradient) * problem.scale.state / problem.scale.cost
        if not (np.abs(slopes[free]) > 1e-12).any():
            return candidate
    return None


def _without_costates(problem: TwoPoint, path: Callable[[Array], Array]) -> Curve:
    tau = np.linspace(0.0, 1.0, POINTS)
    mesh = meshes.along(problem, tau, path(tau), problem.theta)
    n, at = problem.states, stage_times(mesh, STAGES)
    nodes, stages = np.zeros((2 * n, len(mesh))), np.zeros((2 * n, *at.shape))
    nodes[:n], stages[:n] = path(mesh), path(at.ravel()).reshape(n, *at.shape)
    return Curve(mesh, nodes, stages, problem.theta)


def _remeshed(problem: TwoPoint, curve: Curve) -> Curve:
    return curve.on(meshes.laid(problem, curve), STAGES)


def _predicted(problem: TwoPoint, curve: Curve, tangent: tuple[Array, Array] | None, move: float) -> Curve:
    if tangent is None:
        return curve
    ahead = replace(curve, nodes=curve.nodes + move * tangent[0], stages=curve.stages + move * tangent[1])
    falls = any((ahead.stages[i] < 0.5 * curve.stages[i]).any() for i in problem.positive)
    return curve if falls else ahead


def _tangent(problem: TwoPoint, curve: Curve, away: Array, home: Array, at: float) -> tuple[Array, Array] | None:
    """How the extremal changes with the share of the way."""
    ahead = min(at + 1e-4, 1.0)
    slope = (between(away, home, ahead) - between(away, home, at)) / (ahead - at)
    system = System(problem, curve.mesh, curve.order)
    residual = system.residual(curve)
    try:
        linearised = system.linearised(curve, residual, system.jacobian(curve))
    except np.linalg.LinAlgError:
        return None
    zero = replace(
        residual,
        stages=np.zeros_like(residual.stages),
        ends=np.zeros_like(residual.ends),
        start=-slope,
        finish=np.zeros_like(residual.finish),
    )
    step = linearised.step(zero)
    return step.nodes, step.stages


def _in_domain(problem: TwoPoint, curve: Curve) -> bool:
    return all(curve.stages[i].min() > 0.0 and curve.nodes[i].min() > 0.0 for i in problem.positive)


def _reason(found: Found) -> str:
    """Why an attempt is no answer."""
    return "the minimum lies outside the domain" if found.minimum else found.reason
