"""Reading of sums of terms, including double signs, of sums over an index, and of integrals."""

from __future__ import annotations

from fractions import Fraction

from satsym.auditing.latex import words
from satsym.auditing.latex.cursor import listed
from satsym.auditing.latex.enclosed import EnclosedCursor
from satsym.auditing.latex.operators import shows_transposition
from satsym.auditing.latex.quotients import is_differential
from satsym.auditing.latex.tokens import END, Token, Unread, group_end
from satsym.formula.tree import Add, Call, Mul, Neg, Node, Num, Sym, children, symbols

_RELATED = frozenset(words.RELATIONS.values())
"""Functions in conditions below a sum, of which the first argument is an index."""


class SumCursor(EnclosedCursor):
    """Parser of sums of terms, sums over an index, and integrals."""

    def _sum(self) -> Node:
        terms: list[Node] = []
        summed: set[str] = set()
        while True:
            negative, double, before = False, "", ""
            while (sign := self._additive()) in ("+", "-"):
                at = self._take().at
                if sign == before:
                    raise Unread("two signs stand side by side", at)
                negative, before = negative ^ (sign == "-"), sign
            if sign:
                double = words.DOUBLE_SIGNS[self._take().text]
            at = self._here
            term = self._product()
            if summed & self._free(term):
                raise Unread("without brackets, it is not clear where the sum ends", at)
            summed |= _summed_over(term)
            if isinstance(term, Mul) and not (self._reading.transposing or self._reading.lenient):
                self._refuse_primed(term, at)
            term = Call(double, (term,)) if double else term
            terms.append(Neg(term) if negative else term)
            if not self._additive():
                break
        self._reading.transposing |= shows_transposition(terms)
        return terms[0] if len(terms) == 1 else Add(tuple(terms))

    def _refuse_primed(self, product: Mul, at: int) -> None:
        """Refuse a product that ends with a matrix with a prime, which could be its transpose or its derivative."""
        letter = self._letter_of(product.factors[-1])
        matrix = letter is not None and letter.base.isupper() and not letter.dots
        if matrix and letter is not None and letter.marks == ("prime",):
            raise Unread(words.PRIMED, at)

    def _sum_over(self, token: Token) -> Node:
        """Read a sum or product over an index: the term, the index, and the limits as far as they are printed."""
        limits = self._limits()
        parts: list[Node] = [self._product()]
        if token.text == "prod" and isinstance(parts[0], Mul):
            index = {t.text for t in limits.get("_", []) if t.kind == "letter"}
            if not all(index & self._indices(factor) for factor in parts[0].factors):
                raise Unread(words.OPERAND_ENDS, token.at)
        if below := limits.get("_"):
            if all(t.kind == "letter" for t in below):  # indices side by side
                below = [t for letter in below for t in (letter, Token("sign", ",", letter.at))][:-1]
            found = listed(self._condition(below, token.at))
            equal = [k for k, one in enumerate(found) if isinstance(one, Call) and one.function == "equal"]
            if len(equal) == 1 and all(isinstance(one, Sym) for one in found[: equal[0]]):  # from the lower limit on
                parts += [*found[: equal[0]], *children(found[equal[0]])]
                parts += [self._limit(limits.pop("^"), token.at)] if "^" in limits else []
                found = found[equal[0] + 1 :]
            parts += [part for one in found for part in _steps(one)]
        if "^" in limits:
            parts.append(self._limit(limits["^"], token.at))
        return Call("sum" if token.text == "sum" else "product", tuple(parts))

    def _integral(self, token: Token) -> Node:
        """Read an integral: integrand up to the differential, variable, and limits as far as they are printed."""
        limits = self._limits()
        if "^" in limits and "_" not in limits:
            raise Unread("an integral with an upper limit alone is not supported", token.at)
        self._put_differential_last()
        begin, depth = self._i, 0
        while (now := self._peek()) is not END:
            depth += now.nesting
            if depth < 0:
                break
            here = self._i
            if depth == 0 and is_differential(now):
                volume = self._volume()
                letters = list(self._variables()) if volume is None else []
                ends = self._peek() is END or self._peek().is_sign("+-)]")
                if ends and (volume or (all(letters) and len(letters) in (1, words.INTEGRALS[token.text]))):
                    along = here > begin and self._found[here - 1].text == "cdot"
                    integrand = self._found[begin : here - along]
                    tree = self._inner(integrand, token.at) if integrand else Num(Fraction(1))
                    over = [volume] if volume else [self._symbol(letter, now.at) for letter in letters if letter]
                    self._reading.integrated |= {one.name for one in over if isinstance(one, Sym)}
                    parts = [tree, over[0] if len(over) == 1 else Call("list", tuple(over))]
                    parts += [self._limit(limits[sign], token.at) for sign in "_^" if sign in limits]
                    name = "line_integral" if along and letters and letters[0] and letters[0].bold else "integral"
                    return Call({"oint": "circulation"}.get(token.text, name), tuple(parts))
            self._i = here + 1
        raise Unread("integrals without a differential at the end are not supported", token.at)

    def _volume(self) -> Node | None:
        """Read an element of volume such as ``d^3 x``; ``None``, with nothing read, if there is none."""
        begin = self._i
        self._i += 1
        if self._accept("^"):
            order = self._script()
            letter = self._letter()
            if letter is not None and len(order) == 1 and order[0].text in "23":
                return Call("volume", (self._symbol(letter, order[0].at), Num(Fraction(order[0].text))))
        self._i = begin
        return None

    def _put_differential_last(self) -> None:
        """Move a differential that is printed in a numerator, or before the integrand, after the integrand."""
        found, i = list(self._found), self._i
        end = group_end(found, i) if self._is("{", kind="open") else i
        whole = end == len(found) or found[end].text in "+-)]" or end == i
        if end > i and whole and any(t.text in ("d", "mathrm", "dd") for t in found[i:end]):  # braces around it all
            found = [*found[:i], *found[i + 1 : end - 1], *found[end:]]
        depth = length = 0
        for token in found[i:]:
            depth += token.nesting
            if depth < 0 or (depth == 0 and token.is_sign("+-")):
                break
            length += 1
        alone = i + length == len(found) or found[i + length].text in ")]"
        first = self._of(found[i:])
        if is_differential(first._peek()) and alone and all(list(first._variables())):
            found = [*found[:i], *found[i + first._i : i + length], *found[i : i + first._i], *found[i + length :]]
        depth = 0
        for k in range(i, i + length):
            depth += found[k].group
            if depth or found[k].text not in ("frac", "dfrac", "tfrac") or found[k + 1].kind != "open":
                continue
            behind = group_end(found, k + 1)
            above = found[k + 2 : behind - 1]
            below = found[behind + 1] if behind + 1 < len(found) else END
            for j in [j for j, token in enumerate(above) if is_differential(token) and not is_differential(below)][:1]:
                inner = self._of(above)
                inner._i = j
                if all(list(inner._variables())) and inner._i == len(above):
                    rest = above[:j] or [Token("number", "1", above[j].at)]
                    last = group_end(found, behind) if found[behind].kind == "open" else behind + 1
                    quotient = [*found[: k + 2], *rest, *found[behind - 1 : last]]
                    self._found = [*quotient, *above[j:], *found[last:]]
                    return
        self._found = found

    def _additive(self) -> str:
        """Return the additive sign that comes next; empty if there is none."""
        token = self._peek()
        return token.text if token.is_sign("+-") or token.is_macro(words.DOUBLE_SIGNS) else ""

    def _free(self, term: Node) -> set[str]:
        """Return the letters and indices of a term, except the indices of sums within the term."""
        factors = term.factors if isinstance(term, Mul) else (term,)
        return set[str]().union(*(self._indices(factor) - _summed_over(factor) for factor in factors))

    def _indices(self, term: Node) -> set[str]:
        """Return the letters of a term, and the letters in their indices."""
        letters = [self._reading.letters.get(name) for name in symbols(term)]
        return symbols(term).union(*(letter.index.split("_") for letter in letters if letter))


def _steps(condition: Node) -> tuple[Node, ...]:
    """Return the relations of a chain of relations one by one."""
    return condition.arguments if isinstance(condition, Call) and condition.function == "both" else (condition,)


def _summed_over(term: Node) -> set[str]:
    """Return the indices of the sums that are factors of a term."""
    sums = [part for part in (term, *children(term)) if isinstance(part, Call) and part.function == "sum"]
    found: set[str] = set()
    for part in sums:
        related = [one.arguments[0] for one in part.arguments[1:] if isinstance(one, Call) and one.function in _RELATED]
        found = found.union(*map(symbols, related or part.arguments[1:2]))
    return found
