"""Batch forms at several places: values, derivatives by complex steps, and how large what they are made of is."""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.kernels.contract import BATCH, TUPLES, Signature, pointwise
from satsym.kernels.core import Kernels

COMPLEX_STEP = 1e-30
COPIES, ASIDE = 2, 1e-4
"""Copies of each place, and how far aside of it they are, relative to each argument."""

FAINT = 1e-4
"""Share of what a row of derivatives comes to at most, at which something smaller in it counts: terms may cancel."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The functions of a model at places, and at copies a little aside of them."""

    kernels: Kernels
    """Whose."""
    at: Mapping[str, Any]
    """By name of the argument: times (K,), tables of K columns; for those in :data:`TUPLES` tuples of numbers or of
    arrays (K,). The first K/(1 + COPIES) columns are the places, then come the copies."""

    @cached_property
    def signatures(self) -> dict[str, Signature]:
        """Of the functions that the model has."""
        return pointwise(self.kernels.spec)

    def has(self, *names: str) -> bool:
        """Whether the model has all of these functions."""
        return set(names) <= set(self.signatures)

    @cached_property
    def _known(self) -> dict[tuple[str, str], Array]:
        """Values (with no argument) and derivatives by an argument at the columns themselves, kept."""
        return {}

    def __call__(self, name: str, **instead: Any) -> Array:
        """A function at all columns, some arguments being others; the last axis counts the columns."""
        if instead:
            return self._value(name, instead)
        if (name, "") not in self._known:
            self._known[name, ""] = self._value(name, instead)
        return self._known[name, ""]

    def slope(self, name: str, by: str, **instead: Any) -> Array:
        """Derivatives by all components of an argument, exact but for rounding; the last axis but one counts these."""
        if instead:
            return self._slope(name, by, instead)
        if (name, by) not in self._known:
            self._known[name, by] = self._slope(name, by, instead)
        return self._known[name, by]

    def _value(self, name: str, instead: Mapping[str, Any]) -> Array:
        found = np.asarray(self._called(name, instead), dtype=float)
        # what takes nothing that varies has no columns
        axes = len(self.signatures[name].shape)
        return found if found.ndim > axes else np.broadcast_to(found[..., None], (*found.shape, len(self.at["t"])))

    def _slope(self, name: str, by: str, instead: Mapping[str, Any]) -> Array:
        table = self._table(by, instead)
        moved: Any = table[:, None, :] + 1j * COMPLEX_STEP * np.eye(len(table))[:, :, None]
        moved = moved[0] if by == "t" else tuple(moved) if by in TUPLES else moved
        others = {}
        if by in TUPLES:  # functions take their shape from arrays, so these have as many copies
            given = {a: np.asarray(instead.get(a, v)) for a, v in self.at.items() if a not in TUPLES}
            others = {a: np.repeat(v[..., None, :], len(table), axis=-2) for a, v in given.items()}
        return np.asarray(np.imag(self._called(name, {**instead, **others, by: moved})) / COMPLEX_STEP)

    def faint(self, name: str, by: str, **instead: Any) -> Array:
        """How small derivatives may be before what they are made of is lost: see :data:`FAINT`."""
        if instead:
            unit, value = size(self._table(by, instead)), size(self(name, **instead))
        else:
            unit, value = self._size("", by), self._size(name, "")
        return np.asarray(FAINT * value[..., None, :] / np.where(unit > 0.0, unit, 1.0))

    @cached_property
    def _sizes(self) -> dict[tuple[str, str], Array]:
        """Of values and of arguments, kept."""
        return {}

    def _size(self, name: str, by: str) -> Array:
        """Of a function at the columns themselves, or of an argument."""
        if (name, by) not in self._sizes:
            self._sizes[name, by] = size(self(name) if name else self._table(by, {}))
        return self._sizes[name, by]

    def _table(self, by: str, instead: Mapping[str, Any]) -> Array:
        return np.asarray(instead.get(by, self.at[by]), dtype=float).reshape(-1, len(self.at["t"]))

    def _called(self, name: str, instead: Mapping[str, Any]) -> Any:
        arguments = {**self.at, **instead}
        function = self.kernels.functions[name + BATCH]
        return function(*(arguments[a] for a in self.signatures[name].arguments))


def with_copies(at: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Arguments at places (K,) with copies aside of each, every component by another share of itself."""
    tables = {name: np.asarray(values, dtype=float).reshape(-1, len(at["t"])) for name, values in at.items()}
    all_rows = np.concatenate(list(tables.values()))
    aside = _aside(seed, COPIES * all_rows.size).reshape(len(all_rows), COPIES, -1)
    copied = np.concatenate([all_rows, (all_rows[:, None, :] * aside).reshape(len(all_rows), -1)], axis=1)
    found: dict[str, Any] = {}
    for name, table in tables.items():
        rows, copied = copied[: len(table)], copied[len(table) :]
        found[name] = tuple(rows) if name in TUPLES else rows[0] if name == "t" else rows
    return found


@lru_cache(maxsize=8)
def _aside(seed: int, count: int) -> Array:
    """Factors by which arguments are moved."""
    rng = random.Random(seed)
    drawn = np.array([rng.random() - 0.5 for _ in range(count)])
    return np.asarray(1.0 + ASIDE * (drawn + np.copysign(0.5, drawn)))


def size(values: Array) -> Array:
    """What errors of values are relative to, over all columns; the last axis becomes one.

    Their magnitude, and what they change by, for one part in the arguments: rounding does as much to them.
    """
    if not np.isfinite(values).all():
        values = np.where(np.isfinite(values), values, 0.0)
    groups = values.reshape(*values.shape[:-1], 1 + COPIES, -1)
    moved = np.abs(groups[..., 1:, :] - groups[..., :1, :]).max(axis=-2) / ASIDE
    return np.asarray(np.maximum(np.abs(groups).max(axis=-2), moved).max(axis=-1, initial=0.0)[..., None])
