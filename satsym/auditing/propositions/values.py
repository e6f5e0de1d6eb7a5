"""What the terms of a proposition are: numbers, exact expressions, matrices, lists, texts, and records of these."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.auditing.quantities import Quantity
from satsym.formula.budget import OverBudget
from satsym.status import BadInput
from satsym.wording import refuse_unknown

_LISTED = 6
"""Entries of a list that are shown."""


class Undecided(Exception):
    """A measurement that has no answer; the reason is said."""


@contextmanager
def undecided_if_refused() -> Iterator[None]:
    """What is refused within has no answer, unless it is refused for taking too much."""
    try:
        yield
    except OverBudget:
        raise
    except BadInput as error:
        raise Undecided(str(error)) from None


@dataclass(frozen=True, eq=False)
class Record:
    """Named values that belong together: the state at an end, a trajectory, a member of a family."""

    name: str
    """How it is called where it confirms or refutes."""
    parts: Mapping[str, Any] = field(default_factory=dict)
    """Its values by name; a proposition writes ``record.name``."""

    def part(self, name: str) -> Any:
        """One of its values."""
        refuse_unknown(f"{self.name} has no", name, self.parts)
        return self.parts[name]


@dataclass(frozen=True, eq=False)
class Family:
    """Members of a kind, some from textbooks and some at random, over which a claim quantifies."""

    name: str
    of: str
    """As the language has it, and what its members are, in the plural."""
    members: tuple[Record, ...]

    def __iter__(self) -> Iterator[Record]:
        return iter(self.members)

    def __len__(self) -> int:
        return len(self.members)


def is_exact(value: Any) -> bool:
    """Whether a value is an expression or a matrix of sympy's."""
    return type(value).__module__.startswith("sympy.")


def is_number(value: Any) -> bool:
    """Whether a value is a plain number, exact or not."""
    if isinstance(value, bool | np.bool_ | str):
        return False
    return isinstance(value, int | float | complex | np.number) or (is_exact(value) and bool(value.is_number))


@lru_cache(maxsize=4096)
def measured(of: Any) -> Any:
    """An exact number or matrix as an array of plain numbers."""
    if of.free_symbols:
        raise BadInput(f"{of} contains symbols, but must consist of numbers")
    found = np.array(of.tolist() if getattr(of, "is_Matrix", False) else of, dtype=complex)
    found = found if np.imag(found).any() else np.real(found)
    found.flags.writeable = False
    return found


def numbers(of: Any) -> Array:
    """A matrix with numbers, its letters taken as 1."""
    return _numbers(of) if is_exact(of) else np.asarray(of, dtype=float)


@lru_cache(maxsize=4096)
def _numbers(of: Any) -> Array:
    return np.asarray(measured(of.subs(dict.fromkeys(of.free_symbols, 1)))).reshape(of.shape)


def alike(left: Any, right: Any) -> tuple[Any, Any]:
    """Two values that can be calculated with together: an exact one beside measured ones becomes a measured one."""
    for one, other in ((left, right), (right, left)):
        if isinstance(one, np.ndarray) and is_exact(other):
            plain = measured(other)[()]
            return (left, plain) if one is left else (plain, right)
    return left, right


def in_words(value: Any) -> str:
    """A value as a person would write it, in a few characters."""
    if isinstance(value, bool | np.bool_):
        return str(bool(value)).lower()
    if isinstance(value, Record):
        return value.name
    if isinstance(value, Quantity):
        return str(value)
    if isinstance(value, complex | np.complexfloating):
        return f"{value.real:.6g}{value.imag:+.6g}i" if value.imag else f"{value.real:.6g}"
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    if isinstance(value, np.ndarray):
        return in_words(value.tolist()) if value.size <= _LISTED**2 else f"{value.size} numbers"
    if is_exact(value) and getattr(value, "is_Matrix", False):
        return in_words(value.tolist())
    if isinstance(value, list | tuple):
        inside = [in_words(entry) for entry in value[:_LISTED]]
        return f"[{', '.join(inside)}{', ...' if len(value) > _LISTED else ''}]"
    return str(value)
