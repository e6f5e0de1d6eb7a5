"""Guesses of the states: straight lines, and motions without control."""

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
"""Scaled states, shape (n, M), at M times tau in [0, 1]."""

POINTS = 41
"""Points of a path at which the mesh is laid."""

STEPS = 4000
"""RK4 steps of a motion under a control that is guessed, and at most of one without control."""

FEWEST, QUICK = 400, 20.0
"""RK4 steps of a motion without control at least, and in the time in which its quickest mode turns by one radian."""


def first(problem: TwoPoint) -> States:
    """Where to begin: as guessed, else on the straight line to the end, or where that is free without control."""
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
    """Where to begin as a curve, with the costates that are guessed.

    Parameters
    ----------
    path
        :func:`first`, if that is known.
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
    """Values evenly spaced over [0, 1], straight lines between."""
    found: Array = np.interp(tau, np.linspace(0.0, 1.0, len(values)), values)
    return found


def through(problem: TwoPoint, states: Array) -> States:
    """The path along states at evenly spaced times, shape (n, N + 1)."""
    nodes, scaled = np.linspace(0.0, 1.0, states.shape[1]), states / problem.scale.state[:, None]
    return lambda tau: np.array([np.interp(tau, nodes, row) for row in scaled])


def curve(problem: TwoPoint, path: States) -> Curve:
    """A path as a curve without costates, on a mesh that resolves it."""
    tau = np.linspace(0.0, 1.0, POINTS)
    return on(problem, path, meshes.along(problem, tau, path(tau), problem.theta))


def on(problem: TwoPoint, path: States, mesh: Array) -> Curve:
    """A path as a curve without costates on a mesh, shape (N+1,)."""
    n, at = problem.states, stage_times(mesh, STAGES)
    nodes, stages = np.zeros((2 * n, len(mesh))), np.zeros((2 * n, *at.shape))
    nodes[:n], stages[:n] = path(mesh), path(at.ravel()).reshape(n, *at.shape)
    return Curve(mesh, nodes, stages, problem.theta)


def _line(problem: TwoPoint) -> States:
    line = straight(problem)
    return lambda tau: line[:, :1] + (line[:, 1:] - line[:, :1]) * tau


def _under_guess(problem: TwoPoint) -> States | None:
    """The motion under the control that is guessed, if it is, and stays in the domain."""
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
    """The motion without control through a scaled state; ``None`` where it leaves the domain."""
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
    """So many that the quickest mode of a motion without control, as it is at its start, is followed."""
    instance, n = problem.instance, problem.states
    none = (0.0,) * len(instance.model.spec.controls)
    begin = instance.t0 + problem.duration if backwards else instance.t0
    try:
        slopes = np.array(instance.model.jacobian_x(begin, start, none, instance.parameters)).reshape(n, n)
        turned = float(np.abs(np.linalg.eigvals(slopes)).max()) * problem.duration
    except FAILURES:
        return STEPS
    return int(min(max(FEWEST, np.ceil(QUICK * turned)), STEPS))
