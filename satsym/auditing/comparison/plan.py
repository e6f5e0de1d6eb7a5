"""A plan states when printed cells are right, as proved by two engines that must agree.

Whatever is printed is divided into cells: an expression is one cell, an equation has two, and a matrix has one for each
entry. Edited cells can thus be tried in the place of the printed ones. The first engine is SymPy, the second evaluates
trees in a prime field. If they disagree, as is possible for roots of expressions of unknown sign, numerical values with
forty digits decide.
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
    """A random point for formulas in the symbols of a document.

    Parameters
    ----------
    base
        Random point for formulas in the names of the models.
    meanings
        Symbols of the document -> their meanings in the names of the models.
    """

    def __init__(self, base: Point, meanings: Mapping[str, Node]) -> None:
        super().__init__("", (), base.strict)
        self.base = base
        self._meanings = meanings

    def value_of_call(self, node: Call) -> int:
        """Return the value of a function.

        The argument of functions like the sine is first written in the models' names.
        """
        if node.function in BY_TERMS:
            return self.base.value(substituted(node, self._meanings))
        return super().value_of_call(node)

    def symbol(self, name: str) -> int:
        """Return the value at the point of what a symbol of the document means."""
        if name in self._meanings:
            return self.base.value(self._meanings[name])
        if name in ("I", "pi"):
            return self.base.value(Sym(name))
        raise Nowhere(f"{name} means a matrix")


Cells: TypeAlias = Sequence[Node]
QUICK = 2
"""Number of points at which an edit is tried; an edit that passes at these points is then proved."""


class Plan(ABC):
    """The condition under which printed cells are right.

    The label of a cell is empty, the side of an equation, or the position of a matrix entry, such as ``"1, 2"``.
    """

    def __init__(self, bench: Bench, row: Row, printed: Cells, labels: Sequence[str], target: Any) -> None:
        self.bench, self.row, self.target = bench, row, target
        self.printed, self.labels = tuple(printed), tuple(labels)

    @abstractmethod
    def holds(self, cells: Cells) -> bool:
        """Return whether the given cells would be right, as proved by both engines."""

    @abstractmethod
    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        """Yield residuals at a point, one list for each alternative.

        All values of one list vanish if the cells are right.

        The alternatives have the same order at all points.
        """

    @property
    @abstractmethod
    def targets(self) -> list[Node]:
        """Correct formulas of the cells in the names of the models, as far as each is a single expression."""

    def difference(self) -> str:
        """Return the term that the printed formula lacks, in the document's symbols.

        It is empty if it is not one short expression.
        """
        return ""

    def gaps(self, _: int) -> Iterator[Node]:
        """Yield alternatives for the term that a cell lacks, in the names of the models, as far as they are known."""
        yield from ()

    @cached_property
    def meanings(self) -> Mapping[str, Node]:
        """Symbols of the document as expressions in the names of the models."""
        return self.bench.meanings(self.row)

    @cached_property
    def points(self) -> list[BoundPoint]:
        """Random points at which edits are tried."""
        return self.points_for(self.printed)

    def points_for(self, cells: Cells, count: int = QUICK) -> list[BoundPoint]:
        """Return random points at which both the cells and the targets have values."""
        positive = self.bench.names.positive
        found = field.drawn(
            lambda draw, strict: BoundPoint(Point(f"edits {draw}", positive, strict), self.meanings),
            lambda point: next(self.residuals(point, cells), None),
            count,
        )
        return list(found)[-count:]

    def may_hold(self, cells: Cells) -> bool:
        """Return whether cells are right at a few random points; fast enough for the search of edits."""
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
        """Return whether the residuals of one alternative vanish at all points."""
        left: set[int] | None = None
        for point in points:
            zero = {i for i, values in enumerate(self.residuals(point, cells)) if not any(values)}
            left = zero if left is None else left & zero
            if not left:
                return False
        return True

    @cached_property
    def useful(self) -> set[str]:
        """Symbols of the document that can occur in the right formula, because they share a name with the targets."""
        inside = {name for target in self.targets for name in symbols(target)}
        return {name for name, meaning in self.meanings.items() if symbols(meaning) & inside or not symbols(meaning)}

    def normal(self, node: Node) -> Node:
        """Return a printed formula in the models' names and in the normal form of the targets, to compare terms."""
        return formulas.to_tree(self.both(node).exact)

    def is_right(self, cells: Cells) -> bool:
        """Return whether the given cells would be right; cells that have no value are not."""
        try:
            return self.holds(cells)
        except formulas.NotAFormula:
            return False

    def both(self, node: Node) -> Both:
        """Return the value of a printed formula as computed by both engines.

        Raises
        ------
        NotAFormula
            If the formula divides by zero for all values of its symbols.
        """
        found = self.bench.printed(self.row, node)
        if not found.has_a_value:
            raise formulas.NotAFormula(written(node))
        return found

    def vanish(self, tree: Node, exact: Any) -> bool:
        """Return whether a difference, given as a tree and as a SymPy expression, is identically zero."""
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
    """A plan that never holds, because printed formula and target differ in size and no edit of a cell can help."""

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
