"""The ``[continuation]`` of an instance: what changes on the way from an easy problem to the one that is meant."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from satsym.instance.resolve import time, value_of
from satsym.spec import ProblemSpec
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

if TYPE_CHECKING:
    from satsym.instance.types import Instance

LARGE = 10.0
"""Ratio of both ends of the way from which steps are shares of its logarithm."""

INITIAL, FINAL, TIMES = "initial.", "final.", ("t0", "tf")


@dataclass(frozen=True)
class Varied:
    """A number of an instance that changes, in the model's unit."""

    key: str
    """A parameter, ``tf``, ``t0``, ``initial.STATE`` or ``final.STATE``."""
    begin: float
    end: float

    def value(self, share: float) -> float:
        """At a share of the way: of its logarithm where that is long."""
        if share in (0.0, 1.0):
            return self.end if share else self.begin
        if self.begin * self.end > 0.0 and max(self.begin / self.end, self.end / self.begin) >= LARGE:
            return float(self.begin * (self.end / self.begin) ** share)
        return self.begin + share * (self.end - self.begin)

    def of(self, instance: Instance) -> float | None:
        """Its value in an instance."""
        if self.key in TIMES:
            return instance.t0 if self.key == "t0" else instance.tf
        if self.key.startswith(FINAL):
            return float(instance.final[self.key.removeprefix(FINAL)])
        spec = instance.model.spec
        if self.key.startswith(INITIAL):
            return instance.initial[spec.state_names.index(self.key.removeprefix(INITIAL))]
        return instance.parameters[spec.parameter_names.index(self.key)]

    def at(self, instance: Instance, share: float) -> Instance:
        """The instance at a share of the way."""
        value = self.value(share)
        if self.key in TIMES:
            return replace(instance, t0=value) if self.key == "t0" else replace(instance, tf=value)
        if self.key.startswith(FINAL):
            return replace(instance, final={**instance.final, self.key.removeprefix(FINAL): value})
        spec = instance.model.spec
        if self.key.startswith(INITIAL):
            return replace(instance, initial=self._changed(instance.initial, spec.state_names, value))
        return replace(instance, parameters=self._changed(instance.parameters, spec.parameter_names, value))

    def _changed(self, row: tuple[float, ...], names: tuple[str, ...], value: float) -> tuple[float, ...]:
        k = names.index(self.key.removeprefix(INITIAL))
        return (*row[:k], value, *row[k + 1 :])


def varied(
    table: Mapping[str, tuple[float | str, float | str]], spec: ProblemSpec, given: Instance
) -> tuple[Varied, ...]:
    """What changes, checked against the model and against what the instance gives.

    Raises
    ------
    BadInput
        If there is no such number, or it is free, or both ends are the same.
    """
    variables = {v.symbol: v for v in spec.parameters}
    variables |= {f"{INITIAL}{v.symbol}": v for v in spec.states} | {f"{FINAL}{v.symbol}": v for v in spec.states}
    if table and not spec.has_cost:
        raise BadInput(f"[continuation]: the model {spec.name} has no cost, so there is nothing to solve; remove it")
    found = []
    for key, ends in table.items():
        place = f"[continuation] {printable(key)}"
        if key not in variables and key not in TIMES:
            instead = suggestion(key, [*variables, *TIMES])
            raise BadInput(f"{place}: no parameter, time or end of the model; {instead}")
        begin, end = (time(one, place, spec) if key in TIMES else value_of(variables[key], one, place) for one in ends)
        if begin == end:
            raise BadInput(f"{place}: both values are {shown(ends[0])}; write where it begins and where it ends")
        named = key.removeprefix(INITIAL)
        free = key == "tf" and given.tf is None
        free |= key.startswith(FINAL) and not isinstance(given.final.get(key.removeprefix(FINAL)), float)
        free |= any(unknown.name == named for unknown in given.free)
        if free:
            raise BadInput(f"{place}: the instance gives no number for it; give it one")
        found.append(Varied(key, begin, end))
    for share in (0.0, 1.0):
        case = given
        for one in found:
            case = one.at(case, share)
        if case.tf is not None and not case.tf > case.t0:
            raise BadInput(f"[continuation]: tf = {case.tf:g} is not after t0 = {case.t0:g}; write later times")
    return tuple(found)
