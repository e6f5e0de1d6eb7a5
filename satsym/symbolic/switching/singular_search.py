"""The search for the order of singular arcs: derivatives of a switching function until its control appears.

Along a singular arc a switching function stays at its threshold, so that all its total time derivatives vanish. The
first one in which the control appears determines it; each one before is a condition on states and costates, and is
solved for one of them, so that what follows is known *on the arc* (Kelley, Kopp and Moyer, Singular extremals, 1967).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache

import sympy as sp
from sympy.functions.elementary.trigonometric import TrigonometricFunction

from satsym.symbolic.algebra import COMMON, depends, differs_from_zero, shortened, terms_over, tidy, total_derivative
from satsym.symbolic.convention import sign
from satsym.symbolic.decimals import as_decimals, as_fractions
from satsym.symbolic.derivation import Derivation
from satsym.symbolic.factoring import factored
from satsym.symbolic.model import symbols_of
from satsym.symbolic.switching.functions import flow, parts

SIDES = {"_positive": 1, "_negative": -1}
"""Sign of a control with a weight on its magnitude, on the two kinds of singular arcs."""

MOST_OPERATIONS = 2000
"""Number of operations of a derivative, before or after reduction, above which the search is abandoned."""


@dataclass
class Surface:
    """The surface of successive conditions: symbols that are solved for, and conditions that are not."""

    solved: dict[sp.Symbol, sp.Expr] = field(default_factory=dict)
    left: list[sp.Expr] = field(default_factory=list)

    def reduced(self, expression: sp.Expr) -> sp.Expr:
        """Return an expression with the solved symbols substituted."""
        return _simplest(sp.sympify(expression).xreplace(self.solved))

    def add(self, condition: sp.Expr, unknowns: Sequence[sp.Symbol]) -> None:
        """Solve a reduced condition for the first unknown in which it is linear, with certainty if possible."""
        chosen: tuple[sp.Symbol, sp.Expr] | None = None
        for unknown in unknowns:
            slope = _slope(condition, unknown)
            if slope is not None and (chosen is None or slope.is_nonzero):
                chosen = unknown, slope
                if slope.is_nonzero:
                    break
        if chosen is None:
            self.left.append(condition)
            return
        unknown, slope = chosen
        value = _simplest(-condition.xreplace({unknown: sp.Integer(0)}) / slope)
        self.solved = {k: _simplest(v.xreplace({unknown: value})) for k, v in self.solved.items()} | {unknown: value}

    def equations(self) -> sp.Tuple:
        """Return the equations that hold on the surface."""
        stated = [sp.Eq(k, v, evaluate=False) for k, v in self.solved.items()]
        return sp.Tuple(*stated, *(sp.Eq(c, 0, evaluate=False) for c in self.left))


@dataclass(frozen=True)
class Search:
    """The outcome of differentiating one switching function at one threshold."""

    control: sp.Symbol
    branch: str
    """The control, and the suffix of its threshold in :data:`satsym.symbolic.switching.notation.BRANCHES`."""
    magnitude: Mapping[sp.Expr, sp.Expr]
    """Expression that replaces |u| on this kind of singular arc."""
    threshold: sp.Expr
    """The switching function less its threshold."""
    derivatives: tuple[sp.Expr, ...]
    """The total time derivatives of the switching function, from the first."""
    outcome: str
    """``"order"`` if the last derivative contains the control, ``"closed"`` if it follows from those before,
    ``"impossible"`` if it cannot vanish, otherwise ``"open"``."""
    surface: Surface
    """The surface on which all derivatives except the last vanish; also the last one if it does not contain the
    control."""
    slope: sp.Expr = sp.Integer(0)
    singular: sp.Expr = sp.Integer(0)
    """Factor of the control in the last derivative, and the singular control, both on the surface."""

    @property
    def order(self) -> int:
        """Return the number of derivatives taken."""
        return len(self.derivatives)


def searches(so_far: Derivation) -> list[Search]:
    """Search for the singular control of each control at each of its thresholds."""
    assert so_far.problem is not None
    found, controls = parts(so_far), symbols_of(so_far.model.controls)
    motion = tuple(flow(so_far).items())
    results = []
    for u, sigma, w in zip(controls, found.switching, found.weights, strict=True):
        for branch, side in SIDES.items() if w != 0 else (("", 0),):
            threshold = sigma + sign(so_far.problem) * side * w
            results.append(_in_fractions(u, branch, threshold, motion, controls))
    return results


def _in_fractions(
    u: sp.Symbol,
    branch: str,
    threshold: sp.Expr,
    motion: tuple[tuple[sp.Symbol, sp.Expr], ...],
    controls: tuple[sp.Symbol, ...],
) -> Search:
    """Run a search with fractions in place of decimals, which neither cancel nor factor, and convert back."""
    if not any(e.has(sp.Float) for e in (threshold, *(rate for _, rate in motion))):
        return _search(u, branch, threshold, motion, controls)
    rates = tuple((z, as_fractions(rate)) for z, rate in motion)
    found = _search(u, branch, as_fractions(threshold), rates, controls)
    solved = {k: as_decimals(v) for k, v in found.surface.solved.items()}
    return replace(
        found,
        threshold=threshold,
        derivatives=tuple(map(as_decimals, found.derivatives)),
        surface=Surface(solved, list(map(as_decimals, found.surface.left))),
        slope=as_decimals(found.slope),
        singular=as_decimals(found.singular),
    )


@lru_cache(maxsize=32)  # two steps need them
def _search(
    u: sp.Symbol,
    branch: str,
    threshold: sp.Expr,
    motion: tuple[tuple[sp.Symbol, sp.Expr], ...],
    controls: tuple[sp.Symbol, ...],
) -> Search:
    magnitude = {sp.Abs(u): SIDES[branch] * u} if branch else {}
    rates = {z: rate.xreplace(magnitude) for z, rate in motion}
    states, lam = list(rates)[: len(rates) // 2], list(rates)[len(rates) // 2 :]
    unknowns = [*lam, *states]
    derivatives: list[sp.Expr] = []
    surface, last = Surface(), threshold
    surface.add(_simplest(threshold), unknowns)

    def ended(outcome: str, **more: sp.Expr) -> Search:
        return Search(u, branch, magnitude, threshold, tuple(derivatives), outcome, surface, **more)

    while len(derivatives) < 2 * len(states):
        total = tidy(total_derivative(last, rates), (*controls, *lam))
        derivatives.append(total)
        if max(e.count_ops() for e in (total, total.xreplace(surface.solved))) > MOST_OPERATIONS:
            break
        slope, rest = surface.reduced(sp.diff(total, u)), total.xreplace({u: sp.Integer(0)})
        condition = surface.reduced(rest)
        if slope != 0:
            return ended("order", slope=slope, singular=tidy(_simplest(-condition / slope)))
        if condition == 0:
            return ended("closed")
        if condition.is_nonzero:
            return ended("impossible")
        if (needed := _with_costates(condition, surface, lam)) is None:
            break
        surface.add(needed, unknowns)
        last = rest  # what multiplied the control vanishes along the arc, and so do its derivatives
    return ended("open")


def _with_costates(condition: sp.Expr, surface: Surface, lam: Sequence[sp.Symbol]) -> sp.Expr | None:
    """Remove the factor of a condition whose vanishing would make all costates vanish.

    ``None`` where another factor is not simple: where it vanishes, so do derivatives of the condition, whatever it does
    later.
    """
    powers = (factor.as_base_exp() for factor in sp.Mul.make_args(sp.numer(condition)))
    factors = {base: exponent for base, exponent in powers if base.free_symbols}
    others = [factor for factor in factors if not (factor.free_symbols & set(lam) or factor.is_nonzero)]
    for factor in factors:
        values = [surface.solved.get(c, c).xreplace({factor: sp.Integer(0)}) for c in lam]
        if factor in lam and others and all(_simplest(v) == 0 for v in values):
            return sp.Mul(*others) if all(factors[other] == 1 for other in others) else None
    return condition


def _slope(condition: sp.Expr, unknown: sp.Symbol) -> sp.Expr | None:
    """Return the factor of an unknown in a reduced condition, a product that is linear in the unknown."""
    factors = sp.Mul.make_args(condition)
    having = [factor for factor in factors if factor.has(unknown)]
    if len(having) != 1 or having[0].is_Pow:
        return None
    others = sp.Mul(*(factor for factor in factors if factor != having[0]))
    if not having[0].is_polynomial(unknown) or terms_over(having[0]) > COMMON:
        slope = sp.diff(having[0], unknown)
        if depends(slope, [unknown]):
            return None
        slope = _simplest(slope)
        return None if slope.has(unknown) else slope * others
    polynomial = sp.Poly(having[0], unknown)
    return _simplest(polynomial.LC() * others) if polynomial.degree() == 1 else None


def _simplest(expression: sp.Expr) -> sp.Expr:
    """Factor an expression where it is rational, apart from magnitudes; simplify it otherwise."""
    names = {magnitude: sp.Dummy(real=True) for magnitude in expression.atoms(sp.Abs)}
    plain = expression.xreplace(names)
    if not plain.is_rational_function():
        found = shortened(expression)
        return found if differs_from_zero(found) or not _vanishes_by_half_angles(found) else sp.Integer(0)
    return factored(plain).xreplace({dummy: magnitude for magnitude, dummy in names.items()})


def _vanishes_by_half_angles(expression: sp.Expr) -> bool:
    """Tell whether an expression is zero, proved by tangents of half angles where it is rational in them."""
    single = sp.expand_trig(expression)
    halves = {f.args[0]: sp.Dummy(real=True) for f in single.atoms(TrigonometricFunction)}
    tangents = {f(angle): value for angle, h in halves.items() for f, value in _by_half(h).items()}
    rational = single.xreplace(tangents)
    return bool(rational.is_rational_function() and factored(rational) == 0)


def _by_half(h: sp.Symbol) -> dict[type[TrigonometricFunction], sp.Expr]:
    """Map functions of an angle to rational functions of the tangent of half the angle."""
    sine, cosine = 2 * h / (1 + h**2), (1 - h**2) / (1 + h**2)
    ratios = {sp.tan: sine / cosine, sp.cot: cosine / sine, sp.sec: 1 / cosine, sp.csc: 1 / sine}
    return {sp.sin: sine, sp.cos: cosine, **ratios}
