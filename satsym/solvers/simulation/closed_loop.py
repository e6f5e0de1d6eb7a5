"""Simulation of motions under a control law, which may have corners, by SciPy's DOP853 with small tolerances."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.core import Function
from satsym.solvers.iteration import Limits
from satsym.solvers.simulation import blocks
from satsym.solvers.simulation.stability import fastest, stable_steps

Control: TypeAlias = Callable[[float, Sequence[float]], Sequence[float]]

MOST_EVALUATIONS = 100_000
"""Largest number of evaluations in one run, in addition to those for the fastest mode; exceeded only near a pole."""

FOR_STABILITY = 4
"""Number of evaluations of DOP853 per time constant of the fastest mode, twice as many as stability requires."""

MOST_FOR_SIZES = 2**17
"""Largest number of steps in the run that determines the magnitudes of the states."""

EVERY = 256
"""Number of evaluations between two checks of the time limit."""


@dataclass(frozen=True)
class Law:
    """A control law."""

    name: str
    """Name of the law in results."""
    control: Control
    """Function of time and state that returns the controls in the model's order, without regard to bounds."""
    gain: Array | None = None
    """Gain K of shape (m, n) if the law is u = -K x, otherwise ``None``."""


@dataclass(frozen=True, eq=False)
class Run:
    """A motion under a control law."""

    x: Array
    u: Array
    """States (n, N+1) and controls (m, N+1) at the nodes; NaN after an early end."""
    steps: int
    """Number of steps of the integrator."""
    left_domain: bool
    """Whether the motion ended because a state that must be positive became zero."""


def simulate(
    instance: Instance,
    law: Law,
    nodes: Array,
    tolerance: float,
    dynamics: Function | None = None,
    limits: Limits | None = None,
) -> Run:
    """Simulate the motion under a control law whose controls are projected to the control set.

    Parameters
    ----------
    instance
        The instance.
    law
        The control law.
    nodes
        Times, shape (N+1,).
    tolerance
        Tolerance of each step, relative to the magnitude of each state.
    dynamics
        Function of t, x, u and p that returns the time derivatives of the states; by default that of the model.
    limits
        Limits of time.

    Raises
    ------
    TimeUp
        If the time limit is exceeded.
    """
    from scipy.integrate import solve_ivp

    most = MOST_EVALUATIONS + int(FOR_STABILITY * fastest(instance) * abs(nodes[-1] - nodes[0]))
    positive = [i for i, state in enumerate(instance.model.spec.states) if state.positive]

    def boundary(_t: float, x: Array) -> float:
        return float(min(x[i] for i in positive))

    boundary.terminal = True  # type: ignore[attr-defined]
    start = np.array(instance.initial)
    with np.errstate(all="ignore"):
        found = solve_ivp(
            _rates(instance, law, dynamics or instance.model.dynamics, most, limits),
            (float(nodes[0]), float(nodes[-1])),
            start,
            method="DOP853",
            t_eval=nodes,
            rtol=tolerance,
            atol=tolerance * _sizes(instance, nodes, limits),
            events=boundary if positive else None,
        )
    x = np.full((len(start), len(nodes)), np.nan)
    x[:, : found.y.shape[1]] = found.y

    def wanted(part: NDArray[Any]) -> Array:
        columns = zip(found.t[part].tolist(), found.y[:, part].T.tolist(), strict=True)
        return np.array([law.control(t, column) for t, column in columns]).T

    u = np.full((len(instance.model.spec.controls), len(nodes)), np.nan)
    every = np.arange(len(found.t))
    met = wanted(every) if limits is None else limits.in_blocks(wanted, every)
    u[:, : len(every)] = instance.control_set.project(met)
    return Run(x, u, found.nfev // 12, found.status == 1)


def _rates(
    instance: Instance, law: Law, dynamics: Function, most: int, limits: Limits | None
) -> Callable[[float, Array], list[float]]:
    """Return the right-hand side as a function of time and states.

    NaN where it is undefined, and after too many calls.
    """
    p, within, count = instance.parameters, instance.control_set.nearest(), 0

    def rates(t: float, x: Array) -> list[float]:
        nonlocal count
        count += 1
        if limits is not None and count % EVERY == 0:
            limits.check()
        if count > most:
            return [math.nan] * len(x)
        try:
            state = x.tolist()
            return list(dynamics(t, state, within(law.control(t, state)), p))
        except ArithmeticError:
            return [math.nan] * len(x)

    return rates


def _sizes(instance: Instance, nodes: Array, limits: Limits | None) -> Array:
    """Return the reference magnitudes of the states, their largest magnitudes in the uncontrolled motion."""
    steps = stable_steps(instance, len(nodes) - 1, MOST_FOR_SIZES)
    nodes = np.linspace(nodes[0], nodes[-1], steps + 1) if steps >= len(nodes) else nodes
    rest = np.zeros((len(instance.model.spec.controls), len(nodes)))
    x, _, _ = blocks.forward(instance.model, nodes, instance.initial, rest, rest[:, 1:], instance.parameters, limits)
    sizes = np.nan_to_num(np.abs(x), nan=0.0, posinf=0.0).max(axis=1)
    return np.where(sizes > 0.0, sizes, 1.0)
