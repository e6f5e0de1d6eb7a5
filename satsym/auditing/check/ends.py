"""Equations at the initial or the final time only, such as ``x(t_f) = x_f``, which are no equations of motion."""

from __future__ import annotations

from dataclasses import dataclass

from satsym.auditing.check.derived import Target
from satsym.formula.tree import ZERO, Call, Equality, Node, Sym, calls_in, cells, each, mapped, symbols

_AT_THE_END = frozenset(map(Sym, ("t_f", "tf", "T", "t1", "t_1")))
_AT_THE_BEGINNING = frozenset((ZERO, Sym("t_0"), Sym("t0")))
_CONDITIONS = ":boundary_conditions."


@dataclass(frozen=True)
class AtOneTime:
    """An equation whose quantities are all taken at the initial time, or all at the final time."""

    equation: Equality
    """The equation with the time argument removed."""
    last: bool
    """Whether the equation holds at the final time; otherwise at the initial time."""

    def is_condition(self, target: Target) -> bool:
        """Return whether an equation of the derivation is a boundary condition, or the terminal cost."""
        return _CONDITIONS in target.address or (self.last and target.equation.lhs == Sym("S"))

    def holds_at_this_end(self, target: Target | None, states: tuple[str, ...]) -> bool:
        """Return whether an equation of the derivation holds at the initial or final time of the printed equation.

        The boundary conditions of the states hold at the initial time, all other boundary conditions at the final time.
        """
        if target is None or _CONDITIONS not in target.address:
            return target is None or target.always or self.last
        of = target.equation.lhs
        return (isinstance(of, Sym) and of.name in states) != self.last


def at_one_time(statement: Node | Equality) -> AtOneTime | None:
    """Return an equation about the initial or the final time only; ``None`` for any other equation."""
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
