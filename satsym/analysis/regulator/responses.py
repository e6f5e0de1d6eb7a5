"""What becomes of a disturbance: without control and with the gain, by the linear system and by the exact motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from satsym.analysis.linear.system import LinearSystem
from satsym.analysis.regulator.feedback import Design, gain, law, running_cost
from satsym.analysis.regulator.lqr import Regulator
from satsym.arrays import Array
from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solvers.simulation import closed_loop

STEPS = 1000
"""Intervals of the time grid on which responses are given."""
TOLERANCE = 1e-9


@dataclass(frozen=True, eq=False)
class Response:
    """Deviations x, shape (n, N+1), and active inputs u, shape (m, N+1)."""

    x: Array
    u: Array

    def cost(self, found: Regulator, times: Array) -> Array:
        """Integral of x'Qx + 2x'Nu + u'Ru from the first time to each, shape (N+1,)."""
        rate = running_cost(found, self.x, self.u)
        steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(times)
        return np.concatenate([[0.0], np.cumsum(steps)])


@dataclass(frozen=True, eq=False)
class Responses:
    """Responses to one disturbance: of the linear and of the whole equations, with and without feedback."""

    times: Array
    """Shape (N+1,)."""
    free: Response
    steered: Response
    """By the linear system, without control and with the gain."""
    exact_free: Response | None
    exact_steered: Response | None
    """By the exact motion, within the instance's bounds; ``None`` where none is known but the linear one."""


def responses(design: Design, case: Instance) -> Responses:
    """Responses to the initial deviation of an instance, from its initial to its final time."""
    assert case.tf is not None
    times, start = Grid.uniform(case.t0, case.tf, STEPS).nodes, np.array(case.initial) - design.about.point
    system, rest = design.regulator.system, np.zeros((len(design.regulator.system.inputs), STEPS + 1))
    return Responses(
        times=times,
        free=Response(linear_motion(system, start, times), rest),
        steered=_steered(design, start, times),
        exact_free=_exact(design, case, times, steered=False) if design.about.nonlinear else None,
        exact_steered=_exact(design, case, times, steered=True) if design.about.nonlinear else None,
    )


def linear_motion(system: LinearSystem, start: Array, times: Array) -> Array:
    """Solution of x' = A x at evenly spaced times, shape (n, N+1)."""
    step = system.transition(float(times[1] - times[0]))
    path = [np.asarray(start, dtype=float)]
    for _ in times[1:]:
        path.append(step @ path[-1])
    return np.array(path).T


def _steered(design: Design, start: Array, times: Array) -> Response:
    found = design.regulator
    if found.horizon is None:
        x = linear_motion(found.closed_loop, start, times)
        return Response(x, -found.K @ x)
    from scipy.integrate import solve_ivp

    system, K = found.system, gain(design.about, found)
    x = solve_ivp(
        lambda t, x: system.A @ x - system.B @ (np.array(K(t)) @ x),
        (times[0], times[-1]),
        start,
        method="DOP853",
        t_eval=times,
        rtol=TOLERANCE,
        atol=TOLERANCE * np.abs(linear_motion(system, start, times)).max(axis=1),
    ).y
    return Response(x, -np.einsum("kij,jk->ik", np.array([K(t) for t in times]), x))


def _exact(design: Design, case: Instance, times: Array, steered: bool) -> Response:
    """The exact motion; by the same law with or without its effect."""
    acting = law(design.about, design.regulator)
    nothing = [0.0] * len(case.model.spec.controls)
    driven = acting if steered else replace(acting, control=lambda t, x: nothing)
    run = closed_loop.simulate(case, driven, times, TOLERANCE, design.about.rates)
    places = [design.about.system.inputs.index(name) for name in design.regulator.system.inputs]
    return Response(run.x - np.array([design.about.at(t) for t in times]).T, run.u[places])
