"""Simulation of many motions of one instance at once, each under its own controls."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from satsym.arrays import Array
from satsym.instance import Instance


@dataclass(frozen=True, eq=False)
class Step:
    """One Runge-Kutta step of many motions.

    Attributes
    ----------
    times, states
        Times (4, S) and states (4, n, S) of the four stages.
    controls
        Controls (4, m, S) of the four stages.
    end
        States after the step, shape (n, S).
    """

    times: Array
    states: Array
    controls: Array
    end: Array


def steps_together(instance: Instance, start: Array, controls: Array, lasting: Array) -> Iterator[Step]:
    """Yield the steps of S motions by the classical Runge-Kutta method, all integrated at once.

    Parameters
    ----------
    instance
        The instance.
    start
        Initial states, shape (n, S).
    controls
        Controls at the nodes and midpoints of N steps, shape (2 N + 1, m, S).
    lasting
        Durations, shape (S,).
    """
    rates, p, steps, x = instance.model.dynamics_batch, instance.parameters, len(controls) // 2, start
    h = lasting / steps
    for k in range(steps):
        times = instance.t0 + (k + np.array([[0.0], [0.5], [0.5], [1.0]])) * h
        u = controls[[2 * k, 2 * k + 1, 2 * k + 1, 2 * k + 2]]
        states, slopes = [x], list[Array]()
        for stage, share in enumerate((0.5, 0.5, 1.0, 0.0)):
            slopes.append(np.asarray(rates(times[stage], states[-1], u[stage], p)))
            states.append(x + share * h * slopes[-1])
        x = x + h / 6.0 * (slopes[0] + 2.0 * (slopes[1] + slopes[2]) + slopes[3])
        yield Step(times, np.array(states[:4]), u, x)


def costs_together(instance: Instance, controls: Array, lasting: Array, start: Array | None = None) -> Array:
    """Return the costs of S motions, shape (S,); infinite if a motion leaves its domain.

    Parameters
    ----------
    instance
        The instance.
    controls
        Controls at the nodes and midpoints of N steps, shape (m, 2 N + 1, S); they are projected to their bounds.
    lasting
        Durations, shape (S,).
    start
        Initial states, shape (n, S); by default the initial state of the instance.
    """
    model, p = instance.model, instance.parameters
    if start is None:
        start = np.repeat(np.array(instance.initial)[:, None], len(lasting), axis=1)
    within = np.array([instance.control_set.project(u) for u in controls.transpose(1, 0, 2)])
    states, total, h = [start], np.zeros(len(lasting)), 2.0 * lasting / (len(within) - 1)
    with np.errstate(all="ignore"):
        for step in steps_together(instance, start, within, lasting):
            stages = zip((1.0, 2.0, 2.0, 1.0), step.times, step.states, step.controls, strict=True)
            total += h / 6.0 * sum(w * np.asarray(model.running_cost_batch(t, x, u, p)) for w, t, x, u in stages)
            states.append(step.end)
        found = np.array(states)
        positive = [i for i, state in enumerate(model.spec.states) if state.positive]
        inside = np.isfinite(found).all(axis=(0, 1)) & (found[:, positive] > 0.0).all(axis=(0, 1))
        ends = zip(instance.t0 + lasting, states[-1].T, inside, strict=True)
        total += [_terminal_cost(instance, float(t), end) if ok else np.inf for t, end, ok in ends]
    return np.where(inside & np.isfinite(total), total, np.inf)


def _terminal_cost(instance: Instance, t: float, end: Array) -> float:
    """Return the terminal cost of a final state; infinite if it overflows or is not defined there."""
    try:
        return instance.model.terminal_cost(t, tuple(end.tolist()), instance.parameters)
    except (ArithmeticError, ValueError):
        return float("inf")
