"""Functions of time that are stated piece by piece, as tables and schedules are, in a form that can be differentiated.

Sympy's Piecewise, Max, Min, Abs, sign and Heaviside of time and constants alone become nested :class:`Until`. Between
two breaks each is smooth; derivatives by time are those of the pieces.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Sequence
from typing import Any

import mpmath as mp
import sympy as sp
from sympy.core.relational import Relational

CORNERS = (sp.Abs, sp.sign, sp.Max, sp.Min, sp.Heaviside, sp.Piecewise)
"""Functions that have jumps, or whose derivatives have jumps."""


class Until(sp.Function):
    """``Until(excess, one, other)``: ``one`` where the excess is not positive, ``other`` elsewhere.

    The excess is a function of time and constants alone, so that no derivative by a state passes through it.
    """

    nargs = 3
    is_real = True

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Return the derivative of the piece at hand; where the excess changes sign there is none."""
        pair = (0, 0) if argindex == 1 else (1, 0) if argindex == 2 else (0, 1)
        return Until(self.args[0], *map(sp.Integer, pair)) if any(pair) else sp.Integer(0)

    def _eval_derivative(self, by: sp.Symbol) -> sp.Expr:
        one, other = (sp.diff(e, by) for e in self.args[1:])
        return one if one == other else Until(self.args[0], one, other)


def until(excess: Any, one: Any, other: Any) -> Any:
    """Evaluate :class:`Until` in mpmath; NaN where the excess is NaN."""
    return mp.nan if excess != excess else one if excess <= 0 else other


def in_pieces(expression: sp.Expr, time: sp.Symbol, moving: Collection[str]) -> sp.Expr:
    """Write functions of time that are stated piece by piece as :class:`Until`; leave what has no such form.

    Parameters
    ----------
    moving
        Names of states and controls.
    """

    def of_time(e: sp.Basic) -> bool:
        return isinstance(e, CORNERS) and time in e.free_symbols and not any(s.name in moving for s in e.free_symbols)

    return expression.replace(of_time, _converted) if expression.has(*CORNERS) else expression


def breaks(expressions: Collection[sp.Basic], time: sp.Symbol) -> list[float]:
    """Return the times between pieces that are numbers, in order."""
    excesses = {e.args[0] for expression in expressions for e in expression.atoms(Until)}
    compared = (_compared(excess) for excess in excesses)
    return sorted({float(-rest / factor) for what, factor, rest in filter(None, compared) if what == time})


def pieces_of(e: sp.Expr) -> tuple[sp.Expr, list[sp.Expr], list[tuple[sp.Expr, bool]]] | None:
    """Return the variable that an :class:`Until` compares, its pieces in order, and the breaks between them.

    Each break goes with whether it belongs to the piece before it. ``None`` where no numbers order them.
    """
    if not isinstance(e, Until) or (compared := _compared(e.args[0])) is None:
        return None
    what, factor, rest = compared
    rising = bool(factor > 0)
    halves = []
    for half in e.args[1:] if rising else e.args[:0:-1]:
        inner = pieces_of(half) if isinstance(half, Until) else (what, [half], [])
        if inner is None or inner[0] != what:
            return None
        halves.append(inner)
    (_, before, first), (_, after, last) = halves
    ends = [*first, (-rest / factor, rising), *last]
    ordered = all(one <= other for (one, _), (other, _) in itertools.pairwise(ends))
    return (what, [*before, *after], ends) if ordered else None


def _converted(e: sp.Expr) -> sp.Expr:
    if isinstance(e, sp.Abs):
        return Until(e.args[0], -e.args[0], e.args[0])
    if isinstance(e, sp.sign | sp.Heaviside):
        return Until(-e.args[0], sp.Integer(1), sp.Integer(-1 if isinstance(e, sp.sign) else 0))
    if isinstance(e, sp.Max | sp.Min):
        side = 1 if isinstance(e, sp.Max) else -1
        found, *rest = e.args
        for other in rest:
            found = Until(side * (other - found), found, other)
        return found
    return _in_intervals(e) or _one_after_the_other(e) or e


def _compared(excess: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr] | None:
    """Split an excess into the expression that is compared with a number, a factor, and a rest."""
    rest, moving = sp.sympify(excess).as_coeff_Add()
    factor, what = moving.as_coeff_Mul()
    return None if what == 1 or factor == 0 else (what, factor, rest)


def _in_intervals(e: sp.Piecewise) -> sp.Expr | None:
    """Write a Piecewise whose breaks are numbers by repeated halving; its first and last pieces are extended."""
    stated = sorted(set().union(*(condition.atoms(Relational) for _, condition in e.args)), key=str)
    compared = {each: _compared(each.lhs - each.rhs) for each in stated}
    found = [one for one in compared.values() if one is not None]
    if len(found) < len(stated) or len({what for what, _, _ in found}) != 1:
        return None

    def at(place: sp.Expr) -> sp.Expr | None:
        """Return the piece that holds at a place."""
        holds = {each: each.func(one[1] * place + one[2], 0) for each, one in compared.items() if one is not None}
        return next((value for value, condition in e.args if condition.xreplace(holds) == True), None)  # noqa: E712

    ends = sorted({-rest / factor for _, factor, rest in found})
    inner = [(one + other) / 2 for one, other in itertools.pairwise(ends)]
    values = [at(place) for place in (ends[0] - 1, *inner, ends[-1] + 1)]
    if values[0] is None:
        values, ends = values[1:], ends[1:]
    if values and values[-1] is None:
        values, ends = values[:-1], ends[:-1]
    if not values or None in values:
        return None
    return _halved(found[0][0], values, ends, [at(end) for end in ends])


def _halved(what: sp.Expr, values: Sequence[Any], ends: Sequence[sp.Expr], there: Sequence[Any]) -> sp.Expr:
    if not ends:
        return values[0]
    k = len(ends) // 2
    before = _halved(what, values[: k + 1], ends[:k], there[:k])
    after = _halved(what, values[k + 1 :], ends[k + 1 :], there[k + 1 :])
    if before == after:
        return before
    return Until(ends[k] - what, after, before) if there[k] == values[k + 1] else Until(what - ends[k], before, after)


def _one_after_the_other(e: sp.Piecewise) -> sp.Expr | None:
    """Write a Piecewise whose breaks are parameters; ``None`` where it has no final piece for all other times."""
    *first, (found, last) = e.args
    if last != True:  # noqa: E712
        return None
    for value, condition in reversed(first):
        excess = _excess(condition)
        if excess is None:
            return None
        strict = isinstance(condition, sp.Gt | sp.Lt)
        found = Until(-excess, found, value) if strict else Until(excess, value, found)
    return found


def _excess(condition: sp.Basic) -> sp.Expr | None:
    """Return an expression that is not positive exactly where a condition holds."""
    if isinstance(condition, sp.Lt | sp.Le):
        return condition.lhs - condition.rhs
    if isinstance(condition, sp.Gt | sp.Ge):
        return condition.rhs - condition.lhs
    if isinstance(condition, sp.And | sp.Or):
        parts = [excess for part in condition.args if (excess := _excess(part)) is not None]
        if len(parts) < len(condition.args):
            return None
        side = 1 if isinstance(condition, sp.And) else -1
        found, *rest = parts
        for other in rest:
            found = Until(side * (other - found), found, other)
        return found
    return None
