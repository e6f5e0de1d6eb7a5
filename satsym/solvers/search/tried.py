"""What starts of a search came to beside an answer, and what is remembered of them beside the next, cheaper one."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar

from satsym.arrays import Array
from satsym.solvers.search.starts import Plan

Answer = TypeVar("Answer")


@dataclass(frozen=True)
class Tried(Generic[Answer]):
    """What a start came to beside an answer.

    Attributes
    ----------
    plan
        How it began.
    cost
        That of the answer where both seem to be one. NaN where the start was not solved, and where neither an extremal
        nor finer meshes confirm that its motion is cheaper.
    exact
        The extremal, if it costs less than the answer.
    unsettled
        Whether its motion seems to cost less, but no mesh settles that.
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
        Times and states of the first of them, along which the coarse mesh is laid.
    tried
        What starts came to, in their order.
    seen
        Costs on the coarse mesh, and what each came to.
    """

    answers: int = 0
    first: tuple[Array, Array] | None = None
    tried: list[Tried[Any]] = field(default_factory=list)
    seen: list[tuple[float, float]] = field(default_factory=list)
