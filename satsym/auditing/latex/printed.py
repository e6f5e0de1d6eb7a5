"""Letters as they are printed, with all that they wear."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from satsym.auditing.latex.cursor import Cursor
from satsym.auditing.latex.letters import GREEK, Letter, cleaned, is_name
from satsym.auditing.latex.rows import split
from satsym.auditing.latex.tokens import Token, Unread, group_end
from satsym.auditing.latex.words import ACCENTS, AT_A_TIME, INDICES, MARKS, SHIFTED, STARS, STYLES, TRANSPOSED, UPRIGHT
from satsym.formula.tree import Node, Sym


class LetterCursor(Cursor):
    """Reads letters."""

    def _letter(self) -> Letter | None:
        """A letter with all it wears; ``None``, with nothing taken, where none is next."""
        begin = self._i
        token = self._peek()
        letter: Letter | None = None
        if token is None:
            return None
        if token.kind == "letter":
            self._i += 1
            letter = Letter(token.text)
        elif token.kind == "macro" and token.text in GREEK:
            self._i += 1
            letter = Letter(token.text)
            after = self._peek()
            if after is not None and self._may_vary(token, after):
                varied = self._letter()
                return replace(varied, before=token.text) if varied and not varied.before else letter
        elif token.kind == "macro" and (token.text in ACCENTS or token.text in MARKS or token.text in STYLES):
            self._i += 1
            group = self._group()
            inner = self._letter_in(group)
            if inner is not None:
                letter = self._dressed(inner, token.text)
            elif token.text in STYLES and len(group) > 1 and all(t.kind == "letter" for t in group):
                letter = Letter("".join(t.text for t in group), style=STYLES[token.text])
        elif token.kind == "macro" and token.text in UPRIGHT:
            self._i += 1
            group = self._group()
            word = "".join(t.text for t in group if t.text not in "~ ")
            if len(word) == 1 or is_name(cleaned(word)):
                letter = Letter(cleaned(word)) if word else None
        elif token.kind == "open":
            letter = self._letter_in(self._group())
        if letter is None:
            self._i = begin
            return None
        return self._scripts(letter)

    def _may_vary(self, sign: Token, token: Token) -> bool:
        """Whether a delta in front of a letter is a sign of variation: of two letters behind it, it is a factor."""
        if sign.text not in ("delta", "Delta"):
            return False
        if token.kind == "letter":
            behind = self._peek(1)
            return sign.text == "Delta" or behind is None or behind.kind != "letter"
        return token.kind == "macro" and (token.text in GREEK or token.text in ACCENTS or token.text in STYLES)

    def _letter_in(self, part: Sequence[Token]) -> Letter | None:
        """The letter that a group is, if it is nothing else."""
        inner = self._of(part)
        letter = inner._letter()
        return letter if letter is not None and inner._i == len(part) else None

    def _dressed(self, letter: Letter, accent: str) -> Letter | None:
        if accent in ACCENTS:
            return letter.dotted(ACCENTS[accent])
        if accent in MARKS:
            return replace(letter, marks=(*letter.marks, MARKS[accent]))
        return replace(letter, style=STYLES[accent])

    def _scripts(self, letter: Letter) -> Letter:
        """The letter with its index, stars and primes; a power is left where it is."""
        while True:
            if self._is("^") and not self._plain:
                self._index_first()
            if self._is("_") and not self._plain:
                at = self._take().at
                script = self._script()
                index = cleaned(self._said(script))
                if not index:
                    raise Unread("this index is not read", at)
                foot = ",".join(filter(None, [letter.foot, _in_tex(script)]))
                letter = replace(letter, index="_".join(filter(None, [letter.index, index])), foot=foot)
            elif self._is("'"):
                self._i += 1
                letter = replace(letter, marks=(*letter.marks, "prime"))
            elif self._is("^") and (mark := self._marked(letter)):
                letter = replace(letter, marks=(*letter.marks, mark))
            else:
                return letter

    def _marked(self, letter: Letter) -> str:
        self._bold = letter.style == "vector"
        try:
            return self._mark()
        finally:
            self._bold = False

    def _index_first(self) -> None:
        """Put an index that is printed behind a power in front of it."""
        begin, found = self._i, self._found
        self._i += 1
        if self._peek() is None:
            self._i = begin
            return
        self._script()
        middle = self._i
        if self._is("_") and self._peek(1) is not None:
            self._i += 1
            self._script()
            now = self._found
            self._found = [*now[:begin], *now[middle : self._i], *now[begin:middle], *now[self._i :]]
        else:
            self._found = found
        self._i = begin

    _bold = False
    """Whether the letter that is read is set as a vector."""

    def _mark(self) -> str:
        """The mark that a superscript is; empty, with nothing taken, where it is a power."""
        begin, found = self._i, self._found
        self._i += 1
        script = self._script()
        word = "".join(t.text for t in script if t.text not in UPRIGHT and t.kind not in ("open", "close"))
        upright = (
            bool(script) and script[0].kind == "macro" and script[0].text in UPRIGHT and script[0].text != "mathsf"
        )
        if len(script) == 1 and script[0].text in STARS:
            return "star"
        if word and set(word.replace("prime", "'")) == {"'"}:
            return "prime"
        if len(script) == 1 and script[0].kind == "sign" and script[0].text in "+-":
            return "plus" if script[0].text == "+" else "minus"
        if word in ("max", "min", "opt", "ref") or (upright and word not in ("T", "d") and cleaned(word)):
            return cleaned(word)
        if word.startswith("(") and word.endswith(")") and cleaned(word):
            return cleaned(word)
        if self._bold and not word.isdigit() and word not in TRANSPOSED and (said := cleaned(self._said(script))):
            return said  # a vector has no powers
        self._i, self._found = begin, found
        return ""

    def _said(self, script: Sequence[Token]) -> str:
        """An index as text."""
        said: list[str] = []
        i = 0
        while i < len(script):
            token = script[i]
            i += 1
            if token.kind == "macro" and token.text in ACCENTS:
                end = group_end(script, i) if i < len(script) and script[i].kind == "open" else i + 1
                said.append(f" {self._said(script[i:end])} {token.text} ")
                i = end
            elif token.kind == "macro" and (token.text in GREEK or token.text in INDICES):
                said.append(f" {token.text} ")
            elif token.kind in ("letter", "number", "word"):
                said.append(token.text)
            elif token.text in ("times", ","):
                said.append(" by " if token.text == "times" else " ")
            elif token.kind == "sign" and token.text in "+-*":
                said.append({"+": " plus ", "-": " minus ", "*": " star "}[token.text])
        return "".join(said)

    def _symbol(self, letter: Letter, at: int) -> Node:
        name = letter.name
        if self._plain is False:
            self._timed(letter)
        if letter.base == "pi" and letter == Letter("pi"):
            return Sym("pi")
        if not is_name(name):
            raise Unread("this letter is not read", at)
        self._reading.letters.setdefault(name, letter)
        return Sym(name)

    def _timed(self, letter: Letter | None = None) -> None:
        """Go past ``(t)`` behind a letter, or the letters that it depends on; they must be the same everywhere."""
        if not self._is("("):
            self._at_time(letter, "", self._i)
            return
        begin = self._i
        inside = self._untimed(letter)
        if inside is None:
            return
        places = split(inside, lambda t: t.text == ",")
        letters = [self._place(place) for place in places]
        several = len(places) > 1
        bare = [at for at in letters if at and (several or (not at.dots and (not at.index or at.base == "t")))]
        if not self._plain and len(bare) == len(letters):
            words = ",".join(at.name for at in bare)
            if self._reading.taken_at.setdefault(letter.name if letter else "", words) == words:
                return
            raise Unread("what it is taken at differs from place to place, and is not read", self._found[begin].at)
        if several or (not self._plain and (self._is_product(inside) or self._is_shift(letter, inside))):
            raise Unread("what it is taken at is not read", self._found[begin].at)
        self._i = begin
        self._at_time(letter, "", begin)

    def _untimed(self, letter: Letter | None) -> list[Token] | None:
        """Go past the bracket that is next; what stands in it, or nothing where that is a time, which is entered."""
        begin = self._i
        end = self._bracket_end()
        inside = list(self._found[begin + 1 : end])
        words = "".join(t.text for t in inside if t.kind not in ("open", "close"))
        if words not in AT_A_TIME:
            return inside
        self._at_time(letter, "" if words in ("t", "tau") else words, begin)
        return None

    def _at_time(self, letter: Letter | None, time: str, place: int) -> None:
        """Enter when a letter is taken; one formula may not have it at a fixed time and at another one."""
        if letter is not None and self._reading.times.setdefault(letter.still.name, time) != time:
            at = self._found[min(place, len(self._found) - 1)].at
            raise Unread(f"{letter.still.name} is taken at two times, which is not read", at)

    def _place(self, part: Sequence[Token]) -> Letter | None:
        """The letter at one place of a function, which may be a function of time itself."""
        inner = self._of(part)
        letter = inner._letter()
        rest = "".join(t.text for t in part[inner._i :])
        return letter if rest == "" or (rest[0] == "(" and rest[1:-1] in AT_A_TIME) else None

    def _is_shift(self, letter: Letter | None, part: Sequence[Token]) -> bool:
        """Whether what stands in brackets behind a letter is a place, and no factor: f(x + h), u(t - T)."""
        if letter is None or letter.dots or letter.base not in SHIFTED:
            return False
        letters = [t.text for t in part if t.kind == "letter" or t.text in GREEK]
        return bool(letters) if letter.base in "fF" else "t" in letters

    def _is_product(self, part: Sequence[Token]) -> bool:
        """Whether letters stand side by side: in brackets behind a letter that is what a function is taken at."""
        if len(part) < 2 or any(t.text in "+-*/" and t.kind == "sign" for t in part):
            return False
        inner = self._of(part)
        first = inner._letter()
        behind = part[inner._i] if inner._i < len(part) else None
        return first is not None and behind is not None and (behind.kind in ("letter", "macro") or behind.text == "(")


def _in_tex(part: Sequence[Token]) -> str:
    """Tokens as LaTeX again."""
    said, after_macro = "", False
    for token in part:
        text = f"\\{token.text}" if token.kind == "macro" else token.text
        said += f" {text}" if after_macro and text[:1].isalpha() else text
        after_macro = token.kind == "macro" and token.text[-1:].isalpha()
    return said
