"""A ledger, read: what a document prints, and what each thing is to be held against."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from satsym.auditing.ledger.schema import DocumentTable, RowTable, SymbolTable
from satsym.auditing.ledger.scopes import Scope
from satsym.auditing.ledger.vocabulary import is_address
from satsym.auditing.propositions.reading import Proposition
from satsym.auditing.sentences import Said
from satsym.formula.tree import Call, Equality, Formula, Node, Text, calls_in, cells, walk


@dataclass(frozen=True)
class Row:
    """One printed thing, read."""

    table: RowTable
    """As the ledger has it."""
    key: str
    """The item and its part: how other rows name it."""
    place: str
    """File and line where it stands."""
    printed: Formula | None = None
    """The printed formula in the document's symbols: an expression, an equality, rows of expressions (matrix),
    or ``None`` where what is printed is not a formula."""
    holds: Node | Equality | None = None
    """What it is held against, in our names; ``None`` where a proposition judges."""
    follows: Node | Equality | None = None
    """How the document says it follows, over printed rows, in the document's symbols."""
    claims: Proposition | None = None
    """The proposition that has to hold: what a claim prints, or what another row is held against."""
    because: Proposition | None = None
    produced: Proposition | None = None
    """The reason given, and what tells that the printed algorithm produces it."""
    why: tuple[str | Proposition, ...] = ()
    """A sentence that explains why it is not so: texts, and terms to be measured between them."""
    why_id: tuple[str | Proposition, ...] = ()
    """The explaining sentence in Indonesian, where the ledger has it."""
    says_id: str = ""
    """What it is about in Indonesian, where the ledger has it."""

    @property
    def says(self) -> Said:
        """What it is about, in both languages."""
        return Said(self.table.says, self.says_id)

    @property
    def uses(self) -> list[str]:
        """Keys of the rows it is said to follow from."""
        if not isinstance(self.table.follows, str):
            return list(self.table.follows)
        return list(dict.fromkeys(row_key(call) for call in calls_in(self.follows) if call.function == "row"))


@dataclass(frozen=True)
class Ledger:
    """What a document prints."""

    path: Path
    name: str
    document: DocumentTable
    scopes: Mapping[str, Scope]
    symbols: Mapping[str, SymbolTable]
    inputs: Mapping[str, str]
    rows: tuple[Row, ...]
    model: str = ""
    """The model whose names are its own, without the folder."""
    folder: Path | None = None
    """Where records of derivations lie, beside the shipped ones."""

    @cached_property
    def models(self) -> tuple[str, ...]:
        """Derivations that it names, that of the document first."""
        trees = [side for row in self.rows for formula in (row.holds, row.follows) for side in cells(formula)]
        trees += [meaning for scope in self.scopes.values() for meaning in scope.meanings.values()]
        texts = [part.value for tree in trees for _, part in walk(tree) if isinstance(part, Text)]
        named = (text.partition(":")[0] for text in texts if is_address(text))
        return tuple(dict.fromkeys(filter(None, (self.model, *named))))

    def uncovered(self) -> list[str]:
        """Numbers of the document that have no row."""
        covered = {row.table.item for row in self.rows}
        return [number for number in self.document.numbers if number not in covered]


def row_key(call: Call) -> str:
    """The key that ``row['item']`` or ``row['item', 'part']`` names."""
    return " ".join(argument.value for argument in call.arguments if isinstance(argument, Text))
