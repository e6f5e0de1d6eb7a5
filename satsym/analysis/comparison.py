"""Comparison of control laws: each instance is simulated or solved, and described by the same numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from satsym.analysis.classical import law as classical
from satsym.analysis.classical.signals import excesses, spans_of, totals
from satsym.analysis.coupling import Driver, reached, undriven
from satsym.arrays import Array
from satsym.instance import Instance, load
from satsym.solution import Solution
from satsym.solvers import solve
from satsym.status import BadInput

SAMPLES = 2000
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
        spec = self.instance.model.spec
        if name in spec.state_names:
            return self.x[spec.state_names.index(name)]
        if name in spec.control_names:
            return self.u[spec.control_names.index(name)]
        place = [v.symbol for v in spec.quantities].index(name)
        found: Array = self.instance.model.quantities_batch(self.times, self.x, self.u, self.instance.parameters)[place]
        return found


def compare(instances: Sequence[Instance], progress: Callable[[str], None] = lambda name: None) -> list[Case]:
    """Simulate or solve each of several instances.

    Parameters
    ----------
    instances
        Their models have the same controls, and begin with the same states.
    progress
        Called with the name of each before its turn, and with how far one that is driven has come.

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
    answered, none = simulation.status.answered, ()
    return Case(
        instance,
        "classical",
        answered,
        None,
        simulation.message,
        simulation.times,
        simulation.x,
        simulation.u,
        none,
        metrics,
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

    still, name, found = undriven(instance, share_of("not driven")), instance.driven.control, []
    for case in cases:
        spans = spans_of(case.times, case.x, case.u, case.switching_times)
        run = reached(
            instance,
            Driver(case.instance, spans, case.metrics.get("impulse", 0.0)),
            still,
            share_of(f"driven by {case.instance.name}"),
        )
        metrics = {"transition_time": case.metrics["transition_time"]} | run.metrics
        called = replace(instance, name=case.instance.name)
        said = f"{name} of {case.instance.name}"
        found.append(
            Case(called, said, True, None, run.message, run.times, run.x, run.u, case.switching_times, metrics)
        )
    return found


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
        times = np.linspace(0.0, RANGE_DURATION / damping, SAMPLES)
        for j, command in enumerate(commands):
            case = replace(instance, classical=replace(options, damping=damping, command=command))
            loop = classical.loop(case)
            z = loop.linear(initial, times)
            control[i, j], impulse[i, j] = np.abs(loop.control(z)).max(), loop.impulse
            for k, name in enumerate(spec.state_names):
                peaks[name][i, j] = np.abs(z[k]).max()
    return Range(np.array(dampings), np.array(commands), control, impulse, peaks)
