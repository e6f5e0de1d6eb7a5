"""Constraints that no motion can keep: violated where it starts or ends, or against each other."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from satsym.instance import Instance
from satsym.solvers.constrained.interior_point import Path
from satsym.solvers.constrained.transcription import Program
from satsym.status import BadInput

ROUNDING = 1e-12
"""Of a constraint that holds exactly, relative to its terms."""


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
    if end.any() and instance.tf is not None:
        state = np.where(np.isin(np.arange(len(instance.initial)), program.given), program.target(program.guessed), 0.0)
        _refuse_values(instance, instance.tf, tuple(state.tolist()), "final", end)


def _refuse_at(instance: Instance, time: float, state: tuple[float, ...], key: str, direction: float) -> None:
    """At a state that is known as a whole."""
    model, p = instance.model, instance.parameters
    _refuse_values(instance, time, state, key, np.ones(len(model.spec.path_constraints), bool))
    g = np.array(model.path_constraints(time, state, p))
    rates = np.array(model.path_rates(time, state, (0.0,) * len(model.spec.controls), p)).reshape(-1, 2)[:, 0]
    for one, value, rate in zip(model.spec.path_constraints, g, rates, strict=True):
        if one.order > 1 and abs(value) <= ROUNDING and direction * rate > 0.0:
            when = "after the start" if direction > 0 else "before the end"
            raise BadInput(
                f"{instance.name}: {key}: path constraint {one.name} is met with the rate {rate:.6g}, which no "
                f"control changes at once, so it is violated right {when}; change the velocity there"
            )


def _refuse_values(
    instance: Instance,
    time: float,
    state: tuple[float, ...],
    key: str,
    which: NDArray[np.bool_],
) -> None:
    model, p = instance.model, instance.parameters
    g = np.array(model.path_constraints(time, state, p))
    size = np.abs(np.array(model.path_gradient(time, state, p)).reshape(len(g), -1)) @ np.abs(state)
    for one, value, scale, counts in zip(model.spec.path_constraints, g, size, which, strict=True):
        if counts and value > ROUNDING * max(float(scale), 1e-300):
            raise BadInput(
                f"{instance.name}: {key}: path constraint {one.name} is {value:.6g} there and may not be positive; "
                "change that state, or the constraint's parameters"
            )


def impossible(program: Program, path: Path) -> str:
    """What stands against each other where a convex problem has no admissible path."""
    z = path.at.z * program.kept
    names = [one.name for one in program.instance.model.spec.path_constraints]
    pushing = [name for name, row in zip(names, z, strict=True) if row.max(initial=0.0) > 1e-3 * z.max(initial=1e-300)]
    return f"no motion keeps to the path constraints ({', '.join(pushing or names)}) on the way to the given end"
