"""Base of the parsers that read the tokens of one side of an equation from left to right."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Self

from satsym.auditing.latex.letters import Letter
from satsym.auditing.latex.tokens import END, Token, Unread, braced, group_end
from satsym.auditing.latex.words import (
    CLOSING,
    DECORATIONS,
    MARKS,
    OPENING,
    REFUSED,
    RELATIONS,
    UNITS,
    UPRIGHT,
)
from satsym.formula.tree import Call, Equality, Grid, Node, Pow, Sym, symbols, walk
from satsym.wording import printable

CONSTANT = "constant"
"""Name of a constant of unspecified value: a quantity equated with it does not change in time."""

_MEASURED = 10
"""Number from which a number before one letter measures something, rather than being a factor."""
MIXED_BRACKETS = "brackets of different kinds, as around a half-open interval, are not supported"


@dataclass
class Reading:
    """Result of reading a formula: equations and expressions, and the printed letter of each name."""

    statements: list[Node | Equality]
    letters: dict[str, Letter] = field(default_factory=dict)
    """Name in the trees -> the printed letter."""
    places: dict[str, set[str]] = field(default_factory=dict)
    """Name -> the arguments with which the letter is printed, apart from time."""
    known: dict[str, set[str]] = field(default_factory=dict)
    """Value of `places` after a first reading of the formula, in which not every letter is understood yet."""
    lenient: bool = False
    """Whether a bracket that could hold an argument passes for a factor, until it is known which letters have any."""
    transposing: bool = False
    """Whether primes denote transposition in the formula."""
    matrices: set[str] = field(default_factory=set)
    """Names of capital letters that are inverted or transposed."""
    timed: set[str] = field(default_factory=set)
    """Names of letters that are printed as functions of time."""
    integrated: set[str] = field(default_factory=set)
    """Names of the variables of integration."""
    differential: int = -1
    """Position of a differential that belongs to no derivative or integral; -1 if there is none."""
    constants: bool = False
    """Whether the formula states that a quantity is constant."""
    products: list[str] = field(default_factory=list)
    """Adjacent capitals that were read as products, but could be names."""


class Cursor(ABC):
    """Tokens of one side of an equation, with the position up to which they are read.

    Parameters
    ----------
    found
        The tokens.
    reading
        The result, in which letters are recorded.
    start
        Position of the first character of the formula.
    """

    def __init__(self, found: Sequence[Token], reading: Reading, start: int, depth: int = 0) -> None:
        self._found, self._reading, self._start, self._depth = found, reading, start, depth
        self._i = 0

    def _of(self, part: Sequence[Token]) -> Self:
        """Return a new cursor for a part of the tokens, one level deeper."""
        return type(self)(part, self._reading, self._start, self._depth + 1)

    @abstractmethod
    def _inner(self, part: Sequence[Token], at: int) -> Node:
        """Return the tree of a part of the tokens, read completely."""

    @abstractmethod
    def _sum(self) -> Node:
        """Read the next sum."""

    @abstractmethod
    def _product(self, argument: bool = False) -> Node:
        """Read the next term."""

    @abstractmethod
    def _factor(self) -> Node:
        """Read the next factor."""

    @abstractmethod
    def _signed_factor(self) -> Node:
        """Read the next factor, which may have a sign."""

    @abstractmethod
    def _bracket(self) -> Node:
        """Read the contents of the next bracket."""

    @abstractmethod
    def _cases(self, rows: Sequence[Sequence[Token]], at: int) -> Node:
        """Read the values of a case distinction with their conditions."""

    @abstractmethod
    def _taken(self, base: Node, script: list[Token], at: int) -> Node:
        """Read the subscript of a vertical bar, the point at which an expression is evaluated."""

    @abstractmethod
    def _condition(self, part: Sequence[Token], at: int) -> Node:
        """Read a place, relation or list of relations, with what it is given, as in brackets or below an operator."""

    @abstractmethod
    def _begins_factor(self, token: Token) -> bool:
        """Return whether a factor can begin with a token."""

    def _at(self, place: int) -> Token:
        """Return the token at a place; at any other place, the end of the formula."""
        return self._found[place] if 0 <= place < len(self._found) else END

    def _peek(self, ahead: int = 0) -> Token:
        return self._at(self._i + ahead)

    def _is(self, text: str, ahead: int = 0, kind: str = "sign") -> bool:
        token = self._peek(ahead)
        return token.kind == kind and token.text == text

    @property
    def _here(self) -> int:
        """Position of the next token, or of the last one at the end of the formula."""
        return self._found[min(self._i, len(self._found) - 1)].at

    def _is_bar_of_place(self) -> bool:
        """Return whether a vertical bar with an index comes next."""
        return self._peek().text in ("|", "vert", "rvert") and self._is("_", 1)

    def _accept(self, sign: str) -> bool:
        """Read a sign if it comes next, and return whether it does."""
        accepted = self._is(sign)
        self._i += accepted
        return accepted

    def _take(self) -> Token:
        if self._i >= len(self._found):
            last = self._at(len(self._found) - 1)
            raise Unread("the formula is incomplete", self._start if last is END else last.at + len(last.text))
        self._i += 1
        return self._found[self._i - 1]

    def _refuse(self) -> None:
        token = self._take()
        if token.is_macro(REFUSED):
            raise Unread(f"{REFUSED[token.text]} (\\{token.text}) is not supported", token.at)
        if token.is_macro("remark"):
            raise Unread("words inside a formula are not supported", token.at)
        if token.text in RELATIONS:
            raise Unread("relations inside brackets or arguments are not supported", token.at)
        sign = "\\" if token.kind == "macro" else ""
        raise Unread(f'"{sign}{printable(token.text)}" is not supported here', token.at)

    def _letter_of(self, node: Node, power: bool = False) -> Letter | None:
        """Return the printed letter of a name, or with `power` also of a power of a name; ``None`` for other trees."""
        if power and isinstance(node, Pow):
            node = node.base
        elif power and isinstance(node, Call) and node.function == "raised":
            node = node.arguments[0]
        return self._reading.letters.get(node.name) if isinstance(node, Sym) else None

    def _is_matrix(self, node: Node) -> bool:
        """Return whether an expression is a bold capital letter, a power of it, or a transpose."""
        if isinstance(node, Call):
            return node.function == "transpose"
        base = node.base if isinstance(node, Pow) else node
        return isinstance(base, Sym) and base.name[:1].isupper() and self._is_vector(base)

    def _has_matrix(self, node: Node) -> bool:
        """Return whether an expression contains a vector, a matrix or a capital letter."""
        return self._is_vector(node) or any(name[:1].isupper() for name in symbols(node))

    def _is_vector(self, node: Node) -> bool:
        """Return whether an expression contains letters that are typeset as vectors, or a matrix."""
        if isinstance(node, Call) and node.function == "diff":
            return any(map(self._is_vector, node.arguments))
        if isinstance(node, Call) and node.function in ("d", "value", "raised", "differential"):
            return self._is_vector(node.arguments[0])
        if isinstance(node, Call):
            return node.function in ("cross", "transpose", "gradient", "curl")
        letters = self._reading.letters
        return any(
            isinstance(part, Grid)
            or part == Sym("nabla")
            or (isinstance(part, Sym) and part.name in letters and letters[part.name].bold)
            for _, part in walk(node)
        )

    def _script(self) -> list[Token]:
        """Read the subscript or superscript after ``^`` or ``_``."""
        token = self._take()
        if token.kind == "open":
            end = group_end(self._found, self._i - 1)
            inside = list(self._found[self._i : end - 1])
            self._i = end
            return inside
        if token.kind == "number" and len(token.text) > 1:
            if self._peek(-2).text in ("^", "_"):
                raise Unread("an exponent or an index of several characters needs braces", token.at)
            return [self._first_digit(token)]
        if token.is_macro(DECORATIONS - MARKS.keys() | UPRIGHT):
            return [token, *self._group()]
        if token.is_macro(("frac", "tfrac", "dfrac")):
            return [token, *self._group(True), *self._group(True)]
        return [token]

    def _first_digit(self, number: Token) -> Token:
        """Return the first digit of a number that was read; the other digits are read next."""
        rest = Token("number", number.text[1:], number.at + 1)
        self._found = [*self._found[: self._i], rest, *self._found[self._i :]]
        return Token("number", number.text[0], number.at)

    def _script_end(self) -> int:
        """Return the position after the next subscript or superscript."""
        return group_end(self._found, self._i + 1) if self._is("{", 1, "open") else self._i + 2

    def _group(self, braces: bool = False) -> list[Token]:
        """Read the argument of a macro, which is a group in braces or a single token."""
        token = self._take()
        if token.kind != "open":
            if token.kind == "number" and len(token.text) > 1 and "." not in token.text:
                token = self._first_digit(token)
            inner = [token, *(self._group(True) if token.is_macro(DECORATIONS) else ())]
            return braced(inner, token.at) if braces else inner
        begin, end = self._i - 1, group_end(self._found, self._i - 1)
        self._i = end
        return list(self._found[begin:end] if braces else self._found[begin + 1 : end - 1])

    def _peek_group(self) -> list[Token]:
        if self._peek(1).kind != "open":
            return list(self._found[self._i + 1 : self._i + 2])
        return list(self._found[self._i + 2 : group_end(self._found, self._i + 1) - 1])

    def _up_to_end(self, nesting: Callable[[Token], int]) -> Sequence[Token]:
        """Read up to the end of a part whose beginning was read, and return the tokens in it, without the last one."""
        begin, depth = self._i, 1
        while depth:
            depth += nesting(self._take())
        return self._found[begin : self._i - 1]

    def _bracket_end(self, interval: bool = False) -> int:
        """Move past the bracket that closes the next one, of an interval of any kind, and return its position."""
        opening, depth = self._take(), 1
        groups = 0
        while depth:
            token = self._peek()
            if token is END:
                raise Unread("a bracket is not closed", opening.at)
            groups += token.group
            depth += token.nesting if groups == 0 and token.kind == "sign" else 0
            self._i += 1
        if not interval and self._found[self._i - 1].text != {"(": ")", "[": "]"}[opening.text]:
            raise Unread(MIXED_BRACKETS, opening.at)
        return self._i - 1


def listed(node: Node) -> tuple[Node, ...]:
    """Return the members of a list; of anything else, itself alone."""
    return node.arguments if isinstance(node, Call) and node.function == "list" else (node,)


def refuse_unit(part: Sequence[Token]) -> None:
    """Refuse a number with one letter that could be its unit, if nothing else stands there."""
    if [t.kind for t in part] == ["number", "letter"] and part[1].text in UNITS:
        number, letter = part
        apart = letter.at > number.at + len(number.text) + 1
        if apart or "." in number.text or float(number.text) >= _MEASURED:
            raise Unread("this could be a unit or a factor; set units upright", letter.at)


def are_units(part: Sequence[Token]) -> bool:
    """Return whether tokens spell only units, such as m/s or kg."""
    said = "".join(t.text for t in part if t.kind not in ("open", "close")).replace("cdot", " ")
    names = [name for name in re.split(r"[^A-Za-z]+", said) if name]
    return bool(names) and all(name in UNITS for name in names)


def bar_in(part: Sequence[Token], colon: bool = False) -> int:
    """Return the place of the bar, or with `colon` also the colon, after which conditions follow; -1 if none is there.

    Bars around an expression come in pairs, so that one of an odd number of them stands alone.
    """
    depth, bars = 0, []
    for k, token in enumerate(part):
        depth += token.nesting
        depth += token.kind == "macro" and (token.text in OPENING) - (token.text in CLOSING)
        if depth == 0 and (token.text == "mid" or (colon and token.text == ":")):
            return k
        if depth == 0 and token.text in ("|", "vert") and not token.is_macro("|"):
            bars.append(k)
    if len(bars) % 2 == 0:
        return -1
    if len(bars) == 1 and part[bars[0] + 1 : bars[0] + 2] and part[bars[0] + 1].text == "_":
        return -1  # the point at which something is evaluated
    return next((k for k in bars if 0 < k < len(part) - 1), -1)
