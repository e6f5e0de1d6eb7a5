"""Scopes: the meanings of a document's symbols in the names of the models, for each part of the document."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from satsym.formula import reading
from satsym.formula.tree import Node, Sym, calls_in, substituted
from satsym.formula.weight import Scales
from satsym.status import BadInput
from satsym.wording import shown, suggestion

LISTS = ("states", "controls", "outputs")
"""Keys of a scope that state the order in which the document numbers states, controls and outputs."""
CONSTANTS = frozenset({"I", "pi"})
"""Names with the same meaning everywhere: the imaginary unit and the number pi."""


@dataclass(frozen=True)
class Scope:
    """The notation of a part of a document."""

    name: str
    """Name of the scope in the ledger."""
    meanings: Mapping[str, Node]
    """Symbol of the document -> its meaning, an expression in the names of the models."""
    orders: Mapping[str, tuple[str, ...]]
    """``states``, ``controls``, ``outputs`` -> symbols in the order of the document, as far as the ledger states it."""

    def knows(self, name: str) -> bool:
        """Return whether a printed formula may contain a name."""
        return name in self.meanings or name in CONSTANTS

    def ours(self, printed: Node) -> Node:
        """Return a printed formula in the names of the models."""
        return Scales().checked(substituted(printed, self.meanings))

    def family(self, name: str) -> list[str]:
        """Return all other symbols; first those that differ only by the index, as ``x1`` and ``x2``."""
        stem = _stem(name)
        others = [symbol for symbol in self.meanings if symbol != name]
        return sorted(others, key=lambda symbol: (_stem(symbol) != stem, others.index(symbol)))

    def is_slip(self, one: str, other: str) -> bool:
        """Return whether two symbols differ only by an index."""
        return _stem(one) == _stem(other)


class WrongScope(BadInput):
    """A scope cannot be read; ``scope`` and ``key`` are the names of the table and of the key."""

    def __init__(self, scope: str, key: str, message: str) -> None:
        super().__init__(f"[scope.{scope}] {key}: {message}" if key else f"[scope.{scope}]: {message}")
        self.scope, self.key = scope, key


def scopes(tables: Mapping[str, Mapping[str, object]], derived: Mapping[str, Node]) -> dict[str, Scope]:
    """Return all scopes of a ledger, each including the scope that it extends."""
    found: dict[str, Scope] = {}

    def resolve(name: str, asking: tuple[str, ...]) -> Scope:
        if name in asking:
            raise WrongScope(
                asking[-1], "extends", f"the definition refers back to itself: {' -> '.join((*asking, name))}"
            )
        if name not in found:
            base = tables[name].get("extends")
            below = None
            if base is not None:
                if not isinstance(base, str) or base not in tables:
                    raise WrongScope(
                        name, "extends", f"there is no scope {shown(base)}; {suggestion(str(base), tables)}"
                    )
                below = resolve(base, (*asking, name))
            found[name] = _scope(name, tables[name], below, derived)
        return found[name]

    return {name: resolve(name, ()) for name in tables}


def _scope(name: str, table: Mapping[str, object], below: Scope | None, derived: Mapping[str, Node]) -> Scope:
    meanings = dict(below.meanings) if below else {}
    orders = dict(below.orders) if below else {}
    for key, value in table.items():
        if key == "extends":
            continue
        if key in LISTS:
            if not isinstance(value, list) or not all(isinstance(entry, str) for entry in value):
                raise WrongScope(name, key, f'got {shown(value)}; write a list of names, such as ["x1", "x2"]')
            orders[key] = tuple(value)
            continue
        if not isinstance(value, str):
            raise WrongScope(
                name, key, f"got {shown(value)}; write the corresponding expression of the model in quotes"
            )
        try:
            reading.checked_name(key)
            meanings[key] = Scales().checked(substituted(reading.expression(value, judging=True), derived))
        except BadInput as error:
            raise WrongScope(name, key, str(error)) from None
        if any(call.function == "row" for call in calls_in(meanings[key])):
            raise WrongScope(name, key, "a notation cannot depend on a row")
    for key, entries in orders.items():
        for entry in entries:
            if entry not in meanings:
                hint = suggestion(entry, meanings)
                raise WrongScope(name, key, f"{shown(entry)} is not a symbol of this scope; {hint}")
    return Scope(name, meanings, orders)


def self_named(found: Mapping[str, Scope]) -> set[str]:
    """Return the symbols that a scope maps to themselves; no derivation needs to define them."""
    return {key for scope in found.values() for key, value in scope.meanings.items() if value == Sym(key)}


def _stem(name: str) -> str:
    return "".join("#" if character.isdigit() else character for character in name)
