"""Values of the terms of a proposition: numbers, exact expressions, matrices, lists, texts, and records of these."""

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
"""Number of entries of a list that are shown."""


class Undecided(Exception):
    """A measurement has no answer; the message contains the reason."""


@contextmanager
def undecided_if_refused() -> Iterator[None]:
    """Turn refusals within the context into undecided answers, except those for too much work."""
    try:
        yield
    except OverBudget:
        raise
    except BadInput as error:
        raise Undecided(str(error)) from None


@dataclass(frozen=True, eq=False)
class Record:
    """Named values that belong together, such as a state, a trajectory, or a member of a family."""

    name: str
    """Name of the record in answers."""
    parts: Mapping[str, Any] = field(default_factory=dict)
    """Values by name; a proposition accesses them as ``record.name``."""

    def part(self, name: str) -> Any:
        """Return one of the values of the record.

        Raises
        ------
        BadInput
            If the record has no value of this name.
        """
        refuse_unknown(f"{self.name} has no", name, self.parts)
        return self.parts[name]


@dataclass(frozen=True, eq=False)
class Family:
    """A family of systems, motions etc., from textbooks and at random, over which a claim quantifies."""

    name: str
    of: str
    """Name of the family in propositions, and the plural noun for its members."""
    members: tuple[Record, ...]

    def __iter__(self) -> Iterator[Record]:
        return iter(self.members)

    def __len__(self) -> int:
        return len(self.members)


def is_exact(value: Any) -> bool:
    """Return whether a value is a SymPy expression or matrix."""
    return type(value).__module__.startswith("sympy.")


def is_number(value: Any) -> bool:
    """Return whether a value is a number, exact or not."""
    if isinstance(value, bool | np.bool_ | str):
        return False
    return isinstance(value, int | float | complex | np.number) or (is_exact(value) and bool(value.is_number))


@lru_cache(maxsize=4096)
def measured(of: Any) -> Any:
    """Return an exact number or matrix as an array of numbers."""
    if of.free_symbols:
        raise BadInput(f"{of} contains symbols, but must consist of numbers")
    found = np.array(of.tolist() if getattr(of, "is_Matrix", False) else of, dtype=complex)
    found = found if np.imag(found).any() else np.real(found)
    found.flags.writeable = False
    return found


def numbers(of: Any) -> Array:
    """Return a matrix as an array of numbers, with all letters set to 1."""
    return _numbers(of) if is_exact(of) else np.asarray(of, dtype=float)


@lru_cache(maxsize=4096)
def _numbers(of: Any) -> Array:
    return np.asarray(measured(of.subs(dict.fromkeys(of.free_symbols, 1)))).reshape(of.shape)


def alike(left: Any, right: Any) -> tuple[Any, Any]:
    """Return two values in compatible forms: an exact value next to an array becomes an array."""
    for one, other in ((left, right), (right, left)):
        if isinstance(one, np.ndarray) and is_exact(other):
            plain = measured(other)[()]
            return (left, plain) if one is left else (plain, right)
    return left, right


def in_words(value: Any) -> str:
    """Return a short text for a value."""
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


def listed(value: Any, last: str, *, numbers: bool = False) -> str:
    """Return a short text for a value; names or formulas in a list are enumerated, each between backquotes.

    With ``numbers``, numbers in a list are enumerated as well; otherwise such a list is shown as a vector.
    """
    kind = (str, int, float) if numbers else str
    if not (isinstance(value, list) and value and all(isinstance(entry, kind) for entry in value)):
        return in_words(value)
    *first, end = [f"`{entry}`" if isinstance(entry, str) else in_words(entry) for entry in value]
    if len(value) > _LISTED:
        return ", ".join([*first[:_LISTED], "..."])
    return f"{', '.join(first)}{last}{end}" if first else end
