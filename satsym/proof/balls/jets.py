"""Jets: values with first and second derivatives by several variables, on which generated code runs as on numbers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from flint import arb, arb_series, ctx

from satsym.proof.balls.arithmetic import Ball, constant, value

_First = dict[int, Any]
_Second = dict[tuple[int, int], Any]


class Jet:
    """A value with its gradient and its Hessian; entries that are identically zero are left out.

    Parameters
    ----------
    value
        A series of one term.
    first, second
        Entries by places of variables; of the Hessian those with i <= j.
    """

    __slots__ = ("first", "second", "value")

    def __init__(self, value: Any, first: _First | None = None, second: _Second | None = None) -> None:
        self.value, self.first, self.second = value, first or {}, second or {}

    def __getitem__(self, k: int) -> Ball:
        return self.value[k]

    def __add__(self, other: Any) -> Jet:
        o = _jet(other)
        return Jet(self.value + o.value, _sum(self.first, o.first), _sum(self.second, o.second))

    def __mul__(self, other: Any) -> Jet:
        o = _jet(other)
        first = _sum(_times(self.first, o.value), _times(o.first, self.value))
        second = _sum(_times(self.second, o.value), _times(o.second, self.value))
        return Jet(self.value * o.value, first, _sum(second, _products(self.first, o.first)))

    def __neg__(self) -> Jet:
        return Jet(-self.value, {i: -v for i, v in self.first.items()}, {i: -v for i, v in self.second.items()})

    def __sub__(self, other: Any) -> Jet:
        return self + -_jet(other)

    def __rsub__(self, other: Any) -> Jet:
        return _jet(other) + -self

    def __truediv__(self, other: Any) -> Jet:
        return self * _jet(other)._inverse()

    def __rtruediv__(self, other: Any) -> Jet:
        return _jet(other) * self._inverse()

    __radd__, __rmul__ = __add__, __mul__

    def _inverse(self) -> Jet:
        v = constant(1) / self.value
        return self._of(v, -(v * v), constant(2) * v * v * v)

    def _of(self, v: Any, d: Any, dd: Any) -> Jet:
        """Return a function of the jet, given the function's value and derivatives there."""
        squares = {key: dd * v for key, v in _products(self.first, self.first, half=True).items()}
        return Jet(v, _times(self.first, d), _sum(_times(self.second, d), squares))

    def sin(self) -> Jet:
        s, c = self.value.sin(), self.value.cos()
        return self._of(s, c, -s)

    def cos(self) -> Jet:
        s, c = self.value.sin(), self.value.cos()
        return self._of(c, -s, -c)

    def tan(self) -> Jet:
        return self.sin() / self.cos()

    def exp(self) -> Jet:
        e = self.value.exp()
        return self._of(e, e, e)

    def log(self) -> Jet:
        d = constant(1) / self.value
        return self._of(self.value.log(), d, -(d * d))

    def sqrt(self) -> Jet:
        r = self.value.sqrt()
        d = constant(1) / (constant(2) * r)
        return self._of(r, d, -d / (constant(2) * self.value))

    def atan(self) -> Jet:
        d = constant(1) / (constant(1) + self.value * self.value)
        return self._of(self.value.atan(), d, constant(-2) * self.value * d * d)

    def asin(self) -> Jet:
        d = constant(1) / (constant(1) - self.value * self.value).sqrt()
        return self._of(self.value.asin(), d, self.value * d * d * d)

    def acos(self) -> Jet:
        return constant(arb.pi() / 2) - self.asin()

    @staticmethod
    def angle(y: Any, x: Any) -> Jet:
        """Return the angle of a vector of jets, as ``atan2`` does."""
        y, x = _jet(y), _jet(x)
        r = constant(1) / (x.value * x.value + y.value * y.value)
        dy, dx = x.value * r, -y.value * r
        first = _sum(_times(y.first, dy), _times(x.first, dx))
        second = _sum(_times(y.second, dy), _times(x.second, dx))
        two = constant(2)
        for d, a, b, half in (
            (-two * dy * -dx, y.first, y.first, True),
            (two * dy * -dx, x.first, x.first, True),
            (dx * dx - dy * dy, y.first, x.first, False),
        ):
            second = _sum(second, _times(_products(a, b, half), d))
        return Jet(constant(arb.atan2(value(y.value), value(x.value))), first, second)


def _jet(v: Any) -> Jet:
    return v if isinstance(v, Jet) else Jet(v if isinstance(v, arb_series) else constant(v))


def _sum(a: dict[Any, Any], b: dict[Any, Any]) -> dict[Any, Any]:
    if not a or not b:
        return a or b
    return {**a, **{key: a[key] + v if key in a else v for key, v in b.items()}}


def _times(a: dict[Any, Any], by: Any) -> dict[Any, Any]:
    return {key: v * by for key, v in a.items()} if a else a


def _products(a: _First, b: _First, half: bool = False) -> _Second:
    """Return the entries with i <= j of a b' + b a', or of half of it."""
    found: _Second = {}
    for i, v in a.items():
        for j, w in b.items():
            if half and j < i:
                continue
            key, product = (min(i, j), max(i, j)), v * w
            if not half and i == j:
                product = product + product
            found[key] = found[key] + product if key in found else product
    return found


def variables(values: Sequence[Ball], among: int | None = None) -> list[Jet]:
    """Return variables with these values, the first of which (by default all) are differentiated by."""
    ctx.cap = 1
    count = len(values) if among is None else among
    return [Jet(constant(v), {i: constant(1)} if i < count else {}) for i, v in enumerate(values)]


def derivatives(function: Callable[..., Any], count: int) -> tuple[Ball, list[Ball], list[list[Ball]]]:
    """Return value, gradient and Hessian of a jet by the first ``count`` :func:`variables`.

    The function that makes the jet refers to these variables and takes no arguments.
    """
    found = _jet(function())
    first = [value(found.first[i]) if i in found.first else arb(0) for i in range(count)]
    second = [[arb(0)] * count for _ in range(count)]
    for (i, j), v in found.second.items():
        second[i][j] = second[j][i] = value(v)
    return value(found.value), first, second


def gradients(function: Callable[[Sequence[Jet]], Sequence[Any]], z: Sequence[Any]) -> list[Any]:
    """Return, row by row, the derivatives of a function's series by its arguments, as series."""
    zero = constant(0)
    found = function([Jet(v, {i: constant(1)}) for i, v in enumerate(z)])
    return [(v.first.get(j, zero) if isinstance(v, Jet) else zero) for v in found for j in range(len(z))]


class _Opaque:
    """A number that no result may depend on: arithmetic with it is an error."""


OPAQUE: Any = _Opaque()
