"""Minimum time as a feedback: by the switching curve, through a relay with a deadband; and by pairs of pulses.

The relay switches where the position is past the curve by the deadband. The state then moves alongside the curve, at
that distance from it, and stops where the rate has its final value: the position is within the deadband, by its width
at most. Pulses depend on the position alone. Where its error exceeds the deadband, a generator holds the control at one
bound and then at the other, in the minimum time that removes this error from rest, and is then off until the error
exceeds the deadband again. The generator does not measure the rate, and a pair of pulses does not change it: the
initial rate stays.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from satsym.analysis.classical.signals import Span, excesses, totals
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Simulation
from satsym.solvers.collocation.scaling import final_argument
from satsym.solvers.simulation.balances import balances
from satsym.status import BadInput, Status

TOLERANCE = 1e-13
"""Largest error of a step of the integration, relative to the size of each state."""
MOST_ARCS = 1000
STEPS_PER_SCALE = 20.0

Event = Callable[[Array], float]
"""A function of the state whose change from positive to negative ends an arc."""


@dataclass(frozen=True, eq=False)
class Arc:
    """A part of a motion under a constant control."""

    start: float
    end: float
    """Times at the beginning and the end of the arc."""
    control: float
    """The constant control on the arc."""
    states: Callable[[Array], Array]
    """A function from times within the arc, shape (K,), to states (n, K)."""
    event: int | None
    """Place of the event that ended the arc; ``None`` where its time was over."""

    @property
    def last(self) -> Array:
        """Return the state at the end of the arc, shape (n,)."""
        found: Array = self.states(np.array([self.end]))[:, 0]
        return found


@dataclass(frozen=True, eq=False)
class Plant:
    """The motion and the bounds that a switching feedback acts on."""

    instance: Instance
    """Instance whose model has a switching curve."""
    position: int
    rate: int
    """Places of the position and of its rate among the states."""
    target: tuple[float, float]
    """Target values of position and rate."""
    deadband: float
    """The tolerated position error."""
    final: tuple[float, ...]
    """The target in the form that generated functions take."""
    scale: float
    """A time within which the motion ends, which sets the steps and the time limit."""

    def error(self, x: Array) -> float:
        """Return the position error: the position less its target."""
        return float(x[self.position]) - self.target[0]

    def beyond(self, x: Array) -> float:
        """Return how far the position lies beyond the switching curve."""
        return float(self._of(self.instance.model.beyond_switching_curve, x))

    def law(self, x: Array) -> float:
        """Return the time-optimal control at a state."""
        return float(self._of(self.instance.model.feedback_law, x)[0])

    def durations(self, x: Array) -> tuple[float, float]:
        """Return the times of the change of position from rest to rest, and of its first arc."""
        model = self.instance.model
        return float(self._of(model.transition_time, x)), float(self._of(model.first_arc_time, x))

    def slopes(self, x: Array, control: float) -> Array:
        """Return the rates of change of the states under a control."""
        return np.array(self.instance.model.dynamics(self.instance.t0, x.tolist(), [control], self.instance.parameters))

    def past_curve(self, side: float) -> Event:
        """Return the event at which a state on one side is past the curve by the deadband.

        The side is 1 beyond the curve and -1 before it.
        """
        return lambda x: side * self.beyond(x) + self.deadband

    def at_rate(self, side: float) -> Event:
        """Return the event at which the rate reaches its target while it falls (1) or rises (-1)."""
        return lambda x: side * (float(x[self.rate]) - self.target[1])

    def _of(self, function: Callable[..., Any], x: Array) -> Any:
        case = self.instance
        return function(case.t0, x.tolist(), case.parameters, case.control_set.arguments, self.final)

    def follow(self, start: float, x: Array, control: float, end: float, events: Sequence[Event] = ()) -> Arc:
        """Integrate the motion under a constant control until a time, or the first event."""
        from scipy.integrate import solve_ivp

        sizes = np.maximum(np.abs(x), np.abs(self.slopes(x, control)) * self.scale)
        watched = [_watched(event) for event in events]
        run = solve_ivp(
            lambda _t, z: self.slopes(z, control),
            (start, end),
            x,
            method="DOP853",
            dense_output=True,
            events=watched or None,
            rtol=TOLERANCE,
            atol=TOLERANCE * np.where(sizes > 0.0, sizes, 1.0),
            max_step=self.scale / STEPS_PER_SCALE if control else np.inf,
        )
        hit = next((k for k, times in enumerate(run.t_events or ()) if len(times)), None)
        return Arc(start, float(run.t[-1]), control, run.sol, hit)


def plant(instance: Instance, feedback: str) -> Plant:
    """Return the motion and the bounds of an instance that a switching feedback acts on.

    Raises
    ------
    BadInput
        If the model has no switching curve, no deadband or no target is stated, or the bounds do not let the control
        work either way.
    """
    spec, name = instance.model.spec, instance.name
    if not spec.switching_curve:
        raise BadInput(f"{name}: --feedback {feedback}: model {spec.name} has no switching curve in closed form")
    if instance.deadband is None:
        raise BadInput(f"{name}: no [switching] table; add the table with the deadband, or choose another feedback")
    position, rate = (spec.state_names.index(state) for state in spec.switching_curve)
    for state in spec.switching_curve:
        if not isinstance(instance.final.get(state), float | int):
            raise BadInput(f"{name}: [final] {state}: missing; a switching feedback requires a given final value")
    (low,), (high,) = instance.lower, instance.upper
    if not -np.inf < low < 0.0 < high < np.inf:
        raise BadInput(
            f"{name}: [control] {spec.control_names[0]}: the bounds {low:g} and {high:g} must be finite, with "
            "0 between them; a switching feedback needs a control that can act in both directions"
        )
    final = final_argument(instance)
    target = final[2 * len(spec.states) + position], final[2 * len(spec.states) + rate]
    return Plant(instance, position, rate, target, instance.deadband, final, _scale(instance, position, rate, final))


def simulation_of(
    plant: Plant, feedback: str, arcs: Sequence[Arc], metrics: dict[str, float], message: str, answered: bool
) -> Simulation:
    """Join arcs to a simulation with its totals; `answered` tells whether the feedback reached its aim."""
    case, spec = plant.instance, plant.instance.model.spec
    begins = np.array([arc.start for arc in arcs])
    times = np.linspace(arcs[0].start, arcs[-1].end, case.solver.steps + 1)
    place = np.clip(np.searchsorted(begins, times, side="right") - 1, 0, len(arcs) - 1)
    x = np.hstack([arcs[k].states(times[place == k]) for k in np.unique(place)])
    u = np.array([[arcs[k].control for k in place]])
    spans = [_span(plant, arc) for arc in arcs if arc.end > arc.start]
    last = arcs[-1].last
    residuals = {
        f"{spec.state_names[k]}_residual": float(last[k]) - wanted
        for k, wanted in zip((plant.position, plant.rate), plant.target, strict=True)
    }
    metrics = metrics | residuals | {"deadband": plant.deadband} | totals(case, spans)
    status = Status.CONVERGED if answered else Status.NOT_CONVERGED
    if not np.isfinite(x).all():
        status, message = Status.NON_FINITE, f"the motion is not finite: {Status.NON_FINITE.advice}"
    return Simulation(
        instance=case,
        feedback=feedback,
        status=status,
        message="; ".join(filter(None, (message, excesses(case, metrics)))),
        times=times,
        x=x,
        u=u,
        invariants=balances(case, times, x, u),
        metrics=metrics,
    )


def within_already(plant: Plant) -> BadInput:
    """Return the refusal of an instance that starts within the deadband and states no final time."""
    (name, _), case = plant.instance.model.spec.switching_curve, plant.instance
    return BadInput(
        f"{case.called}: [initial] {name} is already within the deadband of its target; give another value, or a "
        "final time for the simulation"
    )


def _watched(event: Event) -> Callable[[float, Array], float]:
    def function(_t: float, x: Array) -> float:
        return event(x)

    function.terminal, function.direction = True, -1.0  # type: ignore[attr-defined]
    return function


def _span(plant: Plant, arc: Arc) -> Span:
    nodes = np.linspace(arc.start, arc.end, max(3, int(STEPS_PER_SCALE * (arc.end - arc.start) / plant.scale)))
    return Span(nodes, arc.states, lambda t: np.full((1, len(t)), arc.control))


def _scale(instance: Instance, position: int, rate: int, final: tuple[float, ...]) -> float:
    """Return a time within which the target is reached: the time to stop, and then to go all the way from rest."""
    case, model, n = instance, instance.model, len(instance.initial)
    x = np.array(case.initial)
    speeds = [abs(x[rate]), abs(final[2 * n + rate])]
    slopes = [abs(model.dynamics(case.t0, list(x), [u], case.parameters)[rate]) for u in (*case.lower, *case.upper)]
    faster = x.copy()
    faster[rate] = sum(speeds)
    stop = sum(speeds) / min(slopes)
    drift = abs(model.dynamics(case.t0, faster.tolist(), [0.0], case.parameters)[position]) * stop
    away = x.copy()
    away[position] = final[2 * n + position] + abs(x[position] - final[2 * n + position]) + drift + case.deadband
    whole = model.transition_time(case.t0, away.tolist(), case.parameters, case.control_set.arguments, final)
    return float(2.0 * (whole + stop))


SLACK = 1e-6
"""Fraction of the deadband that allows for rounding of an event at its edge."""


def by_relay(instance: Instance) -> Simulation:
    """Simulate an instance by its switching curve until it is within the deadband, or at its final time.

    Returns
    -------
    Simulation
        Its metrics have ``arrival_time`` after the beginning (where it arrives), ``switches``, and what is left of
        position and rate at the end, ``_residual``. With a final time the motion coasts from its arrival on.

    Raises
    ------
    BadInput
        If the instance does not suit this feedback.
    """
    found = plant(instance, "switching")
    arcs, arrived = _approach(found)
    metrics = {"switches": float(sum(a.control != b.control for a, b in pairwise(arcs)))}
    time, x = (arcs[-1].end, arcs[-1].last) if arcs else (instance.t0, np.array(instance.initial))
    if arrived:
        metrics = {"arrival_time": time - instance.t0} | metrics
    if arrived and instance.tf is not None and time < instance.tf:
        arcs.append(found.follow(time, x, 0.0, instance.tf))
    if not arcs:
        raise within_already(found)
    answered = arrived or instance.tf is not None
    return simulation_of(found, "switching", arcs, metrics, _said_of_relay(found, arrived), answered)


def _approach(found: Plant) -> tuple[list[Arc], bool]:
    """Return the arcs until the deadband is reached, and whether it is."""
    case, time, x = found.instance, found.instance.t0, np.array(found.instance.initial)
    end = case.t0 + found.scale if case.tf is None else case.tf
    arcs: list[Arc] = []
    while len(arcs) < MOST_ARCS and time < end:
        near = abs(found.beyond(x)) <= found.deadband * (1.0 + SLACK)
        off = float(x[found.rate]) - found.target[1]
        if near and not off:
            return arcs, True
        control = found.law(x)
        slope = float(found.slopes(x, control)[found.rate])
        side = -float(np.sign(slope))  # what lies beyond the curve has the control that lets the rate fall
        # an arc that starts beside the curve and leads on stays there, so that it arrives where the rate does
        arrives = near and off * slope < 0.0
        event = found.at_rate(side) if arrives else found.past_curve(side)
        arc = found.follow(time, x, control, end, [event])
        if arc.end == time:  # switched without having moved
            break
        arcs.append(arc)
        time, x = arcs[-1].end, arcs[-1].last
        if arrives and arcs[-1].event is not None:
            return arcs, True
    return arcs, False


def _said_of_relay(found: Plant, arrived: bool) -> str:
    if arrived:
        return "within the deadband, with the required final rate"
    if found.instance.tf is not None:
        return f"the motion has not reached the deadband of {found.deadband:g} at the final time"
    return (
        f"the motion does not reach the deadband of {found.deadband:g}, which is below the rounding error: widen "
        "the deadband"
    )


def by_pulses(instance: Instance) -> Simulation:
    """Simulate an instance with pairs of pulses: one pair, or until its final time.

    Returns
    -------
    Simulation
        Its metrics have ``arrival_time``, when the last pair is over, ``pairs``, and what is left of position and
        rate at the end, ``_residual``.

    Raises
    ------
    BadInput
        If the instance does not suit this feedback.
    """
    found = plant(instance, "pulses")
    if found.target[1]:
        name = instance.model.spec.switching_curve[1]
        raise BadInput(
            f"{instance.called}: [final] {name}: pairs of pulses always end at rest, so the final rate must be 0; "
            "write 0, or choose another feedback"
        )
    if instance.tf is None and abs(found.error(np.array(instance.initial))) <= found.deadband:
        raise within_already(found)
    arcs, pairs = _flown(found)
    metrics = {"pairs": float(pairs)}
    ends = [arc.end for arc in arcs if arc.control]
    if ends:
        metrics = {"arrival_time": ends[-1] - instance.t0} | metrics
    return simulation_of(found, "pulses", arcs, metrics, _said_of_pulses(found, arcs), len(arcs) < MOST_ARCS)


def _flown(found: Plant) -> tuple[list[Arc], int]:
    """Return the pulses with the arcs between them, and the number of pairs."""
    case, time, x = found.instance, found.instance.t0, np.array(found.instance.initial)
    end = np.inf if case.tf is None else case.tf
    arcs: list[Arc] = []
    pairs, exceeds = 0, abs(found.error(x)) > found.deadband
    while time < end and len(arcs) < MOST_ARCS:
        if not exceeds:
            arcs.append(found.follow(time, x, 0.0, end, [lambda z: found.deadband - abs(found.error(z))]))
        else:
            pairs += 1
            for control, duration in _pair(found, x):
                if time < end:
                    arcs.append(found.follow(time, x, control, min(time + duration, end)))
                    time, x = arcs[-1].end, arcs[-1].last
            if case.tf is None:
                break
        time, x = arcs[-1].end, arcs[-1].last
        exceeds = arcs[-1].event is not None or abs(found.error(x)) > found.deadband
    return arcs, pairs


def _pair(found: Plant, x: Array) -> list[tuple[float, float]]:
    """Return controls and durations of the two pulses that remove the position error from rest, whatever the rate."""
    seen = x.copy()
    seen[found.rate] = 0.0
    whole, first = found.durations(seen)
    control, bounds = found.law(seen), (found.instance.lower[0], found.instance.upper[0])
    return [(control, first), (bounds[control == bounds[0]], whole - first)]


def _said_of_pulses(found: Plant, arcs: list[Arc]) -> str:
    if len(arcs) >= MOST_ARCS:
        return f"the motion has not ended after {MOST_ARCS} pulses and pauses: widen the deadband, or shorten the time"
    last, name = arcs[-1].last, found.instance.model.spec.switching_curve[1]
    rate = float(last[found.rate])
    start = float(found.instance.initial[found.rate])
    if start:
        return (
            f"the final value of {name} is {rate:.6g}, not zero: the motion did not start at rest, and "
            "feedback of the position alone cannot detect this"
        )
    within = abs(found.error(last)) <= found.deadband
    return "within the deadband, at rest" if within else "outside the deadband at the final time"
