"""Comparison of control laws: each instance is simulated or solved, and described by the same numbers.

An instance may be driven by the control of other instances: its motion under that control is compared with its motion
without any, which shows how much reaches each state.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from satsym.analysis.classical import law as classical
from satsym.analysis.classical.signals import excesses, spans_of, totals
from satsym.arrays import Array
from satsym.grid import Grid
from satsym.instance import Instance, load
from satsym.kernels import Kernels
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import BadInput

Progress: TypeAlias = Callable[[float], None]
Torque: TypeAlias = tuple[float, float, Callable[[Array], Array]]
"""The driving control on a smooth part of the motion: begin, end, and the control as a function of time."""

TOLERANCE = 1e-7
"""Relative tolerance of the integration of driven motions."""
DRIVER_SAMPLES = 400
"""Number of values of the driving control in each smooth part, joined by straight lines."""
RANGE_SAMPLES = 2000
"""Number of times at which the linear motion is evaluated for a range."""
RANGE_DURATION = 16.0
"""Duration of the motions in a range, in units of 1 over the damping."""


@dataclass(frozen=True, eq=False)
class Case:
    """One of the cases that are compared."""

    instance: Instance
    how: str
    """Whether the case was simulated or solved, and by which law or method."""
    answered: bool
    verdict: str | None
    message: str
    """Whether there is an answer, the verdict of its certificate (``None`` for a simulation), and a sentence on both
    and on exceeded limits."""
    times: Array
    x: Array
    u: Array
    """Nodes (N+1,), states (n, N+1) and controls (m, N+1)."""
    switching_times: tuple[float, ...]
    """Times at which controls jump."""
    metrics: dict[str, float]
    """Metrics by name; empty where there is no answer."""
    solution: Solution | None = None
    """What a solver answered; ``None`` for a simulation."""

    def signal(self, name: str) -> Array:
        """Return a state, a control or a derived quantity at the nodes, by name."""
        return _signal(self.instance, name, self.times, self.x, self.u)


def _signal(instance: Instance, name: str, t: Array, x: Array, u: Array) -> Array:
    """Return a state, a control or a derived quantity over time, by name."""
    spec = instance.model.spec
    if name in spec.state_names:
        return x[spec.state_names.index(name)]
    if name in spec.control_names:
        return u[spec.control_names.index(name)]
    place = [v.symbol for v in spec.quantities].index(name)
    return np.asarray(instance.model.quantities_batch(t, x, u, instance.parameters)[place])


def compare(instances: Sequence[Instance], progress: Callable[[str], None] = lambda name: None) -> list[Case]:
    """Simulate or solve each of several instances.

    Parameters
    ----------
    instances
        Instances whose models have the same controls, and begin with the same states.
    progress
        Function that is called with the name of each instance before its turn, and with the progress of driven motions.

    Raises
    ------
    BadInput
        If they do not suit each other, or one states neither a law nor a cost.
    """
    first = instances[0].model.spec
    for other in instances[1:]:
        spec = other.model.spec
        shared = min(len(spec.states), len(first.states))
        if spec.controls != first.controls or spec.states[:shared] != first.states[:shared]:
            raise BadInput(
                f"{other.name}: its model {spec.name} does not have the states and controls of {first.name}, "
                f"the model of {instances[0].name}; compare instances of one system"
            )
    found = []
    for instance in instances:
        progress(instance.name)
        if instance.driven:
            found += driven(instance, progress)
        else:
            found.append(case_of(instance))
    return found


def case_of(instance: Instance) -> Case:
    """Simulate an instance under the law that it states, or solve it if it states none."""
    return _simulated(instance) if instance.classical else _solved(instance)


def _simulated(instance: Instance) -> Case:
    simulation = classical.simulate(instance)
    metrics = simulation.metrics
    if simulation.status.answered:
        metrics = {"transition_time": metrics.get("settling_time", math.nan)} | metrics
    return Case(
        instance=instance,
        how="classical",
        answered=simulation.status.answered,
        verdict=None,
        message=simulation.message,
        times=simulation.times,
        x=simulation.x,
        u=simulation.u,
        switching_times=(),
        metrics=metrics,
    )


def _solved(instance: Instance) -> Case:
    solution = solve(instance)
    answered, times = solution.status.answered, solution.times
    switches = tuple(sorted(s for each in solution.switching_times for s in each))
    metrics = _of_solution(instance, solution, switches) if answered else {}
    beyond = excesses(instance, metrics)
    return Case(
        instance=instance,
        how=solution.method,
        answered=answered,
        verdict=solution.certificate.verdict.value if solution.certificate else None,
        message=beyond or solution.message,
        times=times,
        x=solution.x,
        u=solution.u,
        switching_times=switches,
        metrics=metrics,
        solution=solution,
    )


def _of_solution(instance: Instance, solution: Solution, switches: Sequence[float]) -> dict[str, float]:
    spans = spans_of(solution.times, solution.x, solution.u, switches)
    duration = float(solution.times[-1] - solution.times[0])
    return {"transition_time": duration} | totals(instance, spans)


def limits_noted(solution: Solution) -> Solution:
    """Return the solution with a sentence on each limit of its instance that it exceeds."""
    if not solution.instance.limits or not solution.status.answered:
        return solution
    switches = [s for each in solution.switching_times for s in each]
    passed = excesses(solution.instance, _of_solution(solution.instance, solution, switches))
    return replace(solution, message=passed) if passed else solution


def driven(instance: Instance, progress: Callable[[str], None] = lambda name: None) -> list[Case]:
    """Simulate an instance with the control of each of some other instances, and without control.

    Raises
    ------
    BadInput
        If one of them has no answer, or none of them the control.
    """
    assert instance.driven is not None
    cases = []
    for driver in instance.driven.by:
        progress(driver)
        cases.append(_driving(instance, case_of(load(driver))))

    def share_of(what: str) -> Callable[[float], None]:
        return lambda share: progress(f"{instance.name}, {what}: {share:.0%}")

    still = undriven(instance, share_of("not driven"))
    return [reached(instance, case, still, share_of(f"driven by {case.instance.name}")) for case in cases]


def _driving(instance: Instance, case: Case) -> Case:
    """Return the solved case of an instance as the control that drives another instance."""
    assert instance.driven is not None
    name, spec = instance.driven.control, case.instance.model.spec
    if not case.answered:
        raise BadInput(f"{instance.called}: [driven] by: {case.instance.name} has no solution: {case.message}")
    if name not in (*spec.control_names, *(v.symbol for v in spec.quantities)):
        raise BadInput(
            f"{instance.called}: [driven] by: {case.instance.name} has no {name}; name instances that have this control"
        )
    return case


def _nodes(instance: Instance) -> Array:
    """Return the times at which driven motions are compared.

    Raises
    ------
    BadInput
        If the final time is free.
    """
    if instance.tf is None:
        raise BadInput(f"{instance.called}: time.tf: a driven motion requires a final time; give a number")
    return Grid.uniform(instance.t0, instance.tf, instance.solver.steps).nodes


def undriven(instance: Instance, progress: Progress = lambda share: None) -> Array:
    """Return the states at the nodes without control, shape (n, N+1), the same for every driving control."""
    return _followed(instance.model, instance.parameters, _nodes(instance), np.array(instance.initial), [], 0, progress)


def reached(instance: Instance, driver: Case, still: Array, progress: Progress = lambda share: None) -> Case:
    """Simulate the motion under the control of another case, and compare it with the uncontrolled one.

    The equations are stiff, as wheels nutate fast: an implicit method of order five (Radau) follows them, with the
    exact Jacobian. An impulse at the start makes the speeds jump by its effect on them.

    Parameters
    ----------
    driver
        The case whose control drives the instance.
    still
        The uncontrolled motion from the same start, see :func:`undriven`.
    progress
        Function that is called with the fraction of the time that has been integrated.

    Returns
    -------
    Case
        The driven motion. Its metrics are, for each state, the largest magnitude (``_peak``) and the largest difference
        from the motion without the control (``_driven``); for each state in the unit of the state that the control
        changes most, ``_share`` is the largest difference of its rate of change, relative to the largest of all in that
        unit.
    """
    assert instance.driven is not None
    model, p = instance.model, instance.parameters
    spec, place = model.spec, instance.model.spec.control_names.index(instance.driven.control)
    torques, slope = _signals(driver, instance.driven.control)
    impulse = driver.metrics.get("impulse", 0.0)
    nodes = _nodes(instance)
    count, start = len(spec.controls), np.array(instance.initial)
    column = np.reshape(model.jacobian_u(instance.t0, start.tolist(), (0.0,) * count, p), (-1, count))[:, place]
    moved = _followed(model, p, nodes, start + column * slope * impulse, torques, place, progress)
    u = np.zeros((count, len(nodes)))
    for a, b, torque in torques:
        within = (nodes >= a) & (nodes <= b)
        u[place, within] = torque(nodes[within])
    rates = [model.dynamics_batch(nodes, x, v, p) for x, v in ((moved, u), (still, 0.0 * u))]
    change, difference = np.abs(rates[0] - rates[1]).max(axis=1), np.abs(moved - still).max(axis=1)
    metrics = {"transition_time": driver.metrics["transition_time"]}
    if impulse:
        metrics["impulse"] = slope * impulse
    most = spec.states[int(np.abs(column).argmax())].unit
    for k, control in enumerate(spec.control_names):
        sudden = abs(slope * impulse) if k == place else 0.0
        metrics[f"{control}_peak"] = float(np.abs(u[k]).max())
        metrics[f"{control}_total"] = float(np.trapezoid(np.abs(u[k]), nodes)) + sudden
    for k, state in enumerate(spec.states):
        metrics[f"{state.symbol}_peak"] = float(np.abs(moved[k]).max())
        metrics[f"{state.symbol}_driven"] = float(difference[k])
        alike = max(change[i] for i, other in enumerate(spec.states) if other.unit == state.unit)
        if column.any() and state.unit == most and change[k] < alike:
            metrics[f"{state.symbol}_share"] = float(change[k] / alike)
    return Case(
        instance=replace(instance, name=driver.instance.name),
        how=f"{instance.driven.control} of {driver.instance.name}",
        answered=True,
        verdict=None,
        message=f"followed by Radau to {TOLERANCE:.0e}; {_said(spec.state_names, difference)}",
        times=nodes,
        x=moved,
        u=u,
        switching_times=driver.switching_times,
        metrics=metrics,
    )


def _said(names: Sequence[str], difference: Array) -> str:
    untouched = ", ".join(name for name, value in zip(names, difference, strict=True) if value == 0.0)
    if untouched:
        return f"states that the driving control does not affect: {untouched}"
    return "the driving control affects every state"


def _signals(driver: Case, name: str) -> tuple[list[Torque], float]:
    """Return the control on each smooth part, and its slope by the driver's own first control."""
    value = partial(_signal, driver.instance, name)
    found: list[Torque] = []
    for span in spans_of(driver.times, driver.x, driver.u, driver.switching_times):
        times = np.linspace(span.times[0], span.times[-1], DRIVER_SAMPLES)
        values = value(times, span.x(times), span.u(times))
        joined = lambda t, xp=times, fp=values: np.asarray(np.interp(t, xp, fp))  # noqa: E731
        found.append((float(times[0]), float(times[-1]), joined))
    at, x = np.array([driver.instance.t0]), np.array(driver.instance.initial)[:, None]
    one = np.zeros((len(driver.u), 1))
    slope = value(at, x, one + 1.0) - value(at, x, one)
    return found, float(slope[0])


def _followed(
    model: Kernels,
    p: Sequence[float],
    nodes: Array,
    start: Array,
    torques: Sequence[Torque],
    place: int,
    progress: Progress,
) -> Array:
    """Integrate the states part by part to the nodes; no control acts after the last part."""
    from scipy.integrate import solve_ivp

    n, x, parts = len(start), start, list(torques)
    end = parts[-1][1] if parts else float(nodes[0])
    if end < nodes[-1]:
        parts.append((end, float(nodes[-1]), lambda t: np.zeros(np.shape(t))))
    found = np.full((n, len(nodes)), np.nan)
    u = [0.0] * len(model.spec.controls)
    sizes = np.maximum(np.abs(start), 1e-6)

    for a, b, torque in parts:

        def controls(t: float, torque: Callable[[Array], Array] = torque) -> list[float]:
            return [*u[:place], float(torque(np.array(t))), *u[place + 1 :]]

        def rates(t: float, y: Array, controls: Any = controls) -> Array:
            progress((t - nodes[0]) / (nodes[-1] - nodes[0]))
            return np.array(model.dynamics(t, y.tolist(), controls(t), p))

        def slopes(t: float, y: Array, controls: Any = controls) -> Array:
            return np.reshape(model.jacobian_x(t, y.tolist(), controls(t), p), (n, n))

        b = min(b, float(nodes[-1]))
        run = solve_ivp(
            rates, (a, b), x, "Radau", dense_output=True, jac=slopes, rtol=TOLERANCE, atol=TOLERANCE * sizes
        )
        within = (nodes >= a) & (nodes <= b)
        if not run.success or not within.any():
            break
        found[:, within] = run.sol(nodes[within])
        x = run.y[:, -1]
    return found


@dataclass(frozen=True, eq=False)
class Range:
    """The performance of the classical law for other dampings and commands."""

    dampings: Array
    commands: Array
    """Dampings, shape (K,), and commands, shape (L,)."""
    control_peak: Array
    impulse: Array
    """Largest magnitude of the control after the step, and its integral at the step; shape (K, L)."""
    peaks: Mapping[str, Array]
    """The largest magnitude of each state, by name, shape (K, L)."""


def ranged(instance: Instance, dampings: Sequence[float], commands: Sequence[float]) -> Range:
    """Compute the linear motion under the law of an instance for other dampings and commands.

    Raises
    ------
    BadInput
        If the instance states no law with a damping, or one of these is not positive.
    """
    options = instance.classical
    if options is None or options.damping is None:
        raise BadInput(
            f"{instance.called}: [classical] damping: missing; a range of dampings requires an initial value"
        )
    if not all(d > 0.0 and math.isfinite(d) for d in dampings):
        raise BadInput(f"{instance.called}: all dampings of a range must be positive")
    spec, shape = instance.model.spec, (len(dampings), len(commands))
    control, impulse = np.empty(shape), np.empty(shape)
    peaks = {name: np.empty(shape) for name in spec.state_names}
    initial = np.array(instance.initial)
    for i, damping in enumerate(dampings):
        times = np.linspace(0.0, RANGE_DURATION / damping, RANGE_SAMPLES)
        for j, command in enumerate(commands):
            case = replace(instance, classical=replace(options, damping=damping, command=command))
            loop = classical.loop(case)
            z = loop.linear(initial, times)
            control[i, j], impulse[i, j] = np.abs(loop.control(z)).max(), loop.impulse
            for k, name in enumerate(spec.state_names):
                peaks[name][i, j] = np.abs(z[k]).max()
    return Range(np.array(dampings), np.array(commands), control, impulse, peaks)
