"""Evaluation of batch forms at several places: values, derivatives by complex steps, and relations between them.

The Hamiltonian determines the other functions: its derivatives are the rates of states and costates, its minimiser over
the admissible controls is the law, and with the law in it these rates are the canonical equations. The two sides of
each relation were generated separately.
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
"""Number of displaced copies of each point, and their relative distance from the point in each argument."""

SMALLEST_FRACTION = 1e-4
"""Fraction of the largest derivative in a row below which a derivative is not compared, since terms may cancel."""

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
"""Function -> arguments with respect to which it is differentiated in one call."""


@dataclass(frozen=True, eq=False)
class Evaluation:
    """The functions of a model, evaluated at places and at copies displaced a little from them."""

    kernels: Kernels
    """Kernels whose functions are evaluated."""
    at: Mapping[str, Any]
    """Name of an argument -> its values: times (K,), tables of K columns, or tuples for the arguments in
    :data:`TUPLES`.

    The first K/(1 + COPIES) columns are the points, the others their displaced copies.
    """

    @cached_property
    def signatures(self) -> dict[str, Signature]:
        """Return the signatures of the functions that the model has."""
        return pointwise(self.kernels.spec)

    def has(self, *names: str) -> bool:
        """Tell whether the model has all of these functions."""
        return set(names) <= set(self.signatures)

    @cached_property
    def _shapes(self) -> dict[str, tuple[int, ...]]:
        """Return the shapes of the functions' values at one place."""
        counts = sizes(self.kernels.spec)
        return {name: tuple(counts[k] for k in signature.shape) for name, signature in self.signatures.items()}

    @cached_property
    def _and_without_costates(self) -> dict[str, Any]:
        """Return the arguments with one more column: the first place, with zero costates."""
        found: dict[str, Any] = {}
        for name in self.at:
            table = self._table(name, {})
            rows = np.concatenate([table, np.zeros_like(table[:, :1]) if name == "lam" else table[:, :1]], axis=1)
            found[name] = tuple(rows) if name in TUPLES else rows[0] if name == "t" else rows
        return found

    @cached_property
    def _known(self) -> dict[tuple[str, str], Array]:
        """Return the cache of values (with no argument) and derivatives by an argument at the columns themselves."""
        return {}

    def __call__(self, name: str, **instead: Any) -> Array:
        """Evaluate a function at all columns, with some arguments replaced; the last axis counts the columns."""
        columns = len(self.at["t"])
        if instead:
            return self._value(name, {**self.at, **instead}, columns)
        if (name, "") not in self._known:
            found = self._value(name, self._and_without_costates, columns + 1)
            self._known[name, ""], self._known[name, "without costates"] = found[..., :-1], found[..., -1:]
        return self._known[name, ""]

    def single(self, name: str) -> Function:
        """Return the form on floats of a function."""
        return self.kernels.functions[name]

    def without_costates(self, name: str) -> Array:
        """Evaluate a function at the first place with zero costates, where laws may be undecided; a column."""
        self(name)
        return self._known[name, "without costates"]

    def slope(self, name: str, by: str, **instead: Any) -> Array:
        """Return derivatives by all components of an argument, exact up to rounding.

        The last axis but one counts the components.
        """
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
        """Return derivatives of a function by several arguments, computed in one call."""
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
        """Return the size below which a derivative is lost in rounding: see :data:`SMALLEST_FRACTION`."""
        if instead:
            unit, value = size(self._table(by, instead)), size(self(name, **instead))
        else:
            unit, value = self._sizes["", by], self._sizes[name, ""]
        return np.asarray(SMALLEST_FRACTION * value[..., None, :] / np.where(unit > 0.0, unit, 1.0))

    @cached_property
    def _sizes(self) -> dict[tuple[str, str], Array]:
        """Return the sizes of functions at the columns themselves, and of arguments, computed together."""
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
        """Evaluate a function into a given array, so that shapes and types need not be found."""
        self.kernels.functions[name + BATCH](*(at[a] for a in self.signatures[name].arguments), out=out)


def with_copies(at: Mapping[str, Any], seed: int) -> dict[str, Any]:
    """Return arguments at places (K,) with displaced copies of each, every component by a different fraction."""
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
    """Return the factors by which arguments are displaced."""
    rng = random.Random(seed)
    drawn = np.array([rng.random() - 0.5 for _ in range(count)])
    return np.asarray(1.0 + COPY_DISTANCE * (drawn + np.copysign(0.5, drawn)))


def size(values: Array) -> Array:
    """Return the size to which errors of values are relative, over all columns; the last axis becomes one.

    It is the magnitude of the values plus their change for a relative change of the arguments by one: rounding of the
    arguments affects them as much.
    """
    if not np.isfinite(values).all():
        values = np.where(np.isfinite(values), values, 0.0)
    groups = values.reshape(*values.shape[:-1], 1 + COPIES, -1)
    moved = np.abs(groups[..., 1:, :] - groups[..., :1, :]).max(axis=-2) / COPY_DISTANCE
    return np.asarray(np.maximum(np.abs(groups).max(axis=-2), moved).max(axis=-1, initial=0.0)[..., None])


@dataclass(frozen=True, eq=False)
class Relation:
    """Two sides that must be equal up to rounding."""

    function: str
    """Name of the function that is compared with others."""
    claim: str
    """The relation that the function must satisfy, in words."""
    left: Array
    right: Array
    """The two sides that must be equal, of the same shape, whose last axis counts columns."""
    terms: Array | float = 0.0
    """Magnitudes of the terms of both sides, needed if terms may cancel; broadcast to the shape of the sides."""


def deviations(found: Sequence[Relation], scale: Callable[[Array], Array]) -> list[float]:
    """Return the largest difference of the sides of each relation, relative to their size.

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
    """Relate a function to the derivative of another, by one argument or by several in turn."""
    arguments = [a for a in by if len(of.at[a])]
    if not arguments:
        return
    slopes = np.concatenate([of.slope(function, a) for a in arguments], axis=-2)
    faint = np.concatenate([of.faint(function, a) for a in arguments], axis=-2)
    found = of(name).reshape(slopes.shape)
    yield Relation(name, f"derivative of {function} by {', '.join(by)}", found, factor * slopes, faint)


def along(of: Evaluation, name: str, rates: Array, **instead: Array) -> tuple[Array, Array]:
    """Return the rate of change of a function along a motion of the states, and the terms of this rate."""
    by_time = of.slope(name, "t", **instead)[..., 0, :]
    parts = of.slope(name, "x", **instead) * rates
    return by_time + parts.sum(axis=-2), np.abs(by_time) + np.abs(parts).sum(axis=-2)
