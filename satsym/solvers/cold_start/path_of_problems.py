"""A cold start for hard problems: from a motion without control the initial state is moved to the given one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from satsym.arrays import Array
from satsym.solvers.cold_start import paths
from satsym.solvers.cold_start.origin import Origin
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.arclength import Point
from satsym.solvers.collocation.attempt import Attempt, Reason
from satsym.solvers.collocation.curve import Curve, Step
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.sqp import descended, minimise
from satsym.solvers.collocation.system import System
from satsym.solvers.iteration import Limits
from satsym.solvers.symmetry import Spiral

Between = Callable[[Array, Array, float], Array]
"""A state between two others, by its share of the way."""

FIRST_MOVE, SMALLEST_MOVE, MOST_STEPS = 0.25, 2e-3, 500


def along_problems(problem: TwoPoint, between: Between, limits: Limits) -> Attempt | None:
    """Move the initial state from a motion without control to the given one; ``None`` where there is no such motion.

    It coasts backwards from an end that is given, or costs nothing. Where the minima that one follows come to an
    end, the minimisation goes on from the last one to whatever lies below.

    Parameters
    ----------
    problem
        Without bounds.
    between
        The initial states on the way.
    """
    coasting = paths.coasting_to_the_end(problem)
    if coasting is None:
        return None
    away, home = coasting(np.zeros(1))[:, 0], problem.initial

    def path(fraction: float) -> TwoPoint:
        return problem.starting_at(between(away, home, fraction))

    return followed(problem, path, paths.curve(problem, coasting), limits)


def followed(problem: TwoPoint, path: Callable[[float], TwoPoint], curve: Curve, limits: Limits) -> Attempt:
    """Follow the minima of problems from the first one to a problem, which is the last.

    Parameters
    ----------
    problem
        Without bounds.
    path
        The problem at a share of the way, in the units of the last.
    curve
        A guess of the first one's minimum.
    """
    at, move, steps = 0.0, FIRST_MOVE, 0
    tangent: Step | None = None
    while steps < MOST_STEPS and move >= SMALLEST_MOVE and not limits.expired:
        there = min(1.0, at + move)
        guess = _predicted(problem, curve, tangent, there - at)
        system = System(path(there), curve.mesh, STAGES)
        last = there == 1.0
        found = minimise(
            system, guess, limits, 1e-7 if last else 1e-3, (6 if move > 0.03 else 14) + 4 * last, meshes.COARSEST
        )
        steps += max(found.iterations, 1)
        if found.reason is Reason.OUTGROWN:
            if found.curve.in_domain(problem.positive):
                curve, tangent = curve.on(meshes.laid(problem, found.curve), STAGES), None
            move *= 0.7
        elif found.minimum:
            at, curve = there, found.curve
            if last:
                return replace(found, iterations=steps, hard=True)
            tangent = _tangent(Point(path, at, curve, known=found.linearised))
            mesh = meshes.laid(problem, curve)
            if abs(len(mesh) - len(curve.mesh)) > 0.15 * len(curve.mesh):
                curve, tangent = curve.on(mesh, STAGES), None
            move *= 1.6 if found.iterations <= 5 else 1.0
        else:
            move *= 0.4
    below = descended(problem, curve, STAGES, 1e-7, limits)
    if below.minimum:
        return replace(below, iterations=steps + below.iterations, hard=True)
    facts = (Origin.PROBLEMS.value, at)
    return Attempt(curve, Reason.PATH_ENDS, steps + below.iterations, float("inf"), facts=facts)


def geometric(a: Array, b: Array, fraction: float) -> Array:
    """From one state to another: geometrically where both have the same sign, else straight."""
    same = a * b > 0.0
    ratio = np.where(same, b, 1.0) / np.where(same, a, 1.0)
    found: Array = np.where(same, a * np.abs(ratio) ** fraction, a + (b - a) * fraction)
    return found


def straight(a: Array, b: Array, fraction: float) -> Array:
    """From one state to another on the straight line."""
    return a + (b - a) * fraction


def _predicted(problem: TwoPoint, curve: Curve, tangent: Step | None, move: float) -> Curve:
    if tangent is None:
        return curve
    ahead = curve.moved(tangent, move)
    falls = any((ahead.stages[i] < 0.5 * curve.stages[i]).any() for i in problem.positive)
    return curve if falls else ahead


def _tangent(point: Point) -> Step | None:
    try:
        return point.response()
    except np.linalg.LinAlgError:
        return None


STEP = 1e-5
"""Share of the duration by which a path is differenced."""


def along_turns(problem: TwoPoint, spiral: Spiral, limits: Limits) -> Attempt:
    """The minimum with a number of turns, from the spiral that makes them, driven by a force that fades.

    A spiral is no motion: it lacks some rates. With these added to the model it becomes one, and costs no control, so
    it is where a path of problems begins; the controls take over what the force leaves. Minimising from the spiral
    itself gets stuck where there are many turns, as a small defect early on asks for a large change of phase later.

    Parameters
    ----------
    problem
        Without bounds, or with soft ones; its duration is given.
    spiral
        That makes them.
    """
    return followed(problem, fading(problem, spiral), paths.curve(problem, spiral.path), limits)


def fading(problem: TwoPoint, spiral: Spiral) -> Callable[[float], TwoPoint]:
    """Problems by their share of the way: from the one that the spiral solves without costates, to the given one."""

    def lacking(tau: Array) -> Array:
        its = (spiral.path(tau + STEP) - spiral.path(tau - STEP)) / (2.0 * STEP * problem.duration)
        z = np.concatenate([spiral.path(tau), np.zeros((problem.states, len(tau)))])
        return its - problem.rates(tau, z, problem.theta)[: problem.states]

    return lambda fraction: problem.forced(lacking, 1.0 - fraction)
