"""Blocks as executable lines: each value computed once, invariants before the loop, unused lines dropped."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import sympy as sp

from satsym.codegen.block import Assignment, Block

LONGEST_NAME = 24


class Emitter:
    """Straight-line code under construction.

    Parameters
    ----------
    names
        Names already in use.
    invariant
        Symbols that do not change within the loop; what depends on nothing else goes to ``before``.
    """

    def __init__(self, names: Iterable[str], invariant: Iterable[sp.Symbol] = ()) -> None:
        self.names = set(names)
        self.invariant = set(invariant)
        self.before: list[Assignment] = []
        self.lines: list[Assignment] = []
        self._known: dict[sp.Expr, sp.Symbol] = {}

    def fresh(self, hint: str) -> sp.Symbol:
        """A symbol whose name is not in use: the hint, or the hint with a number."""
        name, count = hint, 2
        while name in self.names:
            name, count = f"{hint}_{count}", count + 1
        self.names.add(name)
        return sp.Symbol(name, real=True)

    def assign(self, expression: sp.Expr, hint: str = "") -> sp.Expr:
        """The symbol that holds the expression's value: an earlier one if it was computed before."""
        if not expression.args:
            return expression
        if expression not in self._known:
            symbol = self.fresh(hint or _name(expression))
            self._known[expression] = symbol
            if expression.free_symbols <= self.invariant:
                self.invariant.add(symbol)
                self.before.append((symbol, expression))
            else:
                self.lines.append((symbol, expression))
        return self._known[expression]

    def inline(self, block: Block, values: Mapping[sp.Symbol, sp.Expr], hints: Sequence[str] = ()) -> list[sp.Expr]:
        """Emit a block with the given values for its inputs; its outputs in terms of what is now known.

        ``hints`` are names for the outputs that the block assigns to a symbol.
        """
        value = dict(values)
        hint = {s: "" if s.name.startswith("_") else s.name for s, _ in block.assignments}
        hint |= {s: name for s, name in zip(block.outputs, hints, strict=False) if s in hint}
        for symbol, expression in block.assignments:
            value[symbol] = self.assign(expression.xreplace(value), hint[symbol])
        return [e.xreplace(value) for e in block.outputs]

    def take_lines(self) -> list[Assignment]:
        """Hand over the lines so far and forget what they computed: they run once, what follows often."""
        taken, self.lines = self.lines, []
        self._known = {e: s for e, s in self._known.items() if s in self.invariant}
        return taken


def live(lines: Sequence[Assignment], roots: Iterable[sp.Expr]) -> list[Assignment]:
    """The lines that the roots need."""
    needed = free_symbols(roots)
    kept = []
    for symbol, expression in reversed(lines):
        if symbol in needed:
            kept.append((symbol, expression))
            needed |= expression.free_symbols
    return kept[::-1]


def free_symbols(expressions: Iterable[sp.Expr]) -> set[sp.Symbol]:
    """Symbols that occur in any of the expressions."""
    return set().union(*(sp.sympify(e).free_symbols for e in expressions))


def _name(expression: sp.Expr) -> str:
    """A telling name for a simple expression, ``w`` for any other."""
    name = "w"
    if expression.is_Pow and expression.base.is_Symbol:
        base = expression.base.name
        names = {-1: f"inv_{base}", 2: f"{base}_sq", 3: f"{base}_cubed", sp.S.Half: f"sqrt_{base}"}
        name = names.get(expression.exp, "w")
    elif expression.is_Mul and all(a.is_Symbol for a in expression.args):
        name = "_".join(sorted(a.name for a in expression.args))
    elif expression.is_Mul and len(expression.args) == 2 and expression.args[1].is_Symbol:
        words = {sp.S.Half: "half", sp.Integer(2): "twice"}
        name = f"{words[expression.args[0]]}_{expression.args[1].name}" if expression.args[0] in words else "w"
    elif expression.is_Function and len(expression.args) == 1 and expression.args[0].is_Symbol:
        name = f"{expression.func.__name__}_{expression.args[0].name}"
    return name if len(name) <= LONGEST_NAME else "w"
