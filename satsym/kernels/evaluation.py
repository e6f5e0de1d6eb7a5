"""Batch forms at several places: values, derivatives by complex steps, and relations that hold between them.

The Hamiltonian says it all: its derivatives are the rates of states and costates, where it is least over the admissible
controls is the law, and with the law in it these rates are the canonical equations. Each relation is two sides that
were generated apart.
"""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.kernels.contract import BATCH, TUPLES, Signature, pointwise, sizes
from satsym.kernels.core import Function, Kernels

COMPLEX_STEP = 1e-30
COPIES, COPY_DISTANCE = 2, 1e-4
"""Copies of each place, and how far aside of it they are, relative to each argument."""

SMALLEST_FRACTION = 1e-4
"""Share of what a row of derivatives comes to at most, at which something smaller in it counts: terms may cancel."""

TOGETHER = {
    "dynamics": ("x", "u"),
    "hamiltonian": ("x", "u", "lam"),
    "canonical": ("x", "lam", "t"),
    "boundary": ("x", "lam", "nu", "t"),
    "terminal_cost": ("x", "t"),
    "invariants": ("x", "t"),
    "inertial_state": ("x", "t"),
    "switching_function": ("x", "lam", "t"),
}
"""Functions whose derivatives by several arguments are wanted: one call gives them all."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The functions of a model at places, and at copies a little aside of them."""

    kernels: Kernels
    """Kernels whose functions are evaluated."""
    at: Mapping[str, Any]
    """By name of the argument: times (K,), tables of K columns; for those in :data:`TUPLES` tuples of numbers or of
    arrays (K,). The first K/(1 + COPIES) columns are the places, then come the copies."""

    @cached_property
    def signatures(self) -> dict[str, Signature]:
        """Signatures of the functions that the model has."""
        return pointwise(self.kernels.spec)

    def has(self, *names: str) -> bool:
        """Whether the model has all of these functions."""
        return set(names) <= set(self.signatures)

    @cached_property
    def _shapes(self) -> dict[str, tuple[int, ...]]:
        """Shapes of the functions' values at one place."""
        counts = sizes(self.kernels.spec)
        return {name: tuple(counts[k] for k in signature.shape) for name, signature in self.signatures.items()}

    @cached_property
    def _and_without_costates(self) -> dict[str, Any]:
        """The arguments with a column more: the first place, without costates."""
        found: dict[str, Any] = {}
        for name in self.at:
            table = self._table(name, {})
            rows = np.concatenate([table, np.zeros_like(table[:, :1]) if name == "lam" else table[:, :1]], axis=1)
            found[name] = tuple(rows) if name in TUPLES else rows[0] if name == "t" else rows
        return found

    @cached_property
    def _known(self) -> dict[tuple[str, str], Array]:
        """Values (with no argument) and derivatives by an argument at the columns themselves, kept."""
        return {}

    def __call__(self, name: str, **instead: Any) -> Array:
        """A function at all columns, some arguments being others; the last axis counts the columns."""
        columns = len(self.at["t"])
        if instead:
            return self._value(name, {**self.at, **instead}, columns)
        if (name, "") not in self._known:
            found = self._value(name, self._and_without_costates, columns + 1)
            self._known[name, ""], self._known[name, "without costates"] = found[..., :-1], found[..., -1:]
        return self._known[name, ""]

    def single(self, name: str) -> Function:
        """The form on floats of a function."""
        return self.kernels.functions[name]

    def without_costates(self, name: str) -> Array:
        """A function at the first place if all costates vanish there, where laws may decide nothing; a column."""
        self(name)
        return self._known[name, "without costates"]

    def slope(self, name: str, by: str, **instead: Any) -> Array:
        """Derivatives by all components of an argument, exact but for rounding; the last axis but one counts these."""
        if instead:
            return self._slopes(name, (by,), instead)[by]
        if (name, by) not in self._known:
            together = TOGETHER.get(name, ())
            slopes = self._slopes(name, together if by in together else (by,), {})
            self._known.update({(name, argument): slope for argument, slope in slopes.items()})
        return self._known[name, by]

    def _value(self, name: str, at: Mapping[str, Any], columns: int) -> Array:
        found = np.empty((*self._shapes[name], columns))
        self._called(name, at, found)
        return found

    def _slopes(self, name: str, by: Sequence[str], instead: Mapping[str, Any]) -> dict[str, Array]:
        """Derivatives of a function by several arguments, computed in one call."""
        tables = {a: self._table(a, instead) for a in by}
        count, columns, first = sum(map(len, tables.values())), len(self.at["t"]), 0
        steps = 1j * COMPLEX_STEP * np.eye(count)[:, :, None]
        moved: dict[str, Any] = {}
        for a, table in tables.items():
            rows = table[:, None, :] + steps[first : first + len(table)]
            moved[a] = rows[0] if a == "t" else tuple(rows) if a in TUPLES else rows
            first += len(table)
        values = np.empty((*self._shapes[name], count, columns), dtype=complex)
        self._called(name, {**self.at, **instead, **moved}, values)
        slopes, found, end = values.imag / COMPLEX_STEP, dict[str, Array](), 0
        for a, table in tables.items():
            begin, end = end, end + len(table)
            found[a] = slopes[..., begin:end, :]
        return found

    def faint(self, name: str, by: str, **instead: Any) -> Array:
        """How small derivatives may be before what they are made of is lost: see :data:`SMALLEST_FRACTION`."""
        if instead:
            unit, value = size(self._table(by, instead)), size(self(name, **instead))
        else:
            unit, value = self._sizes["", by], self._sizes[name, ""]
        return np.asarray(SMALLEST_FRACTION * value[..., None, :] / np.where(unit > 0.0, unit, 1.0))

    @cached_property
    def _sizes(self) -> dict[tuple[str, str], Array]:
        """Sizes of functions at the columns themselves, and of arguments, told in one go."""
        tables = {(name, ""): self(name) for name in self.signatures} | {("", a): self._table(a, {}) for a in self.at}
        columns, found, end = len(self.at["t"]), dict[tuple[str, str], Array](), 0
        every = size(np.concatenate([table.reshape(-1, columns) for table in tables.values()]))
        for key, table in tables.items():
            begin, end = end, end + math.prod(table.shape[:-1])
            found[key] = every[begin:end].reshape(*table.shape[:-1], 1)
        return found

    def _table(self, by: str, instead: Mapping[str, Any]) -> Array:
        return np.asarray(instead.get(by, self.at[by]), dtype=float).reshape(-1, len(self.at["t"]))

    def _called(self, name: str, at: Mapping[str, Any], out: Array) -> None:
        """A function into an array that is given, so that it need not find out shapes and types."""
        self.kernels.functions[name + BATCH](*(at[a] for a in self.signatures[name].arguments), out=out)


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
    return np.asarray(1.0 + COPY_DISTANCE * (drawn + np.copysign(0.5, drawn)))


def size(values: Array) -> Array:
    """What errors of values are relative to, over all columns; the last axis becomes one.

    Their magnitude, and what they change by, for one part in the arguments: rounding does as much to them.
    """
    if not np.isfinite(values).all():
        values = np.where(np.isfinite(values), values, 0.0)
    groups = values.reshape(*values.shape[:-1], 1 + COPIES, -1)
    moved = np.abs(groups[..., 1:, :] - groups[..., :1, :]).max(axis=-2) / COPY_DISTANCE
    return np.asarray(np.maximum(np.abs(groups).max(axis=-2), moved).max(axis=-1, initial=0.0)[..., None])


@dataclass(frozen=True, eq=False)
class Relation:
    """Two sides that must be equal but for rounding."""

    function: str
    """The one that is held against the others."""
    claim: str
    """What it must be."""
    left: Array
    right: Array
    """The two sides that must be equal, of one shape; the last axis counts columns."""
    terms: Array | float = 0.0
    """Sizes of what the sides are sums of, where these may cancel; broadcast against the sides."""


def deviations(found: Sequence[Relation], scale: Callable[[Array], Array]) -> list[float]:
    """Largest difference of the sides of each relation, relative to their size; all of as many columns.

    Where neither side is finite there is nothing to compare; where one is, they could not differ more.

    Parameters
    ----------
    scale
        Size of the rows of a table, shape (rows, 1).
    """
    columns, ends = found[0].left.shape[-1], [0]
    left, right = (
        np.concatenate([side.reshape(-1, columns) for side in sides])
        for sides in zip(*((each.left, each.right) for each in found), strict=True)
    )
    terms = np.empty(left.shape)
    for each in found:
        ends.append(ends[-1] + math.prod(each.left.shape[:-1]))
        terms[ends[-2] : ends[-1]].reshape(each.left.shape)[...] = each.terms
    known = np.isfinite(left)
    one_sided = known != np.isfinite(right)
    left, right, terms = (np.where(known & np.isfinite(side), side, 0.0) for side in (left, right, terms))
    sizes = np.maximum(np.maximum(scale(left), scale(right)), terms.max(axis=-1, initial=0.0, keepdims=True))
    rows = np.where(one_sided, np.inf, np.abs(left - right)) / np.maximum(sizes, 1e-300)
    worst = rows.max(axis=-1, initial=0.0).tolist()
    return [max(worst[first:last], default=0.0) for first, last in pairwise(ends)]


def derivative(
    of: Evaluation, name: str, function: str, by: tuple[str, ...], factor: float = 1.0
) -> Iterator[Relation]:
    """A function must be the derivative of another, by one argument or by several in turn."""
    arguments = [a for a in by if len(of.at[a])]
    if not arguments:
        return
    slopes = np.concatenate([of.slope(function, a) for a in arguments], axis=-2)
    faint = np.concatenate([of.faint(function, a) for a in arguments], axis=-2)
    found = of(name).reshape(slopes.shape)
    yield Relation(name, f"derivative of {function} by {', '.join(by)}", found, factor * slopes, faint)


def along(of: Evaluation, name: str, rates: Array, **instead: Array) -> tuple[Array, Array]:
    """The rate of change of a function along a motion of the states, and the terms it consists of."""
    by_time = of.slope(name, "t", **instead)[..., 0, :]
    parts = of.slope(name, "x", **instead) * rates
    return by_time + parts.sum(axis=-2), np.abs(by_time) + np.abs(parts).sum(axis=-2)
