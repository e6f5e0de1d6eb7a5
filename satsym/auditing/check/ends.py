"""Equations about the beginning or the end alone, ``x(t_f) = x_f``: what holds there is no equation of the motion."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.auditing.check.derived import Target
from satsym.formula.tree import ZERO, Call, Equality, Node, Sym, calls_in, cells, each, mapped, symbols

_AT_THE_END = frozenset(map(Sym, ("t_f", "tf", "T", "t1", "t_1")))
_AT_THE_BEGINNING = frozenset((ZERO, Sym("t_0"), Sym("t0")))
_CONDITIONS = ":boundary_conditions."


@dataclass(frozen=True)
class AtOneTime:
    """An equation of which all is taken at one end."""

    equation: Equality
    """What is left of it without the time."""
    last: bool
    """Whether it is the end, not the beginning."""

    def is_condition(self, target: Target) -> bool:
        """Whether an equation of the derivation is a condition at an end, or the cost of the end."""
        return _CONDITIONS in target.address or (self.last and target.equation.lhs == Sym("S"))

    def holds_at_this_end(self, target: Target | None, states: tuple[str, ...]) -> bool:
        """Whether an equation of the derivation holds at this end: what is given is the state at the beginning."""
        if target is None or _CONDITIONS not in target.address:
            return target is None or target.always or self.last
        of = target.equation.lhs
        return (isinstance(of, Sym) and of.name in states) != self.last


def at_one_time(statement: Node | Equality) -> AtOneTime | None:
    """An equation about one end alone; ``None`` for what holds all along, or has to do with both ends."""
    taken = [call for call in calls_in(statement) if call.function == "value"]
    places = {call.arguments[1:] for call in taken}
    if not isinstance(statement, Equality) or len(places) != 1:
        return None
    (place,) = places
    if len(place) != 1 or place[0] not in _AT_THE_END | _AT_THE_BEGINNING:
        return None
    without = each(statement, lambda side: mapped(side, lambda part: ZERO if _of_value(part) else None))
    names = {name for call in taken for name in symbols(call.arguments[0])}
    if names & {name for side in cells(without) for name in symbols(side)}:
        return None
    bare = Equality(mapped(statement.lhs, _of_value), mapped(statement.rhs, _of_value))
    return AtOneTime(bare, place[0] in _AT_THE_END)


def _of_value(part: Node) -> Node | None:
    return part.arguments[0] if isinstance(part, Call) and part.function == "value" else None
