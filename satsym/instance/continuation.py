"""The ``[continuation]`` table: numbers that change on the way from an easy problem to the stated one."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from satsym.instance.numbers import Key, Table, named
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.wording import printable, shown

if TYPE_CHECKING:
    from satsym.instance.types import Instance

LARGE = 10.0
"""Ratio of both ends of a continuation above which its steps are logarithmic."""


@dataclass(frozen=True)
class Varied:
    """A number of an instance that changes during a continuation, in the model's unit."""

    key: Key
    begin: float
    end: float

    def value(self, share: float) -> float:
        """Return the number at a fraction of the way, on a logarithmic scale where the way is long."""
        if share in (0.0, 1.0):
            return self.end if share else self.begin
        if self.begin * self.end > 0.0 and max(self.begin / self.end, self.end / self.begin) >= LARGE:
            return float(self.begin * (self.end / self.begin) ** share)
        return self.begin + share * (self.end - self.begin)

    def at(self, instance: Instance, share: float) -> Instance:
        """Return the instance at a fraction of the way."""
        return self.key.placed(instance, self.value(share))


def varied(
    table: Mapping[str, tuple[float | str, float | str]], spec: ProblemSpec, given: Instance
) -> tuple[Varied, ...]:
    """Return the number that changes, checked against the model and the numbers of the instance.

    Raises
    ------
    BadInput
        If there is no such number, or it is free, or both ends are the same.
    """
    if table and not spec.has_cost:
        raise BadInput(
            f"[continuation]: the model {spec.name} has no cost, so there is nothing to solve; remove this table"
        )
    found = list[Varied]()
    for name, ends in table.items():
        place = f"[continuation] {printable(name)}"
        key = named(name, given, place, without=Table.CONTROL)
        if any(one.key == key for one in found):
            raise BadInput(f"{place}: is given twice, as {key.short} and as {key.text}; remove one of the two")
        begin, end = (key.value(one, spec, place) for one in ends)
        if begin == end:
            raise BadInput(
                f"{place}: both values are {shown(ends[0])}; give two different values, the first and the last"
            )
        if not key.given(given):
            raise BadInput(f"{place}: the instance gives no numerical value for this key; give it a number")
        found.append(Varied(key, begin, end))
    for share in (0.0, 1.0):
        case = given
        for one in found:
            case = one.at(case, share)
        if case.tf is not None and not case.tf > case.t0:
            raise BadInput(f"[continuation]: tf = {case.tf:g} is not after t0 = {case.t0:g}; give later times")
    return tuple(found)
