"""The matrices of a linearisation as fractions, where the model and its numbers have none but rational ones.

The generated functions are called with fractions in place of floats. Decimals count as written: a parameter of at most
15 digits, and a number in a formula that is a simple fraction or has few digits. Wherever a root, a sine or a number of
more digits comes in, the matrices are not known exactly.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from satsym.analysis.linear.rational import Rational, matrix
from satsym.arrays import Array
from satsym.kernels import Kernels

SIMPLE = 10_000
"""Largest denominator of a simple fraction: of floats that are none, one in a hundred million looks like one."""
DIGITS_OF_PARAMETERS, DIGITS_OF_FORMULAS = 15, 12
"""Most digits of a number that is read as the decimal it prints as: of a parameter that a user wrote, and of a value of
a formula. A float that was computed usually has more."""

SAME_AS_FLOATS = (0, 1)
"""Numbers at which functions have exact values, as sin(0) and log(1), or one of too many digits."""


class NotRational(ArithmeticError):
    """A number that is not known as a fraction."""


class Ratio:
    """A fraction, in formulas that are written for floats."""

    __slots__ = ("value",)

    def __init__(self, value: Fraction) -> None:
        self.value = value

    def __float__(self) -> float:
        if self.value in SAME_AS_FLOATS:
            return float(self.value)
        raise NotRational

    def __bool__(self) -> bool:
        return self.value != 0

    def __neg__(self) -> Ratio:
        return Ratio(-self.value)

    def __abs__(self) -> Ratio:
        return Ratio(abs(self.value))

    def __pow__(self, power: float | Ratio) -> Ratio:
        exponent = fraction(power)
        if exponent.denominator != 1:
            raise NotRational
        return Ratio(self.value ** int(exponent))


def _forward(name: str) -> Callable[[Ratio, Any], Any]:
    function = getattr(operator, name)
    return lambda one, other: _wrapped(function(one.value, fraction(other)))


def _backward(name: str) -> Callable[[Ratio, Any], Any]:
    function = getattr(operator, name)
    return lambda one, other: _wrapped(function(fraction(other), one.value))


def _wrapped(value: Any) -> Any:
    return Ratio(value) if isinstance(value, Fraction) else value


for _name in ("add", "sub", "mul", "truediv"):
    setattr(Ratio, f"__{_name}__", _forward(_name))
    setattr(Ratio, f"__r{_name}__", _backward(_name))
for _name in ("eq", "ne", "lt", "le", "gt", "ge"):
    setattr(Ratio, f"__{_name}__", _forward(_name))


def fraction(number: float | Ratio) -> Fraction:
    """A number of a formula as a fraction.

    Raises
    ------
    NotRational
        If it has too many digits to be one.
    """
    if isinstance(number, Ratio):
        return number.value
    if not np.isfinite(number):
        raise NotRational
    simple = Fraction(number).limit_denominator(SIMPLE)
    if float(simple) == number:
        return simple
    written = _written(number, DIGITS_OF_FORMULAS)
    if written is None:
        raise NotRational
    return written


def _written(number: float, digits: int) -> Fraction | None:
    """The decimal that a float was read from; none if that has more digits."""
    shortest = repr(float(number))
    mantissa = shortest.partition("e")[0].replace(".", "").lstrip("-0").rstrip("0")
    return Fraction(shortest) if len(mantissa) <= digits else None


def given(number: float) -> Any:
    """A number that users gave, as a fraction; as the float that it is where it has too many digits."""
    written = _written(number, DIGITS_OF_PARAMETERS)
    return number if written is None else Ratio(written)


def exact_matrices(model: Kernels, parameters: Sequence[float], t0: float, point: Array) -> Rational | None:
    """A, B and C where a model is linearised; ``None`` where they, or that point, are not known exactly.

    Parameters
    ----------
    point
        The reference at t0, zero, or an equilibrium, shape (n,).
    """
    if model.backend != "python":
        return None
    n, m, k = len(point), len(model.spec.controls), len(model.spec.outputs)
    p, t, rest = tuple(map(given, parameters)), given(t0), (0.0,) * m
    try:
        x = [*model.reference(t, p)] if model.spec.has_reference else list(map(given, point.tolist()))
        if not (model.spec.has_reference or model.spec.linear) and any(map(fraction, model.dynamics(t, x, rest, p))):
            return None
        A, B = model.jacobian_x(t, x, rest, p), model.jacobian_u(t, x, rest, p) if m else ()
        C = model.output_matrix(t, p) if k else ()
        return Rational(*(_matrix(*each) for each in ((A, n, n), (B, n, m), (C, k, n))))
    except (ArithmeticError, TypeError, ValueError):
        return None


def _matrix(values: Sequence[float | Ratio], rows: int, columns: int) -> Any:
    return matrix(np.array([fraction(value) for value in values], dtype=object).reshape(rows, columns))
