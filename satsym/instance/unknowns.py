"""Numbers that an instance leaves ``"free"``: initial states, the initial time, parameters. Solvers choose them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum
from typing import TYPE_CHECKING, Any

import msgspec

from satsym.instance.resolve import FREE, REFERENCE, time
from satsym.instance.schema import InstanceFile
from satsym.spec import ProblemSpec, Variable
from satsym.status import BadInput

if TYPE_CHECKING:
    from satsym.instance.types import Instance


class Place(str, Enum):
    """The table of an instance that contains a free number."""

    INITIAL = "initial"
    TIME = "time"
    PARAMETER = "parameters"


@dataclass(frozen=True)
class Unknown:
    """A free number of an instance, which is to be found from the initial guess that the instance holds.

    Attributes
    ----------
    place, name, index
        Table of the number, its key there, and its position among the states or parameters.
    positive
        Whether only positive values are meaningful.
    """

    place: Place
    name: str
    index: int
    positive: bool

    @property
    def key(self) -> str:
        """Return the key of the unknown number for messages."""
        return f"[{self.place.value}] {self.name}"

    def of(self, instance: Instance) -> float:
        """Return the value of the unknown number in an instance."""
        if self.place is Place.TIME:
            return instance.t0
        return (instance.initial if self.place is Place.INITIAL else instance.parameters)[self.index]

    def at(self, instance: Instance, value: float) -> Instance:
        """Return the instance with another value of the unknown number."""
        if self.place is Place.TIME:
            return replace(instance, t0=value)
        row = list(instance.initial if self.place is Place.INITIAL else instance.parameters)
        row[self.index] = value
        if self.place is Place.INITIAL:
            return replace(instance, initial=tuple(row))
        return replace(instance, parameters=tuple(row))

    def admits(self, instance: Instance, value: float) -> bool:
        """Tell whether a value is in the number's domain, and leaves time for the motion."""
        if self.place is Place.TIME:
            return instance.tf is None or value < instance.tf
        return value > 0.0 or not self.positive


def begun(file: InstanceFile, spec: ProblemSpec) -> tuple[InstanceFile, tuple[Unknown, ...]]:
    """Replace free numbers of a file by initial guesses, and return these numbers as unknowns.

    The guesses are the first guess of a state, its final value, the default of a parameter, the middle of its typical
    range, or else zero or one.

    Raises
    ------
    BadInput
        If the model has no cost, so that nothing chooses them.
    """
    found = tuple(_stated(file, spec))
    if found and not spec.has_cost:
        raise BadInput(
            f"{found[0].key}: the model {spec.name} has no cost that could determine this value; give a number"
        )
    if file.time.t0_guess is not None and file.time.t0 != FREE:
        raise BadInput(f'[time] t0_guess: the initial time is given; remove t0_guess, or write t0 = "{FREE}"')
    for name in file.guess.parameter:
        if file.parameters.get(name) != FREE and name in spec.parameter_names:
            raise BadInput(
                f'[guess.parameter] {name}: the parameter is given; remove this guess, or write {name} = "{FREE}"'
            )
    tables: dict[str, Any] = {"initial": dict(file.initial), "parameters": dict(file.parameters)}
    for unknown in found:
        if unknown.place is Place.TIME:
            tables["time"] = msgspec.structs.replace(file.time, t0=_first_time(file, spec))
        else:
            tables[unknown.place.value][unknown.name] = _first(file, unknown, spec)
    # one number says where to begin, and nothing of the motion; several are a motion that is guessed
    begins = {one.name for one in found if one.place is Place.INITIAL}
    moving = {k: v for k, v in file.guess.state.items() if k not in begins or (isinstance(v, list) and len(v) > 1)}
    tables["guess"] = msgspec.structs.replace(file.guess, state=moving)
    return msgspec.structs.replace(file, **tables), found


def _stated(file: InstanceFile, spec: ProblemSpec) -> Iterator[Unknown]:
    for place, table, variables in (
        (Place.INITIAL, file.initial, spec.states),
        (Place.PARAMETER, file.parameters, spec.parameters),
    ):
        for k, v in enumerate(variables):
            if table.get(v.symbol) == FREE:
                yield Unknown(place, v.symbol, k, v.positive)
    if file.time.t0 == FREE:
        yield Unknown(Place.TIME, "t0", 0, positive=False)


def _first(file: InstanceFile, unknown: Unknown, spec: ProblemSpec) -> float | str:
    """Return the initial guess of a state or a parameter."""
    name, guess = unknown.name, file.guess
    variable: Variable
    if unknown.place is Place.INITIAL:
        variable, series = spec.states[unknown.index], guess.state.get(name)
        stated = [series[0] if isinstance(series, list) and series else series, file.final.get(name)]
    else:
        variable = spec.parameters[unknown.index]
        stated = [guess.parameter.get(name), variable.default]
    for value in stated:
        if isinstance(value, str | float | int) and value not in (REFERENCE, FREE):
            return value
    if variable.typical is not None:
        return sum(variable.typical) / 2.0
    return 1.0 if variable.positive else 0.0


def _first_time(file: InstanceFile, spec: ProblemSpec) -> float | str:
    """Return the initial guess of the initial time: the stated guess, zero, or a time before the final one."""
    if file.time.t0_guess is not None:
        return file.time.t0_guess
    tf = 1.0 if file.time.tf == FREE else time(file.time.tf, "[time] tf", spec)
    return 0.0 if tf > 0.0 else 2.0 * tf - 1.0
