"""The weight of a formula: bounds on its size after expansion, known from its tree beforehand.

A tree may share its parts: twenty abbreviations that each square the one before make a million terms of forty nodes. So
each part is weighed once, and the weight of a whole follows from those of its parts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TypeVar

from satsym.formula.budget import OverBudget
from satsym.formula.tree import Add, Call, Div, Equality, Mul, Neg, Node, Num, Pow, Sym, children, constant

T = TypeVar("T", bound=Node | Equality)
MAX_NODES = 50_000
"""Largest number of nodes of a tree, with shared parts counted each time; the shipped ledgers have up to 578."""
MAX_DEPTH = 110
"""Largest depth of brackets; the shipped ledgers have up to 17. Functions on trees are recursive, and Python stops at a
depth of a thousand calls."""
MAX_TERMS = 20_000
"""Largest number of terms of one printed formula after expansion."""
MAX_COMBINED_TERMS = 100_000
"""Largest number of terms of a combination of formulas; the shipped ledgers have up to 2112."""
MAX_DIGITS = 2000
"""Largest number of digits of a number after expansion; the shipped ledgers have up to 66."""
MAX_DEGREE = 500
"""Largest degree in all symbols; the shipped ledgers have up to 47. Dense polynomials are lists of that length."""
MAX_ARGUMENT = 1e30
"""Largest argument of an exponential or an angle at points of size one, whose whole part is computed exactly."""
MAX_CONSTANT_ARGUMENT = 1e4
"""Largest constant argument of an exponential, which may be written out with all digits."""

_GROWING = frozenset({"exp", "sinh", "cosh", "tanh"})
_TURNING = frozenset({"sin", "cos", "tan"})
_NEAR_ZERO = 1e-3
"""Assumed least magnitude of a sum or a function at a generic point."""


@dataclass(frozen=True, slots=True)
class Weight:
    """The weight of a tree: bounds on its terms, digits, degree and values."""

    nodes: int = 1
    depth: int = 1
    terms: int = 1
    digits: int = 1
    degree: int = 0
    """Nodes, depth, terms, digits and degree, as in the limits above."""
    largest: float = 2.0
    smallest: float = 0.5
    """Approximate largest and smallest magnitude at points whose coordinates are of size one."""
    number: bool = False
    """Whether the tree contains no symbol."""


@dataclass
class Scales:
    """Computes weights of trees, each part once."""

    max_terms: int = MAX_COMBINED_TERMS
    """Terms that a tree may have once multiplied out."""
    _known: dict[int, tuple[Node, Weight]] = field(default_factory=dict)

    def checked(self, tree: T) -> T:
        """Return the tree unchanged, or refuse it as too heavy.

        Raises
        ------
        OverBudget
            With what is exceeded.
        """
        for side in (tree.lhs, tree.rhs) if isinstance(tree, Equality) else (tree,):
            self.weight(side)
        return tree

    def weight(self, node: Node) -> Weight:
        """Return the weight of a tree that is not too heavy; see :meth:`checked`."""
        known = self._known.get(id(node))
        if known is not None:
            return known[1]
        found = _weight(node, [self.weight(child) for child in children(node)], self.max_terms)
        self._refuse(found)
        self._known[id(node)] = node, found
        return found

    def _refuse(self, found: Weight) -> None:
        if found.terms > self.max_terms or found.digits > MAX_DIGITS or found.degree > MAX_DEGREE:
            raise OverBudget("is too large when multiplied out; split it into parts, or use smaller exponents")
        if found.nodes > MAX_NODES:
            raise OverBudget(f"has more than {MAX_NODES} parts after abbreviations are replaced; split it")
        if found.depth > MAX_DEPTH:
            raise OverBudget(f"is nested more than {MAX_DEPTH} levels deep after abbreviations are replaced; split it")


def _weight(node: Node, parts: Sequence[Weight], max_terms: int) -> Weight:
    if isinstance(node, Num):
        size = abs(_float(node.value))
        digits = len(str(node.value.numerator)) + len(str(node.value.denominator))
        return Weight(digits=digits, largest=size, smallest=size, number=True)
    if not parts:
        return Weight(degree=1, largest=4.0) if isinstance(node, Sym) else Weight()
    largest, smallest = _sizes(node, parts)
    number = all(part.number for part in parts)
    if isinstance(node, Call):
        _refuse_argument(node.function, parts, number)
    terms, digits, degree = _multiplied_out(node, parts, max_terms)
    return Weight(
        nodes=1 + sum(part.nodes for part in parts),
        depth=1 + max(part.depth for part in parts),
        terms=terms,
        digits=digits,
        degree=degree,
        largest=largest,
        smallest=smallest,
        number=number,
    )


def _multiplied_out(node: Node, parts: Sequence[Weight], max_terms: int) -> tuple[int, int, int]:
    """Bound terms, digits and degree of a tree after expansion."""
    terms, digits, degree = max(p.terms for p in parts), max(p.digits for p in parts), max(p.degree for p in parts)
    if isinstance(node, Add):
        return sum(p.terms for p in parts), digits, degree
    if isinstance(node, Mul | Div):
        terms = 1
        for part in parts:
            terms = min(terms * part.terms, max_terms + 1)
        return terms, sum(p.digits for p in parts), sum(p.degree for p in parts)
    if isinstance(node, Pow):
        exponent = max(abs(constant(node.exponent) or Fraction(1)), Fraction(1))
        whole = min(math.ceil(exponent), MAX_DEGREE + 1)
        terms = 1
        for _ in range(min(whole, 20)):
            terms = min(terms * parts[0].terms, max_terms + 1)
        return terms, int(parts[0].digits * exponent) + 1, parts[0].degree * whole
    if isinstance(node, Call):
        return terms, digits, max(degree, 1)
    return terms, digits, degree


def _sizes(node: Node, parts: Sequence[Weight]) -> tuple[float, float]:
    """Bound the magnitude of a tree, above and below, at points of size one."""
    first = parts[0]
    if isinstance(node, Neg):
        return first.largest, first.smallest
    if isinstance(node, Add):
        largest = sum(part.largest for part in parts)
        value = constant(node) if all(part.number for part in parts) else None
        return (abs(_float(value)),) * 2 if value else (largest, min(_NEAR_ZERO, largest))
    if isinstance(node, Mul):
        return math.prod(part.largest for part in parts), math.prod(part.smallest for part in parts)
    if isinstance(node, Div):
        return _over(first.largest, parts[1].smallest), _over(first.smallest, parts[1].largest)
    if isinstance(node, Pow):
        exponent = float(constant(node.exponent) or 0)
        sizes = _power(first.largest, exponent), _power(first.smallest, exponent)
        return max(sizes), min(sizes)
    if isinstance(node, Call) and node.function in _SIZES:
        return _SIZES[node.function](max(part.largest for part in parts)), _NEAR_ZERO
    return max(part.largest for part in parts), _NEAR_ZERO


def _refuse_argument(function: str, parts: Sequence[Weight], number: bool) -> None:
    if function not in _GROWING | _TURNING:
        return
    limit = MAX_CONSTANT_ARGUMENT if number and function in _GROWING else MAX_ARGUMENT
    if not parts[0].largest <= limit:
        raise OverBudget(f"takes {function}(...) of numbers larger than {limit:.0e}; use smaller numbers")


def _float(value: Fraction) -> float:
    try:
        return float(value)
    except OverflowError:
        return math.inf


def _over(above: float, below: float) -> float:
    return above / below if below else math.inf


def _power(base: float, exponent: float) -> float:
    try:
        return base**exponent
    except OverflowError:
        return math.inf
    except ZeroDivisionError:
        return math.inf


def _grown(size: float) -> float:
    return math.exp(size) if size < 700.0 else math.inf


_SIZES: Mapping[str, Callable[[float], float]] = {
    **dict.fromkeys(("exp", "sinh", "cosh"), _grown),
    **dict.fromkeys(("sin", "cos", "tanh", "sign"), lambda _: 1.0),
    **dict.fromkeys(("asin", "acos", "atan", "atan2"), lambda _: 4.0),
    "tan": lambda _: 1.0 / _NEAR_ZERO,
    "log": lambda size: 100.0 + (math.log(size) if 1.0 < size < math.inf else 0.0),
    "sqrt": math.sqrt,
}
