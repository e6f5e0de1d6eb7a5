"""The arithmetic that generated code calls, on power series of balls; an arc states how its comparisons come out.

All numbers are power series, those of one term included, since python-flint is fast with these. A series that was made
while ``ctx.cap`` was small stays short in every operation, so constants are made by :func:`constant`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

from flint import arb, arb_series, ctx

Ball = Any
"""An ``arb`` of FLINT: an interval of real numbers, represented by midpoint and radius."""
Series = Any
"""An ``arb_series`` of FLINT: a power series whose coefficients are intervals."""
Key = tuple[str, int]
"""Name of a generated function, and the number of one of the comparisons in it."""

LONGEST_PRODUCT = 1000
"""Largest number of terms of a series that may be multiplied by a constant."""


class BeyondProof(Exception):
    """The problem has a feature that this proof does not cover; the message names it."""


class NotProved(Exception):
    """A step of the proof fails; the message says which step, where, and what would help."""


def constant(value: Any) -> Series:
    """Return a value as a series of one term, with unlimited precision in the variable."""
    cap, ctx.cap = ctx.cap, LONGEST_PRODUCT
    try:
        return arb_series([arb(value)])
    finally:
        ctx.cap = cap


@dataclass
class Answers:
    """The outcomes of comparisons in generated code along an arc, and the differences that must then be positive.

    Attributes
    ----------
    given
        Whether the smaller side is the first one, by comparison. What is not there is read from midpoints and kept: no
        proof, for each difference is noted and its sign shown by whoever claims anything.
    noted
        What must be positive for the answers to hold; ``None`` while nobody asks.
    """

    given: dict[Key, bool] = field(default_factory=dict)
    noted: list[tuple[Key, Series]] | None = None

    def notes(self, evaluate: Callable[[], Any]) -> list[tuple[Key, Series]]:
        """Return the differences that an evaluation compares."""
        self.noted = []
        try:
            evaluate()
            return self.noted
        finally:
            self.noted = None

    def below(self, key: Key, a: Any, b: Any) -> bool:
        """Answer whether a < b, where the two differ."""
        for bound, side in ((a, True), (b, False)):
            if isinstance(bound, float) and math.isinf(bound):  # where a control has no bound
                return (bound < 0.0) == side
        difference = b - a
        answer = self.given.setdefault(key, bool(difference[0].mid() > 0))
        if self.noted is not None:
            self.noted.append((key, difference if answer else -difference))
        return answer

    def magnitude(self, key: Key, a: Series) -> Series:
        """Return the absolute value of a number that is not zero."""
        return -a if self.below(key, a, constant(0)) else a


def _atan2(y: Series, x: Series) -> Series:
    """Return the angle of a vector by integrating its derivative."""
    y, x = (v if hasattr(v, "sin") else constant(v) for v in (y, x))
    for one in (y, x):
        if hasattr(one, "angle"):  # of a jet
            return one.angle(y, x)
    rate = (x * y.derivative() - y * x.derivative()) / (x * x + y * y)
    return rate.integral() + constant(arb.atan2(y[0], x[0]))


def _hyperbolic(sign: int) -> Callable[[Series], Series]:
    return lambda a: (a.exp() + (-a).exp() * constant(sign)) / constant(2)


def mathematics() -> SimpleNamespace:
    """Return the replacement of the module ``math`` in generated code, with pi to the present precision."""
    called = {name: _method(name) for name in ("sin", "cos", "tan", "sqrt", "exp", "log", "asin", "acos", "atan")}
    sinh, cosh = _hyperbolic(-1), _hyperbolic(1)
    return SimpleNamespace(
        atan2=_atan2, sinh=sinh, cosh=cosh, tanh=lambda a: sinh(a) / cosh(a), pi=constant(arb.pi()), **called
    )


def _method(name: str) -> Callable[[Series], Series]:
    def called(a: Any) -> Any:
        if name == "sqrt" and isinstance(a, arb_series) and not any(v != 0 for v in a.coeffs()):
            return a  # of what is zero all along
        return getattr(a if hasattr(a, name) else constant(a), name)()

    return called


def value(number: Any) -> Ball:
    """Return the first term of a result of generated code."""
    return number[0] if isinstance(number, arb_series) else arb(number)


def balls(numbers: Any) -> list[Ball]:
    """Return the first terms of several results of generated code."""
    return [value(v) for v in numbers]
