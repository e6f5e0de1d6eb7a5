"""Refusal of instances whose path constraints are violated at the given initial or final state."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.kernels.evaluation import COMPLEX_STEP
from satsym.solvers.constrained.arcs import decided_at_end, given_end, terms, values
from satsym.status import BadInput

ROUNDING = 1e-12
"""Relative rounding error of a constraint that is satisfied exactly, compared with its terms."""

DURATIONS = (0.37, 1.0, 2.6)
"""Durations at which it is tested whether a constraint at the given final state changes with time."""


def refuse(instance: Instance) -> None:
    """Refuse an instance whose given initial or final state violates a constraint, or leads to a violation at once.

    Raises
    ------
    BadInput
        If a path constraint is violated.
    """
    _refuse_at(instance, instance.t0, instance.initial, "initial", 1.0)
    if instance.tf is not None and not np.isnan(ended := given_end(instance, instance.tf)).any():
        _refuse_at(instance, instance.tf, tuple(ended.tolist()), "final", -1.0)
        return
    decided = decided_at_end(instance)
    if decided.any() and (instance.tf is not None or _stands(instance, decided)):
        end = instance.t0 + 1.0 if instance.tf is None else instance.tf
        _refuse_values(instance, end, _end(instance, end), "final", decided)


def _end(instance: Instance, end: float) -> tuple[float, ...]:
    """Return the given final states, and zero for the others."""
    return tuple(np.nan_to_num(given_end(instance, end)).tolist())


def _stands(instance: Instance, which: NDArray[np.bool_]) -> bool:
    """Return whether constraints have the same value at the given final state for all final times."""
    rest = np.zeros((len(instance.model.spec.controls), 1))
    ends = [instance.t0 + duration for duration in DURATIONS]
    found = [values(instance, np.array([t]), np.array(_end(instance, t))[:, None], rest)[which, 0] for t in ends]
    return all(np.array_equal(one, found[0]) for one in found)


def _refuse_at(instance: Instance, time: float, state: tuple[float, ...], key: str, direction: float) -> None:
    """Refuse an instance if a completely known state violates a path constraint by more than rounding."""
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
                f"{instance.called}: {key}: path constraint {one.name} is reached with the rate of change "
                f"{rate:.6g}, which no control can change instantly, so the constraint is violated just "
                f"{when}; change the velocity at that point"
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
                f"{instance.called}: {key}: path constraint {one.name} has the value {value:.6g} at that "
                "point, but must not be positive; change that state, or the constraint's parameters"
            )
