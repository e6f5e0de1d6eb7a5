"""Comparison of printed matrices with the matrices of a derivation of the same size."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Literal

from satsym.auditing.check.derived import Derived, vanishes
from satsym.formula.calculus import difference
from satsym.formula.tree import Call, Equality, Grid, Node, Sym, substituted
from satsym.formula.values import Matrix
from satsym.records import record
from satsym.records.record import Equated, Family
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.auditing.check.answer import Subject

Verdict = Literal["right", "wrong", "undecided"]
Rows = tuple[tuple[Node, ...], ...]


def matrix_answer(
    statement: Node | Equality, meanings: Mapping[str, Node], derived: Derived, subject: Subject
) -> tuple[Verdict, str, str, Node | Equality | None]:
    """Return verdict, address, diagnosis and correct matrix for a printed matrix."""
    side, label = _printed(statement)
    rows = _rows(side)
    if rows is None:
        return "undecided", "", "vectors and matrices are compared entry by entry; print one matrix", None
    best: tuple[int, str, Rows, list[tuple[int, int]]] | None = None
    for address, entries in _matrices(derived, label):
        if (len(entries), len(entries[0])) != (len(rows), len(rows[0])):
            continue
        wrong = [
            (i, j)
            for i, row in enumerate(rows)
            for j, cell in enumerate(row)
            if not vanishes(difference(substituted(cell, meanings), entries[i][j]), derived)
        ]
        if best is None or len(wrong) < best[0]:
            best = len(wrong), address, entries, wrong
    size = f"{len(rows)} by {len(rows[0])}"
    if best is None:
        return "undecided", "", f"no matrix of {derived.record.name} is {size}", None
    count, address, entries, wrong = best
    if not count:
        return "right", address, "", None
    if 2 * count > len(rows) * len(rows[0]):
        return "undecided", "", f"no {size} matrix of {derived.record.name} resembles it", None
    names = {tree.name: Sym(name) for name, tree in meanings.items() if isinstance(tree, Sym)}
    theirs = [
        [substituted(entries[i][j], names) if (i, j) in wrong else cell for j, cell in enumerate(row)]
        for i, row in enumerate(rows)
    ]
    right = Grid(tuple(Grid(tuple(row)) for row in theirs))
    write = subject.writer(subject.latex)
    said = "; ".join(f"entry ({i + 1}, {j + 1}): {write(rows[i][j])} should be {write(theirs[i][j])}" for i, j in wrong)
    correct = Equality(statement.lhs, right) if isinstance(statement, Equality) and statement.rhs == side else right
    return "wrong", address, said, correct


def _printed(statement: Node | Equality) -> tuple[Node, str]:
    if not isinstance(statement, Equality):
        return statement, ""
    for side, other in ((statement.rhs, statement.lhs), (statement.lhs, statement.rhs)):
        if _rows(side) is not None:
            return side, other.name if isinstance(other, Sym) else ""
    return statement.rhs, ""


def _rows(side: Node) -> Rows | None:
    """Return the rows of a matrix, where a bracket with commas is a column; ``None`` if the tree is no matrix."""
    if isinstance(side, Call) and side.function == "transpose":
        inner = _rows(side.arguments[0])
        return tuple(zip(*inner, strict=True)) if inner else None
    if not isinstance(side, Grid):
        return None
    rows = [entry.entries if isinstance(entry, Grid) else (entry,) for entry in side.entries]
    return tuple(rows) if len({len(row) for row in rows}) == 1 else None


def _matrices(derived: Derived, label: str) -> Iterator[tuple[str, Rows]]:
    """Yield address and entries of each matrix of the derivation, those with the printed name first."""
    places = []
    for step in derived.record.steps:
        places += [f"{step.name}.{equation.name}" for equation in step.equations if isinstance(equation.rhs, list)]
        families = dict.fromkeys(equation.name.partition("_")[0] for equation in step.equations)
        places += [f"{step.name}.{family}" for family in families]
    places += [f"{record.DECLARED}.{name}" for name in derived.record.declared]
    found: list[tuple[str, Rows]] = []
    for address in (f"{derived.record.name}:{place}" for place in places):
        try:
            value = record.look_up(derived.record, address)
        except BadInput:
            continue
        if isinstance(value, Family):
            found.append((address, value.entries))
        elif isinstance(value, Equated) and isinstance(value.rhs, Matrix):
            found.append((address, value.rhs.rows))
    yield from sorted(found, key=lambda entry: entry[0].rpartition(".")[2] != label)
