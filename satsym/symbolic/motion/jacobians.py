"""Matrices of derivatives, entry by entry, confirmed by numeric differentiation."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import sympy as sp

from satsym.symbolic.checks import Point, compare, numeric, partial
from satsym.symbolic.derivation import Check, Equation


def jacobians(
    values: Sequence[sp.Expr],
    rows: Sequence[sp.Symbol],
    columns: Mapping[str, Sequence[sp.Symbol]],
    written: Callable[[sp.Expr], sp.Expr],
    at: Mapping[sp.Symbol, sp.Expr],
) -> tuple[tuple[Equation, ...], Check]:
    """Differentiate values, which the rows are named after, by the columns of each letter: ``A_row_column``.

    ``at`` is the point where that is done, as far as it is a special one; ``written`` simplifies an entry.
    """
    equations, pairs = [], []
    for letter, symbols in columns.items():
        for k, row in enumerate(rows):
            for column in symbols:
                name = f"{letter}_{row.name}_{column.name}"
                entry = written(sp.diff(values[k], column).xreplace(at))
                equations.append(Equation(name, sp.Symbol(name, real=True), entry))
                pairs.append((k, column))
    functions, entries = numeric(list(values)), numeric([e.rhs for e in equations])

    def sides(point: Point) -> tuple[list[Any], list[Any]]:
        there = {**point, **at}
        return entries(there), [partial(functions, there, column)[k] for k, column in pairs]

    moving = {column for symbols in columns.values() for column in symbols}
    return tuple(equations), compare("numeric derivative", moving.union(*(v.free_symbols for v in values)), sides)
