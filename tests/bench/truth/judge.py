"""Two answers to one instance, and what follows for satsym's."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

from tests.bench.truth.answer import Answer, Truth

CHEAPER = 1e-5
"""Relative difference of costs that counts."""
NOTHING = 1e-7
"""Costs below that are none."""
SHORTEST = 1.001e-3
"""Durations at which a program with a free one ends because it has a bound there: shorter ones may cost less still."""
MISSED, OFF_COST, OUT = 1e-3, 1e-2, 1e-6
"""What a coarse simulation of satsym's control may miss, and by how much it may leave its bounds."""


class Outcome(str, Enum):
    """What came of an instance."""

    AGREED = "agreed"
    OURS = "ours cheaper"
    THEIRS = "theirs cheaper"
    NONE = "no solution"
    UNJUDGED = "unjudged"
    """The independent side found nothing."""


class Wrong(str, Enum):
    """Words of satsym's that are not true."""

    CERTIFIED = "certified, though there is a cheaper control"
    UNCOMPARED = "certified without seeded starts, though there is a cheaper control"
    INFEASIBLE = "infeasible, though a control arrives"
    NO_MINIMISER = "no minimiser, though there is one"
    ARRIVED = "converged, though nothing can arrive"
    VIOLATED = "converged, though its control does not do what it says"
    BELOW = "converged below the least cost"


@dataclass(frozen=True)
class Judgement:
    """What came of an instance, and what is wrong about it.

    Attributes
    ----------
    outcome
        By costs and statuses.
    wrong
        ``None`` where every word is true.
    excess
        Relative cost above the independent one; ``None`` without two costs.
    """

    outcome: Outcome
    wrong: Wrong | None = None
    excess: float | None = None


def judged(truth: Answer, ours: dict[str, Any]) -> Judgement:
    """Compare both."""
    status = ours["status"]
    if status == "converged":
        return _converged(truth, ours)
    if truth.truth is Truth.UNKNOWN:
        return Judgement(Outcome.UNJUDGED)
    if status == "infeasible":
        if truth.truth is Truth.INFEASIBLE:
            return Judgement(Outcome.AGREED)
        return Judgement(Outcome.NONE, Wrong.INFEASIBLE)
    if status == "no minimiser":
        if truth.truth is Truth.UNBOUNDED:
            return Judgement(Outcome.AGREED)
        if truth.duration is not None and truth.duration <= SHORTEST:
            return Judgement(Outcome.UNJUDGED)
        return Judgement(Outcome.NONE, Wrong.NO_MINIMISER)
    return Judgement(Outcome.NONE)


def _converged(truth: Answer, ours: dict[str, Any]) -> Judgement:
    word = None
    if ours.get("verdict") == "certified":
        compared = any(kind.startswith("seeded starts") for kind in ours.get("kinds", ()))
        word = Wrong.CERTIFIED if compared else Wrong.UNCOMPARED
    kept = ours["missed"] <= MISSED and ours["off cost"] <= OFF_COST and ours["out"] <= OUT  # NaN is not
    if not kept:
        return Judgement(Outcome.NONE, Wrong.VIOLATED)
    if truth.truth is Truth.UNKNOWN:
        return Judgement(Outcome.UNJUDGED)
    if truth.truth is Truth.INFEASIBLE:
        return Judgement(Outcome.NONE, Wrong.ARRIVED)
    if truth.truth is Truth.UNBOUNDED:
        return Judgement(Outcome.THEIRS, word)
    assert truth.cost is not None
    scale = max(abs(truth.cost), abs(ours["cost"]), NOTHING)
    excess = (ours["cost"] - truth.cost) / scale
    if excess > CHEAPER:
        return Judgement(Outcome.THEIRS, word, excess)
    if excess < -CHEAPER:
        return Judgement(Outcome.OURS, Wrong.BELOW if truth.truth is Truth.MINIMUM else None, excess)
    return Judgement(Outcome.AGREED, None, excess)
