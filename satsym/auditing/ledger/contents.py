"""The contents of a ledger: what a document prints, and what each printed item is compared with.

The formulas of a row are read from its table here, in the notation of the document.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from satsym.auditing import quantities
from satsym.auditing.ledger import vocabulary
from satsym.auditing.ledger.schema import DocumentTable, RowTable, SymbolTable
from satsym.auditing.ledger.scopes import Scope
from satsym.auditing.propositions.reading import Proposition
from satsym.auditing.sentences import Said
from satsym.formula import reading
from satsym.formula.functions import row_key
from satsym.formula.tree import Equality, Formula, Node, Text, calls_in, cells, each, names_in, substituted, walk
from satsym.formula.weight import Scales
from satsym.status import BadInput
from satsym.wording import shown, suggestion

FORMULAS = ("equation", "algorithm")
"""Kinds of rows that print one formula."""


@dataclass(frozen=True)
class Row:
    """A row of a ledger: one printed item of a document, such as an equation, a number or a claim."""

    table: RowTable
    """The keys of the row in the ledger."""
    key: str
    """Item and part, by which other rows refer to this row."""
    place: str
    """File and line of the row."""
    printed: Formula | None = None
    """Printed formula in the document's symbols: an expression, an equality, or rows of expressions (a matrix).

    ``None`` if the printed item is not a formula.
    """
    holds: Node | Equality | None = None
    """Derived formula that the row is compared with, in the names of the models; ``None`` if a proposition judges the
    row."""
    follows: Node | Equality | None = None
    """How the row follows from other rows according to the document, in the document's symbols."""
    claims: Proposition | None = None
    """The proposition that has to hold: the printed claim, or the one that a row of another kind is judged by."""
    because: Proposition | None = None
    produced: Proposition | None = None
    """`because` is the reason that the document gives; `produced` tests whether the printed algorithm causes the
    result."""
    why: tuple[str | Proposition, ...] = ()
    """Explanation why the row is wrong, as texts with terms to be evaluated between them."""
    why_id: tuple[str | Proposition, ...] = ()
    """The explanation in Indonesian; empty if the ledger has none."""
    says_id: str = ""
    """Subject of the row in Indonesian; empty if the ledger does not state it."""

    @property
    def says(self) -> Said:
        """Subject of the row in both languages."""
        return Said(self.table.says, self.says_id)

    @property
    def uses(self) -> list[str]:
        """Keys of the rows that the row follows from."""
        if not isinstance(self.table.follows, str):
            return list(self.table.follows)
        return list(dict.fromkeys(row_key(call) for call in calls_in(self.follows) if call.function == "row"))


@dataclass(frozen=True)
class Ledger:
    """A ledger that was read: the rows of a document with its notation, symbols and numbers."""

    path: Path
    name: str
    document: DocumentTable
    scopes: Mapping[str, Scope]
    symbols: Mapping[str, SymbolTable]
    inputs: Mapping[str, str]
    rows: tuple[Row, ...]
    model: str = ""
    """Name of the document's model, whose names need no prefix, without the folder."""
    folder: Path | None = None
    """Folder of derivations that are used in addition to the shipped ones."""

    @cached_property
    def models(self) -> tuple[str, ...]:
        """Models whose derivations the ledger refers to, that of the document first."""
        trees = [side for row in self.rows for formula in (row.holds, row.follows) for side in cells(formula)]
        trees += [meaning for scope in self.scopes.values() for meaning in scope.meanings.values()]
        texts = [part.value for tree in trees for _, part in walk(tree) if isinstance(part, Text)]
        named = (text.partition(":")[0] for text in texts if vocabulary.is_address(text))
        return tuple(dict.fromkeys(filter(None, (self.model, *named))))

    def uncovered(self) -> list[str]:
        """Return the numbers of the document's equations etc. for which the ledger has no row."""
        covered = {row.table.item for row in self.rows}
        return [number for number in self.document.numbers if number not in covered]


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
