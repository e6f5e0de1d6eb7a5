"""What minimises a Hamiltonian where the magnitude of a control may be worth having, as where it stands in the motion.

``slope * u + weight * |u|`` with a weight of either sign is least at one of three values: a bound, or the admissible
value of least magnitude. Where the weight is negative it bends downwards, so that both bounds have to be compared.
"""

from __future__ import annotations

import sympy as sp

from satsym.symbolic.functions.minimisers import Clip
from satsym.symbolic.functions.roots import Choice


class SignedSwitch(sp.Function):
    """``SignedSwitch(slope, weight, lower, upper)``: the minimiser of ``slope * u + weight * |u|`` on an interval.

    The weight may have either sign. Where all of an interval minimises, it is the value of least magnitude.
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
