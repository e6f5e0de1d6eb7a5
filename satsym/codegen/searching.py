"""Generated lines of searches: for a root, and for the minimiser of a polynomial on an interval.

A root is found by Newton's method, kept between ends that enclose it and to steps that shrink. Both forms take the same
fixed number of steps: a few more than are needed for doubling from one and halving down to the last digits. Where the
slope does not vanish, the result is NaN. For the minimiser, all zeros of the slope are compared. Between zeros of its
derivative a polynomial is monotone, so that each zero of the slope is enclosed by zeros of the slope's derivative, and
these by those of the next one, down to a quadratic polynomial. Where there is no zero between two, an end or some point
between is taken for it, which does no harm: all of them are admissible.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import sympy as sp

from satsym.symbolic.functions.roots import Argmin, Root

STEPS, POLISHED = 60, 2
"""Number of bisections of an interval, and of Newton steps at the best point."""

SMALLEST_SQUARE = 1e-200
"""Smallest square of a divisor."""

_AT = sp.Symbol("at", real=True)

Ends = Sequence[str | None]
"""Lower and upper end; ``None`` where there is none."""


@dataclass(frozen=True)
class _Form:
    """The comparisons of a form, and its printer of expressions."""

    name: str
    code: Callable[[sp.Expr], str]

    def chosen(self, left: str, right: str, one: str, other: str) -> str:
        """Print the choice of ``one`` where the left is less than the right, else of the other."""
        if self.name == "np":
            return f"np.where({left} < {right}, {one}, {other})"
        return f"{one} if {left} < {right} else {other}"

    def within(self, place: str, ends: Ends) -> list[str]:
        """Return statements that bring a value between ends."""
        low, high = ends
        found = [] if low is None else [f"{place} = {self.chosen(place, low, low, place)}"]
        return found + ([] if high is None else [f"{place} = {self.chosen(high, place, high, place)}"])


def minimum_lines(name: str, least: Argmin, form: str, code: Callable[[sp.Expr], str]) -> list[str]:
    """Return statements that assign the minimiser of a polynomial to a name.

    Parameters
    ----------
    name
        Of the result; others begin with it.
    form
        ``"math"`` or ``"np"``.
    code
        Prints expressions in that form.
    """
    by, coefficients = _Form(form, code), least.args[2:]
    degree, low, high = len(coefficients), f"{name}_low", f"{name}_high"
    ends = [None if end.is_infinite else code(end) for end in least.args[:2]]
    named = [sp.Symbol(f"{name}_c{k}", real=True) for k in range(1, degree + 1)]
    found = [f"{c} = {code(value)}" for c, value in zip(named, coefficients, strict=True)]
    exact = _derivatives(named)
    if form == "np":  # where one looks, nothing is moved by a complex step: it comes in with the polish
        found += [f"{c}_real = np.real({c})" for c in named]
        named = [sp.Symbol(f"{c}_real", real=True) for c in named]
    derivatives = _derivatives(named)
    found += _within_reach(low, high, ends, named, by)
    places = [f"{name}_{degree - 2}_{k}" for k in range(2)]
    found += _zeros(name, places, derivatives[degree - 2], by)
    found += [line for place in places for line in by.within(place, (low, high))]
    found += _in_order(places, by)
    for k in range(degree - 3, 0, -1):
        around = [low, *places, high]
        places = [f"{name}_{k}_{j}" for j in range(degree - k)]
        for place, pair in zip(places, pairwise(around), strict=True):
            found += _enclosed(name, place, pair, derivatives[k], by)
    compared = [*places, *(end for end in ends if end is not None)]
    return [*found, *_best(name, compared, derivatives[0], by), *_polished(name, exact, ends, by)]


def _derivatives(coefficients: list[sp.Symbol]) -> list[sp.Poly]:
    """Return a polynomial without a constant, and all its derivatives."""
    found = [sp.Poly([*coefficients[::-1], 0], _AT)]
    for _ in coefficients:
        found.append(found[-1].diff())
    return found


def _within_reach(low: str, high: str, ends: Ends, coefficients: list[sp.Symbol], by: _Form) -> list[str]:
    """Return Cauchy's bound on the zeros of the slope, intersected with the interval."""
    absolute = "np.abs" if by.name == "np" else "math.fabs"
    *others, last = coefficients
    sizes = " + ".join(f"{float(k)!r}*{absolute}({c})" for k, c in enumerate(others, 1))
    bound = f"1.0 + ({sizes})/({float(len(coefficients))!r}*{absolute}({last}) + {SMALLEST_SQUARE!r})"
    return [f"{high} = {bound}", f"{low} = -{high}", *by.within(low, ends), *by.within(high, ends)]


def _zeros(name: str, places: list[str], quadratic: sp.Poly, by: _Form) -> list[str]:
    """Return both zeros of a quadratic polynomial without cancellation; where it has none, some points."""
    square, linear, constant = (by.code(c) for c in quadratic.all_coeffs())
    a, b, c, root, sum_, below = (f"{name}_{part}" for part in ("a", "b", "c", "root", "sum", "below"))
    return [
        f"{a} = {square}",
        f"{b} = {linear}",
        f"{c} = {constant}",
        f"{root} = {b}*{b} - 4.0*{a}*{c}",
        f"{root} = {by.chosen(root, '0.0', '0.0', root)}",
        f"{root} = {by.name}.sqrt({root})",
        f"{sum_} = -0.5*({b} + {root})",
        f"{below} = 0.5*({root} - {b})",
        f"{sum_} = {by.chosen(b, '0.0', below, sum_)}",
        *_divided(places[0], sum_, a, below, by),
        *_divided(places[1], c, sum_, below, by),
    ]


def _divided(place: str, above: str, below: str, spare: str, by: _Form) -> list[str]:
    """Return a quotient, and a finite value where the divisor is zero."""
    square = f"{below}*{below}"
    return [
        f"{spare} = {by.chosen(square, repr(SMALLEST_SQUARE), '1.0', below)}",
        f"{place} = {above}/{spare}",
    ]


def _in_order(places: list[str], by: _Form) -> list[str]:
    """Return two points with the lower one first."""
    one, other = places
    return [
        f"{one}_first = {by.chosen(other, one, other, one)}",
        f"{other} = {by.chosen(other, one, one, other)}",
        f"{one} = {one}_first",
    ]


def _enclosed(name: str, place: str, ends: tuple[str, str], derivative: sp.Poly, by: _Form) -> list[str]:
    """Return the zero of a monotone function between two points, by bisection."""
    low, high, rising, value = (f"{name}_{part}" for part in ("left", "right", "rising", "value"))
    return [
        f"{low} = {ends[0]}",
        f"{high} = {ends[1]}",
        f"{rising} = {_value(derivative, high, by)} - ({_value(derivative, low, by)})",
        f"for _ in range({STEPS}):",
        f"    {place} = 0.5*({low} + {high})",
        f"    {value} = {rising}*({_value(derivative, place, by)})",
        f"    {low} = {by.chosen(value, '0.0', place, low)}",
        f"    {high} = {by.chosen(value, '0.0', high, place)}",
        f"{place} = 0.5*({low} + {high})",
    ]


def _best(name: str, places: list[str], polynomial: sp.Poly, by: _Form) -> list[str]:
    """Return the one of several points at which a polynomial is least."""
    value, least = f"{name}_value", f"{name}_least"
    found = [f"{name} = {places[0]}", f"{least} = {_value(polynomial, name, by)}"]
    for place in places[1:]:
        found += [
            f"{value} = {_value(polynomial, place, by)}",
            f"{name} = {by.chosen(value, least, place, name)}",
            f"{least} = {by.chosen(value, least, value, least)}",
        ]
    return [*found, f"{name} = {name} + 0.0*{least}"]


def _polished(name: str, derivatives: list[sp.Poly], ends: Ends, by: _Form) -> list[str]:
    """Refine a minimiser to the last digits where the slope increases; else return the better end."""
    (low, high), step, curved, nearer = ends, f"{name}_step", f"{name}_curved", f"{name}_nearer"
    statements = [f"{curved} = {_value(derivatives[2], name, by)}", f"{step} = {_value(derivatives[1], name, by)}"]
    if low is not None:
        statements += [f"{step} = {by.chosen(low, name, step, '0.0')}"]
    if high is not None:
        statements += [f"{step} = {by.chosen(name, high, step, '0.0')}"]
    if low is not None and high is not None:
        statements += [f"{nearer} = {by.chosen(f'{name} + {name}', f'{low} + {high}', low, high)}"]
        statements += [f"{name} = {by.chosen('0.0', curved, name, nearer)}"]
    statements += [
        f"{step} = {by.chosen('0.0', curved, step, '0.0')}",
        f"{curved} = {by.chosen('0.0', curved, curved, '1.0')}",
        f"{name} = {name} - {step}/{curved}",
        *by.within(name, ends),
    ]
    return [f"for _ in range({POLISHED}):", *(f"    {one}" for one in statements)]


def _value(polynomial: sp.Poly, place: str, by: _Form) -> str:
    """Evaluate a polynomial at a point by Horner's rule."""
    return by.code(sp.horner(polynomial).xreplace({_AT: sp.Symbol(place, real=True)}))


ROOT_STEPS, POLISHED_ROOT = 60, 3
"""Number of steps between ends, and of Newton steps after them."""

FARTHEST_ROOT, SMALLEST_CURVATURE = 1e150, 1e-100
"""Largest root that is sought, and smallest curvature, which replaces smaller ones."""

LAST_STEP = 1e-9
"""Largest final step, relative to one plus the size of the root."""


def root_lines(name: str, root: Root, form: str, code: Callable[[sp.Expr], str]) -> list[str]:
    """Return statements that assign the value of a root to a name.

    Parameters
    ----------
    name
        Of the result; others begin with it.
    form
        ``"math"`` or ``"np"``.
    code
        Prints expressions in that form.
    """

    def chosen(left: str, right: str, one: str, other: str) -> str:
        """Print the choice of ``one`` where the left is less than the right, else of the other."""
        return (
            f"np.where({left} < {right}, {one}, {other})" if form == "np" else f"{one} if {left} < {right} else {other}"
        )

    absolute = "np.abs" if form == "np" else "math.fabs"
    low, high, step, last, longest, value, curved, ahead = (
        f"{name}_{part}" for part in ("low", "high", "step", "last", "longest", "value", "curved", "ahead")
    )
    lower, upper = (_end(end, code) for end in root.args[:2])
    unknown = sp.Symbol(name, real=True)
    slope = root.at().xreplace({root.unknown: unknown})
    shared, (first, second) = sp.cse(
        [slope, sp.diff(slope, unknown)], sp.utilities.numbered_symbols(f"{name}_part", real=True), order="canonical"
    )
    evaluated = [f"{s.name} = {code(e)}" for s, e in shared]
    evaluated += [f"{value} = {code(first)}", f"{curved} = {code(second)}"]
    evaluated += [f"{curved} = {chosen(curved, repr(SMALLEST_CURVATURE), repr(SMALLEST_CURVATURE), curved)}"]
    return [
        f"{low} = {chosen(lower, repr(-FARTHEST_ROOT), repr(-FARTHEST_ROOT), lower)}",
        f"{high} = {chosen(repr(FARTHEST_ROOT), upper, repr(FARTHEST_ROOT), upper)}",
        f"{name} = {chosen('0.0', low, low, '0.0')}",
        f"{name} = {chosen(high, name, high, name)}",
        f"{last} = {FARTHEST_ROOT!r}",
        f"for _ in range({ROOT_STEPS}):",
        *(f"    {line}" for line in evaluated),
        f"    {low} = {chosen(value, '0.0', name, low)}",
        f"    {high} = {chosen('0.0', value, name, high)}",
        f"    {longest} = 1.0 + {absolute}({name})",
        f"    {step} = -{value}/{curved}",
        f"    {ahead} = 0.5*({low} + {high}) - {name}",
        f"    {last} = 0.5*{last} + 1e-12*{longest}",
        f"    {last} = {chosen(f'{absolute}({step})', last, last, '-1.0')}",
        f"    {last} = {chosen(high, f'{name} + {step}', '-1.0', last)}",
        f"    {last} = {chosen(f'{name} + {step}', low, '-1.0', last)}",
        f"    {step} = {chosen(last, '0.0', ahead, step)}",
        f"    {step} = {chosen(longest, step, longest, step)}",
        f"    {step} = {chosen(step, f'-{longest}', f'-{longest}', step)}",
        f"    {name} = {name} + {step}",
        f"    {last} = {absolute}({step})",
        f"for _ in range({POLISHED_ROOT}):",
        *(f"    {line}" for line in evaluated),
        f"    {last} = {name}",
        f"    {name} = {name} - {value}/{curved}",
        f"    {name} = {chosen(name, lower, lower, name)}",
        f"    {name} = {chosen(upper, name, upper, name)}",
        f"{last} = {LAST_STEP!r}*(1.0 + {absolute}({name})) - {absolute}({name} - {last})",
        f"{name} = {name} + 0.0*{form}.sqrt({last})",
    ]


def _end(end: sp.Expr, code: Callable[[sp.Expr], str]) -> str:
    return repr(FARTHEST_ROOT if end is sp.oo else -FARTHEST_ROOT) if end.is_infinite else code(end)
