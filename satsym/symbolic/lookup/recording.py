"""Conversion of a derivation to plain data, as :mod:`satsym.records.record` defines it."""

from __future__ import annotations

from collections.abc import Iterator

import sympy as sp

from satsym.formula import reading
from satsym.formula.writing import written
from satsym.records.record import FORMAT, Name, Record, RecordedStep, Stated
from satsym.records.record import Text as Written
from satsym.spec import Variable
from satsym.status import BadInput
from satsym.symbolic import dimensions
from satsym.symbolic.algebra import definitions_of
from satsym.symbolic.declared import begin
from satsym.symbolic.derivation import Derivation, Equation
from satsym.symbolic.dimensions import Known
from satsym.symbolic.lookup.formulas import NotAFormula, plain, to_tree
from satsym.symbolic.model import variables_of
from satsym.symbolic.principle.path import interior


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
        declared={name: _value(value) for name, value in _declared(derivation).items()},
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


def _declared(derivation: Derivation) -> dict[str, object]:
    """Return what ``model:declared.name`` names: costs, constraints, declarations of the kind, and all variables."""
    model, problem = derivation.model, derivation.problem
    found: dict[str, object] = {v.symbol: sp.Symbol(v.symbol) for v in variables_of(model)}
    found |= {o.variable.symbol: o.value for o in model.outputs}
    found |= {symbol.name: value for symbol, value in definitions_of(model).items()}
    if problem:
        found |= {"L": problem.running_cost, "S": problem.terminal_cost}
        found |= {f"psi_{k}": value for k, value in enumerate(problem.end_conditions, start=1)}
        found |= problem.path_constraints
        found |= interior.named(problem)
    return found | dict(model.declared())


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
