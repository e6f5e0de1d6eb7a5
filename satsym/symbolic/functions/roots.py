"""Zeros of monotone functions, as functions that can be differentiated, typeset, evaluated and generated.

``Root(lower, upper, *coefficients)`` is the minimiser of a convex function on an interval, given the slope of the
function: the point where the slope vanishes, or the end towards which the function falls. Each slope has a class of its
own.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, ClassVar
from weakref import WeakValueDictionary

import mpmath as mp
import sympy as sp

STEPS_PER_BIT = 4
"""Largest number of steps in the search for a root, per bit of the working precision; bisection takes one per bit."""
POLYNOMIAL_STEPS = 400
"""Largest number of steps of the iteration for all roots of a polynomial."""

_classes: WeakValueDictionary[tuple[sp.Expr, tuple[sp.Symbol, ...]], type[Root]] = WeakValueDictionary()
"""(Derivative that vanishes at the root, its symbols) -> class of roots.

A class exists as long as it is used. With two classes for one derivative, equal expressions would differ.
"""


class Root(sp.Function):
    """The base class of the minimisers for all slopes; see :func:`root_of`."""

    is_real = True
    unknown: ClassVar[sp.Symbol]
    slope: ClassVar[sp.Expr]
    """Derivative of the convex function with respect to its unknown, as an expression in the unknown and the
    symbols."""
    letters: ClassVar[tuple[sp.Symbol, ...]]

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative by a coefficient: that of the implicit function, or zero at an end."""
        if argindex <= 2:
            return sp.Integer(0)
        by = self.letters[argindex - 3]
        ratio = -sp.diff(self.slope, by) / sp.diff(self.slope, self.unknown)
        values = {self.unknown: self, **dict(zip(self.letters, self.args[2:], strict=True))}
        return Interior(self, *self.args[:2]) * ratio.xreplace(values)

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        """Pickle the arguments of the class, which is made anew where it is read."""
        return _again, (self.unknown, self.slope, self.letters, self.args)

    def at(self) -> sp.Expr:
        """Return the slope with the coefficients of this root."""
        return self.slope.xreplace(dict(zip(self.letters, self.args[2:], strict=True)))


class Interior(sp.Function):
    """``Interior(value, lower, upper)``: one inside the interval, zero at its ends and outside."""

    nargs = 3

    @classmethod
    def eval(cls, value: sp.Expr, lower: sp.Expr, upper: sp.Expr) -> sp.Expr | None:
        """Return one where the interval has no finite ends."""
        return sp.Integer(1) if upper is sp.oo and lower is -sp.oo else None

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return zero: the function has no derivative at the ends, and is constant elsewhere."""
        return sp.Integer(0)


class Convex(sp.Function):
    """``Convex(value, curvature)``: the value where the curvature is not negative, and NaN elsewhere."""

    nargs = 2
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative, which is one by the value and zero by the curvature."""
        return sp.Integer(int(argindex == 1))


class Choice(sp.Function):
    """``Choice(excess, one, other)``: ``one`` where its excess over the other is not positive, else ``other``."""

    nargs = 3
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative of the chosen argument; where the excess changes sign there is none."""
        excess, *_ = self.args
        pair = (0, 0) if argindex == 1 else (1, 0) if argindex == 2 else (0, 1)
        return Choice(excess, *map(sp.Integer, pair)) if any(pair) else sp.Integer(0)


class Vertex(sp.Function):
    """``Vertex(curvature, slope, lower, upper)``: the minimiser of ``curvature/2 u**2 + slope u`` on an interval.

    Where the curvature is not positive that is the better end, and the lower one if both are equally good.
    """

    nargs = 4
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative by curvature or slope; it does not exist where the minimiser jumps."""
        return (self * Bend(*self.args), Bend(*self.args), sp.Integer(0), sp.Integer(0))[argindex - 1]


class Bend(sp.Function):
    """``Bend(curvature, slope, lower, upper)``: the derivative of :class:`Vertex` by the slope."""

    nargs = 4
    is_real = True


class Argmin(sp.Function):
    """``Argmin(lower, upper, c1, ..., cd)``: the minimiser of ``c1 u + ... + cd u**d`` on an interval.

    Both ends are compared with all points at which the slope vanishes; of several equally good points, one is taken.
    """

    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative by a coefficient, of the implicit function or zero at an end; jumps have none."""
        if argindex <= 2:
            return sp.Integer(0)
        lower, upper, *coefficients = self.args
        k = argindex - 2
        bent = sum(j * (j - 1) * c * self ** (j - 2) for j, c in enumerate(coefficients[1:], 2))
        return -Interior(self, lower, upper) * k * self ** (k - 1) / bent


class Middle(sp.Function):
    """``Middle(lower, upper)``: the middle of an interval of angles, or of one turn of a longer one."""

    nargs = 2
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return zero, because the limits are constants."""
        return sp.Integer(0)


class Bearing(sp.Function):
    """``Bearing(across, along)``: the angle of a direction, as atan2, in a form that can be differentiated."""

    nargs = 2
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative by either component: the other one over the square of the length."""
        across, along = self.args
        return (along if argindex == 1 else -across) / (across**2 + along**2)


def root_of(unknown: sp.Symbol, slope: sp.Expr, letters: tuple[sp.Symbol, ...]) -> type[Root]:
    """Return the class of the minimisers of convex functions with the given slope."""
    plain = {s: sp.Symbol(f"c{k}", real=True) for k, s in enumerate(letters)} | {unknown: sp.Symbol("v", real=True)}
    key = slope.xreplace(plain), tuple(plain[s] for s in letters)
    found = _classes.get(key)
    return _classes.setdefault(key, _class_of(key[0], plain[unknown], key[1])) if found is None else found


def _class_of(slope: sp.Expr, unknown: sp.Symbol, letters: tuple[sp.Symbol, ...]) -> type[Root]:
    """Return the class for all slopes that differ only in their letters; its name is made from the slope."""
    mark = hashlib.sha256(sp.srepr(slope).encode()).hexdigest()[:10]
    function = sp.lambdify([unknown, *letters], [slope, sp.diff(slope, unknown)], modules="mpmath")

    def value(lower: Any, upper: Any, *coefficients: Any) -> Any:
        return minimum_between(lambda at: function(at, *coefficients), lower, upper)

    shared = {"unknown": unknown, "slope": slope, "letters": letters, "nargs": len(letters) + 2}
    return type(f"Root_{mark}", (Root,), shared | {"_imp_": staticmethod(value)})


def _again(unknown: sp.Symbol, slope: sp.Expr, letters: tuple[sp.Symbol, ...], args: tuple[sp.Expr, ...]) -> sp.Expr:
    return root_of(unknown, slope, letters)(*args)


def minimum_between(slopes: Callable[[Any], Sequence[Any]], lower: Any, upper: Any) -> Any:
    """Return the minimiser of a convex function on an interval in mpmath; NaN where the function falls for ever.

    Parameters
    ----------
    slopes
        Its first and second derivative.
    """
    low, high = mp.mpf(lower), mp.mpf(upper)
    for end, outwards in ((low, -1), (high, 1)):  # what is least there must be that end to the last digit
        with suppress(ArithmeticError):
            if mp.isfinite(end) and not mp.im(slope := slopes(end)[0]) and outwards * slope <= 0:
                return end
    at, last = max(low, min(mp.mpf(0), high)), mp.inf
    for _ in range(STEPS_PER_BIT * mp.mp.prec):
        slope, curvature = slopes(at)
        if slope == 0 or low == high:
            return at
        low, high = (at, high) if slope < 0 else (low, at)
        longest = 1 + abs(at)
        move = -slope / curvature if curvature > 0 else mp.inf
        inside = low <= at + move <= high and 2 * abs(move) <= last
        if not inside:
            move = (low + high) / 2 - at if high - low < mp.inf else -mp.sign(slope) * longest
        move = max(-longest, min(move, longest))
        at, last = at + move, abs(move)
        if abs(move) <= mp.eps * longest / 100:
            return at
    return mp.nan


def _interior(value: Any, lower: Any, upper: Any) -> Any:
    return mp.mpf(lower < value < upper)


def _convex(value: Any, curvature: Any) -> Any:
    return value if not mp.im(value) and not mp.im(curvature) and curvature >= 0 else mp.nan


def _choice(excess: Any, one: Any, other: Any) -> Any:
    return mp.nan if excess != excess else one if excess <= 0 else other


def _vertex(curvature: Any, slope: Any, lower: Any, upper: Any) -> Any:
    if curvature > 0:
        return max(lower, min(-slope / curvature, upper))
    excess = (upper - lower) * (curvature * (lower + upper) / 2 + slope)
    return mp.nan if excess != excess else upper if excess < 0 else lower


def _bend(curvature: Any, slope: Any, lower: Any, upper: Any) -> Any:
    inside = curvature > 0 and lower < -slope / curvature < upper
    return -1 / curvature if inside else mp.mpf(0)


def _argmin(lower: Any, upper: Any, *coefficients: Any) -> Any:
    if any(c != c for c in coefficients):
        return mp.nan
    slope = [k * c for k, c in enumerate(coefficients, 1)]
    while slope and not slope[-1]:
        slope.pop()
    found = mp.polyroots(slope[::-1], maxsteps=POLYNOMIAL_STEPS, extraprec=10 * mp.mp.prec) if slope[1:] else []
    places = [end for end in (lower, upper) if not mp.isinf(end)]
    places += [max(lower, min(mp.re(root), upper)) for root in found]
    return min(places, key=lambda u: mp.polyval([*coefficients[::-1], 0], u), default=mp.nan)


def _middle(lower: Any, upper: Any) -> Any:
    low = max(lower, min(upper, mp.pi) - 2 * mp.pi)
    return (low + min(upper, max(lower, -mp.pi) + 2 * mp.pi)) / 2


CONSTRUCTED = (Root, Interior, Convex, Choice, Vertex, Bend, Argmin, Middle, Bearing)
MPMATH = {"Interior": _interior, "Convex": _convex, "Choice": _choice, "Middle": _middle, "Bearing": mp.atan2}
MPMATH |= {"Vertex": _vertex, "Bend": _bend, "Argmin": _argmin}
