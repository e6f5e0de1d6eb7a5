"""Plans of comparison for expressions, equations, matrix entries, eigenvalues, null spaces and matrix products."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import Any

from satsym.auditing.comparison.bench import Bench, Both
from satsym.auditing.comparison.plan import BoundPoint, Cells, Plan
from satsym.auditing.ledger.contents import Row
from satsym.formula import field
from satsym.formula.angles import Complex, Monomial, TooManyTerms, over, terms_of
from satsym.formula.calculus import difference, product, raised
from satsym.formula.evaluation import Engine
from satsym.formula.tree import (
    Add,
    Call,
    Equality,
    Neg,
    Node,
    Sym,
    calls_in,
    number,
    shaped,
    substituted,
    symbols,
    walk,
)
from satsym.formula.values import Matrix
from satsym.formula.writing import written
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas

_MOST_FACTORS = 60
_SIMPLEST = 6
_MOST_DRAWS = 40
"""Number of random points tried to find two at which all roots have values in the prime field."""
_LONGEST_DIFFERENCE = 120
"""Number of characters above which a difference is not printed."""


class Equal(Plan):
    """Plan: each printed cell equals its target, a value of class :class:`Both`."""

    @cached_property
    def targets(self) -> list[Node]:
        return [formulas.to_tree(target.exact) for target in self.target]

    def holds(self, cells: Cells) -> bool:
        return all(self.cell_holds(i, cell) for i, cell in enumerate(cells))

    def alone(self, index: int) -> Equal:
        """Return the plan of one cell only."""
        return Equal(self.bench, self.row, (self.printed[index],), (self.labels[index],), (self.target[index],))

    def gaps(self, index: int) -> Iterator[Node]:
        yield difference(self.targets[index], self.normal(self.printed[index]))

    def difference(self) -> str:
        if len(self.printed) > 1:
            return ""
        try:
            lacking = formulas.short(self.target[0].exact - self.both(self.printed[0]).exact)
        except formulas.NotAFormula:
            return ""
        text = written(self.bench.theirs(self.row, formulas.to_tree(lacking)))
        return text if len(text) <= _LONGEST_DIFFERENCE else ""

    def cell_holds(self, index: int, cell: Node) -> bool:
        """Return whether a formula in the place of one cell would be right."""
        found, target = self.both(cell), self.target[index]
        if isinstance(found.exact, Matrix):
            raise BadInput("a symbol that denotes a matrix cannot be compared with a number")
        return self.vanish(difference(found.trees, target.trees), found.exact - target.exact)

    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        yield [
            (point.value(cell) - point.base.value(aim)) % field.PRIME
            for cell, aim in zip(cells, self.targets, strict=True)
        ]


class Multiple(Plan):
    """Plan: lhs - rhs of the printed equation is lhs - rhs of the target, times a factor that never vanishes."""

    def __init__(self, bench: Bench, row: Row, sides: Equality, target: Both) -> None:
        super().__init__(bench, row, (sides.lhs, sides.rhs), ("left-hand side", "right-hand side"), target.exact)
        self._trees = difference(target.trees.lhs, target.trees.rhs)
        self._exact = target.exact.lhs - target.exact.rhs
        self._aim = formulas.to_tree(self._exact)

    @property
    def targets(self) -> list[Node]:
        return [formulas.to_tree(self.target.lhs), formulas.to_tree(self.target.rhs)]

    @cached_property
    def factors(self) -> list[Node]:
        """Factors that may relate the printed equation to the target, as quotients of single terms."""
        printed = self.both_sides(self.printed).trees
        found: dict[Node, None] = {number(1): None, number(-1): None}
        try:
            pairs = [
                (a, b) for a in terms_of(printed).coefficients.items() for b in terms_of(self._aim).coefficients.items()
            ]
        except TooManyTerms:
            pairs = []
        for one, other in pairs:
            factor = _quotient(one, other, self.bench.names.positive)
            if factor is not None:
                found[factor] = None
        return list(found)[:_MOST_FACTORS]

    def gaps(self, index: int) -> Iterator[Node]:
        found = formulas.to_tree(self.both_sides(self.printed).exact)
        for factor in self.factors[:_SIMPLEST]:
            gap = difference(product([factor, self._aim]), found)
            yield Neg(gap) if index else gap

    def both_sides(self, cells: Cells) -> Both:
        """Return the difference of the two sides as computed by both engines."""
        lhs, rhs = map(self.both, cells)
        return Both(difference(lhs.trees, rhs.trees), lhs.exact - rhs.exact)

    def holds(self, cells: Cells) -> bool:
        found = self.both_sides(cells)
        for i, alternative in enumerate(zip(*(self.residuals(point, cells) for point in self.points), strict=True)):
            if not any(value for values in alternative for value in values):
                factor = self.factors[i]
                exact = formulas.from_tree(factor, self.bench.names.expression)
                if self.vanish(
                    difference(found.trees, product([factor, self._trees])), found.exact - exact * self._exact
                ):
                    return True
        quotient = formulas.nonvanishing_quotient(found.exact, self._exact) if self._may_be_multiple(cells) else None
        if quotient is None:
            return False
        tree = product([formulas.to_tree(quotient), self._trees])
        return self.vanish(difference(found.trees, tree), found.exact - quotient * self._exact)

    def _may_be_multiple(self, cells: Cells) -> bool:
        """Return whether the printed equation may be the target times a factor of positive symbols only.

        If it is, the ratio of the two is the same at all random points that agree in the positive symbols.
        """
        positive = self.bench.names.positive
        parts = [substituted(cell, self.meanings) for cell in cells]
        for call in (
            call for part in (*parts, self._aim) for call in calls_in(part) if call.function in field.BY_TERMS
        ):
            inside = symbols(call)
            if inside & positive and inside - positive and any(isinstance(part, Add) for _, part in walk(call)):
                return True  # a factor of it may be made of positive symbols, and has other values at each point
        quotients = set()
        for draw in range(_MOST_DRAWS):
            point = _SamePositive(f"multiple {draw}", positive)
            try:
                gap, aim = point.value(parts[0]) - point.value(parts[1]), point.value(self._aim)
            except field.NoValue:
                continue
            if gap % field.PRIME and aim:
                quotients.add(gap * pow(aim, -1, field.PRIME) % field.PRIME)
            if len(quotients) > 1:
                return False
        return True

    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        gap, aim = point.value(cells[0]) - point.value(cells[1]), point.base.value(self._aim)
        for factor in self.factors:
            yield [(gap - point.base.value(factor) * aim) % field.PRIME]


class _SamePositive(field.Point):
    """A random point whose positive symbols, and functions of positive symbols only, do not depend on the seed."""

    def __init__(self, seed: str, positive: frozenset[str]) -> None:
        super().__init__(seed, positive)
        self._shared = field.Point("same", positive)

    def symbol(self, name: str) -> int:
        """Return the value of a symbol modulo the prime.

        For a positive symbol it is the same at all points of this class.
        """
        return self._shared.symbol(name) if name in self._positive else super().symbol(name)

    def value_of_call(self, node: Call) -> int:
        """Return the value of a function, which does not depend on the seed if its symbols are all positive."""
        return self._shared.value(node) if symbols(node) <= {*self._positive} else super().value_of_call(node)


def _quotient(one: tuple[Monomial, Complex], other: tuple[Monomial, Complex], positive: frozenset[str]) -> Node | None:
    """Return the quotient of two terms if it never vanishes, otherwise ``None``."""
    (above, (a, a_imaginary)), (below, (b, b_imaginary)) = one, other
    if a_imaginary or b_imaginary:
        return None
    kept = over(above, below)
    if not all(name in positive for name, _ in kept):
        return None
    return product([number(a / b), *(raised(Sym(name), power) for name, power in kept)])


class SameRoots(Plan):
    """Plan: the printed cells are the eigenvalues of a matrix, in any order."""

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
    """Plan: the printed columns are a basis of the null space of a matrix."""

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
        """Return whether the columns are in the null space, linearly independent, and as many as its dimension."""
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
    """Plan: a formula whose value is a matrix, such as a product of matrices, equals the target."""

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
