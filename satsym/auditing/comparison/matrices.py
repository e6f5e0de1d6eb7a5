"""Plans for what belongs to a matrix as a whole: its eigenvalues, its null space, a product of matrices."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

from satsym.auditing.comparison.bench import Bench, Both
from satsym.auditing.comparison.plan import Cells, Plan
from satsym.auditing.ledger.contents import Row
from satsym.formula import field
from satsym.formula.bound import BoundPoint
from satsym.formula.calculus import difference, product
from satsym.formula.evaluation import Engine
from satsym.formula.tree import Node, Sym, shaped
from satsym.formula.values import Matrix
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas


class SameRoots(Plan):
    """The cells are the eigenvalues of a matrix, in any order."""

    def __init__(self, bench: Bench, row: Row, printed: Cells, target: Both) -> None:
        super().__init__(bench, row, printed, [f"eigenvalue {i}" for i in range(1, len(printed) + 1)], target)
        trees, exact = bench.engines(row)
        variable = bench.unused()
        self._variable = Sym(variable)
        self._trees = trees.characteristic(target.trees.of, self._variable)
        self._symbol = formulas.symbol(variable)
        self._exact = exact.characteristic(target.exact.of, self._symbol)
        self._aim = formulas.to_tree(self._exact)

    @property
    def targets(self) -> list[Node]:
        return [formulas.to_tree(root) for root in formulas.roots(self._exact, self._symbol)]

    def holds(self, cells: Cells) -> bool:
        found = [self.both(cell) for cell in cells]
        trees = product([difference(self._variable, root.trees) for root in found])
        exact = formulas.product(self._symbol - root.exact for root in found)
        return self.vanish(difference(trees, self._trees), exact - self._exact)

    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        place, total = point.base.value(self._variable), 1
        for cell in cells:
            total = total * (place - point.value(cell)) % field.PRIME
        yield [(total - point.base.value(self._aim)) % field.PRIME]


class Spans(Plan):
    """The cells are columns that span the null space of a matrix, none of them too many."""

    @property
    def _columns(self) -> int:
        return len(self.row.printed[0]) if isinstance(self.row.printed, tuple) else 1

    @property
    def targets(self) -> list[Node]:
        columns = formulas.nullspace(self.target.exact.of.rows)
        return [formulas.to_tree(entry) for line in zip(*columns, strict=True) for entry in line]

    def holds(self, cells: Cells) -> bool:
        found = [self.both(cell) for cell in cells]
        by_trees, by_sympy = self.bench.engines(self.row)
        positive = self.bench.names.positive
        return self._spans(
            by_trees,
            self.target.trees.of,
            [cell.trees for cell in found],
            lambda entry: field.vanishes(entry, "kernel", positive),
        ) and self._spans(by_sympy, self.target.exact.of, [cell.exact for cell in found], formulas.is_zero)

    def _spans(
        self, engine: Engine[Any], matrix: Matrix[Any], cells: Sequence[Any], is_zero: Callable[[Any], bool]
    ) -> bool:
        """Whether the columns are mapped to zero, and are as many as there are independent ones."""
        basis = Matrix(shaped(cells, self._columns))
        image = engine.product(matrix, basis)
        if not all(map(is_zero, image.entries)):
            return False
        nullity = matrix.shape[1] - engine.rank(matrix)
        return engine.rank(basis) == nullity == basis.shape[1]

    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        basis = shaped([point.value(cell) for cell in cells], self._columns)
        matrix = [[point.base.value(entry) for entry in line] for line in self.target.trees.of.rows]
        yield [
            sum(a * line[k] for a, line in zip(entries, basis, strict=True)) % field.PRIME
            for entries in matrix
            for k in range(self._columns)
        ]


class EqualMatrix(Plan):
    """A formula whose value is a matrix, such as a product, equals the target."""

    @property
    def targets(self) -> list[Node]:
        return []

    def holds(self, cells: Cells) -> bool:
        found = self.both(cells[0])
        if not isinstance(found.trees, Matrix) or found.trees.shape != self.target.trees.shape:
            return False
        sides = (found.trees, self.target.trees, found.exact, self.target.exact)
        places = zip(*(matrix.entries for matrix in sides), strict=True)
        return all(self.vanish(difference(a, b), c - d) for a, b, c, d in places)

    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        try:
            found = self.bench.engines(self.row)[0].value(self.bench.scope(self.row).ours(cells[0]))
        except BadInput:
            found = None
        if not isinstance(found, Matrix) or found.shape != self.target.trees.shape:
            yield [1]
            return
        yield [
            (point.base.value(a) - point.base.value(b)) % field.PRIME
            for a, b in zip(found.entries, self.target.trees.entries, strict=True)
        ]
