"""Arguments on both sides of the thresholds of a generated function, where its value or derivative jumps.

A slightly wrong threshold changes the outcome of a condition only in a thin layer: at random arguments it shows only by
chance, but it always shows right beside the threshold itself.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import mpmath as mp
import numpy as np

from satsym.kernels.core import Function as GeneratedFunction
from satsym.kernels.many_digits import NO_NUMBERS, exactly

MOVED_ARGUMENTS = ("lam", "bounds", "x")
"""Arguments of which one number is changed to reach a threshold: first costates, which decide on controls."""
MOST_STEPS, TRUSTED_STEPS = 12, 4
"""Most steps of the secant method, since conditions of laws are polynomials of low degree in one number; and the steps
after which a difference must have decreased."""
FIRST_STEP = 1e-3
"""First step of the secant method, relative to the number that is moved."""
TOLERANCE = 1e-40
"""Relative distance from a threshold at which it counts as found."""
DISTANCE = 1e-20
"""Distance of the arguments on both sides from the threshold, relative to the changed number."""

Place = dict[str, Any]


def beside_thresholds(
    watched: tuple[GeneratedFunction, dict[int, Any]],
    arguments: Sequence[str],
    out: tuple[int, ...] | None,
    places: Iterable[Place],
    digits: int,
) -> Iterator[Place]:
    """Find pairs of places between which one condition in the text of a function changes.

    Parameters
    ----------
    watched
        The function, and what it notes of its conditions (:func:`satsym.kernels.many_digits.watched`).
    arguments
        Their names, in the function's order.
    out
        Shape of the array that the function fills; ``None`` for a function on numbers.
    places
        Where the search begins, as arguments by name.
    digits
        Precision of the search.
    """
    search = _Search(*watched, arguments, out)
    found: set[tuple[int, str]] = set()
    with mp.workdps(digits):
        for place in places:
            begin = {**place, **{a: exactly(place[a]) for a in arguments}}
            first = search.conditions(begin)
            for argument in (a for a in MOVED_ARGUMENTS if a in arguments):
                for component in range(len(begin[argument])):
                    missing = [c for c in first if (c, argument) not in found]
                    for condition, pair in search.pairs(begin, first, (argument, component), missing):
                        found.add((condition, argument))
                        yield from pair


@dataclass(frozen=True)
class _Search:
    """The search for thresholds of a function's conditions."""

    function: GeneratedFunction
    seen: dict[int, Any]
    arguments: Sequence[str]
    out: tuple[int, ...] | None

    def conditions(self, place: Place) -> dict[int, Any]:
        """Return the differences of both sides of all evaluated conditions, where real; arguments are of mpmath."""
        self.seen.clear()
        with suppress(*NO_NUMBERS):
            self.function(
                *(place[a] for a in self.arguments), *(() if self.out is None else (np.empty(self.out, dtype=object),))
            )
        return {condition: gap for condition, gap in self.seen.items() if not isinstance(gap, mp.mpc)}

    def pairs(
        self, begin: Place, first: Mapping[int, Any], moved: tuple[str, int], wanted: Iterable[int]
    ) -> Iterator[tuple[int, list[Place]]]:
        """Return conditions with arguments on both sides of their thresholds, reached by changing one number."""
        number = begin[moved[0]][moved[1]]
        other = number * (1 + mp.mpf(FIRST_STEP))
        second = self.conditions(_moved(begin, *moved, other))
        for condition in wanted:
            ends = (number, first[condition]), (other, second.get(condition, mp.nan))
            there = _root(partial(self._difference, begin, moved, condition), *ends)
            if there is None:
                continue
            aside = DISTANCE * (abs(there) if abs(there) > TOLERANCE * abs(number) else abs(number))
            pair = [_moved(begin, *moved, there + side * aside) for side in (-1, 1)]
            low, high = (self.conditions(place).get(condition, mp.nan) for place in pair)
            if low * high < 0:
                yield condition, pair

    def _difference(self, begin: Place, moved: tuple[str, int], condition: int, to: Any) -> Any:
        return self.conditions(_moved(begin, *moved, to)).get(condition, mp.nan)


def _root(value: Callable[[Any], Any], one: tuple[Any, Any], other: tuple[Any, Any]) -> Any:
    """Find a root of a function of one number by the secant method; ``None`` where that fails."""
    (a, f), (b, g) = one, other
    scale, begin = abs(a), abs(f)
    for step in range(MOST_STEPS):
        if g == 0:
            return b
        if not mp.isfinite(g) or not mp.isfinite(f) or g == f or (step >= TRUSTED_STEPS and abs(g) >= begin):
            return None
        a, f, b = b, g, b - g * (b - a) / (g - f)
        if abs(b - a) <= TOLERANCE * max(scale, abs(b)):
            return b
        g = value(b)
    return None


def _moved(place: Place, argument: str, component: int, to: Any) -> Place:
    """Return arguments with one component of one argument changed."""
    values = place[argument]
    return {**place, argument: tuple(to if i == component else v for i, v in enumerate(values))}
