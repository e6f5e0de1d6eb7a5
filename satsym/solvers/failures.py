"""Numerical failures that end a single attempt, but not the whole computation."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from satsym.solvers.simulation.extrapolation import NotFinite

Found = TypeVar("Found")

FAILURES = (NotFinite, ArithmeticError, ValueError)
"""Errors of values that are not finite, of scalars outside the domain of a function (``math`` raises ValueError for
these), and of singular matrices (a ValueError too)."""


def tried(step: Callable[[], Found]) -> Found | None:
    """Return the result of a step, or ``None`` if it fails numerically."""
    try:
        return step()
    except FAILURES:
        return None
