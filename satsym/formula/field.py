"""The second engine: formulas evaluated exactly, with whole numbers modulo a prime, at random points.

Two formulas that are equal by the laws of arithmetic, roots, angles and exponentials have equal values at every
point. Two that differ agree at a random point with a probability of about their degree divided by the prime, 2e18
(Schwartz 1980, Zippel 1979). Nothing is rounded, and nothing of sympy is used.

The prime has two properties. One is that -1 has a root, so the imaginary unit is a number, and e^(ix) is one number
from which the cosine and the sine follow. The other is that small primes have square roots. *Positive* is what has
an odd order: among those each square root is unique, and the root of a product is the product of the roots, as for
positive real numbers. Symbols are drawn positive or with a sign; a sum under a root is positive by chance only, and
if it is not, another point is drawn.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Iterable, Iterator
from fractions import Fraction
from functools import lru_cache
from typing import TypeVar

from satsym.formula.angles import HALF_TURNS, PARTS, Terms, TooManyTerms, terms_of
from satsym.formula.tree import Add, Call, Div, Mul, Neg, Node, Num, Pow, Sym, constant
from satsym.formula.writing import written

P = TypeVar("P", bound="Point")
PRIME = 2305843009139462809
"""A prime below 2^61; PRIME - 1 = 2^3 * 3 * 17 * 5651576002792801."""
POINTS = 12
DRAWS = 400
"""Largest number of points that are tried."""

_TWO_PART, _THREE_PART = 8, 3
_ODD = (PRIME - 1) // _TWO_PART
_TO_POSITIVE = 24
IMAGINARY = pow(29, (PRIME - 1) // 4, PRIME)
"""A root of -1 modulo the prime, since 29 is no square."""


BY_TERMS = frozenset({"sin", "cos", "tan", "exp", "sinh", "cosh", "tanh"})
"""Functions whose arguments are expanded into terms."""


class NoValue(Exception):
    """The formula has no value at this point: it divides by zero, or takes a root that does not exist."""


class Nowhere(NoValue):
    """The formula has no value at any point, except with probability 1e-18: it divides by zero, or is no formula."""


class Undecided(Exception):
    """No point was found at which the formula has a value."""


class Point:
    """Random values of all symbols, drawn when they are requested.

    Parameters
    ----------
    seed
        The same seed gives the same point.
    positive
        Names of symbols that are positive.
    strict
        Whether roots of what is not positive have no value; otherwise the root of -1 is the imaginary unit.
    """

    def __init__(self, seed: str, positive: Collection[str] = (), strict: bool = True) -> None:
        self._seed = seed
        self._positive = positive
        self.strict = strict
        self._memory: dict[int, tuple[Node, int]] = {}

    def value(self, node: Node) -> int:
        """Return the value of a formula at this point.

        Raises
        ------
        NoValue
            If it has none here.
        """
        # by identity: an edited tree shares most of its parts with the original
        known = self._memory.get(id(node))
        if known is not None and known[0] is node:
            return known[1]
        value = self._value(node)
        self._memory[id(node)] = (node, value)
        return value

    def _value(self, node: Node) -> int:
        if isinstance(node, Num):
            return node.value.numerator * _inverse(node.value.denominator) % PRIME
        if isinstance(node, Sym):
            return self.symbol(node.name)
        if isinstance(node, Neg):
            return -self.value(node.operand) % PRIME
        if isinstance(node, Add):
            return sum(map(self.value, node.terms)) % PRIME
        if isinstance(node, Mul):
            product = 1
            for factor in node.factors:
                product = product * self.value(factor) % PRIME
            return product
        if isinstance(node, Div):
            return self.value(node.numerator) * _inverse(self.value(node.denominator)) % PRIME
        if isinstance(node, Pow):
            return self._power(self.value(node.base), constant(node.exponent))
        if isinstance(node, Call):
            return self.value_of_call(node)
        raise Nowhere(f"{type(node).__name__} is not a formula")

    def symbol(self, name: str) -> int:
        """Return the value of a symbol."""
        if name == "I":
            return IMAGINARY
        return _symbol(self._seed, name, name in self._positive or name == "pi")

    def _power(self, base: int, exponent: Fraction | None) -> int:
        if exponent is None:
            raise Nowhere("an exponent is not a number")
        if base == 0:
            if exponent <= 0:
                raise Nowhere("zero to the power of zero, or less")
            return 0
        root, degree = base, exponent.denominator
        while degree % 2 == 0:
            root, degree = self._square_root(root), degree // 2
        while degree % 3 == 0:
            root, degree = self._cube_root(root), degree // 3
        if degree > 1:
            root = pow(root, pow(degree, -1, PRIME - 1), PRIME)
        return pow(root, exponent.numerator, PRIME)

    def _square_root(self, base: int) -> int:
        unit, size = _split(base, _TWO_PART)
        if unit != 1 and (self.strict or unit != PRIME - 1):
            raise NoValue("the square root of a number that is not positive")
        root = pow(size, (_ODD + 1) // 2, PRIME)
        return root if unit == 1 else root * IMAGINARY % PRIME

    def _cube_root(self, base: int) -> int:
        unit, size = _split(base, _THREE_PART)
        if unit != 1:
            raise NoValue("the cube root of a number that is not positive")
        return pow(size, pow(3, -1, (PRIME - 1) // _THREE_PART), PRIME)

    def value_of_call(self, node: Call) -> int:
        """Return the value of a function call."""
        name = node.function
        if name in ("sin", "cos", "tan"):
            inner = node.arguments[0]
            if isinstance(inner, Call) and inner.function in ("asin", "acos", "atan"):
                return self._of_an_inverse(name, inner.function, self.value(inner.arguments[0]))
            turn = self._exponential(_terms(node.arguments[0]).times_i())
            return _circular(name, turn)
        if name == "exp":
            return self._exponential(_terms(node.arguments[0]))
        if name in ("sinh", "cosh", "tanh"):
            growth = self._exponential(_terms(node.arguments[0]))
            back = _inverse(growth)
            sine, cosine = (growth - back) * _HALF % PRIME, (growth + back) * _HALF % PRIME
            return {"sinh": sine, "cosh": cosine}.get(name) or sine * _inverse(cosine) % PRIME
        arguments = [self.value(argument) for argument in node.arguments]
        if name == "sqrt":
            return self._power(arguments[0], Fraction(1, 2))
        if name == "abs":
            return self._size(arguments[0])
        if name == "sign":
            return arguments[0] * _inverse(self._size(arguments[0])) % PRIME
        if name in ("min", "max"):
            one, other = arguments
            gap = self._size(one - other) * (1 if name == "max" else -1)
            return (one + other + gap) * _HALF % PRIME
        # any other function is known by its arguments alone
        return _random(self._seed, f"{name}({','.join(map(str, arguments))})")

    def _of_an_inverse(self, name: str, inverse: str, value: int) -> int:
        """Return the sine, cosine or tangent of an angle that is itself given by an inverse function."""
        if inverse == "atan":
            cosine = self._power((1 + value * value) % PRIME, Fraction(-1, 2))
            sine = value * cosine % PRIME
        else:
            other = self._power((1 - value * value) % PRIME, Fraction(1, 2))
            sine, cosine = (value, other) if inverse == "asin" else (other, value)
        if name == "tan":
            return value if inverse == "atan" else sine * _inverse(cosine) % PRIME
        return sine if name == "sin" else cosine

    def _size(self, value: int) -> int:
        return self._power(value * value % PRIME, Fraction(1, 2)) if value % PRIME else 0

    def _exponential(self, terms: Terms) -> int:
        """Return the exponential of a sum as a product of powers, one for each term."""
        product = 1
        for key, (real, imaginary) in terms.coefficients.items():
            if key == HALF_TURNS:
                if real or (2 * imaginary).denominator != 1:
                    raise Nowhere("an angle that is not a multiple of a right angle")
                product = product * pow(IMAGINARY, int(2 * imaginary), PRIME) % PRIME
                continue
            for kind, fraction in (("grows", real * PARTS), ("turns", imaginary * PARTS)):
                if fraction.denominator != 1:
                    raise Nowhere("an odd part of an angle")
                if fraction:
                    # what grows is positive, as the exponential of a real number is
                    base = pow(_random(self._seed, f"{kind} {key}"), _TO_POSITIVE if kind == "grows" else 1, PRIME)
                    product = product * pow(base, int(fraction), PRIME) % PRIME
        return product


def _terms(node: Node) -> Terms:
    try:
        return terms_of(node)
    except TooManyTerms as error:
        raise Nowhere(str(error)) from None


def vanishes(tree: Node, seed: str, positive: Collection[str] = (), points: int = POINTS) -> bool:
    """Tell whether a formula is zero at random points.

    Parameters
    ----------
    tree
        The formula; usually a difference.
    positive
        Names of symbols that are positive.
    points
        How many points must agree.

    Raises
    ------
    Undecided
        If it has no value anywhere.
    """
    return all(point.value(tree) == 0 for point in points_for((tree,), seed, positive, points))


def points_for(trees: Iterable[Node], seed: str, positive: Collection[str] = (), count: int = POINTS) -> list[Point]:
    """Return points at which all of some formulas have values.

    Raises
    ------
    Undecided
        If there are not enough.
    """
    wanted = list(trees)
    found = drawn(
        lambda draw, strict: Point(f"{seed} {draw}", positive, strict), lambda point: [*map(point.value, wanted)], count
    )
    try:
        return list(found)[-count:]
    except Undecided:
        raise Undecided(f"no point at which {written(wanted[0])[:60]} has a value") from None


def drawn(point: Callable[[int, bool], P], tried: Callable[[P], object], count: int, draws: int = DRAWS) -> Iterator[P]:
    """Yield points at which something has a value, until there are so many of one kind.

    Parameters
    ----------
    point
        The point of a draw; first those at which only positive numbers have roots, then others.
    tried
        What has to have a value.

    Raises
    ------
    Undecided
        If there are not enough.
    """
    for strict in (True, False):
        found = 0
        for draw in range(draws):
            one = point(draw, strict)
            try:
                tried(one)
            except Nowhere:
                break
            except NoValue:
                continue
            yield one
            found += 1
            if found == count:
                return
    raise Undecided("no point was found at which the printed expression has a value")


@lru_cache(maxsize=65536)
def _symbol(seed: str, name: str, positive: bool) -> int:
    """Return the value of a symbol at the point of a seed: a fourth power, negated for a negative sign."""
    size = pow(_random(seed, name), _TO_POSITIVE, PRIME)
    return size if positive or _random(seed, f"{name} sign") % 2 else PRIME - size


def _random(seed: str, what: str) -> int:
    digest = hashlib.blake2b(f"{seed} {what}".encode(), digest_size=16).digest()
    return int.from_bytes(digest) % (PRIME - 1) + 1


_HALF = (PRIME + 1) // 2


def _inverse(value: int) -> int:
    if value % PRIME == 0:
        raise Nowhere("a division by zero")
    return pow(value, -1, PRIME)


def _split(value: int, part: int) -> tuple[int, int]:
    """Write a number as a root of unity of order `part` times a number whose order is prime to it."""
    rest = (PRIME - 1) // part
    unit = pow(value, rest * pow(rest, -1, part), PRIME)
    return unit, value * pow(unit, -1, PRIME) % PRIME


def _circular(name: str, turn: int) -> int:
    """Return cosine, sine or tangent from e^(ix)."""
    back = _inverse(turn)
    cosine = (turn + back) * _HALF % PRIME
    sine = (turn - back) * _HALF % PRIME * _inverse(IMAGINARY) % PRIME
    return {"cos": cosine, "sin": sine}[name] if name != "tan" else sine * _inverse(cosine) % PRIME


def rank(rows: list[list[int]]) -> int:
    """Return the rank of a matrix of numbers modulo the prime."""
    from flint import nmod_mat

    return int(nmod_mat(len(rows), len(rows[0]) if rows else 0, [e % PRIME for row in rows for e in row], PRIME).rank())
