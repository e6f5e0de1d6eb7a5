"""A printer of LaTeX that orders and shapes sums, products and fractions as a person would.

Factors and terms stand in the order of declaration, never in one of spelling or hashing, and a sum does not begin
with a minus where it can help it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import IntEnum
from typing import Any

import sympy as sp

from satsym.symbolic.functions.pieces import Until
from satsym.symbolic.latex.laws import LawPrinter
from satsym.symbolic.latex.products import (
    Piece,
    Product,
    Term,
    base,
    decimal,
    exponent,
    is_negative,
    is_power_of_sum,
    joined,
    spread,
    take_apart,
    turned_round,
    whole_term,
    with_plus_first,
)
from satsym.symbolic.latex.rewriting import rewritten

ELEMENTARY = frozenset("sin cos tan cot sec csc sinh cosh tanh log".split())
"""Functions that are printed without parentheses around a single symbol."""

CHOSEN = frozenset("Shorten Stretch Within Clip Max Min".split())
"""Functions whose print is too tall for a fraction."""


class Kind(IntEnum):
    """The kinds of factors; products are written in the order of this list."""

    NUMBER = 0
    CONSTANT = 1
    COSTATE = 2
    MOTION = 3
    ACCELERATION = 4
    CONTROL = 5
    OTHER = 6
    SUM = 7
    FUNCTION = 8
    DIRECTION = 9


class Printer(LawPrinter):
    """A LaTeX printer of sympy that arranges sums, products and powers in the order of declaration.

    Parameters
    ----------
    notation
        Name of a symbol -> its LaTeX.
    ranks
        Name of a symbol -> its kind, and its place in the order of declaration.
    comma
        Whether decimal numbers have a comma.
    """

    def __init__(self, notation: Mapping[str, str], ranks: Mapping[str, tuple[Kind, int]], comma: bool = False) -> None:
        super().__init__(notation.values(), comma)
        self._notation, self._ranks = notation, ranks

    def symbol(self, name: str) -> str:
        """Return the LaTeX of a name; names without an entry in the notation are set upright."""
        known = self._notation.get(name)
        return rf"\mathrm{{{_escaped(name)}}}" if known is None else known

    def slashed(self, expression: Any) -> str:
        """Print an expression within a sentence, whose lines are too low for built-up fractions."""
        with self._inside():
            return self.doprint(expression)

    # sums

    def normalised(self, expression: sp.Expr) -> sp.Expr:
        """Make the first term of a sum positive where the sum is below a fraction line or has an even power."""
        return rewritten(expression, is_power_of_sum, self._turned)

    def _turned(self, power: sp.Expr) -> sp.Expr:
        root, exponent = power.as_base_exp()
        first = min(root.args, key=self._summand_order)
        if not is_negative(first):
            return power
        return sp.Integer(-1) ** exponent * sp.Pow(-root, exponent)

    def terms(self, expression: sp.Expr, *, plus_first: bool = True) -> list[Term]:
        """Return the terms of a sum in the order of print."""
        parts = (part for summand in sp.Add.make_args(expression) for part in sp.Add.make_args(spread(summand)))
        summands = sorted(parts, key=self._summand_order)
        if plus_first:
            summands = with_plus_first(summands)
        alone = len(summands) == 1
        return [
            self._term(s, alone=alone) if len(rest) == 0 else self._halves([s, *rest])
            for s, *rest in self._alike(summands)
        ]

    def _print_Add(self, expr: sp.Add, order: Any = None) -> str:
        return joined(self.terms(expr))

    def _backwards(self, factors: Sequence[sp.Expr]) -> list[int]:
        """Return the sums, such as b - a, that begin so only to put a plus first, and the other sums after them."""
        like: list[int] = []
        others: list[int] = []
        for k, factor in enumerate(factors):
            first, *rest = sorted(factor.args, key=self._summand_order) if factor.is_Add else (factor,)
            plus = [s for s in rest if not is_negative(s)]
            if plus and is_negative(first):
                (like if self._form(plus[0]) == self._form(first) else others).append(k)
        return [*like, *others] if like else []

    def _form(self, summand: sp.Expr) -> tuple[Any, ...]:
        """Return the properties of a summand that decide its place, whichever symbols of a kind it has."""
        return self._summand_order(summand)[:-2]

    def _alike(self, summands: Sequence[sp.Expr]) -> list[list[sp.Expr]]:
        """Group summands over the same whole number, unless their costates differ."""
        groups: dict[Any, list[sp.Expr]] = {}
        for place, summand in enumerate(summands):
            parts = take_apart(summand)
            alone = self._small or parts.number_below == 1 or parts.bottom or not parts.top
            alone = alone or self._has_costates(summand)
            groups.setdefault(("alone", place) if alone else ("over", parts.number_below), []).append(summand)
        return list(groups.values())

    def _has_costates(self, expression: sp.Expr) -> bool:
        return any(self._rank(s)[0] is Kind.COSTATE for s in expression.free_symbols)

    def _halves(self, summands: Sequence[sp.Expr]) -> Term:
        """Write summands over the same whole number as one term."""
        below = take_apart(summands[0]).number_below
        negative = all(map(is_negative, summands))
        inner = sp.Add(*((-below if negative else below) * s for s in summands))
        return self._with_sum(negative, rf"\tfrac{{1}}{{{below}}}", inner, "")

    def _summand_order(self, summand: sp.Expr) -> tuple[Any, ...]:
        """Return the sorting key of a summand: fewer costates first, controls and fractions last."""
        parts = take_apart(summand)
        ranked = [(*self._rank(base(f)), exponent(f)) for f in parts.top]
        inside = {self._rank(s)[0] for s in summand.free_symbols}
        squares = [exponent(f) for f in parts.top if base(f).is_Add and self._has_costates(base(f))]
        return (
            sum((power for kind, _, power in ranked if kind is Kind.COSTATE), sum(squares, sp.Integer(0))),
            [place for kind, place, _ in ranked if kind is Kind.COSTATE],
            [place for kind, place, _ in ranked if kind is Kind.DIRECTION],
            Kind.ACCELERATION not in inside,
            Kind.CONTROL in inside,
            bool(parts.bottom),
            sum((power for kind, _, power in ranked if kind is not Kind.CONSTANT), sp.Integer(0)),
            sorted((kind, place) for kind, place, _ in ranked),
            sp.default_sort_key(summand),
        )

    # products

    def _print_Mul(self, expr: sp.Mul) -> str:
        return self._term(expr, alone=True).signed(first=True)

    def _term(self, expression: sp.Expr, *, alone: bool = False) -> Term:
        """Print a product as a term; ``alone`` if no other term is beside it."""
        if expression.func.__name__ == "Clip":
            return self._bounded(expression)
        parts = take_apart(expression)
        if expression.is_Mul and (alone or not parts.negative):  # within a sum no sign changes
            parts = turned_round(parts, self._backwards(parts.top))
        if not parts.top and not parts.bottom:
            return whole_term(parts.negative, self._fraction_of_numbers(parts))
        negative, top = parts.negative, sorted(parts.top, key=self._factor_order)
        sums = [f for f in top if f.is_Add]
        last = Kind.FUNCTION if sums and not parts.bottom else Kind.DIRECTION
        trailing = [f for f in top if self._rank(base(f))[0] >= last or (parts.bottom and f.func.__name__ in CHOSEN)]
        others = [f for f in top if not f.is_Add and f not in trailing]
        tail = self._product(trailing)
        small_fraction = self._small and (parts.bottom or parts.number_below != 1)
        functions = [f for f in others if sums and self._rank(base(f))[0] >= Kind.FUNCTION]  # not before parentheses
        plain = [f for f in others if f not in functions]
        whole = f"{self._over(parts, [*plain, *sums, *functions])} {tail}".strip()
        if len(sums) != 1 or small_fraction:
            return whole_term(negative, whole)
        (inner,) = sums
        broken = self._with_sum(negative, self._over(parts, others, alone=False), inner, tail)
        if others and any(base(f).is_Add for f in parts.bottom):
            return Term(negative, whole, broken.pieces)
        if parts.bottom and parts.number == 1 and all(self._rank(base(f))[0] is Kind.COSTATE for f in others):
            with self._inside():
                above = self._print(inner)
            tex = rf"{self._product(others)} \frac{{{above}}}{{{self._below(parts)}}} {tail}".strip()
            return Term(negative, tex, broken.pieces)
        return broken

    def _bounded(self, expression: sp.Expr) -> Term:
        """Print a value between bounds, with possible line breaks after each bound."""
        whole = self._print(expression)
        *bounds, value = whole.split(r",\, ", 2)
        pieces = [*(Piece(f"{bound},", bool(k)) for k, bound in enumerate(bounds)), Piece(value, 2)]
        return Term(False, whole, tuple(pieces))

    def _with_sum(self, negative: bool, head: str, inner: sp.Expr, tail: str) -> Term:
        """Print ``head (sum) tail``, with possible line breaks inside the sum."""
        terms = self.terms(inner)
        whole = joined(terms)
        opening, closing = self._parentheses(whole)
        pieces = [Piece(p.tex, p.depth + 1) for k, t in enumerate(terms) for p in t.signed_pieces(first=k == 0)]
        pieces[0] = Piece(f"{head} {opening}{pieces[0].tex}".strip())
        pieces[-1] = Piece(f"{pieces[-1].tex}{closing} {tail}".strip(), pieces[-1].depth)
        return Term(negative, f"{head} {opening}{whole}{closing} {tail}".strip(), tuple(pieces))

    def _over(self, parts: Product, factors: Sequence[sp.Expr], alone: bool = True) -> str:
        """Print number and factors over the denominator; ``alone`` if no sum in parentheses follows."""
        number = "" if parts.number == 1 and (factors or not alone) else self._print(parts.number)
        if parts.bottom:
            with self._inside():
                above = self._product(factors, number) or "1"
            return self._slashed(above, parts) if self._small else rf"\frac{{{above}}}{{{self._below(parts)}}}"
        if parts.number_below == 1 or self._small:
            written = self._product(factors, number)
            return written if parts.number_below == 1 else f"{written}/{parts.number_below}"
        return self._product(factors, self._fraction_of_numbers(parts))

    def _slashed(self, above: str, parts: Product) -> str:
        below = self._below(parts)
        single = parts.number_below == 1 and len(parts.bottom) == 1 and not parts.bottom[0].is_Add
        return f"{above}/{below}" if single else f"{above}/({below})"

    def _below(self, parts: Product) -> str:
        number = "" if parts.number_below == 1 else str(parts.number_below)
        factors = sorted(parts.bottom, key=self._factor_order)
        with self._inside():
            alone = len(factors) == 1 and not number
            return self._print(factors[0]) if alone else self._product(factors, number)

    def _product(self, factors: Sequence[sp.Expr], number: str = "") -> str:
        """Print number and factors side by side, with sums in parentheses."""
        written = [number] if number else []
        for factor in factors:
            tex = self._print(factor)
            if factor.is_Add or isinstance(factor, sp.Piecewise | Until):
                tex = self._enclosed(tex)
            written.append(rf"\cdot {tex}" if written and tex[0].isdigit() else tex)
        return " ".join(written)

    def _fraction_of_numbers(self, parts: Product) -> str:
        above, below = self._print(parts.number), parts.number_below
        if below == 1:
            return above
        return f"{above}/{below}" if self._small else rf"\tfrac{{{above}}}{{{below}}}"

    def _factor_order(self, factor: sp.Expr) -> tuple[Any, ...]:
        return (*self._rank(base(factor)), sp.default_sort_key(factor))

    def _rank(self, factor: sp.Expr) -> tuple[Kind, int]:
        if isinstance(factor, sp.Symbol):
            return self._ranks.get(factor.name, (Kind.OTHER, 0))
        if not factor.free_symbols:
            return (Kind.NUMBER, 0)
        return (Kind.SUM if factor.is_Add else Kind.FUNCTION, min(self._rank(s)[1] for s in factor.free_symbols))

    # numbers, symbols, powers, functions

    def _print_Rational(self, expr: sp.Rational) -> str:
        if expr.is_Integer:
            return str(expr)
        parts = take_apart(expr)
        return ("-" if parts.negative else "") + self._fraction_of_numbers(parts)

    def _print_Symbol(self, expr: sp.Symbol, style: str = "plain") -> str:
        return self.symbol(expr.name)

    def _print_Pow(self, expr: sp.Pow) -> str:
        root, power = expr.as_base_exp()
        if power.is_Rational and power.is_negative:
            return self._term(expr).signed(first=True)
        with self._inside():
            if power == sp.Rational(1, 2):
                return rf"\sqrt{{{self._print(root)}}}"
            exponent_tex = self._print(decimal(power))
        if root.func.__name__ in ELEMENTARY:
            return self._print_Function(root, exponent_tex)
        tex = self._print(root)
        bare = root.is_Symbol and "^" not in tex and r"\frac" not in tex
        bare = bare or bool(root.is_Integer and root.is_nonnegative)
        return f"{tex if bare else self._enclosed(tex)}^{{{exponent_tex}}}"

    def _print_Function(self, expr: sp.Function, exp: str | None = None) -> str:
        name = expr.func.__name__
        if name not in ELEMENTARY:
            return super()._print_Function(expr, exp)
        (argument,) = expr.args
        tex = self._print(argument)
        power = f"^{{{exp}}}" if exp else ""
        return rf"\{'ln' if name == 'log' else name}{power} {tex if argument.is_Symbol else self._enclosed(tex)}"

    def _print_ExpBase(self, expr: sp.Expr, exp: str | None = None) -> str:
        with self._inside():
            return super()._print_ExpBase(expr, exp)

    def _print_log(self, expr: sp.Expr, exp: str | None = None) -> str:
        return self._print_Function(expr, exp)

    def _print_Abs(self, expr: sp.Abs, exp: str | None = None) -> str:
        (inside,) = expr.args
        if inside.is_Add and is_negative(min(inside.args, key=self._summand_order)):
            expr = expr.func(-inside, evaluate=False)
        return super()._print_Abs(expr, exp)

    def _print_atan2(self, expr: sp.Expr, exp: str | None = None) -> str:
        across, along = map(self._print, expr.args)
        return rf"\operatorname{{atan2}}({across},\, {along})"

    _print_Bearing = _print_atan2


def _escaped(name: str) -> str:
    return "".join(c if c.isalnum() and c.isascii() else r"\_" if c == "_" else " " for c in name)
