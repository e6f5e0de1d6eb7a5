"""The printed sweeps, executed: the loops in appendix B of the ITS thesis, and the steps of its section 4.4."""

from __future__ import annotations

from functools import cache, partial

import numpy as np

from satsym import kernels
from satsym.auditing.predicates import Finding, its_listing, predicate
from satsym.auditing.predicates.linear import analysis, numeric
from satsym.auditing.predicates.motion import loaded, solved
from satsym.auditing.predicates.printed_methods import SWEEP, TEXTBOOK, Vector, march, order
from satsym.instance import Instance
from satsym.status import BadInput
from satsym.wording import shown

_COUNTS = (50, 100, 200, 400)
_FINE = 2 * _COUNTS[-1]
_TF = 1.0
_START = (1.1, 0.1, 0.3, 0.9)
_END = (0.4, -0.3, 0.2, 0.5)
_STEPS = 300
_PARAMETERS = {"sigma": 1.0, "omega": 1.0}


@predicate
def listing_order(loop: str) -> Finding:
    """Whether a loop of the listing is of fourth order: ``initial``, ``state`` or ``costate``, executed as printed."""
    if loop not in ("initial", "state", "costate"):
        raise BadInput(f"listing_order: no loop {shown(loop)}; write initial, state or costate")
    errors_of = {"initial": _initial_error, "state": _state_error, "costate": _costate_error}[loop]
    measured, errors = order(lambda n: errors_of(n, False), _COUNTS)
    once, _ = order(lambda n: errors_of(n, True), _COUNTS)
    return Finding(
        abs(measured - 4.0) < 0.3,
        f"measured order {measured:.1f}",
        {
            "measured order": measured,
            "measured order with h once": once,
            **{f"error, {n} steps": error for n, error in zip(_COUNTS, errors, strict=True)},
        },
        remark="the stages are multiplied by h when they are made and again where they are used; with h once the "
        f"measured order is {once:.1f}"
        + ("" if loop == "initial" else ", for the fourth stage takes values from the middle of the step"),
    )


@predicate
def sweep_of_steps(instance: str) -> Finding:
    """Whether the sweep of section 4.4, executed from zero vectors with its own formulas, ends at the optimum."""
    case = loaded(instance)
    assert case.tf is not None
    model, h = case.model, (case.tf - case.t0) / _STEPS
    u = np.zeros((2, _STEPS + 1))
    x, lam = np.zeros((4, _STEPS + 1)), np.zeros((4, _STEPS + 1))
    changes: list[float] = []
    while len(changes) < 3:
        x[:, 0] = case.initial
        for i in range(_STEPS):
            x[:, i + 1] = SWEEP.step(partial(_rates, case, tuple(u[:, i])), 0.0, x[:, i], h)
        lam[:, -1] = 0.0
        for i in range(_STEPS, 0, -1):
            field = partial(_costate_rates, case, tuple(x[:, i]), tuple(u[:, i]))
            before = SWEEP.step(field, 0.0, lam[:, i], -h)
            # lambda3 one node before is printed as lambda1 of this node, less its increment
            before[2] += lam[0, i] - lam[2, i]
            lam[:, i - 1] = before
        law = np.array([model.control_law(0.0, tuple(a), tuple(b), case.parameters, case.control_set.arguments)
                        for a, b in zip(x.T, lam.T, strict=True)]).T  # fmt: skip
        changes.append(float(np.abs(law - u).max()))
        u = law
    weights = np.array([dict(zip((v.symbol for v in model.spec.parameters), case.parameters, strict=True))[c]
                        for c in ("c1", "c2")])  # fmt: skip
    cost = float(0.5 * h * (weights @ u[:, :-1] ** 2).sum())
    least = solved(instance).objective
    return Finding(
        changes[-1] == 0.0 and abs(cost - least) < 1e-12,
        f"they end at a largest control of {np.abs(u).max():g} and J = {cost:g}; the least J is {least:g}",
        {"J": cost, "least J": float(least), "change in the last sweep": changes[-1]},
        f"satsym solve {instance}",
    )


def _control(t: float) -> tuple[float, float]:
    """A smooth control, so that what happens between the nodes shows."""
    return 0.05 * float(np.cos(3.0 * t)), 0.05 * float(np.sin(3.0 * t))


def _initial_error(n: int, once: bool) -> float:
    from scipy.linalg import expm

    exact = expm(_TF * numeric(analysis("clohessy_wiltshire").system.a, _PARAMETERS)) @ _START
    found = its_listing.initial_system(n, _TF, _START, 1.0, once=once)[-1]
    return float(np.abs(np.array(found) - exact).max())


def _state_error(n: int, once: bool) -> float:
    u = [_control(i * _TF / n) for i in range(n + 1)]
    found = its_listing.state_sweep(u, _TF, _START, 1.0, 1.0, once=once)[-1]
    return float(np.abs(np.array(found) - _path()[-1]).max())


def _costate_error(n: int, once: bool) -> float:
    stride = _FINE // n
    x = [_four(row) for row in _path()[::stride]]
    u = [_control(i * _TF / n) for i in range(n + 1)]
    found = its_listing.costate_sweep(x, u, _TF, _END, 1.0, 1.0, once=once)[0]
    return float(np.abs(np.array(found) - _first_costate()).max())


def _four(row: Vector) -> its_listing.State:
    a, b, c, d = (float(value) for value in row)
    return a, b, c, d


@cache
def _path() -> list[Vector]:
    """States at all multiples of a fine step, as exact as is needed here."""
    parameters = _parameters()

    def field(t: float, x: Vector) -> Vector:
        return np.array(kernels.load("polar_orbit").dynamics(t, tuple(x), _control(t), parameters), dtype=float)

    rows, h = [np.array(_START)], _TF / _FINE
    for i in range(_FINE):
        rows.append(march(lambda t, y, s: TEXTBOOK.step(field, t, y, s), i * h, rows[-1], h / 2, 2))
    return rows


@cache
def _first_costate() -> Vector:
    """Costates at the start by the textbook's method on the fine path."""
    rate, path, parameters = kernels.load("polar_orbit").costate_rate, _path(), _parameters()

    def field(t: float, lam: Vector) -> Vector:
        x = path[round(t / _TF * _FINE)]
        return np.array(rate(t, tuple(x), _control(t), tuple(lam), parameters), dtype=float)

    count = _FINE // 2
    return march(lambda t, y, h: TEXTBOOK.step(field, t, y, h), _TF, np.array(_END), -_TF / count, count)


@cache
def _parameters() -> tuple[float, ...]:
    return tuple(_PARAMETERS.get(v.symbol, 0.0) for v in kernels.load("polar_orbit").spec.parameters)


def _rates(case: Instance, u: tuple[float, ...], t: float, y: Vector) -> Vector:
    return np.array(case.model.dynamics(t, tuple(y), u, case.parameters), dtype=float)


def _costate_rates(case: Instance, x: tuple[float, ...], u: tuple[float, ...], t: float, y: Vector) -> Vector:
    return np.array(case.model.costate_rate(t, x, u, tuple(y), case.parameters), dtype=float)
