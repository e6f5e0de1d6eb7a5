"""Optimal control of shipped instances: what boundary conditions give, what sweeps come to, what can be reached."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.auditing.measurements import measurement, motion
from satsym.auditing.propositions.values import Record, Undecided
from satsym.instance import Instance
from satsym.status import BadInput, Status

_POINTS, _STEP, _EQUAL = 20, 1e-6, 1e-12
_SWEEPS = 60
_SETTLED = 1e-10


@measurement
def extremals(instance: str) -> list[Record]:
    """Solutions of the necessary conditions that are found, each as the optimum is given; none if none is found."""
    return [motion.least_cost(instance)] if motion.solved(instance).status is Status.CONVERGED else []


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
    times = np.linspace(case.t0, case.tf, motion.STEPS + 1)
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


@measurement
@cache
def reachable(instance: str) -> bool:
    """Whether admissible controls bring an instance to where it has to end; by its invariants, or by a solution.

    Along every motion the angular momentum h changes at the rate r u2 and the energy E at r_dot u1 + r theta_dot u2,
    which is checked along the equations. If no control can be negative, h never falls; where it is that of the
    reference at the start, u2 must be zero all the way, and E falls only where r_dot u1 is negative. But with h as it
    is, r_dot^2 = 2 E + 2 mu/r - (h/r)^2 stays positive from the start outwards as long as E is not negative: the
    motion never turns, and E never falls to the negative value on the reference.
    """
    case = motion.loaded(instance)
    if not case.final:
        raise BadInput(f"{instance} may end anywhere; name one with a given final state")
    if _kept_out(case):
        return False
    if motion.solved(instance).status is Status.CONVERGED:
        return True
    raise Undecided(f"no solution of {instance} is found, and no invariant forbids one")


def _kept_out(case: Instance) -> bool:
    names = case.model.spec.state_names
    needed = {"energy", "angular_momentum"} - {v.symbol for v in case.model.spec.invariants}
    if needed or not {"r", "r_dot", "theta_dot"} <= set(names) or any(low < 0.0 for low in case.lower):
        return False
    start = np.array(case.initial)
    aim = np.array(case.model.reference(case.t0, case.parameters), dtype=float)
    (energy, momentum), (energy_on, momentum_on) = _invariants(case, start), _invariants(case, aim)
    values = dict(zip((v.symbol for v in case.model.spec.parameters), case.parameters, strict=True))
    r, rate = (float(start[names.index(name)]) for name in ("r", "r_dot"))
    # the smallest value of 2 mu/r - (h/r)^2 beyond r is not negative once 2 mu r >= h^2
    outwards = rate > 0.0 and 2.0 * values["sigma"] ** 3 * values["omega"] ** 2 * r >= momentum**2
    conserved = abs(momentum - momentum_on) < _EQUAL and energy >= 0.0 > energy_on
    return outwards and conserved and _rate_errors(case) < _STEP


def _invariants(case: Instance, x: Array) -> tuple[float, float]:
    """Energy and angular momentum."""
    names = [v.symbol for v in case.model.spec.invariants]
    values = case.model.invariants(case.t0, tuple(x), case.parameters)
    return float(values[names.index("energy")]), float(values[names.index("angular_momentum")])


def _rate_errors(case: Instance) -> float:
    """How far dE/dt = r_dot u1 + r theta_dot u2 and dh/dt = r u2 are off, by differences along the equations."""
    rng, worst = np.random.default_rng(1), 0.0
    for _ in range(_POINTS):
        x, u = rng.uniform(0.5, 2.0, 4), rng.uniform(-1.0, 1.0, 2)
        flow = np.array(case.model.dynamics(case.t0, tuple(x), tuple(u), case.parameters))
        ahead, behind = (_invariants(case, x + sign * _STEP * flow) for sign in (1.0, -1.0))
        found = [(a - b) / (2.0 * _STEP) for a, b in zip(ahead, behind, strict=True)]
        said = (x[1] * u[0] + x[0] * x[3] * u[1], x[0] * u[1])
        worst = max(worst, *(abs(f - s) for f, s in zip(found, said, strict=True)))
    return worst


def _law(case: Instance, times: Array, x: Array, lam: Array) -> Array:
    """The controls that minimise the Hamiltonian, at each node."""
    limits: Any = case.control_set.arguments
    rows = [
        case.model.control_law(float(t), tuple(a), tuple(b), case.parameters, limits)
        for t, a, b in zip(times, x.T, lam.T, strict=True)
    ]
    return np.array(rows, dtype=float).T
