"""Reader of ledgers, which checks every formula before anything is derived or a large library is loaded.

Checks are made in order of their cost: all texts first, then the units, for which pint is loaded.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

from satsym.auditing import measurements, quantities
from satsym.auditing.ledger import contents, documents, schema, vocabulary
from satsym.auditing.ledger import scopes as notation
from satsym.auditing.ledger.contents import Ledger, Row
from satsym.auditing.ledger.positions import Part
from satsym.auditing.ledger.schema import DocumentTable, RowTable, SymbolTable, WrongKey
from satsym.auditing.ledger.scopes import Scope
from satsym.auditing.propositions.reading import explanation, is_proposition, matching, proposition
from satsym.formula import budget, reading
from satsym.formula.functions import row_key
from satsym.formula.tree import Node, calls_in, substituted
from satsym.formula.weight import Scales
from satsym.instance import files
from satsym.records import shelf
from satsym.status import BadInput
from satsym.wording import printable, refuse_unknown, shown, suggestion

REASONS = ("because", "produced")
TABLES = ("format", "document", "scope", "symbols", "inputs", "derived", "row")

_CLAUSE = re.compile(r"[;:] ")


def read(path: Path) -> Ledger:
    """Read and check a ledger, the file that lists the claims of a document.

    Raises
    ------
    BadInput
        If the ledger is not valid; the message is one line, ``FILE:LINE: what is wrong; what to do``.
    """
    parts = _parts(path)
    allowance = budget.Allowance(counted=path not in documents.shipped())
    return allowance.within(budget.READING, lambda: _read(path, parts))


def _read(path: Path, parts: Sequence[Part]) -> Ledger:
    reader = _Reader(path, parts)
    with shelf.opened(reader.folder):
        return reader.ledger(documents.named(path))


def _parts(path: Path) -> list[Part]:
    """Return the files of a ledger, of which chapters may contain only rows."""
    found: list[Part] = []
    for file in documents.files_of(path):
        try:
            tree = files.read(file)
        except BadInput as error:
            raise BadInput(f"{printable(str(file), 200)}: {error}") from None
        part = Part(file, tree, sum(len(each.tree.get("row", [])) for each in found))
        for key in tree if found else ():
            if key != "row":
                raise BadInput(
                    f"{part.place(key, 0, key)}: {printable(key)}: this table is not allowed in a chapter; put "
                    f"it in {documents.HEAD}"
                )
        if found and not isinstance(tree.get("row"), list):
            raise BadInput(f"{part.place('')}: row: the ledger has no rows; write one [[row]] for each printed item")
        found.append(part)
        if not isinstance(tree.get("row", []), list):
            break
    return found


class _Reader:
    """Reader of a ledger table by table; errors are reported with the line where they occur."""

    def __init__(self, path: Path, parts: Sequence[Part]) -> None:
        self._path, self._parts = path, parts
        head, *chapters = (part.tree for part in parts)
        self._tree = dict(head)
        for tree in chapters:
            self._tree["row"] = [*self._tree.get("row", []), *tree["row"]]
        document = self._tree.get("document", {})
        stated = document.get("model", "") if isinstance(document, dict) else ""
        with self._telling("document", "model"):
            home = path if path.is_dir() else path.parent
            self.folder, self._model = (
                shelf.place_of(stated, home) if stated and isinstance(stated, str) else (None, "")
            )

    def ledger(self, name: str) -> Ledger:
        """Return the ledger after all its tables are read and checked."""
        self._refuse_unknown_tables()
        document = self._document()
        with self._telling("document", "model"):
            if self._model:
                shelf.find(self._model)
        self._symbols = self._entries("symbols", _symbol)
        self._inputs = self._entries("inputs", _input)
        self._derived: dict[str, Node] = {}
        self._scales = Scales()
        self._derived = self._entries("derived", self._expression, self._derived)
        self._scopes = self._read_scopes()
        self._own = {*self._symbols, *notation.self_named(self._scopes), *notation.CONSTANTS}
        with self._telling("document", "model"):
            for model in {self._model, *vocabulary.models_in(self._tree)} - {""}:
                self._own.update(vocabulary.names_of(model))
        self._check_scopes()
        tables = self._tree.get("row", [])
        if not isinstance(tables, list) or not tables:
            raise self._bad("row: the ledger has no rows; write one [[row]] for each printed item")
        found = [self._row(i, entry) for i, entry in enumerate(tables)]
        self._check_references(found)
        self._check_units(found)
        found = _with_indonesian(found, documents.beside(self._path, documents.INDONESIAN))
        tables = self._scopes, self._symbols, self._inputs
        return Ledger(self._path, name, document, *tables, tuple(found), self._model, self.folder)

    def _refuse_unknown_tables(self) -> None:
        for key in self._tree:
            if key not in TABLES:
                raise self._bad(f"{printable(key)}: unknown key; {suggestion(key, TABLES)}", key, key)
        stated = self._tree.get("format")
        if stated != schema.FORMAT:
            raise self._bad(f"format: got {shown(stated)}; write format = {schema.FORMAT}", "", "format")

    def _document(self) -> DocumentTable:
        with self._telling("document", ""):
            found: DocumentTable = schema.table(self._tree.get("document", {}), DocumentTable)
        with self._telling("document", "key"):
            reading.checked_name(found.key)
        return found

    def _entries(
        self, table: str, read_entry: Callable[..., Any], into: dict[str, Any] | None = None
    ) -> dict[str, Any]:
        """Return the entries of a table that maps names to values."""
        found = {} if into is None else into
        for name, entry in self._mapping(table).items():
            with self._telling(table, name):
                reading.checked_name(name)
                found[name] = read_entry(entry)
        return found

    def _expression(self, entry: object) -> Node:
        if not isinstance(entry, str):
            raise BadInput(f"got {shown(entry)}; write an expression in quotes")
        return self._scales.checked(substituted(reading.expression(entry, judging=True), self._derived))

    def _read_scopes(self) -> dict[str, Scope]:
        tables = {"main": {}, **self._mapping("scope")}
        for name, entry in tables.items():
            with self._telling("scope", name):
                if not isinstance(entry, dict):
                    raise BadInput(f"got {shown(entry)}; write a table [scope.{printable(name)}]")
        return notation.scopes(tables, self._derived, self._telling)

    def _check_scopes(self) -> None:
        for scope in self._scopes.values():
            for key in self._tree.get("scope", {}).get(scope.name, {}):
                if key in scope.meanings:
                    with self._telling(f"scope.{scope.name}", key):
                        vocabulary.check(scope.meanings[key], self._own)

    def _row(self, index: int, entry: object) -> Row:
        title = printable(str(entry.get("item", index + 1))) if isinstance(entry, dict) else str(index + 1)
        with self._telling("row", "", index, title):
            table: RowTable = schema.table(entry, RowTable)
        key = f"{table.item} {table.part}".strip()
        row = Row(table, key, self._place("row", index))
        with self._telling("row", "scope", index, key):
            refuse_unknown("there is no scope", table.scope, self._scopes)
        if not table.legible:
            return row
        scope = self._scopes[table.scope]
        if not table.holds if table.kind == "claim" else is_proposition(table.holds):
            return self._claim(index, row, scope)
        with self._telling("row", "holds", index, key):
            if not table.holds:
                raise BadInput("missing; write an address, an expression over addresses, or a proposition")
            if table.kind == "claim":
                raise BadInput("a claim is judged by the proposition that it states; leave out `holds`")
            if table.kind == "table":
                raise BadInput('a table is judged by a proposition, such as "all(a == b for a, b in printed)"')
        found: dict[str, Any] = {}
        with self._telling("row", "printed", index, key):
            found["printed"] = contents.printed(table, scope)
        with self._telling("row", "inputs", index, key):
            for value in table.inputs.values():
                _input(value)
        with self._telling("row", "holds", index, key):
            found["holds"] = contents.held_against(table, self._derived, self._own, self._inputs)
        with self._telling("row", "from", index, key):
            found["follows"] = contents.follows(table, self._derived, self._own, scope) if table.follows else None
        return replace(row, **found, **self._explanations(index, row, scope, own=True))

    def _claim(self, index: int, row: Row, scope: Scope) -> Row:
        """Read a row that is judged by a proposition: a claim prints it, any other row states it as ``holds``."""
        table, words = row.table, measurements.words(scope.meanings)
        own = table.kind != "claim"
        with self._telling("row", "printed", index, row.key):
            if not table.printed or (not own and not isinstance(table.printed, str)):
                raise BadInput(
                    "missing; write the proposition in quotes" if not own else "missing; give the printed text"
                )
            row = replace(row, printed=contents.readable(table, scope) if own else None)
        found: dict[str, Any] = {}
        for key, text in (
            ("claims", table.holds if own else table.printed),
            *((k, getattr(table, k)) for k in REASONS),
        ):
            with self._telling("row", key if key in REASONS else "holds" if own else "printed", index, row.key):
                found[key] = proposition(str(text), words, own=own) if text else None
        with self._telling("row", "from", index, row.key):
            if isinstance(table.follows, str) and table.follows:
                raise BadInput('write a list of the rows from which the conclusion is drawn, such as ["2.19", "2.20"]')
        return replace(row, **found, **self._explanations(index, row, scope, own=own))

    def _explanations(self, index: int, row: Row, scope: Scope, *, own: bool) -> dict[str, Any]:
        """Return the explanation of a row in each language in which the ledger contains it."""
        found: dict[str, Any] = {}
        for key in ("why", "why_id"):
            with self._telling("row", key, index, row.key):
                if text := getattr(row.table, key):  # measurements load what ledgers without propositions never need
                    found[key] = explanation(text, measurements.words(scope.meanings), own=own)
        return found

    def _check_references(self, found: Sequence[Row]) -> None:
        by_key: dict[str, Row] = {}
        for index, row in enumerate(found):
            with self._telling("row", "item", index, row.key):
                if row.key in by_key:
                    raise BadInput("another row has the same name; give the two rows different parts")
            by_key[row.key] = row
        for index, row in enumerate(found):
            for key, formula in (("holds", row.holds), ("from", row.follows)):
                with self._telling("row", key, index, row.key):
                    _check_rows_named(row, formula, by_key)
            for claim in filter(None, (row.claims, row.because, row.produced)):
                with self._telling("row", "printed" if row.table.kind == "claim" else "holds", index, row.key):
                    for name in claim.rows:
                        if not any(map(matching(name), by_key)):
                            raise BadInput(f"there is no row {shown(name)}; {suggestion(name, by_key)}")
            with self._telling("row", "from", index, row.key):
                for name in row.uses:
                    if name not in by_key or name == row.key:
                        raise BadInput(f"{shown(name)} is not another row of the ledger; {suggestion(name, by_key)}")

    def _check_units(self, found: Sequence[Row]) -> None:
        for name, text in self._inputs.items():
            with self._telling("inputs", name):
                quantities.in_base_units(text)
        for name, symbol in self._symbols.items():
            with self._telling("symbols", name):
                quantities.check_unit(symbol.unit or "1")
        for index, row in enumerate(found):
            if row.table.legible and row.claims is None and row.table.kind in ("number", "unit"):
                with self._telling("row", "printed", index, row.key):
                    text = str(row.table.printed)
                    quantities.check_unit(text if row.table.kind == "unit" else quantities.printed_number(text).unit)
            with self._telling("row", "inputs", index, row.key):
                for text in row.table.inputs.values():
                    quantities.in_base_units(text)

    def _mapping(self, name: str) -> dict[str, Any]:
        found = self._tree.get(name, {})
        if not isinstance(found, dict):
            raise self._bad(f"{name}: got {shown(found)}; write a table [{name}]", name, name)
        return found

    @contextmanager
    def _telling(self, table: str, key: str, index: int = 0, row: str = "") -> Iterator[None]:
        """Add file, line and key to any error that is raised in this context."""
        try:
            yield
        except WrongKey as error:
            where = f"row {row}: " if table == "row" else f"[{table}] "
            raise self._bad(f"{where}{error}", table, error.key, index) from None
        except (BadInput, budget.Spent) as error:
            where = f"row {printable(row)}: {key}: " if table == "row" else f"[{table}] {printable(key)}: "
            raise self._bad(f"{where}{error}", table, key, index) from None

    def _bad(self, message: str, table: str = "", key: str = "", index: int = 0) -> BadInput:
        return BadInput(f"{self._place(table, index, key)}: {message}")

    def _place(self, table: str, index: int = 0, key: str = "") -> str:
        own = [part for part in self._parts if part.first <= index] if table == "row" else self._parts[:1]
        return own[-1].place(table, index, key)


def _check_rows_named(row: Row, formula: Any, by_key: Mapping[str, Row]) -> None:
    for call in calls_in(formula):
        if call.function == "row":
            name = row_key(call)
            if name == row.key:
                raise BadInput("a row cannot follow from itself")
            if name not in by_key or by_key[name].printed is None:
                raise BadInput(f"there is no row {shown(name)} with a formula; {suggestion(name, by_key)}")


def _symbol(entry: object) -> SymbolTable:
    if isinstance(entry, str):
        return SymbolTable(unit=entry)
    found: SymbolTable = schema.table(entry, SymbolTable)
    return found


def _input(entry: object) -> str:
    if not isinstance(entry, str):
        raise BadInput(f'got {shown(entry)}; write a number with its unit in quotes, such as "6378 km"')
    quantities.printed_number(entry)
    return entry


def _with_indonesian(found: list[Row], path: Path) -> list[Row]:
    """Return rows with their Indonesian subjects, from a flat table ``"English subject" = "Indonesian subject"``.

    Rows are unchanged if the file does not exist.

    Raises
    ------
    BadInput
        If an entry is not a text, or no row has this subject; the message contains file and line.
    """
    if not path.exists():
        return found
    try:
        part = Part(path, files.read(path), 0)
    except BadInput as error:
        raise BadInput(f"{printable(str(path), 200)}: {error}") from None
    said = {row.table.says for row in found if row.table.says}
    for english, text in part.tree.items():
        place, begins = part.place("", 0, english), shown(_CLAUSE.split(english)[0])
        if not isinstance(text, str) or not text.strip():
            raise BadInput(f"{place}: got {shown(text)} for {begins}; write the Indonesian translation in quotes")
        if english not in said:
            raise BadInput(
                f"{place}: no row has the text {begins}; copy the text of a row exactly, or remove this entry"
            )
    return [replace(row, says_id=part.tree.get(row.table.says, "")) for row in found]
