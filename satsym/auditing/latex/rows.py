"""A formula as its lines, and these as the sides of equations: before any of it is read."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

from satsym.auditing.latex.tokens import Token, Unread, group_end
from satsym.auditing.latex.words import EQUALS, RELATIONS, SKIPPED_GROUPS, SPACES, SYSTEMS, TIMES, UPRIGHT


def without_remarks(found: Sequence[Token]) -> list[Token]:
    """The tokens without spaces, labels and alignment."""
    kept: list[Token] = []
    i = 0
    while i < len(found):
        token = found[i]
        i += 1
        if token.kind == "macro" and token.text == "boxed" and i < len(found) and found[i].kind == "open":
            end = group_end(found, i)
            found = [*found[: i - 1], *found[i + 1 : end - 1], *found[end:]]
            i -= 1
        elif token.kind == "macro" and token.text in SKIPPED_GROUPS:
            if token.text == "hspace":  # parts equations, as a wide space does
                kept.append(replace(token, text="quad"))
            i += 1 if i < len(found) and found[i].text == "*" else 0
            i = group_end(found, i) if i < len(found) and found[i].kind == "open" else i
        elif token.kind == "macro" and token.text in ("left", "right", "middle") and i < len(found):
            if found[i].text == ".":  # no bracket on this side
                i += 1
        elif (token.kind == "macro" and token.text in SPACES - {"quad", "qquad", " "}) or token.text in ("~", "$"):
            continue
        else:
            kept.append(token)
    return kept


def lines(found: Sequence[Token]) -> list[list[list[Token]]]:
    """Equations, each as its sides: split at ends of lines, wide spaces and commas between equations."""
    pieces = [piece for row in _rows(found) for part in _equations(row) for piece in _at_commas(part)]
    done: list[list[list[Token]]] = []
    for piece in pieces:
        sides = _sides(piece)
        if not any(sides):
            continue
        first = sides[0][0] if sides[0] else None
        signed = first is not None and first.kind == "sign" and first.text in "+-"
        if done and not sides[0]:  # a line that begins with the equality sign goes on with the one before
            done[-1] += sides[1:]
        elif done and signed and (len(sides) == 1 or len(done[-1]) == 1):
            done[-1][-1] += sides[0]
            done[-1] += sides[1:]
        else:
            done.append(sides)
    with_sides = [line for line in done if len(line) > 1]
    if with_sides and (
        asked := next((t for line in done if len(line) == 1 for t in line[0] if t.text in RELATIONS), None)
    ):
        raise Unread("a condition beside the equations is not read", asked.at)
    return with_sides or done


def _rows(found: Sequence[Token]) -> list[list[Token]]:
    """Lines outside of brackets and matrices, and those of a system of equations."""
    rows: list[list[Token]] = [[]]
    depth, bracket, i = 0, 0, 0
    systems: list[bool] = []
    while i < len(found):
        token = found[i]
        i += 1
        if token.kind == "begin":
            system = token.text in SYSTEMS or (token.text == "array" and _is_system(found, i))
            systems.append(system)
            if system:
                if token.text in ("array", "alignedat") and i < len(found) and found[i].kind == "open":
                    i = group_end(found, i)
                rows[-1] = [] if all(t.text in ("{", "\\{", ".") for t in rows[-1]) else rows[-1]
                continue
        if token.kind == "end" and systems and systems.pop():
            continue
        inside = not all(systems)
        if token.kind == "macro" and token.text in ("\\", "cr") and not inside:
            if depth <= 0:  # else a bracket goes on in the next line
                rows.append([])
            if i < len(found) and found[i].text == "[":
                while i < len(found) and found[i].text != "]":
                    i += 1
                i += 1
        elif token.kind == "sign" and token.text == "&" and not inside:
            if not systems:
                raise Unread('a "&" outside of lines that are aligned', token.at)
            rows[-1].append(token)
        elif token.kind == "macro" and token.text in ("quad", "qquad", " "):
            if not inside and bracket:
                rows[-1].append(replace(token, text="quad"))  # parts the entries of a row
            elif not inside and depth == 0 and token.text != " ":
                rows.append([])
        else:
            depth += (token.kind == "open" or token.text in "([") - (token.kind == "close" or token.text in ")]")
            bracket = max(0, bracket + (token.text in "([") - (token.text in ")]")) if token.kind == "sign" else bracket
            rows[-1].append(token)
    return [row for row in rows if row]


def _equations(row: Sequence[Token]) -> list[list[Token]]:
    """The equations that stand side by side in a line whose columns are aligned."""
    pieces: list[list[Token]] = [[]]
    cells = split(row, lambda token: token.kind == "sign" and token.text == "&")
    for place, cell in enumerate(cells):
        after = cells[place + 1] if place + 1 < len(cells) else []
        before, first = pieces[-1], cell[0] if cell else None
        begun = first is None or _is_equals(first) or first.text in RELATIONS or first.text in TIMES | {"+", "-", ","}
        complete = _has_equality(before) and not _is_equals(before[-1])
        begins = bool(cell) and bool(after) and _is_equals(after[0])
        if complete and (begins or _has_equality(cell) or _is_remark(cell)):
            pieces.append(list(cell))
        elif begun or not before or _is_equals(before[-1]):
            pieces[-1] += cell
        else:
            assert first is not None
            raise Unread("what stands in this column is no part of an equation", first.at)
    equations = [piece for piece in pieces if _has_equality(piece)]
    said = [token for piece in pieces if piece not in equations for token in piece if token.text in RELATIONS]
    if equations and said:
        raise Unread("a condition beside the equations is not read", said[0].at)
    return equations if len(pieces) > 1 else pieces


def _is_system(found: Sequence[Token], i: int) -> bool:
    """Whether the lines of an array are equations."""
    depth = 0
    for token in found[i:]:
        depth += (token.kind == "begin") - (token.kind == "end")
        if depth < 0:
            return False
        if depth == 0 and token.kind == "sign" and token.text == "=":
            return True
    return False


def _at_commas(found: Sequence[Token]) -> list[list[Token]]:
    """Equations between which commas stand; ends of sentences are left out."""
    parts = split(found, lambda token: token.kind == "sign" and token.text in ",;")
    for before, after in pairwise(part for part in parts if part):
        digits = before[-1]
        if digits.kind == after[0].kind == "number" and after[0].at == digits.at + len(digits.text) + 1:
            raise Unread("a comma in a number may part thousands or decimals", after[0].at - 1)
    kept = [part for part in (_without_stop(part) for part in parts) if part]
    if len(kept) > 1 and not all(_has_equality(part) for part in kept[:2]):
        equations = [part for part in kept if _has_equality(part)]
        said = [part for part in kept if not _has_equality(part)]
        if len(equations) == 1 and kept[0] is equations[0] and all(_is_remark(part) for part in said):
            return equations
        raise Unread("a comma has no meaning here", _between(found, kept))
    return kept


def _between(found: Sequence[Token], kept: Sequence[Sequence[Token]]) -> int:
    return next((t.at for t in found if t.text in ",;" and t.at > kept[0][-1].at), found[0].at)


def _is_remark(part: Sequence[Token]) -> bool:
    """Whether what follows an equation is a condition, in words or as a relation."""
    return any(t.text in RELATIONS or t.text in UPRIGHT for t in part)


def _without_stop(part: list[Token]) -> list[Token]:
    while part and part[-1].kind == "sign" and part[-1].text in ".,;:":
        part = part[:-1]
    return part


def _has_equality(part: Sequence[Token]) -> bool:
    return any(_is_equals(token) for token in part)


def _is_equals(token: Token) -> bool:
    return (token.kind == "sign" and token.text == "=") or (token.kind == "macro" and token.text in EQUALS)


def _sides(found: Sequence[Token]) -> list[list[Token]]:
    sides = split(found, _is_equals)
    return [part[:-1] if part and part[-1].text == ":" else part for part in sides]


def split(found: Sequence[Token], divides: Callable[[Token], bool]) -> list[list[Token]]:
    """The tokens between those that divide, outside of all brackets and environments."""
    parts: list[list[Token]] = [[]]
    depth = 0
    for token in found:
        depth += token.kind in ("open", "begin") or (token.kind == "sign" and token.text in "([")
        depth -= token.kind in ("close", "end") or (token.kind == "sign" and token.text in ")]")
        if depth == 0 and divides(token):
            parts.append([])
        else:
            parts[-1].append(token)
    return parts
