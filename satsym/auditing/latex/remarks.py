"""What of a formula is no mathematics: spaces, labels, words between formulas, which part these."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from satsym.auditing.latex.tokens import Token, group_end
from satsym.auditing.latex.words import CONNECTIVES, OPTIMA, SAID, SIGNS, SKIPPED_GROUPS, SPACES, UNITS, UPRIGHT

_BRACKETS = {"lbrack": "[", "rbrack": "]", "lparen": "(", "rparen": ")"}
REMARK = "remark"
"""The macro that stands for words between formulas."""


def without_remarks(found: Sequence[Token]) -> list[Token]:
    """The tokens without spaces, labels and alignment; for words between formulas a sign that parts these."""
    kept: list[Token] = []
    i = depth = 0
    while i < len(found):
        token = found[i]
        i += 1
        if token.kind == "macro" and token.text == "boxed" and i < len(found) and found[i].kind == "open":
            end = group_end(found, i)
            found = [*found[: i - 1], *found[i + 1 : end - 1], *found[end:]]
            i -= 1
        elif token.kind == "macro" and token.text == "underset" and (under := _underset(found, i)):
            found = [*found[: i - 1], *under, *found[group_end(found, group_end(found, i)) :]]
            i -= 1
        elif token.kind == "macro" and token.text == "ensuremath":
            continue
        elif token.kind == "macro" and token.text in _BRACKETS:
            kept.append(Token("sign", _BRACKETS[token.text], token.at))
            depth += 1 if token.text.startswith("l") else -1
        elif token.kind == "open" and i + 1 < len(found) and found[i].text in SIGNS and found[i + 1].kind == "close":
            kept.append(found[i])  # a sign in a group of its own
            i += 2
        elif token.kind == "macro" and token.text in SKIPPED_GROUPS:
            if token.text == "hspace":  # parts equations, as a wide space does
                kept.append(replace(token, text="quad"))
            i += 1 if i < len(found) and found[i].text == "*" else 0
            i = group_end(found, i) if i < len(found) and found[i].kind == "open" else i
        elif token.kind == "macro" and token.text in ("left", "right", "middle") and i < len(found):
            if found[i].text == ".":  # no bracket on this side
                i += 1
        elif (token.kind == "macro" and (token.text in SPACES - {"quad", "qquad", " "} or token.text.isspace())) or (
            token.text in ("~", "$")
        ):
            if token.text == " " or token.text.isspace():
                kept.append(replace(token, text=" "))
        elif token.kind == "macro" and token.text in UPRIGHT and i < len(found) and _is_spoken(found, i, depth):
            i = group_end(found, i)
            if depth and i < len(found) and found[i].text == ")":  # the bracket is one of the words
                kept.pop()
                i, depth = i + 1, depth - 1
            kept.append(replace(token, text=REMARK))
        elif token.kind == "macro" and token.text in CONNECTIVES and not depth:
            kept.append(replace(token, text=REMARK))
        else:
            depth += (token.text in "([") - (token.text in ")]") if token.kind == "sign" else 0
            kept.append(token)
    return kept


def _underset(found: Sequence[Token], i: int) -> list[Token]:
    """What is minimised over what stands below, as an index of the word; empty for other words."""
    end = group_end(found, i)
    if end >= len(found) or found[i].kind != "open" or found[end].kind != "open":
        return []
    above = found[end + 1 : group_end(found, end) - 1]
    word = "".join(t.text for t in above if t.kind == "letter" or t.text in OPTIMA)
    if word.removeprefix("operatorname") not in OPTIMA:
        return []
    at = found[i].at
    return [Token("macro", word, at), Token("sign", "_", at), *found[i:end]]


def _is_spoken(found: Sequence[Token], i: int, depth: int) -> bool:
    """Whether the group at a place is words of plain language, outside of brackets or all that stands in one."""
    if found[i].kind != "open":
        return False
    end = group_end(found, i)
    inside = [t for t in found[i + 1 : end - 1] if t.text not in "~$"]
    alone = depth == 1 and i > 1 and found[i - 2].text == "(" and end < len(found) and found[end].text == ")"
    if not inside or (depth and not alone):
        return False
    said = inside[0].text + "".join(
        (" " if token.at > before.at + len(before.text) else "") + token.text for before, token in pairwise(inside)
    )
    plain = found[i - 1].text.startswith(("text", "mbox"))
    several = plain and " " in said and not all(word in UNITS for word in said.split())
    spoken = said.strip(" .,:;()").lower()
    if spoken.startswith("constant") or spoken == "otherwise":
        return False
    return alone or several or spoken in SAID or said.endswith(":") or (said[0] == "(" and said[-1] == ")")
