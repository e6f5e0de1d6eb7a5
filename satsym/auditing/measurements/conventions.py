"""What sentences leave open, stated once: how near is "returns", how late is "in the end", how often is "swings"."""

from __future__ import annotations

from satsym.auditing.measurements import value


@value
def near() -> float:
    """A state is back, or stays, where it is no farther from its aim than this (relative where the aim exceeds 1)."""
    return 0.05


@value
def often() -> int:
    """A curve goes up and down where it turns at least so often."""
    return 2
