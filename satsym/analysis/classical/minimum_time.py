"""Minimum time as a feedback: by the switching curve, through a relay with a deadband; and by pairs of pulses.

The relay switches where the position is past the curve by the deadband. It then runs alongside the curve, as far from
it as that, and stops where the rate has its final value: the position is within the deadband, by its width at most.

Pulses go by the position alone. Where its error exceeds the deadband, a generator holds the control at one bound and
then at the other, as least time takes that error away from rest, and then is off until the error exceeds the deadband
again. It does not know the rate, and a pair changes no rate: what the motion has at the beginning, it keeps.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from satsym.analysis.classical.arcs import MOST_ARCS, Arc, Plant, plant, simulation_of, within_already
from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solution import Simulation
from satsym.status import BadInput

SLACK = 1e-6
"""Share of the deadband for the rounding of what was switched at its edge."""


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
    """Arcs until the deadband is reached, and whether it is."""
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


def _said_of_pulses(found: Plant, arcs: list[Arc]) -> str:
    if len(arcs) >= MOST_ARCS:
        return f"the motion has not ended after {MOST_ARCS} pulses and pauses: widen the deadband, or shorten the time"
    last, name = arcs[-1].last, found.instance.model.spec.switching_curve[1]
    rate = float(last[found.rate])
    start = float(found.instance.initial[found.rate])
    if start:
        return (
            f"the final value of {name} is {rate:.6g}, not zero: the motion did not start at rest, and a "
            "feedback of the position alone does not detect this"
        )
    within = abs(found.error(last)) <= found.deadband
    return "within the deadband, at rest" if within else "outside the deadband at the final time"
