"""From starts through regularised paths to what these lead to, each path once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import TypeVar

from satsym.solvers.constrained.regularised.easing import tightened
from satsym.solvers.constrained.regularised.interior_point import Path, regularised
from satsym.solvers.constrained.regularised.transcription import Point, Program
from satsym.solvers.failures import tried
from satsym.solvers.iteration import Limits, Meter

Found = TypeVar("Found")

SAME = 1e-6
"""Relative difference of costs of regularised paths that are one."""


def searched(
    program: Program,
    starts: Sequence[Point],
    worth: float,
    limits: Limits,
    exact: Callable[[Path, Limits], Found],
    eased: Point | None = None,
) -> Iterator[Found | None]:
    """To what each start leads; what leads to the same regularised path leads to the same extremal. Ends with time.

    Parameters
    ----------
    worth
        The size of costs.
    limits
        Each start may do the work that they allow.
    exact
        What a regularised path, solved or not, leads to within limits.
    eased
        The start from which constraints are eased where they are too far from holding.

    Yields
    ------
    Found or None
        ``None`` where numbers fail.
    """
    known: list[tuple[float, Found | None]] = []

    def led(start: Point) -> Found | None:
        own = replace(limits, meter=Meter())
        path = regularised(program, start, worth, own)
        if start is eased and not path.solved:
            path = tightened(program, start, worth, own)
        if not path.solved:
            return exact(path, own)
        for cost, one in known:
            if abs(path.cost - cost) <= SAME * abs(cost):
                return one
        found = tried(partial(exact, path, own))
        known.append((path.cost, found))
        return found

    for start in starts:
        yield tried(partial(led, start))
        if limits.late:
            return
