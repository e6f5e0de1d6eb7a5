"""Printed Runge-Kutta formulas: which order a method has that uses them, measured."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache

import numpy as np

from satsym import kernels
from satsym.auditing.predicates import Finding, predicate
from satsym.auditing.predicates.printed_methods import (
    GENERAL,
    SWEEP,
    TEXTBOOK,
    TEXTBOOK_SCALED,
    Field,
    Method,
    StageArgument,
    Vector,
    march,
    order,
    replaced,
)
from satsym.status import BadInput
from satsym.wording import shown

COUNTS = (8, 16, 32, 64)
ORDER = 4
_SLACK = 0.3
"""How far a measured order may be from a whole number."""
_TF = 1.0
_START = (1.1, 0.1, 0.3, 0.9)
_COSTATE = (0.4, -0.3, 0.2, 0.5)
_CONTROL = (0.05, -0.03)
_PARAMETERS = {"sigma": 1.0, "omega": 1.0}
_STAGES = {"sum": 0, "1": 1, "2": 2, "3": 3, "4": 4, "all": None}


def _growth(t: float, y: Vector) -> Vector:
    """y' = cos(t) y, whose solution is exp(sin t)."""
    return math.cos(t) * y


@predicate
def stage_order(formulas: str, stage: str) -> Finding:
    """Whether the textbook's method keeps its order with one of its formulas as printed, or with all of them.

    Parameters
    ----------
    formulas
        ``general``: (2.18) and (2.19) of the thesis, (16) to (21) of the paper.
    stage
        ``1`` to ``4``, ``sum`` or ``all``.
    """
    if formulas != "general" or stage not in _STAGES:
        raise BadInput(f"stage_order: no {shown(formulas)} or no stage {shown(stage)}")
    method = replaced(TEXTBOOK, GENERAL, _STAGES[stage])
    found = _finding(*_orders(method, _growth, np.array([1.0]), np.array([math.exp(math.sin(_TF))])))
    repaired, _ = _orders(_times_h(method), _growth, np.array([1.0]), np.array([math.exp(math.sin(_TF))]))
    if found.holds or abs(repaired - ORDER) > _SLACK:
        return found
    return replace(found, remark=f"with h times what is added to y_n, the measured order is {repaired:.1f}")


@predicate
def sweep_stage(direction: str, stage: int | str, component: int = 0) -> Finding:
    """Whether a stage of the printed sweep leaves the order of the textbook's method what it is.

    Forwards the controls are held over the motion, so that nothing is lost by taking those of node n. Backwards the
    states are those of a motion that goes on between the nodes.

    Parameters
    ----------
    direction
        ``forward`` (states) or ``backward`` (costates).
    stage
        1 to 4 or ``"all"``.
    component
        Whose stage it is, 1 to 4; 0 for all components.
    """
    if direction not in ("forward", "backward") or str(stage) not in _STAGES or not 0 <= component <= 4:
        raise BadInput(f"sweep_stage: no {shown(direction)}, stage {shown(stage)} or component {shown(component)}")
    printed = replaced(TEXTBOOK_SCALED, SWEEP, _STAGES[str(stage)])
    method = printed if component == 0 else _mixed(TEXTBOOK_SCALED, printed, component - 1)
    if direction == "forward":
        return _finding(*_orders(method, _states(), np.array(_START), _reference_end()))
    found = _finding(*_backward_orders(method))
    if found.holds:
        return found
    repaired, _ = _backward_orders(TEXTBOOK_SCALED)
    return replace(
        found,
        remark="all stages take the states of node n; with those of the middle of the step in the second and third, "
        f"and of its other end in the fourth, the measured order is {repaired:.1f}",
    )


@predicate
def truncation_error(power: int) -> Finding:
    """Whether the error that a step of the textbook's method makes, or that is left at the end, goes like h^power."""
    whole, errors = _orders(
        TEXTBOOK, lambda t, y: math.cos(t) * y, np.array([1.0]), np.array([math.exp(math.sin(_TF))])
    )
    steps = [2.0**-k for k in (2, 3, 4, 5)]
    local = [abs(float(TEXTBOOK.step(_growth, 0.0, np.array([1.0]), h)[0]) - math.exp(math.sin(h)))
             for h in steps]  # fmt: skip
    one = math.log(local[-2] / local[-1], 2.0)
    return Finding(
        min(abs(one - power), abs(whole - power)) < _SLACK,
        f"it goes like h^{round(one)} in one step and like h^{round(whole)} at the end",
        {"measured in one step": one, "measured at the end": whole, "error at the end": errors[-1]},
    )


@predicate
def errors_ordered() -> Finding:
    """Whether the textbook's method has a smaller error than Euler's and Heun's, for equal steps and equal effort."""
    field, start = _states(), np.array(_START)
    end = _reference_end()

    def euler(t: float, y: Vector, h: float) -> Vector:
        return y + h * field(t, y)

    def heun(t: float, y: Vector, h: float) -> Vector:
        first = field(t, y)
        return y + h / 2.0 * (first + field(t + h, y + h * first))

    def error(step: object, count: int) -> float:
        return float(np.abs(march(step, 0.0, start, _TF / count, count) - end).max())  # type: ignore[arg-type]

    def runge_kutta(t: float, y: Vector, h: float) -> Vector:
        return TEXTBOOK.step(field, t, y, h)

    n = 64
    found = {
        "Runge-Kutta": error(runge_kutta, n),
        "Heun, equal steps": error(heun, n),
        "Euler, equal steps": error(euler, n),
        "Heun, equal effort": error(heun, 2 * n),
        "Euler, equal effort": error(euler, 4 * n),
    }
    best = found.pop("Runge-Kutta")
    return Finding(
        best < min(found.values()),
        f"errors for equal effort: {best:.0e}, {found['Heun, equal effort']:.0e} (Heun), "
        f"{found['Euler, equal effort']:.0e} (Euler)",
        {"Runge-Kutta": best, **found},
    )


def _finding(measured: float, errors: list[float]) -> Finding:
    return Finding(
        abs(measured - ORDER) < _SLACK,
        f"measured order {max(measured, 0.0):.1f}" + ("" if errors[-1] < 0.5 * errors[0] else ": it does not converge"),
        {"measured order": measured, **{f"error, {n} steps": e for n, e in zip(COUNTS, errors, strict=True)}},
    )


def _orders(method: Method, field: Field, start: Vector, end: Vector) -> tuple[float, list[float]]:
    def error(count: int) -> float:
        found = march(lambda t, y, h: method.step(field, t, y, h), 0.0, start, _TF / count, count)
        return float(np.abs(found - end).max())

    return order(error, COUNTS)


def _times_h(method: Method) -> Method:
    """The method with h times each earlier stage in the place where a stage evaluates f."""

    def scaled(argument: StageArgument) -> StageArgument:
        return lambda t, h, y, k: argument(t, h, y, [h * stage for stage in k])

    first, *others = method.arguments
    changed = (first, *(a if a in TEXTBOOK.arguments else scaled(a) for a in others))
    return Method(changed, method.total, method.scaled)  # type: ignore[arg-type]


def _mixed(textbook: Method, printed: Method, component: int) -> Method:
    """The textbook's method, whose stages take one component from the printed one."""

    class Mixed(Method):
        def step(self, f: Field, t: float, y: Vector, h: float) -> Vector:
            stages: list[Vector] = []
            for ours, theirs in zip(textbook.arguments, printed.arguments, strict=True):
                slope = f(*ours(t, h, y, stages))
                slope[component] = f(*theirs(t, h, y, stages))[component]
                stages.append(h * slope if textbook.scaled else slope)
            return y + textbook.total(h, stages)

    return Mixed(textbook.arguments, textbook.total, textbook.scaled)


@cache
def _parameters() -> tuple[float, ...]:
    return tuple(_PARAMETERS.get(v.symbol, 0.0) for v in kernels.load("polar_orbit").spec.parameters)


def _states() -> Field:
    rates = kernels.load("polar_orbit").dynamics
    return lambda t, x: np.array(rates(t, tuple(x), _CONTROL, _parameters()), dtype=float)


@cache
def _path() -> list[Vector]:
    """States at all multiples of a fine step, exact for what is measured here."""
    field, count = _states(), COUNTS[-1] * 2
    h, x = _TF / count, np.array(_START)
    rows = [x]
    for i in range(count):
        x = march(lambda t, y, s: TEXTBOOK.step(field, t, y, s), i * h, x, h / 16, 16)
        rows.append(x)
    return rows


@cache
def _reference_end() -> Vector:
    return march(lambda t, y, h: TEXTBOOK.step(_states(), t, y, h), 0.0, np.array(_START), _TF / 1024, 1024)


def _backward_orders(method: Method) -> tuple[float, list[float]]:
    """Costates from the end to the start along the path."""
    rates, path, fine = kernels.load("polar_orbit").costate_rate, _path(), COUNTS[-1] * 2

    def field(t: float, lam: Vector) -> Vector:
        x = path[round(t / _TF * fine)]
        return np.array(rates(t, tuple(x), _CONTROL, tuple(lam), _parameters()), dtype=float)

    def end(step_of: Method, count: int) -> Vector:
        return march(lambda t, y, h: step_of.step(field, t, y, h), _TF, np.array(_COSTATE), -_TF / count, count)

    # Richardson from the two finest grids of the textbook's method
    exact = (16.0 * end(TEXTBOOK_SCALED, fine // 2) - end(TEXTBOOK_SCALED, fine // 4)) / 15.0
    return order(lambda count: float(np.abs(end(method, count) - exact).max()), COUNTS)
