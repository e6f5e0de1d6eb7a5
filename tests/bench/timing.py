"""Timing that survives a busy machine: variants take turns, and ratios are formed pair by pair.

What runs in this process is timed by the processor time it takes, which other programs disturb less than the clock on
the wall. They still do: a shared cache and a changing clock rate remain, hence the turns.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import ceil
from statistics import median
from time import process_time

Action = Callable[[], object]


@dataclass(frozen=True)
class Samples:
    """Seconds a call took, one sample a round."""

    seconds: tuple[float, ...]

    @property
    def least(self) -> float:
        """The fastest round: what other programs disturbed least."""
        return min(self.seconds)

    @property
    def middle(self) -> float:
        """The median round."""
        return median(self.seconds)

    def times(self, other: Samples) -> float:
        """How many times as long as ``other``: the median over rounds, in which both ran shortly after one another."""
        return median(a / b for a, b in zip(self.seconds, other.seconds, strict=True))


def interleaved(
    variants: Mapping[str, Action], rounds: int, least: float = 0.01, clock: Callable[[], float] = process_time
) -> dict[str, Samples]:
    """Time every variant once a round, in turns: A B C A B C ...

    Parameters
    ----------
    variants
        Name -> what to call.
    rounds
        Number of samples each.
    least
        Seconds a sample should last: a shorter call is repeated within its sample, and called twice beforehand to
        see how often. With 0 nothing is repeated, nor called beforehand.
    clock
        Seconds since some moment: processor time, or ``perf_counter`` for what runs in other processes.
    """
    repeats = dict.fromkeys(variants, 1)
    for name, action in variants.items() if least > 0.0 else ():
        action()
        repeats[name] = max(1, ceil(least / max(_once(action, 1, clock), 1e-9)))
    found: dict[str, list[float]] = {name: [] for name in variants}
    for _ in range(rounds):
        for name, action in variants.items():
            found[name].append(_once(action, repeats[name], clock))
    return {name: Samples(tuple(seconds)) for name, seconds in found.items()}


def _once(action: Action, repeats: int, clock: Callable[[], float]) -> float:
    start = clock()
    for _ in range(repeats):
        action()
    return (clock() - start) / repeats
