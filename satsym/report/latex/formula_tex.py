"""Printed formulas in LaTeX, in their own symbols and usual handwritten form, broken where they are wide."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import pairwise
from typing import TypeAlias

from satsym.formula import reading
from satsym.formula.tree import Add, Call, Div, Equality, Grid, Mul, Neg, Node, Num, Pow, Sym, constant
from satsym.formula.writing import GREEK, written
from satsym.report.latex.equations import width
from satsym.report.latex.tex import GREEK_CAPITALS, escape
from satsym.status import BadInput

Printed: TypeAlias = Node | Equality | tuple[tuple[Node, ...], ...]
"""A formula, or a matrix of them."""

WIDEST = 34.0
"""Width of a line, in em of the main font."""

_GREEK = GREEK | {letter.capitalize() for letter in GREEK_CAPITALS}
_ACCENTS = {"dot": r"\dot", "ddot": r"\ddot", "hat": r"\hat", "bar": r"\bar", "vector": r"\vec"}
_FUNCTIONS = {
    "asin": "arcsin",
    "acos": "arccos",
    "atan": "arctan",
    "atan2": "operatorname{atan2}",
    "norm": "operatorname{norm}",
}
_BASE = re.compile(r"([A-Za-z]+?)([0-9]+[A-Za-z0-9]*)?\Z")
_SUM, _PRODUCT, _ATOM = range(3)


def formula(tree: Printed) -> str:
    """Typeset a formula or a matrix on one line."""
    if isinstance(tree, tuple):
        return matrix(tree)
    if isinstance(tree, Equality):
        return f"{formula(tree.lhs)} = {formula(tree.rhs)}"
    return _tex(tree)[0]


def lines(tree: Printed) -> list[str]:
    """Typeset a formula on as many lines as its width needs; a sum is broken between its terms."""
    whole = formula(tree)
    right = tree.rhs if isinstance(tree, Equality) else tree
    if width(whole) <= WIDEST or not isinstance(right, Add):
        return [whole]
    found = [f"{formula(tree.lhs)} = " if isinstance(tree, Equality) else ""]
    for k, term in enumerate(right.terms):
        piece = _signed(term, first=k == 0)
        if k and width(found[-1] + piece) > WIDEST:
            found.append("")
        found[-1] += piece
    return [line.strip() for line in found]


def matrix(entries: Sequence[Sequence[Node]]) -> str:
    """Typeset a matrix."""
    rows = " \\\\ ".join(" & ".join(map(formula, row)) for row in entries)
    return f"\\begin{{pmatrix}} {rows} \\end{{pmatrix}}"


def read(text: str) -> Printed | None:
    """Return the formula or matrix in a text; ``None`` where the text is none."""
    try:
        tree = reading.statement(text, judging=text.startswith("["))
    except BadInput:
        return None
    if not isinstance(tree, Grid):
        return tree
    return tuple(entry.entries if isinstance(entry, Grid) else (entry,) for entry in tree.entries)


def inline(text: str) -> str | None:
    """Typeset a formula in a sentence, possibly a term with its sign; ``None`` where a text is none."""
    found = read(text.removeprefix("+"))
    return None if found is None else f"{'+' if text.startswith('+') else ''}{formula(found)}"


def symbol(name: str) -> str:
    """Typeset a name: ``x1`` has an index, ``d_x1`` and ``r_dot`` a dot, ``lambda`` is a letter."""
    letter, index, star = _parts(name)
    return f"{letter}{f'_{{{index}}}' if index else ''}{star}"


def _parts(name: str) -> tuple[str, str, str]:
    """Split a name into letter with accents, index and star."""
    if name.startswith("d_") and len(name) > 2:
        letter, index, star = _parts(name[2:])
        return rf"\dot{{{letter}}}", index, star
    head, _, last = name.rpartition("_")
    if head and last in _ACCENTS:
        letter, index, star = _parts(head)
        return rf"{_ACCENTS[last]}{{{letter}}}", index, star
    if head and last == "star":
        letter, index, _ = _parts(head)
        return letter, index, "^{*}"
    base, _, rest = name.partition("_")
    match = _BASE.match(base)
    letters, digits = (match[1], match[2] or "") if match else (base, "")
    if letters in _GREEK:
        letter = rf"\{letters}"
    else:
        letter = letters if len(letters) == 1 else rf"\mathrm{{{letters}}}"
    return letter, ",".join(filter(None, [digits, *(_index(part) for part in rest.split("_") if part)])), ""


def _index(part: str) -> str:
    if part in _GREEK:
        return rf"\{part}"
    return part if len(part) == 1 or part.isdigit() else rf"\mathrm{{{part}}}"


def _signed(term: Node, first: bool) -> str:
    negative = isinstance(term, Neg)
    inner = term.operand if isinstance(term, Neg) else term
    sign = "-" if negative else "" if first else "+"
    return f" {sign} {_bound(inner, _PRODUCT)}" if sign and not first else f"{sign}{_bound(inner, _PRODUCT)}"


def _tex(node: Node) -> tuple[str, int]:
    """Return the LaTeX of a node, and its binding strength."""
    if isinstance(node, Num):
        return _fraction(node) if "/" in written(node) else written(node), _ATOM
    if isinstance(node, Sym):
        return symbol(node.name), _ATOM
    if isinstance(node, Neg):
        return f"-{_bound(node.operand, _PRODUCT)}", _SUM
    if isinstance(node, Add):
        return "".join(_signed(term, first=k == 0) for k, term in enumerate(node.terms)), _SUM
    if isinstance(node, Mul):
        return _product(node), _PRODUCT
    if isinstance(node, Div):
        return rf"\frac{{{_tex(node.numerator)[0]}}}{{{_tex(node.denominator)[0]}}}", _ATOM
    if isinstance(node, Pow):
        return _power(node), _PRODUCT
    if isinstance(node, Call):
        return _call(node), _ATOM
    return rf"\text{{{escape(written(node))}}}", _ATOM


def _bound(node: Node, least: int) -> str:
    text, binding = _tex(node)
    return text if binding >= least else rf"\left({text}\right)"


def _fraction(node: Num) -> str:
    return rf"\frac{{{node.value.numerator}}}{{{node.value.denominator}}}"


def _product(node: Mul) -> str:
    pieces = [_bound(factor, _PRODUCT) for factor in node.factors]
    joined = pieces[0]
    for before, piece in pairwise(pieces):
        numbers = before[-1].isdigit() and piece[0].isdigit()
        joined += rf" \cdot {piece}" if numbers else rf" {piece}"
    return joined


def _power(node: Pow) -> str:
    exponent = constant(node.exponent)
    if exponent is not None and exponent.denominator == 2 and exponent.numerator == 1:
        return rf"\sqrt{{{_tex(node.base)[0]}}}"
    accented = isinstance(node.base, Sym) and node.base.name.endswith("_star")
    base = _bound(node.base, _ATOM)
    return rf"{{{base}}}^{{{_tex(node.exponent)[0]}}}" if not accented else rf"({base})^{{{_tex(node.exponent)[0]}}}"


def _call(node: Call) -> str:
    arguments = ", ".join(_tex(argument)[0] for argument in node.arguments)
    if node.function == "sqrt":
        return rf"\sqrt{{{arguments}}}"
    if node.function == "abs":
        return rf"\left|{arguments}\right|"
    if node.function == "exp":
        return rf"e^{{{arguments}}}"
    name = _FUNCTIONS.get(node.function, node.function)
    if name == "sign":
        name = r"operatorname{sgn}"
    return rf"\{name}\left({arguments}\right)"
