"""Optimal control of shipped instances: what boundary conditions give, what sweeps come to, what can be reached."""

from __future__ import annotations

from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.auditing.measurements import linear_motions, measurement, motion
from satsym.auditing.propositions.values import Record, Undecided
from satsym.instance import Instance
from satsym.status import BadInput

_POINTS, _STEP, _EQUAL = 20, 1e-6, 1e-12
_SWEEPS = 60
_SETTLED = 1e-10


@measurement
def given_at(instance: str, node: str) -> list[str]:
    """States and costates whose values the boundary conditions give as numbers, at the ``start`` or at the ``end``."""
    case = motion.loaded(instance)
    names = case.model.spec.state_names
    if node == "start":
        return list(names)
    if node != "end":
        raise BadInput("write 'start' or 'end'")
    if case.tf is None:
        return list(case.final)
    points = np.random.default_rng(_POINTS).uniform(0.5, 2.0, (2, len(names)))
    one, other = (np.array(case.model.terminal_gradient(case.tf, tuple(x), case.parameters)) for x in points)
    free = [f"lambda_{name}" for k, name in enumerate(names) if name not in case.final and one[k] == other[k]]
    return [*case.final, *free]


@measurement
def swept(instance: str, guess: float = 0.0) -> Record:
    """Where forward-backward sweeps end that begin with constant controls and replace them by the law: J and controls.

    States go forwards and costates backwards by the classical method of order four.
    """
    case = motion.loaded(instance)
    if case.tf is None or case.final:
        raise BadInput(f"{instance}: sweeps need a given final time and a free final state")
    model, p = case.model, case.parameters
    times = np.linspace(case.t0, case.tf, linear_motions.STEPS + 1)
    u = np.full((len(model.spec.controls), len(times)), float(guess))
    for _ in range(_SWEEPS):
        middle = 0.5 * (u[:, 1:] + u[:, :-1])
        x, x_mid, integral = model.forward(times, case.initial, u, middle, p)
        end = model.terminal_gradient(case.tf, tuple(x[:, -1]), p)
        lam, _ = model.backward(times, end, x, x_mid, u, middle, p)
        law = _law(case, times, x, lam)
        change, u = float(np.abs(law - u).max()), law
        if change <= _SETTLED:
            cost = float(integral + model.terminal_cost(case.tf, tuple(x[:, -1]), p))
            controls = dict(zip((v.symbol for v in model.spec.controls), u, strict=True))
            return Record(f"the sweeps of {instance}", {"J": cost, "t": times, **controls})
    raise Undecided(f"after {_SWEEPS} sweeps the controls still change by {change:.2g}")


def _law(case: Instance, times: Array, x: Array, lam: Array) -> Array:
    """The controls that minimise the Hamiltonian, at each node."""
    limits: Any = case.control_set.arguments
    rows = [
        case.model.control_law(float(t), tuple(a), tuple(b), case.parameters, limits)
        for t, a, b in zip(times, x.T, lam.T, strict=True)
    ]
    return np.array(rows, dtype=float).T
