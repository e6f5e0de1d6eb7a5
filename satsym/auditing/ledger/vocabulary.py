"""The names that a ledger may use for derived quantities: those of the derivations it refers to, and its own."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator
from functools import cache
from typing import Any

from satsym import source_files
from satsym.formula.tree import Call, Formula, Sym, Text, cells, walk
from satsym.records import record, shelf
from satsym.status import BadInput
from satsym.wording import shown, suggestion

ADDRESS = re.compile(r"[A-Za-z][A-Za-z0-9_]*:[A-Za-z][A-Za-z0-9_]*\.[A-Za-z][A-Za-z0-9_.]*\Z")
_WITHIN = re.compile(r"(?<![A-Za-z0-9_])([a-z][a-z0-9_]{0,99}):[A-Za-z][A-Za-z0-9_]*\.[A-Za-z]")


def is_address(text: str) -> bool:
    """Return whether a text is an address, ``model:step.equation``."""
    return ADDRESS.match(text.strip()) is not None


def models_in(tree: Any) -> Iterator[str]:
    """Yield the models of all addresses in the tables of a ledger."""
    if isinstance(tree, str):
        yield from _WITHIN.findall(tree)
    elif isinstance(tree, dict | list):
        for part in tree.values() if isinstance(tree, dict) else tree:
            yield from models_in(part)


def names_of(model: str) -> Collection[str]:
    """Return the names that the derivation of a model defines; empty if there is no such derivation."""
    return shelf.find(model).names if shelf.path_of(model) else ()


def check(tree: Formula, own: Collection[str]) -> None:
    """Refuse unknown names and malformed addresses."""
    for cell in cells(tree):
        for _, part in walk(cell):
            if isinstance(part, Sym) and part.name not in own and part.name not in _shipped():
                hint = suggestion(part.name, sorted(own))
                raise BadInput(
                    f"no derivation defines the name {shown(part.name)}; {hint} (declare a symbol of your own in "
                    "[symbols])"
                )
            if isinstance(part, Call) and part.function == "at":
                (argument,) = part.arguments
                if not isinstance(argument, Text):
                    raise BadInput("at(...) takes an address in quotes, such as at('polar_orbit:first_order.r')")
                _check_address(argument.value)
            elif isinstance(part, Text) and part is cell:
                _check_address(part.value)


@cache
def _shipped() -> frozenset[str]:
    """Return the names of all shipped derivations; a scope may use them even if no row refers to the model."""
    return frozenset(name for model in source_files.models() for name in names_of(model))


def _check_address(address: str) -> None:
    if not is_address(address):
        raise BadInput(f"{shown(address)} is not an address; write model:step.equation")
    record.look_up(shelf.find(address.partition(":")[0]), address)
