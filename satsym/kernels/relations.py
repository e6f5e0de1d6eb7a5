"""What functions of one module must have to do with each other, whatever the module describes.

The Hamiltonian says it all: its derivatives are the rates of states and costates, where it is least over the admissible
controls is the law, and with the law in it these rates are the canonical equations. Each relation is two sides that
were generated apart.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.kernels.evaluation import Evaluation


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
