"""The keys of an instance file and the type of each, before any model is known.

Tables are strict: a key that is not listed here is refused. Each type carries the words that a message uses for
it, so that what is checked and what is said cannot drift apart.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any, Literal, get_args, get_origin

import msgspec
from msgspec import Meta

from satsym import methods
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

Name = Annotated[str, Meta(description="a name in quotes")]
Names = Annotated[tuple[str, ...], Meta(description='a list of names, such as ["u1"]')]
Text = Annotated[str, Meta(description="text in quotes")]
Quantity = Annotated[float | str, Meta(description='a number, or text with a unit such as "5 km"')]
FinalValue = Annotated[float | str, Meta(description='a number, text with a unit such as "5 km", or "reference"')]
FinalTime = Annotated[float | str, Meta(description='a number, text with a unit such as "1 day", or "free"')]
Bound = Annotated[
    float | str | tuple[float | str, float | str] | dict[str, float | str],
    Meta(description="the lower and the upper bound, such as [-0.2, 0.2]; or max_norm, one number"),
]
Ends = Annotated[
    tuple[float | str, float | str], Meta(description="where it begins and where it ends, such as [1.0, 1e-6]")
]
Matrix = Annotated[
    list[float | list[float]], Meta(description="a list of rows of numbers, or the list of the diagonal's numbers")
]
Series = Annotated[float | str | list[float | str], Meta(description="a number, or a list of numbers over time")]
Variations = Annotated[
    dict[str, str | dict[str, str]], Meta(description='a table of texts, such as "initial.r" = "0.9:1.1:50"')
]
Gains = Annotated[
    tuple[float, float],
    Meta(description="two numbers, the gain of the rate and that of the angle, such as [13.56, 0.0678]"),
]


class OneOf:
    """Names of which a text is one, asked for when a file is read: more may be known by then."""

    def __init__(self, names: Callable[[], tuple[str, ...]]) -> None:
        self.names = names

    @property
    def description(self) -> str:
        """As of ``Meta``."""
        return "one of " + ", ".join(f'"{name}"' for name in self.names())


Method = Annotated[str, OneOf(methods.names)]
Backend = Literal["auto", "python", "numba"]
Count = Annotated[int, Meta(ge=1, le=10**7, description="a whole number from 1 to 10000000")]
Positive = Annotated[float, Meta(gt=0, description="a positive number")]


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    pass


class TimeTable(_Table, frozen=True):
    tf: FinalTime
    t0: Quantity = 0.0
    tf_guess: Quantity | None = None
    t0_guess: Quantity | None = None


class LqrTable(_Table, frozen=True):
    Q: Matrix | None = None
    R: Matrix | None = None
    allowed: dict[str, Quantity] = {}
    inputs: Names | None = None
    horizon: Quantity | None = None


class ClassicalTable(_Table, frozen=True):
    follows: Name
    command: Quantity
    damping: Quantity | None = None
    gains: Gains | None = None
    differentiator: Quantity = 0.0


class SwitchingTable(_Table, frozen=True):
    deadband: Quantity


class DrivenTable(_Table, frozen=True):
    control: Name
    by: Names


class GuessTable(_Table, frozen=True):
    state: dict[str, Series] = {}
    costate: dict[str, Series] = {}
    control: dict[str, Series] = {}
    parameter: dict[str, Quantity] = {}


class StudyTable(_Table, frozen=True):
    vary: Variations = {}
    normal: Variations = {}
    uniform: Variations = {}
    sample: Count | None = None
    method: Name | None = None
    seed: Annotated[int, Meta(ge=0, lt=2**32, description="a whole number from 0 to 4294967295")] | None = None
    command: Name | None = None
    certificate: Name | None = None
    feedback: Name | None = None
    trajectories: bool = False


class SolverOptions(_Table, frozen=True):
    """What the solvers are told."""

    method: Method = methods.AUTO
    """Which solver, ``"auto"`` for the one that fits."""
    tolerance: Positive = 1e-9
    """Largest residual of an answer."""
    steps: Annotated[int, Meta(ge=2, le=10**7, description="a whole number from 2 to 10000000")] = 1000
    """Steps of the grid, from 2."""
    max_seconds: Positive = 60.0
    max_iterations: Count | None = None
    """When to give up; the latter counts sweeps, other methods know by themselves how many steps make sense."""
    free_angles: Names = ()
    """States whose final value counts modulo a turn."""
    relaxation: Annotated[float, Meta(gt=0, le=1, description="a number above 0, at most 1")] | None = None
    """Share of the new control in each sweep, in (0, 1]; chooses plain relaxation."""
    backend: Annotated[Backend, Meta(description="one of " + ", ".join(f'"{b}"' for b in get_args(Backend)))] = "auto"
    """Whether kernels are compiled."""


class InstanceFile(_Table, frozen=True):
    """An instance as it was written."""

    model: Name
    initial: dict[str, Quantity]
    time: TimeTable
    title: Text = ""
    parameters: dict[str, Quantity] = {}
    final: dict[str, FinalValue] = {}
    control: dict[str, Bound] = {}
    lqr: LqrTable | None = None
    solver: SolverOptions = SolverOptions()
    guess: GuessTable = GuessTable()
    classical: ClassicalTable | None = None
    limits: dict[str, Quantity] = {}
    switching: SwitchingTable | None = None
    driven: DrivenTable | None = None
    continuation: dict[str, Ends] = {}
    study: StudyTable | None = None


def check(tree: dict[str, Any]) -> InstanceFile:
    """Check the keys of a TOML tree and the type of each value.

    Raises
    ------
    BadInput
        For the first key that is unknown, missing, or of another type.
    """
    checked: InstanceFile = _table(tree, InstanceFile, "")
    return checked


def _table(tree: dict[str, Any], table: type[Any], section: str) -> Any:
    fields = {entry.name: entry for entry in msgspec.structs.fields(table)}
    for name in tree:
        if name not in fields:
            raise BadInput(f"{_key(section, name)}: unknown key; {_instead(name, fields, table)}")
    for name, entry in fields.items():
        if entry.required and name not in tree:
            raise BadInput(f"{_key(section, name)}: missing; write {_wanted(entry.type, section, name)}")
    return table(**{name: _value(value, fields[name].type, section, name) for name, value in tree.items()})


def _value(value: Any, kind: Any, section: str, name: str) -> Any:
    inner, entries = _inner(kind), _entries(kind)
    if inner is None and entries is None:
        try:
            return _chosen(msgspec.convert(value, kind), kind)
        except msgspec.ValidationError:
            raise BadInput(f"{_key(section, name)}: got {shown(value)}; write {_wanted(kind, section, name)}") from None
    if not isinstance(value, dict):
        raise BadInput(f"{_key(section, name)}: got {shown(value)}; write {_wanted(kind, section, name)}")
    below = _below(section, name)
    if inner is not None:
        return _table(value, inner, below)
    return {name: _value(entry, entries, below, name) for name, entry in value.items()}


def _chosen(value: Any, kind: Any) -> Any:
    """A value of a type, which may have to be one of some names."""
    for meta in getattr(kind, "__metadata__", ()):
        if isinstance(meta, OneOf) and value not in meta.names():
            raise msgspec.ValidationError
    return value


def _inner(kind: Any) -> type[_Table] | None:
    """The table that a type stands for, if it is one or may be ``None`` instead."""
    return next((k for k in (kind, *get_args(kind)) if isinstance(k, type) and issubclass(k, _Table)), None)


def _entries(kind: Any) -> Any:
    """The type of the values of a table whose keys are a model's names."""
    return get_args(kind)[1] if get_origin(kind) is dict else None


def _below(section: str, name: str) -> str:
    return f"{section}.{name}" if section else name


def _key(section: str, name: str) -> str:
    return f"[{section}] {printable(name)}" if section else printable(name)


def _wanted(kind: Any, section: str, name: str) -> str:
    """The words that a type carries, for a table its header."""
    if _inner(kind) or _entries(kind):
        return f"a table, [{_below(section, name)}]"
    metas = (meta for part in (kind, *get_args(kind)) for meta in getattr(part, "__metadata__", ()))
    return next(str(meta.description) for meta in metas)


def _instead(name: str, fields: dict[str, Any], table: type[Any]) -> str:
    if table is InstanceFile:
        for section, entry in fields.items():
            inner = _inner(entry.type)
            if inner is not None and name in inner.__struct_fields__:
                return f"it belongs under [{section}]"
    return suggestion(name, fields)
