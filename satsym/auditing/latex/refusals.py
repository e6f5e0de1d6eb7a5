"""Refusals of printed formulas: words, units, names without a backslash, and ambiguous notation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from satsym.auditing.latex import words
from satsym.auditing.latex.letters import GREEK
from satsym.auditing.latex.operators import OperatorCursor, product_of
from satsym.auditing.latex.quotients import is_differential
from satsym.auditing.latex.tokens import Token, Unread
from satsym.auditing.latex.words import ACCENTS, FIELDS, FREQUENCIES, FUNCTIONS, MARKS, OPERATORS
from satsym.formula.tree import Call, Node, Num, Pow, Sym, children, constant
from satsym.wording import printable


class RefusalCursor(OperatorCursor):
    """Parser that refuses, with its position, any input that the grammar does not read."""

    def _is_function(self, token: Token) -> bool:
        return token.is_macro(FUNCTIONS) and token.text != "d"

    def _continues_argument(self, token: Token, last: Node) -> bool:
        r"""Return whether the argument of a function continues, as in ``2\theta``, ``\omega t``, ``kx``.

        Not ``\theta v``.
        """
        if token.kind not in ("letter", "macro") or (token.kind == "macro" and token.text not in GREEK):
            return isinstance(last, Num) and token.kind == "macro" and (token.text in ACCENTS or token.text in MARKS)
        if self._is_function(token) or (token.text == "e" and self._is("^", 1)):
            return False
        if isinstance(last, Num) or last == Sym("pi"):
            return True
        letter = self._letter_of(last)
        stem = letter.base if letter is not None else ""
        time = token.text in words.TIMES_OF_ANGLES
        if (time and stem not in words.ANGLES) or (stem in FREQUENCIES and token.text in words.PLACES):
            return True
        if time or (len(stem) == 1) or (stem in GREEK and token.text in GREEK):
            raise Unread("without brackets, it is not clear where the argument of the function ends", token.at)
        return False

    def _may_be_divided_by(self, token: Token, above: Sequence[Node], divisor: Node) -> bool:
        """Return whether the next factor could belong to the denominator, as in ``a/bc``, not in ``1/2 mv``."""
        if not self._begins_factor(token) or token.text in words.STYLES or token.text in MARKS:
            return False
        number = constant(divisor) is not None
        return not (number and constant(product_of(above)) is not None)

    def _refuse_behind(self, last: Node, token: Token) -> None:
        """Refuse input after an expression that is no factor: units, powers of ten, arguments of a transform."""
        before, after = self._found[self._i - 1], self._peek(1)
        if last in (Sym("delta"), Sym("Delta")) and token.text in words.INTEGRALS:
            raise Unread("this delta could denote a difference, or be a factor before an integral", before.at)
        if token.text in words.UPRIGHT:
            said, plain = "".join(t.text for t in self._peek_group()), token.text.startswith(("text", "mbox"))
            apart = token.at > before.at + len(before.text) + (before.kind == "macro") + 1
            if said in words.UNITS and (plain or apart or constant(last) is not None):
                raise Unread("units in formulas are not supported", token.at)
            if plain and len(said) > 1 and said not in FUNCTIONS and said not in words.UNKNOWN:
                raise Unread("words inside a formula are not supported", token.at)
        if token.text in ("e", "E") and before.kind == "number" and token.at == before.at + len(before.text):
            power = self._peek(2) if after.text in "+-" else after
            if power.kind == "number" and power.at <= token.at + 2:
                raise Unread("this notation for a power of ten is not supported; write \\cdot 10^{...}", token.at)
        said = "".join(t.text for t in self._found[self._i : self._i + 4])
        if isinstance(last, Num) and last.value.denominator > 1 and said.startswith(("m/s", "km/s", "rad/", "kg/")):
            raise Unread("this could be a unit or a product of letters; set units upright", token.at)
        raised = isinstance(last, Pow) or (isinstance(last, Call) and last.function == "power")
        if token.text in words.UNITS and raised and children(last)[0] == Num(Fraction(10)):
            raise Unread("this could be a unit or a factor after a power of ten; set units upright", token.at)
        letter = self._letter_of(last, power=True)
        applied = (token.text in FIELDS or token.text in GREEK) and token.at == before.at + 1 and self._is("(", 1)
        if letter is not None and letter.base in OPERATORS and applied:
            raise Unread("this could be an operator that is applied to a function, or a product", token.at)
        if letter is not None and token.text in ("[", "{", "lbrace") and token.kind in ("sign", "macro"):
            alone = after.kind == "letter" and self._is("}", 2, "macro")
            alone |= letter.base in (words.TRANSFORMS if token.kind == "macro" else "E")
            if letter.style == "cal" or alone:
                raise Unread("arguments in brackets of this kind are not supported", token.at)

    def _spells(self, word: str) -> bool:
        """Return whether adjacent letters, of which the first was read, spell a word; if they do, read all of them."""
        begin = self._i - 1
        part = self._found[begin : begin + len(word)]
        if [token.text for token in part] != list(word) or part[-1].at - part[0].at != len(word) - 1:
            return False
        self._i = begin + len(word)
        return True

    def _spelled_function(self, token: Token) -> Node | None:
        """Read a function whose backslash is missing, before a bracket or Greek letter; refuse it elsewhere."""
        before = self._peek(-2)
        alone = before.kind != "letter" or before.at != token.at - 1
        for word in (*words.SPELLED, *words.CALLED):
            begin = self._i
            if self._spells(word) and word in words.CALLED and not self._is("("):
                self._i = begin
            elif self._i > begin and word in words.CALLED:
                raise Unread(f"{word} could be one name, \\mathrm{{{word}}}, or a product", token.at)
            elif self._i > begin:
                after = self._peek()
                if alone and word in FUNCTIONS and (after.text == "(" or after.text in GREEK):
                    return self._function(FUNCTIONS[word], replace(token, kind="macro", text=word))
                raise Unread(f"{word} has no backslash; write \\{word}, or put spaces between the letters", token.at)
        return None

    def _refuse_derivative(self, above: Sequence[Token], below: Sequence[Token], at: int) -> None:
        """Refuse quotients that denote other kinds of derivatives, and remaining differentials."""
        if not above or (len(above) > 1 and above[1].text in ("^", "_")):
            differentials = above and len(below) > 1 and is_differential(above[0]) and is_differential(below[0])
            if differentials and above[1].text == "^" and below[1].text not in ("^", "_"):
                raise Unread("a derivative of this order is not supported", at)
            return
        if above[0].text in ("D", "delta") and len(below) > 1 and below[0].text == above[0].text:
            raise Unread("this kind of derivative is not supported", at)
        if len(below) > 1 and is_differential(below[0]) and "d" in {t.text for t in above}:
            raise Unread("this kind of derivative is not supported", at)
        if len(above) < 2:
            return
        apart = above[1].at > above[0].at + 2
        if above[0].text == "d" and apart and (above[1].kind == "letter" or above[1].text in GREEK):
            raise Unread("differentials are not supported", above[0].at)

    def _refuse_units(self, above: Sequence[Token], below: Sequence[Token]) -> None:
        """Refuse a quotient whose numerator and denominator are units, such as m/s."""
        said = ["".join(t.text for t in part[1:]).strip("{}") for part in (above, below)]
        set_upright = all(part and part[0].text in words.UPRIGHT for part in (above, below))
        if set_upright and all(one.partition("}")[0] in words.UNITS for one in said):
            raise Unread("units in formulas are not supported", above[0].at)

    def _refuse_word(self, macro: str, word: str, at: int) -> None:
        """Refuse upright words that are no letters: unknown functions, and plain language."""
        behind = self._peek(1 + len(self._peek_group()) + 2 * (self._is("{", 1, "open")))
        taken = self._begins_factor(behind) or behind.text == "^"
        places = [t.at for t in self._peek_group() if t.kind == "letter"]
        space = 1 if macro.startswith(("text", "mbox")) else 2  # elsewhere a space has to be set: "\\ "
        parted = any(b > a + space for a, b in pairwise(places)) and word.isalpha()
        if word.lower() in words.SAID or parted:
            raise Unread("words inside a formula are not supported", at)
        if (word in words.UNKNOWN or macro == "operatorname") and word not in FUNCTIONS and taken:
            raise Unread(f"unknown function {printable(word)}", at)
