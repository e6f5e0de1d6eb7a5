"""Reader of the formulas of one row of a ledger."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from satsym.auditing import quantities
from satsym.auditing.ledger import vocabulary
from satsym.auditing.ledger.schema import RowTable
from satsym.auditing.ledger.scopes import Scope
from satsym.formula import reading
from satsym.formula.tree import Equality, Formula, Node, Text, each, names_in, substituted
from satsym.formula.weight import Scales
from satsym.status import BadInput
from satsym.wording import shown, suggestion

FORMULAS = ("equation", "algorithm")
"""Kinds of rows that print one formula."""


def printed(table: RowTable, scope: Scope) -> Formula | None:
    """Return the printed formula of a row; ``None`` for kinds of rows that print no formula."""
    if table.kind == "number":
        quantities.printed_number(_one_text(table))
    if table.kind not in (*FORMULAS, "matrix"):
        if not table.printed:
            raise BadInput("missing; give the printed text")
        return None
    if table.kind in FORMULAS:
        formula = reading.statement(_one_text(table))
        _refuse_unknown(formula, scope)
        return formula
    if isinstance(table.printed, str) or not table.printed:
        raise BadInput('write a list of rows, such as [["0", "1"], ["3*omega**2", "0"]]')
    lines = [(line,) if isinstance(line, str) else line for line in table.printed]
    if len({len(line) for line in lines}) > 1 or not lines[0]:
        raise BadInput("all rows must have the same length")
    entries = tuple(tuple(map(reading.expression, line)) for line in lines)
    _refuse_unknown(entries, scope)
    return entries


def readable(table: RowTable, scope: Scope) -> Formula | None:
    """Return the printed formula of a row that a proposition judges; ``None`` if the printed text is not a formula."""
    try:
        return printed(table, scope)
    except BadInput:
        return None


def held_against(
    table: RowTable, derived: Mapping[str, Node], own: Collection[str], inputs: Mapping[str, str]
) -> Node | Equality:
    """Return the formula that a row is compared with."""
    if vocabulary.is_address(table.holds):
        formula: Node | Equality = Text(table.holds.strip())
    else:
        formula = _with(reading.statement(table.holds, judging=True), derived)
    if table.kind == "number" and quantities.is_numeric(formula):
        quantities.check(formula, {**inputs, **table.inputs})
    else:
        vocabulary.check(formula, own)
    return formula


def follows(table: RowTable, derived: Mapping[str, Node], own: Collection[str], scope: Scope) -> Node | Equality:
    """Return the formula by which a row follows from other rows."""
    formula = _with(reading.statement(str(table.follows), judging=True), derived)
    _refuse_unknown(formula, scope, own)
    return formula


def _one_text(table: RowTable) -> str:
    if not isinstance(table.printed, str) or not table.printed:
        raise BadInput("write the printed expression as a single quoted string")
    return table.printed


def _refuse_unknown(formula: Formula, scope: Scope, own: Collection[str] | None = None) -> None:
    """Refuse symbols that are not in the notation of the row or, if given, among the names of derivations."""
    for name in sorted(names_in(formula)):
        if not scope.knows(name) and (own is None or name not in own):
            raise BadInput(f"{shown(name)} is not a symbol of [scope.{scope.name}]; {suggestion(name, scope.meanings)}")


def _with(formula: Formula, derived: Mapping[str, Node]) -> Any:
    return each(formula, lambda cell: Scales().checked(substituted(cell, derived)))
