"""Scopes: the meanings of a document's symbols in the names of the models, for each part of the document."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import TypeAlias

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


Telling: TypeAlias = Callable[[str, str], AbstractContextManager[None]]
"""Context that adds table and key to the message of an error."""


def scopes(
    tables: Mapping[str, Mapping[str, object]], derived: Mapping[str, Node], telling: Telling
) -> dict[str, Scope]:
    """Return all scopes of a ledger, each including the scope that it extends."""
    found: dict[str, Scope] = {}

    def resolve(name: str, asking: tuple[str, ...]) -> Scope:
        if name not in found:
            base = tables[name].get("extends")
            below = None
            if base is not None:
                with telling(f"scope.{name}", "extends"):
                    if not isinstance(base, str) or base not in tables:
                        raise BadInput(f"there is no scope {shown(base)}; {suggestion(str(base), tables)}")
                    if base in (*asking, name):
                        circle = " -> ".join((*asking, name, base))
                        raise BadInput(f"the definition refers back to itself: {circle}")
                below = resolve(base, (*asking, name))
            found[name] = _scope(name, tables[name], below, derived, telling)
        return found[name]

    return {name: resolve(name, ()) for name in tables}


def _scope(
    name: str, table: Mapping[str, object], below: Scope | None, derived: Mapping[str, Node], telling: Telling
) -> Scope:
    meanings = dict(below.meanings) if below else {}
    orders = dict(below.orders) if below else {}
    for key, value in table.items():
        with telling(f"scope.{name}", key):
            if key == "extends":
                continue
            if key in LISTS:
                if not isinstance(value, list) or not all(isinstance(entry, str) for entry in value):
                    raise BadInput(f'got {shown(value)}; write a list of names, such as ["x1", "x2"]')
                orders[key] = tuple(value)
                continue
            if not isinstance(value, str):
                raise BadInput(f"got {shown(value)}; write the corresponding expression of the model in quotes")
            reading.checked_name(key)
            meanings[key] = Scales().checked(substituted(reading.expression(value, judging=True), derived))
            if any(call.function == "row" for call in calls_in(meanings[key])):
                raise BadInput("a notation cannot depend on a row")
    for key, entries in orders.items():
        for entry in entries:
            if entry not in meanings:
                with telling(f"scope.{name}", key):
                    raise BadInput(f"{shown(entry)} is not a symbol of this scope; {suggestion(entry, meanings)}")
    return Scope(name, meanings, orders)


def self_named(found: Mapping[str, Scope]) -> set[str]:
    """Return the symbols that a scope maps to themselves; no derivation needs to define them."""
    return {key for scope in found.values() for key, value in scope.meanings.items() if value == Sym(key)}


def _stem(name: str) -> str:
    return "".join("#" if character.isdigit() else character for character in name)
