"""Division of a formula into lines, and of lines into the sides of their relations, before any side is read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import accumulate, pairwise

from satsym.auditing.latex import words
from satsym.auditing.latex.letters import GREEK
from satsym.auditing.latex.remarks import REMARK
from satsym.auditing.latex.tokens import COMMA_IN_NUMBER, END, Token, Unread, end_of, environment, group_end
from satsym.auditing.latex.words import CLOSING, COUNTERS, ELLIPSES, OPENING, OPTIMA, RELATIONS, SYSTEMS, TIMES, UPRIGHT

_GROUPED = 3
"""Number of digits that a comma parts from the others in a number."""


@dataclass
class Line:
    """A chain of relations: the expressions, and the relation signs between them."""

    sides: list[list[Token]]
    signs: list[str]

    @property
    def bare(self) -> bool:
        """Whether the line is an expression without relation sign."""
        return not self.signs


def lines(found: Sequence[Token]) -> list[Line]:
    """Return all relations as their sides, divided at line breaks, wide spaces, words and commas."""
    done: list[Line] = []
    begun: dict[int, Line] = {}
    for place, row in _rows(found):
        for piece in (piece for part in _equations(row) for piece in _at_commas(_at_colons(part))):
            line = _sides(piece)
            before = begun.get(place) or (begun[max(begun)] if begun else None)
            if not line.sides[0] and line.signs[0] == "tends":  # an arrow in front says that something follows
                del line.sides[0], line.signs[0]
            if done and place in begun:
                before = done[-1]
            signed = bool(line.sides[0]) and line.sides[0][0].is_sign("+-")
            if before is None and not line.sides[0]:
                raise Unread("an expression is missing before this sign", piece[0].at)
            goes_on = signed and before is not None and (line.bare or before.bare or line.sides[0][0].text == "+")
            if before is not None and (goes_on or not line.sides[0]):  # a line that begins with a sign
                before.sides[-1] += line.sides[0]
                before.sides += line.sides[1:]
                before.signs += line.signs
            else:
                done += _parted(line)
                before = done[-1]
            begun.setdefault(place, before)
    for line in done:
        _refuse_arrow(line)
    related = any(not line.bare for line in done)
    kept = [line for line in done if not (related and line.bare and _is_label(line.sides[0]))]
    bare = next((line.sides[0] for line in kept if line.bare and not _seeks(line.sides[0])), None)
    if related and bare:
        raise Unread("an expression without a relation stands beside an equation", bare[0].at)
    return kept


def _seeks(side: Sequence[Token]) -> bool:
    """Return whether an expression is sought to be least or greatest, under constraints that stand beside it."""
    said = "".join(t.text for t in side[:12] if t.text not in ("{", "operatorname", *UPRIGHT))
    return said.startswith(tuple(OPTIMA)) or "arg" in said


def _is_label(side: Sequence[Token]) -> bool:
    """Return whether a separate expression is only a number or star in brackets, or dots, and can be left out."""
    inside = [token for token in side if token.text not in "()."]
    domain = len(side) - side[0].is_macro("partial") == 1 and (side[-1].text[0].isupper() or side[0].text in ELLIPSES)
    return not inside or domain or (side[0].text == "(" and len(inside) == 1 and inside[0].kind != "letter")


def _parted(line: Line) -> list[Line]:
    """Return the equations that are connected by an implication arrow as separate lines."""
    if line.signs == ["tends"] * 3:  # what one quantity tends to follows from what another tends to
        return [Line(line.sides[:2], ["tends"]), Line(line.sides[2:], ["tends"])]
    for k, sign in enumerate(line.signs):
        if sign == "tends" and "=" in line.signs[:k] and "=" in line.signs[k + 1 :]:
            first = Line(line.sides[: k + 1], line.signs[:k])
            return [first, *_parted(Line(line.sides[k + 1 :], line.signs[k + 1 :]))]
    return [line]


def _refuse_arrow(line: Line) -> None:
    """Refuse an arrow that could mean a limit, an implication or a map, and other signs that end a chain."""
    for k, (sign, before) in enumerate(zip(line.signs, line.sides, strict=False)):
        at = (line.sides[k + 1] or before)[0].at
        if sign == "unequal" and "unequal" in line.signs[:-1]:
            raise Unread("inequalities in chains of relations are not supported", at)
        if sign == "=" and "element" in line.signs[:k]:
            raise Unread("it is not clear what is equal to this side of a chain", at)
        if sign == "tends" and len(line.signs) > 1 and line.signs[:-1] != ["="] * (len(line.signs) - 1):
            raise Unread("arrows between more than two expressions are not supported", at)


def _rows(found: Sequence[Token]) -> list[tuple[int, list[Token]]]:
    """Return the parts of each line between wide spaces, with the number of the line.

    Matrices and brackets are not divided.
    """
    rows: list[list[Token]] = [[]]
    places = [0]
    line = 0
    depth, bracket, i = 0, 0, 0
    systems: list[bool] = []
    levels: list[int] = []
    broken = False
    gaps: list[tuple[int, int]] = []
    while i < len(found):
        token = found[i]
        i += 1
        if token.kind == "begin":
            system = _is_system(found, i, token.text, rows[-1])
            systems.append(system)
            levels.append(-1 if system or token.text not in words.MATRICES else depth)
            if system:
                if token.text in ("array", "alignedat") and i < len(found) and found[i].kind == "open":
                    i = group_end(found, i)
                rows[-1] = [] if _is_brace(rows[-1]) else rows[-1]
                continue
        places += [line] * (len(rows) - len(places))
        if token.kind == "end" and systems:
            levels.pop()
            if systems.pop():
                i += i < len(found) and found[i].is_macro("}")  # a brace on the right of all equations
                continue
        inside = not all(systems)
        if token.is_macro(("\\", "cr")) and not inside:
            if depth <= 0 and not _goes_on(rows[-1]):  # else a bracket or a sum goes on in the next line
                line += 1
                rows.append([])
            elif depth <= 0:
                i += _repeats(found, i, rows[-1])
            broken = depth > 0
        elif token.is_sign("&") and not inside:
            if not systems:
                raise Unread('there is an "&" outside aligned lines', token.at)
            if depth <= 0 and not _goes_on(rows[-1]) and not _asks(rows[-1]):
                rows[-1].append(token)
        elif token.kind == "macro" and token.text == REMARK and not inside:
            if rows[-1] and depth == 0:
                empty = all(t.text == "&" for t in rows[-1])
                if not empty and (not _has_relation(rows[-1]) or _goes_on(rows[-1])):
                    raise Unread("words inside a formula are not supported", token.at)
                rows.append([])
        elif token.is_macro(("quad", "qquad", " ")):
            if levels[-1:] == [depth] and _are_entries(rows[-1][-1], found[i] if i < len(found) else END):
                raise Unread("this space could separate two entries or two factors", found[i].at)
            if not inside and bracket:
                if broken or (i < len(found) and found[i].text == "+"):
                    continue
                rows[-1].append(replace(token, text="quad"))  # parts the entries of a row
            elif not inside and depth == 0 and token.text == " ":
                gaps.append((len(rows) - 1, len(rows[-1])))
            elif not inside and depth == 0 and not _asks(rows[-1]) and not _goes_on(rows[-1]):
                rows.append([])
        else:
            broken = False
            depth += token.nesting if token.kind not in ("begin", "end") else 0
            bracket = max(0, bracket + token.nesting) if token.kind == "sign" else bracket
            rows[-1].append(token)
        places += [line] * (len(rows) - len(places))
    for k, gap in gaps:
        _refuse_gap(rows[k], gap)
    return [(place, row) for place, row in zip(places, rows, strict=True) if row]


def _are_entries(before: Token, behind: Token) -> bool:
    """Return whether two tokens with a space between them, in a matrix, could belong to two entries."""
    ends = before.kind in ("letter", "number", "close") or before.is_sign(")]") or before.text in GREEK
    return ends and (behind.kind in ("letter", "number", "open") or behind.is_macro(GREEK | words.DECORATIONS))


def _repeats(found: Sequence[Token], i: int, row: Sequence[Token]) -> int:
    """Return the number of tokens at the beginning of a line that repeat the sign at the end of the line before."""
    begin = i
    while i < len(found) and found[i].text == "&":
        i += 1
    again = i < len(found) and (found[i].kind, found[i].text) == (row[-1].kind, row[-1].text)
    return i + 1 - begin if again and row[-1].kind in ("sign", "macro") else 0


def _refuse_gap(row: Sequence[Token], gap: int) -> None:
    """Refuse a space that could separate two equations or two factors."""
    before, behind = row[:gap], row[gap:]
    if _has_relation(before) and _has_relation(behind):
        ends = before[-1], behind[0]
        if behind[0].text == "d":  # of an integral
            return
        if not any(_sign(token) or token.text in TIMES | {"+", "-", ",", ";", "&", "/", ":"} for token in ends):
            raise Unread("this space could separate two equations or two factors", behind[0].at)


def _is_brace(row: Sequence[Token]) -> bool:
    return all(t.text in ("{", "\\{", ".") for t in row)


def _goes_on(row: Sequence[Token]) -> bool:
    """Return whether a line ends with a sign after which the expression continues."""
    last = row[-1] if row else None
    if last is None:
        return False
    index = len(row) > 1 and row[-2].text in ("^", "_")
    if not index and (last.is_sign("+-") or _sign(last)):
        return True
    k = max((k for k, token in enumerate(row) if token.is_macro(("sum", "int"))), default=-1)
    end = k + 1
    while 0 < end < len(row) and row[end].text in ("_", "^"):
        end = group_end(row, end + 1)
    return k >= 0 and end >= len(row)


def _asks(row: Sequence[Token]) -> bool:
    """Return whether a line ends with the variables of an optimisation whose cost follows after a space."""
    for k in range(len(row) - 1, -1, -1):
        if row[k].is_macro((*OPTIMA, "lim")):
            end = group_end(row, k + 2) if k + 2 < len(row) and row[k + 2].kind == "open" else k + 3
            return end >= len(row)
    return False


def _equations(row: Sequence[Token]) -> list[list[Token]]:
    """Return the relations that stand side by side in a line with aligned columns."""
    pieces: list[list[Token]] = [[]]
    cells = split(row, lambda token: token.is_sign("&"))
    for cell, after in zip(cells, [*cells[1:], []], strict=True):
        before, first = pieces[-1], cell[0] if cell else END
        related = first is END or bool(_sign(first))
        complete = _has_relation(before) and not _sign(before[-1])
        follows = _has_relation(cell) or _is_remark(cell) or bool(after and _sign(after[0]))
        if complete and not related and follows:
            pieces.append(list(cell))
        elif related or first.text in TIMES | {"+", "-", ","} or not before or _sign(before[-1]):
            pieces[-1] += cell
        else:
            raise Unread("the entry in this column is not part of an equation", first.at)
    return pieces


def _is_system(found: Sequence[Token], i: int, name: str, before: Sequence[Token]) -> bool:
    """Return whether the lines of an environment are equations, not entries of a matrix or cases of one side."""
    if name in SYSTEMS:
        return not name.endswith("cases") or _is_brace([t for t in before if t.text not in ("&", ".")])
    if name != "array":
        return False
    inside = found[i - 1 : end_of(found, i - 1, environment)]
    depths = accumulate(map(environment, inside))
    return any(depth == 1 and token.is_sign("=") for token, depth in zip(inside, depths, strict=True))


def _at_commas(found: Sequence[Token]) -> list[list[Token]]:
    """Return the relations that are separated by commas, without full stops; lists are not divided."""
    parts = [
        piece
        for part in split(found, lambda token: token.is_sign(",;"))
        for listed in split(_unbracketed(part), lambda token: token.is_sign(",;"))
        for piece in ([listed[:1], listed[1:]] if _lacks_comma(listed) else [listed])
    ]
    parts = [piece for part in parts for piece in _before_condition(part)]
    listed = any(token.text in ELLIPSES for token in found)
    listed |= any(len(part) == 3 and part[0].text in COUNTERS and part[1].text == "=" for part in parts)
    for before, after in pairwise(part for part in parts if part):
        digits = before[-1]
        if listed and len(after[0].text) != _GROUPED:
            continue
        if digits.kind == after[0].kind == "number" and after[0].at == digits.at + len(digits.text) + 1:
            raise Unread(COMMA_IN_NUMBER, after[0].at - 1)
    kept = [part for part in (_without_stop(part) for part in parts) if part]
    if not any(_has_relation(part) for part in kept):
        return kept
    done: list[list[Token]] = []
    pending: list[Token] = []
    misplaced = False
    for place, part in enumerate(kept):
        if _has_relation(part):
            misplaced |= bool(pending) and next(filter(None, map(_sign, part))) == "="
            done.append([*pending, *part])
            pending = []
        elif done and _goes_on_as_list(done[-1], kept[place:]):
            done[-1] += [Token("sign", ",", part[0].at), *part]
        elif not (done and _is_remark(part)):
            misplaced |= not any(_has_relation(later) for later in kept[place:])
            pending += [*part, Token("sign", ",", part[-1].at)]
    if misplaced:
        comma = (t.at for t in found if t.text in ",;" and t.at > kept[0][-1].at)
        raise Unread("a comma is not allowed here", next(comma, found[0].at))
    return done


def _lacks_comma(part: Sequence[Token]) -> bool:
    """Return whether an ellipsis and the end of a list stand side by side, without a comma between them."""
    return len(part) == 2 and part[0].text in ELLIPSES and part[1].kind in ("letter", "number")


def _before_condition(part: list[Token]) -> list[list[Token]]:
    """Return a relation that ends with a number apart from the relation in brackets after it."""
    depth = 0
    for k in range(len(part) - 1, 1, -1):
        depth += (part[k].text == ")") - (part[k].text == "(")
        if depth <= 0:
            apart = depth == 0 and k < len(part) - 1 and part[k - 1].kind == "number" and part[k - 2].text not in "_^"
            inside = part[k + 1 : -1]
            return [part[:k], inside] if apart and _has_relation(part[:k]) and relation_in(inside).signs else [part]
    return [part]


def _at_colons(found: Sequence[Token]) -> list[Token]:
    """Return the tokens with colons between relations replaced by semicolons."""
    part, depths = list(found), list(accumulate(token.nesting for token in found))
    for k in range(1, len(part) - 1):
        colon = depths[k] == 0 and part[k].is_sign(":") and not _sign(part[k - 1]) and not _sign(part[k + 1])
        if colon and _has_relation(part[:k]) and _has_relation(part[k:]):
            part[k] = Token("sign", ";", part[k].at)
    return part


def _unbracketed(part: list[Token]) -> list[Token]:
    """Return a relation without brackets that enclose all of it."""
    depth = 0
    for place, token in enumerate(part):
        depth += (token.text == "(") - (token.text == ")")
        if depth <= 0 and place < len(part) - 1:
            return part
    return part[1:-1] if part and depth == 0 and _has_relation(part[1:-1]) else part


def _goes_on_as_list(relation: Sequence[Token], later: Sequence[Sequence[Token]]) -> bool:
    """Return whether the rest of a list follows a relation, such as in i = 0, ..., N."""
    rest = [relation[-1:]]
    for part in later:
        if _has_relation(part):
            break
        rest.append(part)
    if any(token.is_macro(ELLIPSES) for part in rest for token in part):
        return relation[-1].text != ")"  # else the vectors of a list of relations
    return relation[-1].text in ELLIPSES or all(len(part) == 1 and part[0].kind == "number" for part in rest)


def _is_remark(part: Sequence[Token]) -> bool:
    """Return whether the part after an equation consists of words."""
    return any(t.text in UPRIGHT for t in part)


def _without_stop(part: list[Token]) -> list[Token]:
    while part and part[-1].is_sign(".,;:"):
        part = part[:-1]
    return part


def _has_relation(part: Sequence[Token]) -> bool:
    return any(_sign(token) for token in part)


def _sign(token: Token) -> str:
    """Return the relation that a token denotes; empty if the token is no relation sign."""
    if token.is_sign("=") or token.is_macro(words.EQUALS):
        return "="
    return RELATIONS.get(token.text, "") if token.kind in ("macro", "sign") else ""


def _sides(found: Sequence[Token]) -> Line:
    """Return the expressions between the relation signs."""
    signs: list[Token] = []

    def divides(token: Token) -> bool:
        if _sign(token):
            signs.append(token)
        return bool(_sign(token))

    sides = split(found, divides)
    for sign, side in zip(signs, sides[1:], strict=True):
        if not side:
            raise Unread("an expression is missing after this sign", sign.at)
    return Line(sides, [_sign(sign) for sign in signs])


def relation_in(part: Sequence[Token]) -> Line:
    """Return the sides of a relation within another expression, such as the condition of a case."""
    return _sides(_without_stop([token for token in part if token.text not in (REMARK, "quad", "qquad", " ")]))


def split(found: Sequence[Token], divides: Callable[[Token], bool]) -> list[list[Token]]:
    """Return the tokens between dividing tokens, which are recognised outside of brackets and environments only."""
    parts: list[list[Token]] = [[]]
    depth = 0
    closing = max((k for k, token in enumerate(found) if token.is_macro(CLOSING)), default=-1)
    for k, token in enumerate(found):
        depth += token.nesting
        depth += token.is_macro(OPENING) - token.is_macro(CLOSING) if k <= closing else 0
        if depth == 0 and divides(token):
            parts.append([])
        else:
            parts[-1].append(token)
    return parts
