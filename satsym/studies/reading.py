"""From what a user writes, on the command line or in a ``[study]`` table, to what a study varies."""

from __future__ import annotations

from collections.abc import Sequence

from satsym.choices import Sampling
from satsym.instance import Instance
from satsym.instance import numbers as keys
from satsym.instance.numbers import Key, texts
from satsym.instance.schema import StudyTable
from satsym.status import BadInput
from satsym.studies.design import Axis, Design, Distribution, Grid, Sample
from satsym.wording import printable, shown

MOST_ROWS = 10**7

RANGE = "LOW:HIGH:N or log:LOW:HIGH:N, such as 0.9:1.1:50"
PAIR = {"normal": "MEAN,SD, such as 1.1,0.01", "uniform": "LOW,HIGH, such as 0.9,1.1"}


def design(asked: StudyTable, instance: Instance) -> Design:
    """What a study varies, checked against an instance.

    Raises
    ------
    BadInput
        With one line, if nothing varies, a key does not exist or varies twice, a value lies outside its domain, there
        is both a grid and a sample, or there are too many rows.
    """
    vary = texts(asked.vary)
    drawn = [(kind, key, text) for kind in PAIR for key, text in texts(getattr(asked, kind))]
    if vary and (drawn or asked.sample is not None):
        raise BadInput("a study is a grid (vary) or a sample (sample, normal, uniform), not both; remove one of them")
    if not vary and not drawn:
        known = ", ".join(key.text for key in keys.known(instance.model.spec))
        raise BadInput(f"nothing varies; write --vary KEY={RANGE}; keys here: {printable(known, 300)}")
    seen: set[str] = set()
    for name in (*(name for name, _ in vary), *(name for _, name, _ in drawn)):
        if (key := keys.find(name, instance).text) in seen:
            raise BadInput(f"{key}: varies twice; remove one of the two")
        seen.add(key)
    if vary:
        if unused := [name for name in ("method", "seed") if getattr(asked, name) is not None]:
            raise BadInput(f"{unused[0]}: is for a sample, and this is a grid; remove it")
        found: Design = Grid(tuple(_axis(key, text, instance) for key, text in vary))
    else:
        found = _sample(asked, tuple(_distribution(kind, key, text, instance) for kind, key, text in drawn))
    if found.count > MOST_ROWS:
        raise BadInput(f"{found.count} rows are more than {MOST_ROWS}; write fewer values")
    return found


def _axis(name: str, text: str, instance: Instance) -> Axis:
    key = keys.find(name, instance)
    logarithmic = text.startswith("log:")
    parts = text.removeprefix("log:").split(":")
    if len(parts) != 3 or not all(part.strip() for part in parts):
        raise BadInput(f"{key.text}: {shown(text)} is not a range; write {RANGE}")
    low, high = (_value(key, part, instance) for part in parts[:2])
    count = _count(parts[2], f"{key.text}: {shown(text)}")
    if logarithmic and not min(low, high) > 0.0:
        raise BadInput(f"{key.text}: {shown(text)} has no logarithm; write positive ends, or leave out log:")
    if (low == high) != (count == 1):
        raise BadInput(f"{key.text}: {shown(text)} has {count} values; LOW and HIGH must differ, or N must be 1")
    return Axis(key, low, high, count, logarithmic)


def _distribution(kind: str, name: str, text: str, instance: Instance) -> Distribution:
    key = keys.find(name, instance)
    parts = text.split(",")
    if len(parts) != 2 or not all(part.strip() for part in parts):
        raise BadInput(f"{key.text}: {shown(text)} is not a {kind} distribution; write {PAIR[kind]}")
    first = _value(key, parts[0], instance)
    if kind == "normal":
        return Distribution(key, first, key.spread(_number(parts[1], key), instance.model.spec), normal=True)
    second = _value(key, parts[1], instance)
    if not first < second:
        raise BadInput(f"{key.text}: {shown(text)} LOW is not below HIGH; write {PAIR[kind]}")
    return Distribution(key, first, second, normal=False)


def _sample(asked: StudyTable, distributions: tuple[Distribution, ...]) -> Sample:
    if asked.sample is None:
        raise BadInput("the number of rows to draw is missing; write --sample N")
    return Sample(distributions, asked.sample, Sampling(asked.method or Sampling.SOBOL), asked.seed or 0)


def _value(key: Key, text: str, instance: Instance) -> float:
    """A value, which the instance can have while all else stays as it is."""
    value = key.value(_number(text, key), instance.model.spec)
    try:
        keys.at(instance, (key,), (value,))
    except BadInput as error:
        raise BadInput(f"{key.text}: {shown(text.strip())} is not possible ({error})") from None
    return value


def _number(text: str, key: Key) -> float | str:
    """A finite number, or text with a unit."""
    try:
        number = float(text)
    except ValueError:
        return text.strip()
    if number - number != 0.0:
        raise BadInput(f"{key.text}: {shown(text)} is not finite; write a finite number")
    return number


def _count(text: str, place: str) -> int:
    try:
        count = int(text)
    except ValueError:
        count = 0
    if not 1 <= count <= MOST_ROWS:
        raise BadInput(f"{place}: {shown(text)} is not a number of values; write a whole number from 1 to {MOST_ROWS}")
    return count


def read_pairs(entries: Sequence[str], option: str) -> dict[str, str]:
    """``KEY=VALUE`` arguments of an option."""
    wanted = {"vary": RANGE, "set": "VALUE, such as initial.r=1.05", **PAIR}[option]
    found: dict[str, str] = {}
    for entry in entries:
        key, equals, value = (part.strip() for part in entry.partition("="))
        if not (equals and key and value):
            raise BadInput(f"--{option} {printable(entry)}: write --{option} KEY={wanted}")
        if key in found:
            raise BadInput(f"--{option} {printable(key)}: is there twice; remove one of the two")
        found[key] = value
    return found


def settings(instance: Instance, entries: Sequence[str]) -> dict[str, float]:
    """What ``--set KEY=VALUE`` gives, by key, in the model's units.

    Raises
    ------
    BadInput
        If a key does not exist, or a value is not possible.
    """
    found = dict[str, float]()
    for name, text in read_pairs(entries, "set").items():
        key = keys.find(name, instance)
        if key.text in found:
            raise BadInput(f"--set {key.text}: is there twice; remove one of the two")
        found[key.text] = key.value(_number(text, key), instance.model.spec)
    return found
