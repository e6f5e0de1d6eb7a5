"""Reading of letters with all decorations, such as indices, accents and superscripts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from satsym.auditing.latex.cursor import Cursor
from satsym.auditing.latex.letters import GREEK, Letter, cleaned, is_name
from satsym.auditing.latex.tokens import END, Token, Unread, braced, group_end, in_tex
from satsym.auditing.latex.words import (
    ACCENTS,
    BARS,
    CLOSING,
    DECORATIONS,
    ELLIPSES,
    INDICES,
    MARKS,
    OPENING,
    RELATIONS,
    SPACES,
    STARS,
    STYLES,
    TRANSPOSED,
    UPRIGHT,
)

_SAID = {"+": "plus", "-": "minus", "*": "star", "|": "given", "'": "prime", ":": "to", "=": "equal"}
"""Signs in an index -> their names."""
_UNSAID = UPRIGHT | STYLES.keys() | SPACES | RELATIONS.keys() | ELLIPSES | OPENING | CLOSING | BARS | {"mid", "cdot"}
_UNSAID |= frozenset(("{", "}", "frac", "tfrac", "dfrac", "text", "rm", "it", "sf", "%", "&", "#", "_"))
"""Macros in an index that do not belong to its name."""


class LetterCursor(Cursor):
    """Parser of single letters with their decorations, such as indices and accents."""

    def _letter(self) -> Letter | None:
        """Read a letter with its decorations; ``None``, with nothing read, if no letter is next."""
        begin = self._i
        token = self._peek()
        letter: Letter | None = None
        if token.kind == "letter" or token.is_macro(GREEK):
            self._i += 1
            letter = Letter(token.text)
            if token.kind == "macro" and self._may_vary(token, self._peek()):
                varied = self._letter()
                return replace(varied, before=token.text) if varied and not varied.before else letter
        elif token.is_macro(DECORATIONS):
            self._i += 1
            group = self._group()
            inner = self._letter_in(group)
            if inner is not None:
                letter = self._dressed(inner, token.text)
            elif token.text in STYLES and len(group) > 1 and all(t.kind == "letter" for t in group):
                letter = Letter("".join(t.text for t in group), style=STYLES[token.text])
        elif token.is_macro(UPRIGHT):
            self._i += 1
            group = self._group()
            word = "".join(t.text for t in group if t.text not in "~ ")
            if len(word) == 1 or (is_name(cleaned(word)) and "[" not in word):  # in brackets it is a unit
                letter = Letter(cleaned(word)) if word else None
        elif token.kind == "open":
            letter = self._letter_in(self._group())
        if letter is None:
            self._i = begin
            return None
        return self._scripts(letter)

    def _may_vary(self, sign: Token, token: Token) -> bool:
        """Return whether a delta before a letter is a sign of variation; before two letters it is a factor."""
        if sign.text not in ("delta", "Delta"):
            return False
        timed = self._peek(2).text in ("t", "k", "tau") and self._is(")", 3)
        if token.kind == "letter" and self._is("(", 1) and not timed:
            raise Unread("this delta could denote a difference, or be a factor before a bracket", sign.at)
        if token.kind == "letter":
            return sign.text == "Delta" or self._peek(1).kind != "letter"
        return token.is_macro(GREEK | DECORATIONS)

    def _letter_in(self, part: Sequence[Token]) -> Letter | None:
        """Return the letter that a group consists of; ``None`` if the group contains anything else."""
        inner = self._of(part)
        letter = inner._letter()
        return letter if letter is not None and inner._i == len(part) else None

    def _dressed(self, letter: Letter, accent: str) -> Letter | None:
        if accent in ACCENTS:
            return letter.dotted(ACCENTS[accent])
        if accent in MARKS:
            return replace(letter, marks=(*letter.marks, MARKS[accent]))
        return replace(letter, style="_".join(sorted({*filter(None, letter.style.split("_")), STYLES[accent]})))

    def _scripts(self, letter: Letter) -> Letter:
        """Read index, stars and primes of a letter; a power is not read."""
        while True:
            if self._is("^"):
                self._part_transposition(letter.base == "e")
                self._index_first()
            if self._is("_"):
                at = self._take().at
                script = self._script()
                if not script:
                    continue
                index = cleaned(self._said(script))
                if not index:
                    raise Unread("this index is not supported", at)
                foot = ",".join(filter(None, [letter.foot, in_tex(script)]))
                letter = replace(letter, index="_".join(filter(None, [letter.index, index])), foot=foot)
            elif self._accept("'"):
                letter = replace(letter, marks=(*letter.marks, "prime"))
            elif self._is("^") and (mark := self._marked(letter)):
                letter = replace(letter, marks=(*letter.marks, mark))
            else:
                return letter

    _may_have_index = False
    """Whether the letter that is being read may have a superscript index, unlike e, the base of exponentials."""

    def _marked(self, letter: Letter) -> str:
        self._may_have_index = letter.base != "e"
        self._bold = bool(letter.style)
        try:
            return self._mark()
        finally:
            self._bold = False

    def _part_transposition(self, exponential: bool) -> None:
        """Split a superscript that ends in a transposition sign into two superscripts."""
        script = self._peek_group()
        upright = [
            k for k in (-4, -2) if len(script) >= -k and script[k].text in UPRIGHT and script[k:][-k // 2].text == "T"
        ]
        rest, sign = script[: upright[0] if upright else -1], script[upright[0] if upright else -1 :]
        if not rest or exponential or not (upright or sign[0].text in TRANSPOSED):
            return
        if sign[0].text == "T" and not all(t.kind == "number" or t.text in ("-", "prime", "'", *STARS) for t in rest):
            raise Unread("it is not clear whether T in this exponent means the transpose", sign[0].at)
        at = self._found[self._i].at
        rest += [Token("number", "1", at)] if [t.text for t in rest] == ["-"] else []
        end = group_end(self._found, self._i + 1)
        caret = Token("sign", "^", at)
        apart = [caret, *braced(rest, at), caret, *braced(sign, at)]
        self._found = [*self._found[: self._i], *apart, *self._found[end:]]

    def _index_first(self) -> None:
        """Move a subscript that is printed after a power before the power."""
        begin, found = self._i, self._found
        if self._peek(1) is END:
            return
        self._i += 1
        self._script()
        middle = self._i
        if self._peek(1) is not END and self._accept("_"):
            self._script()
            now = self._found
            self._found = [*now[:begin], *now[middle : self._i], *now[begin:middle], *now[self._i :]]
        else:
            self._found = found
        self._i = begin

    _bold = False
    """Whether the letter that is being read is typeset as a vector."""

    def _mark(self) -> str:
        """Read a superscript that is a mark; empty, with nothing read, if the superscript is a power."""
        begin, found = self._i, self._found
        self._i += 1
        script = self._script()
        word = "".join(t.text for t in script if t.text not in UPRIGHT and t.kind not in ("open", "close"))
        upright = len(script) > 1 and script[0].is_macro(UPRIGHT - {"mathsf"})
        if upright:  # and nothing else
            upright = group_end(script, 1) == len(script) or all(t.kind in ("letter", "number") for t in script[1:])
        if len(script) == 1 and script[0].text in "01" and self._may_have_index:
            return f"upper_{script[0].text}"  # no power
        if len(script) == 1 and script[0].text in STARS:
            return "star"
        if len(script) == 1 and script[0].text == "circ":
            return "circ"
        if word and set(word.replace("prime", "'")) == {"'"}:
            return "_".join(["prime"] * len(word.replace("prime", "'")))
        if len(script) == 1 and script[0].is_sign("+-"):
            return "plus" if script[0].text == "+" else "minus"
        spelled = len(script) > 2 or (len(script) == 2 and word.isupper() and word[-1] != "T")
        spelled &= word.isalpha() and all(t.kind == "letter" for t in script)
        spelled &= self._may_have_index
        if word in ("max", "min") or spelled or (upright and word not in ("T", "d") and cleaned(word)):
            return cleaned(word)
        if word.startswith("(") and word.endswith(")") and cleaned(word):
            return f"upper_{cleaned(self._said(script))}"
        number = script[:1] != [] and all(t.kind == "number" or t.text in ("-", "/", "frac", "{", "}") for t in script)
        powers = number or word in ("times", "wedge") or word in TRANSPOSED
        if self._bold and not powers and (said := cleaned(self._said(script))):
            return said  # a vector, or a set, has no powers
        self._i, self._found = begin, found
        return ""

    def _said(self, script: Sequence[Token]) -> str:
        """Return the tokens of an index as text, e.g. for use in a name."""
        said: list[str] = []
        i = 0
        while i < len(script):
            token = script[i]
            i += 1
            if token.is_macro(DECORATIONS - STYLES.keys()):
                end = max(i + 1, group_end(script, i))
                said.append(f" {self._said(script[i:end])} {MARKS.get(token.text, token.text)} ")
                i = end
            elif token.is_macro(GREEK | INDICES):
                said.append(f" {token.text} ")
            elif token.kind in ("letter", "number"):
                said.append(token.text)
            elif token.text in ("frac", "tfrac", "dfrac") and i < len(script) and script[i].kind == "open":
                end = group_end(script, i)
                said.append(f"{self._said(script[i:end])} over ")
                i = end
            elif token.text in ("times", ","):
                said.append(" by " if token.text == "times" else " ")
            elif token.is_sign("/") and script[i - 2].kind == "number":
                said.append(" over ")
            elif token.is_sign(_SAID):
                said.append(f" {_SAID[token.text]} ")
            elif token.kind == "macro" and token.text not in _UNSAID and not token.text.isspace():
                raise Unread("this index is not supported", token.at)
        return "".join(said)
