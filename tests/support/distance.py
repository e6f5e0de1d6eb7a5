"""How far numbers of mpmath are apart."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any


def deviation(found: Iterable[Any], expected: Iterable[Any]) -> Any:
    """The largest difference, relative to the size of the number and of the largest one."""
    pairs = list(zip(found, expected, strict=True))
    largest = max((abs(b) for _, b in pairs), default=0)
    return max((abs(a - b) / (largest + abs(b)) for a, b in pairs if a != b), default=0)
