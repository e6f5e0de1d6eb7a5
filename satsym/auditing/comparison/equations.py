"""Plans for expressions, entries of matrices, and equations."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from functools import cached_property

from satsym.auditing.comparison.bench import Bench, Both
from satsym.auditing.comparison.plan import Cells, Plan
from satsym.auditing.ledger.contents import Row
from satsym.formula import field
from satsym.formula.angles import Complex, Monomial, TooManyTerms, terms_of
from satsym.formula.bound import BoundPoint
from satsym.formula.calculus import difference, product, raised
from satsym.formula.tree import Add, Call, Equality, Neg, Node, Sym, calls_in, number, substituted, symbols, walk
from satsym.formula.values import Matrix
from satsym.formula.writing import written
from satsym.status import BadInput
from satsym.symbolic.lookup import formulas

_MOST_FACTORS = 60
_SIMPLEST = 6
_MOST_DRAWS = 40
"""Points tried for two at which roots have values."""
_LONGEST_DIFFERENCE = 120
"""Characters of a difference that is worth printing."""


class Equal(Plan):
    """Each cell equals its target, one of :class:`Both`."""

    @cached_property
    def targets(self) -> list[Node]:
        return [formulas.to_tree(target.exact) for target in self.target]

    def holds(self, cells: Cells) -> bool:
        return all(self.cell_holds(i, cell) for i, cell in enumerate(cells))

    def alone(self, index: int) -> Equal:
        """The plan of one cell."""
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
        """Whether one cell would be right."""
        found, target = self.both(cell), self.target[index]
        if isinstance(found.exact, Matrix):
            raise BadInput("a symbol for a matrix is compared with an expression that is a number")
        return self.vanish(difference(found.trees, target.trees), found.exact - target.exact)

    def residuals(self, point: BoundPoint, cells: Cells) -> Iterator[list[int]]:
        yield [
            (point.value(cell) - point.base.value(aim)) % field.PRIME
            for cell, aim in zip(cells, self.targets, strict=True)
        ]


class Multiple(Plan):
    """The difference of two sides is that of the target's, times a factor that never vanishes."""

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
        """Factors that may stand between the printed equation and the target: quotients of single terms."""
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
        """The difference of the sides by both engines."""
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
        """Whether the quotient of the differences may be made of positive symbols alone: then only these change it."""
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
    """A point at which positive symbols, and functions of them alone, have the same values whatever its seed is."""

    def __init__(self, seed: str, positive: frozenset[str]) -> None:
        super().__init__(seed, positive)
        self._shared = field.Point("same", positive)

    def symbol(self, name: str) -> int:
        """The value of a symbol."""
        return self._shared.symbol(name) if name in self._positive else super().symbol(name)

    def value_of_call(self, node: Call) -> int:
        """The value of a function."""
        return self._shared.value(node) if symbols(node) <= {*self._positive} else super().value_of_call(node)


def _quotient(one: tuple[Monomial, Complex], other: tuple[Monomial, Complex], positive: frozenset[str]) -> Node | None:
    """The quotient of two terms, if it never vanishes."""
    (above, (a, a_imaginary)), (below, (b, b_imaginary)) = one, other
    if a_imaginary or b_imaginary:
        return None
    powers = dict(above)
    for name, power in below:
        powers[name] = powers.get(name, Fraction(0)) - power
    kept = {name: power for name, power in powers.items() if power}
    if not all(name in positive for name in kept):
        return None
    return product([number(a / b), *(raised(Sym(name), power) for name, power in sorted(kept.items()))])
