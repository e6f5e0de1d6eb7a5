"""Minimisers of a Hamiltonian over a control set, as functions that can be differentiated, typeset and evaluated.

The minimiser of ``slope * u + weight * |u|`` on ``lower <= u <= upper`` jumps where the slope passes ``weight`` or
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
        """Return the derivative by the value, one inside the interval and zero outside; the limits are constants."""
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return Inside(*self.args)


class Inside(sp.Function):
    """``Inside(value, lower, upper)``: one in the interval, zero outside; the derivative of :class:`Clip`."""

    nargs = 3

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return zero: the function has no derivative at the ends, and is constant elsewhere."""
        return sp.Integer(0)


class Shorten(sp.Function):
    """``Shorten(norm_squared, limit)``: the factor, at most one, that brings a vector into a ball."""

    nargs = 2

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative by the square of the norm; the limit is a constant."""
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return ShortenSlope(*self.args)


class ShortenSlope(sp.Function):
    """``ShortenSlope(norm_squared, limit)``: the derivative of :class:`Shorten` by its first argument."""

    nargs = 2


class Stretch(sp.Function):
    """``Stretch(norm_squared, smoothing, length)``: the factor, at most 1 / smoothing, that gives a vector a length.

    Minus the slope times this factor minimises ``slope . u + smoothing / 2 * u . u`` on a ball.
    """

    nargs = 3

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative by the square of the norm; smoothing and length are constants."""
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
        """Return the derivative by the square of the norm; the limits are constants."""
        if argindex != 1:
            raise sp.ArgumentIndexError(self, argindex)
        return WithinSlope(*self.args)


class WithinSlope(sp.Function):
    """``WithinSlope(norm_squared, least, largest)``: the derivative of :class:`Within` by its first argument."""

    nargs = 3


class Switch(sp.Function):
    """``Switch(slope, weight, lower, upper)``: the minimiser of ``slope * u + weight * |u|`` on an interval.

    Where every value of an interval minimises, the function is the value of least magnitude; without a weight, the
    midpoint.
    """

    nargs = 4
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return zero: the function has no derivative where it jumps, and is constant elsewhere."""
        if argindex > 2:
            raise sp.ArgumentIndexError(self, argindex)
        return sp.Integer(0)


class Shrink(sp.Function):
    """``Shrink(value, width)``: the value moved towards zero by the width, and zero if it is within the width."""

    nargs = 2
    is_real = True

    @classmethod
    def eval(cls, value: sp.Expr, width: sp.Expr) -> sp.Expr | None:
        """Return the value itself where the width is zero."""
        return value if width.is_zero else None

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative: by the value one or zero, by the width minus the sign of the value or zero."""
        side = Side(*self.args)
        return side**2 if argindex == 1 else -side


class Side(sp.Function):
    """``Side(value, width)``: one above ``width``, minus one below ``-width``, and zero between."""

    nargs = 2
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return zero: the function has no derivative where it jumps, and is constant elsewhere."""
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
    """Write switches in an expression by signs, minima and maxima, as control laws are printed.

    Exactly at a threshold the sign is zero, and a switch with a weight is halfway between two of its levels.
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
        """Return the function that is minimised, at a value of the control."""
        slope, weight, *_ = self.args
        return _value(slope, weight, sp.Integer(0), u)


class SignedClip(sp.Function):
    """``SignedClip(slope, weight, smoothing, lower, upper)``: a minimiser on an interval.

    It minimises ``slope * u + weight * |u| + smoothing / 2 * u**2``.
    """

    nargs = 5
    is_real = True

    def at(self, u: sp.Expr) -> sp.Expr:
        """Return the function that is minimised, at a value of the control."""
        slope, weight, smoothing, *_ = self.args
        return _value(slope, weight, smoothing, u)


def compared(expression: sp.Expr) -> sp.Expr:
    """Replace signed switches and clips in an expression by the comparisons of values that define them."""
    return sp.sympify(expression).replace(SignedSwitch, _of_three).replace(SignedClip, _of_two)


def _of_three(*given: sp.Expr) -> sp.Expr:
    """Compare the function at both bounds, and the better one with its value at the control of least magnitude."""
    value, (lower, upper) = SignedSwitch(*given).at, given[-2:]
    rest, low, high = Clip(sp.Integer(0), lower, upper), value(lower), value(upper)
    end, best = Choice(low - high, lower, upper), Choice(low - high, low, high)
    return Choice(value(rest) - best, rest, end)


def _of_two(*given: sp.Expr) -> sp.Expr:
    """Compare the least values for either sign of the control, for each of which the function is a convex parabola."""
    value, (slope, weight, smoothing, lower, upper) = SignedClip(*given).at, given
    rest = Clip(sp.Integer(0), lower, upper)
    above = Clip(-(slope + weight) / smoothing, rest, upper)
    below = Clip(-(slope - weight) / smoothing, lower, rest)
    return Choice(value(above) - value(below), above, below)


def _value(slope: sp.Expr, weight: sp.Expr, smoothing: sp.Expr, u: sp.Expr) -> sp.Expr:
    return smoothing * u**2 / 2 + slope * u + weight * sp.Abs(u)
