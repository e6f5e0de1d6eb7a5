"""Motions whose equations are a chain of named parts; they are differentiated and solved part by part, not expanded.

Written in one piece, the accelerations of bodies in gimbals have some million operations; along the chain, some
hundreds, and their derivatives some thousands.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any, TypeAlias

import sympy as sp

from satsym.symbolic import notation as n
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.model import symbols_of

Assignment: TypeAlias = "tuple[sp.Symbol, sp.Expr]"


class Chain:
    """Named parts of expressions, in an order in which each part uses only those before it.

    Parameters
    ----------
    parts
        What it begins with.
    """

    def __init__(self, parts: Iterable[Assignment] = ()) -> None:
        self.parts: list[Assignment] = list(parts)

    def named(self, name: str, value: sp.Expr) -> sp.Expr:
        """Give a value a name, unless it is a number or has a name already, and return its symbol."""
        if not value.args:
            return value
        self.parts.append((sp.Symbol(name, real=True), value))
        return self.parts[-1][0]

    def derivatives(self, by: sp.Symbol) -> dict[sp.Symbol, sp.Expr]:
        """Return the total derivatives of the parts by a variable, by the chain rule; zero ones are left out."""
        found = {by: sp.Integer(1)}
        for symbol, value in tuple(self.parts):
            slope = along(value, found)
            if slope != 0:
                found[symbol] = self.named(f"d_{symbol.name}_by_{by.name}", slope)
        return found


def named_parts(
    parts: Iterable[Assignment], values: Iterable[sp.Expr], named: Callable[[int], sp.Symbol]
) -> tuple[list[Assignment], list[sp.Expr]]:
    """Return the parts without those that only negate another symbol, numbered anew."""
    said: dict[sp.Symbol, sp.Expr] = {}
    kept: list[Assignment] = []
    for symbol, value in parts:
        shown = value.xreplace(said)
        if (-shown).is_Symbol:
            said[symbol] = shown
        else:
            said[symbol] = named(len(kept) + 1)
            kept.append((said[symbol], shown))
    return kept, [value.xreplace(said) for value in values]


def along(value: sp.Expr, slopes: Mapping[sp.Symbol, sp.Expr]) -> sp.Expr:
    """Return the derivative of a value whose symbols have the given derivatives."""
    found = sorted((s for s in value.free_symbols if s in slopes), key=lambda s: s.name)
    return sp.Add(*(_partial(value, s) * slopes[s] for s in found))


@lru_cache(maxsize=4096)  # asked again for each symbol by which a whole chain is differentiated
def _partial(value: sp.Expr, by: sp.Symbol) -> sp.Expr:
    return sp.diff(value, by)


class Elimination:
    """A symmetric matrix factored as L D L', with the order of rows that fills in least, for solving systems."""

    def __init__(self, chain: Chain, matrix: sp.MatrixBase) -> None:
        rest = sp.Matrix(matrix)
        self.order: list[int] = []
        self.pivots: dict[int, sp.Expr] = {}
        self.factors: dict[int, dict[int, sp.Expr]] = {}
        left = list(range(rest.rows))
        while left:
            pivot = min(left, key=lambda i: (sum(rest[i, k] != 0 for k in left), sp.count_ops(rest[i, i]), i))
            left.remove(pivot)
            self.order.append(pivot)
            self.pivots[pivot] = chain.named(f"pivot_{pivot}", rest[pivot, pivot])
            filled = [i for i in left if rest[i, pivot] != 0]
            column = {i: chain.named(f"factor_{i}_{pivot}", rest[i, pivot] / self.pivots[pivot]) for i in filled}
            self.factors[pivot] = column
            for k, i in enumerate(filled):
                for j in filled[k:]:
                    value = chain.named(f"rest_{pivot}_{i}_{j}", rest[i, j] - column[i] * rest[j, pivot])
                    rest[i, j] = rest[j, i] = value

    def solve(self, chain: Chain, right: Sequence[sp.Expr], name: str) -> list[sp.Expr]:
        """Solve the system for one right-hand side; the parts of the solution have names with the given beginning."""
        values = list(right)
        for pivot in self.order:
            if values[pivot] == 0:
                continue
            values[pivot] = chain.named(f"{name}_right_{pivot}", values[pivot])
            for i, factor in self.factors[pivot].items():
                values[i] -= factor * values[pivot]
        for pivot in reversed(self.order):
            back = sp.Add(*(factor * values[i] for i, factor in self.factors[pivot].items()))
            values[pivot] = chain.named(f"{name}_{pivot}", values[pivot] / self.pivots[pivot] - back)
        return values


@lru_cache(maxsize=8)
def _solved(parts: tuple[Assignment, ...], mass: sp.ImmutableMatrix, load: sp.ImmutableMatrix) -> Any:
    chain = Chain(parts)
    elimination = Elimination(chain, mass)
    return elimination, elimination.solve(chain, list(load), "acceleration"), tuple(chain.parts)


def parts_of(derivation: Derivation) -> tuple[Assignment, ...]:
    """Return the chain behind the first-order form: named functions, parts and accelerations.

    It is empty where the form is closed.
    """
    if "kane" not in derivation or not any(n.is_solved(e) for e in derivation.rhs("first_order")):
        return ()
    symbols = [e.rhs for e in derivation.step("first_order").equations if n.is_solved(e.rhs)]
    _, solution, parts = _solved(*_system(derivation))
    return (*parts, *zip(symbols, solution, strict=True))


def jacobians(derivation: Derivation) -> tuple[tuple[Assignment, ...], sp.Matrix, sp.Matrix]:
    """Return the derivatives of the first-order form by states and controls: the chain for them, and both matrices.

    The derivatives w of the accelerations a solve M w = d(Q - b) - dM a, with the same factors of M.
    """
    parts, mass, load = _system(derivation)
    elimination, solution, _ = _solved(parts, mass, load)
    whole, rates = Chain(parts_of(derivation)), derivation.rhs("first_order")
    accelerations = [e for e in rates if n.is_solved(e)]
    columns = []
    for by in (*symbols_of(derivation.model.states), *symbols_of(derivation.model.controls)):
        chain = Chain(parts)
        slopes = chain.derivatives(by)
        change = mass.applyfunc(lambda e, slopes=slopes: along(e, slopes)) * sp.Matrix(solution)
        right = load.applyfunc(lambda e, slopes=slopes: along(e, slopes)) - change
        whole.parts += chain.parts[len(parts) :]
        found = elimination.solve(whole, list(right), f"slope_{by.name}")
        known = slopes | dict(zip(accelerations, found, strict=True))
        columns.append(sp.Matrix([along(e, known) for e in rates]))
    m = len(derivation.model.states)
    empty = sp.zeros(len(rates), 0)
    return tuple(whole.parts), sp.Matrix.hstack(*columns[:m]), sp.Matrix.hstack(empty, *columns[m:])


def _system(derivation: Derivation) -> tuple[tuple[Assignment, ...], sp.ImmutableMatrix, sp.ImmutableMatrix]:
    """Return the named parts, the mass matrix, and the right-hand side of M a = Q - b."""
    named = [(e.lhs, e.rhs) for e in derivation.step("kinematics").equations if e.lhs.name == e.name]
    known = {e.name: e.rhs for e in derivation.step("kane").equations}
    parts = [(e.lhs, e.rhs) for e in derivation.step("kane").equations if e.name.startswith("part_")]
    size = sum(name.startswith("force_") for name in known)
    chain = Chain((*named, *parts))
    entries = {
        (i, k): chain.named(f"mass_{i}_{k}", known.get(f"mass_{i}_{k}", sp.Integer(0)))
        for i in range(1, size + 1)
        for k in range(1, i + 1)
    }
    mass = sp.ImmutableMatrix(size, size, lambda i, k: entries[max(i, k) + 1, min(i, k) + 1])
    load = sp.ImmutableMatrix([known[f"force_{i}"] - known[f"bias_{i}"] for i in range(1, size + 1)])
    return tuple(chain.parts), mass, load
