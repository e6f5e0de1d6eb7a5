"""How large the values of a printed program may become: looked at before they are made."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from satsym.formula import budget
from satsym.formula.budget import OverBudget
from satsym.status import BadInput

MAX_SIZE = 100_000
"""Entries of an array or a list, characters of a text; the shipped programs have arrays of up to 3000."""


def made(count: int) -> None:
    """Count what is about to be made."""
    if count > MAX_SIZE:
        raise OverBudget(f"an array, a list or a text of more than {MAX_SIZE:,} entries")
    budget.charge(numbers=count)


def broadcast(one: Any, other: Any) -> None:
    """Count the entries of what two arrays, or an array and a number, are put together to."""
    made(math.prod(np.broadcast_shapes(np.shape(one), np.shape(other))))


def indexed(owner: Any, place: Any) -> None:
    """Count the entries that lists of indices pick from an array; a slice is a view and takes nothing."""
    parts = place if isinstance(place, tuple) else (place,)
    picked = math.prod(max(1, extent(part)) for part in parts if isinstance(part, list | np.ndarray))
    if picked > 1:
        made(picked * (owner.size // max(1, owner.shape[0]) if len(parts) == 1 and owner.ndim else owner.size))


def formatted(parts: Sequence[str]) -> str:
    """Texts as one, unless that is too long."""
    made(sum(map(len, parts)))
    return "".join(parts)


def numeric(value: Any) -> Any:
    """Numbers, or lists of them, as an array."""
    if not isinstance(value, np.ndarray):
        _refuse_others(value)
        made(extent(value))
    return np.asarray(value)


def extent(value: Any, known: dict[int, int] | None = None) -> int:
    """Entries of a value, and of what is in it, each as often as it is there."""
    if isinstance(value, np.ndarray):
        return int(value.size)
    if isinstance(value, str):
        return len(value)
    if not isinstance(value, list | tuple):
        return 1
    sizes = {} if known is None else known
    if id(value) not in sizes:
        sizes[id(value)] = 1 + sum(extent(entry, sizes) for entry in value)
    return sizes[id(value)]


def _refuse_others(value: Any) -> None:
    if isinstance(value, list | tuple):
        for entry in value:
            _refuse_others(entry)
    elif not isinstance(value, int | float | complex | np.number | np.ndarray):
        raise BadInput(f"an array of entries that are not numbers ({type(value).__name__}) is not known here")
