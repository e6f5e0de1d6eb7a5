"""Claims about motions: whether they return, swing, rest or can be steered, from solutions and simulations."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

from satsym import instance as instances
from satsym.arrays import Array
from satsym.auditing.predicates import Finding, predicate
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.instance import Instance

_BACK = 0.05
"""A state has returned if it is this close to its reference, relative to the larger of one unit and the reference."""
_STEPS = 4000
_SEED = 3


@cache
def loaded(name: str) -> Instance:
    """A shipped instance."""
    return instances.load(name)


def steered(case: Instance, control: float) -> Array:
    """States at the end of the motion, all controls constant; shape (n,)."""
    assert case.tf is not None
    times = np.linspace(case.t0, case.tf, _STEPS + 1)
    u = np.full((len(case.model.spec.controls), _STEPS + 1), control)
    x, _, _ = case.model.forward(times, case.initial, u, u[:, 1:], case.parameters)
    return x[:, -1]


def reference(case: Instance, time: float | None) -> Array:
    """The reference at a time, shape (n,)."""
    assert time is not None
    return np.array(case.model.reference(time, case.parameters), dtype=float)


@predicate
def swings(model: str, states: tuple[str, ...], instance: str, drifts: tuple[str, ...] = ()) -> Finding:
    """Whether deviations swing without coming to rest on the reference, in the linear system without control.

    The start is the instance's, its numbers taken for deviations; e^(At) is evaluated, so that no integration error
    enters.

    Parameters
    ----------
    drifts
        Deviations that are said to move away, too: over the last turn larger, on average, than over the first.
    """
    from scipy.linalg import expm

    case, found = loaded(instance), analysis(model)
    values = dict(zip((v.symbol for v in case.model.spec.parameters), case.parameters, strict=True))
    assert case.tf is not None
    advance, x = expm(case.tf / _STEPS * numeric(found.system.a, values)), np.array(case.initial)
    rows = [x]
    for _ in range(_STEPS):
        rows.append(advance @ rows[-1])
    path = np.array(rows).T
    turn = round(2.0 * math.pi / values["omega"] / case.tf * _STEPS)
    nearest = float(np.linalg.norm(path, axis=0)[1:].min())
    evidence: dict[str, float | int | bool | str] = {"closest to the reference": nearest}
    swinging, away = True, True
    for name in states:
        row = path[found.system.states.index(name)]
        slopes = np.diff(row)
        turns = int((slopes[1:] * slopes[:-1] < 0.0).sum())
        evidence[f"turning points of {name}"] = turns
        evidence[f"largest {name}"] = float(np.abs(row).max())
        swinging &= turns >= 2
        if name in drifts:
            means = abs(float(row[:turn].mean())), abs(float(row[-turn:].mean()))
            evidence[f"mean of {name}, first and last turn"] = f"{means[0]:.3g}, {means[1]:.3g}"
            away &= means[1] > 2.0 * means[0]
    apart = nearest > _BACK * float(np.linalg.norm(case.initial))
    derived = f"turning points in {case.tf:g}: " + ", ".join(
        f"{evidence[f'turning points of {s}']} ({s})" for s in states
    )
    return Finding(
        swinging and away and apart, f"{derived}; never nearer than {nearest:.2g}", evidence, f"satsym analyse {model}"
    )


@predicate
def stays_without_thrust(instance: str) -> Finding:
    """Whether a motion that starts on the reference stays there without control."""
    case = loaded(instance)
    start = replace(case, initial=tuple(reference(case, case.t0)))
    drift = float(np.abs(steered(start, 0.0) - reference(case, case.tf)).max())
    return Finding(drift < 1e-8, f"after {case.tf:g} it is off by {drift:.0e}", {"deviation at the end": drift})
