"""Numbers with units: a document's values, results computed from them, and the precision of printed digits."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import reduce
from typing import Any

from satsym import units
from satsym.auditing.constants import PUBLISHED
from satsym.formula.reading import FUNCTIONS, MAX_DIGITS
from satsym.formula.tree import Add, Call, Div, Equality, Mul, Neg, Node, Num, Pow, Sym, Text, constant, symbols, walk
from satsym.status import BadInput
from satsym.wording import shown, suggestion

ROUNDED = "~"
"""Prefix of an input that is measured or rounded; an input without it is exact."""
_POINTS, _STARTS, _HOW = 64, 4, {"eps": 1e-4}
"""Parameters of the search for extrema: number of points, number of starting points, and step of the gradient."""
_PRINTED = re.compile(
    r" *(?P<sign>[-+]?) *(?P<whole>[0-9]*)(?:\.(?P<part>[0-9]*))?(?:[eE](?P<power>[-+]?[0-9]{1,3}))? *"
)
_BASES = {
    "[length]": "m",
    "[time]": "s",
    "[mass]": "kg",
    "[current]": "ampere",
    "[temperature]": "kelvin",
    "[substance]": "mole",
    "[luminosity]": "candela",
}
_FLOATS = {name: getattr(math, name) for name in "sin cos tan sqrt exp log asin acos atan sinh cosh tanh atan2".split()}
_FLOATS |= {"abs": abs, "min": min, "max": max}
_ROOTS = 12
"""Highest root of a unit that is supported."""


@dataclass(frozen=True)
class Quantity:
    """A value in base units with the exponents of its dimension."""

    value: float
    dimension: Mapping[str, Fraction]

    def __str__(self) -> str:
        unit = readable_unit(self.dimension)
        return f"{self.value:.6g}" if unit == "1" else f"{self.value:.6g} {unit}"

    def __add__(self, other: Quantity) -> Quantity:
        return Quantity(self.value + other.value, _same([self, other]))

    def __sub__(self, other: Quantity) -> Quantity:
        return Quantity(self.value - other.value, _same([self, other]))

    def __neg__(self) -> Quantity:
        return Quantity(-self.value, self.dimension)

    def __abs__(self) -> Quantity:
        return Quantity(abs(self.value), self.dimension)

    def __mul__(self, other: Quantity | float) -> Quantity:
        if isinstance(other, Quantity):
            return Quantity(self.value * other.value, _sum(self.dimension, other.dimension, Fraction(1)))
        return Quantity(self.value * other, self.dimension)

    __rmul__ = __mul__

    def __truediv__(self, other: Quantity | float) -> Quantity:
        if isinstance(other, Quantity):
            return Quantity(self.value / other.value, _sum(self.dimension, other.dimension, Fraction(-1)))
        return Quantity(self.value / other, self.dimension)

    def __rtruediv__(self, other: float) -> Quantity:
        return Quantity(other / self.value, _sum({}, self.dimension, Fraction(-1)))

    def __pow__(self, exponent: float | Fraction) -> Quantity:
        power = Fraction(exponent).limit_denominator(_ROOTS)
        return Quantity(self.value ** float(exponent), _sum({}, self.dimension, power))


@dataclass(frozen=True)
class PrintedNumber:
    """A printed number: value, half a unit of its last digit, and unit."""

    text: str
    value: Fraction
    half_unit: Fraction
    unit: str


def printed_number(text: str) -> PrintedNumber:
    """Read a number with a unit; trailing zeros are significant only after a decimal point."""
    text = text.removeprefix(ROUNDED)
    match = _PRINTED.match(text)
    if match is None or not (match["whole"] or match["part"]):
        raise BadInput(f'{shown(text)} is not a number with a unit; write, for instance, "35786 km"')
    part, power = match["part"], int(match["power"] or 0)
    digits = f"{match['whole']}{part or ''}"
    if len(digits) > MAX_DIGITS:
        raise BadInput(f"{shown(text)} has more than {MAX_DIGITS} digits; no measured value has so many digits")
    significant = digits if part is not None else digits.rstrip("0") or "0"
    last = power - len(part or "") + len(digits) - len(significant)
    value = Fraction(int(digits)) * Fraction(10) ** (power - len(part or ""))
    unit = text[match.end() :].strip() or "1"
    return PrintedNumber(text, -value if match["sign"] == "-" else value, Fraction(10) ** last / 2, unit)


def check_unit(unit: str) -> None:
    """Raise BadInput for an unknown unit; this loads pint."""
    if unit.strip() not in ("", "1"):
        units.dimension(unit)


def in_base_units(text: str) -> Quantity:
    """Return a number with a unit in base units."""
    number = printed_number(text)
    dimension = {base: Fraction(power) for base, power in units.dimension(number.unit).items()}
    if number.unit == "1":
        return Quantity(float(number.value), dimension)
    one = units.parse_quantity(f"1 {number.unit}", base_unit(dimension))
    return Quantity(float(number.value) * one, dimension)


def one(unit: str) -> Quantity:
    """Return one unit in base units."""
    return in_base_units(f"1 {unit}") if unit != "1" else Quantity(1.0, {})


def base_unit(dimension: Mapping[str, Fraction]) -> str:
    """Return the product of base units that has a given dimension."""
    if any(power.denominator != 1 or base not in _BASES for base, power in dimension.items()):
        raise BadInput("the exponents of a unit must be integers")
    return "*".join(f"{_BASES[base]}^{int(power)}" for base, power in dimension.items()) or "1"


def readable_unit(dimension: Mapping[str, Fraction]) -> str:
    """Write the unit that :func:`base_unit` returns with fractions in place of negative exponents: ``m/s^2``."""
    found = units.factors(base_unit(dimension))
    return units.expression(dict(sorted(found.items(), key=lambda one: one[0] != "kg"))).replace("**", "^")


def check(tree: Node | Equality, inputs: Mapping[str, str]) -> None:
    """Refuse names in the formula of a number that are neither inputs of the document nor published constants."""
    if isinstance(tree, Equality):
        raise BadInput("is an equation; write only the expression for the number")
    known = {*inputs, *PUBLISHED, "pi"}
    for _, part in walk(tree):
        if isinstance(part, Sym) and part.name not in known:
            raise BadInput(
                f"{shown(part.name)} is neither in [inputs] nor one of the published constants; "
                f"{suggestion(part.name, known)}"
            )


def is_numeric(tree: Node | Equality) -> bool:
    """Return whether a formula contains only numbers and inputs, and nothing derived."""
    return not isinstance(tree, Equality) and all(
        not isinstance(part, Text) and (not isinstance(part, Call) or part.function in FUNCTIONS)
        for _, part in walk(tree)
    )


def evaluated(tree: Node, inputs: Mapping[str, str]) -> Quantity:
    """Return the value of a formula for the document's inputs and published constants.

    Raises
    ------
    BadInput
        If the formula adds or compares different dimensions, or has no finite value.
    """
    return _finite(tree, _known(tree, inputs))


def _known(tree: Node, inputs: Mapping[str, str]) -> dict[str, Quantity]:
    texts = {**PUBLISHED, **inputs}
    return {name: in_base_units(texts[name]) for name in symbols(tree) if name != "pi" or "pi" in inputs}


def _finite(tree: Node, known: Mapping[str, Quantity]) -> Quantity:
    try:
        found = _evaluated(tree, known)
    except (ArithmeticError, ValueError) as error:
        raise BadInput(f"the formula has no value ({error})") from None
    if not math.isfinite(found.value):
        raise BadInput("the formula has no finite value")
    return found


def bounds(tree: Node, inputs: Mapping[str, str]) -> tuple[float, float]:
    """Return the smallest and largest value of a formula over all values of its rounded inputs.

    A tilde marks a rounded input (``"~ 6378 km"``), which may have any value that its digits allow. If the formula is
    monotonic in each input, its extrema are at corners; otherwise they are found by descent from the best of evenly
    distributed points.
    """
    import numpy as np
    from scipy.optimize import minimize
    from scipy.stats import qmc

    known = {name: Quantity(found.value, {}) for name, found in _known(tree, inputs).items()}
    rounded = {name: text for name in sorted(known) if (text := inputs.get(name, "")).startswith(ROUNDED)}
    widths = np.array([float(n.half_unit) * one(n.unit).value for n in map(printed_number, rounded.values())])

    def at(shares: Any) -> float:
        moved = zip(rounded, (shares * widths).tolist(), strict=True)
        return _finite(tree, known | {name: Quantity(known[name].value + by, {}) for name, by in moved}).value

    middle, axes = at(np.zeros(len(widths))), np.eye(len(widths))
    if not rounded:
        return middle, middle
    corner = np.sign([at(axis) - at(-axis) for axis in axes])
    inside = 2.0 * qmc.Sobol(len(widths), scramble=False).random(_POINTS) - 1.0
    tried = np.vstack([corner, -corner, axes, -axes, inside])
    gaps = np.array([at(shares) - middle for shares in tried])
    size, box = np.abs(gaps).max() or 1.0, [(-1.0, 1.0)] * len(widths)

    def least(sign: float) -> float:
        starts = tried[np.argsort(sign * gaps, kind="stable")[:_STARTS]]
        ends = [minimize(lambda at_: sign * (at(at_) - middle) / size, x, bounds=box, options=_HOW).x for x in starts]
        return min((at(shares) for shares in (*starts, *ends)), key=lambda value: sign * value)

    return least(1.0), least(-1.0)


def _evaluated(tree: Node, known: Mapping[str, Quantity]) -> Quantity:
    if isinstance(tree, Num):
        return Quantity(float(tree.value), {})
    if isinstance(tree, Sym):
        return known[tree.name] if tree.name in known else Quantity(math.pi, {})
    if isinstance(tree, Neg):
        return -_evaluated(tree.operand, known)
    if isinstance(tree, Add):
        return reduce(operator.add, (_evaluated(term, known) for term in tree.terms))
    if isinstance(tree, Mul):
        return reduce(operator.mul, (_evaluated(factor, known) for factor in tree.factors))
    if isinstance(tree, Div):
        return _evaluated(tree.numerator, known) / _evaluated(tree.denominator, known)
    if isinstance(tree, Pow):
        return _evaluated(tree.base, known) ** (constant(tree.exponent) or Fraction(0))
    if isinstance(tree, Call) and tree.function in _FLOATS:
        arguments = [_evaluated(argument, known) for argument in tree.arguments]
        if tree.function in ("abs", "min", "max"):
            return Quantity(_FLOATS[tree.function](*(a.value for a in arguments)), _same(arguments))
        if tree.function == "sqrt":
            return arguments[0] ** Fraction(1, 2)
        shared = _same(arguments)
        if shared and tree.function != "atan2":
            raise BadInput(f"the argument of {tree.function} must be dimensionless")
        return Quantity(_FLOATS[tree.function](*(a.value for a in arguments)), {})
    raise BadInput("only numbers and functions of numbers are allowed here")


def _same(quantities: list[Quantity]) -> Mapping[str, Fraction]:
    first = quantities[0].dimension
    if any(quantity.dimension != first for quantity in quantities):
        raise BadInput("the formula adds or compares quantities of different dimensions")
    return first


def _sum(one: Mapping[str, Fraction], other: Mapping[str, Fraction], times: Fraction) -> dict[str, Fraction]:
    total = {base: one.get(base, Fraction(0)) + times * other.get(base, Fraction(0)) for base in {*one, *other}}
    return {base: total[base] for base in sorted(total) if total[base]}
