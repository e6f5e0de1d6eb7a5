"""Derived equations that rows are held against, typeset; kept between runs, for deriving takes its time."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import msgspec

from satsym import user_cache
from satsym.auditing import cache
from satsym.auditing.latex.writing import in_latex
from satsym.auditing.ledger.contents import Row, calls_in
from satsym.formula.tree import Equality, Text, grid
from satsym.formula.values import Matrix
from satsym.records import record, shelf
from satsym.report.latex import formula_tex

if TYPE_CHECKING:
    from satsym.symbolic import Derivation


class Derived(msgspec.Struct, frozen=True):
    """A derived thing: the title of its derivation, and its LaTeX."""

    title: str
    tex: str


def addresses(row: Row) -> list[str]:
    """Addresses of what a row is held against."""
    if isinstance(row.holds, Text):
        return [row.holds.value]
    named = [call.arguments[0] for call in calls_in(row.holds) if call.function == "at"]
    return list(dict.fromkeys(argument.value for argument in named if isinstance(argument, Text)))


def typeset(wanted: Iterable[str], announce: Callable[[str], None] = lambda _: None) -> dict[str, Derived]:
    """What addresses name, in their order."""
    path = user_cache.folder("audit") / f"derived-{cache.program((__name__,))}.json"
    try:
        known = msgspec.json.decode(user_cache.read(path), type=dict[str, Derived])
    except (ValueError, msgspec.MsgspecError):
        known = {}
    own = {address for address in wanted if not shelf.is_shipped(address.partition(":")[0])}
    found = {address: known.get(address) or _typeset(address, announce) for address in sorted({*wanted} - own)}
    if own:
        return dict(sorted((found | {address: _of_record(address) for address in own}).items()))
    if found.keys() - known.keys():
        user_cache.write(path, msgspec.json.encode(dict(sorted({**known, **found}.items()))))
    return found


def _typeset(address: str, announce: Callable[[str], None]) -> Derived:
    from satsym.symbolic.latex.typeset import Typesetter
    from satsym.symbolic.lookup import library

    name = address.partition(":")[0]
    announce(f"typesetting {name} ...")
    derivation = library.derivation(name)
    return Derived(derivation.title, _tex(derivation, address, Typesetter(derivation)))


def _of_record(address: str) -> Derived:
    """An equation of a model whose file is not executed."""
    record_ = shelf.find(address.partition(":")[0])
    write = in_latex({name: entry.latex for name, entry in record_.names.items() if entry.latex})
    found = record.look_up(record_, address)
    if isinstance(found, record.Equated):
        right = grid(found.rhs.rows) if isinstance(found.rhs, Matrix) else found.rhs
        return Derived(record_.title, write(Equality(found.lhs, right)))
    value = write(grid(found.entries) if isinstance(found, record.Family) else found)
    return Derived(record_.title, f"{formula_tex.symbol(address.rpartition('.')[2])} = {value}")


def _tex(derivation: Derivation, address: str, typesetter: Any) -> str:
    from satsym.symbolic.derivation import Equation
    from satsym.symbolic.lookup import addresses as naming

    found = naming.resolve(derivation, address)
    if isinstance(found, Equation):
        return f"{typesetter.tex(found.lhs)} = {typesetter.tex(found.rhs)}"
    name = address.rpartition(".")[2]
    value = typesetter.tex(found.matrix if isinstance(found, naming.Family) else found)
    return f"{formula_tex.symbol(name)} = {value}"
