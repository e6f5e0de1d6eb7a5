"""A plan says when printed cells are right: proved by two engines, which must agree.

What is printed is taken as cells: an expression is one, an equation has two, a matrix has one for each entry. So
edited cells can be tried in the place of the printed ones. The first engine is sympy, the second evaluates trees in a
prime field. Should they disagree, as they may about roots of what has no sign, numbers with forty digits decide.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, TypeAlias

from satsym.auditing.comparison.bench import Bench, Both
from satsym.auditing.ledger.contents import Row
from satsym.auditing.sentences import Said
from satsym.formula import field
from satsym.formula.field import BY_TERMS, Nowhere, Point
from satsym.formula.tree import Call, Node, Sym, substituted, symbols
from satsym.formula.writing import written
from satsym.symbolic.lookup import formulas


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


Cells: TypeAlias = Sequence[Node]
QUICK = 2
"""Points at which an edit is tried; what passes is examined in full."""


class Plan(ABC):
    """When printed cells are right; labels say which is which: empty, a side of an equation, or ``"1, 2"``."""

    def __init__(self, bench: Bench, row: Row, printed: Cells, labels: Sequence[str], target: Any) -> None:
        self.bench, self.row, self.target = bench, row, target
        self.printed, self.labels = tuple(printed), tuple(labels)

    @abstractmethod
    def holds(self, cells: Cells) -> bool:
        """Whether these cells would be right: proved by both engines."""

    @abstractmethod
    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        """Values that vanish at a point if the cells are right; alternatives, each in the same place at all points."""

    @property
    @abstractmethod
    def targets(self) -> list[Node]:
        """What the cells ought to be, in our names, so far as that is one expression each."""

    def difference(self) -> str:
        """What the printed thing lacks, in the document's symbols, if that is one short expression."""
        return ""

    def gaps(self, _: int) -> Iterator[Node]:
        """What a cell lacks to be right, in our names, so far as that is known; alternatives."""
        yield from ()

    @cached_property
    def meanings(self) -> Mapping[str, Node]:
        """The document's symbols as expressions in our names."""
        return self.bench.meanings(self.row)

    @cached_property
    def points(self) -> list[BoundPoint]:
        """Where edits are tried."""
        return self.points_for(self.printed)

    def points_for(self, cells: Cells, count: int = QUICK) -> list[BoundPoint]:
        """Points at which cells and targets have values."""
        found = []
        for strict in (True, False):
            for draw in range(field.DRAWS):
                point = BoundPoint(field.Point(f"edits {draw}", self.bench.names.positive, strict), self.meanings)
                try:
                    next(self.residuals(point, cells), None)
                except field.Nowhere:
                    break
                except field.NoValue:
                    continue
                found.append(point)
                if len(found) == count:
                    return found
        raise field.Undecided("no point at which what is printed has a value")

    def may_hold(self, cells: Cells) -> bool:
        """Whether cells are right at a few points; fast, for the search of edits."""
        try:
            return self._agree(self.points, cells)
        except field.NoValue:
            try:
                return self._agree(self.points_for(cells), cells)
            except (field.Undecided, field.NoValue):
                return False
        except field.Undecided:
            return False

    def _agree(self, points: Sequence[BoundPoint], cells: Cells) -> bool:
        """Whether one alternative vanishes at all points."""
        left: set[int] | None = None
        for point in points:
            zero = {i for i, values in enumerate(self.residuals(point, cells)) if not any(values)}
            left = zero if left is None else left & zero
            if not left:
                return False
        return True

    @cached_property
    def useful(self) -> set[str]:
        """Symbols of the document that the right formula may have: those that share something with the targets."""
        inside = {name for target in self.targets for name in symbols(target)}
        return {name for name, meaning in self.meanings.items() if symbols(meaning) & inside or not symbols(meaning)}

    def normal(self, node: Node) -> Node:
        """A printed formula in our names, written as targets are, so that like parts look alike."""
        return formulas.to_tree(self.both(node).exact)

    def is_right(self, cells: Cells) -> bool:
        """Whether these cells would be right; what has no value is not."""
        try:
            return self.holds(cells)
        except formulas.NotAFormula:
            return False

    def both(self, node: Node) -> Both:
        """A printed formula by both engines.

        Raises
        ------
        NotAFormula
            If it divides by zero, whatever its symbols are.
        """
        found = self.bench.printed(self.row, node)
        if not found.has_a_value:
            raise formulas.NotAFormula(written(node))
        return found

    def vanish(self, tree: Node, exact: Any) -> bool:
        """Whether a difference, given to both engines, is identically zero."""
        positive = self.bench.names.positive
        try:
            by_field: bool | None = field.vanishes(tree, "audit", positive)
        except field.Undecided:
            by_field = None
        if by_field is False and formulas.differs_somewhere(exact):
            return False
        by_sympy = formulas.is_zero(exact)
        return by_sympy if by_field is by_sympy else not formulas.differs_somewhere(exact)


class Never(Plan):
    """In the place of a plan where sizes differ, so that no edit of a cell helps."""

    def __init__(self, plan: Plan, why: Said) -> None:
        super().__init__(plan.bench, plan.row, plan.printed, plan.labels, plan.targets)
        self.why = why

    @property
    def targets(self) -> list[Node]:
        return list(self.target)

    def holds(self, cells: Cells) -> bool:
        return False

    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        yield [1]
