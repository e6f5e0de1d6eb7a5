"""Conversion of trees to text in the safe language, with no more brackets than needed."""

from __future__ import annotations

from fractions import Fraction

from satsym.formula.tree import Add, Call, Div, Equality, Grid, Mul, Neg, Node, Num, Pow, Sym, Text

GREEK = frozenset(
    "alpha beta gamma delta epsilon zeta eta theta iota kappa lambda mu nu xi pi rho sigma tau upsilon phi chi psi "
    "omega".split()
)
"""Greek letters, which are written as words."""
_SUM, _PRODUCT, _POWER, _ATOM = range(4)


def written(tree: Node | Equality) -> str:
    """Return the text that is read as this tree."""
    if isinstance(tree, Equality):
        return f"{written(tree.lhs)} = {written(tree.rhs)}"
    return _text(tree)[0]


def _text(node: Node) -> tuple[str, int]:
    """Return the text of a node, and its binding strength."""
    if isinstance(node, Num):
        return _number(node.value)
    if isinstance(node, Sym):
        return node.name, _ATOM
    if isinstance(node, Text):
        return f"'{node.value}'", _ATOM
    if isinstance(node, Neg):
        return f"-{_bound(node.operand, _PRODUCT)}", _SUM
    if isinstance(node, Add):
        first, *rest = node.terms
        pieces = [_bound(first, _SUM) if not isinstance(first, Add) else f"({_text(first)[0]})"]
        for term in rest:
            negative = isinstance(term, Neg)
            inner = term.operand if isinstance(term, Neg) else term
            pieces.append(f" {'-' if negative else '+'} {_bound(inner, _PRODUCT)}")
        return "".join(pieces), _SUM
    if isinstance(node, Mul):
        first, *rest = node.factors
        return "*".join([_bound(first, _PRODUCT), *(_bound(factor, _POWER) for factor in rest)]), _PRODUCT
    if isinstance(node, Div):
        return f"{_bound(node.numerator, _PRODUCT)}/{_bound(node.denominator, _POWER)}", _PRODUCT
    if isinstance(node, Pow):
        return f"{_bound(node.base, _ATOM)}**{_bound(node.exponent, _ATOM)}", _POWER
    if isinstance(node, Grid):
        return f"[{', '.join(map(written, node.entries))}]", _ATOM
    return _call(node), _ATOM


def _bound(node: Node, least: int) -> str:
    text, binding = _text(node)
    return text if binding >= least else f"({text})"


def _number(value: Fraction) -> tuple[str, int]:
    if value.denominator == 1:
        return str(value.numerator), _ATOM
    places = _decimal_places(value.denominator)
    if places is None:
        return f"{value.numerator}/{value.denominator}", _PRODUCT
    digits = f"{value.numerator * 10**places // value.denominator:0{places + 1}d}"
    return f"{digits[:-places]}.{digits[-places:]}", _ATOM


def _decimal_places(denominator: int) -> int | None:
    """Return the decimal places that this denominator needs; ``None`` if no number is enough."""
    return next((n for n in range(61) if 10**n % denominator == 0), None)


def _call(node: Call) -> str:
    arguments = [*map(written, node.arguments), *(f"{name}={written(value)}" for name, value in node.named)]
    if node.function == "row":
        return f"row[{', '.join(arguments)}]"
    return f"{node.function}({', '.join(arguments)})"
