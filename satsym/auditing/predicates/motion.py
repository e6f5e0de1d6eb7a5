"""Claims about motions: whether they return, swing, rest or can be steered, from solutions and simulations."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

from satsym import instance as instances
from satsym import kernels
from satsym.arrays import Array
from satsym.auditing.predicates import Finding, its_listing, predicate, reproduction
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.instance import Instance
from satsym.solution import Solution
from satsym.status import BadInput
from satsym.wording import shown, suggestion

_BACK = 0.05
"""A state has returned if it is this close to its reference, relative to the larger of one unit and the reference."""
_STEPS = 4000
_SEED = 3


@cache
def loaded(name: str) -> Instance:
    """A shipped instance."""
    return instances.load(name)


@cache
def solved(name: str) -> Solution:
    """Its optimum."""
    from satsym.solvers import solve

    return solve(loaded(name))


def steered(case: Instance, control: float) -> Array:
    """States at the end of the motion, all controls constant; shape (n,)."""
    assert case.tf is not None
    times = np.linspace(case.t0, case.tf, _STEPS + 1)
    u = np.full((len(case.model.spec.controls), _STEPS + 1), control)
    x, _, _ = case.model.forward(times, case.initial, u, u[:, 1:], case.parameters)
    return x[:, -1]


@cache
def _steered(instance: str, control: float) -> Array:
    return steered(loaded(instance), control)


def reference(case: Instance, time: float | None) -> Array:
    """The reference at a time, shape (n,)."""
    assert time is not None
    return np.array(case.model.reference(time, case.parameters), dtype=float)


@predicate
def returns(
    instance: str, control: str, states: tuple[str, ...] = (), beside: str = "", steps: tuple[int, ...] = ()
) -> Finding:
    """Whether states end on the reference: under the optimal control, or under the constant one that is printed.

    Parameters
    ----------
    instance
        The printed problem.
    control
        The printed value of all controls.
    states
        Names; by default all but angles, whose turns do not matter.
    beside, steps
        The uncontrolled deviation that is drawn in the same figure, and numbers of steps of the printed program for
        which its size is measured, too.
    """
    case, names = loaded(instance), loaded(instance).model.spec.state_names
    chosen = states or tuple(v.symbol for v in case.model.spec.states if v.kind != "angle")
    for name in chosen:
        if name not in names:
            raise BadInput(f"returns: no state {shown(name)}; {suggestion(name, names)}")
    goal = reference(case, case.tf)
    ends = {"optimal": solved(instance).x[:, -1], f"u = {control}": _steered(instance, float(control))}
    evidence: dict[str, float | int | bool | str] = {}
    close: dict[str, bool] = {}
    for label, end in ends.items():
        close[label] = True
        for name in chosen:
            i = names.index(name)
            evidence[f"{name}({case.tf:g}), {label}"] = float(end[i])
            evidence[f"reference of {name}"] = float(goal[i])
            close[label] &= bool(abs(end[i] - goal[i]) <= _BACK * max(1.0, abs(goal[i])))
    first = names.index(chosen[0])
    derived = ", ".join(f"{chosen[0]}({case.tf:g}) = {end[first]:.4g} ({label})" for label, end in ends.items())
    return Finding(
        any(close.values()),
        f"{derived}; the reference is {goal[first]:.4g}",
        evidence,
        f"satsym simulate {instance}",
        remark=_drawn(beside, steps, 2.0 * float(control)) if beside else "",
    )


@cache
def _drawn(name: str, steps: tuple[int, ...], guess: float) -> str:
    """How large the controlled curve is beside the uncontrolled one in the printed program."""
    k = int(name.removeprefix("x")) - 1
    pairs = []
    for n in steps:
        free = its_listing.initial_system(n, reproduction.TF, reproduction.START, reproduction.OMEGA)
        steered = reproduction.run(1.0, 1.0, n, guess).x
        pairs.append([max(abs(x[k]) for x in path) for path in (free, steered)])
    large, small = (
        " to ".join(dict.fromkeys(f"{value:.0f}" if value >= 100.0 else f"{value:.3g}" for value in sorted(values)))
        for values in zip(*pairs, strict=True)
    )
    return (
        f"in the printed program with {' to '.join(map(str, steps))} steps the uncontrolled {name} reaches {large} by "
        f"errors of integration; beside it the controlled one, up to {small}, looks like zero"
    )


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
def displacement(instance: str, state: str, printed: str) -> Finding:
    """Whether the initial state differs from the reference by the printed number, in the equations that are solved."""
    case = loaded(instance)
    i = case.model.spec.state_names.index(state)
    start, on = case.initial[i], float(reference(case, case.t0)[i])
    return Finding(
        abs(start - on - float(printed)) < 1e-12,
        f"{state} = {start:g} at the start, {on:g} on the reference: displaced by {start - on:g}",
        {"start": start, "reference": on, "displacement": start - on},
        f"satsym simulate {instance}",
    )


@predicate
def same_system(linear: str, nonlinear: str) -> Finding:
    """Whether two models are one: their rates at the state (1, 1, ...), without control, parameters 1."""
    found, other = analysis(linear), kernels.load(nonlinear)
    n = len(found.system.states)
    values = {s.name: 1.0 for s in found.system.a.free_symbols}
    parameters = [1.0 if v.symbol in values or v.symbol == "sigma" else 0.0 for v in other.spec.parameters]
    one = numeric(found.system.a, values) @ np.ones(n)
    two = np.array(other.dynamics(0.0, (1.0,) * n, (0.0,) * len(other.spec.controls), tuple(parameters)))
    written = [" ".join(f"{rate:g}" for rate in rates) for rates in (one, two)]
    return Finding(
        bool(np.allclose(one, two)),
        f"at x = (1, 1, 1, 1) without control the rates are ({written[0].replace(' ', ', ')}) in the one, "
        f"({written[1].replace(' ', ', ')}) in the other",
        {f"rates of {linear}": written[0], f"rates of {nonlinear}": written[1]},
        f"satsym analyse {linear}",
    )


@predicate
def rest_point(model: str) -> Finding:
    """Whether all rates vanish on the reference of a model without control (of deviations: at zero).

    A motion on which only a state changes that no rate depends on is steady, but no zero of the rates.
    """
    if model not in kernels.shipped() or not kernels.load(model).spec.has_reference:
        rates = numeric(analysis(model).system.a, {"omega": 1.0, "sigma": 1.0}) @ np.zeros(
            len(analysis(model).system.a[0, :])
        )
        return Finding(
            not rates.any(), "the rates vanish where all deviations do", {"largest rate": float(abs(rates).max())}
        )
    system = kernels.load(model)
    names = system.spec.state_names
    rng = np.random.default_rng(_SEED)
    p = tuple(rng.uniform(0.5, 2.0, len(system.spec.parameters)))
    x, u = np.array(system.reference(0.7, p), dtype=float), (0.0,) * len(system.spec.controls)
    rates = np.array(system.dynamics(0.7, tuple(x), u, p))
    moving = [i for i, rate in enumerate(rates) if abs(rate) > 1e-9]
    ignored = True
    for i in moving:
        shifted = x + 0.3 * (np.arange(len(x)) == i)
        ignored &= bool(np.allclose(system.dynamics(0.7, tuple(shifted), u, p), rates))
    evidence = {f"rate of {name}": float(rate) for name, rate in zip(names, rates, strict=True)}
    which = ", ".join(names[i] for i in moving)
    derived = f"on the reference {which} changes all the time" if moving else "all rates vanish"
    remark = (
        f"the orbit is a steady motion, for no rate depends on {which}; an equilibrium in the sense of the definition "
        "are only the deviations from it"
        if moving and ignored
        else ""
    )
    return Finding(not moving or ignored, derived, evidence, sound=not moving, remark=remark)


@predicate
def stays_without_thrust(instance: str) -> Finding:
    """Whether a motion that starts on the reference stays there without control."""
    case = loaded(instance)
    start = replace(case, initial=tuple(reference(case, case.t0)))
    drift = float(np.abs(steered(start, 0.0) - reference(case, case.tf)).max())
    return Finding(drift < 1e-8, f"after {case.tf:g} it is off by {drift:.0e}", {"deviation at the end": drift})


@predicate
def impulse_moves(instance: str) -> Finding:
    """Whether a sudden change of velocity on the reference changes the later position."""
    case = loaded(instance)
    names, orbit = case.model.spec.state_names, reference(case, case.t0)
    kicked = orbit + 1e-3 * (np.array(names) == "theta_dot")
    ends = [steered(replace(case, initial=tuple(start)), 0.0) for start in (orbit, kicked)]
    moved = {name: float(ends[1][names.index(name)] - ends[0][names.index(name)]) for name in ("r", "theta")}
    return Finding(
        max(map(abs, moved.values())) > 1e-6,
        f"a thousandth more angular velocity moves it by {moved['theta']:.2g} rad in {case.tf:.3g}",
        {f"change of {name} at the end": value for name, value in moved.items()},
    )


@predicate
def form_kept(model: str, angle: str) -> Finding:
    """Whether the equations of a model hold as they stand when its angles are measured in another unit."""
    from satsym import units

    system = kernels.load(model)
    factor = 1.0 / units.parse_quantity(f"1 {angle}", "rad")
    scale = np.array([factor if v.unit.startswith("rad") else 1.0 for v in system.spec.states])
    rng = np.random.default_rng(_SEED)
    x, p = rng.uniform(0.5, 2.0, len(scale)), tuple(rng.uniform(0.5, 2.0, len(system.spec.parameters)))
    u = (0.0,) * len(system.spec.controls)
    right = scale * np.array(system.dynamics(0.0, tuple(x), u, p))
    as_printed = np.array(system.dynamics(0.0, tuple(scale * x), u, p))
    off = float(np.abs(as_printed - right).max() / np.abs(right).max())
    return Finding(
        off < 1e-9,
        f"in {angle} the squares of angular velocities come out {factor**2:.4g} times too large",
        {"factor of the angle": factor, "largest relative error of a rate": off},
        unit=True,
        remark="the equations hold for radians alone",
    )
