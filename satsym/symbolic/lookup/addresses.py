"""Addresses of derived expressions: equations, matrices made of a family of equations, and declarations.

A derivation is also converted to plain data that has the same addresses, as :mod:`satsym.records.record` defines it.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import sympy as sp

from satsym.formula import reading
from satsym.formula.writing import written
from satsym.records.record import FORMAT, Name, Record, RecordedStep, Stated
from satsym.records.record import Text as Written
from satsym.spec import Variable, names
from satsym.status import BadInput
from satsym.symbolic import dimensions
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.declared import begin
from satsym.symbolic.derivation import Derivation, Equation, Step
from satsym.symbolic.dimensions import Known
from satsym.symbolic.lookup.formulas import NotAFormula, plain, to_tree
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
    found: dict[str, Found] = {s.name: s for s in symbols_of(variables_of(derivation.model))}
    found |= _given(derivation)
    found |= {key: _column(value) if value.is_Matrix else value for key, value in derivation.model.declared().items()}
    if name not in found:
        raise BadInput(f"{shown(address)}: no declared variable has this name; {suggestion(name, found)}")
    return found[name]


def _given(derivation: Derivation) -> dict[str, sp.Expr]:
    """Return named constants, costs and constraints by their names."""
    problem = derivation.problem
    found: dict[str, sp.Expr] = {symbol.name: value for symbol, value in definitions_of(derivation.model).items()}
    if problem:
        found |= {"L": problem.running_cost, "S": sp.sympify(problem.terminal_cost)}
        found |= {f"psi_{k}": value for k, value in enumerate(problem.end_conditions, start=1)}
        found |= {name: sp.sympify(value) for name, value in problem.path_constraints.items()}
        found |= interior.named(problem)
    return found


def _column(vector: Iterable[sp.Expr]) -> Family:
    entries = tuple((entry,) for entry in vector)
    return Family(_counted(len(entries)), ("1",), entries)


def _counted(n: int) -> tuple[str, ...]:
    return tuple(str(i) for i in range(1, n + 1))


def recorded(derivation: Derivation, source: str) -> Record:
    """Convert everything that a derivation establishes to data.

    Parameters
    ----------
    source
        Name of the derivation file.
    """
    return Record(
        written=f"Written by satsym from {source}. Do not edit.",
        format=FORMAT,
        name=derivation.name,
        title=derivation.title,
        sources={},
        names=_names(derivation, known_dimensions(derivation)),
        definitions={s.name: _text(value) or "" for s, value in definitions_of(derivation.model).items()},
        declared={name: _value(value) for name, value in _declarations(derivation).items()},
        steps=[
            RecordedStep(step.name, step.rule, list(step.follows_from), [_equation(e) for e in step.equations])
            for step in derivation.steps
        ],
    )


def known_dimensions(derivation: Derivation) -> Known:
    """Return the dimensions of all names of a derivation."""
    known = dimensions.declared(begin(derivation.model, derivation.problem))
    for step in derivation.steps:
        known = dimensions.extended(known, step)
    return known


def _kinds(derivation: Derivation) -> Iterator[tuple[str, Variable]]:
    model = derivation.model
    yield from (("state", v) for v in model.states)
    yield from (("control", v) for v in model.controls)
    yield from (("parameter", v) for v in model.parameters)
    yield from (("output", o.variable) for o in model.outputs)
    yield from (("constant", d.variable) for d in model.definitions)
    yield from (("other", v) for v in variables_of(model))


def _names(derivation: Derivation, known: Known) -> dict[str, Name]:
    """Return every name that occurs in a derivation, declared ones first."""
    variables: dict[str, tuple[str, Variable]] = {}
    for kind, variable in _kinds(derivation):
        variables.setdefault(variable.symbol, (kind, variable))
    equations = [e for step in derivation.steps for e in step.equations]
    inside: dict[str, bool] = {}
    for symbol in sorted(set().union(*(e.lhs.free_symbols | e.rhs.free_symbols for e in equations)), key=str):
        inside[symbol.name] = inside.get(symbol.name, True) and bool(symbol.is_positive)
    found = {}
    for name in dict.fromkeys((*variables, *inside)):
        kind, variable = variables.get(name, ("", Variable(name, name)))
        found[name] = Name(
            latex=derivation.notation.get(name) or (variable.latex if kind else ""),
            kind=kind,
            unit=variable.unit if kind else "",
            dimension=_dimension(known, name),
            positive=inside.get(name, True) and (variable.positive or not kind),
            meaning=variable.meaning,
        )
    return found


def _dimension(known: Known, name: str) -> dict[str, str] | None:
    dimension = known.get(name)
    if dimension is None or not all(sp.sympify(power).is_Rational for power in dimension.values()):
        return None
    return {base: str(power) for base, power in dimension.items()}


def _declarations(derivation: Derivation) -> dict[str, object]:
    """Return what ``model:declared.name`` names: costs, constraints, declarations of the kind, and all variables."""
    found: dict[str, object] = {v.symbol: sp.Symbol(v.symbol) for v in variables_of(derivation.model)}
    found |= {o.variable.symbol: o.value for o in derivation.model.outputs}
    return found | _given(derivation) | dict(derivation.model.declared())


def _equation(equation: Equation) -> Stated:
    return Stated(equation.name, _text(equation.lhs), _value(equation.rhs))


def _value(value: object) -> Written | list[list[Written]]:
    if isinstance(value, sp.MatrixBase):
        return [[_text(entry) for entry in row] for row in value.tolist()]
    return _text(value)


def _text(expression: object) -> Written:
    """Write a formula as text, if the text can be read again."""
    try:
        text = written(to_tree(plain(sp.sympify(expression))))
        reading.expression(text)
    except (NotAFormula, BadInput):
        return None
    return text
