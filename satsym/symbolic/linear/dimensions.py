"""Dimensions of what linear models bring: outputs, eigenvalues, weights, and matrices of them all."""

from __future__ import annotations

from typing import Any

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.dimension_algebra import (
    PLAIN,
    Dimension,
    Disagreement,
    Known,
    dimension_of,
    over,
    product,
    written,
)
from satsym.symbolic.linear import notation as ln
from satsym.symbolic.model import Model, Requirement, symbols_of

COST: Dimension = {"[cost]": sp.Integer(1)}
"""Of a running cost with weights of any unit: what is added to it must have the same."""


def declare(known: dict[str, Dimension | None], model: Model, require: Requirement) -> None:
    """Enter the dimensions of C and D, and refuse outputs that have others than their variables."""
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    for output in model.outputs:
        name = output.variable.symbol
        require(f"the output {name}", output.value, known[name])
        for letter, columns in (("C", states), ("D", controls)):
            for column in columns:
                known[f"{letter}_{name}_{column.name}"] = over(known[name], known[column.name])


def declare_results(known: dict[str, Dimension | None], model: Model) -> None:
    """Enter the dimensions of eigenvalues, and of weights, costates and Riccati solution for a quadratic cost."""
    states, controls = symbols_of(model.states), symbols_of(model.controls)
    second = known[n.TIME.name]
    for symbol in (ln.LAMBDA, ln.EIGENVALUES, ln.DISTINCT):
        known[symbol.name] = over(PLAIN, second)
    known[n.HAMILTONIAN.name] = COST
    total = product((COST, second))
    for state in states:
        known[n.costate_of(state).name] = over(total, known[state.name])
        known[n.rate_of(n.costate_of(state)).name] = over(COST, known[state.name])
    for letter, value, symbols in (("Q", COST, states), ("R", COST, controls), ("P", total, states)):
        for a in symbols:
            for b in symbols:
                known[ln.weight(letter, a, b).name] = over(over(value, known[a.name]), known[b.name])
    for a in states:
        for b in states:
            speeds = (known[n.rate_of(a).name], known[n.rate_of(b).name])
            known[ln.weight("S", a, b).name] = over(product(speeds), COST)


def require_matrix(matrix: sp.MatrixBase, known: Known) -> None:
    """Refuse a matrix that can map no quantities to quantities.

    Entry (i, j) of one that can has the dimension of the i-th result over that of the j-th argument. A small number
    in a Routh array takes the dimension of its place.

    Raises
    ------
    Disagreement
        If there are no such dimensions.
    """
    links: dict[tuple[str, int], list[tuple[tuple[str, int], Dimension]]] = {}
    for i in range(matrix.rows):
        for j in range(matrix.cols):
            found = _entry(matrix[i, j], known)
            if found is not None:
                links.setdefault(("row", i), []).append((("column", j), over(PLAIN, found) or PLAIN))
                links.setdefault(("column", j), []).append((("row", i), found))
    place: dict[tuple[str, int], Dimension] = {}
    for start in links:
        waiting = [] if start in place else [start]
        place.setdefault(start, PLAIN)
        while waiting:
            here = waiting.pop()
            for there, step in links[here]:
                reached = product((place[here], step)) or PLAIN
                if there not in place:
                    place[there] = reached
                    waiting.append(there)
                elif place[there] != reached:
                    raise Disagreement(f"has entries of dimensions {written(place[there])} and {written(reached)}")


def _entry(entry: Any, known: Known) -> Dimension | None:
    if any(s.name.startswith("epsilon_") for s in entry.free_symbols):
        return None
    return dimension_of(entry, known)
