"""Reading of derivatives that are printed as quotients of differentials, or as operators before an expression."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from satsym.auditing.latex.arguments import is_single, is_varied
from satsym.auditing.latex.letters import Letter, cleaned, is_name
from satsym.auditing.latex.places import PlaceCursor
from satsym.auditing.latex.tokens import Token, Unread, group_end
from satsym.auditing.latex.words import ARGUMENT_OR_FACTOR
from satsym.formula.tree import ZERO, Add, Call, Mul, Node, Sym, constant, walk


class QuotientCursor(PlaceCursor):
    """Parser of derivatives in printed formulas."""

    _deriving = False
    """Whether the operand of a derivative is read, behind which a bar belongs to the derivative."""

    def _derivative(self, token: Token) -> Node | None:
        """Read a derivative that is printed as a quotient.

        Return ``None``, with nothing read, if there is no such quotient.
        """
        begin, found = self._i, self._found
        parts: tuple[list[Token], list[Token]] | None = None
        if token.is_macro(("frac", "tfrac", "dfrac")):
            self._i += 1
            parts = self._group(), self._group()
        elif token.text == "partial" and self._is("_", 1):
            self._i += 2
            return self._by_index(token)
        elif is_differential(token):
            parts = self._slashed()
        if parts is not None and (tree := self._quotient(*parts)) is not None:
            self._pass_time()
            return tree
        self._i, self._found = begin, found
        return None

    def _by_index(self, sign: Token) -> Node:
        """Read a partial derivative that is printed with its variable as an index."""
        by = self._letter_in(self._script())
        if by is None:
            raise Unread("a derivative with respect to this index is not supported", sign.at)
        times = 1
        if self._accept("^"):
            digits = "".join(t.text for t in self._script())
            if digits not in ("1", "2", "3", "4"):
                raise Unread("a derivative of this order is not supported", sign.at)
            times = int(digits)
        what = self._factor()
        if isinstance(what, Sym) and self._peek().kind == "letter":
            raise Unread("without brackets, it is not clear what is differentiated", self._here)
        for _ in range(times):
            what = Call("diff", (what, self._symbol_of(by, [sign])))
        return what

    def _pass_time(self) -> None:
        """Skip ``(t)`` after a derivative.

        Another letter in brackets could be an argument or a factor, and is refused.
        """
        if self._is("(") and (self._is_place_next() or self._is_varied_next()):
            at = self._found[self._i].at
            if not (self._is("t", 1, "letter") and self._is(")", 2)):
                raise Unread(ARGUMENT_OR_FACTOR, at)
            self._i += 3

    def _is_varied_next(self) -> bool:
        """Return whether the next bracket holds one term, or a place near another one, as in x + h."""
        begin = self._i
        inside = self._found[begin + 1 : self._bracket_end()]
        self._i = begin
        return bool(inside) and (is_single(inside) or is_varied(inside))

    def _slashed(self) -> tuple[list[Token], list[Token]] | None:
        """Read a quotient of differentials with a slash, as numerator and denominator; otherwise ``None``."""
        texts = [token.text for token in self._found[self._i :]]
        above = self._found[self._i :][: texts.index("/") if "/" in texts else 0]
        if not above or any(token.text in "+-=" for token in above):
            return None
        self._i += len(above) + 1
        start = self._i
        if not is_differential(self._peek()) or not all(self._variables()):
            return None
        if self._accept("^"):
            self._script()
        return list(above), list(self._found[start : self._i])

    def _variables(self) -> Iterator[Letter | None]:
        """Skip all differentials that come next, and yield the letter of each.

        Return ``None`` for a differential without letter.
        """
        while is_differential(self._peek()):
            rest = list(self._found[self._i :])
            self._i += len(rest) - len(after_differential(rest))
            yield self._letter()

    def _differential(self, at: int) -> Node:
        """Read the letter of a differential."""
        letter = self._letter()
        if letter is None:
            raise Unread("differentials are not supported", at)
        if letter not in (Letter("t"), Letter("tau")):  # a step in time may stand anywhere
            self._reading.differential = at
        return Call("differential", (self._symbol(letter, at),))

    def _dotted(self, inner: Node, times: int) -> Node:
        """Return the time derivative of the given order of an expression."""
        return inner if times == 0 else self._along(self._dotted(inner, times - 1))

    def _quotient(self, above: list[Token], below: list[Token]) -> Node | None:
        """Return the derivative that a quotient of differentials denotes; ``None`` if the quotient is no derivative."""
        by = self._differentials(below)
        head = self._order(above)
        if by is None or head is None or head[0] != len(by):
            return None
        _, rest, partial = head
        if not rest and self._is_bar_of_place():  # where it is taken stands in front of what it is of
            at = self._take().at
            self._i += 1
            script = self._script()
            return self._taken(self._derived(above, rest, partial, by), script, at)
        return self._derived(above, rest, partial, by)

    def _derived(self, above: Sequence[Token], rest: list[Token], partial: bool, by: Sequence[Letter]) -> Node:
        """Return the derivative of the expression in the numerator, or after the quotient if the numerator has none."""
        what: Node
        if rest:
            letter = self._letter_in(rest)
            what = self._symbol_of(letter, rest) if letter else self._inner(rest, above[0].at)
        else:
            what = self._operand()
        if partial or any(letter != Letter("t") for letter in by):
            for letter in by:
                name = letter.name
                self._reading.letters.setdefault(name, letter)
                what = Call("diff", (what, Sym(name)))
            return what
        for _ in by:
            what = self._along(what)
        return what

    def _operand(self) -> Node:
        """Read the operand of a derivative operator, which is a bracket or the rest of the term."""
        if self._is("(") or self._is("["):
            return self._bracket()
        at = self._here
        self._deriving, before = True, self._deriving
        found = self._product()
        self._deriving = before
        if isinstance(found, Mul) and sum(constant(factor) is None for factor in found.factors) > 1:
            raise Unread("without brackets, it is not clear what is differentiated", at)
        return found

    def _along(self, what: Node) -> Node:
        """Return the time derivative of an expression; a letter receives one more dot."""
        if (letter := self._letter_of(what)) and (dotted := letter.dotted()):
            self._reading.letters.setdefault(dotted.name, dotted)
            return Sym(dotted.name)
        return Call("d", (what,))

    def _symbol_of(self, letter: Letter, part: Sequence[Token]) -> Node:
        self._reading.letters.setdefault(letter.name, letter)
        if not is_name(letter.name):
            raise Unread("this letter is not supported", part[0].at)
        return Sym(letter.name)

    def _order(self, above: list[Token]) -> tuple[int, list[Token], bool] | None:
        """Return order, operand (empty if it comes after the quotient), and whether the derivative is partial."""
        if not above or not is_differential(above[0]):
            return None
        rest, order = after_differential(above), 1
        if len(rest) > 1 and rest[0].text == "^":
            end = group_end(rest, 1) if rest[1].kind == "open" else 2
            digits = "".join(t.text for t in rest[1:end] if t.kind == "number")
            if not digits and end != 3:  # as a macro leaves it that may have an order
                return None
            order, rest = int(digits or 1), rest[end:]
        return order, rest, above[0].text == "partial"

    def _differentials(self, below: list[Token]) -> list[Letter] | None:
        """Return the variables of differentiation, each repeated according to its order; ``None`` if there are none."""
        found: list[Letter] = []
        inner = self._of(below)
        while inner._i < len(below):
            letter = next(inner._variables(), None)
            if letter is None:
                return None
            times = 1
            if inner._is("(") and inner._is("t", 1, "letter") and inner._is(")", 2):
                inner._i += 3
            if inner._is("("):
                raise Unread(
                    "derivatives with respect to a value at a given time are not supported", below[inner._i].at
                )
            if inner._accept("^"):
                script = inner._script() or [Token("number", "1", below[0].at)]
                digits = "".join(t.text for t in script if t.kind == "number")
                if len(script) == 1 and not digits and (raised := cleaned(inner._said(script))):  # an index above
                    letter = replace(letter, marks=(*letter.marks, f"upper_{raised}"))
                elif not digits or int(digits) > 4:
                    return None
                else:
                    times = int(digits)
            found += [letter] * times
        return found or None


def is_differential(token: Token) -> bool:
    """Return whether a token can begin a differential: d, the partial sign, or a macro that sets d upright."""
    return (token.kind == "letter" and token.text == "d") or (
        token.is_macro(("partial", "mathrm", "d", "dd", "diff", "text", "operatorname", "rm"))
    )


def after_differential(part: list[Token]) -> list[Token]:
    """Return the tokens after a differential sign, which may be set upright."""
    if part[0].text in ("mathrm", "text", "operatorname"):
        return part[group_end(part, 1) :] if len(part) > 1 and part[1].kind == "open" else part[2:]
    return part[1:]


def are_differentials(*sides: Node) -> bool:
    """Return whether each term of each side contains a differential; a side may also be zero."""
    terms = [term for side in sides if side != ZERO for term in (side.terms if isinstance(side, Add) else (side,))]
    found = [[isinstance(part, Call) and part.function == "differential" for _, part in walk(term)] for term in terms]
    return all(map(any, found))
