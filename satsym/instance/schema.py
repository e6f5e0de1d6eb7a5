"""The keys of an instance file with their types, independent of any model.

Tables are strict: a key that is not listed here is refused. Each type carries the words that a message uses for it, so
that the check and the message cannot differ.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from functools import cache
from typing import Annotated, Any, Literal, get_args, get_origin

import msgspec
from msgspec import Meta

from satsym import methods
from satsym.choices import Checked, Command, Sampling
from satsym.status import BadInput
from satsym.wording import printable, shown, suggestion

Name = Annotated[str, Meta(description="a name in quotes")]
Names = Annotated[tuple[str, ...], Meta(description='a list of names, such as ["u1"]')]
Text = Annotated[str, Meta(description="text in quotes")]
Quantity = Annotated[float | str, Meta(description='a number, or text with a unit such as "5 km"')]
FinalValue = Annotated[
    float | str | tuple[float | str, float | str],
    Meta(description='a number, text with a unit such as "5 km", "reference", or a range [lower, upper]'),
]
FinalTime = Annotated[float | str, Meta(description='a number, text with a unit such as "1 day", or "free"')]
Bound = Annotated[
    float | str | tuple[float | str, float | str] | dict[str, float | str],
    Meta(description="the lower and the upper bound, such as [-0.2, 0.2]; or max_norm, one number"),
]
Ends = Annotated[tuple[float | str, float | str], Meta(description="the first and the last value, such as [1.0, 1e-6]")]
Matrix = Annotated[
    list[float | list[float]], Meta(description="a list of rows of numbers, or a list of the diagonal entries")
]
Rows = Annotated[list[list[float]], Meta(description="a list of rows of numbers")]
Series = Annotated[float | str | list[float | str], Meta(description="a number, or a list of numbers over time")]
Spread = Annotated[str | dict[str, str], Meta(description='text such as "0.9:1.1:50"')]
Variations = dict[str, Spread]
Flag = Annotated[bool, Meta(description="true or false")]
Gains = Annotated[
    tuple[float, float],
    Meta(description="two numbers, the gains on the rate and on the angle, such as [13.56, 0.0678]"),
]


Epoch = Annotated[datetime, Meta(description="a date and a time in UTC, such as 2026-03-20T12:00:00Z")]


class OneOf:
    """A type of text that must be one of some names, which are evaluated when a file is read."""

    def __init__(self, names: Callable[[], tuple[str, ...]]) -> None:
        self.names = names

    @property
    def description(self) -> str:
        """Return the description of the key in the JSON schema, as ``Meta`` has it."""
        return "one of " + ", ".join(f'"{name}"' for name in self.names())


Method = Annotated[str, OneOf(methods.names)]
Commands = Annotated[str, OneOf(Command.names)]
Certificates = Annotated[str, OneOf(Checked.names)]
Samplings = Annotated[str, OneOf(Sampling.names)]
Backend = Literal["auto", "python", "numba"]
Backends = Annotated[Backend, Meta(description="one of " + ", ".join(f'"{b}"' for b in get_args(Backend)))]
Count = Annotated[int, Meta(ge=1, le=10**7, description="a whole number from 1 to 10000000")]
Steps = Annotated[int, Meta(ge=2, le=10**7, description="a whole number from 2 to 10000000")]
Seed = Annotated[int, Meta(ge=0, lt=2**32, description="a whole number from 0 to 4294967295")]
Positive = Annotated[float, Meta(gt=0, description="a positive number")]
UpToOne = Annotated[float, Meta(gt=0, le=1, description="a number above 0, at most 1")]

SOLVING, COMPARING, REGULATING = ("solve", "compare"), ("compare",), ("lqr", "simulate --feedback lqr")
MOVING = (*SOLVING, "simulate")
STUDYING = ("study",)
EXPORTING = ("export",)
RELAYS = ("simulate --feedback switching", "simulate --feedback pulses")
ALL = ("all",)


@dataclass(frozen=True)
class Key:
    """The purpose of a key, besides its type and its default."""

    meaning: str
    commands: tuple[str, ...] = ALL
    """Commands that use the key."""
    unit: str = ""
    """Unit of a plain number; empty for keys that are no quantities."""
    names: str = ""
    """Kind of the names that are the keys of a table, such as states; empty where the keys are fixed."""


class _Table(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    pass


class TimeTable(_Table, frozen=True):
    tf: Annotated[FinalTime, Key('final time; "free" if it is to be found', MOVING, "time")]
    t0: Annotated[Quantity, Key('initial time; "free" if it is to be found', MOVING, "time")] = 0.0
    tf_guess: Annotated[Quantity | None, Key("initial guess of a free final time", SOLVING, "time")] = None
    t0_guess: Annotated[Quantity | None, Key("initial guess of a free initial time", SOLVING, "time")] = None


class LqrTable(_Table, frozen=True):
    Q: Annotated[Matrix | None, Key("weights of the states, in x'Qx + 2x'Nu + u'Ru", REGULATING, "1")] = None
    R: Annotated[Matrix | None, Key("weights of the inputs", REGULATING, "1")] = None
    N: Annotated[Rows | None, Key("cross weights, a row for each state; zero by default", REGULATING, "1")] = None
    allowed: Annotated[
        dict[str, Quantity],
        Key(
            "allowed deviation d, which gives the weight 1/d^2, in place of Q and R",
            REGULATING,
            "the model's",
            "STATE or CONTROL",
        ),
    ] = {}
    inputs: Annotated[Names | None, Key("the controls that are used; all of them by default", REGULATING)] = None
    horizon: Annotated[Quantity | None, Key("length of the horizon; infinite by default", REGULATING, "time")] = None


_LAW = ("simulate --feedback classical", "compare", "compare --range")


class ClassicalTable(_Table, frozen=True):
    follows: Annotated[Name, Key("the state that follows the command", _LAW)]
    command: Annotated[Quantity, Key("commanded value after t0", _LAW, "the model's")]
    damping: Annotated[Quantity | None, Key("damping parameter d; both poles are at -d", _LAW, "1/time")] = None
    gains: Annotated[Gains | None, Key("gains on the rate and on the state, in place of damping", _LAW, "1")] = None
    differentiator: Annotated[
        Quantity, Key("time constant of the differentiator that measures the rate", _LAW, "time")
    ] = 0.0


class SwitchingTable(_Table, frozen=True):
    deadband: Annotated[Quantity, Key("allowed position error", RELAYS, "the model's")]


class DrivenTable(_Table, frozen=True):
    control: Annotated[Name, Key("a control that is taken from other instances", COMPARING)]
    by: Annotated[Names, Key("the instances that supply this control; one run for each instance", COMPARING)]


class GuessTable(_Table, frozen=True):
    state: Annotated[dict[str, Series], Key("state at evenly spaced times", SOLVING, "the model's", "STATE")] = {}
    costate: Annotated[
        dict[str, Series],
        Key("costate at evenly spaced times, without units", SOLVING, "cost per unit of the state", "STATE"),
    ] = {}
    control: Annotated[dict[str, Series], Key("control at evenly spaced times", SOLVING, "the model's", "CONTROL")] = {}
    parameter: Annotated[
        dict[str, Quantity], Key("initial guess of a free parameter", SOLVING, "the model's", "PARAMETER")
    ] = {}


class OrbitTable(_Table, frozen=True):
    epoch: Annotated[Epoch, Key("date and time at which the model's time is zero", EXPORTING)]
    frame: Annotated[Name, Key("the reference frame: EME2000, ICRF or GCRF", EXPORTING)] = "EME2000"
    centre: Annotated[Name, Key("the body at the origin, such as Earth; pictures show it", (*EXPORTING, "plot"))] = (
        "Earth"
    )
    inclination: Annotated[
        Quantity | None,
        Key(
            "planar models: inclination of the orbital plane to the plane of the frame's first two axes",
            EXPORTING,
            "rad",
        ),
    ] = None
    node: Annotated[
        Quantity | None, Key("planar models: angle from the frame's first axis to the ascending node", EXPORTING, "rad")
    ] = None
    argument: Annotated[
        Quantity | None, Key("planar models: angle from the ascending node to the model's first axis", EXPORTING, "rad")
    ] = None


class StudyTable(_Table, frozen=True):
    vary: Annotated[
        Variations, Key("a grid: LOW:HIGH:N, evenly spaced, or log:LOW:HIGH:N", STUDYING, "the model's", "KEY")
    ] = {}
    normal: Annotated[
        Variations, Key("a sample: MEAN,SD of a normal distribution", STUDYING, "the model's", "KEY")
    ] = {}
    uniform: Annotated[
        Variations, Key("a sample: LOW,HIGH of a uniform distribution", STUDYING, "the model's", "KEY")
    ] = {}
    sample: Annotated[Count | None, Key("number of cases in a sample", STUDYING)] = None
    method: Annotated[Samplings | None, Key("how a sample is drawn", STUDYING)] = None
    seed: Annotated[Seed | None, Key("seed of the random numbers of a sample", STUDYING)] = None
    command: Annotated[Commands | None, Key("the command that is run for each case", STUDYING)] = None
    certificate: Annotated[Certificates | None, Key("how solutions are certified", STUDYING)] = None
    feedback: Annotated[
        Name | None, Key("the control law of a simulation, as for `satsym simulate --feedback`", STUDYING)
    ] = None
    trajectories: Annotated[Flag, Key("whether trajectories are saved", STUDYING)] = False


class SolverOptions(_Table, frozen=True):
    """Options of solvers that are not part of the problem."""

    method: Annotated[Method, Key("solver; by default the one that suits the problem", SOLVING)] = methods.AUTO
    tolerance: Annotated[Positive, Key("largest residual that a solution may have", MOVING, "1")] = 1e-9
    steps: Annotated[Steps, Key("number of steps of the time grid", MOVING)] = 1000
    max_seconds: Annotated[Positive, Key("processor time after which the solver stops", MOVING, "s")] = 60.0
    max_iterations: Annotated[Count | None, Key("number of sweeps, for methods that sweep", SOLVING)] = None
    free_angles: Annotated[Names, Key("angles whose final value counts modulo a full turn", SOLVING)] = ()
    relaxation: Annotated[
        UpToOne | None,
        Key("fixed weight of the new control in each sweep, instead of quasi-Newton steps", SOLVING, "1"),
    ] = None
    backend: Annotated[Backends, Key("whether kernels are compiled", MOVING)] = "auto"


class InstanceFile(_Table, frozen=True):
    """The contents of an instance file."""

    model: Annotated[Name, Key("a shipped model, or the path of a model relative to this file, without .py")]
    initial: Annotated[
        dict[str, Quantity],
        Key('initial value of every state; "free" if the value is to be found', unit="the model's", names="STATE"),
    ]
    time: Annotated[TimeTable, Key("initial and final time")]
    title: Annotated[Text, Key("title of one line")] = ""
    parameters: Annotated[
        dict[str, Quantity],
        Key(
            'values that replace the defaults; "free" if a value is to be found', unit="the model's", names="PARAMETER"
        ),
    ] = {}
    final: Annotated[
        dict[str, FinalValue],
        Key(
            'required final values; a state that is left out or "free" is free, and so is a limit of a range '
            'that is "free"',
            (*SOLVING, *RELAYS),
            "the model's",
            "STATE",
        ),
    ] = {}
    control: Annotated[
        dict[str, Bound],
        Key(
            "bounds [lower, upper]; or max_norm (and min_norm), also in a table [control.SET] for one set",
            SOLVING,
            "the model's",
            "CONTROL",
        ),
    ] = {}
    lqr: Annotated[LqrTable | None, Key("a linear-quadratic regulator", REGULATING)] = None
    solver: Annotated[SolverOptions, Key("options of the solvers", MOVING)] = SolverOptions()
    guess: Annotated[GuessTable, Key("initial guesses for the solvers", SOLVING)] = GuessTable()
    classical: Annotated[ClassicalTable | None, Key("a linear law that follows a command", _LAW)] = None
    limits: Annotated[
        dict[str, Quantity],
        Key(
            "largest allowed magnitudes; compared with the result, not enforced",
            MOVING,
            "the model's",
            "STATE or quantity",
        ),
    ] = {}
    switching: Annotated[SwitchingTable | None, Key("a switching feedback law", RELAYS)] = None
    driven: Annotated[DrivenTable | None, Key("a control that other instances determine", COMPARING)] = None
    continuation: Annotated[
        dict[str, Ends],
        Key(
            "first and last values of the continuation parameter",
            ("solve",),
            "the model's",
            "PARAMETER, t0, tf, initial.STATE or final.STATE",
        ),
    ] = {}
    study: Annotated[StudyTable | None, Key("a study of this instance over ranges of values", STUDYING)] = None
    orbit: Annotated[OrbitTable | None, Key("date of the motion, and orientation of its plane in space", EXPORTING)] = (
        None
    )


def check(tree: dict[str, Any]) -> InstanceFile:
    """Check the keys of a TOML tree and the type of each value.

    Raises
    ------
    BadInput
        For the first key that is unknown, missing, or of another type.
    """
    checked: InstanceFile = _table(tree, InstanceFile, "")
    return checked


def study(tree: Mapping[str, Any]) -> StudyTable:
    """Check the options of a study from the command line or from Python as the table [study] is checked.

    Raises
    ------
    BadInput
        As :func:`check`.
    """
    checked: StudyTable = _table(dict(tree), StudyTable, "")
    return checked


def _table(tree: dict[str, Any], table: Any, section: str) -> Any:
    fields, kinds = _declared(table)
    for name in tree:
        if name not in fields:
            raise BadInput(f"{_key(section, name)}: unknown key; {_instead(name, kinds, table)}")
    for name, entry in fields.items():
        if entry.required and name not in tree:
            raise BadInput(f"{_key(section, name)}: missing; give {wanted(kinds[name], section, name)}")
    return table(**{name: _value(value, kinds[name], section, name) for name, value in tree.items()})


@cache
def _declared(table: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the keys of a table and their types."""
    fields = {entry.name: entry for entry in msgspec.structs.fields(table)}
    return fields, {name: apart(entry.type)[0] for name, entry in fields.items()}


def apart(kind: Any) -> tuple[Any, Key]:
    """Split an annotated type into the type of a key and its purpose."""
    base, *more = get_args(kind)
    (key,) = (m for m in more if isinstance(m, Key))
    others = tuple(m for m in more if not isinstance(m, Key))
    return (Annotated[(base, *others)] if others else base), key


def _value(value: Any, kind: Any, section: str, name: str) -> Any:
    inner, entries = inner_table(kind), entries_of(kind)
    if inner is None and entries is None:
        try:
            return _chosen(msgspec.convert(value, kind), kind)
        except msgspec.ValidationError:
            raise BadInput(f"{_key(section, name)}: got {shown(value)}; give {wanted(kind, section, name)}") from None
    if not isinstance(value, dict):
        raise BadInput(f"{_key(section, name)}: got {shown(value)}; give {wanted(kind, section, name)}")
    below = _below(section, name)
    if inner is not None:
        return _table(value, inner, below)
    return {name: _value(entry, entries, below, name) for name, entry in value.items()}


def _chosen(value: Any, kind: Any) -> Any:
    """Check a value of a type, which may have to be one of some names."""
    names = names_of(kind)
    if names and value is not None and value not in names:
        raise msgspec.ValidationError
    return value


def names_of(kind: Any) -> tuple[str, ...]:
    """Return the names that values of a type must be among; empty where any value is allowed."""
    metas = (meta for part in (kind, *get_args(kind)) for meta in getattr(part, "__metadata__", ()))
    return next((meta.names() for meta in metas if isinstance(meta, OneOf)), ())


def inner_table(kind: Any) -> type[_Table] | None:
    """Return the table that a type stands for, also where ``None`` is allowed instead."""
    return next((k for k in (kind, *get_args(kind)) if isinstance(k, type) and issubclass(k, _Table)), None)


def entries_of(kind: Any) -> Any:
    """Return the type of the values of a table whose keys are a model's names."""
    return get_args(kind)[1] if get_origin(kind) is dict else None


def _below(section: str, name: str) -> str:
    return f"{section}.{name}" if section else name


def _key(section: str, name: str) -> str:
    return f"[{section}] {printable(name)}" if section else printable(name)


def wanted(kind: Any, section: str, name: str) -> str:
    """Return the description of a type for messages; for a table, its header."""
    if inner_table(kind) or entries_of(kind):
        return f"a table, [{_below(section, name)}]"
    metas = (meta for part in (kind, *get_args(kind)) for meta in getattr(part, "__metadata__", ()))
    return next(str(meta.description) for meta in metas)


def _instead(name: str, kinds: dict[str, Any], table: type[Any]) -> str:
    if table is InstanceFile:
        for section, kind in kinds.items():
            inner = inner_table(kind)
            if inner is not None and name in inner.__struct_fields__:
                return f"it belongs in the table [{section}]"
    return suggestion(name, kinds)
