"""Least time as a feedback: the control by the side of the switching curve, through a relay with a deadband.

The relay switches where the position is past the curve by the deadband. It then runs alongside the curve, as far from
it as that, and stops where the rate has its final value: the position is within the deadband, by its width at most.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from satsym.analysis.classical.arcs import MOST_ARCS, Arc, Plant, plant, simulation_of, within_already
from satsym.instance import Instance
from satsym.solution import Simulation

SLACK = 1e-6
"""Share of the deadband for the rounding of what was switched at its edge."""


def simulate(instance: Instance) -> Simulation:
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
    return simulation_of(found, "switching", arcs, metrics, _message(found, arrived), answered)


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


def _message(found: Plant, arrived: bool) -> str:
    if arrived:
        return "within the deadband at the final rate"
    if found.instance.tf is not None:
        return f"not within the deadband of {found.deadband:g} by the final time"
    return f"does not come within the deadband of {found.deadband:g}, which is lost in rounding: widen it"
