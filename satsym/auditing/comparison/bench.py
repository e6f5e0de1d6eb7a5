"""Evaluation of the formulas of a row by two engines: names, addresses and printed rows are resolved for both."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, TypeAlias, TypeVar

from satsym.auditing.ledger import documents
from satsym.auditing.ledger.contents import Ledger, Row
from satsym.auditing.ledger.scopes import Scope, self_named
from satsym.formula.budget import Allowance, Limit, OverBudget
from satsym.formula.calculus import Calculus
from satsym.formula.field import Undecided
from satsym.formula.tree import Equality, Formula, Node, Sym, Text, each, grid, names_in, substituted, symbols, walk
from satsym.formula.values import Kernel, Matrix, Relation, Roots, Sources, Value
from satsym.formula.writing import written
from satsym.records import record, shelf
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas, library
from satsym.symbolic.lookup.library import Names, Sympy
from satsym.wording import printable, shown, suggestion

T = TypeVar("T")
Replacements: TypeAlias = Mapping[str, Formula]
"""Key of a row -> the formula that is used instead of the printed one, in the names of the models."""


class Refused(BadInput):
    """A row cannot be judged because of bad input or too much work; the message names the row."""


@dataclass(frozen=True)
class Both:
    """One value as computed by both engines, as a tree in a prime field and by SymPy."""

    trees: Value
    exact: Value

    @property
    def has_a_value(self) -> bool:
        """Whether no part of the value is divided by zero."""
        found = self.exact.of if isinstance(self.exact, Roots | Kernel) else self.exact
        if isinstance(found, Matrix):
            return all(map(formulas.has_a_value, found.entries))
        sides = (found.lhs, found.rhs) if isinstance(found, Relation) else (found,)
        return all(map(formulas.has_a_value, sides))


@dataclass(eq=False)
class Bench:
    """The context in which the rows of one ledger are judged."""

    ledger: Ledger

    def __post_init__(self) -> None:
        self.allowance = Allowance(counted=self.ledger.path not in documents.shipped())
        self.rows = {row.key: row for row in self.ledger.rows}
        self._meanings: dict[str, Mapping[str, Node]] = {}
        self._derived: dict[tuple[str, str], Both] = {}
        self._targets: dict[str, Both] = {}
        self._tellings: dict[str, str] = {}

    def within(self, limit: Limit, row: Row, work: Callable[[], T], where: str = "") -> T:
        """Return the result of some work for a row, done within a limit.

        Raises
        ------
        Refused
            If the work fails or exceeds the limit. The message names the row and `where`, the key of the row that is to
            blame; if the work depends on another row that is refused, it names that row.
        """
        try:
            return self.allowance.within(limit, work)
        except Refused:
            raise
        except (BadInput, Undecided) as error:
            why = str(error)
        except (RecursionError, MemoryError):
            why = "is nested too deep, or too large; split it into rows"
        raise Refused(f"{row.place}: row {printable(row.key)}: {f'{where}: ' if where else ''}{why}")

    def scope(self, row: Row) -> Scope:
        """Return the notation in which a row is printed."""
        return self.ledger.scopes[row.table.scope]

    @cached_property
    def names(self) -> Names:
        """Names that rows may use, with one symbol for each name in all rows."""
        own = dict.fromkeys(self_named(self.ledger.scopes), False)
        return library.names(self.ledger.models, own | {n: table.positive for n, table in self.ledger.symbols.items()})

    @cached_property
    def along_the_motion(self) -> Bench:
        """The context in which rates of states are functions of the states, as they are along every motion."""
        return _AlongTheMotion(self.ledger)

    @cached_property
    def dimensions(self) -> Any:
        """Dimensions of all names whose dimension is known."""
        return library.dimensions_of(
            self.ledger.models, {name: table.unit for name, table in self.ledger.symbols.items()}
        )

    def _rates(self) -> dict[str, str]:
        found: dict[str, str] = {}
        for model in self.ledger.models:
            found = {**record.rates(shelf.find(model)), **found}
        return found

    def plain_expression(self, formula: Node) -> Any:
        """Return a formula in the names of the models as a SymPy expression in which definitions keep their names.

        Raises
        ------
        NotAFormula
            If the formula contains addresses or matrices.
        """
        return library.from_tree(formula, lambda name: library.named(name, self.names))

    def target(self, row: Row) -> Both:
        """Return the derived quantity that a row is compared with."""
        formula = row.holds
        assert formula is not None
        if row.key not in self._targets:
            found = self._both(row, formula)
            if not found.has_a_value:
                raise BadInput("the expression in `holds` divides by zero")
            self._targets[row.key] = found
        return self._targets[row.key]

    def same_target(self, one: Row, other: Row) -> bool:
        """Return whether two rows are compared with the same quantity, even if their addresses differ."""
        if any(row.holds is None or row.printed is None for row in (one, other)):
            return False
        return one.table.holds == other.table.holds or bool(
            (shared := self._telling(one)) and shared == self._telling(other)
        )

    def _telling(self, row: Row) -> str:
        if row.key not in self._tellings:
            self._tellings[row.key] = self._told(row)
        return self._tellings[row.key]

    def _told(self, row: Row) -> str:
        """Return the target of a row as text if the text identifies the target, otherwise an empty text.

        The target of a general statement, whose symbols stand for whole derived quantities, is never identified by its
        text.
        """
        meanings = self.scope(row).meanings
        used = {name for name in names_in(row.printed) if name in meanings}
        if any(isinstance(part, Text) for name in used for _, part in walk(meanings[name])):
            return ""
        found = self.target(row)
        trees, exact = found.trees, found.exact
        if isinstance(trees, Relation) and isinstance(trees.lhs, Sym):
            trees, exact = trees.rhs, exact.rhs
        names = symbols(trees) if isinstance(trees, Node) else set()
        return str(exact) if len(names) > 1 else ""

    def follows(self, row: Row, replacements: Replacements | None = None) -> Both:
        """Return what a row should be according to the rows that it follows from."""
        formula = row.follows
        assert formula is not None
        return self._both(row, formula, theirs=True, replacements=replacements)

    def printed(self, row: Row, formula: Node) -> Both:
        """Return the value of a formula that is part of what a row prints."""
        return self._both(row, self.scope(row).ours(formula))

    def in_ours(self, row: Row) -> Formula:
        """Return the printed formula of a row in the names of the models."""
        assert row.printed is not None
        return each(row.printed, self.scope(row).ours)

    def meanings(self, row: Row) -> Mapping[str, Node]:
        """Return the meanings of the document's symbols as trees without addresses, leaving out matrices."""
        known = self._meanings.get(row.table.scope)
        if known is not None:
            return known
        found: dict[str, Node] = {}
        engine = self._engine(row, Calculus)
        for name, meaning in self.scope(row).meanings.items():
            try:
                value = engine.value(meaning)
            except OverBudget:
                raise
            except BadInput:
                continue
            if not isinstance(value, Matrix | Relation):
                found[name] = value
        self._meanings[row.table.scope] = found
        return found

    def theirs(self, row: Row, formula: Node) -> Node:
        """Return a formula with the models' names replaced by the document's symbols, preferring symbols of the row."""
        inside = names_in(row.printed)
        names: dict[str, Node] = {}
        meanings = self.meanings(row)
        for name in sorted(meanings, key=lambda name: name not in inside):
            meaning = meanings[name]
            if isinstance(meaning, Sym):
                names.setdefault(meaning.name, Sym(name))
        return substituted(formula, names)

    def solved(self, row: Row, relation: Both, name: str) -> Both | None:
        """Return an equation solved for a symbol in which it is linear, otherwise ``None``."""
        trees, exact = self.engines(row)
        if name not in symbols(relation.trees.lhs) | symbols(relation.trees.rhs):
            return None
        try:
            return Both(trees.solution(relation.trees, name), exact.solution(relation.exact, name))
        except OverBudget:
            raise
        except BadInput:
            return None

    def engines(self, row: Row) -> tuple[Calculus, Sympy]:
        """Return both engines that evaluate formulas in the names of the models: trees in a prime field, and SymPy."""
        return self._engine(row, Calculus), self._engine(row, Sympy)

    def unused(self) -> str:
        """Return a name that occurs in no formula."""
        taken = {*self.names.symbols, *(name for scope in self.ledger.scopes.values() for name in scope.meanings)}
        return next(name for name in ("s", *(f"s{i}" for i in range(1000))) if name not in taken)

    def _both(self, row: Row, formula: Node | Equality, **how: Any) -> Both:
        trees, exact = (self._engine(row, kind, **how).value(formula) for kind in (Calculus, Sympy))
        return Both(trees, exact)

    def _engine(self, row: Row, kind: type, theirs: bool = False, replacements: Replacements | None = None) -> Any:
        """Return an engine for evaluating formulas in the models' names, or with `theirs` in the document's symbols."""

        def name(text: str) -> Any:
            return (self._theirs if theirs else self._ours)(row, text, kind)

        def address(text: str) -> Any:
            found = self._at(row, text)
            return found.trees if kind is Calculus else found.exact

        def other(key: str) -> Any:
            return self.of_row(self.rows[key], kind, (replacements or {}).get(key))

        def symbol(text: str) -> str:
            return self._symbol_meant(row, text) if theirs else text

        sources: Sources[Any] = Sources(name, address, other, symbol, self._rates)
        return Calculus(sources, self.names.positive) if kind is Calculus else Sympy(sources)

    def _at(self, row: Row, address: str) -> Both:
        """Return the derived quantity at an address, with entries in the document's order; cached for each notation."""
        key = row.table.scope, address
        if key not in self._derived:
            found = library.at(address, self.names, lambda entries: self._order(row, entries))
            self._derived[key] = Both(library.in_trees(found), found)
        return self._derived[key]

    def _ours(self, row: Row, name: str, kind: type) -> Any:
        shared = self.names
        if name not in shared.symbols and name not in shared.definitions and name not in ("I", "pi"):
            raise BadInput(
                f"{shown(name)} is not a name of {' or '.join(self.ledger.models) or 'a derivation'}; "
                f"{suggestion(name, sorted(shared.symbols))} (declare a symbol of your own in [symbols])"
            )
        return shared.tree(name) if kind is Calculus else shared.expression(name)

    def _theirs(self, row: Row, name: str, kind: type) -> Any:
        meaning = self.scope(row).meanings.get(name)
        if meaning is None:
            return self._ours(row, name, kind)
        return self._engine(row, kind).value(meaning)

    def _symbol_meant(self, row: Row, name: str) -> str:
        """Return the model's symbol that a symbol of the document means."""
        meaning = self.scope(row).meanings.get(name, Sym(name))
        if not isinstance(meaning, Sym):
            raise BadInput(
                f"{shown(name)} means {written(meaning)}, but only a single symbol can be replaced or be the "
                "variable of differentiation"
            )
        return meaning.name

    def of_row(self, row: Row, kind: type = Sympy, instead: Formula | None = None) -> Any:
        """Return the value of what a row prints, or of a formula that replaces it, in the names of the models."""
        engine = self._engine(row, kind)
        formula = instead if instead is not None else self.in_ours(row)
        if isinstance(formula, tuple):
            return engine.value(grid(formula))
        if isinstance(formula, Equality) and isinstance(engine.value(formula.rhs), Matrix):
            return engine.value(formula.rhs)
        return engine.value(formula)

    def _order(self, row: Row, entries: tuple[str, ...]) -> tuple[int, ...]:
        """Return the positions of entries in the order of the document, if its notation orders all of them."""
        scope = self.scope(row)
        for listed in scope.orders.values():
            places = []
            for symbol in listed:
                inside = [name for name in entries if name in symbols(scope.meanings[symbol])]
                places += [entries.index(name) for name in inside] if len(inside) == 1 else []
            if sorted(places) == list(range(len(entries))):
                return tuple(places)
        return tuple(range(len(entries)))


class _AlongTheMotion(Bench):
    """The context in which names of rates, such as ``d_x``, stand for what the equations of motion say of them."""

    @cached_property
    def names(self) -> Names:
        """Names that rows may use; rates of states have definitions."""
        found = Bench(self.ledger).names
        rates = dict[str, Any]()
        for model in self.ledger.models:
            rates = library.rates_by_name(model, found) | rates
        return Names(found.symbols, rates | dict(found.definitions))
