"""Constraints that no motion can keep: violated where it starts or ends, or against each other."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained.arcs import terms, values
from satsym.solvers.constrained.regularised.slopes import Slopes, rooms
from satsym.solvers.constrained.regularised.stagewise import Factors
from satsym.solvers.constrained.regularised.starts import straight
from satsym.solvers.constrained.regularised.transcription import Point, Program
from satsym.status import BadInput

ROUNDING = 1e-12
"""Of a constraint that holds exactly, relative to its terms."""


WEIGHTS, NEWTON = (1e2, 1e4, 1e6, 1e8), 40
"""Of squared violations, relative to the cost, and steps for each."""

REMAINING = 0.5
"""Share of a violation that a hundred times the weight, or steps of half the length, leave where it is unavoidable."""

UNAVOIDABLE = 1e-7
"""Least violation, relative to the constraint's size, and least share of the cost, that exceed rounding."""


DURATIONS = (0.37, 1.0, 2.6)
"""Of the guessed one: where it is looked whether a constraint at the given end changes with time."""


def refuse(instance: Instance) -> None:
    """Refuse an instance whose given start or end violates a constraint, or leaves it at once.

    Raises
    ------
    BadInput
        At the first of them.
    """
    program = Program(instance, 2)
    _refuse_at(instance, instance.t0, instance.initial, "initial", 1.0)
    if len(program.given) == len(instance.initial) and instance.tf is not None:
        _refuse_at(instance, instance.tf, tuple(program.target(instance.tf - instance.t0).tolist()), "final", -1.0)
        return
    end = program.kept[:, -1] == 0.0
    if end.any() and (instance.tf is not None or _stands(program, end)):
        tf = instance.t0 + program.guessed
        _refuse_values(instance, tf, _end(program, program.guessed), "final", end)


def _end(program: Program, duration: float) -> tuple[float, ...]:
    """What is given of the final state after a duration, zero where nothing is."""
    is_given = np.isin(np.arange(len(program.instance.initial)), program.given)
    return tuple(np.where(is_given, program.target(duration), 0.0).tolist())


def _stands(program: Program, which: NDArray[np.bool_]) -> bool:
    """Whether these constraints have the same value at the given end whenever that is reached."""
    instance, rest = program.instance, np.zeros((len(program.instance.model.spec.controls), 1))
    found = [
        values(instance, np.array([instance.t0 + duration]), np.array(_end(program, duration))[:, None], rest)[which, 0]
        for duration in (program.guessed * share for share in DURATIONS)
    ]
    return all(np.array_equal(one, found[0]) for one in found)


def _refuse_at(instance: Instance, time: float, state: tuple[float, ...], key: str, direction: float) -> None:
    """At a state that is known as a whole; what is rounding of its terms is nothing."""
    model, p = instance.model, instance.parameters
    _refuse_values(instance, time, state, key, np.ones(len(model.spec.path_constraints), bool))
    t, x, rest = np.array([time]), np.array(state)[:, None], np.zeros((len(model.spec.controls), 1))
    g, size = values(instance, t, x, rest)[:, 0], terms(instance, t, x, rest)[:, 0]

    def rates_at(at: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(model.path_rates_batch(t, at, rest.astype(at.dtype), p)).reshape(len(g), 2, -1)[:, 0, 0]

    moved = x + 1j * COMPLEX_STEP * np.eye(len(x))
    slopes = np.column_stack([np.imag(rates_at(moved[:, [j]])) for j in range(len(x))]) / COMPLEX_STEP
    faint = ROUNDING * np.abs(slopes) @ np.abs(x)[:, 0]
    for one, value, scale, rate, nothing in zip(model.spec.path_constraints, g, size, rates_at(x), faint, strict=True):
        if one.order > 1 and abs(value) <= ROUNDING * scale and direction * rate > nothing:
            when = "after the start" if direction > 0 else "before the end"
            raise BadInput(
                f"{instance.called}: {key}: path constraint {one.name} is met with the rate {rate:.6g}, which no "
                f"control changes at once, so it is violated right {when}; change the velocity there"
            )


def _refuse_values(
    instance: Instance,
    time: float,
    state: tuple[float, ...],
    key: str,
    which: NDArray[np.bool_],
) -> None:
    spec, place = instance.model.spec, (np.array([time]), np.array(state)[:, None])
    rest = np.zeros((len(spec.controls), 1))
    g, size = values(instance, *place, rest)[:, 0], terms(instance, *place, rest)[:, 0]
    for one, value, scale, counts in zip(spec.path_constraints, g, size, which, strict=True):
        if counts and one.order and value > ROUNDING * max(float(scale), 1e-300):
            raise BadInput(
                f"{instance.called}: {key}: path constraint {one.name} is {value:.6g} there and may not be positive; "
                "change that state, or the constraint's parameters"
            )


def impossible(program: Program, worth: float) -> str:
    """What stands against each other where no path of a convex problem is admissible; empty where that is not shown.

    Violations are penalised by their squares, more and more: where some path is admissible they vanish like one over
    the weight, else they tend to the least that there are, and the cost to that of such a path. What the discretisation
    alone violates is less on a finer mesh.
    """
    coarse = _remaining(program, worth)
    fine = None if coarse is None else _remaining(Program(program.instance, 2 * program.intervals), worth)
    if coarse is None or fine is None or not fine.max() > REMAINING * coarse.max():
        return ""
    names = [one.name for one in program.instance.model.spec.path_constraints]
    violated = ", ".join(name for name, left in zip(names, fine, strict=True) if left > 0.01 * fine.max())
    return f"no motion to the given end keeps to the path constraints ({violated}): one of them is always violated"


def _remaining(program: Program, worth: float) -> Array | None:
    """By how much each constraint stays violated, relative to its size; ``None`` where nothing shows that it does."""
    at, found, costs, penalty = straight(program), list[Array](), list[float](), 0.0
    room = rooms(program, at)
    for weight in WEIGHTS:
        own = weight * max(abs(worth), 1e-12) / program.intervals
        at = _penalised(program, at, own / room**2)
        if not np.isfinite(at.x).all():
            return None
        violated = np.maximum(program.constraints(at) * program.kept / room, 0.0)
        found.append(violated.max(axis=1))
        costs.append(program.cost(at))
        penalty = own * float((violated**2).sum()) / 2
    before, last = found[-2:]
    avoided = not last.max() > max(REMAINING * before.max(), UNAVOIDABLE)
    # where the weights are too small to count, the cost outweighs what is violated, or rises more at each step
    paying = costs[-1] - costs[-2] > max(costs[-2] - costs[-3], UNAVOIDABLE * abs(costs[-1]))
    return None if avoided or paying or not penalty > abs(costs[-1]) else last


def _penalised(program: Program, start: Point, weight: Array) -> Point:
    """The path of least cost with squared violations in it, by Newton's method on those that are violated."""
    at = start
    for _ in range(NEWTON):
        g = program.constraints(at) * program.kept
        pushed = replace(at, z=weight * np.maximum(g, 0.0))
        slopes = Slopes.of(program, pushed)
        stiff, own = slopes.stiffened(np.broadcast_to(weight, g.shape) * (g > 0.0))
        try:
            step = Factors.of(stiff, own).step(stiff, slopes.pushed(pushed.z))
        except np.linalg.LinAlgError:
            return replace(at, x=np.full_like(at.x, np.nan))
        moved = at.moved(step, 1.0)
        settled = np.abs(moved.x - at.x).max() <= 1e-10 * np.abs(at.x).max()
        at = moved
        if settled:
            break
    return at
