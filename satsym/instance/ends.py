"""Ranges of final states, and the ends of these ranges at which final states are found."""

from __future__ import annotations

import math
from collections.abc import Mapping
from enum import Enum

from satsym.instance.resolve import FREE, REFERENCE, Row, known, value_of
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.wording import shown


class Side(str, Enum):
    """A side of a range: its lower or its upper end."""

    LOWER = "lower"
    UPPER = "upper"

    @property
    def outward(self) -> float:
        """Return the sign of a change that leaves the range at this side."""
        return 1.0 if self is Side.UPPER else -1.0

    def of(self, limits: Row) -> float:
        """Return the limit at this side."""
        return limits[self is Side.UPPER]


Final = Mapping[str, float | str | tuple[float | str, float | str]]
"""The table [final]: for each state a value, or both ends of a range."""


def ranges(table: Final, spec: ProblemSpec) -> dict[str, tuple[float, float]]:
    """Return the ranges of final states in the model's order, without those of zero width.

    An end that is free is infinite.

    Raises
    ------
    BadInput
        If one is empty or everything, or an end of it is no value of the state.
    """
    known(table, spec.states, "state", "final")
    found = {}
    for variable in spec.states:
        written = table.get(variable.symbol)
        if not isinstance(written, tuple):
            continue
        key = f"[final] {variable.symbol}"
        if REFERENCE in written:
            raise BadInput(f'{key}: "{REFERENCE}" cannot be a limit of a range; give two numbers')
        if not spec.has_cost:
            raise BadInput(
                f"{key}: the model {spec.name} has no cost that could determine a value in a range; give a number"
            )
        lower, upper = (
            sign * math.inf if end == FREE else value_of(variable, end, key)
            for end, sign in zip(written, (-1.0, 1.0), strict=True)
        )
        if math.isinf(lower) and math.isinf(upper):
            raise BadInput(f"{key}: both limits of the range are free; leave the state out of [final]")
        if lower > upper:
            raise BadInput(
                f"{key}: the range is empty, because {shown(written[0])} exceeds {shown(written[1])}; swap the two"
            )
        if lower < upper:
            found[variable.symbol] = (lower, upper)
    return found


def without_ranges(table: Final, spec: ProblemSpec) -> dict[str, float | str]:
    """Return the exact final values, given by a number or by a range of zero width."""
    inside = ranges(table, spec)
    return {
        name: value[0] if isinstance(value, tuple) else value for name, value in table.items() if name not in inside
    }
