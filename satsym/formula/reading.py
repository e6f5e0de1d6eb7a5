"""The safe language of formulas: conversion of text from a file to a tree, without any evaluation.

The text is measured before Python's own parser sees it, so that no length, depth or tower of powers can do harm; the
parser's result is translated node by node, and any kind of node, operator, name or function that is not listed here is
refused.
"""

from __future__ import annotations

import ast
import re
import warnings
from collections.abc import Mapping
from fractions import Fraction
from typing import TypeAlias

from satsym.formula.functions import OPERATIONS
from satsym.formula.tree import Add, Call, Div, Equality, Grid, Mul, Neg, Node, Num, Pow, Sym, Text, constant
from satsym.formula.weight import MAX_TERMS, Scales
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

MAX_LENGTH = 4000
MAX_DEPTH = 50
MAX_DIGITS = 30
MAX_NAME = 40
MAX_EXPONENT = 20
MAX_DENOMINATOR = 12

NAME = re.compile(r"[A-Za-z](?:_?[A-Za-z0-9])*_?\Z")
Functions: TypeAlias = Mapping[str, tuple[int, int]]
"""Names of functions with the least and largest number of arguments."""

FUNCTIONS: Functions = {
    **dict.fromkeys("sin cos tan sqrt exp log abs sign asin acos atan sinh cosh tanh".split(), (1, 1)),
    "atan2": (2, 2),
    "min": (2, 2),
    "max": (2, 2),
    "norm": (1, 1),  # of a column
}
"""The functions that a printed formula may call."""
_JUDGING = {**{name: (found.fewest, found.most) for name, found in OPERATIONS.items()}, **FUNCTIONS}
"""The functions that the formulas of a ledger may call."""
_OF_LIBRARIES = {"np.sqrt": "sqrt", "np.linalg.norm": "norm"}
"""Names of functions in libraries, with the names that they have here."""

_FOREIGN = re.compile(r"""[^A-Za-z0-9_ .,+\-*/()\[\]='":@\n]""")
_FOREIGN_TO_RELATIONS = re.compile(r"""[^A-Za-z0-9_ .,+\-*/()\[\]='":@\n<>!]""")
_TOO_DEEP = f"brackets or signs are nested more than {MAX_DEPTH} levels deep; split the formula"
_QUOTED = re.compile(r"""'[ !-&(-\[\]-~]*'|"[ !#-\[\]-~]*\"""")
"""Printable characters in quotes, without quotes and backslashes."""
_SIGNS = re.compile(r"[-+](?:[ \n]*[-+]){3}")
_LAMBDA, _STAND_IN = re.compile(r"\blambda\b"), "la__da"
"""The name lambda, which Python reserves, and its replacement of equal length, which no text contains."""
_DECIMAL = re.compile(r"(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]{1,2})?")
_DIGITS = re.compile(r"(?<![A-Za-z0-9_.])[0-9][0-9_]*|(?<=\.)[0-9_]+")
_WORDS = {
    ast.Attribute: "an attribute (a dot after a name)",
    ast.Lambda: "lambda",
    ast.Compare: "a comparison",
    ast.BoolOp: "and/or",
    ast.IfExp: "if/else",
    ast.Subscript: "an index in brackets",
    ast.NamedExpr: ":=",
    ast.Starred: "a star",
    ast.Tuple: "a tuple (a comma)",
    ast.List: "a list",
    ast.ListComp: "a comprehension",
    ast.GeneratorExp: "a comprehension",
    ast.JoinedStr: "a formatted text",
    ast.Call: "a call of something other than a name",
}


def expression(text: str, *, judging: bool = False) -> Node:
    """Read one expression.

    Parameters
    ----------
    text
        Numbers, names, ``+ - * / **``, brackets and calls.
    judging
        Whether lists, quoted texts, ``row['item']``, ``@``, arguments by name and what derives are allowed, too: in
        what a formula is held against, not in what is printed.

    Raises
    ------
    BadInput
        With the reason, and the column where there is one.
    """
    measured(text, judging)
    line = _LAMBDA.sub(_STAND_IN, text.strip().replace("\n", " "))
    return Scales(MAX_TERMS).checked(_Reader(line, judging).node(parsed(line, text, "a formula")))


def statement(text: str, *, judging: bool = False) -> Node | Equality:
    """Read one expression, or an equality ``lhs = rhs`` of two.

    Raises
    ------
    BadInput
        As for :func:`expression`, or if there are several equality signs.
    """
    measured(text, judging)
    sides = _sides(text)
    if len(sides) > 2:
        raise BadInput("has more than one equals sign; write a separate row for each equation")
    read = [expression(side, judging=judging) for side in sides]
    return read[0] if len(read) == 1 else Equality(read[0], read[1])


def checked_name(name: str) -> str:
    """Return a name after a check that it may occur in a formula.

    Raises
    ------
    BadInput
        If it is not letters, digits and single underscores.
    """
    if len(name) > MAX_NAME:
        raise BadInput(f"the name {shown(name)} is longer than {MAX_NAME} characters")
    if not NAME.match(name):
        raise BadInput(f"{shown(name)} is not a name; use letters, digits and single underscores, without TeX")
    return name


def measured(text: str, judging: bool, relations: bool = False) -> None:
    """Refuse a text that is too long or too deep, or has characters that are not part of formulas.

    Raises
    ------
    BadInput
        With what is wrong.
    """
    if len(text) > MAX_LENGTH:
        raise BadInput(f"longer than {MAX_LENGTH} characters; split it into parts")
    if judging:
        text = _QUOTED.sub("''", text)
    foreign = (_FOREIGN_TO_RELATIONS if relations else _FOREIGN).search(text)
    if foreign:
        raise BadInput(f'the character "{printable(foreign[0])}" is not allowed here (column {foreign.start() + 1})')
    depth = 0
    for character in text:
        depth += (character in "([") - (character in ")]")
        if depth > MAX_DEPTH:
            raise BadInput(_TOO_DEEP)
    if _SIGNS.search(text) or text.count("**") > 200:
        raise BadInput(_TOO_DEEP)
    for digits in _DIGITS.findall(text):
        if len(digits) > MAX_DIGITS:
            raise BadInput(f"a number has more than {MAX_DIGITS} digits")


def _sides(text: str) -> list[str]:
    """Split a text at the equality signs outside all brackets."""
    sides, depth, start = [], 0, 0
    for i, character in enumerate(text):
        depth += (character in "([") - (character in ")]")
        if character == "=" and depth == 0:
            sides.append(text[start:i])
            start = i + 1
    return [*sides, text[start:]]


def parsed(line: str, text: str, what: str) -> ast.expr:
    """Parse a measured line by Python's parser.

    Raises
    ------
    BadInput
        If it is no expression.
    """
    if not line:
        raise BadInput(f"is empty; give {what}")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return ast.parse(line, mode="eval").body
    except SyntaxError as error:
        where = f" (column {error.offset})" if error.offset else ""
        raise BadInput(f"{shown(text)} is not {what}{where}; write products with * and powers with **") from None
    except (RecursionError, MemoryError, ValueError):
        raise BadInput(_TOO_DEEP) from None


class _Reader:
    """Translates Python's syntax tree, and refuses whatever is not listed."""

    def __init__(self, text: str, judging: bool) -> None:
        self._text = text
        self._functions = _JUDGING if judging else FUNCTIONS
        self._judging = judging

    def node(self, found: ast.expr, depth: int = 0) -> Node:
        """Return the tree of a node of Python's syntax tree."""
        if depth > 2 * MAX_DEPTH:
            raise BadInput(_TOO_DEEP)
        if isinstance(found, ast.Constant):
            return self._constant(found)
        if isinstance(found, ast.Name):
            return Sym(checked_name(found.id.replace(_STAND_IN, "lambda")))
        if isinstance(found, ast.UnaryOp) and isinstance(found.op, ast.USub | ast.UAdd):
            operand = self.node(found.operand, depth + 1)
            return Neg(operand) if isinstance(found.op, ast.USub) else operand
        if isinstance(found, ast.BinOp):
            return self._power(found, depth) if isinstance(found.op, ast.Pow) else self._chain(found, depth)
        if isinstance(found, ast.Call):
            called = self._text[found.func.col_offset : found.func.end_col_offset]
            if isinstance(found.func, ast.Name) or called in _OF_LIBRARIES:
                return self._call(found, _OF_LIBRARIES.get(called, called), depth)
        if self._judging and isinstance(found, ast.List):
            return Grid(tuple(self.node(entry, depth + 1) for entry in found.elts))
        if self._judging and isinstance(found, ast.Subscript) and isinstance(found.value, ast.Name):
            keys = found.slice.elts if isinstance(found.slice, ast.Tuple) else [found.slice]
            return self._call(ast.Call(found.value, keys, []), found.value.id, depth)
        what = _WORDS.get(type(found), f"this ({type(found).__name__})")
        raise BadInput(f"{what} is not allowed here{column(found)}")

    def _constant(self, found: ast.Constant) -> Node:
        if isinstance(found.value, str) and self._judging:
            return Text(found.value)
        text = self._text[found.col_offset : found.end_col_offset]
        if not _DECIMAL.fullmatch(text):
            raise BadInput(f"{printable(text)} is not a plain decimal number{column(found)}")
        return Num(Fraction(text))

    def _chain(self, found: ast.BinOp, depth: int) -> Node:
        """Translate sums and products; a long one leans to the left and is walked, so that its length is not depth."""
        spine: list[ast.BinOp] = []
        left: ast.expr = found
        while isinstance(left, ast.BinOp) and not isinstance(left.op, ast.Pow):
            spine.append(left)
            left = left.left
        result = self.node(left, depth + 1)
        for link in reversed(spine):
            result = self._joined(result, link, self.node(link.right, depth + 1))
        return result

    def _joined(self, left: Node, link: ast.BinOp, right: Node) -> Node:
        if isinstance(link.op, ast.Add | ast.Sub):
            term = Neg(right) if isinstance(link.op, ast.Sub) else right
            return Add((*left.terms, term) if isinstance(left, Add) else (left, term))
        if isinstance(left, Neg):  # -a*b is -(a*b)
            return Neg(self._joined(left.operand, link, right))
        if isinstance(link.op, ast.Div):
            if constant(right) == 0:
                raise BadInput(f"a division by zero{column(link.right)}")
            return Div(left, right)
        if isinstance(link.op, ast.Mult) or (isinstance(link.op, ast.MatMult) and self._judging):
            return Mul((*left.factors, right) if isinstance(left, Mul) else (left, right))
        raise BadInput(f"only the operators + - * / ** are allowed here{column(link)}")

    def _power(self, found: ast.BinOp, depth: int) -> Node:
        base, exponent = self.node(found.left, depth + 1), self.node(found.right, depth + 1)
        value = (
            None if isinstance(found.right, ast.BinOp) and isinstance(found.right.op, ast.Pow) else constant(exponent)
        )
        if value is None:
            raise BadInput(f"an exponent must be a number{column(found.right)}; write exp(...) for powers of e")
        if abs(value) > MAX_EXPONENT or value.denominator > MAX_DENOMINATOR:
            raise BadInput(
                f"the exponent {value} is out of range (-{MAX_EXPONENT} to {MAX_EXPONENT}){column(found.right)}"
            )
        if value <= 0 and constant(base) == 0:
            raise BadInput(f"zero to the power of {value}{column(found)}")
        return Pow(base, exponent)

    def _call(self, found: ast.Call, name: str, depth: int) -> Node:
        if name not in self._functions:
            raise BadInput(
                f"the function {shown(name)} is unknown{column(found.func)}; {suggestion(name, self._functions)}"
            )
        if found.keywords and not self._judging:
            raise BadInput(f"{name} takes no keyword arguments{column(found.func)}")
        least, most = self._functions[name]
        if not least <= len(found.args) <= most:
            wanted = f"{least}" if least == most else f"{least} to {most}"
            raise BadInput(f"{name} takes {wanted} arguments, not {len(found.args)}{column(found.func)}")
        positional = tuple(self.node(argument, depth + 1) for argument in found.args)
        named = tuple((checked_name(k.arg or "**"), self.node(k.value, depth + 1)) for k in found.keywords)
        return Call(name, positional, named)


def column(found: ast.AST) -> str:
    """Return where a node of Python's syntax tree stands, for messages; empty if it is not known."""
    return f" (column {found.col_offset + 1})" if hasattr(found, "col_offset") else ""
