"""The numbers of an instance that can be varied, by their names in instance files."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from difflib import get_close_matches
from enum import Enum
from typing import TYPE_CHECKING, Any

from satsym.instance import weights
from satsym.instance.control import MAX_NORM
from satsym.instance.resolve import parameters, quantity, time, value_of
from satsym.spec import ProblemSpec, Variable
from satsym.status import BadInput
from satsym.wording import printable, shown, some, suggestion

if TYPE_CHECKING:
    from satsym.instance.types import Instance


class Table(str, Enum):
    """The tables of an instance file whose numbers can be varied."""

    INITIAL = "initial"
    FINAL = "final"
    PARAMETERS = "parameters"
    TIME = "time"
    CONTROL = "control"
    LQR = "lqr"


GUESS = "tf_guess"
"""Key of the guess of a free final time, which may be set where the file has none."""

SIDES = ("lower", "upper")
"""Last parts of keys of bounds on one control, as in ``control.u1.lower``."""


@dataclass(frozen=True)
class Key:
    """The key of a number of an instance, such as ``initial.r``."""

    table: Table
    name: str

    @property
    def text(self) -> str:
        """Return the full name of the number, as in ``initial.r``."""
        return f"{self.table.value}.{self.name}"

    @property
    def short(self) -> str:
        """Return the name used in continuations: parameters and times without their table."""
        return self.name if self.table in (Table.PARAMETERS, Table.TIME) else self.text

    def value(self, given: float | str, spec: ProblemSpec, place: str = "") -> float:
        """Convert a number, or a quantity with its unit, to the model's unit, and check its domain.

        Parameters
        ----------
        place
            The place of the number in messages; by default its name.

        Raises
        ------
        BadInput
            If it is no such number.
        """
        place = place or self.text
        if isinstance(given, str) and given.lstrip().startswith("["):
            raise BadInput(
                f"{place}: {shown(given)} is not a number; ranges and bounds can be set only in the instance file"
            )
        if self.table is Table.TIME:
            return time(given, place, spec)
        if self.table is Table.CONTROL:
            number = quantity(given, self.unit(spec), place)
            if self.name == MAX_NORM and number <= 0.0:
                raise BadInput(f"{place}: a bound of {shown(given)} admits no control; give a positive number")
            return number
        if self.table is Table.LQR:
            return quantity(given, "1", place)
        return value_of(self._variable(spec), given, place)

    def spread(self, given: float | str, spec: ProblemSpec) -> float:
        """Convert a standard deviation to the model's unit."""
        if self.table is Table.TIME:
            number = time(given, self.text, spec)
        else:
            number = quantity(given, self.unit(spec), self.text)
        if number <= 0.0:
            raise BadInput(f"{self.text}: {shown(given)} is not a standard deviation; give a positive number")
        return number

    def of(self, instance: Instance) -> float | None:
        """Return the value in an instance; ``None`` where the instance gives no number."""
        spec = instance.model.spec
        if self.table is Table.TIME:
            return {"t0": instance.t0, "tf": instance.tf, GUESS: instance.tf_guess}[self.name]
        if self.table is Table.CONTROL:
            if self.name == MAX_NORM:
                return instance.max_norm
            bound = float(getattr(instance, self.side)[self._control(spec)])
            return bound if math.isfinite(bound) else None
        if self.table is Table.LQR:
            return weights.entry(instance.lqr, self.name, spec.state_names)
        if self.table is Table.FINAL:
            found = instance.final.get(self.name)
            return found if isinstance(found, float) else None
        if self.table is Table.INITIAL:
            return instance.initial[spec.state_names.index(self.name)]
        return instance.parameters[spec.parameter_names.index(self.name)]

    def given(self, instance: Instance) -> bool:
        """Tell whether an instance gives a number for this key, neither omitted nor free."""
        free = any(unknown.name == self.name and unknown.place.value == self.table.value for unknown in instance.free)
        return not free and self.of(instance) is not None

    def placed(self, instance: Instance, value: float) -> Instance:
        """Return an instance with another value of this key, without checks."""
        return placed(instance, {self: value})

    def unit(self, spec: ProblemSpec) -> str:
        """Return the unit of the number; times have none, since the model states their unit."""
        if self.table in (Table.TIME, Table.LQR):
            return "" if self.table is Table.TIME else "1"
        return spec.controls[self._control(spec)].unit if self.table is Table.CONTROL else self._variable(spec).unit

    @property
    def side(self) -> str:
        """Return the side of the control's interval that is bounded, ``lower`` or ``upper``."""
        return self.name.rpartition(".")[2]

    def _control(self, spec: ProblemSpec) -> int:
        """Return the position of the control that is bounded; the first one where all are."""
        return 0 if self.name == MAX_NORM else spec.control_names.index(self.name.rpartition(".")[0])

    def _variable(self, spec: ProblemSpec) -> Variable:
        variables = spec.parameters if self.table is Table.PARAMETERS else spec.states
        return next(v for v in variables if v.symbol == self.name)


def placed(instance: Instance, values: Mapping[Key, float]) -> Instance:
    """Return an instance with other values, without checks; it is made once, because that takes time."""
    spec, fields = instance.model.spec, dict[str, Any]()
    for key, value in values.items():
        match key.table:
            case Table.TIME:
                fields[key.name] = value
            case Table.CONTROL if key.name == MAX_NORM:
                fields["max_norm"] = value
            case Table.CONTROL:
                row = fields.get(key.side, getattr(instance, key.side))
                fields[key.side] = _with(row, spec.control_names.index(key.name.rpartition(".")[0]), value)
            case Table.FINAL:
                fields["final"] = {**fields.get("final", instance.final), key.name: value}
            case Table.INITIAL:
                row = fields.get("initial", instance.initial)
                fields["initial"] = _with(row, spec.state_names.index(key.name), value)
            case Table.LQR:
                fields["lqr"] = weights.placed(fields.get("lqr", instance.lqr), key.name, value, spec.state_names)
            case Table.PARAMETERS:
                row = fields.get("parameters", instance.parameters)
                fields["parameters"] = _with(row, spec.parameter_names.index(key.name), value)
    return replace(instance, **fields)


def _with(row: tuple[float, ...], place: int, value: float) -> tuple[float, ...]:
    return (*row[:place], value, *row[place + 1 :])


def known(spec: ProblemSpec) -> Iterator[Key]:
    """Return the keys of all numbers that can be varied in an instance of a model."""
    for table, names in (
        (Table.INITIAL, spec.state_names),
        (Table.PARAMETERS, spec.parameter_names),
        (Table.TIME, ("tf", "t0", GUESS)),
        (Table.FINAL, spec.state_names),
        (Table.CONTROL, (MAX_NORM,) if spec.control_set == "ball" else ()),
        (Table.CONTROL, tuple(f"{name}.{side}" for name in _in_boxes(spec) for side in SIDES)),
        (Table.LQR, weights.entries(spec.state_names, spec.control_names)),
    ):
        for name in names:
            yield Key(table, name)


def _in_boxes(spec: ProblemSpec) -> tuple[str, ...]:
    """Return the controls that have bounds of their own."""
    if spec.control_parts:
        return tuple(name for part in spec.control_parts if part.kind == "box" for name in part.controls)
    return spec.control_names if spec.control_set == "box" else ()


def find(text: str, instance: Instance) -> Key:
    """Return the key of a name that has a number in the instance.

    Raises
    ------
    BadInput
        If there is none, or the instance gives no numerical value for it.
    """
    key = named(text, instance, printable(text))
    if key.table is Table.FINAL and key.name in instance.ranges:
        raise BadInput(
            f"{key.text}: {instance.called} gives a range for this key, which can be set only in the instance file"
        )
    guessed = key.name == GUESS and key.table is Table.TIME
    if guessed and instance.tf is not None:
        raise BadInput(f"{key.text}: {instance.called} gives the final time; set time.tf, or leave out this key")
    if not guessed and not key.given(instance):
        raise BadInput(f"{key.text}: {instance.called} gives no numerical value for this key; add a number there")
    return key


def named(text: str, instance: Instance, place: str, without: Table | None = None) -> Key:
    """Return the key of a full or short name.

    Parameters
    ----------
    place
        The place of the name in messages.
    without
        A table whose numbers are excluded.

    Raises
    ------
    BadInput
        If there is none.
    """
    keys = [key for key in known(instance.model.spec) if key.table is not without]
    for key in keys:
        if text in (key.text, key.short):
            return key
    raise BadInput(f"{place}: {instance.called} has no numerical quantity of this name; {_instead(text, keys)}")


def _instead(text: str, keys: list[Key]) -> str:
    """Suggest what to write for an unknown name: a key with this ending, a side of a bound, or a table's keys."""
    if sides := [key.text for key in keys if key.table is Table.CONTROL and key.text.rpartition(".")[0] == text]:
        return f"bounds are {' and '.join(sides)}"
    if ending := [key.text for key in keys if key.name == text]:
        return f'did you mean "{ending[0]}"?'
    table, _, name = text.partition(".")
    own = [key.name for key in keys if key.table.value == table]
    if not own:
        return suggestion(text, [key.text for key in keys])
    near = get_close_matches(name, own, n=1)
    return f'did you mean "{table}.{near[0]}"?' if near else f"available: {some([f'{table}.{one}' for one in own])}"


def changed(instance: Instance, values: Mapping[str, float]) -> Instance:
    """Return an instance with other values of some numbers, by name; see :func:`at`."""
    return at(instance, tuple(find(name, instance) for name in values), tuple(values.values()))


def texts(table: Mapping[str, str | Mapping[str, str]]) -> list[tuple[str, str]]:
    """Return keys and values of a table, written as ``"initial.r"`` or as a subtable ``initial`` with ``r``."""
    found: list[tuple[str, str]] = []
    for name, value in table.items():
        if isinstance(value, str):
            found.append((name, value))
        else:
            found += [(f"{name}.{inner}", text) for inner, text in value.items()]
    return found


def at(instance: Instance, keys: tuple[Key, ...], values: tuple[float, ...]) -> Instance:
    """Return an instance with other values of some numbers, after the checks that concern them.

    Where a continuation varies one of them, it ends at the new value.

    Raises
    ------
    BadInput
        If a value is outside its domain, or values do not fit together.
    """
    spec, found, ends = instance.model.spec, instance, dict(zip(keys, values, strict=True))
    for key, value in ends.items():
        if not math.isfinite(value):
            raise BadInput(f"{key.text}: {value} is not finite; give a number")
    found = placed(found, {key: key.value(value, spec) for key, value in ends.items()})
    if found.lqr and any(key.table is Table.LQR for key in keys):
        weights.checked(found.lqr.Q, found.lqr.R, found.lqr.N, len(spec.states), len(found.lqr.inputs))
    if any(key.table is Table.PARAMETERS for key in keys):
        parameters(dict(zip(spec.parameter_names, found.parameters, strict=True)), spec)
    for name, low, high in zip(spec.control_names, found.lower, found.upper, strict=True):
        if low > high:
            raise BadInput(f"control.{name}: the lower bound {low:g} exceeds the upper bound {high:g}; swap them")
    if instance.continuation:
        ways = [replace(one, end=ends.get(one.key, one.end)) for one in instance.continuation]
        found = replace(found, continuation=tuple(one for one in ways if one.begin != one.end))
    begun = found
    for one in found.continuation:
        begun = one.key.placed(begun, one.begin)
    for each in (found, begun):
        for name, end in (("tf", each.tf), (GUESS, each.tf_guess)):
            if end is not None and not end > each.t0:
                raise BadInput(f"time.{name}: {end:g} is not after t0 = {each.t0:g}; give a later time")
    return found
