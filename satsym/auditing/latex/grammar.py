r"""The grammar of printed formulas, which turns tokens into trees and refuses all other input with its position.

Products may be written without a sign, arguments of functions without brackets (``\sin 2\theta``), letters as functions
of time (``x(t)``), and derivatives as dots, quotients or partial quotients.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from contextlib import suppress
from itertools import pairwise

from satsym.auditing.latex import words
from satsym.auditing.latex.cursor import Reading, bar_in
from satsym.auditing.latex.names import capitals, refuse_powers_of_numbered, refuse_spelled_name, with_names
from satsym.auditing.latex.packages import put_in
from satsym.auditing.latex.parser import Parser
from satsym.auditing.latex.quotients import are_differentials
from satsym.auditing.latex.remarks import without_remarks
from satsym.auditing.latex.rows import lines
from satsym.auditing.latex.tokens import Token, Unread
from satsym.formula.tree import Call, Equality, Grid, Mul, Node, Sym, children

_READINGS = 3
"""Number of times that a formula is read at most until it is clear which of its letters have arguments."""


def read(found: Sequence[Token], text: str, start: int = 0, names: Collection[str] = ()) -> Reading:
    """Read the equations and expressions of a formula.

    Parameters
    ----------
    found
        The tokens of the formula.
    text, start
        The text of the tokens, and the position of its first character in the document.
    names
        Known names of several letters, which need not be printed upright.

    Raises
    ------
    Unread
        At the first part that does not belong to the grammar.
    """
    kept = with_names(without_remarks(put_in(found)), names)
    first = Reading([], lenient=True)
    with suppress(Unread):
        _read(kept, first, start)
    known = first.places
    for _ in range(_READINGS):  # what has an argument once, has one everywhere
        reading = _read(kept, Reading([], known=known, transposing=first.transposing), start)
        if reading.places == known:
            break
        known = reading.places
    reading.products = capitals(kept)
    refuse_powers_of_numbered(reading, start)
    if not reading.statements:
        raise Unread("there is no formula here", start)
    return reading


def _read(kept: Sequence[Token], reading: Reading, start: int) -> Reading:
    for line in lines(kept):
        refuse_spelled_name(line.sides)
        colon = bar_in(line.sides[0], colon=True) if line.signs == ["tends"] else -1
        if colon > 0 and line.sides[0][colon].text == ":":  # a function between two sets
            parts = [line.sides[0][:colon], line.sides[0][colon + 1 :], line.sides[1]]
            reading.statements.append(Call("maps", tuple(Parser(part, reading, start).side() for part in parts)))
            continue
        reading.differential = -1
        sides = [Parser(part, reading, start).side() for part in line.sides]
        if reading.differential >= 0 and line.bare:
            raise Unread("differentials are not supported", reading.differential)
        reading.statements += sides if line.bare else []
        for sign, side, (one, other) in zip(line.signs, line.sides[1:], pairwise(sides), strict=True):
            if sign == "=" and line.sides[0][0].text == "[" and isinstance(one, Grid) and len(one.entries) == 2:
                one = Call("bracket", one.entries)
            braces = [side for side in (one, other) if isinstance(side, Call) and side.function == "braces"]
            if sign == "=" and braces and any(isinstance(side, Mul) for side in (one, other)):
                function = one.factors[0] if isinstance(one, Mul) and len(one.factors) == 2 else None
                if reading.lenient and isinstance(function, Sym):  # whose values are sets
                    reading.places.setdefault(function.name, set()).add("")
                    continue
                raise Unread(
                    "braces could enclose a set here; write round brackets around a product", line.sides[0][0].at
                )
            if Sym("nabla") in (one, other):
                raise Unread("a nabla on its own is not a quantity", line.sides[0][0].at)
            if reading.differential >= 0 and not (sign == "=" and are_differentials(one, other)):
                raise Unread("differentials are not supported", reading.differential)
            taken = isinstance(one, Sym) and one.name in reading.places and line.sides[0][-1].text == ")"
            if sign == "=" and taken and _stands_in(one, other):
                raise Unread("this letter occurs both with and without an argument", line.sides[0][0].at)
            if sign == "element" and isinstance(other, Grid) and side[0].text == "(" and len(other.entries) == 2:
                other = Call("open_interval", other.entries)
            reading.statements.append(Equality(one, other) if sign == "=" else Call(sign, (one, other)))
    return reading


def _stands_in(name: Node, tree: Node) -> bool:
    """Return whether a name is a factor or term of a tree, apart from derivatives."""
    if isinstance(tree, Call) and tree.function in ("diff", "d", "value", *words.NOT_COMPARED):
        return False
    return tree == name or any(_stands_in(name, part) for part in children(tree))
