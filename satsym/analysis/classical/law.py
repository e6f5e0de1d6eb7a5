"""The classical control law of a single axis: proportional and derivative action on the error after a step command.

The gains for critical damping, and the torque that cancels the body's own torque, follow from the linearised motion.
The rate is measured by a differentiator, which is ideal or has a lag. An ideal one turns the step into an impulse: the
states jump at the beginning.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from satsym.analysis.classical.signals import Span, excesses, performance, totals
from satsym.arrays import Array
from satsym.grid import Grid
from satsym.instance import Instance
from satsym.solution import Simulation
from satsym.solvers import iteration
from satsym.solvers.iteration import Limits, TimeUp, watched
from satsym.solvers.simulation.balances import balances
from satsym.status import BadInput, Status

if TYPE_CHECKING:
    from scipy.integrate import OdeSolution

TOLERANCE = 1e-13
"""Largest error of a step of the integration, relative to the size of each state."""
MOST_STEPS = 10_000
"""Largest length of a simulation, in time constants of the loop's fastest motion."""


@dataclass(frozen=True, eq=False)
class Loop:
    """The classical law of an instance, and the linear motion of the closed loop."""

    follows: int
    rate: int
    """Places of the state that follows the command and of the state that is its rate."""
    gains: tuple[float, float]
    """Gains of the rate and of the state."""
    compensation: float
    """Control for each unit of the state that follows, which cancels the body's own torque."""
    command: float
    differentiator: float
    """The command, and the time constant of the differentiator, as the instance states them."""
    jump: Array
    """The change of the states at the moment of the step, shape (n,)."""
    impulse: float
    """The integral of the control over the moment of the step."""
    matrix: Array
    offset: Array
    """The linear motion under the law, z' = M z + c; the last entry of z is the measured error where the differentiator
    has a lag."""

    @property
    def fastest(self) -> float:
        """Return the largest magnitude of the closed loop's poles."""
        return float(np.abs(np.linalg.eigvals(self.matrix)).max())

    def control(self, z: Array) -> Array:
        """Return the control at states (with the measured error), shape (n,) or (n, M)."""
        error = self.command - z[self.follows]
        if self.differentiator:
            slope = (error - z[-1]) / self.differentiator
        else:
            slope = -z[self.rate]
        found: Array = self.compensation * z[self.follows] + self.gains[0] * slope + self.gains[1] * error
        return found

    def start(self, initial: Array) -> Array:
        """Return the states just after the step, with the measured error if the differentiator has a lag."""
        return np.append(initial, 0.0) if self.differentiator else initial + self.jump

    def linear(self, initial: Array, times: Array) -> Array:
        """Return the linear motion at evenly spaced times by matrix exponentials; shape (n or n+1, M)."""
        from scipy.linalg import expm

        size = len(self.offset)
        whole = np.zeros((size + 1, size + 1))
        whole[:size, :size], whole[:size, size] = self.matrix, self.offset
        later = expm(whole * (times[-1] - times[0]) / (len(times) - 1))
        found = np.append(self.start(initial), 1.0)[:, None]
        while found.shape[1] < len(times):  # as many again, so much later
            found, later = np.hstack([found, later @ found]), later @ later
        return found[:size, : len(times)]


def loop(instance: Instance) -> Loop:
    """Return the closed loop of an instance under its classical law.

    Raises
    ------
    BadInput
        If the instance states no law, or its control does not act on the state that is to follow.
    """
    options, spec, model = instance.classical, instance.model.spec, instance.model
    if options is None:
        raise BadInput(
            f"{instance.called}: no [classical] table; add the table with the control law, or choose another feedback"
        )
    rest, none = [0.0] * len(spec.states), [0.0]
    a = np.array(model.jacobian_x(instance.t0, rest, none, instance.parameters)).reshape(len(rest), -1)
    b = np.array(model.jacobian_u(instance.t0, rest, none, instance.parameters)).ravel()
    place = spec.state_names.index(options.follows)
    (rates,) = np.nonzero(a[place])
    if len(rates) != 1 or a[place, rates[0]] != 1.0 or not b[rates[0]] or b[place]:
        raise BadInput(
            f"{instance.called}: [classical] follows: the control does not act on the rate of {options.follows}"
        )
    rate = int(rates[0])
    if options.gains is not None:
        gains = options.gains
    else:
        assert options.damping is not None
        gains = (2.0 * options.damping / b[rate], options.damping**2 / b[rate])
    compensation = -a[rate, place] / b[rate]
    step = options.command - instance.initial[place]
    impulse = 0.0 if options.differentiator else gains[0] * step
    return Loop(
        follows=place,
        rate=rate,
        gains=gains,
        compensation=compensation,
        command=options.command,
        differentiator=options.differentiator,
        jump=b * impulse,
        impulse=impulse,
        **_linear(a, b, place, rate, gains, compensation, options.command, options.differentiator),
    )


@np.errstate(all="ignore")  # numbers out of range are a status
def simulate(instance: Instance) -> Simulation:
    """Simulate an instance under its classical law.

    Returns
    -------
    Simulation
        The motion; its controls leave out the impulse at the beginning, which is in `metrics`.

    Raises
    ------
    BadInput
        If there is no such law, no final time, or one that is very long for so fast a loop.
    """
    if instance.tf is None:
        raise BadInput(f"{instance.called}: time.tf: a simulation requires a final time; give a number")
    found = loop(instance)
    if found.fastest * (instance.tf - instance.t0) > MOST_STEPS:
        raise BadInput(
            f"{instance.called}: [classical]: the shortest time constant of the loop, "
            f"{1.0 / found.fastest:.3g}, is too short for a simulation until {instance.tf:.6g}; shorten "
            "time.tf, or use a slower control law or a slower differentiator"
        )
    limits, _ = watched(instance, None)
    try:
        return _simulated(instance, found, limits)
    except TimeUp:
        return iteration.unsimulated(instance, "classical")


def _simulated(instance: Instance, found: Loop, limits: Limits) -> Simulation:
    assert instance.tf is not None
    n = len(instance.model.spec.states)
    times = Grid.uniform(instance.t0, instance.tf, instance.solver.steps).nodes
    initial = np.array(instance.initial)
    z, dense = _flown(instance, found, times, found.start(initial), limits)
    status = Status.CONVERGED if np.isfinite(z).all() else Status.NON_FINITE
    x, u = z[:n], found.control(z)[None]
    metrics: dict[str, float] = {"gain_rate": found.gains[0], "gain_state": found.gains[1]}
    if status is Status.CONVERGED:

        def seen(at: Array) -> Array:
            limits.check()
            return np.asarray(dense(at))

        span = Span(np.union1d(times, dense.ts), lambda t: seen(t)[:n], lambda t: found.control(seen(t))[None])
        metrics |= performance(span.times, span.x, found.follows, float(initial[found.follows]), found.command)
        metrics |= totals(instance, [span], found.impulse)
    return Simulation(
        instance=instance,
        feedback="classical",
        status=status,
        message=_message(instance, status, metrics),
        times=times,
        x=x,
        u=u,
        invariants=balances(instance, times, x, u) if status is Status.CONVERGED else {},
        metrics=metrics,
    )


def _linear(
    a: Array,
    b: Array,
    place: int,
    rate: int,
    gains: tuple[float, float],
    compensation: float,
    command: float,
    lag: float,
) -> dict[str, Array]:
    """Return matrix and offset of the linear motion."""
    n, by_rate, by_state = len(a), *gains
    row, constant = np.zeros(n + bool(lag)), by_state * command
    row[place] = compensation - by_state
    if lag:
        # the measured error y follows the error e with y' = (e - y) / lag, and its slope stands for the rate
        row[place] -= by_rate / lag
        row[-1] = -by_rate / lag
        constant += by_rate * command / lag
    else:
        row[rate] = -by_rate
    matrix, offset = np.zeros((len(row), len(row))), np.zeros(len(row))
    matrix[:n, :n] = a
    matrix[:n] += np.outer(b, row)
    offset[:n] = b * constant
    if lag:
        matrix[-1, place], matrix[-1, -1], offset[-1] = -1.0 / lag, -1.0 / lag, command / lag
    return {"matrix": matrix, "offset": offset}


def _flown(instance: Instance, found: Loop, times: Array, start: Array, limits: Limits) -> tuple[Array, OdeSolution]:
    """Integrate the motion, and return it at the nodes and between them, with the steps taken."""
    from scipy.integrate import solve_ivp

    n, f, p = len(instance.model.spec.states), instance.model.dynamics, instance.parameters

    def rates(t: float, z: Array) -> Array:
        limits.check()
        u = float(found.control(z))
        change = np.array(f(t, z[:n].tolist(), [u], p))
        if not found.differentiator:
            return change
        return np.append(change, (found.command - z[found.follows] - z[-1]) / found.differentiator)

    largest = max(abs(found.command), abs(start[found.follows]))
    sizes = np.maximum(np.abs(start), largest * np.abs(found.matrix).max(axis=1))
    sizes[sizes == 0.0] = 1.0
    with np.errstate(all="ignore"):
        run = solve_ivp(
            rates,
            (float(times[0]), float(times[-1])),
            start,
            method="DOP853",
            t_eval=times,
            dense_output=True,
            rtol=TOLERANCE,
            atol=TOLERANCE * sizes,
            max_step=1.0 / found.fastest,  # so that what lies between the steps is as accurate
        )
    z = np.full((len(start), len(times)), np.nan)
    z[:, : run.y.shape[1]] = run.y
    return z, run.sol


def _message(instance: Instance, status: Status, metrics: dict[str, float]) -> str:
    if status is not Status.CONVERGED:
        return f"the motion is not finite: {status.advice}"
    law = instance.classical
    assert law is not None
    unsettled = math.isnan(metrics.get("settling_time", 0.0))
    said = [excesses(instance, metrics), f"{law.follows} has not settled by the final time" if unsettled else ""]
    return "; ".join(filter(None, said)) or "simulated by a method of order eight with small steps"
