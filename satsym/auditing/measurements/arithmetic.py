"""Functions of numbers, lists and curves, exact where their arguments are."""

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
    """Size of a number, of each point of a curve."""
    return abs(x)


def re(z: Any) -> Any:
    """Real part."""
    return z.as_real_imag()[0] if is_exact(z) else np.real(z)


def im(z: Any) -> Any:
    """Imaginary part."""
    return z.as_real_imag()[1] if is_exact(z) else np.imag(z)


def min_(values: Sequence[Any]) -> Any:
    """The smallest of a list, or of a curve."""
    return _extreme(values, -1)


def max_(values: Sequence[Any]) -> Any:
    """The largest of a list, or of a curve."""
    return _extreme(values, 1)


def len_(values: Sequence[Any]) -> int:
    """How many there are."""
    return len(values)


def sum_(values: Sequence[Any]) -> Any:
    """The sum of a list."""
    total = values[0]
    for entry in values[1:]:
        total = total + entry
    return total


def different(values: Sequence[Any]) -> list[Any]:
    """The entries of a list, each once."""
    found: list[Any] = []
    for entry in values:
        if not any(equal(entry, other).holds for other in found):
            found.append(entry)
    return found


def sqrt(x: Any) -> Any:
    """Square root."""
    if hasattr(x, "sqrt"):
        return x.sqrt()
    if not is_exact(x):
        return np.emath.sqrt(x)
    from satsym.symbolic.lookup import formulas

    return formulas.function("sqrt", [x])


def first(values: Sequence[Any]) -> Any:
    """The first entry."""
    return values[0]


def last(values: Sequence[Any]) -> Any:
    """The last entry."""
    return values[-1]


def mean(values: Sequence[float]) -> float:
    """The mean of a curve."""
    return float(np.mean(values))


def early(curve: Sequence[Any]) -> Sequence[Any]:
    """The first tenth of a curve."""
    return curve[: max(1, len(curve) // 10)]


def late(curve: Sequence[Any]) -> Sequence[Any]:
    """The last tenth of a curve."""
    return curve[-max(1, len(curve) // 10) :]


def area(curve: Sequence[float], t: Sequence[float]) -> float:
    """The integral of a curve over its times, by a cubic spline."""
    from scipy.interpolate import CubicSpline

    return float(CubicSpline(t, curve).integrate(t[0], t[-1]))


def defined(of: Any, **values: float) -> bool:
    """Whether a formula has a value where its letters have these, those that are not named being 1."""
    from satsym.symbolic.lookup import formulas

    known = {letter: formulas.rational(Fraction(values.get(letter.name, 1))) for letter in of.free_symbols}
    if any(part.func.__name__ in ("Min", "Max") for part in (of, *of.args)):  # sympy raises where these have no value
        return all(defined(part, **values) for part in of.args)
    return bool(of.xreplace(known).is_finite)


def turning_points(curve: Sequence[float]) -> int:
    """How often a curve turns from rising to falling or back."""
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
    """The Euclidean length of a list of numbers, or of a column."""
    if isinstance(of, np.ndarray):
        return float(np.linalg.norm(of))
    return sqrt(sum_([entry * entry for entry in _flat(of)]))


def cosine(one: Any, other: Any) -> Any:
    """The cosine of the angle between two lists of numbers, or columns."""
    pairs = zip(_flat(one), _flat(other), strict=True)
    return sum_([a * b for a, b in pairs]) / (norm(one) * norm(other))


def sign(x: Any) -> int:
    """-1, 0 or 1."""
    return ordered(x, 0)


def part(values: Sequence[Any], start: int, stop: int) -> Any:
    """The entries of a list from one place up to, but without, another; the first place is 0."""
    return values[start:stop]


def steps(values: Sequence[Any]) -> list[Any]:
    """By how much each entry exceeds the one before it."""
    return [b - a for a, b in pairwise(values)]


def convergence_order(errors: Sequence[float]) -> float:
    """The power of the step with which errors fall as it is halved again and again, to one decimal."""
    if min(errors[-2:]) <= 0.0:
        raise Undecided("there is no error left to compare")
    return round(math.log2(errors[-2] / errors[-1]), 1)


def _flat(of: Any) -> list[Any]:
    """The entries of a list, an array or a column."""
    return [entry for line in of.tolist() for entry in line] if getattr(of, "is_Matrix", False) else list(of)
