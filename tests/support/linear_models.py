"""Linear systems that tests share."""

from __future__ import annotations

from typing import Any

import numpy as np

from satsym.analysis.linear.system import LinearSystem, system
from satsym.kernels import Kernels
from satsym.spec import ProblemSpec, Variable

OMEGA = 7.2921159e-5
"""Of the Earth, in rad/s."""


def satellite(omega: float = 1.0) -> LinearSystem:
    """Deviations from a circular orbit (Clohessy and Wiltshire), written out by hand; distance and angle measured."""
    A = [[0, 1, 0, 0], [3 * omega**2, 0, 0, 2 * omega], [0, 0, 0, 1], [0, -2 * omega, 0, 0]]
    return system(A, [[0, 0], [1, 0], [0, 0], [0, 1]], [[1, 0, 0, 0], [0, 0, 1, 0]], name="satellite")


def in_other_units(given: LinearSystem, seed: int, decades: float = 6.0) -> LinearSystem:
    """The same system with other units of its states, inputs, outputs and of time."""
    rng = np.random.default_rng(seed)
    x, u, y = (10.0 ** rng.uniform(-decades, decades, n) for n in map(len, (given.states, given.inputs, given.outputs)))
    rate = 10.0 ** rng.uniform(-decades, decades)
    return LinearSystem(
        given.A * x / x[:, None] * rate,
        given.B * u / x[:, None] * rate,
        given.C * x / y[:, None],
        given.D * u / y[:, None],
        given.states,
        given.inputs,
        given.outputs,
        given.name,
    )


def pendulum(damping: float = 0.5) -> Kernels:
    """q'' = -sin q - damping q' + torque, by hand: it rests hanging and standing."""

    def dynamics(t: float, x: Any, u: Any, p: Any) -> Any:
        return (x[1], -np.sin(x[0]) - p[0] * x[1] + u[0])

    def jacobian_x(t: float, x: Any, u: Any, p: Any) -> Any:
        return (0.0, 1.0, -np.cos(x[0]), -p[0])

    def dynamics_batch(t: float, x: Any, u: Any, p: Any) -> Any:
        return np.array([x[1], -np.sin(x[0]) - p[0] * x[1] + u[0]])

    spec = ProblemSpec(
        name="pendulum",
        title="A pendulum",
        source="a test",
        states=(Variable("q", "q", "rad"), Variable("w", "w", "rad/s")),
        controls=(Variable("torque", "u"),),
        parameters=(Variable("damping", "d", default=damping),),
        control_set=None,
        has_cost=False,
        has_terminal_cost=False,
        has_reference=False,
        autonomous=True,
    )
    functions = {
        "dynamics": dynamics,
        "jacobian_x": jacobian_x,
        "jacobian_u": lambda t, x, u, p: (0.0, 1.0),
        "dynamics_batch": dynamics_batch,
    }
    return Kernels(spec, functions)
