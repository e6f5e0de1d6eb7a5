"""Reading of what a study varies, from the command line or a ``[study]`` table: a grid or a sample."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.choices import Sampling
from satsym.instance import Instance
from satsym.instance import numbers as keys
from satsym.instance.numbers import Key, texts
from satsym.instance.schema import StudyTable
from satsym.status import BadInput
from satsym.wording import printable, shown

MOST_ROWS = 10**7

RANGE = "LOW:HIGH:N or log:LOW:HIGH:N, such as 0.9:1.1:50"
PAIR = {"normal": "MEAN,SD, such as 1.1,0.01", "uniform": "LOW,HIGH, such as 0.9,1.1"}


def design(asked: StudyTable, instance: Instance) -> Design:
    """Return the grid or sample of a study, checked against an instance.

    Raises
    ------
    BadInput
        With one line, if nothing varies, a key does not exist or varies twice, a value lies outside its domain, there
        is both a grid and a sample, or there are too many rows.
    """
    vary = texts(asked.vary)
    drawn = [(kind, key, text) for kind in PAIR for key, text in texts(getattr(asked, kind))]
    if vary and (drawn or asked.sample is not None):
        raise BadInput(
            "a study must be either a grid (vary) or a sample (sample, normal, uniform), not both; remove one of them"
        )
    if not vary and not drawn:
        known = ", ".join(key.text for key in keys.known(instance.model.spec))
        raise BadInput(f"the study varies no key; write --vary KEY={RANGE}; available keys: {printable(known, 300)}")
    seen: set[str] = set()
    for name in (*(name for name, _ in vary), *(name for _, name, _ in drawn)):
        if (key := keys.find(name, instance).text) in seen:
            raise BadInput(f"{key}: is varied twice; remove one of the two")
        seen.add(key)
    if vary:
        if unused := [name for name in ("method", "seed") if getattr(asked, name) is not None]:
            raise BadInput(f"{unused[0]}: applies to samples only, but this study is a grid; remove it")
        found: Design = Grid(tuple(_axis(key, text, instance) for key, text in vary))
    else:
        found = _sample(asked, tuple(_distribution(kind, key, text, instance) for kind, key, text in drawn))
    if found.count > MOST_ROWS:
        raise BadInput(f"the study has {found.count} cases, but at most {MOST_ROWS} are allowed; give fewer values")
    return found


def _axis(name: str, text: str, instance: Instance) -> Axis:
    key = keys.find(name, instance)
    logarithmic = text.startswith("log:")
    parts = text.removeprefix("log:").split(":")
    if len(parts) != 3 or not all(part.strip() for part in parts):
        raise BadInput(f"{key.text}: {shown(text)} is not a range; give {RANGE}")
    low, high = (_value(key, part, instance) for part in parts[:2])
    count = _count(parts[2], f"{key.text}: {shown(text)}")
    if logarithmic and not min(low, high) > 0.0:
        raise BadInput(
            f"{key.text}: the logarithm of {shown(text)} does not exist; give positive limits, or leave out log:"
        )
    if (low == high) != (count == 1):
        raise BadInput(
            f"{key.text}: {shown(text)} has {count} values, but must have a single one; LOW and HIGH must differ, "
            "or N must be 1"
        )
    return Axis(key, low, high, count, logarithmic)


def _distribution(kind: str, name: str, text: str, instance: Instance) -> Distribution:
    key = keys.find(name, instance)
    parts = text.split(",")
    if len(parts) != 2 or not all(part.strip() for part in parts):
        raise BadInput(f"{key.text}: {shown(text)} is not a {kind} distribution; give {PAIR[kind]}")
    first = _value(key, parts[0], instance)
    if kind == "normal":
        return Distribution(key, first, key.spread(_number(parts[1], key), instance.model.spec), normal=True)
    second = _value(key, parts[1], instance)
    if not first < second:
        raise BadInput(f"{key.text}: {shown(text)}, but LOW must be less than HIGH; give {PAIR[kind]}")
    return Distribution(key, first, second, normal=False)


def _sample(asked: StudyTable, distributions: tuple[Distribution, ...]) -> Sample:
    if asked.sample is None:
        raise BadInput("the number of cases in the sample is missing; write --sample N")
    return Sample(distributions, asked.sample, Sampling(asked.method or Sampling.SOBOL), asked.seed or 0)


def _value(key: Key, text: str, instance: Instance) -> float:
    """Return a value that the instance can have with all other numbers unchanged."""
    value = key.value(_number(text, key), instance.model.spec)
    try:
        keys.at(instance, (key,), (value,))
    except BadInput as error:
        raise BadInput(f"{key.text}: the value {shown(text.strip())} is not possible ({error})") from None
    return value


def _number(text: str, key: Key) -> float | str:
    """Return a finite number, or a text with a unit."""
    try:
        number = float(text)
    except ValueError:
        return text.strip()
    if number - number != 0.0:
        raise BadInput(f"{key.text}: {shown(text)} is not finite; give a finite number")
    return number


def _count(text: str, place: str) -> int:
    try:
        count = int(text)
    except ValueError:
        count = 0
    if not 1 <= count <= MOST_ROWS:
        raise BadInput(
            f"{place}: the number of values must be a positive integer, not {shown(text)}; give a whole "
            f"number between 1 and {MOST_ROWS}"
        )
    return count


def read_pairs(entries: Sequence[str], option: str) -> dict[str, str]:
    """Read ``KEY=VALUE`` arguments of an option."""
    wanted = {"vary": RANGE, "set": "VALUE, such as initial.r=1.05", **PAIR}[option]
    found: dict[str, str] = {}
    for entry in entries:
        key, equals, value = (part.strip() for part in entry.partition("="))
        if not (equals and key and value):
            raise BadInput(f"--{option} {printable(entry)}: write --{option} KEY={wanted}")
        if key in found:
            raise BadInput(f"--{option} {printable(key)}: is given twice; remove one of the two")
        found[key] = value
    return found


def settings(instance: Instance, entries: Sequence[str]) -> dict[str, float]:
    """Return the values of ``--set KEY=VALUE`` by key, in the model's units.

    Raises
    ------
    BadInput
        If a key does not exist, or a value is not possible.
    """
    found = dict[str, float]()
    for name, text in read_pairs(entries, "set").items():
        key = keys.find(name, instance)
        if key.text in found:
            raise BadInput(f"--set {key.text}: is given twice; remove one of the two")
        found[key.text] = key.value(_number(text, key), instance.model.spec)
    return found


ROUNDING = 1e-15
"""Deviation due to rounding, as a fraction of the largest value of a grid, up to which a value belongs to the grid."""


@dataclass(frozen=True)
class Axis:
    """Values of one key, evenly spaced, linearly or in their logarithms."""

    key: Key
    low: float
    high: float
    count: int
    logarithmic: bool = False

    @cached_property
    def values(self) -> Array:
        """Return the values in order, with both ends exact."""
        if self.logarithmic:
            found = np.exp(np.linspace(math.log(self.low), math.log(self.high), self.count))
        else:
            size = max(abs(self.low), abs(self.high))
            found = np.array([_decimal(v, size) for v in np.linspace(self.low, self.high, self.count)])
        found[0], found[-1] = self.low, self.high if self.count > 1 else self.low
        return found


def _decimal(value: float, size: float) -> float:
    """Return the short decimal number that a value of a grid is but for rounding, such as 0.95; else the value."""
    short = float(f"{value:.12g}")
    return short if abs(short - value) <= ROUNDING * size else float(value)


@dataclass(frozen=True)
class Grid:
    """All combinations of the values of some axes; the last axis varies fastest."""

    axes: tuple[Axis, ...]

    @property
    def keys(self) -> tuple[Key, ...]:
        """Return the keys that vary."""
        return tuple(axis.key for axis in self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the number of values of each axis."""
        return tuple(axis.count for axis in self.axes)

    @property
    def count(self) -> int:
        """Return the number of rows."""
        return math.prod(self.shape)

    def rows(self, start: int, stop: int) -> Array:
        """Return the values of some rows, shape (stop - start, keys)."""
        places = np.unravel_index(np.arange(start, stop), self.shape)
        return np.stack([axis.values[place] for axis, place in zip(self.axes, places, strict=True)], axis=-1)

    def stated(self) -> dict[str, str]:
        """Return the varied values by key, as the command line states them."""
        return {
            f"vary {axis.key.text}": f"{'log:' if axis.logarithmic else ''}{axis.low!r}:{axis.high!r}:{axis.count}"
            for axis in self.axes
        }


@dataclass(frozen=True)
class Distribution:
    """A normal or a uniform distribution of one key."""

    key: Key
    first: float
    second: float
    """Mean and standard deviation, or both ends of the interval."""
    normal: bool

    def quantiles(self, shares: Array) -> Array:
        """Return the quantiles of the distribution at some probabilities."""
        if not self.normal:
            return self.first + (self.second - self.first) * shares
        from scipy.special import ndtri

        return self.first + self.second * ndtri(shares)


@dataclass(frozen=True)
class Sample:
    """Values drawn from distributions."""

    distributions: tuple[Distribution, ...]
    count: int
    method: Sampling
    seed: int

    @property
    def keys(self) -> tuple[Key, ...]:
        """Return the keys that vary."""
        return tuple(one.key for one in self.distributions)

    @cached_property
    def _shares(self) -> Array:
        """Return points in the open unit cube."""
        dimension = len(self.distributions)
        if self.method is Sampling.RANDOM:
            points = np.random.default_rng(self.seed).random((self.count, dimension))
        else:
            import warnings

            from scipy.stats import qmc

            kind = qmc.Sobol if self.method is Sampling.SOBOL else qmc.LatinHypercube
            engine = kind(dimension, seed=self.seed)
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # numbers that are no powers of two are the user's choice
                points = engine.random(self.count)
        return np.clip(points, 2.0**-53, 1.0 - 2.0**-53)

    def rows(self, start: int, stop: int) -> Array:
        """Return the values of some rows, shape (stop - start, keys)."""
        shares = self._shares[start:stop]
        return np.stack([one.quantiles(shares[:, k]) for k, one in enumerate(self.distributions)], axis=-1)

    def stated(self) -> dict[str, str]:
        """Return the varied values by key, as the command line states them."""
        found = {
            f"{'normal' if one.normal else 'uniform'} {one.key.text}": f"{one.first!r},{one.second!r}"
            for one in self.distributions
        }
        return {"sample": str(self.count), "method": self.method.value, "seed": str(self.seed)} | found


Design: TypeAlias = Grid | Sample


def scaled(values: Array) -> Array:
    """Scale each column of rows by its spread, so that distances between rows are comparable."""
    spread = np.ptp(values, axis=0) if len(values) else np.ones(values.shape[1:])
    return values / np.where(spread > 0.0, spread, 1.0)


def chain(values: Array) -> Sequence[int]:
    """Return an order of rows in which each follows its nearest predecessor, starting from the first row."""
    left, places = list(range(len(values))), scaled(values)
    order = [left.pop(0)] if left else []
    while left:
        distances = np.abs(places[left] - places[order[-1]]).sum(axis=-1)
        order.append(left.pop(int(np.argmin(distances))))
    return order
