"""Conversion of an instance's numbers by its model's description: names, units, domains, kinds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Literal

from satsym import units
from satsym.instance.schema import TimeTable
from satsym.spec import ProblemSpec, Variable
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

Row = tuple[float, ...]
REFERENCE: Literal["reference"] = "reference"
FREE = "free"


def quantity(value: float | str, unit: str, key: str) -> float:
    """Convert a number, or a text with its own unit, to the model's unit."""
    if not isinstance(value, str):
        return float(value)
    try:
        return units.parse_quantity(value, unit)
    except BadInput as error:
        raise BadInput(f"{key}: {error}") from None


def known(names: Iterable[str], variables: Iterable[Variable], what: str, section: str) -> None:
    """Refuse names that are not among the variables."""
    symbols = [v.symbol for v in variables]
    for name in names:
        if name not in symbols:
            raise BadInput(f"[{section}] {printable(name)}: the model has no such {what}; {suggestion(name, symbols)}")


def value_of(variable: Variable, value: float | str, key: str) -> float:
    """Return a variable's value in its unit, after a check of its domain."""
    number = quantity(value, variable.unit, key)
    if variable.positive and number <= 0:
        raise BadInput(f"{key}: {shown(value)} is outside the domain of {variable.symbol}; give a positive value")
    return number


def parameters(table: Mapping[str, float | str], spec: ProblemSpec) -> Row:
    """Return the parameters in the model's order, with the model's defaults for omitted ones."""
    known(table, spec.parameters, "parameter", "parameters")
    found = tuple(_parameter(v, table.get(v.symbol, v.default)) for v in spec.parameters)
    values = dict(zip(spec.parameter_names, found, strict=True))
    for condition in spec.conditions:
        margin = math.fsum(weight * values[name] for name, weight in condition.terms)
        if margin < 0.0 or (condition.strict and margin == 0.0):
            named = ", ".join(f"{name} = {values[name]:.6g}" for name, _ in condition.terms)
            raise BadInput(
                f"[parameters] {condition.terms[0][0]}: {condition.reason}; change one of these parameters: {named}"
            )
    return found


def _parameter(variable: Variable, value: float | str | None) -> float:
    key = f"[parameters] {variable.symbol}"
    if value is None:
        raise BadInput(f"{key}: missing, and the model has no default; add {_wanted(variable)}")
    return value_of(variable, value, key)


def initial(table: Mapping[str, float | str], spec: ProblemSpec) -> Row:
    """Return the initial state in the model's order."""
    known(table, spec.states, "state", "initial")
    return tuple(_initial(v, table.get(v.symbol)) for v in spec.states)


def _initial(variable: Variable, value: float | str | None) -> float:
    key = f"[initial] {variable.symbol}"
    if value is None:
        raise BadInput(f"{key}: missing; add {_wanted(variable)}")
    if value == REFERENCE:
        raise BadInput(f'{key}: "{REFERENCE}" can be used in [final] only; give {_wanted(variable)}')
    return value_of(variable, value, key)


def final(table: Mapping[str, float | str], spec: ProblemSpec) -> dict[str, float | Literal["reference"]]:
    """Return the given final states in the model's order, without ``"free"`` ones; ``"reference"`` is kept."""
    known(table, spec.states, "state", "final")
    given = [v for v in spec.states if table.get(v.symbol, FREE) != FREE]
    return {v.symbol: _final(v, table[v.symbol], spec) for v in given}


def _final(variable: Variable, value: float | str, spec: ProblemSpec) -> float | Literal["reference"]:
    key = f"[final] {variable.symbol}"
    if value != REFERENCE:
        return value_of(variable, value, key)
    if not spec.has_reference:
        raise BadInput(f"{key}: the model {spec.name} has no reference; give {_wanted(variable)}")
    return REFERENCE


def times(table: TimeTable, spec: ProblemSpec) -> tuple[float, float | None, float | None]:
    """Return initial time, final time (``None`` where free) and the guess of the final time."""
    t0 = time(table.t0, "[time] t0", spec)
    tf = None if table.tf == FREE else time(table.tf, "[time] tf", spec)
    if tf is None and not spec.has_cost:
        raise BadInput(f"[time] tf: the model {spec.name} has no cost that could determine the time; give a number")
    if tf is not None and table.tf_guess is not None:
        raise BadInput(f'[time] tf_guess: the final time is given; remove tf_guess, or write tf = "{FREE}"')
    tf_guess = None if table.tf_guess is None else time(table.tf_guess, "[time] tf_guess", spec)
    for key, end, given in (("tf", tf, table.tf), ("tf_guess", tf_guess, table.tf_guess)):
        if end is not None and not (end > t0 and math.isfinite(end - t0)):
            why, what = ("is not after", "a later time") if end <= t0 else ("is too far from", "a time closer to t0")
            raise BadInput(f"[time] {key}: {shown(given)} {why} t0 = {shown(t0)}; give {what}")
    return t0, tf, tf_guess


def time(value: float | str, key: str, spec: ProblemSpec) -> float:
    """Convert a time to the model's unit of time."""
    if not isinstance(value, str):
        return float(value)
    try:
        unit = units.time_unit(v.unit for v in (*spec.states, *spec.controls, *spec.parameters))
    except BadInput as error:
        raise BadInput(f"{key}: {error}") from None
    return quantity(value, unit, key)


def _wanted(variable: Variable) -> str:
    return "a number" + (f" in {variable.unit}" if variable.unit != "1" else "")
