"""Reading of what stands in brackets behind a letter: a factor, or the arguments at which the letter is taken."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import accumulate

from satsym.auditing.latex.arguments import is_lapse, is_step, may_be_argument, may_be_squared
from satsym.auditing.latex.cursor import bar_in, listed
from satsym.auditing.latex.letters import GREEK, Letter, is_name
from satsym.auditing.latex.printed import LetterCursor
from satsym.auditing.latex.rows import relation_in, split
from satsym.auditing.latex.tokens import END, Token, Unread, has_bold
from satsym.auditing.latex.words import (
    ARGUED,
    ARGUMENT_OR_FACTOR,
    AT_A_TIME,
    COUNTERS,
    DOUBLE_SIGNS,
    FIELDS,
    FUNCTIONS,
    LAPSED,
    PRIMED,
    SHIFTED,
    STYLES,
    TIMES_OF_ANGLES,
)
from satsym.formula.tree import Call, Node, Pow, Sym, constant, symbols

_ORDERS = (Letter("O"), Letter("O", style="cal"))
"""Letters that denote an order of magnitude."""

_OF_EVENTS = frozenset("P p E I H V".split())
"""Letters of functions of an event or a condition, such as a probability."""


@dataclass(frozen=True)
class _Bracket:
    """The contents of a bracket behind a letter."""

    inside: list[Token]
    words: str
    """The tokens, and their texts without braces."""
    places: list[list[Token]]
    letters: list[Letter | None]
    """The parts between commas, and the letter that each consists of; ``None`` for other parts."""
    bare: list[Letter]
    """The letters that can be the usual arguments."""
    fixed: bool
    """Whether this is a point at which the letter is evaluated, as in ``x(t_f)``."""


class PlaceCursor(LetterCursor):
    """Parser of letters with the arguments at which they are taken."""

    def _symbol(self, letter: Letter, at: int) -> Node:
        if self._reading.transposing and letter.marks[-1:] == ("prime",) and self._is_transposed(letter):
            return Call("transpose", (self._symbol(replace(letter, marks=letter.marks[:-1]), at),))
        matrix = letter.marks[-1:] == ("prime",) and letter.marks.count("prime") == 1
        matrix &= letter.bold or (letter.base.isupper() and not letter.dots)
        behind = self._peek()
        if matrix and not self._reading.lenient and self._begins_factor(behind) and not behind.is_sign("([|"):
            raise Unread(PRIMED, at)
        name = letter.name
        if letter.base == "pi" and letter == Letter("pi"):
            if self._is("(") and self._is_place_next():
                raise Unread("pi could be a function or a number here", at)
            return Sym("pi")
        if not is_name(name):
            raise Unread("this letter is not supported", at)
        if letter in _ORDERS and self._is("(") and (order := self._order_of_magnitude(letter)) is not None:
            return order
        places = self._taken_at(letter)
        known = self._reading.letters.setdefault(name, letter)
        if (known != letter or known.signs != letter.signs) and not self._reading.lenient:
            raise Unread("two letters differ only in the signs of their indices; give them other indices", at)
        return Call("value", (Sym(name), *places)) if places else Sym(name)

    def _is_transposed(self, letter: Letter) -> bool:
        """Return whether the last prime of a letter denotes transposition, and of a small letter no derivative."""
        if letter.marks.count("prime") > 1:
            return False
        begin = self._i
        if self._is("("):
            self._bracket_end()
        behind, self._i = self._peek(), begin
        return letter.base.isupper() or letter.bold or self._begins_factor(behind)

    def _order_of_magnitude(self, letter: Letter) -> Node | None:
        """Read the argument of the symbol of Landau; ``None``, with nothing read, if O could be a letter here."""
        begin = self._i
        inside = self._found[begin + 1 : self._bracket_end()]
        if letter.style or len(inside) == 1 or any(t.text == "^" for t in inside):
            return Call("order", (self._inner(inside, self._found[begin].at),))
        self._i = begin
        return None

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
        apart = letter.name in self._reading.timed and words not in self._reading.integrated
        timed = words == "t" or (words == "tau" and letter.name not in self._reading.known and not apart)
        self._reading.timed |= {letter.name} if words == "t" else set()
        if timed or words in (".", "cdot"):
            return ()
        bracket = self._contents(letter, inside, words)
        if self._is_before_power(letter, bracket):
            self._i = begin
            return ()
        step = bracket.letters[0] if len(bracket.places) == 1 else None
        small = letter.base.islower() and not letter.before and letter.base not in LAPSED | ARGUED | SHIFTED
        if step and step.before and small:
            self._refuse_argument(self._found[begin].at)
        if not self._is_surely_taken(letter, bracket) and not self._is_shift(letter, inside):
            doubtful = self._may_be_taken(letter, inside) or letter.style == "cal"
            if doubtful or may_be_argument(letter, inside, self._is("^")):
                self._refuse_argument(self._found[begin].at)
            self._i = begin
            return ()
        return self._read_from(letter, bracket, self._found[begin].at)

    def _contents(self, letter: Letter, inside: list[Token], words: str) -> _Bracket:
        """Return what the bracket behind a letter contains."""
        places = split(inside, lambda t: t.text in ",;")
        letters = [self._place(place) for place in places]
        bare = [at for at in letters if at and (len(places) > 1 or not at.dots)]
        primed = [at for at in bare if "prime" in at.marks and len(places) == 1]
        bare = [at for at in bare if at not in primed or letter.base.isupper()]
        fixed = (
            words in AT_A_TIME
            or (bool(primed) and bool(bare))
            or (len(places) == 1 and bool(bare) and bool(bare[0].index))
            or all(at is not None and at.index == "0" for at in letters)
        )
        return _Bracket(inside, words, places, letters, bare, fixed)

    def _is_before_power(self, letter: Letter, bracket: _Bracket) -> bool:
        """Return whether a letter is a factor in front of the power of a matrix or a vector, which was just read."""
        base = bracket.letters[0]
        factor = base == letter or (
            base and base.base.isupper() if letter.bold and letter.base.isupper() else _is_scalar(letter)
        )
        matrices = base and base.bold and factor
        power, single = self._peek_group() if self._is("^") else [], len(bracket.places) == 1
        raised = [t.text for t in power]
        squared = bool(power) and all(t.kind == "number" for t in power) and single
        if squared and base and letter.name not in self._reading.known and may_be_squared(letter, base):
            if base.before:
                return True
            raise Unread(ARGUMENT_OR_FACTOR, bracket.inside[0].at - 1)
        capitals = base and base.base.isupper() and letter.base.isupper() and not letter.bold
        turned = raised in (["T"], ["top"]) and single and _is_scalar(letter) and letter.base not in "gh"
        if (raised == ["-", "1"] and capitals) or (turned and self._is_taken(bracket.inside)):
            raise Unread(ARGUMENT_OR_FACTOR, bracket.inside[0].at - 1)
        factor = bool(matrices and single and power)
        if not (factor and letter.bold and letter.base.islower() and base != letter):
            return factor or raised in (["times"], ["wedge"])
        if letter.name not in self._reading.known:
            self._refuse_argument(bracket.inside[0].at - 1)
        return self._reading.lenient

    def _is_surely_taken(self, letter: Letter, bracket: _Bracket) -> bool:
        """Return whether the bracket behind a letter contains arguments, without any doubt."""
        inside = bracket.inside
        number = len(inside) == 1 and inside[0].kind == "number"
        number |= inside[-1].text == "infty" and len(inside) < 3
        known = self._known(letter)
        lapse = letter.base in LAPSED | {"delta", "H", "g", "h", "G"} and is_lapse(inside)
        varied = [inside[k + 1].text for k, t in enumerate(inside[:-1]) if t.text in ("delta", "Delta", "d")]
        lapse |= inside[0].text in varied and len(inside) > 3 and inside[1].text in "+-"  # t + Delta t
        lapse |= letter.base in "VJ" and {"x", "u"} <= {t.text for t in inside}  # the value at the next state
        argued = letter in map(Letter, ARGUED) and self._is_product(inside)
        related = _is_related(inside)
        if related and bar_in(inside) < 0 and letter.base not in _OF_EVENTS and not self._states_place(inside):
            raise Unread("relations inside brackets or arguments are not supported", inside[0].at)
        barred = inside[0].text in ("|", "lvert", "lVert") and inside[-1].text in ("|", "rvert", "rVert")
        imaginary = letter.base.isupper() and inside[0].text in "ij" and [t.text for t in inside[1:2]] == ["omega"]
        stated = bool(len(bracket.places) > 1 or bracket.bare or bracket.fixed or number or known or lapse or argued)
        sure = stated or self._is_taken(inside)
        heads = {said[:1] for places in self._reading.known.values() for said in places}
        counted = inside[0].text in COUNTERS & heads
        return sure or related or imaginary or barred or (counted and is_step(inside))

    def _states_place(self, inside: Sequence[Token]) -> bool:
        """Return whether the bracket that was read states a place, as in x(t = 0), not a condition set apart."""
        before, opening = self._peek(-len(inside) - 3), self._peek(-len(inside) - 2)
        gap = opening.at - before.at - len(before.text) - (before.kind == "macro")
        return relation_in(inside).signs == ["="] and gap in (0, len(r"\left"))

    def _may_be_taken(self, letter: Letter, inside: list[Token]) -> bool:
        """Return whether the bracket behind a letter could contain an argument, though it reads as a factor."""
        angles = all(t.text in GREEK or t.text in "+-_" or t.kind in ("open", "close", "number") for t in inside)
        turned = letter.base.isupper() and inside[0].text == "-" and inside[1].text in GREEK
        turned &= not any(t.is_macro(FUNCTIONS) for t in inside)
        turned |= letter.base == "R" and angles and inside[0].text in GREEK
        taken = self._is_product(inside) and not self._is_factor(letter, inside)
        taken &= not (_is_scalar(letter) and self._is("^") and letter not in map(Letter, ARGUED))
        taken |= inside[-1].text != "T" and self._is_power(inside)
        transformed = letter.base.isupper() and {"s"} in self._reading.known.values()
        taken |= transformed and "s" in {t.text for t in inside} and "+" in {t.text for t in inside}
        order = letter == Letter(letter.base) and letter.base in "oO"  # the symbol of Landau
        divided = letter.bold and any(t.text in ("/", "frac") for t in inside) and not has_bold(inside)
        divided |= {"plus", "minus"} & {*letter.marks} != set() and any(t.text == "/" for t in inside)
        transposed = [t.text for t in inside[1:]] in (["^", "T"], ["^", "top"])
        step = letter in (Letter("H"), Letter("delta")) and any(t.is_sign("+-") for t in inside)
        step &= not any(t.text == "(" for t in inside)
        listed = inside[0].is_macro(("{", "lbrace")) and inside[-1].is_macro(("}", "rbrace"))
        vector = letter.bold and not letter.index[:1].isdigit()  # r(t - T), not v_0(t - t_0)
        delayed = (vector or letter in map(Letter, "der")) and is_lapse(inside)
        delayed |= vector and len(inside) == 3 and inside[0].text in "tk" and inside[1].is_sign("+-")
        return turned or taken or order or transposed or step or divided or listed or delayed

    def _read_from(self, letter: Letter, bracket: _Bracket, at: int) -> tuple[Node, ...]:
        """Read the arguments in a bracket, and record that the letter is printed with them."""
        inside, bare, fixed = bracket.inside, bracket.bare, bracket.fixed
        known, related = self._known(letter), _is_related(inside)
        plain = letter != Letter("N", style="cal") and len(bare) == len(bracket.letters) and not fixed
        said = bracket.words if not plain or related else ",".join(at.name for at in bare)
        self._reading.places.setdefault(letter.name, set()).add(said)
        plain &= letter.name not in self._reading.timed or said in self._reading.integrated or len(bare) > 1
        if plain and known <= {said}:
            return ()
        if related:
            return listed(self._condition(inside, at))
        return tuple(self._inner(place, at) for place in bracket.places)

    def _timed_behind_power(self, base: Node) -> Node:
        """Read ``(t)`` after a power of a letter.

        Other arguments are read only after a superscript that is an index.
        """
        begin = self._i
        end = self._bracket_end()
        inside = self._found[begin + 1 : end]
        words_inside = "".join(t.text for t in inside)
        if words_inside in TIMES_OF_ANGLES:
            return base
        if isinstance(base, Pow) and words_inside in AT_A_TIME and (letter := self._squared(base)):
            self._i = begin
            taken = self._taken_at(letter)
            return Pow(Call("value", (base.base, *taken)), base.exponent) if taken else base
        turned = isinstance(base, Call) and base.function == "transpose" and base.arguments[0]
        if isinstance(turned, Sym):  # R^T(x) is R(x)^T
            self._i = begin
            terms = split(inside, lambda t: t.is_sign("+-"))
            timed = any([t.text for t in term] in (["t"], ["k"], ["tau"]) for term in terms)
            matrix = self._reading.letters[turned.name].base.isupper()
            capitals = any(t.kind == "letter" and t.text.isupper() for t in inside)
            if not timed and (capitals and self._is_raised() if matrix else len(terms) > 1):
                return base  # since a factor follows
            taken = self._taken_at(self._reading.letters[turned.name])
            return Call("transpose", (Call("value", (turned, *taken)),)) if taken else base
        places = split(inside, lambda token: token.text == ",")
        timed = words_inside in AT_A_TIME
        inverse = isinstance(base, Pow) and constant(base.exponent) == -1 and not symbols(base.base) & FIELDS
        raised = isinstance(base, Call) and base.function == "raised"
        if raised and symbols(base) & FIELDS and any(t.text in "+-" for t in inside):
            raise Unread(ARGUMENT_OR_FACTOR, self._found[begin].at)
        transposed = self._is("^") and [t.text for t in self._peek_group()] in (["T"], ["top"])
        if inverse and transposed and len(places) > 1:
            raise Unread(ARGUMENT_OR_FACTOR, self._found[begin].at)
        if (raised and timed) or ((raised or inverse) and all(map(self._place, places))):
            return Call("value", (base, *(self._inner(place, self._found[begin].at) for place in places)))
        if timed or self._place(inside) is not None or self._is_taken(inside):
            raise Unread(
                "powers between a function and its argument, as in x^2(t), are not supported", self._found[begin].at
            )
        letter = self._letter_of(base, power=True)
        if letter is not None and may_be_argument(letter, inside, False) and set(words_inside) & {"t", "k"}:
            raise Unread(ARGUMENT_OR_FACTOR, self._found[begin].at)
        self._i = begin
        return base

    def _is_raised(self) -> bool:
        """Return whether a power follows the next bracket."""
        begin = self._i
        self._bracket_end()
        raised, self._i = self._is("^"), begin
        return raised

    def _squared(self, power: Pow) -> Letter | None:
        """Return the letter of a power.

        Return ``None`` if its powers could mean something else, e.g. iterates of a function.
        """
        letter = self._letter_of(power.base)
        exponent = constant(power.exponent)
        unclear = letter is None or letter.base in FIELDS or letter.base in ("delta", "T", *ARGUED)
        return None if unclear or exponent is None or exponent < 2 else letter

    def _known(self, letter: Letter) -> set[str]:
        """Return the arguments with which a letter is printed anywhere, and a letter with primes also without them."""
        unprimed = replace(letter, marks=tuple(mark for mark in letter.marks if not mark.startswith("prime")))
        known = self._reading.known
        return known.get(letter.name, set()) | known.get(unprimed.name, set())

    def _refuse_argument(self, at: int) -> None:
        """Refuse a bracket of which it is not sure whether it is an argument, unless a second reading follows."""
        if not self._reading.lenient:
            raise Unread(ARGUMENT_OR_FACTOR, at)

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
            self._refuse_argument(part[0].at)
        return simple and ("t" in letters or letters == ["k"]) and any(t.text in "+-" for t in part)

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
        bold = [t for t in part if t.is_macro(STYLES)]
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
        depths = accumulate(token.group for token in part)
        level = zip(part, (END, *part), depths, strict=False)
        outer = [token for token, before, depth in level if not depth and before.text != "^"]
        if len(part) < 2 or any(t.is_sign("+-*/") or t.text in DOUBLE_SIGNS for t in outer):
            return False
        inner = self._of(part)
        first = inner._letter()
        while first is not None and inner._is("^"):
            inner._i = inner._script_end()
        return first is not None and (inner._peek().kind in ("letter", "macro") or inner._is("("))


def _is_scalar(letter: Letter) -> bool:
    """Return whether a letter is small, and usually no function."""
    return len(letter.base) == 1 and letter.base.islower() and letter.base not in SHIFTED


def _is_related(part: Sequence[Token]) -> bool:
    """Return whether the tokens contain a relation or a condition."""
    return bar_in(part) >= 0 or not relation_in(part).bare
