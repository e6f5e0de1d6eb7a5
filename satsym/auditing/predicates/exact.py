"""Printed formulas as exact expressions, for predicates that compare them; no predicates here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, TypeAlias

from satsym.formula import reading
from satsym.formula.tree import Equality
from satsym.status import BadInput
from satsym.wording import shown, suggestion

Expression: TypeAlias = Any
"""An expression of sympy's, which no module of the audit imports by name."""


def expression(text: str) -> Expression:
    """A formula in the safe language, exact; of an equality the right-hand side, of which the other is the name."""
    from satsym.symbolic.lookup import formulas

    found = reading.statement(text)
    return formulas.from_tree(found.rhs if isinstance(found, Equality) else found, formulas.symbol)


def number(found: Expression, values: Mapping[str, float]) -> float:
    """The value of an expression.

    Raises
    ------
    BadInput
        If there is no number for one of its letters.
    """
    unknown = sorted(s.name for s in found.free_symbols if s.name not in values)
    if unknown:
        raise BadInput(f"no number for {shown(unknown[0])}; {suggestion(unknown[0], values)}")
    return float(found.xreplace({s: values[s.name] for s in found.free_symbols}))


def share(text: str) -> float:
    """A plain number that an argument is written as.

    Raises
    ------
    BadInput
        If it is none.
    """
    try:
        return float(text)
    except ValueError:
        raise BadInput(f"{shown(text)} is no number; write one such as '0.1'") from None


def letters(*found: Expression, needed: Sequence[str]) -> dict[str, Expression]:
    """The letters of expressions, by name.

    Raises
    ------
    BadInput
        If one that is needed stands in none of them.
    """
    place = {s.name: s for e in found for s in e.free_symbols}
    for name in needed:
        if name not in place:
            raise BadInput(f"the letter {shown(name)} does not stand there; {suggestion(name, place)}")
    return place


def matrix(rows: Sequence[str | Sequence[str]]) -> list[list[Expression]]:
    """A matrix; a row that is one text has its entries separated by commas.

    Raises
    ------
    BadInput
        If the rows differ in length.
    """
    texts = [row.split(",") if isinstance(row, str) else list(row) for row in rows]
    if not texts or len({len(row) for row in texts}) > 1:
        raise BadInput("the rows of a matrix differ in length")
    return [[expression(text) for text in row] for row in texts]


def same(one: Expression, other: Expression) -> bool:
    """Whether two expressions are equal for all values of their symbols, which go by their names."""
    from satsym.symbolic.lookup import formulas

    return formulas.is_zero(_by_name(one) - _by_name(other))


def same_entries(one: Sequence[Sequence[Expression]], other: Sequence[Sequence[Expression]]) -> bool:
    """Whether two matrices are equal."""
    return [len(row) for row in one] == [len(row) for row in other] and all(
        same(a, b) for row, line in zip(one, other, strict=True) for a, b in zip(row, line, strict=True)
    )


def product(one: Sequence[Sequence[Expression]], other: Sequence[Sequence[Expression]]) -> list[list[Expression]]:
    """A product of matrices."""
    columns = list(zip(*other, strict=True))
    return [[sum(a * b for a, b in zip(row, column, strict=True)) for column in columns] for row in one]


def written(rows: Sequence[Sequence[Expression]]) -> str:
    """A matrix for people."""
    return "[" + ", ".join(f"[{', '.join(map(str, row))}]" for row in rows) + "]"


def _by_name(found: Expression) -> Expression:
    from satsym.symbolic.lookup import formulas

    return found.xreplace({s: formulas.symbol(s.name) for s in found.free_symbols})
