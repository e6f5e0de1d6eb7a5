"""Relations between values: equality and order.

Exact values are compared exactly. Computed values are equal if they agree within the tolerances :data:`RELATIVE` and
:data:`ABSOLUTE`, and one is less than the other only if it differs by more. A number in quotes is a printed number: it
stands for the interval of values that are rounded or truncated to its digits, in its unit.
"""

from __future__ import annotations

import ast
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any

import numpy as np

from satsym.auditing import quantities
from satsym.auditing.propositions.values import Undecided, in_words, is_exact
from satsym.auditing.quantities import PrintedNumber, Quantity
from satsym.status import BadInput
from satsym.symbolic.factoring import factored

RELATIVE, ABSOLUTE = 1e-6, 1e-9
"""Relative and absolute tolerance within which two computed numbers are called equal."""


class Fit(Enum):
    """Position of a value relative to the interval of a printed number."""

    INSIDE = "inside"
    NEAR = "near"  # a last digit off
    UNIT = "unit"  # off by the factor of a unit
    OUTSIDE = "outside"


@dataclass(frozen=True)
class Comparison:
    """Result of a relation between two values, such as equality."""

    holds: bool
    """Whether the relation between the values holds."""
    fit: Fit | None = None
    """Position of the value relative to the printed number; ``None`` if no number is printed."""


def compared(operator: ast.cmpop, left: Any, right: Any) -> Comparison:
    """Return whether a relation between two values holds.

    Raises
    ------
    Undecided
        If a value is not a number, or the values cannot be distinguished.
    BadInput
        If the values cannot be compared.
    """
    if isinstance(operator, ast.In | ast.NotIn):
        inside = any(equal(left, entry).holds for entry in _entries(right))
        return Comparison(inside == isinstance(operator, ast.In))
    if isinstance(operator, ast.Eq | ast.NotEq):
        found = equal(left, right)
        return found if isinstance(operator, ast.Eq) else Comparison(not found.holds)
    return Comparison(_ORDERS[type(operator)](order(left, right)))


_ORDERS: Mapping[type[ast.cmpop], Callable[[int], bool]] = {
    ast.Lt: lambda sign: sign < 0,
    ast.LtE: lambda sign: sign <= 0,
    ast.Gt: lambda sign: sign > 0,
    ast.GtE: lambda sign: sign >= 0,
}


def fit(value: Any, printed: PrintedNumber) -> Fit:
    """Return whether a value is inside the interval of a printed number, off by the last digit, or outside.

    The interval contains the values that are rounded or truncated to the digits: 0.15 is anything from 0.145 to below
    0.16.
    """
    number = _in_printed_unit(value, printed.unit)
    return fit_of_range(number, number, printed)


def fit_of_range(low: float, high: float, printed: PrintedNumber) -> Fit:
    """Return the position of a value, known to lie in a range, relative to a printed number; see :func:`fit`."""
    half = float(printed.half_unit)
    sign = -1.0 if printed.value < 0 else 1.0
    above = sorted(sign * (number - float(printed.value)) / half for number in (low, high))
    slack = 1e-9 * max(1.0, abs(float(printed.value)) / half)
    if above[1] >= -1.0 - slack and above[0] < 2.0 - slack:
        return Fit.INSIDE
    return Fit.NEAR if above[1] >= -3.0 - slack and above[0] < 4.0 - slack else Fit.OUTSIDE


def _in_printed_unit(value: Any, unit: str) -> float:
    number = _real(value.value if isinstance(value, Quantity) else value)
    if isinstance(value, Quantity):
        one = quantities.one(unit)
        if dict(one.dimension) != dict(value.dimension):
            raise BadInput(f"{in_words(value)} cannot be measured in {unit}")
        return number / one.value
    if unit != "1":
        raise BadInput(f"{in_words(value)} is dimensionless, so it cannot be measured in {unit}")
    return number


def equal(left: Any, right: Any) -> Comparison:
    """Return whether two values are equal, and if not whether only a last digit or a unit is wrong."""
    if isinstance(left, str) and not isinstance(right, str):
        left, right = right, left
    if isinstance(left, str | bool | np.bool_):
        return Comparison(bool(left == right))
    if isinstance(right, str):
        if _is_sequence(left):
            raise BadInput(f"a list cannot be compared with the string {in_words(right)}")
        how = fit(left, quantities.printed_number(right))
        return Comparison(how is Fit.INSIDE, how)
    if isinstance(left, Quantity) and isinstance(right, Quantity):
        holds = order(left, right) == 0
        return Comparison(holds, Fit.UNIT if not holds and _of_unit(left, right) else None)
    if _is_sequence(left) or _is_sequence(right):
        one, other = _entries(left), _entries(right)
        if len(one) != len(other):
            return Comparison(False)
        pairs = [equal(a, b) for a, b in zip(one, other, strict=True)]
        fits = [pair.fit for pair in pairs if not pair.holds]
        worst = fits[0] if fits and all(how is fits[0] for how in fits) else None
        return Comparison(all(pair.holds for pair in pairs), worst)
    return Comparison(_same(left, right))


def _of_unit(one: Quantity, other: Quantity) -> bool:
    """Return whether two quantities differ only by powers of ten, or by the factor between degrees and radians."""
    if one.value * other.value <= 0.0:
        return False
    ratio = math.log(one.value / other.value)
    steps = (ratio / math.log(10.0), ratio / math.log(math.radians(1.0)))
    return any(round(step) and abs(step - round(step)) < RELATIVE for step in steps)


def _same(left: Any, right: Any) -> bool:
    if isinstance(left, Quantity) or isinstance(right, Quantity):
        return order(left, right) == 0
    if is_exact(left) or is_exact(right):
        if not _has_floats(left) and not _has_floats(right):
            return _is_zero(left - right)
        left, right = complex(left), complex(right)
    if not (np.isfinite(left) and np.isfinite(right)):
        raise Undecided(f"{in_words(left)} and {in_words(right)} are not both numbers")
    return bool(abs(left - right) <= max(RELATIVE * max(abs(left), abs(right)), ABSOLUTE))


def order(left: Any, right: Any) -> int:
    """Return 1 if the first value is greater, -1 if it is less, 0 if both are equal."""
    if isinstance(left, str):
        return -order(right, left)
    if isinstance(right, str):
        printed = quantities.printed_number(right)
        left, right = _in_printed_unit(left, printed.unit), float(printed.value)
    if isinstance(left, Quantity) or isinstance(right, Quantity):
        left, right = (v if isinstance(v, Quantity) else Quantity(float(v), {}) for v in (left, right))
        if left.value and right.value and dict(left.dimension) != dict(right.dimension):
            raise BadInput(f"{in_words(left)} and {in_words(right)} have different dimensions")
        # the scale of a quantity is that of its unit, so that only relative differences count
        size = max(abs(left.value), abs(right.value))
        gap = left.value - right.value
        return 0 if abs(gap) <= RELATIVE * size else int(np.sign(gap))
    if is_exact(left) or is_exact(right):
        gap = left - right
        if not _has_floats(gap):
            return _exact_sign(gap)
    left, right = _real(left), _real(right)
    if math.isinf(left) or math.isinf(right):
        return (left > right) - (left < right)
    return 0 if _same(left, right) else (-1 if left < right else 1)


def _exact_sign(gap: Any) -> int:
    if _is_zero(gap):
        return 0
    for sign, known in ((1, gap.is_positive), (-1, gap.is_negative)):
        if known:
            return sign
    if gap.is_number:
        return 1 if float(gap) > 0.0 else -1
    simple = factored(gap)
    if simple.is_positive or simple.is_negative:
        return 1 if simple.is_positive else -1
    raise Undecided(f"the sign of {gap} depends on the values of its symbols")


def _is_zero(gap: Any) -> bool:
    from satsym.symbolic.lookup import formulas

    known = gap.is_zero
    return formulas.is_zero(gap) if known is None else bool(known)


def _has_floats(value: Any) -> bool:
    return isinstance(value, float | complex | np.number) or (
        is_exact(value) and any(part.is_Float for part in value.atoms())
    )


def _real(value: Any) -> float:
    number = complex(value)
    if math.isnan(abs(number)):
        raise Undecided(f"{in_words(value)} is not a number")
    if abs(number.imag) > max(RELATIVE * abs(number), ABSOLUTE):
        raise BadInput(f"{in_words(value)} is complex, so it cannot be ordered")
    return number.real


def _is_sequence(value: Any) -> bool:
    return isinstance(value, list | tuple | np.ndarray) or bool(getattr(value, "is_Matrix", False))


def _entries(value: Any) -> list[Any]:
    try:
        if not isinstance(value, str):
            return list(value.tolist() if hasattr(value, "tolist") else value)
    except TypeError:
        pass
    raise BadInput(f"{in_words(value)} is not a list")
