r"""The grammar of printed formulas, which turns tokens into trees and refuses all other input with its position.

Products may be written without a sign, arguments of functions without brackets (``\sin 2\theta``), letters as functions
of time (``x(t)``), and derivatives as dots, quotients or partial quotients. Adjacent letters are known names or
products; ambiguous ones are refused.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import pairwise

from satsym.auditing.latex import words
from satsym.auditing.latex.cursor import Reading, bar_in, refuse_unit
from satsym.auditing.latex.letters import GREEK
from satsym.auditing.latex.packages import put_in
from satsym.auditing.latex.parser import Parser
from satsym.auditing.latex.quotients import are_differentials
from satsym.auditing.latex.refusals import refuse_doubtful, refuse_repeated_indices
from satsym.auditing.latex.remarks import without_remarks
from satsym.auditing.latex.rows import lines, split
from satsym.auditing.latex.tokens import END, Token, Unread, braced, end_of, group_at
from satsym.auditing.latex.words import (
    CALLED,
    CONSTANT,
    DECORATIONS,
    RELATIONS,
    SAID,
    SIGNS,
    SPELLED,
    STARS,
    STYLES,
    UNITS,
    UPRIGHT,
)
from satsym.formula.tree import ZERO, Call, Equality, Grid, Mul, Node, Pow, Sym, calls_in, cells, children, walk

_READINGS = 3
"""Number of times that a formula is read at most until it is clear which of its letters have arguments."""

_LONG_WORD = 5
"""Number of adjacent letters, including vowels, from which they are read as a word."""
_GROUPS = frozenset("Re Fr Pr Nu Pe We Ro Kn St Bi Bo Sc Sh".split())
"""Names of dimensionless numbers that are printed as two letters."""
_UNITS = frozenset("rad deg kg Hz rpm mol".split())
"""Units of several letters that hardly ever are products of these letters."""
_SERIES = "xyz", "pid", "rpy"
"""Letters that number the members of a series, such as the gains of a controller."""
_SEPARATORS = frozenset(("\\\\", "quad", "qquad", "remark"))
"""Macros behind which a part of a formula begins."""
_SIGNS = frozenset(("cdot", "*"))
"""Multiplication signs: an author who writes them next to adjacent letters does not mean a product of these letters."""


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
    plain = put_in(found)
    refuse_doubtful(plain)
    kept = with_names(without_remarks(plain), names)
    refuse_leading_indices(kept)
    first = Reading([], lenient=True)
    with suppress(Unread):
        _read(kept, first, start)
    known = first.places
    for _ in range(_READINGS):  # what has an argument once, has one everywhere
        reading = _read(kept, _again(first, known), start)
        if reading.places == known:
            break
        known = reading.places
    reading.products = capitals(kept)
    refuse_powers_of_numbered(reading, start)
    if not reading.statements:
        raise Unread("there is no formula here", start)
    return reading


def _again(first: Reading, known: dict[str, set[str]]) -> Reading:
    """Return a new reading, with what was understood in the first one."""
    return replace(first, statements=[], letters={}, places={}, known=known, lenient=False, constants=False)


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
        if not reading.lenient:
            refuse_repeated_indices(sides, reading.letters, line.sides[0][0].at)
        for sign, side, (one, other) in zip(line.signs, line.sides[1:], pairwise(sides), strict=True):
            pair = line.sides[0][0].text == "[" and isinstance(one, Grid) and len(one.entries) == 2
            if pair and isinstance(one, Grid) and (sign == "=" or all(_is_capital(part) for part in one.entries)):
                one = Call("bracket", one.entries)
            braces = [side for side in (one, other) if isinstance(side, Call) and side.function == "braces"]
            if sign == "=" and braces and any(isinstance(side, Mul) for side in (one, other)):
                function = one.factors[0] if isinstance(one, Mul) and len(one.factors) == 2 else None
                if reading.lenient and isinstance(function, Sym):  # whose values are sets
                    reading.places.setdefault(function.name, set()).add("")
                    continue
                raise Unread(words.BRACES, line.sides[0][0].at)
            if sign != "=" and one == other:
                raise Unread("both sides of this relation are read as the same", side[0].at)
            if Sym("nabla") in (one, other):
                raise Unread("a nabla on its own is not a quantity", line.sides[0][0].at)
            if reading.differential >= 0 and not (sign == "=" and are_differentials(one, other)):
                raise Unread("differentials are not supported", reading.differential)
            taken = isinstance(one, Sym) and one.name in reading.places and line.sides[0][-1].text == ")"
            if sign == "=" and ((taken and _stands_in(one, other)) or _may_be_quaternion(one, other, reading)):
                raise Unread("this letter occurs both with and without an argument", line.sides[0][0].at)
            if sign == "element" and isinstance(other, Grid) and side[0].text == "(" and len(other.entries) == 2:
                other = Call("open_interval", other.entries)
            reading.statements.append(Equality(one, other) if sign == "=" else Call(sign, (one, other)))
    return reading


def _is_capital(node: Node) -> bool:
    """Return whether an expression is a capital letter."""
    return isinstance(node, Sym) and node.name[0].isupper()


def _stands_in(name: Node, tree: Node) -> bool:
    """Return whether a name is a factor or term of a tree, apart from derivatives."""
    if isinstance(tree, Call) and tree.function in ("diff", "d", "value", *words.NOT_COMPARED):
        return False
    return tree == name or any(_stands_in(name, part) for part in children(tree))


def _may_be_quaternion(rate: Node, tree: Node, reading: Reading) -> bool:
    """Return whether the letter of a rate stands before a bracket with a zero and more, as in q' = q (0, w) / 2."""
    letter = reading.letters.get(rate.name) if isinstance(rate, Sym) else None
    if letter is None or not letter.dots:
        return False
    taken = (call.arguments for call in calls_in(tree) if call.function == "value" and len(call.arguments) > 2)
    return any(of == Sym(letter.still.name) and first == ZERO for of, first, *_ in taken)


def _runs(found: Sequence[Token]) -> Iterator[tuple[int, int]]:
    """Yield the positions of runs of adjacent letters, as first position and position after the last letter."""
    begin = 0
    for k in range(1, len(found) + 1):
        before, token = found[k - 1], found[k] if k < len(found) else found[0]
        if not (token.kind == before.kind == "letter" and token.at == before.at + 1):
            if found[begin].kind == "letter" and k - begin > 1:
                yield begin, k
            begin = k


def with_names(found: list[Token], names: Collection[str]) -> list[Token]:
    """Return the tokens with letters that spell a known name set upright."""
    for begin, end in reversed(list(_runs(found))):
        if "".join(t.text for t in found[begin:end]) in names:
            at = found[begin].at
            found = [*found[:begin], Token("macro", "mathrm", at), *braced(found[begin:end], at), *found[end:]]
    return found


def capitals(found: Sequence[Token]) -> list[str]:
    """Return runs of adjacent capitals of which none occurs elsewhere on its own.

    They are products unless they are names.
    """
    runs: dict[str, None] = {}
    for begin, end in _runs(found):
        if begin and found[begin - 1].text in ("^", "_"):  # the first one is an index in front of the others
            continue
        upright = begin > 1 and found[begin - 1].kind == "open" and found[begin - 2].kind == "macro"
        letters = [t.text for t in found[begin:end]]
        if not upright and all(letter.isupper() for letter in letters):
            others = {t.text for k, t in enumerate(found) if t.kind == "letter" and not begin <= k < end}
            if not others & set(letters):
                runs["".join(letters)] = None
    return list(runs)


def refuse_spelled_name(line: Sequence[Sequence[Token]]) -> None:
    """Refuse adjacent capitals that could be a name or a product, as in ``SO(3)`` or on the left of a definition."""
    lone = capitals([t for part in line for t in part])
    for part in line:
        refuse_sums_in_capitals(part)
        refuse_unit(part)
        for first, last in _runs(part):
            name, behind = "".join(t.text for t in part[first:last]), part[last : last + 3]
            grouped = sum((t.kind == "open") - (t.kind == "close") for t in part[:first]) > 0
            ends = part[first - 1].at + len(part[first - 1].text) if first else 0
            apart = first == 0 or part[first].at > ends, not behind or behind[0].at > part[last - 1].at + 1
            measured = first > 0 and part[first - 1].kind == "number" and name in UNITS
            measured &= not _is_labelled(part, first)
            measured &= not behind or behind[0].text in "/^,;)]" or behind[0].text in RELATIONS
            prefixed = first > 0 and part[first - 1].kind == "number" and name in UNITS and name[0] in "kMG"
            measured |= prefixed and name[1].isupper()
            if measured or (name in _UNITS and first and not _is_labelled(part, first)):
                raise Unread("this could be a unit or a factor; set units upright", part[first].at)
            spelled = len(name) >= _LONG_WORD and name not in CONSTANT and not grouped
            spelled &= sum(letter in "aeiou" for letter in name) > 1
            if spelled or (name in SAID and (len(name) == len(part) or all(apart))):
                raise Unread("words inside a formula are not supported", part[first].at)
            beside = {t.text for t in (*part[max(0, first - 1) : first], *behind[:1])}
            called = len(name) > 2 and name[0].isupper() and name[-2:].islower() and bool(set("aeiou") & set(name))
            called |= len(name) > 2 and name.isupper() and first == 0 and part[-1].text == ")"
            doubtful = called and bool(behind) and behind[0].text in ("(", "_")
            doubtful |= name in _GROUPS and beside <= {"(", ")", ","}
            doubtful |= _is_spelled(part, first, last) or _is_in_series(line, name)
            plain = name.islower() and len(name) > 2 and not name.endswith((*SPELLED, *CALLED))
            doubtful |= plain and _holds_one_term(part, last)
            if name.isupper():
                doubtful |= len(set(name)) == len(name) > 2 and name in lone
                doubtful |= name != "GM" and _holds_one_term(part, last)
                doubtful |= len(name) == len(part) and (len(name) > 2 or len(line) > 2)
                doubtful |= [t.kind for t in behind] == ["sign", "number", "sign"] and behind[0].text == "("
                doubtful |= name != "GM" and not beside.isdisjoint(_SIGNS)
                doubtful |= (beside == {"|"} and len(name) == 2) or _is_ratio(part, first, last)
            if doubtful:
                raise Unread(f"{name} could be one name, \\mathrm{{{name}}}, or a product", part[first].at)
    side = line[0]
    begin, end = next(_runs(side), (1, 1)) if side else (1, 1)
    if begin == 0 and all(t.text.isupper() for t in side[:end]) and (end == len(side) or side[end].text == "_"):
        name = "".join(t.text for t in side[:end])
        raise Unread(f"{name} could be one name, \\mathrm{{{name}}}, or a product, {' '.join(name)}", side[0].at)


def _is_spelled(part: Sequence[Token], first: int, last: int) -> bool:
    """Return whether adjacent letters could be a word: three or more with a vowel, none of which occurs elsewhere."""
    letters = [t.text for t in part[first:last]]
    if _is_labelled(part, first) or any(name in "".join(letters) for name in (*SPELLED, *CALLED, "const")):
        return False
    inner = letters[1:] if letters[0].isupper() else letters
    worded = len(letters) > 2 and all(map(str.islower, inner)) and any(letter in "aeiou" for letter in inner)
    return worded and "d" not in letters[::2] and len(set(letters)) == len(letters)


def _holds_one_term(part: Sequence[Token], k: int) -> bool:
    """Return whether a bracket with one term begins at a position, as behind the name of a function."""
    if k >= len(part) or not part[k].is_sign("("):
        return False
    inside = part[k + 1 : end_of(part, k, lambda token: token.is_sign("(") - token.is_sign(")")) - 1]
    timed = len(inside) == 1 and inside[0].text in ("t", "s", "k", "z", "tau")
    return bool(inside) and not timed and len(split(inside, lambda token: token.is_sign("+-"))) < 2


def _is_labelled(part: Sequence[Token], k: int) -> bool:
    """Return whether a token is in an index, or in letters that are set upright or as a vector."""
    depth = 0
    for place in range(k - 1, 0, -1):
        depth += part[place].group
        if depth > 0:
            depth = 0
            before = part[place - 1]
            if before.is_sign("_^") or before.is_macro(UPRIGHT | STYLES.keys()):
                return True
    return False


def _is_in_series(line: Sequence[Sequence[Token]], name: str) -> bool:
    """Return whether two letters could be a name with an index, as ``Kp`` beside ``Kd`` or ``Ix`` beside ``Iy``."""
    if len(name) != 2 or not name[0].isupper():
        return False
    runs = {"".join(t.text for t in part[a:b]) for part in line for a, b in _runs(part)}
    alone = {t.text for part in line for k, t in enumerate(part) if t.kind == "letter" and not _touches(part, k)}
    series = next((letters for letters in _SERIES if name[1] in letters), "")
    others = {run[1] for run in runs if len(run) == 2 and run[0] == name[0] and run[1] in series}
    return len(others) > 1 and not alone & others


def _touches(part: Sequence[Token], k: int) -> bool:
    """Return whether a letter is next to another letter."""
    beside = [part[j] for j in (k - 1, k + 1) if 0 <= j < len(part)]
    return any(t.kind == "letter" and abs(t.at - part[k].at) == 1 for t in beside)


def refuse_sums_in_capitals(part: Sequence[Token]) -> None:
    """Refuse a capital sigma or pi that could be a sign of a sum or product, as in a sum of forces."""
    for k, token in enumerate(part):
        if not token.is_macro(("Sigma", "Pi")):
            continue
        below = group_at(part, k + 2)[0] if k + 2 < len(part) and part[k + 1].text == "_" else []
        behind = part[k + 1].text if k + 1 < len(part) else ""
        forces = k == 0 and token.text == "Sigma" and behind in ("F", "M", "tau", "vec", "T")
        if forces or any(t.text == "=" for t in below):
            raise Unread("this capital letter could be a sign of a sum or product; write \\sum or \\prod", token.at)


def refuse_leading_indices(found: Sequence[Token]) -> None:
    """Refuse a superscript between two letters if superscripts are printed before letters elsewhere in the formula."""
    places = [k for k, token in enumerate(found) if token.is_sign("^_")]
    leading: dict[int, int] = {}
    for k in places:
        inside, end = group_at(found, k + 1)
        if (_begins(found, k) or k in leading.values()) and [t.text for t in inside] not in (["circ"], ["prime"]):
            leading[k] = end  # where another leading index may follow
    for k in places if leading else ():
        inside, end = group_at(found, k + 1)
        power = all(t.kind == "number" or t.text in ("-", "T", "top", "prime", "'", *STARS, *UPRIGHT) for t in inside)
        behind = found[end] if end < len(found) else END
        empty = behind.kind == "open" and found[end + 1].kind == "close"
        letter = behind.kind in ("letter", "open") or behind.is_macro(GREEK | DECORATIONS | UPRIGHT)
        apart = found[k].at > found[k - 1].at + len(found[k - 1].text) + (found[k - 1].kind == "macro")
        trailing = not _begins(found, k) and k not in leading and not empty
        trailing &= found[k].text == "^" or apart or found[k - 1].text == ")"
        if trailing and letter and (not power or found[k].text == "_"):
            raise Unread("it is not clear to which letter this leading index belongs", found[k].at)


def _begins(found: Sequence[Token], k: int) -> bool:
    """Return whether the index at a position belongs to the letter after the index."""
    while k and found[k - 1].is_macro(" "):
        k -= 1
    token = found[k - 1] if k else Token("macro", "quad", 0)
    if token.kind == "close" and k > 1 and found[k - 2].kind == "open":
        return True
    macro = token.kind == "macro" and (token.text in RELATIONS or token.text in SIGNS or token.text in _SEPARATORS)
    return macro or token.kind == "begin" or (token.kind in ("sign", "open") and token.text in "=+-*/([,;&{")


def _is_ratio(part: Sequence[Token], first: int, last: int) -> bool:
    r"""Return whether a run of capitals is divided by one with a common letter, as for lengths, ``\frac{AB}{AC}``."""
    above, between = {t.text for t in part[first:last]}, [t.kind for t in part[last : last + 2]]
    below = next((part[a:b] for a, b in _runs(part) if a == last + 2), [])
    whole = first > 1 and part[first - 2].text in ("frac", "tfrac", "dfrac") and between == ["close", "open"]
    return whole and not above.isdisjoint(t.text for t in below)


def refuse_powers_of_numbered(reading: Reading, start: int) -> None:
    """Refuse powers of a letter whose superscripts 0 and 1 are indices."""
    numbered = {name.rpartition("_upper_")[0] for name in reading.letters if name.endswith(("_upper_0", "_upper_1"))}
    for statement in reading.statements if numbered else ():
        for side in cells(statement):
            powers = [part.base for _, part in walk(side) if isinstance(part, Pow)]
            if any(isinstance(base, Sym) and base.name in numbered for base in powers):
                raise Unread(
                    "a letter that has superscript indices is also raised to a power, which is ambiguous", start
                )
