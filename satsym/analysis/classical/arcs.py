"""Motions under controls that are constant for a while: followed arc by arc, each as far as an event."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
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
    """Times."""
    control: float
    """What is held."""
    states: Callable[[Array], Array]
    """States (n, K) at times within, shape (K,)."""
    event: int | None
    """Place of the event that ended it; ``None`` where its time was over."""

    @property
    def last(self) -> Array:
        """The state at its end, shape (n,)."""
        found: Array = self.states(np.array([self.end]))[:, 0]
        return found


@dataclass(frozen=True, eq=False)
class Plant:
    """What a switching feedback acts on."""

    instance: Instance
    """Instance whose model has a switching curve."""
    position: int
    rate: int
    """Places of these states."""
    target: tuple[float, float]
    """Where they are to go."""
    deadband: float
    """Error of the position that is allowed."""
    final: tuple[float, ...]
    """The target as generated functions take it."""
    scale: float
    """A time within which the motion is over, for steps and to give up."""

    def error(self, x: Array) -> float:
        """By how much the position is past its target."""
        return float(x[self.position]) - self.target[0]

    def beyond(self, x: Array) -> float:
        """How far the position lies beyond the switching curve."""
        return float(self._of(self.instance.model.beyond_switching_curve, x))

    def law(self, x: Array) -> float:
        """The control of least time."""
        return float(self._of(self.instance.model.feedback_law, x)[0])

    def durations(self, x: Array) -> tuple[float, float]:
        """Durations of the change of position from rest to rest, and of its first arc."""
        model = self.instance.model
        return float(self._of(model.transition_time, x)), float(self._of(model.first_arc_time, x))

    def slopes(self, x: Array, control: float) -> Array:
        """Rates of change of the states."""
        return np.array(self.instance.model.dynamics(self.instance.t0, x.tolist(), [control], self.instance.parameters))

    def past_curve(self, side: float) -> Event:
        """Ends an arc on one side of the curve (1 beyond it, -1 before it) where it is past it by the deadband."""
        return lambda x: side * self.beyond(x) + self.deadband

    def at_rate(self, side: float) -> Event:
        """Ends an arc on which the rate falls (1) or rises (-1) to its target."""
        return lambda x: side * (float(x[self.rate]) - self.target[1])

    def _of(self, function: Callable[..., Any], x: Array) -> Any:
        case = self.instance
        return function(case.t0, x.tolist(), case.parameters, case.control_set.arguments, self.final)

    def follow(self, start: float, x: Array, control: float, end: float, events: Sequence[Event] = ()) -> Arc:
        """Hold a control until a time, or the first event."""
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
    """What a switching feedback acts on.

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
            "0 between them; a switching feedback must be able to push in both directions"
        )
    final = final_argument(instance)
    target = final[2 * len(spec.states) + position], final[2 * len(spec.states) + rate]
    return Plant(instance, position, rate, target, instance.deadband, final, _scale(instance, position, rate, final))


def simulation_of(
    plant: Plant, feedback: str, arcs: Sequence[Arc], metrics: dict[str, float], message: str, answered: bool
) -> Simulation:
    """The simulation that arcs make, with its totals; `answered` tells whether the feedback did what it is for."""
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
    """Return the refusal of an instance that begins within the deadband of its target and states no final time."""
    (name, _), case = plant.instance.model.spec.switching_curve, plant.instance
    return BadInput(
        f"{case.called}: [initial] {name} lies within the deadband of its target already; state another one, or a "
        "final time to simulate to"
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
    """A time within which the target is reached: to stop, and to go all the way there from rest."""
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
