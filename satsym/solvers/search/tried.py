"""Results of starts of the direct search as competitors of an answer, kept for the next, cheaper answer."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from satsym.arrays import Array
from satsym.instance import Instance
from satsym.solvers.iteration import Meter
from satsym.solvers.search.starts.planning import Plan

Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Tried(Generic[Answer]):
    """Result of a start of the direct search, as a competitor of an answer.

    Attributes
    ----------
    plan
        Plan of the start.
    cost
        Cost of the motion, or of the answer if both seem to be the same. NaN if the start was not solved, or if neither
        an extremal nor finer meshes confirm that its motion is cheaper.
    exact
        The extremal if it costs less than the answer, otherwise ``None``.
    unsettled
        Whether the motion seems to cost less, although its cost does not converge on finer meshes.
    """

    plan: Plan
    cost: float
    exact: Answer | None = None
    unsettled: bool = False


@dataclass
class Past:
    """Results of comparisons with earlier answers of a higher cost: the next comparison goes on where they ended.

    Attributes
    ----------
    answers
        Number of these answers.
    first
        Times and states of the first of these answers, which grade the coarse mesh.
    begun
        Number of starts in the list that were tried or left out.
    tried
        Results of the starts, in their order.
    seen
        Pairs of the cost on the coarse mesh and the final cost of each motion.
    asked
        The problem as it was stated, if that of the answers lacks a final state that follows from the others: their
        competitors have to reach it. ``None`` if both are the same.
    moving
        Meter of the work for meshes that follow motions which seem cheaper.
    """

    answers: int = 0
    first: tuple[Array, Array] | None = None
    begun: int = 0
    tried: list[Tried[Any]] = field(default_factory=list)
    seen: list[tuple[float, float]] = field(default_factory=list)
    asked: Instance | None = None
    moving: Meter = field(default_factory=Meter)
