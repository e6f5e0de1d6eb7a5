"""Expression graphs as lines of assignments: invariants extracted, powers made cheap, repeated parts shared."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp

from satsym.codegen.printers import LARGEST_PRODUCT
from satsym.symbolic.functions.minimisers import MINIMISERS, Side

Assignment = tuple[sp.Symbol, sp.Expr]


@dataclass(frozen=True)
class Block:
    """Assignments in an executable order, and the expressions of their outputs.

    The symbols assigned to are internal: whoever emits the block renames them.
    """

    assignments: tuple[Assignment, ...]
    outputs: tuple[sp.Expr, ...]

    @property
    def inputs(self) -> set[sp.Symbol]:
        """Return the symbols that the block reads and does not assign."""
        read = set().union(*(e.free_symbols for _, e in self.assignments), *(e.free_symbols for e in self.outputs))
        return read - {s for s, _ in self.assignments}


def build(
    outputs: Sequence[sp.Expr],
    definitions: Sequence[Assignment],
    layers: Sequence[Iterable[sp.Symbol]],
    chain: Sequence[Assignment] = (),
) -> Block:
    """Turn expressions into a block.

    Parameters
    ----------
    definitions
        Named constants that the outputs may use; those they do not use are left out.
    layers
        Sets of symbols, innermost invariants first. What depends only on a layer is computed by itself, so
        that it can leave the loop, or be shared by stages that differ only in other symbols.
    chain
        Named parts of the outputs that move, each in terms of those before; those not used are left out.
    """
    chain = [(s, printable(e)) for s, e in used(chain, outputs)]
    assignments: list[Assignment] = list(definitions)
    current = [printable(sp.sympify(e)) for e in outputs]
    inner = {s for s, _ in definitions}
    for layer in layers:
        inner |= set(layer)
        extraction = _Extraction(inner, prefix=f"_layer{len(assignments)}_")
        current = [extraction.apply(e) for e in current]
        chain = [(s, extraction.apply(e)) for s, e in chain]
        assignments += extraction.assignments
        inner |= {s for s, _ in extraction.assignments}
    assignments += chain
    cheap = _Cheapened()
    assignments = [(s, cheap.apply(e)) for s, e in assignments]
    current = [cheap.apply(e) for e in current]
    assignments += cheap.assignments
    return _ordered(*_shared(assignments, current))


def printable(expression: sp.Expr) -> sp.Expr:
    """Remove sign functions from an expression, which are the limit of a strip of zero width."""
    return expression.replace(sp.sign, lambda value: Side(value, sp.Integer(0)))


def used(chain: Sequence[Assignment], outputs: Iterable[sp.Expr]) -> list[Assignment]:
    """Return the parts that the outputs need, in order."""
    wanted, kept = set().union(*(sp.sympify(e).free_symbols for e in outputs)), []
    for symbol, value in reversed(chain):
        if symbol in wanted:
            wanted |= value.free_symbols
            kept.append((symbol, value))
    return kept[::-1]


class _Extraction:
    """Extracts the largest compound parts that use no symbol outside a set."""

    def __init__(self, allowed: set[sp.Symbol], prefix: str) -> None:
        self.allowed, self.prefix = allowed, prefix
        self.assignments: list[Assignment] = []
        self.known: dict[sp.Expr, sp.Symbol] = {}

    def apply(self, expression: sp.Expr) -> sp.Expr:
        if self._invariant(expression):
            return self._take(expression)
        if not isinstance(expression, sp.Add | sp.Mul):
            return expression.func(*(self.apply(a) for a in expression.args)) if expression.args else expression
        inside = expression.func(*(a for a in expression.args if self._invariant(a)))
        outside = (self.apply(a) for a in expression.args if not self._invariant(a))
        return expression.func(self._take(inside), *outside)

    def _invariant(self, expression: sp.Expr) -> bool:
        return expression.free_symbols <= self.allowed

    def _take(self, part: sp.Expr) -> sp.Expr:
        if not part.args or not part.free_symbols:
            return part
        if _negative(part):  # so that what uses it subtracts, instead of adding what was negated
            return -self._take(-part)
        if part not in self.known:
            self.known[part] = sp.Symbol(f"{self.prefix}{len(self.known)}", real=True)
            self.assignments.append((self.known[part], part))
        return self.known[part]


def _negative(expression: sp.Expr) -> bool:
    """Tell whether every term of an expression has a minus sign."""
    return all(term.as_coeff_Mul()[0].is_negative for term in sp.Add.make_args(expression))


class _Cheapened:
    """Rewrites expressions that are expensive or awkward to print.

    Powers become products, one division and one root a base; projections get names for their arguments and for
    themselves, so that they print as one conditional.
    """

    def __init__(self) -> None:
        self.assignments: list[Assignment] = []
        self.known: dict[sp.Expr, sp.Symbol] = {}

    def apply(self, expression: sp.Expr) -> sp.Expr:
        if not expression.args:
            return expression
        args = [self.apply(a) for a in expression.args]
        if isinstance(expression, sp.Abs):
            return self._take(sp.Abs(self._of_either_sign(args[0])))
        if isinstance(expression, MINIMISERS):
            return self._take(expression.func(*(a if a.is_Symbol else self._take(a) for a in args)))
        if not expression.is_Pow:
            return expression.func(*args)
        base, exponent = args
        if not (exponent.is_Rational and exponent.q in (1, 2)):
            return base**exponent
        base = base if base.is_Symbol else self._take(base)
        if exponent.q == 2:
            base = self._take(sp.sqrt(base))
        if exponent < 0:
            base = self._take(1 / base)
        return self._power(base, abs(exponent.p))

    def _power(self, base: sp.Expr, exponent: int) -> sp.Expr:
        """Write a high power by a named square, since ``**`` would call pow, also in compiled code."""
        if exponent <= LARGEST_PRODUCT or base.is_Number:
            return base**exponent
        return self._power(self._take(base**2), exponent // 2) * base ** (exponent % 2)

    def _of_either_sign(self, part: sp.Expr) -> sp.Expr:
        """Return a symbol without assumptions in place of one whose sign would matter."""
        if part.is_Symbol and not part.name.startswith("_cheap"):
            return part
        symbol = sp.Symbol(f"_signed{len(self.assignments)}", real=True)
        self.assignments.append((symbol, part))
        return symbol

    def _take(self, part: sp.Expr) -> sp.Expr:
        if part.is_Number:
            return part
        if part not in self.known:
            self.known[part] = sp.Symbol(f"_cheap{len(self.known)}", positive=True)
            self.assignments.append((self.known[part], part))
        return self.known[part]


def _shared(assignments: list[Assignment], outputs: list[sp.Expr]) -> tuple[list[Assignment], list[sp.Expr]]:
    """Give parts that occur more than once a name."""
    names = sp.utilities.numbered_symbols("_shared", real=True)
    repeats, reduced = sp.cse([e for _, e in assignments] + outputs, symbols=names, order="canonical")
    kept = [(s, e) for (s, _), e in zip(assignments, reduced, strict=False)]
    return list(repeats) + kept, reduced[len(assignments) :]


def _ordered(assignments: list[Assignment], outputs: list[sp.Expr]) -> Block:
    """Return only the assignments that the outputs need, each before its first use."""
    value = dict(assignments)
    done: dict[sp.Symbol, sp.Expr] = {}

    def need(expression: sp.Expr) -> None:
        for symbol in sorted(expression.free_symbols, key=lambda s: s.name):
            if symbol in value and symbol not in done:
                need(value[symbol])
                done[symbol] = value[symbol]

    for output in outputs:
        need(output)
    return Block(tuple(done.items()), tuple(outputs))


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
        """Return a symbol whose name is not in use: the hint, or the hint with a number."""
        name, count = hint, 2
        while name in self.names:
            name, count = f"{hint}_{count}", count + 1
        self.names.add(name)
        return sp.Symbol(name, real=True)

    def assign(self, expression: sp.Expr, hint: str = "") -> sp.Expr:
        """Return the symbol that holds the expression's value: an earlier one if it was computed before."""
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
        """Emit a block with the given values of its inputs, and return its outputs.

        ``hints`` are names for the outputs that the block assigns to a symbol.
        """
        value = dict(values)
        hint = {s: "" if s.name.startswith("_") else s.name for s, _ in block.assignments}
        hint |= {s: name for s, name in zip(block.outputs, hints, strict=False) if s in hint}
        for symbol, expression in block.assignments:
            value[symbol] = self.assign(expression.xreplace(value), hint[symbol])
        return [e.xreplace(value) for e in block.outputs]

    def take_lines(self) -> list[Assignment]:
        """Return the lines so far and forget their values: they run once, the following lines often."""
        taken, self.lines = self.lines, []
        self._known = {e: s for e, s in self._known.items() if s in self.invariant}
        return taken


def live(lines: Sequence[Assignment], roots: Iterable[sp.Expr]) -> list[Assignment]:
    """Return the lines that the roots need."""
    needed = free_symbols(roots)
    kept = []
    for symbol, expression in reversed(lines):
        if symbol in needed:
            kept.append((symbol, expression))
            needed |= expression.free_symbols
    return kept[::-1]


def free_symbols(expressions: Iterable[sp.Expr]) -> set[sp.Symbol]:
    """Return the symbols that occur in any of the expressions."""
    return set().union(*(sp.sympify(e).free_symbols for e in expressions))


def _name(expression: sp.Expr) -> str:
    """Return a telling name for a simple expression, and ``w`` for any other."""
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
