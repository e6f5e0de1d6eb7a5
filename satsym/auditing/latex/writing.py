"""Formulas written again in the notation that they were printed in: LaTeX, or plain text."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from itertools import pairwise

from satsym.auditing.latex.letters import GREEK
from satsym.auditing.latex.words import COUNTERS
from satsym.formula.tree import (
    Add,
    Call,
    Div,
    Equality,
    Grid,
    Mul,
    Neg,
    Node,
    Num,
    Pow,
    Sym,
    constant,
    each,
    substituted,
    symbols,
)
from satsym.formula.writing import written

Writer = Callable[["Node | Equality"], str]
_SUM, _PRODUCT, _ATOM = range(3)
_NAMES = {"log": r"\ln", "asin": r"\arcsin", "acos": r"\arccos", "atan": r"\arctan"}
_WORDS = {"pi": r"\pi", "constant": r"\text{const}", "infinity": r"\infty", "ellipsis": r"\ldots"}
_WORDS |= {"otherwise": r"\text{otherwise}"}
_SIGNS = {"less": "<", "greater": ">", "at_most": r"\le", "at_least": r"\ge", "unequal": r"\ne", "near": r"\approx"}
_SIGNS |= {"tends": r"\to", "subset": r"\subset", "precedes": r"\prec", "follows": r"\succ", "much_less": r"\ll"}
_SIGNS |= {"much_greater": r"\gg", "similar": r"\sim", "proportional": r"\propto", "element": r"\in", "equal": "="}
_SIGNS |= {"not_element": r"\notin"}
_OPTIMA = {"minimum": r"\min", "maximum": r"\max", "argmin": r"\arg\min", "argmax": r"\arg\max"}
_OPTIMA |= {"infimum": r"\inf", "supremum": r"\sup"}
_KNOWN = frozenset("sin cos tan sinh cosh tanh min max det".split())
_GREEK = "|".join(sorted(GREEK))
_RUNS_ON = re.compile(
    r"\\(?:sinh?|cosh?|tanh?|ln|arc[a-z]+) "
    rf"(?:[A-Za-z][^ |]*\|(?:[A-Za-z]|\\(?:{_GREEK})\b)|\\[^ |]+\|\\(?:{_GREEK})\b)"
)
"""A function of a letter without brackets, in front of another letter."""


def in_latex(letters: Mapping[str, str]) -> Writer:
    """Writes in LaTeX, with these letters by name."""

    def formula(tree: Node | Equality) -> str:
        if isinstance(tree, Equality):
            return f"{_tex(tree.lhs, letters)[0]} = {_tex(tree.rhs, letters)[0]}"
        return _tex(tree, letters)[0]

    return formula


def in_plain(letters: Mapping[str, str]) -> Writer:
    """Writes in plain notation, with ``^`` for powers."""

    def formula(tree: Node | Equality) -> str:
        return written(_renamed(tree, letters)).replace("**", "^")

    return formula


def _renamed(tree: Node | Equality, letters: Mapping[str, str]) -> Node | Equality:
    names: dict[str, Node] = {name: Sym(text) for name, text in letters.items()}
    return each(tree, lambda side: substituted(side, names))


def _tex(node: Node, letters: Mapping[str, str]) -> tuple[str, int]:
    """The LaTeX of a node, and how tightly it binds."""

    def bound(part: Node, least: int) -> str:
        text, binding = _tex(part, letters)
        return text if binding >= least else rf"\left({text}\right)"

    def whole(part: Node) -> str:
        return _tex(part, letters)[0]

    if isinstance(node, Num):
        text = written(node)
        return (rf"\frac{{{node.value.numerator}}}{{{node.value.denominator}}}" if "/" in text else text), _ATOM
    if isinstance(node, Sym):
        return letters.get(node.name) or _WORDS.get(node.name, node.name), _ATOM
    if isinstance(node, Neg):
        return f"-{bound(node.operand, _PRODUCT)}", _SUM
    if isinstance(node, Add):
        said = bound(node.terms[0], _SUM)
        for term in node.terms[1:]:
            inner = term.operand if isinstance(term, Neg) else term
            said += f" {'-' if isinstance(term, Neg) else '+'} {bound(inner, _PRODUCT)}"
        return said, _SUM
    if isinstance(node, Mul):
        pieces = [bound(factor, _PRODUCT) for factor in node.factors]
        for k, (before, piece) in enumerate(pairwise(pieces)):
            if _RUNS_ON.search(f"{before}|{piece} "):  # sin x y would be read as sin(xy)
                pieces[k] = rf"\left({before}\right)"
        said = pieces[0]
        for piece in pieces[1:]:
            said += rf" \cdot {piece}" if piece[:1].isdigit() else f" {piece}"
        return said, _PRODUCT
    if isinstance(node, Div):
        return rf"\frac{{{whole(node.numerator)}}}{{{whole(node.denominator)}}}", _ATOM
    if isinstance(node, Pow):
        return _power(node, letters), _PRODUCT
    if isinstance(node, Grid) and not any(isinstance(entry, Grid) for entry in node.entries):
        return rf"\left[{', '.join(map(whole, node.entries))}\right]", _ATOM
    if isinstance(node, Grid):
        return rf"\begin{{pmatrix}} {_rows(node, letters)} \end{{pmatrix}}", _ATOM
    if not isinstance(node, Call):
        return written(node), _ATOM
    arguments = ", ".join(map(whole, node.arguments))
    special = {
        "sqrt": rf"\sqrt{{{arguments}}}",
        "exp": f"e^{{{arguments}}}",
        "abs": f"|{arguments}|",
        "norm": rf"\|{arguments}\|",
        "d": rf"\frac{{d}}{{dt}}\left({arguments}\right)",
        "transpose": rf"{bound(node.arguments[0], _ATOM)}^{{\mathsf T}}" if node.arguments else "",
        "skew": rf"\left[{arguments}\right]_{{\times}}",
        "list": arguments,
        "braces": rf"\left\{{{arguments}\right\}}",
    }
    if node.function == "diff" and len(node.arguments) == 2:
        by = whole(node.arguments[1])
        return rf"\frac{{\partial {whole(node.arguments[0])}}}{{\partial {by}}}", _ATOM
    if node.function in ("cross", "dot") and len(node.arguments) == 2:
        sign = {"cross": r"\times", "dot": r"\cdot"}[node.function]
        return rf"{bound(node.arguments[0], _ATOM)} {sign} {bound(node.arguments[1], _ATOM)}", _PRODUCT
    if node.function == "sum":
        limits = [whole(part) for part in node.arguments[1:]]
        below = f"_{{{'='.join(limits[:2])}}}" if limits else ""
        above = f"^{{{limits[2]}}}" if len(limits) > 2 else ""
        return rf"\sum{below}{above} {bound(node.arguments[0], _PRODUCT)}", _SUM
    if node.function == "integral" and len(node.arguments) > 1:
        inside, by, *limits = map(whole, node.arguments)
        ends = "".join(f"{sign}{{{end}}}" for sign, end in zip("_^", limits, strict=False))
        return rf"\int{ends} {inside} \, d{by}", _SUM
    if (found := _read_only(node, whole, bound)) is not None:
        return found
    if node.function in special:
        return special[node.function], _ATOM
    name = _NAMES.get(node.function) or (rf"\{node.function}" if node.function in _KNOWN else "")
    name = name or rf"\operatorname{{{node.function}}}"
    simple = len(node.arguments) == 1 and isinstance(node.arguments[0], Sym) and not name.startswith("\\operator")
    return (f"{name} {arguments}" if simple else rf"{name}\left({arguments}\right)"), _PRODUCT if simple else _ATOM


def _read_only(node: Call, whole: Callable[[Node], str], bound: Callable[[Node, int], str]) -> tuple[str, int] | None:
    """The LaTeX of what is read and held against nothing; ``None`` for anything else."""
    first, *rest = node.arguments
    others = ", ".join(map(whole, rest))
    if node.function in _SIGNS:
        return f"{whole(first)} {_SIGNS[node.function]} {others}", _SUM
    if node.function in _OPTIMA:
        below = f"_{{{others}}}" if rest else ""
        return rf"{_OPTIMA[node.function]}{below} \left({whole(first)}\right)", _SUM
    if node.function == "limit":
        return rf"\lim_{{{whole(rest[0])} \to {whole(rest[1])}}} {bound(first, _PRODUCT)}", _SUM
    if node.function == "gradient":
        by = f"_{{{others}}}" if rest else ""
        return rf"\nabla{by} {bound(first, _ATOM)}", _PRODUCT
    if node.function == "value" and isinstance(first, Sym) and len(rest) == 1 and _counts(rest[0]):
        return rf"{whole(first)}\left[{others}\right]", _ATOM
    if node.function == "value" and isinstance(first, Sym):
        return rf"{whole(first)}\left({others}\right)", _ATOM
    if node.function == "value":
        return rf"{bound(first, _ATOM)}\Big|_{{{others}}}", _ATOM
    if node.function == "power":
        return rf"{whole(first) if isinstance(first, Num) else bound(first, _ATOM + 1)}^{{{others}}}", _PRODUCT
    if node.function == "tensor":
        return rf"{bound(first, _ATOM)} \otimes {bound(rest[0], _ATOM)}", _PRODUCT
    if node.function == "both":
        steps = [
            f"{_SIGNS[part.function]} {whole(part.arguments[1])}" for part in node.arguments if isinstance(part, Call)
        ]
        return f"{whole(first.arguments[0]) if isinstance(first, Call) else ''} {' '.join(steps)}", _SUM
    if node.function == "cases":
        rows = [f"{whole(value)} & {whole(when)}" for value, when in zip(node.arguments[::2], rest[::2], strict=True)]
        body = r" \\ ".join(rows)
        return rf"\begin{{cases}} {body} \end{{cases}}", _ATOM
    return None


def _counts(node: Node) -> bool:
    """Whether something is the number of a member of a sequence."""
    return bool(symbols(node)) and symbols(node) <= COUNTERS


def _power(node: Pow, letters: Mapping[str, str]) -> str:
    text, binding = _tex(node.base, letters)
    exponent = _tex(node.exponent, letters)[0]
    if constant(node.exponent) is not None and len(exponent) > 1:
        exponent = f"{{{exponent}}}"
    if binding < _ATOM or isinstance(node.base, Div) or "^" in text:
        text = rf"\left({text}\right)"
    return f"{text}^{exponent}"


def _rows(node: Grid, letters: Mapping[str, str]) -> str:
    rows = [entry.entries if isinstance(entry, Grid) else (entry,) for entry in node.entries]
    return r" \\ ".join(" & ".join(_tex(cell, letters)[0] for cell in row) for row in rows)
