"""Minimisers of H over single controls on which H depends neither linearly nor quadratically.

Where the slope of H is ``a f(u) + b`` with an invertible function f, the minimiser has a closed form if f takes all
values or the control has no bounds; else it is the root of an increasing slope, found to the last digits where the law
is evaluated. The minimiser of ``a cos u + b sin u`` between bounds is the direction of ``(-a, -b)``, or the end of the
interval nearest to it. A control that multiplies what an angle turns, such as a lift, has two minimisers, one of either
sign, which are compared. For a polynomial that is not convex, all zeros of its slope are compared with the ends.
"""

from __future__ import annotations

from typing import Any

import mpmath as mp
import sympy as sp

from satsym.agreement import DIGITS, equal, finite
from satsym.symbolic.algebra import simplify, tidy, vanishes
from satsym.symbolic.checks import Point, numeric, points, with_digits
from satsym.symbolic.derivation import DerivationError
from satsym.symbolic.factoring import factored
from satsym.symbolic.functions.minimisers import Clip
from satsym.symbolic.functions.roots import Argmin, Bearing, Choice, Convex, Middle, root_of
from satsym.symbolic.principle.control_sets import by_circle

SAMPLES, CONTROLS = 10, 12
"""Numbers of random points at which H is evaluated, and of controls at each."""

INVERTED = 8
"""Number of operations up to which SymPy is asked to invert a function."""

REACH = (-3, 0, 3, 9)
"""Exponents (base ten) of the values at which inverse functions are tested."""

PRINTED = (sp.sin, sp.cos, sp.tan, sp.asin, sp.acos, sp.atan, sp.sinh, sp.cosh, sp.tanh, sp.exp, sp.log)

Ends = tuple[sp.Expr, sp.Expr]


def minimiser(name: str, h: sp.Expr, u: sp.Symbol, ends: Ends) -> sp.Expr:
    """Return the control between two ends at which H is least.

    Parameters
    ----------
    name
        Of what is derived, for messages.
    h
        What is minimised, of this control alone.
    ends
        Infinite where there is none.

    Raises
    ------
    DerivationError
        If H may have several local minima, and is no polynomial; or falls for ever.
    """
    circle = by_circle(h, u)
    if circle is not None and h.has(sp.sin, sp.cos):
        return nearest_angle(circle[1], circle[2], ends)
    if h.is_polynomial(u) and (several := _of_polynomial(name, sp.Poly(h, u), u, ends)) is not None:
        return several
    terms = _terms(sp.expand(sp.diff(h, u)), u)
    constant = terms.pop(sp.Integer(1), sp.Integer(0))
    if len(terms) == 1:
        ((function, factor),) = terms.items()
        if (inverse := _inverse(function, u)) is not None and (ends[1] is sp.oo or _everywhere(inverse)):
            law = Convex(*_at(inverse, sp.diff(function, u), u, factor, constant))
            return law if ends[1] is sp.oo else Clip(law, *ends)
    return _root(name, terms, constant, u, ends)


def with_angle(
    name: str, h: sp.Expr, u: sp.Symbol, ends: Ends, angle: sp.Symbol, arc: Ends | None
) -> tuple[sp.Expr, sp.Expr] | None:
    """Return control and angle at which H is least, where the control multiplies what the angle turns.

    ``None`` where H is not ``c(u) + l(u) (a cos + b sin)``. With the best angle it is the lesser of ``c + l m`` and
    ``c + l n``, m and n being the least and the largest of what l multiplies; each has its own minimiser. The sign
    of the difference of their values, written as a product, decides between the two: where both are equal because the
    controls are opposite, a factor of the product is exactly zero, while a sum would leave rounding.

    Parameters
    ----------
    ends
        Bounds of the control.
    arc
        Between which ends the angle lies; ``None`` where nothing limits it.
    """
    circle = by_circle(h, angle)
    if circle is None:
        return None
    rest, *pair = circle
    moved = sp.Add(*(term for term in sp.Add.make_args(sp.expand(rest)) if term.has(u)))
    (cosine, one), (sine, other) = (factored(e).as_independent(u, as_Add=False) for e in pair)
    ratio = simplify(other / one)
    if ratio.has(u):
        return None
    sine *= ratio
    length = sp.Dummy("length", real=True)
    value, laws, turns, sizes, values = moved + one * length, [], [], [], []
    for side in (1, -1):
        turn = Bearing(-side * sine, -side * cosine) if arc is None else nearest_angle(side * cosine, side * sine, arc)
        size = -side * sp.sqrt(tidy(cosine**2 + sine**2))
        if arc is not None:
            size = cosine * sp.cos(turn) + sine * sp.sin(turn)
        law = minimiser(name, value, u, ends)
        laws.append(law.xreplace({length: size}))
        values.append(value.xreplace({u: law}).xreplace({length: size}))
        turns.append(turn)
        sizes.append(size)
    excess = values[0] - values[1]
    if arc is None:
        first, second = sp.Dummy("first", real=True), sp.Dummy("second", real=True)
        product = factored(value.xreplace({u: first}) - value.xreplace({u: second, length: -length}))
        excess = product.xreplace({first: laws[0], second: laws[1]}).xreplace({length: sizes[0]})
    return Choice(excess, *laws), Choice(excess, *turns)


def indefinite(name: str, curvature: sp.Expr) -> bool:
    """Tell whether the factor that bends H, whatever the control, may have either sign."""
    value = numeric([curvature])
    with mp.workdps(DIGITS):
        found = [value(point)[0] for point in points(curvature.free_symbols, f"{name} curvature", SAMPLES)]
    return len({v > 0 for v in found if finite([v]) and not mp.im(v)}) > 1


def _of_polynomial(name: str, h: sp.Poly, u: sp.Symbol, ends: Ends) -> sp.Expr | None:
    """Return the global minimiser of a polynomial; ``None`` where it is convex, or may fall for ever."""
    *coefficients, _ = h.all_coeffs()
    grows = h.degree() % 2 == 0 and h.LC().is_positive
    if h.degree() < 3 or not (grows or all(end.is_finite is not False for end in ends)):
        return None
    if not _bends_down(name, u, sp.diff(h.as_expr(), u, 2)):
        return None
    return Argmin(*ends, *(tidy(c) for c in coefficients[::-1]))


def nearest_angle(cosine: sp.Expr, sine: sp.Expr, ends: Ends) -> sp.Expr:
    """Return the angle of an interval nearest to the minimiser of a cosine and a sine together.

    The minimiser is turned to within half a turn of the middle: from there the nearer end is the better one.
    """
    middle = Middle(*ends)
    along = -cosine * sp.cos(middle) - sine * sp.sin(middle)
    across = cosine * sp.sin(middle) - sine * sp.cos(middle)
    return Clip(middle + Bearing(across, along), *ends)


def _terms(slope: sp.Expr, u: sp.Symbol) -> dict[sp.Expr, sp.Expr]:
    """Map functions of the control to their factors in the slope."""
    parts = [term.as_independent(u, as_Add=False) for term in sp.Add.make_args(slope)]
    found: dict[sp.Expr, sp.Expr] = {}
    for factor, function in parts:
        found[function] = found.get(function, sp.Integer(0)) + factor
    return {function: tidy(factor) for function, factor in found.items() if not vanishes(factor)}


def _inverse(function: sp.Expr, u: sp.Symbol) -> sp.Lambda | None:
    """Return the inverse of a function of one control in closed form; it is checked for all controls tried."""
    if function.free_symbols != {u} or function.count_ops() > INVERTED:
        return None
    value = sp.Dummy("value", real=True)
    plain, scale = _unscaled(function, u)
    try:
        solutions = sp.solve(sp.Eq(plain, value), u)
    except NotImplementedError:
        return None
    there = numeric([function])
    for solution in (simplify(found) / scale for found in solutions):
        if solution.has(sp.I) or not all(isinstance(f, PRINTED) for f in solution.atoms(sp.Function)):
            continue
        back = numeric([solution])

        def sides(point: Point, back: Any = back) -> tuple[list[Any], list[Any]]:
            return back({value: there(point)[0]}), [point[u]]

        if all(equal(with_digits(sides, p)) for p in points([u], f"inverse of {function}", CONTROLS)):
            return sp.Lambda(value, solution)
    return None


def _unscaled(function: sp.Expr, u: sp.Symbol) -> tuple[sp.Expr, sp.Expr]:
    """Write a function of the control as one of ``c u``, with c.

    Sympy treats u in e^(5.82 u) = b as an unknown of an equation of degree 291.
    """
    inner = {f: f.args[0] / u for f in function.atoms(sp.Function) if f.has(u)}
    (scale,) = set(inner.values()) if len(set(inner.values())) == 1 else {sp.Integer(1)}
    outside = function.xreplace(dict.fromkeys(inner, sp.Integer(0)))
    if not scale.is_number or outside.has(u):
        return function, sp.Integer(1)
    return function.xreplace({f: f.func(u) for f in inner}), scale


def _everywhere(inverse: sp.Lambda) -> bool:
    """Tell whether all values have an inverse, small and large ones of either sign."""
    (value,), back = inverse.variables, numeric([inverse.expr])
    with mp.workdps(DIGITS):
        found = [back({value: side * 1.1 * mp.mpf(10) ** k})[0] for side in (1, -1) for k in REACH]
    return not any(v != v or mp.isinf(v) or mp.im(v) for v in found)


def _at(
    inverse: sp.Lambda, derivative: sp.Expr, u: sp.Symbol, factor: sp.Expr, constant: sp.Expr
) -> tuple[sp.Expr, sp.Expr]:
    """Return the zero of the slope ``factor f(u) + constant``, and the derivative of the slope there."""
    value = sp.Dummy("value", real=True)
    at = tidy(-constant / factor)
    curvature = simplify(derivative.xreplace({u: inverse(value)}))
    return inverse(at), factor * curvature.xreplace({value: at})


def _root(name: str, terms: dict[sp.Expr, sp.Expr], constant: sp.Expr, u: sp.Symbol, ends: Ends) -> sp.Expr:
    """Return the minimiser as the root of an increasing slope; other slopes are refused."""
    functions = list(terms)
    inner = sorted(set().union(*(f.free_symbols for f in functions)) - {u}, key=lambda s: s.name)
    weights = [sp.Dummy(f"a{k}", real=True) for k in range(len(functions) + 1)]
    slope = weights[0] + sum(w * f for w, f in zip(weights[1:], functions, strict=True))
    values = [constant, *terms.values()]
    _refuse_several(name, u, slope.xreplace(dict(zip(weights, values, strict=True))))
    found = root_of(u, slope, (*weights, *inner))(*ends, *values, *inner)
    return Convex(found, sp.diff(slope, u).xreplace({**dict(zip(weights, values, strict=True)), u: found}))


def _bends_down(name: str, u: sp.Symbol, bent: sp.Expr) -> bool:
    """Tell whether the curvature of H is negative, for some controls or in some places."""
    curvature, others = numeric([bent]), bent.free_symbols - {u}
    with mp.workdps(DIGITS):
        controls = [point[u] * 2 ** (k % 5 - 2) for k, point in enumerate(points([u], f"{name} {u}", CONTROLS))]
        found = [
            curvature({**point, u: side * control})[0]
            for point in points(others, f"{name} {u}", SAMPLES)
            for control in controls
            for side in (1, -1)
        ]
    return any(v < 0 for v in found if finite([v]) and not mp.im(v))


def _refuse_several(name: str, u: sp.Symbol, slope: sp.Expr) -> None:
    """Refuse a slope that increases for some controls and decreases for others."""
    curvature = numeric([sp.diff(slope, u)])
    others = slope.free_symbols - {u}
    with mp.workdps(DIGITS):
        controls = [point[u] * 2 ** (k % 5 - 2) for k, point in enumerate(points([u], f"{name} {u}", CONTROLS))]
        for point in points(others, f"{name} {u}", SAMPLES):
            found = [curvature({**point, u: control})[0] for control in controls]
            real = [v for v in found if finite([v]) and not mp.im(v)]
            if len({v > 0 for v in real if v}) > 1:
                raise DerivationError(
                    f"{name}: H is convex in {u} only in part of the domain, so H might have several local "
                    "minima, and these are not compared; choose as the control a quantity in which H is a polynomial "
                    "(a reaction rate instead of a temperature, for instance) and give both its bounds, or use a model "
                    "in which H is convex in the control"
                )
