"""Points for printed formulas: the document's symbols have the values of what they mean."""

from __future__ import annotations

from collections.abc import Mapping

from satsym.formula.field import BY_TERMS, Nowhere, Point
from satsym.formula.tree import Call, Node, Sym, substituted, symbols


class BoundPoint(Point):
    """A point for formulas in the symbols of a document.

    Parameters
    ----------
    base
        The point for formulas in our names.
    meanings
        The document's symbols -> what they mean in our names.
    """

    def __init__(self, base: Point, meanings: Mapping[str, Node]) -> None:
        super().__init__("", (), base.strict)
        self.base = base
        self._meanings = meanings

    def value_of_call(self, node: Call) -> int:
        """Angles and exponents are taken apart in our names."""
        if node.function in BY_TERMS:
            return self.base.value(substituted(node, self._meanings))
        return super().value_of_call(node)

    def symbol(self, name: str) -> int:
        """The value of what a symbol of the document means."""
        if name in self._meanings:
            return self.base.value(self._meanings[name])
        if name in ("I", "pi"):
            return self.base.value(Sym(name))
        raise Nowhere(f"{name} means a matrix")


def unbound(node: Node, meanings: Mapping[str, Node]) -> set[str]:
    """Symbols of a formula that mean no expression."""
    return {name for name in symbols(node) if name not in meanings and name not in ("I", "pi")}
