"""Removal of the parts of a formula that are not mathematics: spaces, labels, and the words that separate formulas."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

from satsym.auditing.latex import words
from satsym.auditing.latex.letters import GREEK
from satsym.auditing.latex.packages import height, underset
from satsym.auditing.latex.tokens import END, Token, group_at, group_end
from satsym.auditing.latex.words import CONNECTIVES, RELATIONS, SAID, SHORT_WORDS, SIGNS, SPACES, UNITS, UPRIGHT

_BRACKETS = {"lbrack": "[", "rbrack": "]", "lparen": "(", "rparen": ")"}
_LINED = ("boxed", "fbox", "underline", "overline")
"""Macros that draw a line or frame at a whole relation."""
_OVER = ("overset", "stackrel", "underset")
"""Macros that set a text above or below a sign."""
REMARK = "remark"
"""Name of the macro that replaces words between formulas."""
_DENIALS = frozenset("not unless nor except without instead never tidak bukan kecuali".split())
"""Words that change what the formulas beside them state."""
_ITALIC = frozenset(("for", "where", "with", "when", "and", "if", "s.t.", "s.t"))
"""Words that are recognised between formulas although they are set as letters."""
_LONGEST_WORD = max(map(len, _ITALIC))
"""Number of characters of the longest word that is recognised although it is set as letters."""
_NARROW = (";", ":", ">", "~", "medspace", "thickspace")
"""Spaces that are too narrow to separate formulas."""
_JOINED = {("|", "|"): "|", ("<", "<"): "ll", (">", ">"): "gg", (":", "="): "coloneq", ("=", ":"): "equiv"}
_JOINED |= {("<", "="): "le", (">", "="): "ge", ("=", ">"): REMARK}
"""Pairs of signs that are printed in place of one sign."""


def without_remarks(found: Sequence[Token]) -> list[Token]:
    """Return the tokens without spaces, labels and alignment, with separators in place of words between formulas."""
    removal = _Removal(found)
    while removal.i < len(removal.found):
        removal.step()
    return removal.kept


@dataclass
class _Removal:
    """Removal of what is not mathematics from the tokens of a formula, from left to right."""

    found: Sequence[Token]
    """The tokens of the formula; those behind the position may be replaced."""
    kept: list[Token] = field(default_factory=list)
    i: int = 0
    """Position of the next token."""
    depth: int = 0
    """Number of brackets that are open."""
    narrow: int = 0
    """Number of narrow spaces in a row."""

    def step(self) -> None:
        """Read the next token, with what belongs to it."""
        token = self.found[self.i]
        self.i += 1
        self.narrow = self.narrow + 1 if token.text in _NARROW or token.text.isspace() else 0
        steps = (self._look, self._spelled, self._group, self._skipped, self._space, self._words)
        if not any(step(token) for step in steps):
            self._sign(token)

    @property
    def _next(self) -> Token:
        """The token behind the last one that was read."""
        return self.found[self.i] if self.i < len(self.found) else END

    def _replaced(self, tokens: Sequence[Token], behind: int) -> None:
        """Put tokens in place of the last one and of those up to a position, and read them next."""
        self.found = [*self.found[: self.i - 1], *tokens, *self.found[behind:]]
        self.i -= 1

    def _look(self, token: Token) -> bool:
        """Read a macro or an empty group that only affects how formulas look; return whether the token is one."""
        found, i, first = self.found, self.i, self._next
        if token.is_macro(_LINED) and _is_relation(found, i, token.text == "boxed"):
            self._replaced(*group_at(found, i))
        elif token.is_macro(UPRIGHT) and _is_punctuation(found, i):
            self.kept.append(found[i + 1])
            self.i = group_end(found, i)
        elif token.kind == "open" and first.kind == "close" and _stands_empty(self.kept, found[i + 1 :]):
            self.i += 1
        elif token.is_macro("textcolor") and first.kind == "open":
            self.i = group_end(found, i)
        elif token.is_macro("underset") and (under := underset(found, i)):
            self._replaced(under, group_end(found, group_end(found, i)))
        elif token.is_macro("mathop") and [t.text for t in found[i : i + 2]] == ["{", "mathrm"]:
            end = group_end(found, i)
            self._replaced([replace(token, text="operatorname"), *found[i + 2 : end - 1]], end)
        elif token.is_macro("\\") and (end := height(found, i)):
            self.kept.append(token)
            self.i = end
        elif token.is_macro(_OVER) and (relation := _relation_under(found, i)):
            self._replaced([relation], group_end(found, group_end(found, i)))
        else:
            return token.is_macro("ensuremath")
        return True

    def _spelled(self, token: Token) -> bool:
        """Read what is spelled unusually: a parted sign, a word in letters, a named bracket, a text between lines."""
        found, i, kept = self.found, self.i, self.kept
        if token.text == "&" and kept and kept[-1].text == ":" and self._next.text == "=":
            kept[-1] = Token("macro", "coloneq", kept[-1].at)
            self.i += 1
        elif (end := _italic_word(found, i - 1)) and not self.depth and _standsapart(found, i - 2):
            kept.append(Token("macro", REMARK, token.at))
            self.i = end
        elif token.is_macro(_BRACKETS):
            kept.append(Token("sign", _BRACKETS[token.text], token.at))
            self.depth += 1 if token.text.startswith("l") else -1
        elif token.is_macro(("intertext", "shortintertext")) and i < len(found):
            kept.append(replace(token, text="\\"))
            self.i = group_end(found, i)
        else:
            return False
        return True

    def _group(self, token: Token) -> bool:
        """Read a group that contains a bracket or a sign and nothing else."""
        found, i, kept = self.found, self.i, self.kept
        if token.kind == "open" and _is_bracket(found, i - 1) and _stands_free(kept):
            end = group_end(found, i - 1)
            self.found = [*found[:i], *found[i : end - 1], *found[end:]]
            return True
        inside, end = group_at(found, i - 1)
        sign = token.kind == "open" and len(inside) == 1 and inside[0].text in SIGNS and not _is_script(kept)
        if sign:
            kept.append(inside[0])
            self.i = end
        return sign

    def _skipped(self, token: Token) -> bool:
        """Read a macro whose argument is skipped, or the size of a bracket."""
        found, i = self.found, self.i
        if token.is_macro(words.SKIPPED_GROUPS):
            if token.text == "hspace" and not _is_narrow(found, i):  # parts equations, as a wide space does
                self.kept.append(replace(token, text="quad"))
            i += self._next.text == "*"
            self.i = group_end(found, i) if found[i : i + 1] and found[i].kind == "open" else i
        elif token.is_macro(("left", "right", "middle")) and i < len(found):
            if found[i].text == ".":  # no bracket on this side
                bar = _bar_of(found, i)
                if bar:  # all between them is evaluated at a point
                    inside = [Token("sign", "(", token.at), *found[i + 1 : bar], Token("sign", ")", token.at)]
                    self.found = [*found[:i], *inside, *found[bar + 1 :]]
                else:
                    self.i += 1
        else:
            return False
        return True

    def _space(self, token: Token) -> bool:
        """Read a space, of which several together may be as wide as those that part equations."""
        blank = token.kind == "macro" and (token.text in SPACES - {"quad", "qquad", " "} or token.text.isspace())
        if not blank and token.text not in ("~", "$"):
            return False
        kept = self.kept
        if token.text == " " or token.text.isspace():
            kept.append(replace(token, text=" "))
        if self.narrow == 3:
            while kept and (kept[-1].kind, kept[-1].text) == ("macro", " "):
                kept.pop()
            kept.append(Token("macro", "quad", token.at))
        return True

    def _words(self, token: Token) -> bool:
        """Read words between formulas, or a sign that stands for such words."""
        found, i, kept = self.found, self.i, self.kept
        if token.is_macro(UPRIGHT) and has_formula(found, i, kept):
            self._replaced(apart(found, i), group_end(found, i))
        elif token.is_macro(UPRIGHT) and is_spoken(found, i, self.depth, kept):
            self.i = group_end(found, i)
            if self.depth and self.i < len(found) and found[self.i].text == ")":  # the bracket is one of the words
                kept.pop()
                self.i, self.depth = self.i + 1, self.depth - 1
            kept.append(replace(token, text=REMARK))
        elif token.is_macro(CONNECTIVES) and not self.depth:
            if any(t.kind in ("letter", "number") for t in found[i:]):  # else nothing follows it
                kept.append(replace(token, text=REMARK))
            self.i = _behind_variable(found, i) if token.text == "forall" else i
        else:
            return False
        return True

    def _sign(self, token: Token) -> None:
        """Keep a token, if need be in the usual notation."""
        kept = self.kept
        if kept and kept[-1].at == token.at - 1 and (joined := _joined(kept, token)):
            kept[-1] = Token("macro", joined, kept[-1].at)
        elif token.is_macro("_"):
            kept.append(Token("sign", "_", token.at))  # as it is escaped in Markdown
        else:
            self.depth += (token.text in "([") - (token.text in ")]") if token.kind == "sign" else 0
            kept.append(token)


def _bar_of(found: Sequence[Token], i: int) -> int:
    """Return the place of ``right`` before the bar with an index that closes an invisible bracket; 0 if none does."""
    depth = 1
    for k in range(i + 1, len(found) - 2):
        depth += (found[k].text == "left") - (found[k].text == "right") if found[k].kind == "macro" else 0
        if depth == 0:
            fraction = found[i + 1].text in ("frac", "dfrac") and group_end(found, group_end(found, i + 2)) == k
            return (
                k if found[k + 1].text in ("|", "vert", "rvert") and found[k + 2].text in "_^" and not fraction else 0
            )
    return 0


def _behind_variable(found: Sequence[Token], i: int) -> int:
    """Return the position after a letter that a space parts from the relation for all its values; else the same one."""
    k = i + 1
    while k + 1 < len(found) and found[k].text in ("_", "^"):
        k = group_end(found, k + 1) if found[k + 1].kind == "open" else k + 2
    space = k >= len(found) or found[k].text in ("~", "quad", "qquad", ":", ",") or found[k].text in SPACES
    if [t.text for t in found[k : k + 3 : 2]] in ([",", ","], [",", "in"], [",", "_"], [",", "&"]):
        return i  # a list of letters
    return k + 1 if space and (found[i].kind == "letter" or found[i].text in GREEK) else i


def _joined(kept: Sequence[Token], token: Token) -> str:
    """Return the sign that the last token and the next one are printed for; empty if they are signs of their own.

    A bar after the second one of a pair of bars stands alone.
    """
    joined = _JOINED.get((kept[-1].text, token.text), "")
    if joined != "|":
        return joined
    depth = bars = norms = 0
    for before in reversed(kept):
        depth += (before.kind == "close") - (before.kind == "open")
        if depth < 0 or (depth == 0 and (before.text in ("=", "&", "+", "-") or before.text in RELATIONS)):
            break
        bars += depth == 0 and before.is_sign("|")
        norms += depth == 0 and before.is_macro("|")
    closes = bars % 2 == 0 and norms % 2 == 0 and [t.text for t in kept[-2:-1]] != ["|"]
    return "" if closes else joined


def _relation_under(found: Sequence[Token], i: int) -> Token | None:
    """Return the relation sign that is printed with a text above or below it; ``None`` for other symbols."""
    end = group_end(found, i)
    inside, _ = group_at(found, end)
    is_sign = len(inside) == 1 and (inside[0].text in RELATIONS or inside[0].text in ("=", "equiv"))
    return inside[0] if is_sign and found[i].kind == found[end].kind == "open" else None


def _italic_word(found: Sequence[Token], i: int) -> int:
    """Return the position after a word between formulas that is set in letters; 0 if the letters spell none."""
    said, k = "", i
    while (
        k < min(len(found), i + _LONGEST_WORD)
        and found[k].kind in ("letter", "sign")
        and found[k].at == found[i].at + k - i
    ):
        said, k = said + found[k].text, k + 1
        if said in _ITALIC and (k == len(found) or found[k].kind == "macro" or found[k].text in "~&"):
            return k
    return 0


def _standsapart(found: Sequence[Token], i: int) -> bool:
    """Return whether the token at a position is no part of a product with the one after it."""
    return i < 0 or found[i].text in (",", "&", "~", "\\", "quad", "qquad", *SPACES)


def _is_relation(found: Sequence[Token], i: int, anything: bool) -> bool:
    """Return whether the group at a position contains a relation, or with `anything` whether it is not empty."""
    inside = group_at(found, i)[0] if i < len(found) and found[i].kind == "open" else []
    return (anything and bool(inside)) or any(t.text == "=" or t.text in RELATIONS for t in inside)


def _is_punctuation(found: Sequence[Token], i: int) -> bool:
    """Return whether the group at a position contains only a comma, semicolon or full stop."""
    return [t.kind for t in found[i : i + 3]] == ["open", "sign", "close"] and found[i + 1].text in ",.;"


def _stands_empty(kept: Sequence[Token], behind: Sequence[Token]) -> bool:
    """Return whether an empty group only affects the space before the next sign."""
    free = not kept or kept[-1].text in ("&", "\\") or (kept[-1].kind == "sign" and kept[-1].text not in "^_")
    return free and bool(behind) and behind[0].is_sign("+-=")


def _is_script(kept: Sequence[Token]) -> bool:
    """Return whether the next token is a subscript or superscript."""
    return bool(kept) and kept[-1].is_sign("^_")


def _is_bracket(found: Sequence[Token], i: int) -> bool:
    """Return whether a group contains one bracket and nothing else."""
    end = group_end(found, i)
    depth = 0
    inside = [token for token in found[i + 1 : end - 1] if token.text not in ("left", "right")]
    for place, token in enumerate(inside):
        depth += (token.text == "(") - (token.text == ")")
        if depth <= 0 and place < len(inside) - 1:
            return False
    return len(inside) > 1 and depth == 0


def _stands_free(kept: Sequence[Token]) -> bool:
    """Return whether the next group is neither an argument nor a subscript or superscript."""
    if not kept or kept[-1].text in GREEK:
        return True
    return kept[-1].kind not in ("macro", "close", "begin") and not _is_script(kept)


def _is_narrow(found: Sequence[Token], i: int) -> bool:
    """Return whether a space has zero or negative width."""
    inside = found[i + 1 : group_end(found, i)]
    return bool(inside) and (inside[0].text == "-" or inside[0].text.strip("0.") == "")


def has_formula(found: Sequence[Token], i: int, kept: Sequence[Token]) -> bool:
    """Return whether words at a position contain formulas with relations, and are not an index."""
    index = any(token.text in "^_" for token in kept[-2:])
    inside = found[i : group_end(found, i)] if i < len(found) and found[i].kind == "open" else []
    related = any(token.text == "=" or token.text in RELATIONS for token in inside)
    return not index and related and sum(token.text == "$" for token in inside) in (2, 4)


def _is_sign(token: Token) -> bool:
    """Return whether a macro is a sign of a relation or product, or separates formulas."""
    return token.text in RELATIONS or token.text in SIGNS or token.text in CONNECTIVES or token.text in ("\\", REMARK)


def apart(found: Sequence[Token], i: int) -> list[Token]:
    """Return the words at a position and the formulas between them as separate parts."""
    macro, opening = found[i - 1], found[i]
    parts: list[Token] = []
    spoken: list[Token] = []
    formula = False
    for token in [*found[i + 1 : group_end(found, i) - 1], replace(opening, text="$")]:
        if token.text != "$":
            (parts if formula else spoken).append(token)
            continue
        if any(t.kind == "letter" for t in spoken):
            parts += [macro, opening, *spoken, replace(opening, kind="close", text="}")]
        spoken, formula = [], not formula
    return parts


def is_spoken(found: Sequence[Token], i: int, depth: int, kept: Sequence[Token]) -> bool:
    """Return whether the group at a position is plain language, either outside brackets or alone within one."""
    index = any(token.text in "^_" for token in kept[-2:-1] if kept[-1].kind == "open")
    index |= bool(kept) and kept[-1].is_sign("^_")
    if index or i >= len(found) or found[i].kind != "open":
        return False
    end = group_end(found, i)
    inside = [t for t in found[i + 1 : end - 1] if t.text not in "~$"]
    alone = depth == 1 and i > 1 and found[i - 2].text == "(" and end < len(found) and found[end].text == ")"
    before = kept[-2] if len(kept) > 1 else None
    functional = before is not None and before.kind == "macro" and before.text not in SPACES and not _is_sign(before)
    alone = alone and (before is None or not (before.kind in ("letter", "close") or functional))
    if not inside or (depth and not alone):
        return False
    said = inside[0].text + "".join(
        (" " if token.at > before.at + len(before.text) else "") + token.text for before, token in pairwise(inside)
    )
    plain = found[i - 1].text.startswith(("text", "mbox"))
    several = plain and " " in said and not all(word in UNITS for word in said.split())
    spoken = said.strip(" .,:;()").lower()
    if spoken.startswith("constant") or spoken == "otherwise" or not _DENIALS.isdisjoint(spoken.split()):
        return False
    if _is_condition(kept) and not SAID.issuperset(set(spoken.split()) - {"all"}):
        return False
    measured = next((t for t in reversed(kept) if t.text != " "), END).kind == "number"
    if measured and inside[0].kind == "letter" and said.split()[0].lower() not in SAID | SHORT_WORDS:
        return False
    padded = inside[0].at > found[i].at + 1 or found[end - 1].at > inside[-1].at + len(inside[-1].text)
    behind = found[end] if end < len(found) else None
    between = bool(kept) and behind is not None and behind.kind in ("letter", "macro", "open")
    between &= behind is not None and behind.text not in ("\\\\", "quad", "qquad", "text")
    between &= any(t.text == "=" or t.text in RELATIONS for t in found[end:])  # another formula follows the word
    worded = spoken in SAID | SHORT_WORDS or (plain and padded and between and len(spoken) > 2 and spoken not in UNITS)
    worded |= plain and any(ord(c) > 0x3FF and c.isalpha() for c in spoken)
    return alone or several or worded or said.endswith(":") or (said[0] == "(" and said[-1] == ")")


def _is_condition(kept: Sequence[Token]) -> bool:
    """Return whether the next token stands in the condition of a case, of which no word may be left out."""
    begins = [k for k, token in enumerate(kept) if token.group and token.text.endswith("cases")]
    if not begins or kept[begins[-1]].kind != "begin":
        return False
    row = list(kept[begins[-1] + 1 :])
    while any(token.is_macro("\\") for token in row):
        row = row[next(k for k, token in enumerate(row) if token.is_macro("\\")) + 1 :]
    cells = [token.text for token in row]
    return "&" in cells and "=" not in cells[: cells.index("&")] and len(cells) > cells.index("&") + 1
