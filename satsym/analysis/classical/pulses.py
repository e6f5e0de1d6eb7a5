"""Least time by the position alone: a comparator, and a generator of pairs of pulses.

Where the error of the position exceeds the deadband, the generator holds the control at one bound and then at the
other, as least time takes that error away from rest, and then is off until the error exceeds the deadband again. It
does not know the rate, and a pair changes no rate: what the motion has at the beginning, it keeps.
"""

from __future__ import annotations

import numpy as np

from satsym.analysis.classical.arcs import MOST_ARCS, Arc, Plant, plant, simulation_of, within_already
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Simulation
from satsym.status import BadInput


def simulate(instance: Instance) -> Simulation:
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
        raise BadInput(f"{instance.called}: [final] {name}: pairs of pulses end at rest; write 0, or choose another")
    if instance.tf is None and abs(found.error(np.array(instance.initial))) <= found.deadband:
        raise within_already(found)
    arcs, pairs = _flown(found)
    metrics = {"pairs": float(pairs)}
    ends = [arc.end for arc in arcs if arc.control]
    if ends:
        metrics = {"arrival_time": ends[-1] - instance.t0} | metrics
    return simulation_of(found, "pulses", arcs, metrics, _message(found, arcs), len(arcs) < MOST_ARCS)


def _flown(found: Plant) -> tuple[list[Arc], int]:
    """Pulses and what is between them; and how many pairs."""
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
    """Controls and durations of the two pulses that take the error away from rest; the rate is not looked at."""
    seen = x.copy()
    seen[found.rate] = 0.0
    whole, first = found.durations(seen)
    control, bounds = found.law(seen), (found.instance.lower[0], found.instance.upper[0])
    return [(control, first), (bounds[control == bounds[0]], whole - first)]


def _message(found: Plant, arcs: list[Arc]) -> str:
    if len(arcs) >= MOST_ARCS:
        return f"not over after {MOST_ARCS} pulses and pauses: widen the deadband, or shorten the time"
    last, name = arcs[-1].last, found.instance.model.spec.switching_curve[1]
    rate = float(last[found.rate])
    start = float(found.instance.initial[found.rate])
    if start:
        return f"{name} is still {rate:.6g}: it was not at rest, and the position alone does not show it"
    within = abs(found.error(last)) <= found.deadband
    return "within the deadband, at rest" if within else "outside the deadband at the final time"
