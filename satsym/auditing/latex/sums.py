"""Sums: terms with their signs, double ones too, and where a sum over an index among them ends."""

from __future__ import annotations

from satsym.auditing.latex import words
from satsym.auditing.latex.enclosed import EnclosedCursor
from satsym.auditing.latex.tokens import Unread
from satsym.formula.tree import Add, Call, Neg, Node, children, symbols


class SumCursor(EnclosedCursor):
    """Reads sums."""

    def _sum(self) -> Node:
        terms: list[Node] = []
        summed: set[str] = set()
        while True:
            negative, double = False, ""
            while (sign := self._additive()) in ("+", "-"):
                negative ^= self._take().text == "-"
            if sign:
                double = words.DOUBLE_SIGNS[self._take().text]
            at = self._found[min(self._i, len(self._found) - 1)].at
            term = self._product()
            if summed & self._indices(term):
                raise Unread("without brackets, it is not clear where the sum ends", at)
            summed |= _summed_over(term)
            term = Call(double, (term,)) if double else term
            terms.append(Neg(term) if negative else term)
            if not self._additive():
                break
        return terms[0] if len(terms) == 1 else Add(tuple(terms))

    def _additive(self) -> str:
        """The sign of a sum that is next; empty where none is."""
        token = self._peek()
        signed = token is not None and (
            (token.kind == "sign" and token.text in "+-")
            or (token.kind == "macro" and token.text in words.DOUBLE_SIGNS)
        )
        return token.text if token is not None and signed else ""

    def _indices(self, term: Node) -> set[str]:
        """The letters of a term, and those of their indices."""
        letters = [self._reading.letters.get(name) for name in symbols(term)]
        return symbols(term).union(*(letter.index.split("_") for letter in letters if letter))


def _summed_over(term: Node) -> set[str]:
    """The indices of the sums that are factors of a term."""
    sums = [part for part in (term, *children(term)) if isinstance(part, Call) and part.function == "sum"]
    over = [part.arguments[1] for part in sums if len(part.arguments) > 1]
    return set().union(*(symbols(index.arguments[0] if isinstance(index, Call) else index) for index in over))
