"""Which values a study gives to what it varies: those of a grid, or a sample."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np

from satsym.arrays import Array
from satsym.choices import Sampling
from satsym.instance.numbers import Key

ROUNDING = 1e-15
"""Share of the largest value of a grid by which rounding moves another one."""


@dataclass(frozen=True)
class Axis:
    """Values of one key, evenly spaced, or so in their logarithms."""

    key: Key
    low: float
    high: float
    count: int
    logarithmic: bool = False

    @cached_property
    def values(self) -> Array:
        """Values of the number that varies, in order; the ends exactly."""
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
    """Every combination of the values of some axes, those of the last one varying first."""

    axes: tuple[Axis, ...]

    @property
    def keys(self) -> tuple[Key, ...]:
        """What varies."""
        return tuple(axis.key for axis in self.axes)

    @property
    def shape(self) -> tuple[int, ...]:
        """Numbers of values."""
        return tuple(axis.count for axis in self.axes)

    @property
    def count(self) -> int:
        """Rows."""
        return math.prod(self.shape)

    def rows(self, start: int, stop: int) -> Array:
        """Values of some rows, shape (stop - start, keys)."""
        places = np.unravel_index(np.arange(start, stop), self.shape)
        return np.stack([axis.values[place] for axis, place in zip(self.axes, places, strict=True)], axis=-1)

    def stated(self) -> dict[str, str]:
        """Values that vary, by key, as the command line has them."""
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
    """Mean and standard deviation, or both ends."""
    normal: bool

    def quantiles(self, shares: Array) -> Array:
        """Values below which lie these shares of it."""
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
        """What varies."""
        return tuple(one.key for one in self.distributions)

    @cached_property
    def _shares(self) -> Array:
        """Points of the unit cube, inside it."""
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
        """Values of some rows, shape (stop - start, keys)."""
        shares = self._shares[start:stop]
        return np.stack([one.quantiles(shares[:, k]) for k, one in enumerate(self.distributions)], axis=-1)

    def stated(self) -> dict[str, str]:
        """Values that vary, by key, as the command line has them."""
        found = {
            f"{'normal' if one.normal else 'uniform'} {one.key.text}": f"{one.first!r},{one.second!r}"
            for one in self.distributions
        }
        return {"sample": str(self.count), "method": self.method.value, "seed": str(self.seed)} | found


Design: TypeAlias = Grid | Sample


def scaled(values: Array) -> Array:
    """Rows with each column scaled to its spread, so that distances between rows mean something."""
    spread = np.ptp(values, axis=0) if len(values) else np.ones(values.shape[1:])
    return values / np.where(spread > 0.0, spread, 1.0)


def chain(values: Array) -> Sequence[int]:
    """An order of rows in which each follows the nearest one before it that is left, from the first row on."""
    left, places = list(range(len(values))), scaled(values)
    order = [left.pop(0)] if left else []
    while left:
        distances = np.abs(places[left] - places[order[-1]]).sum(axis=-1)
        order.append(left.pop(int(np.argmin(distances))))
    return order
