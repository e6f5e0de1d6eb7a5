"""The numbers of an instance that a study may vary, by the names that instance files have for them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any

import numpy as np

from satsym.instance import Instance
from satsym.instance.resolve import parameters, quantity, time, value_of
from satsym.spec import ProblemSpec, Variable
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion


class Table(str, Enum):
    """A table of an instance file that has such numbers."""

    INITIAL = "initial"
    FINAL = "final"
    PARAMETERS = "parameters"
    TIME = "time"
    CONTROL = "control"


@dataclass(frozen=True)
class Key:
    """A number of an instance, such as ``initial.r``."""

    table: Table
    name: str

    @property
    def text(self) -> str:
        """As it is asked for, and as tables name it."""
        return f"{self.table.value}.{self.name}"

    def value(self, given: float | str, spec: ProblemSpec) -> float:
        """A number as it stands, or a quantity with its unit, in the model's unit and inside its domain.

        Raises
        ------
        BadInput
            If it is no such number.
        """
        if self.table is Table.TIME:
            return time(given, self.text, spec)
        if self.table is Table.CONTROL:
            number = quantity(given, spec.controls[0].unit, self.text)
            if number <= 0.0:
                raise BadInput(f"{self.text}: {shown(given)} leaves no control; write a positive number")
            return number
        return value_of(self._variable(spec), given, self.text)

    def spread(self, given: float | str, spec: ProblemSpec) -> float:
        """A standard deviation in the model's unit."""
        if self.table is Table.TIME:
            number = time(given, self.text, spec)
        else:
            number = quantity(given, self.unit(spec), self.text)
        if number <= 0.0:
            raise BadInput(f"{self.text}: {shown(given)} is no standard deviation; write a positive number")
        return number

    def of(self, instance: Instance) -> float | None:
        """Its value in an instance; ``None`` where that gives no number."""
        spec = instance.model.spec
        if self.table is Table.TIME:
            return instance.t0 if self.name == "t0" else instance.tf
        if self.table is Table.CONTROL:
            return instance.max_norm
        if self.table is Table.FINAL:
            found = instance.final.get(self.name)
            return found if isinstance(found, float) else None
        if self.table is Table.INITIAL:
            return instance.initial[spec.state_names.index(self.name)]
        return instance.parameters[spec.parameter_names.index(self.name)]

    def unit(self, spec: ProblemSpec) -> str:
        """Its unit; of times nothing, for the model says what it counts them in."""
        if self.table is Table.TIME:
            return ""
        return spec.controls[0].unit if self.table is Table.CONTROL else self._variable(spec).unit

    def _variable(self, spec: ProblemSpec) -> Variable:
        variables = spec.parameters if self.table is Table.PARAMETERS else spec.states
        return next(v for v in variables if v.symbol == self.name)


def known(spec: ProblemSpec) -> Iterator[Key]:
    """All that a study may vary of an instance of a model."""
    for table, names in (
        (Table.INITIAL, spec.state_names),
        (Table.PARAMETERS, spec.parameter_names),
        (Table.TIME, ("tf", "t0")),
        (Table.FINAL, spec.state_names),
        (Table.CONTROL, ("max_norm",) if spec.control_set == "ball" else ()),
    ):
        for name in names:
            yield Key(table, name)


def find(text: str, instance: Instance) -> Key:
    """The key of a name.

    Raises
    ------
    BadInput
        If there is none, or the instance gives no number for it.
    """
    names = {key.text: key for key in known(instance.model.spec)}
    key = names.get(text)
    if key is None:
        raise BadInput(f"{printable(text)}: {printable(instance.name)} has no such number; {_instead(text, names)}")
    free = any(unknown.name == key.name and unknown.place.value == key.table.value for unknown in instance.free)
    if key.of(instance) is None or free:
        raise BadInput(f"{key.text}: {printable(instance.name)} gives no number for it; give it one there")
    return key


def _instead(text: str, names: dict[str, Key]) -> str:
    """What to write; bare names, which tables have too, are found by their ends."""
    ending = [name for name in names if name.partition(".")[2] == text]
    return f'did you mean "{ending[0]}"?' if ending else suggestion(text, names)


def at(instance: Instance, keys: tuple[Key, ...], values: tuple[float, ...]) -> Instance:
    """An instance with other values of some numbers, checked anew as far as they go.

    Raises
    ------
    BadInput
        If a value is outside its domain, or values do not fit together.
    """
    spec = instance.model.spec
    rows: dict[Table, dict[str, Any]] = {
        Table.INITIAL: dict(zip(spec.state_names, instance.initial, strict=True)),
        Table.PARAMETERS: dict(zip(spec.parameter_names, instance.parameters, strict=True)),
        Table.FINAL: dict(instance.final),
        Table.TIME: {"t0": instance.t0, "tf": instance.tf},
        Table.CONTROL: {"max_norm": instance.max_norm},
    }
    for key, value in zip(keys, values, strict=True):
        if not np.isfinite(value):
            raise BadInput(f"{key.text}: {value} is not finite; give a number")
        rows[key.table][key.name] = key.value(value, spec)
    t0, tf = rows[Table.TIME]["t0"], rows[Table.TIME]["tf"]
    if tf is not None and not tf > t0:
        raise BadInput(f"time.tf: {tf:g} is not after t0 = {t0:g}; write a later time")
    changed = {key.table for key in keys}
    given = rows[Table.PARAMETERS]
    return replace(
        instance,
        initial=tuple(rows[Table.INITIAL].values()),
        parameters=parameters(given, spec) if Table.PARAMETERS in changed else instance.parameters,
        final=rows[Table.FINAL] if Table.FINAL in changed else instance.final,
        t0=t0,
        tf=tf,
        max_norm=rows[Table.CONTROL]["max_norm"],
    )
