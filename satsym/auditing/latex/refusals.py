"""Refusals of printed formulas: words, units, names without a backslash, and ambiguous notation."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import accumulate, pairwise

from satsym.auditing.latex import words
from satsym.auditing.latex.letters import GREEK, Letter
from satsym.auditing.latex.operators import OperatorCursor, product_of
from satsym.auditing.latex.quotients import is_differential
from satsym.auditing.latex.tokens import Token, Unread
from satsym.auditing.latex.words import ACCENTS, ARGUMENT_OR_FACTOR, FIELDS, FREQUENCIES, FUNCTIONS, MARKS, OPERATORS
from satsym.formula.tree import Call, Mul, Node, Num, Pow, Sym, children, constant, walk
from satsym.wording import printable

_LETTER = rf"(?:[A-Za-z]|\\(?:{'|'.join(sorted(GREEK))}))"
_UPRIGHT = r"\\(?:text|textrm|mathrm|mbox|rm)"
_FREE = r"(?:(?<= )|\A)(?<![_^] )(?<![_^] { )"
"""Pattern of the place in front of a symbol that is no index or power."""
_NUMBER = r"[0-9][0-9.]*"
_DOUBTS = tuple(
    (re.compile(pattern), why)
    for pattern, why in (
        (
            rf"{_FREE}[12]0 (?:\\cdot )?(?P<at>\\log)(?! _)",
            "this logarithm could have the base 10; write \\log_{10} or \\ln",
        ),
        (r"! (?P<at>!)", "a double factorial is not supported"),
        (rf"{_FREE}1 (?P<at>\() (?![-0-9])", ARGUMENT_OR_FACTOR),
        (rf"{_FREE}o (?P<at>\() ", ARGUMENT_OR_FACTOR),
        (
            rf"{_FREE}[0-9]+ (?P<at>\\[dt]?frac) (?:{{ [0-9]+ }} {{ [0-9]+ }}|[0-9][0-9])(?= |\Z)",
            "this could be a mixed number or a product; write \\cdot for a product",
        ),
        (
            rf"(?P<at>\\delta|\\Delta) \^ (?:2|{{ 2 }}) {_LETTER}(?= |\Z)",
            "this could be a power of a letter or a second variation or difference",
        ),
        (
            rf"{_NUMBER} (?P<at>{_UPRIGHT}) (?:{{ )?[eE] (?:}} )?[-+]? ?[0-9]",
            "this notation for a power of ten is not supported; write \\cdot 10^{...}",
        ),
        (
            r"(?P<at>\\binom) { (?![a-zN0-9] (?:[-+] [a-zN0-9] )*} )",
            "this could be a binomial coefficient or a column; write an environment for the column",
        ),
        (r"_ { (?P<at>[,;]) ", "this index is not supported"),
        (
            r"(?:= |\A)(?P<at>\(|\[|\\{) [A-Za-z] _ { [a-z] (?:, )?[a-z] } (?:\)|\]|\\})(?= [=,.]|\Z)",
            "a bracket around one entry could denote the whole matrix",
        ),
        (
            r"begin:array { [lcr] (?P<at>\|) [lcr] } [A-Z] (?:_ \w )?& [A-Z] [^&]*\\hline [A-Z] (?:_ \w )?& ",
            "lines in a matrix could denote a system instead of a matrix",
        ),
        (
            rf"{_NUMBER} (?P<at>\\[dt]?frac) {{ k?(?: )?m }} {{ s (?:\^ (?:2|{{ 2 }}) )?}}",
            "this could be a unit or a factor; set units upright",
        ),
        (rf"{_FREE}[aA] (?P<at>d) _ (?:{{ )?[A-Za-z]", "ad could be one name, \\mathrm{ad}, or a product"),
        (
            rf"(?P<at>\\mathbb) (?:{{ )?[EP] (?:}} )?{_LETTER}(?= |\Z)",
            "this could be an operator that is applied to a function, or a product",
        ),
        (
            rf"{_FREE}(?P<at>D) (?:_ (?:{{ )?[xtquyz]|\^ [0-9] {_LETTER})",
            "this could be an operator that is applied to a function, or a product",
        ),
        (rf"{_FREE}[0-9]+ (?P<at>:) [0-9]", "this colon could be a ratio or a range; write a fraction or an interval"),
        (r"(?:overset|stackrel) { (?P<at>\?) ", "a relation with a question mark is not supported"),
    )
)
"""Patterns of the symbols of a formula, parted by spaces -> the reason why they are refused."""


_PARTS = frozenset((",", ";", "&", "\\\\", "\\quad", "\\qquad", "\\,", "\\;", "\\ "))
"""Symbols behind which an equation begins."""
_OF_COMPONENTS = re.compile(r"[ijlkab]*[ij][ijlkab]*")
"""Pattern of indices that number the components of vectors and tensors."""


_BOUND = frozenset("sum product integral cross times dot".split())
"""Functions that sum over their indices themselves, and products of vectors that are numbered."""


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
        if isinstance(last, Num) and said.startswith(("m/s", "km/s", "rad/", "kg/")):
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


def refuse_doubtful(found: Sequence[Token]) -> None:
    """Refuse symbols that are read in two ways, at the first place where they occur."""
    said = [("\\" if t.kind == "macro" else "begin:" if t.kind == "begin" else "") + t.text for t in found]
    begins = [0, *accumulate(len(one) + 1 for one in said)]
    text = " ".join(said)
    doubts = [(match.start("at"), why) for pattern, why in _DOUBTS if (match := pattern.search(text))]
    if doubts:
        place, why = min(doubts)
        raise Unread(why, found[begins.index(place)].at)
    for k in range(len(said) - 4):
        if said[k + 1 : k + 5] == ["{", "o", "r", "}"] and "=" in said[:k] and "=" in said[k:]:
            one, other = _left(said[:k]), _left(said[k + 5 : said.index("=", k) + 1])
            if one == other:
                raise Unread("alternatives are not supported", found[k].at)


def _left(part: list[str]) -> list[str]:
    """Return what stands on the left of the last equality sign of some symbols."""
    end = len(part) - 1 - part[::-1].index("=")
    begin = max((k + 1 for k in range(end) if part[k] in _PARTS), default=0)
    return part[begin:end]


def refuse_repeated_indices(sides: Sequence[Node], letters: Mapping[str, Letter], at: int) -> None:
    """Refuse an index that occurs twice in a product and nowhere else, as where a sum over it is not printed."""
    parts = [part for side in sides for _, part in walk(side)]
    if any(isinstance(part, Call) and part.function in _BOUND for part in parts):
        return
    found = Counter(index for part in parts for index in _indices(part, letters))
    for product in (part for part in parts if isinstance(part, Mul)):
        factors = [_inmost(factor) for factor in product.factors]
        inside = Counter(index for factor in factors for index in _indices(factor, letters))
        if any(1 < count == found[index] for index, count in inside.items()):
            raise Unread("an index that is repeated in a product could denote a sum; write \\sum", at)


def _inmost(factor: Node) -> Node:
    """Return what is differentiated, transposed or taken somewhere in a factor."""
    while isinstance(factor, Call) and factor.function in ("d", "value", "transpose", "differential"):
        factor = factor.arguments[0]
    return factor


def _indices(part: Node, letters: Mapping[str, Letter]) -> str:
    """Return the letters of indices that number components, below or above a letter."""
    letter = letters.get(part.name) if isinstance(part, Sym) else None
    if letter is not None and _OF_COMPONENTS.fullmatch(letter.index):
        return letter.index
    above = part.arguments[1] if isinstance(part, Call) and part.function == "raised" else None
    return above.name if isinstance(above, Sym) and _OF_COMPONENTS.fullmatch(above.name) else ""
