"""Addresses of derived expressions: equations, matrices made of a family of equations, and declarations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import sympy as sp

from satsym.spec import names
from satsym.status import BadInput
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.derivation import Derivation, Equation, Step
from satsym.symbolic.model import symbols_of, variables_of
from satsym.symbolic.principle.path import interior
from satsym.wording import shown, suggestion

DECLARED = "declared"


@dataclass(frozen=True)
class Family:
    """A matrix whose entries are equations of a step, with the names of its rows and columns."""

    rows: tuple[str, ...]
    columns: tuple[str, ...]
    entries: tuple[tuple[sp.Expr, ...], ...]

    @property
    def matrix(self) -> sp.Matrix:
        """Return the matrix of the entries."""
        return sp.Matrix(self.entries)


Found: TypeAlias = Equation | Family | sp.Expr


def resolve(derivation: Derivation, address: str) -> Found:
    """Return what stands at ``model:step.equation``, ``model:step.A`` or ``model:declared.name``.

    Raises
    ------
    BadInput
        If there is none.
    """
    step_name, _, name = address.partition(":")[2].partition(".")
    if step_name == DECLARED:
        return _declared(derivation, name, address)
    if step_name not in derivation:
        known = [step.name for step in derivation.steps]
        raise BadInput(f"{shown(address)}: there is no step {shown(step_name)}; {suggestion(step_name, known)}")
    step = derivation.step(step_name)
    for equation in step.equations:
        if equation.name == name:
            return equation
    family = _family(derivation, step, name)
    if family is None:
        known = [equation.name for equation in step.equations]
        raise BadInput(f"{shown(address)}: the step has no {shown(name)}; {suggestion(name, known)}")
    return family


def addresses(derivation: Derivation) -> list[str]:
    """Return the address of every equation of a derivation."""
    return [
        f"{derivation.name}:{step.name}.{equation.name}" for step in derivation.steps for equation in step.equations
    ]


def _family(derivation: Derivation, step: Step, prefix: str) -> Family | None:
    """Return the entries named ``prefix_row_column``, with declared variables as rows and columns."""
    model = derivation.model
    groups: list[tuple[str, ...]] = [names(model.states), names(model.controls)]
    groups.append(tuple(output.variable.symbol for output in model.outputs))
    values = {e.name: e.rhs for e in step.equations} | {
        e.lhs.name: e.rhs for e in step.equations if isinstance(e.lhs, sp.Symbol)
    }
    family = {name: value for name, value in values.items() if name.startswith(f"{prefix}_")}
    if not family:
        return None
    return _by_names(family, prefix, groups) or _by_numbers(family, prefix)


def _by_names(family: Mapping[str, sp.Expr], prefix: str, groups: Sequence[tuple[str, ...]]) -> Family | None:
    for rows in groups:
        for columns in groups:
            places = {f"{prefix}_{row}_{column}" for row in rows for column in columns}
            if set(family) <= places:
                entries = tuple(
                    tuple(family.get(f"{prefix}_{row}_{column}", sp.Integer(0)) for column in columns) for row in rows
                )
                return Family(rows, columns, entries)
    return None


def _by_numbers(family: Mapping[str, sp.Expr], prefix: str) -> Family | None:
    """Return the entries named ``prefix_1_2`` of a family."""
    places = [tuple(name.removeprefix(f"{prefix}_").split("_")) for name in family]
    if any(len(place) != 2 or not all(part.isdigit() for part in place) for place in places):
        return None
    m, n = (max(int(place[k]) for place in places) for k in (0, 1))
    rows, columns = _counted(m), _counted(n)
    entries = tuple(tuple(family.get(f"{prefix}_{i}_{j}", sp.Integer(0)) for j in columns) for i in rows)
    return Family(rows, columns, entries)


def _declared(derivation: Derivation, name: str, address: str) -> Found:
    model, problem = derivation.model, derivation.problem
    variables = variables_of(model)
    found: dict[str, Found] = {s.name: s for s in symbols_of(variables)}
    found |= {symbol.name: value for symbol, value in definitions_of(model).items()}
    if problem:
        found |= {"L": problem.running_cost, "S": sp.sympify(problem.terminal_cost)}
        found |= {f"psi_{k}": value for k, value in enumerate(problem.end_conditions, start=1)}
        found |= {name: sp.sympify(value) for name, value in problem.path_constraints.items()}
        found |= interior.named(problem)
    found |= {key: _column(value) if value.is_Matrix else value for key, value in model.declared().items()}
    if name not in found:
        raise BadInput(f"{shown(address)}: no declared variable has this name; {suggestion(name, found)}")
    return found[name]


def _column(vector: Iterable[sp.Expr]) -> Family:
    entries = tuple((entry,) for entry in vector)
    return Family(_counted(len(entries)), ("1",), entries)


def _counted(n: int) -> tuple[str, ...]:
    return tuple(str(i) for i in range(1, n + 1))
