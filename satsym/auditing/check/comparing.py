"""Comparison of printed formulas with those of a derivation: similar equations, matrices, equations at one time.

A printed equation is meant to be the derived one with which it shares most terms. A matrix is compared entry by entry
with the matrices of the same size. An equation at the initial or the final time only, such as ``x(t_f) = x_f``, is no
equation of motion.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import product
from typing import TYPE_CHECKING, Any

from satsym.auditing.check.answers import Verdict
from satsym.auditing.check.derived import Derived, Target, vanishes
from satsym.formula.angles import Complex, Monomial, TooManyTerms, over, terms_of
from satsym.formula.calculus import difference
from satsym.formula.tree import (
    ZERO,
    Call,
    Equality,
    Grid,
    Node,
    Sym,
    calls_in,
    cells,
    each,
    grid,
    lines,
    mapped,
    substituted,
    symbols,
)
from satsym.formula.values import Matrix
from satsym.records import record
from satsym.records.record import Equated, Family
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.auditing.check.answer import Subject

_MOST_SHIFTS = 24
_AT_THE_END = frozenset(map(Sym, ("t_f", "tf", "T", "t1", "t_1")))
_AT_THE_BEGINNING = frozenset((ZERO, Sym("t_0"), Sym("t0")))
_CONDITIONS = ":boundary_conditions."

Rows = tuple[tuple[Node, ...], ...]


@lru_cache(maxsize=20_000)
def terms(tree: Node) -> Mapping[Monomial, Complex]:
    """Return a formula as a sum of products, by monomial; empty if the sum has too many terms."""
    try:
        found = terms_of(tree).coefficients
    except (TooManyTerms, RecursionError):
        return {}
    # whole exponents as integers: these are added and compared many times quicker
    whole: Any = {key: tuple((n, p if p.denominator != 1 else p.numerator) for n, p in key) for key in found}
    return {whole[key]: value for key, value in found.items()}


def likeness(printed: Node, target: Node, least: float = 0.0) -> float:
    """Return the similarity of two residuals up to a common factor: about one if they agree, zero if nothing is shared.

    Zero is also returned if the numbers of terms and the letters show that the similarity is below `least`.
    """
    one, other = terms(printed), terms(target)
    if not one or not other:
        return 0.0
    mine, theirs = _letters(printed), _letters(target)
    letters = 0.2 * len(mine & theirs) / max(1, len(mine | theirs))
    if min(len(one), len(other)) / max(len(one), len(other)) + letters < least:
        return 0.0
    best = 0.0
    shifts: dict[tuple[Monomial, Fraction], None] = {}
    for a, b in product((a for a, (real, imaginary) in one.items() if real and not imaginary), other):
        shifts[over(a, b), other[b][0] / one[a][0]] = None
        if len(shifts) == _MOST_SHIFTS:
            break
    for shift, scale in shifts:
        shared = 0.0
        for a, (real, imaginary) in one.items():
            there = other.get(over(a, shift))
            if there is not None:
                same = there == (real * scale, imaginary * scale)
                shared += 1.0 if same else 0.6
        best = max(best, shared / max(len(one), len(other)))
    return best + letters


@lru_cache(maxsize=20_000)
def _letters(tree: Node) -> frozenset[str]:
    return frozenset(name for key in terms(tree) for name, _ in key)


@dataclass(frozen=True)
class AtOneTime:
    """An equation whose quantities are all taken at the initial time, or all at the final time."""

    equation: Equality
    """The equation with the time argument removed."""
    last: bool
    """Whether the equation holds at the final time; otherwise at the initial time."""

    def is_condition(self, target: Target) -> bool:
        """Return whether an equation of the derivation is a boundary condition, or the terminal cost."""
        return _CONDITIONS in target.address or (self.last and target.equation.lhs == Sym("S"))

    def holds_at_this_end(self, target: Target | None, states: tuple[str, ...]) -> bool:
        """Return whether an equation of the derivation holds at the initial or final time of the printed equation.

        The boundary conditions of the states hold at the initial time, all other boundary conditions at the final time.
        """
        if target is None or _CONDITIONS not in target.address:
            return target is None or target.always or self.last
        of = target.equation.lhs
        return (isinstance(of, Sym) and of.name in states) != self.last


def at_one_time(statement: Node | Equality) -> AtOneTime | None:
    """Return an equation about the initial or the final time only; ``None`` for any other equation."""
    taken = [call for call in calls_in(statement) if call.function == "value"]
    places = {call.arguments[1:] for call in taken}
    if not isinstance(statement, Equality) or len(places) != 1:
        return None
    (place,) = places
    if len(place) != 1 or place[0] not in _AT_THE_END | _AT_THE_BEGINNING:
        return None
    without = each(statement, lambda side: mapped(side, lambda part: ZERO if _of_value(part) else None))
    names = {name for call in taken for name in symbols(call.arguments[0])}
    if names & {name for side in cells(without) for name in symbols(side)}:
        return None
    bare = Equality(mapped(statement.lhs, _of_value), mapped(statement.rhs, _of_value))
    return AtOneTime(bare, place[0] in _AT_THE_END)


def _of_value(part: Node) -> Node | None:
    return part.arguments[0] if isinstance(part, Call) and part.function == "value" else None


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
    right = grid(theirs)
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
    rows = lines(side)
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
