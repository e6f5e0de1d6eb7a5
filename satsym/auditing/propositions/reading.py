"""Parser of propositions: a text becomes a checked syntax tree in Python's expression syntax.

Nothing is evaluated here. The length and depth of the text are limited before Python's parser reads it, only listed
kinds of nodes are allowed, and every name must be known: a measurement, family or convention, a name bound by a
quantifier, or a symbol of the row's notation.
"""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any

from satsym.formula.reading import MAX_LENGTH, column, measured, parsed
from satsym.status import BadInput
from satsym.wording import shown, suggestion

QUANTIFIERS = ("all", "any")
"""Quantifiers, which take a comprehension: ``all(P(s) for s in FAMILY)``."""
CONNECTIVES = ("implies", "iff")
"""Connectives, which take two propositions."""
LOOKUPS = ("row", "text")
"""Tables that a proposition may look up.

``row['2.19', 'k1']`` is the printed formula of a row, and ``text['program', 'lines']`` the printed text of a row.
``text['program', 'loop*']`` lists the texts of all rows whose keys begin alike.
"""
MEANINGS = "meanings"
"""Name of a table: ``meanings['x1']`` lists the meanings of a letter in all notations of the document."""
ITEMS = "items"
"""Name of the list of numbered items of a document: equations, theorems, tables and figures."""
PRINTED = "printed"
"""Name of the printed text of the row itself, for use in ``holds``."""

_BRACES = re.compile(r"\{([^{}]*)\}")
_ALLOWED: tuple[type[ast.AST], ...] = (
    *(ast.Expression, ast.Constant, ast.Name, ast.Attribute, ast.Subscript, ast.Call, ast.keyword, ast.Tuple, ast.List),
    *(ast.UnaryOp, ast.USub, ast.UAdd, ast.Not, ast.BoolOp, ast.And, ast.Or, ast.Compare, ast.BinOp),
    *(ast.Eq, ast.NotEq, ast.Lt, ast.LtE, ast.Gt, ast.GtE, ast.In, ast.NotIn),
    *(ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow, ast.MatMult),
    *(ast.GeneratorExp, ast.ListComp, ast.comprehension, ast.Load, ast.Store),
)
_WORDS: Mapping[type[ast.AST], str] = {ast.Lambda: "lambda", ast.IfExp: "if/else", ast.NamedExpr: ":=", ast.Is: "is"}


@dataclass(frozen=True)
class Words:
    """Names that a proposition may use."""

    functions: Mapping[str, Callable[..., Any]]
    """Measurements (functions that compute quantities) by name."""
    values: Mapping[str, Callable[[], Any]]
    """Families, conventions and constants by name; each is created on demand."""
    symbols: Collection[str] = ()
    """Symbols of the notation that a proposition may use."""


@dataclass(frozen=True)
class Proposition:
    """A claim that can be true or false."""

    text: str
    """Text of the proposition in the ledger."""
    tree: ast.expr
    """Checked syntax tree of the text."""
    rows: tuple[str, ...] = ()
    """Keys of the rows that the proposition looks up."""
    symbols: tuple[str, ...] = ()
    """Symbols of the notation that the proposition uses, and ``printed`` if it is used."""

    @property
    def quotes(self) -> bool:
        """Whether the proposition refers to printed text of the document, such as the lines of a program."""
        return PRINTED in self.symbols or any(
            isinstance(node, ast.Name) and node.id == "text" for node in ast.walk(self.tree)
        )

    @property
    def stands_alone(self) -> bool:
        """Whether the proposition is independent of the document: it uses no row and no symbol of a notation."""
        return not self.rows and not self.symbols


def proposition(text: str, words: Words, *, own: bool = False) -> Proposition:
    """Read a proposition; with `own` it may refer to the printed text of its own row as ``printed``."""
    if len(text) > MAX_LENGTH:
        raise BadInput(f"longer than {MAX_LENGTH} characters; split it into parts")
    measured(text, judging=True, relations=True)
    line = " ".join(text.split())
    tree = parsed(line, text, "a proposition")
    check = _Check(words, own)
    check.visit(tree)
    return Proposition(text, tree, tuple(dict.fromkeys(keys_in(tree))), tuple(check.symbols))


def explanation(text: str, words: Words, *, own: bool = False) -> tuple[str | Proposition, ...]:
    """Read an explanation with terms in braces, and return its texts and terms in order."""
    parts = _BRACES.split(text)
    if any(brace in part for part in parts[::2] for brace in "{}"):
        raise BadInput("a brace has no matching brace; write a term between { and }")
    return tuple(proposition(part, words, own=own) if k % 2 else part for k, part in enumerate(parts) if part)


def is_proposition(text: str) -> bool:
    """Return whether a text is a relation or a combination of relations, and not a formula or an address."""
    try:
        tree = ast.parse(text.strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return False
    denied = isinstance(tree, ast.UnaryOp) and isinstance(tree.op, ast.Not)
    named = isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id
    return denied or isinstance(tree, ast.Compare | ast.BoolOp) or named in (*QUANTIFIERS, *CONNECTIVES)


def shape(tree: ast.expr) -> str:
    """Return the form of a proposition with numbers, texts, lists and attributes masked."""

    class Masked(ast.NodeTransformer):
        def visit_Constant(self, _: ast.Constant) -> ast.Name:
            return ast.Name("_", ast.Load())

        def visit_Attribute(self, node: ast.Attribute) -> ast.Attribute:
            return ast.Attribute(self.visit(node.value), "_", ast.Load())

        def visit_List(self, _: ast.List) -> ast.Name:
            return ast.Name("_", ast.Load())

    return ast.unparse(Masked().visit(ast.parse(ast.unparse(tree), mode="eval").body))


def matching(key: str) -> Callable[[str], bool]:
    """Return a test whether a row is meant by a key; a key that ends in a star means all keys that begin alike."""
    return lambda name: name.startswith(key[:-1]) if key.endswith("*") else name == key


def keys_in(tree: ast.AST) -> list[str]:
    """Return the keys of the rows that a tree looks up."""
    return [
        row_key(node)
        for node in ast.walk(tree)
        if isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and node.value.id in LOOKUPS
    ]


def row_key(node: ast.Subscript) -> str:
    """Return the key of the row that ``row['item']`` or ``row['item', 'part']`` refers to."""
    parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
    if not all(isinstance(part, ast.Constant) and isinstance(part.value, str) for part in parts):
        raise BadInput("the index of a row must be its item and part in quotes, as in row['2.19', 'k1']")
    return " ".join(str(part.value) for part in parts if isinstance(part, ast.Constant))


class _Check(ast.NodeVisitor):
    """Check that refuses kinds of nodes that are not allowed, and unknown names."""

    def __init__(self, words: Words, own: bool) -> None:
        self._words, self._own = words, own
        self._bound: list[str] = []
        self.symbols: dict[str, None] = {}

    def generic_visit(self, node: ast.AST) -> None:
        if not isinstance(node, _ALLOWED):
            what = _WORDS.get(type(node), f"this ({type(node).__name__})")
            raise BadInput(f"{what} is not allowed here{column(node)}")
        super().generic_visit(node)

    def visit_Name(self, node: ast.Name) -> None:
        words = self._words
        if node.id in self._bound or node.id in words.values:
            return
        if node.id in words.symbols or node.id == ITEMS or (self._own and node.id == PRINTED):
            self.symbols[node.id] = None
            return
        known = [*self._bound, *words.values, *words.symbols]
        hint = "is a measurement; give its arguments in brackets" if node.id in words.functions else ""
        raise BadInput(f"{shown(node.id)} {hint or f'is unknown here; {suggestion(node.id, known)}'}{column(node)}")

    def visit_Attribute(self, node: ast.Attribute) -> None:
        if node.attr.startswith("_"):
            raise BadInput(f"{shown(node.attr)} is not a permitted attribute{column(node)}")
        self.visit(node.value)

    def visit_Subscript(self, node: ast.Subscript) -> None:
        if isinstance(node.value, ast.Name) and node.value.id in LOOKUPS:
            row_key(node)
            return
        if isinstance(node.value, ast.Name) and node.value.id == MEANINGS:
            if not (isinstance(node.slice, ast.Constant) and isinstance(node.slice.value, str)):
                raise BadInput(f"the index must be one quoted symbol, as in meanings['x1']{column(node)}")
            self.symbols[MEANINGS] = None
            return
        self.generic_visit(node)

    def visit_Call(self, node: ast.Call) -> None:
        if not isinstance(node.func, ast.Name):
            raise BadInput(f"only a function given by its name can be called here{column(node)}")
        name = node.func.id
        if name in QUANTIFIERS:
            if len(node.args) != 1 or node.keywords:
                raise BadInput(f"{name} takes one argument, a comprehension or a list{column(node)}")
        elif name in CONNECTIVES:
            if len(node.args) != 2 or node.keywords:
                raise BadInput(f"{name} takes two propositions{column(node)}")
        elif name not in self._words.functions:
            known = [*self._words.functions, *QUANTIFIERS, *CONNECTIVES]
            raise BadInput(f"the measurement {shown(name)} is unknown{column(node)}; {suggestion(name, known)}")
        else:
            self._check_arguments(name, node)
        for argument in [*node.args, *(keyword.value for keyword in node.keywords)]:
            self.visit(argument)

    def _check_arguments(self, name: str, node: ast.Call) -> None:
        signature = inspect.signature(self._words.functions[name])
        if any(keyword.arg is None for keyword in node.keywords):
            raise BadInput(f"** is not allowed here{column(node)}")
        try:
            signature.bind(*node.args, **{str(keyword.arg): keyword.value for keyword in node.keywords})
        except TypeError as error:
            raise BadInput(f"{name}: {error}; its arguments are {', '.join(signature.parameters) or 'none'}") from None

    def _visit_comprehension(self, node: ast.GeneratorExp | ast.ListComp) -> None:
        before = list(self._bound)
        for part in node.generators:
            self.visit(part.iter)
            targets = part.target.elts if isinstance(part.target, ast.Tuple) else [part.target]
            for target in targets:
                if not isinstance(target, ast.Name) or target.id in {*self._words.values, *self._words.functions}:
                    raise BadInput(f"use a new name for the members{column(part.target)}")
                self._bound.append(target.id)
            for condition in part.ifs:
                self.visit(condition)
        self.visit(node.elt)
        self._bound = before

    visit_GeneratorExp = _visit_comprehension
    visit_ListComp = _visit_comprehension
