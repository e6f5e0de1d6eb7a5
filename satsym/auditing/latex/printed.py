"""Reading of letters with all decorations, such as indices, accents and superscripts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from satsym.auditing.latex.cursor import Cursor
from satsym.auditing.latex.letters import GREEK, Letter, cleaned, is_name
from satsym.auditing.latex.rows import split
from satsym.auditing.latex.tokens import Token, Unread, group_end, has_bold, in_tex
from satsym.auditing.latex.words import (
    ACCENTS,
    ARGUED,
    AT_A_TIME,
    COUNTERS,
    DOUBLE_SIGNS,
    INDICES,
    LAPSED,
    MARKS,
    SHIFTED,
    STARS,
    STYLES,
    TRANSPOSED,
    UPRIGHT,
)
from satsym.formula.tree import Call, Node, Sym

_SAID = {"+": "plus", "-": "minus", "*": "star", "|": "given", "'": "prime", ":": "to"}
"""Signs in an index -> their names."""


class LetterCursor(Cursor):
    """Parser of single letters with their decorations, such as indices and accents."""

    def _letter(self) -> Letter | None:
        """Read a letter with its decorations; ``None``, with nothing read, if no letter is next."""
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
        """Return whether a delta before a letter is a sign of variation; before two letters it is a factor."""
        if sign.text not in ("delta", "Delta"):
            return False
        if token.kind == "letter" and self._is("(", 1):
            raise Unread("this delta could denote a difference, or be a factor before a bracket", sign.at)
        if token.kind == "letter":
            behind = self._peek(1)
            return sign.text == "Delta" or behind is None or behind.kind != "letter"
        return token.kind == "macro" and any(token.text in names for names in (GREEK, ACCENTS, MARKS, STYLES))

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
            elif self._is("'"):
                self._i += 1
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
        caret, opening, closing = Token("sign", "^", at), Token("open", "{", at), Token("close", "}", at)
        apart = [caret, opening, *rest, closing, caret, opening, *sign, closing]
        self._found = [*self._found[: self._i], *apart, *self._found[end:]]

    def _index_first(self) -> None:
        """Move a subscript that is printed after a power before the power."""
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
    """Whether the letter that is being read is typeset as a vector."""

    def _mark(self) -> str:
        """Read a superscript that is a mark; empty, with nothing read, if the superscript is a power."""
        begin, found = self._i, self._found
        self._i += 1
        script = self._script()
        word = "".join(t.text for t in script if t.text not in UPRIGHT and t.kind not in ("open", "close"))
        upright = len(script) > 1 and script[0].kind == "macro" and script[0].text in UPRIGHT - {"mathsf"}
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
        if len(script) == 1 and script[0].kind == "sign" and script[0].text in "+-":
            return "plus" if script[0].text == "+" else "minus"
        spelled = len(script) > 2 or (len(script) == 2 and word.isupper() and word[-1] != "T")
        spelled &= word.isalpha() and all(t.kind == "letter" for t in script)
        if (
            word in ("max", "min")
            or (spelled and self._may_have_index)
            or (upright and word not in ("T", "d") and cleaned(word))
        ):
            return cleaned(word)
        if word.startswith("(") and word.endswith(")") and cleaned(word):
            return f"upper_{cleaned(self._said(script))}"
        number = script[:1] != [] and all(t.kind == "number" or t.text in ("-", "/", "frac", "{", "}") for t in script)
        if (
            self._bold
            and not number
            and word not in ("times", "wedge")
            and word not in TRANSPOSED
            and (said := cleaned(self._said(script)))
        ):
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
            if token.kind == "macro" and (token.text in ACCENTS or token.text in MARKS):
                end = group_end(script, i) if i < len(script) and script[i].kind == "open" else i + 1
                said.append(f" {self._said(script[i:end])} {MARKS.get(token.text, token.text)} ")
                i = end
            elif token.kind == "macro" and (token.text in GREEK or token.text in INDICES):
                said.append(f" {token.text} ")
            elif token.kind in ("letter", "number"):
                said.append(token.text)
            elif token.text in ("frac", "tfrac", "dfrac") and i < len(script) and script[i].kind == "open":
                end = group_end(script, i)
                said.append(f"{self._said(script[i:end])} over ")
                i = end
            elif token.text in ("times", ","):
                said.append(" by " if token.text == "times" else " ")
            elif token.kind == "sign" and token.text == "/" and script[i - 2].kind == "number":
                said.append(" over ")
            elif token.kind == "sign" and token.text in _SAID:
                said.append(f" {_SAID[token.text]} ")
        return "".join(said)

    def _symbol(self, letter: Letter, at: int) -> Node:
        name = letter.name
        if letter.base == "pi" and letter == Letter("pi"):
            if self._is("(") and self._is_place_next():
                raise Unread("pi could be a function or a number here", at)
            return Sym("pi")
        if not is_name(name):
            raise Unread("this letter is not supported", at)
        places = self._taken_at(letter)
        self._reading.letters.setdefault(name, letter)
        return Call("value", (Sym(name), *places)) if places else Sym(name)

    def _taken_at(self, letter: Letter) -> tuple[Node, ...]:
        """Read the arguments in brackets after a letter at which it is evaluated; empty if the bracket is a factor.

        The result is also empty for ``(t)``, and for the arguments with which the letter is printed first.
        """
        begin = self._i
        if self._is("["):
            return self._member(letter)
        if not self._is("("):
            return ()
        end = self._bracket_end()
        inside = list(self._found[begin + 1 : end])
        if not inside:
            raise Unread("the brackets are empty", self._found[begin].at)
        words = "".join(t.text for t in inside if t.kind not in ("open", "close"))
        timed = words == "t" or (words == "tau" and letter.name not in self._reading.known)
        if timed or words in (".", "cdot"):
            return ()
        places = split(inside, lambda t: t.text in ",;")
        letters = [self._place(place) for place in places]
        bare = [at for at in letters if at and (len(places) > 1 or not at.dots)]
        primed = [at for at in bare if "prime" in at.marks and len(places) == 1]
        bare = [at for at in bare if at not in primed or letter.base.isupper()]
        fixed = (
            words in AT_A_TIME
            or (bool(primed) and bool(bare))
            or (len(places) == 1 and bool(bare) and bool(bare[0].index))
        )
        number = len(inside) == 1 and inside[0].kind == "number"
        base = letters[0]
        scalar = len(letter.base) == 1 and letter.base.islower() and letter.base not in SHIFTED
        factor = base == letter or (base and base.base.isupper() if letter.bold and letter.base.isupper() else scalar)
        matrices = base and base.bold and factor
        crossed = self._is("^") and [t.text for t in self._peek_group()] in (["times"], ["wedge"])
        if crossed or (
            matrices and len(places) == 1 and self._is("^")
        ):  # a factor in front of the power of a matrix or a vector
            self._i = begin
            return ()
        known = self._reading.known.get(letter.name, set())
        lapse = letter.base in LAPSED and _is_lapse(inside)
        argued = letter in map(Letter, ARGUED) and self._is_product(inside)
        sure = len(places) > 1 or bare or fixed or number or known or lapse or argued or self._is_taken(inside)
        if not sure and not self._is_shift(letter, inside):
            barred = inside[0].text in ("|", "lvert", "lVert") and inside[-1].text in ("|", "rvert", "rVert")
            angles = all(t.text in GREEK or t.text in "+-_" or t.kind in ("open", "close", "number") for t in inside)
            turned = letter.base.isupper() and inside[0].text == "-" and inside[1].text in GREEK
            turned |= letter.base == "R" and angles and inside[0].text in GREEK
            taken = self._is_product(inside) and not self._is_factor(letter, inside)
            taken |= inside[-1].text != "T" and self._is_power(inside) and len(letter.base) + len(letter.marks) > 1
            transformed = letter.base.isupper() and {"s"} in self._reading.known.values()
            taken |= transformed and "s" in {t.text for t in inside} and "+" in {t.text for t in inside}
            order = letter == Letter(letter.base) and letter.base in "oO"  # the symbol of Landau
            divided = letter.bold and any(t.text in ("/", "frac") for t in inside) and not has_bold(inside)
            divided |= {"plus", "minus"} & {*letter.marks} != set() and any(t.text == "/" for t in inside)
            transposed = [t.text for t in inside[1:]] in (["^", "T"], ["^", "top"])
            varied = [inside[k + 1].text for k, t in enumerate(inside[:-1]) if t.text in ("delta", "Delta", "d")]
            shifted = inside[0].text in varied and inside[1:2] != [] and inside[1].text in "+-"
            step = letter in (Letter("H"), Letter("delta")) and any(t.kind == "sign" and t.text in "+-" for t in inside)
            step &= not any(t.text == "(" for t in inside)
            step |= letter.base in "ghG" and _is_lapse(inside)
            next_state = letter.base in "VJ" and {"x", "u"} <= {t.text for t in inside}
            a_place = barred or turned or taken or order or transposed or next_state or shifted or step or divided
            if a_place or letter.style == "cal":
                raise Unread("the argument in brackets after this letter is not supported", self._found[begin].at)
            self._i = begin
            return ()
        said = words if len(bare) < len(letters) or fixed else ",".join(at.name for at in bare)
        self._reading.places.setdefault(letter.name, set()).add(said)
        if len(bare) == len(letters) and not fixed and known <= {said}:
            return ()
        return tuple(self._inner(place, self._found[begin].at) for place in places)

    def _is_place_next(self) -> bool:
        """Return whether the next bracket contains a single letter."""
        begin = self._i
        end = self._bracket_end()
        self._i = begin
        return self._letter_in(self._found[begin + 1 : end]) is not None

    def _member(self, letter: Letter) -> tuple[Node, ...]:
        """Read the index of a member of a sequence, ``x[k + 1]``; empty if the bracket is a factor."""
        begin = self._i
        end = self._bracket_end()
        inside = self._found[begin + 1 : end]
        simple = all(t.kind in ("number", "letter", "open", "close") or t.text in "+-_" for t in inside)
        counts = inside[:1] != [] and (inside[0].kind == "number" or inside[0].text in COUNTERS)
        if simple and counts and letter.base not in ("E", "P"):
            return (self._inner(inside, self._found[begin].at),)
        self._i = begin
        return ()

    def _place(self, part: Sequence[Token]) -> Letter | None:
        """Return the letter that is one argument of a function, with or without ``(t)``; otherwise ``None``."""
        inner = self._of(part)
        letter = inner._letter()
        rest = "".join(t.text for t in part[inner._i :])
        return letter if rest in ("", "(t)", "(tau)") else None

    def _is_shift(self, letter: Letter, part: Sequence[Token]) -> bool:
        """Return whether the bracket after a letter is an argument, as in u(t - T), rather than a factor."""
        if letter.dots or letter.base not in SHIFTED:
            return False
        letters = [t.text for t in part if t.kind == "letter" or t.text in GREEK]
        simple = all(t.kind in ("letter", "number") or t.text in GREEK or t.text in "+-_" for t in part)
        if letter.base in "fF" and letters:
            raise Unread("the argument in brackets after this letter is not supported", part[0].at)
        return simple and "t" in letters and any(t.text in "+-" for t in part)

    def _is_taken(self, part: Sequence[Token]) -> bool:
        """Return whether the tokens are one letter with an argument of its own, such as x(T) in f(x(T))."""
        inner = self._of(part)
        letter = inner._letter()
        called = letter is not None and (inner._is("(") or (inner._is("[") and bool(inner._member(letter))))
        if called and inner._i < len(part):
            inner._bracket_end()
        return called and inner._i == len(part)

    def _is_factor(self, letter: Letter, part: Sequence[Token]) -> bool:
        """Return whether a product in brackets after a letter is a factor, as products of matrices or vectors are."""
        crossed = any(t.text in ("times", "cdot") for t in part) and letter.base not in SHIFTED
        bold = [t for t in part if t.kind == "macro" and t.text in STYLES]
        plain = [
            t for k, t in enumerate(part) if t.kind == "letter" and not (k and part[k - 1].kind in ("open", "macro"))
        ]
        return crossed or (letter.bold and letter.base.isupper() and bool(bold) and not plain)

    def _is_power(self, part: Sequence[Token]) -> bool:
        """Return whether the tokens are a letter with a power and nothing else."""
        inner = self._of(part)
        return inner._letter() is not None and inner._is("^") and inner._script_end() == len(part)

    def _is_product(self, part: Sequence[Token]) -> bool:
        """Return whether the tokens are adjacent letters; in brackets after a letter such a product is an argument."""
        if len(part) < 2 or any((t.text in "+-*/" and t.kind == "sign") or t.text in DOUBLE_SIGNS for t in part):
            return False
        inner = self._of(part)
        first = inner._letter()
        while first is not None and inner._is("^"):
            inner._i = inner._script_end()
        behind = part[inner._i] if inner._i < len(part) else None
        return first is not None and behind is not None and (behind.kind in ("letter", "macro") or behind.text == "(")


def _is_lapse(part: Sequence[Token]) -> bool:
    """Return whether the tokens are a difference of two times."""
    named = [t.text for k, t in enumerate(part) if t.kind in ("letter", "macro") and part[k - 1].text not in "_{"]
    return len(named) == 2 and set(named) <= {"t", "tau", "s", "T"} and "-" in {t.text for t in part}
