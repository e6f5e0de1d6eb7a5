"""What minimises a Hamiltonian over a control set, as functions that can be differentiated, typeset and evaluated.

Of ``slope * u + weight * |u|`` on ``lower <= u <= upper`` the minimiser jumps where the slope passes ``weight`` or
``-weight``. With ``smoothing / 2 * u**2`` added it is the clipped ``-Shrink(slope, weight) / smoothing``.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import sympy as sp

from satsym.symbolic.functions import pieces, roots
from satsym.symbolic.functions.roots import Choice


class Clip(sp.Function):
    """``Clip(value, lower, upper)``: the nearest point of an interval."""

    nargs = 3
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """By the value: one inside, zero outside. The limits are constants."""
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return Inside(*self.args)


class Inside(sp.Function):
    """``Inside(value, lower, upper)``: one in the interval, zero outside; the derivative of :class:`Clip`."""

    nargs = 3

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Zero, except at the ends, where it has no derivative."""
        return sp.Integer(0)


class Shorten(sp.Function):
    """``Shorten(norm_squared, limit)``: the factor that brings a vector into a ball, at most one."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """By the square of the norm. The limit is a constant."""
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return ShortenSlope(*self.args)


class ShortenSlope(sp.Function):
    """``ShortenSlope(norm_squared, limit)``: the derivative of :class:`Shorten` by its first argument."""

    nargs = 2


class Stretch(sp.Function):
    """``Stretch(norm_squared, smoothing, length)``: the factor that gives a vector a length; at most 1 / smoothing.

    Of ``slope . u + smoothing / 2 * u . u`` on a ball, minus the slope, multiplied by it, is the minimiser.
    """

    nargs = 3

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """By the square of the norm. Smoothing and length are constants."""
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return StretchSlope(*self.args)


class StretchSlope(sp.Function):
    """``StretchSlope(norm_squared, smoothing, length)``: the derivative of :class:`Stretch` by its first argument."""

    nargs = 3


class Within(sp.Function):
    """``Within(norm_squared, least, largest)``: the factor that brings a vector into an annulus."""

    nargs = 3

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """By the square of the norm. The limits are constants."""
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return WithinSlope(*self.args)


class WithinSlope(sp.Function):
    """``WithinSlope(norm_squared, least, largest)``: the derivative of :class:`Within` by its first argument."""

    nargs = 3


class Switch(sp.Function):
    """``Switch(slope, weight, lower, upper)``: the minimiser of ``slope * u + weight * |u|`` on an interval.

    Where all of an interval minimises, it is the value of least magnitude; without a weight, the midpoint.
    """

    nargs = 4
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Zero, except where it jumps, where it has no derivative. The limits are constants."""
        if argindex > 2:
            raise sp.ArgumentIndexError(self, argindex)
        return sp.Integer(0)


class Shrink(sp.Function):
    """``Shrink(value, width)``: the value brought nearer to zero by the width, zero if it is not farther away."""

    nargs = 2
    is_real = True

    @classmethod
    def eval(cls, value: sp.Expr, width: sp.Expr) -> sp.Expr | None:
        """The value itself where the width is zero."""
        return value if width.is_zero else None

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """One by the value outside the width, zero inside; by the width the sign of the value, reversed."""
        side = Side(*self.args)
        return side**2 if argindex == 1 else -side


class Side(sp.Function):
    """``Side(value, width)``: one above the width, minus one below ``-width``, zero between."""

    nargs = 2
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Zero, except where it jumps, where it has no derivative."""
        return sp.Integer(0)


MINIMISERS: tuple[type[sp.Function], ...] = (
    *(
        Clip,
        Inside,
        Shorten,
        ShortenSlope,
        Stretch,
        StretchSlope,
        Within,
        WithinSlope,
        Switch,
        Shrink,
        Side,
        pieces.Until,
    ),
    *roots.CONSTRUCTED,
)


def by_signs(expression: sp.Expr) -> sp.Expr:
    """The expression with signs, minima and maxima in place of switches, as people print laws.

    Right at a threshold the sign is zero, and a switch with a weight halfway between two of its levels.
    """

    def switch(slope: sp.Expr, weight: sp.Expr, lower: sp.Expr, upper: sp.Expr) -> sp.Expr:
        above, below = (1 + sp.sign(slope - weight)) / 2, (1 - sp.sign(slope + weight)) / 2
        least = 0 if weight.is_zero else (1 - above - below) * sp.Min(upper, sp.Max(lower, 0))
        return above * lower + below * upper + least

    def shrink(value: sp.Expr, width: sp.Expr) -> sp.Expr:
        return sp.Max(value - width, 0) + sp.Min(value + width, 0)

    return expression.replace(Switch, switch).replace(Shrink, shrink)


def _clip(value: Any, lower: Any, upper: Any) -> Any:
    return value if value != value else max(lower, min(value, upper))


def _shorten(norm_squared: Any, limit: Any) -> Any:
    return mp.mpf(1) if norm_squared <= limit**2 else limit / mp.sqrt(norm_squared)


def _inside(value: Any, lower: Any, upper: Any) -> Any:
    return mp.mpf(lower <= value <= upper)


def _shorten_slope(norm_squared: Any, limit: Any) -> Any:
    return mp.mpf(0) if norm_squared <= limit**2 else -limit / (2 * norm_squared * mp.sqrt(norm_squared))


def _stretch(norm_squared: Any, smoothing: Any, length: Any) -> Any:
    return 1 / smoothing if norm_squared <= (smoothing * length) ** 2 else length / mp.sqrt(norm_squared)


def _stretch_slope(norm_squared: Any, smoothing: Any, length: Any) -> Any:
    inside = norm_squared <= (smoothing * length) ** 2
    return mp.mpf(0) if inside else -length / (2 * norm_squared * mp.sqrt(norm_squared))


def _within(norm_squared: Any, least: Any, largest: Any) -> Any:
    norm = mp.sqrt(norm_squared)
    if not norm:
        return mp.mpf(not least)
    return largest / norm if norm > largest else least / norm if norm < least else mp.mpf(1)


def _within_slope(norm_squared: Any, least: Any, largest: Any) -> Any:
    norm = mp.sqrt(norm_squared)
    met = largest if norm > largest else least if norm < least else 0
    return -met / (2 * norm_squared * norm)


def _switch(slope: Any, weight: Any, lower: Any, upper: Any) -> Any:
    if slope > weight:
        return lower
    if slope < -weight:
        return upper
    return max(lower, min(mp.mpf(0), upper)) if weight > 0 else (lower + upper) / 2


def _side(value: Any, width: Any) -> Any:
    return mp.mpf(int(value > width) - int(value < -width))


def _shrink(value: Any, width: Any) -> Any:
    side = _side(value, width)
    return side * side * value - side * width


MPMATH_FUNCTIONS = {
    "Clip": _clip,
    "Inside": _inside,
    "Shorten": _shorten,
    "ShortenSlope": _shorten_slope,
    "Stretch": _stretch,
    "StretchSlope": _stretch_slope,
    "Within": _within,
    "WithinSlope": _within_slope,
    "Switch": _switch,
    "Shrink": _shrink,
    "Side": _side,
    "Until": pieces.until,
} | roots.MPMATH


class SignedSwitch(sp.Function):
    """``SignedSwitch(slope, weight, lower, upper)``: the minimiser of ``slope * u + weight * |u|`` on an interval.

    The weight may have either sign; where it is negative the function bends downwards, so that both bounds have to be
    compared. Where all of an interval minimises, it is the value of least magnitude.
    """

    nargs = 4
    is_real = True

    def at(self, u: sp.Expr) -> sp.Expr:
        """What it minimises, at a value of the control."""
        slope, weight, *_ = self.args
        return _value(slope, weight, sp.Integer(0), u)


class SignedClip(sp.Function):
    """``SignedClip(slope, weight, smoothing, lower, upper)``: the same with ``smoothing / 2 * u**2`` besides."""

    nargs = 5
    is_real = True

    def at(self, u: sp.Expr) -> sp.Expr:
        """What it minimises, at a value of the control."""
        slope, weight, smoothing, *_ = self.args
        return _value(slope, weight, smoothing, u)


def compared(expression: sp.Expr) -> sp.Expr:
    """The expression with these minimisers as the comparisons of values that they are."""
    return sp.sympify(expression).replace(SignedSwitch, _of_three).replace(SignedClip, _of_two)


def _of_three(*given: sp.Expr) -> sp.Expr:
    """Both bounds are compared, and the better one with the value of least magnitude."""
    value, (lower, upper) = SignedSwitch(*given).at, given[-2:]
    rest, low, high = Clip(sp.Integer(0), lower, upper), value(lower), value(upper)
    end, best = Choice(low - high, lower, upper), Choice(low - high, low, high)
    return Choice(value(rest) - best, rest, end)


def _of_two(*given: sp.Expr) -> sp.Expr:
    """The least of either sign: on each side of the value of least magnitude it is a parabola that bends upwards."""
    value, (slope, weight, smoothing, lower, upper) = SignedClip(*given).at, given
    rest = Clip(sp.Integer(0), lower, upper)
    above = Clip(-(slope + weight) / smoothing, rest, upper)
    below = Clip(-(slope - weight) / smoothing, lower, rest)
    return Choice(value(above) - value(below), above, below)


def _value(slope: sp.Expr, weight: sp.Expr, smoothing: sp.Expr, u: sp.Expr) -> sp.Expr:
    return smoothing * u**2 / 2 + slope * u + weight * sp.Abs(u)
