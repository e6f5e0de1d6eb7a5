"""Initial guesses of the states: straight lines, uncontrolled motions, and motions under a guessed control."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from satsym.arrays import Array
from satsym.grid import Grid
from satsym.solvers.collocation import mesh as meshes
from satsym.solvers.collocation.curve import Curve, stage_times
from satsym.solvers.collocation.gauss import STAGES
from satsym.solvers.collocation.problem import TwoPoint
from satsym.solvers.collocation.scaling import straight
from satsym.solvers.failures import FAILURES

States = Callable[[Array], Array]
"""Function of M times tau in [0, 1] that returns scaled states, shape (n, M)."""

POINTS = 41
"""Number of points of a guess from which the mesh is computed."""

STEPS = 4000
"""Number of RK4 steps of a motion under a guessed control, and largest number for an uncontrolled motion."""

FEWEST, QUICK = 400, 20.0
"""Smallest number of RK4 steps of an uncontrolled motion, and number per radian of its fastest mode."""


def first(problem: TwoPoint) -> States:
    """Return the initial guess of the states: as given, or a straight line, or the uncontrolled motion.

    The straight line leads to the given final state; without one, the uncontrolled motion is used.
    """
    coasting = None if problem.fixed.any() else _coasting(problem, problem.initial, backwards=False)
    path = _under_guess(problem) or coasting or _line(problem)
    guessed, names = problem.instance.guess.state, problem.instance.model.spec.state_names
    if not guessed:
        return path

    def overlaid(tau: Array) -> Array:
        states = path(tau)
        for name, values in guessed.items():
            states[names.index(name)] = series(values, tau) / problem.scale.state[names.index(name)]
        return states

    return overlaid


def start(problem: TwoPoint, path: States | None = None) -> Curve:
    """Return the initial guess as a curve, with the costates that are given.

    Parameters
    ----------
    problem
        The two-point problem.
    path
        Result of :func:`first`, if it is known.
    """
    begun, n = curve(problem, path or first(problem)), problem.states
    times = stage_times(begun.mesh, STAGES)
    for name, values in problem.instance.guess.costate.items():
        i = n + problem.instance.model.spec.state_names.index(name)
        unit = problem.scale.both[i, 0]
        begun.nodes[i] = series(values, begun.mesh) / unit
        begun.stages[i] = series(values, times.ravel()).reshape(times.shape) / unit
    return begun


def series(values: Sequence[float], tau: Array) -> Array:
    """Return the linear interpolation at `tau` of values that are equidistant in [0, 1]."""
    found: Array = np.interp(tau, np.linspace(0.0, 1.0, len(values)), values)
    return found


def through(problem: TwoPoint, states: Array) -> States:
    """Return the linear interpolation of states at equidistant times, shape (n, N + 1)."""
    nodes, scaled = np.linspace(0.0, 1.0, states.shape[1]), states / problem.scale.state[:, None]
    return lambda tau: np.array([np.interp(tau, nodes, row) for row in scaled])


def curve(problem: TwoPoint, path: States) -> Curve:
    """Return a guess of the states as a curve with zero costates, on a mesh that resolves it."""
    tau = np.linspace(0.0, 1.0, POINTS)
    return on(problem, path, meshes.along(problem, tau, path(tau), problem.theta))


def on(problem: TwoPoint, path: States, mesh: Array) -> Curve:
    """Return a guess of the states as a curve with zero costates, on a given mesh, shape (N+1,)."""
    n, at = problem.states, stage_times(mesh, STAGES)
    nodes, stages = np.zeros((2 * n, len(mesh))), np.zeros((2 * n, *at.shape))
    nodes[:n], stages[:n] = path(mesh), path(at.ravel()).reshape(n, *at.shape)
    return Curve(mesh, nodes, stages, problem.theta)


def _line(problem: TwoPoint) -> States:
    line = straight(problem)
    return lambda tau: line[:, :1] + (line[:, 1:] - line[:, :1]) * tau


def _under_guess(problem: TwoPoint) -> States | None:
    """Return the motion under the guessed control.

    Return ``None`` without such a guess, or if the motion leaves the domain.
    """
    instance, values = problem.instance, problem.instance.guess.control
    if not values:
        return None
    nodes = np.linspace(0.0, 1.0, 2 * STEPS + 1)
    names = instance.model.spec.control_names
    u = np.array([series(values.get(name, (0.0,)), nodes) for name in names])
    u = instance.control_set.project(u)
    times = instance.t0 + problem.duration * nodes[::2]
    x, _, _ = instance.model.forward(times, instance.initial, u[:, ::2], u[:, 1::2], instance.parameters)
    if not np.isfinite(x).all() or not instance.model.in_domain(x):
        return None
    return through(problem, x)


def _coasting(problem: TwoPoint, state: Array, backwards: bool) -> States | None:
    """Return the uncontrolled motion through a scaled state; ``None`` if it leaves the domain."""
    instance, start = problem.instance, tuple((state * problem.scale.state).tolist())
    steps = _steps(problem, start, backwards)
    grid = Grid.uniform(0.0, 1.0, steps)
    times = instance.t0 + problem.duration * (1.0 - grid.nodes if backwards else grid.nodes)
    none = np.zeros((len(instance.model.spec.controls), steps + 1))
    x, _, _ = instance.model.forward(times, start, none, none[:, 1:], instance.parameters)
    if not np.isfinite(x).all() or not instance.model.in_domain(x):
        return None
    return through(problem, x[:, ::-1] if backwards else x)


def _steps(problem: TwoPoint, start: tuple[float, ...], backwards: bool) -> int:
    """Return the number of RK4 steps that resolve the fastest mode of an uncontrolled motion."""
    instance, n = problem.instance, problem.states
    none = (0.0,) * len(instance.model.spec.controls)
    begin = instance.t0 + problem.duration if backwards else instance.t0
    try:
        slopes = np.array(instance.model.jacobian_x(begin, start, none, instance.parameters)).reshape(n, n)
        turned = float(np.abs(np.linalg.eigvals(slopes)).max()) * problem.duration
    except FAILURES:
        return STEPS
    return int(min(max(FEWEST, np.ceil(QUICK * turned)), STEPS))
