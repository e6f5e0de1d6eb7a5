"""Functions of numbers, lists and curves; results are exact if the arguments are."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from typing import Any

import numpy as np

from satsym.auditing.propositions.relations import equal
from satsym.auditing.propositions.relations import order as ordered
from satsym.auditing.propositions.values import Undecided, is_exact


def abs_(x: Any) -> Any:
    """Return the absolute value of a number, or of each point of a curve."""
    return abs(x)


def re(z: Any) -> Any:
    """Return the real part."""
    return z.as_real_imag()[0] if is_exact(z) else np.real(z)


def im(z: Any) -> Any:
    """Return the imaginary part."""
    return z.as_real_imag()[1] if is_exact(z) else np.imag(z)


def min_(values: Sequence[Any]) -> Any:
    """Return the smallest entry of a list or curve."""
    return _extreme(values, -1)


def max_(values: Sequence[Any]) -> Any:
    """Return the largest entry of a list or curve."""
    return _extreme(values, 1)


def len_(values: Sequence[Any]) -> int:
    """Return the number of entries."""
    return len(values)


def sum_(values: Sequence[Any]) -> Any:
    """Return the sum of a list."""
    total = values[0]
    for entry in values[1:]:
        total = total + entry
    return total


def different(values: Sequence[Any]) -> list[Any]:
    """Return the entries of a list without repetitions."""
    found: list[Any] = []
    for entry in values:
        if not any(equal(entry, other).holds for other in found):
            found.append(entry)
    return found


def sqrt(x: Any) -> Any:
    """Return the square root."""
    if hasattr(x, "sqrt"):
        return x.sqrt()
    if not is_exact(x):
        return np.emath.sqrt(x)
    from satsym.symbolic.lookup import formulas

    return formulas.function("sqrt", [x])


def first(values: Sequence[Any]) -> Any:
    """Return the first entry."""
    return values[0]


def last(values: Sequence[Any]) -> Any:
    """Return the last entry."""
    return values[-1]


def mean(values: Sequence[float]) -> float:
    """Return the mean value of a curve."""
    return float(np.mean(values))


def early(curve: Sequence[Any]) -> Sequence[Any]:
    """Return the first tenth of a curve."""
    return curve[: max(1, len(curve) // 10)]


def late(curve: Sequence[Any]) -> Sequence[Any]:
    """Return the last tenth of a curve."""
    return curve[-max(1, len(curve) // 10) :]


def area(curve: Sequence[float], t: Sequence[float]) -> float:
    """Return the integral of a curve with respect to time, computed with a cubic spline."""
    from scipy.interpolate import CubicSpline

    return float(CubicSpline(t, curve).integrate(t[0], t[-1]))


def defined(of: Any, **values: float) -> bool:
    """Return whether a formula has a finite value for the given values of its letters; letters not named are 1."""
    from satsym.symbolic.lookup import formulas

    known = {letter: formulas.rational(Fraction(values.get(letter.name, 1))) for letter in of.free_symbols}
    if any(part.func.__name__ in ("Min", "Max") for part in (of, *of.args)):  # sympy raises where these have no value
        return all(defined(part, **values) for part in of.args)
    return bool(of.xreplace(known).is_finite)


def turning_points(curve: Sequence[float]) -> int:
    """Return the number of local maxima and minima of a curve."""
    slopes = np.diff(np.asarray(curve, dtype=float))
    return int((slopes[1:] * slopes[:-1] < 0.0).sum())


def _extreme(values: Any, sign: int) -> Any:
    if isinstance(values, np.ndarray):
        return float(values.max() if sign > 0 else values.min())
    best = values[0]
    for entry in values[1:]:
        best = entry if sign * ordered(entry, best) > 0 else best
    return best


def norm(of: Any) -> Any:
    """Return the Euclidean norm of a list of numbers or of a column."""
    if isinstance(of, np.ndarray):
        return float(np.linalg.norm(of))
    return sqrt(sum_([entry * entry for entry in _flat(of)]))


def cosine(one: Any, other: Any) -> Any:
    """Return the cosine of the angle between two lists of numbers or columns."""
    pairs = zip(_flat(one), _flat(other), strict=True)
    return sum_([a * b for a, b in pairs]) / (norm(one) * norm(other))


def sign(x: Any) -> int:
    """Return the sign of a number: -1, 0 or 1."""
    return ordered(x, 0)


def part(values: Sequence[Any], start: int, stop: int) -> Any:
    """Return the entries of a list from index `start` up to, but not including, index `stop`; the first index is 0."""
    return values[start:stop]


def steps(values: Sequence[Any]) -> list[Any]:
    """Return the differences between successive entries of a list."""
    return [b - a for a, b in pairwise(values)]


def convergence_order(errors: Sequence[float]) -> float:
    """Return the order of convergence, to one decimal, from errors at steps that are halved from one to the next."""
    if min(errors[-2:]) <= 0.0:
        raise Undecided("there is no error left to compare")
    return round(math.log2(errors[-2] / errors[-1]), 1)


def _flat(of: Any) -> list[Any]:
    """Return the entries of a list, array or column as a list."""
    return [entry for line in of.tolist() for entry in line] if getattr(of, "is_Matrix", False) else list(of)
