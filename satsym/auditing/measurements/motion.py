"""Motions of shipped instances: initial states, optima, limits of sweeps, and motions under constant controls."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from satsym import instance as instances
from satsym.arrays import Array
from satsym.auditing.measurements import linear, linear_motions
from satsym.auditing.measurements.linear_motions import STEPS
from satsym.auditing.propositions.values import Record, Undecided
from satsym.status import BadInput, Status
from satsym.wording import refuse_unknown

if TYPE_CHECKING:
    from satsym.instance import Instance
    from satsym.solution import Solution

_SEED = 20
_SWEEPS = 60
_SETTLED_CONTROL = 1e-10

loaded = cache(instances.load)
"""Return a shipped instance, which is read only once."""


def start(instance: str) -> Record:
    """Return the initial state of an instance."""
    case = loaded(instance)
    return _state(case, case.initial, f"the start of {instance}")


def end(instance: str) -> Record:
    """Return the final state of the optimum of an instance."""
    return _state(loaded(instance), _solved(instance).x[:, -1], f"the end of {instance}")


def reference(instance: str, t: float | None = None) -> Record:
    """Return the state on the reference motion of an instance at time t, by default at the final time."""
    case = loaded(instance)
    time = case.tf if t is None else t
    if time is None:
        raise BadInput(f"{instance} has a free final time; give a final time")
    return _state(case, case.model.reference(time, case.parameters), f"the reference of {instance}")


def parameter(instance: str, name: str) -> float:
    """Return a parameter of an instance."""
    known = _parameters(loaded(instance))
    refuse_unknown(f"{instance} has no parameter", name, known)
    return known[name]


def least_cost(instance: str, **parameters: float) -> Record:
    """Return the optimum of an instance, with some parameters replaced if any are given.

    Its parts are the cost J, terminal cost S, running cost V, times, final time, states, controls and costates.
    """
    parameters = {name: float(value) for name, value in parameters.items()}
    case, found = loaded(instance), _solved(instance, **parameters)
    if found.status is not Status.CONVERGED:
        raise Undecided(f"{instance}: {found.status}")
    spec, x, u, times = case.model.spec, np.asarray(found.x), np.asarray(found.u), np.asarray(found.times)
    names = [*spec.state_names, *spec.control_names, *(f"lambda_{name}" for name in spec.state_names)]
    curves = dict(zip(names, (*x, *u, *np.asarray(found.lam)), strict=True))
    p, last = tuple((_parameters(case) | parameters).values()), float(times[-1])
    running = [
        case.model.running_cost(float(t), tuple(a), tuple(b), p) for t, a, b in zip(times, x.T, u.T, strict=True)
    ]
    ends = {"J": found.objective, "S": float(case.model.terminal_cost(last, tuple(x[:, -1]), p)), "t_final": last}
    return Record(f"the optimum of {instance}", {**ends, "t": times, **curves, "V": np.array(running)})


def steered(instance: str, controls: Sequence[float] | float = 0.0) -> Record:
    """Return the motion of an instance under constant controls: ``t``, states by name, and final state ``end``."""
    return _steered(loaded(instance), controls)


def displaced(instance: str, **by: float) -> Record:
    """Return the uncontrolled motion that starts on the reference of an instance with some states displaced."""
    case = loaded(instance)
    names = case.model.spec.state_names
    for other in by:
        refuse_unknown(f"{instance} has no state", other, names)
    on = case.model.reference(case.t0, case.parameters)
    return _steered(replace(case, initial=tuple(x + by.get(n, 0.0) for n, x in zip(names, on, strict=True))), 0.0)


def _steered(case: Instance, controls: Sequence[float] | float) -> Record:
    if case.tf is None:
        raise BadInput(f"{case.name} has a free final time")
    times = np.linspace(case.t0, case.tf, STEPS + 1)
    constant = np.broadcast_to(np.asarray(controls, dtype=float), (len(case.model.spec.controls),))
    u = np.repeat(constant[:, None], STEPS + 1, axis=1)
    x, _, integral = case.model.forward(times, case.initial, u, u[:, 1:], case.parameters)
    parts: dict[str, Any] = {v.symbol: np.asarray(row) for v, row in zip(case.model.spec.states, x, strict=True)}
    last = _state(case, x[:, -1], "its end")
    return Record(
        f"{case.name} under constant controls", {"t": times, "end": last, "integral": float(integral), **parts}
    )


def free_deviation(model: str, instance: str) -> Record:
    """Return the uncontrolled motion of a linear model whose initial deviation is the initial state of an instance."""
    case, found = loaded(instance), linear.system(model)
    if case.tf is None:
        raise BadInput(f"{instance} has a free final time")
    known = _parameters(case)
    a = found.part("A").subs({s: known[s.name] for s in found.part("A").free_symbols if s.name in known})
    return linear_motions.trajectory(Record(model, {**found.parts, "A": a}), case.initial, case.tf - case.t0)


def given_at_end(instance: str) -> list[str]:
    """Return the states and costates whose final values are numbers according to the boundary conditions."""
    case = loaded(instance)
    names = case.model.spec.state_names
    if case.tf is None:
        return list(case.final)
    points = np.random.default_rng(_SEED).uniform(0.5, 2.0, (2, len(names)))
    one, other = (np.array(case.model.terminal_gradient(case.tf, tuple(x), case.parameters)) for x in points)
    free = [f"lambda_{name}" for k, name in enumerate(names) if name not in case.final and one[k] == other[k]]
    return [*case.final, *free]


def swept(instance: str, guess: float = 0.0) -> Record:
    """Return cost J and controls after forward-backward sweeps that start from constant controls and converged.

    Each sweep replaces the controls by the control law. States are integrated forwards and costates backwards by the
    classical Runge-Kutta method of order four.
    """
    case = loaded(instance)
    if case.tf is None or case.final:
        raise BadInput(f"{instance}: sweeps require a given final time and a free final state")
    model, p = case.model, case.parameters
    times = np.linspace(case.t0, case.tf, STEPS + 1)
    u = np.full((len(model.spec.controls), len(times)), float(guess))
    for _ in range(_SWEEPS):
        middle = 0.5 * (u[:, 1:] + u[:, :-1])
        x, x_mid, integral = model.forward(times, case.initial, u, middle, p)
        end = model.terminal_gradient(case.tf, tuple(x[:, -1]), p)
        lam, _ = model.backward(times, end, x, x_mid, u, middle, p)
        law = _law(case, times, x, lam)
        change, u = float(np.abs(law - u).max()), law
        if change <= _SETTLED_CONTROL:
            cost = float(integral + model.terminal_cost(case.tf, tuple(x[:, -1]), p))
            controls = dict(zip((v.symbol for v in model.spec.controls), u, strict=True))
            return Record(f"the sweeps of {instance}", {"J": cost, "t": times, **controls})
    raise Undecided(f"after {_SWEEPS} sweeps the controls still change by {change:.2g}")


def difference(one: Record, other: Record) -> Record:
    """Return the difference of two states, component by component."""
    names = one.part("names")
    parts = {name: one.part(name) - other.part(name) for name in names}
    return Record(f"the difference of {one.name} and {other.name}", {**parts, "names": names})


def distance(one: Record, other: Record, states: Sequence[str] = ()) -> float:
    """Return the largest difference of two states, relative for values above 1; by default of all states but angles."""
    angles = one.parts.get("angles", ())
    names = states or [name for name in one.part("names") if name not in angles]
    return max(abs(one.part(n) - other.part(n)) / max(1.0, abs(other.part(n))) for n in names)


@cache
def _solved(name: str, **parameters: float) -> Solution:
    """Return the optimum of a shipped instance, with some parameters replaced if any are given."""
    from satsym.solvers import solve

    case = loaded(name)
    known = _parameters(case)
    for other in parameters:
        refuse_unknown(f"{name} has no parameter", other, known)
    return solve(replace(case, parameters=tuple((known | parameters).values())))


def _parameters(case: Instance) -> dict[str, float]:
    return dict(zip(case.model.spec.parameter_names, map(float, case.parameters), strict=True))


def _state(case: Instance, values: Sequence[float] | Array, name: str) -> Record:
    spec = case.model.spec
    parts: dict[str, Any] = {v.symbol: float(value) for v, value in zip(spec.states, values, strict=True)}
    angles = [v.symbol for v in spec.states if v.kind == "angle"]
    return Record(name, {**parts, "names": list(spec.state_names), "angles": angles})


def _law(case: Instance, times: Array, x: Array, lam: Array) -> Array:
    """Return the controls that minimise the Hamiltonian at each node."""
    limits: Any = case.control_set.arguments
    rows = [
        case.model.control_law(float(t), tuple(a), tuple(b), case.parameters, limits)
        for t, a, b in zip(times, x.T, lam.T, strict=True)
    ]
    return np.array(rows, dtype=float).T
