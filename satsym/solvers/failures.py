"""What may become of numbers on the way to a solution, and that it ends one attempt only."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from satsym.solvers.simulation.extrapolation import NotFinite

Found = TypeVar("Found")

FAILURES = (NotFinite, ArithmeticError, ValueError)
"""Numbers that are not finite, scalars beyond the domain of a function (``math`` raises ValueError for these), matrices
that have no inverse (a ValueError too)."""


def tried(step: Callable[[], Found]) -> Found | None:
    """What comes of a step; ``None`` where its numbers fail."""
    try:
        return step()
    except FAILURES:
        return None
