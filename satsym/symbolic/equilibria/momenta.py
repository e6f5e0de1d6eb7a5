"""Equilibria of a body in orbit of which only the attitude moves: all of them, and followed over a parameter."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import sympy as sp

from satsym.arrays import Array
from satsym.symbolic.derivation import Derivation, DerivationError
from satsym.symbolic.equilibria.attitude import (
    Continuum,
    Equilibrium,
    Kind,
    all_of,
    classified,
    completed,
    continuum,
    orthonormal,
)
from satsym.symbolic.equilibria.real_roots import family
from satsym.symbolic.equilibria.rest import Rest

SAMPLES = 60
WIDTH = 1e-6
"""Width of the interval to which a change is located, relative to the largest value of the parameter."""


@dataclass(frozen=True)
class Change:
    """An interval of the parameter in which the number or the stability of equilibria changes.

    Attributes
    ----------
    below, above
        Its ends.
    counts
        Exact numbers of equilibria at both.
    kinds
        At both, how many of each kind.
    """

    below: float
    above: float
    counts: tuple[int, int]
    kinds: tuple[Mapping[Kind, int], Mapping[Kind, int]]


@dataclass(frozen=True, eq=False)
class Followed:
    """Equilibria at samples of the parameter, and the intervals in which their number or stability changes."""

    values: Array
    equilibria: tuple[tuple[Equilibrium, ...], ...]
    changes: tuple[Change, ...]


def follow(rest: Rest, numbers: Mapping[sp.Symbol, sp.Rational], beyond: float) -> Followed | None:
    """Follow all equilibria as the varied parameter grows from 0; ``None`` where they are never finitely many.

    The parameter grows to `beyond` times the value at which its torque exceeds every other torque. Changes that undo
    each other between two samples are not detected.
    """
    varied = rest.varied
    assert varied is not None

    def at(value: float) -> Rest:
        return rest.at({**numbers, varied: sp.Rational(repr(value))})

    search = _search(rest.at({s: v for s, v in numbers.items() if s != varied}), varied)
    if search is None:
        return None
    top = beyond * _outweighing(rest, numbers)
    values = np.linspace(0.0, top, SAMPLES + 1)
    values += top / SAMPLES / np.sqrt(50.0)  # off the round numbers at which something may change
    found = [search(float(v)) for v in values]
    changes = []
    for (low, before), (high, after) in pairwise(zip(values.tolist(), found, strict=True)):
        changes += _joined(_bracketed(search, low, before, high, after, WIDTH * top))
    return Followed(values, tuple(found), tuple(_counted(at, change) for change in changes))


def _outweighing(rest: Rest, numbers: Mapping[sp.Symbol, sp.Rational]) -> float:
    """Return the value of the parameter at which its torque is as large as the largest of the others."""
    assert rest.varied is not None
    without, alone = [], []
    for equation in rest.at(numbers).equations:
        for coefficient in sp.Poly(equation, *rest.cosines).coeffs():
            without.append(abs(coefficient.xreplace({rest.varied: sp.Integer(0)})))
            alone.append(abs(sp.diff(coefficient, rest.varied)))
    return float(max(without) / max(alone))


def _joined(brackets: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Join adjacent intervals: a sample fell into the middle of one change."""
    found: list[tuple[float, float]] = []
    for low, high in brackets:
        found[-1:] = [(found[-1][0], high)] if found and found[-1][1] == low else [*found[-1:], (low, high)]
    return found


def _kinds(found: tuple[Equilibrium, ...]) -> Mapping[Kind, int]:
    return dict(sorted(Counter(e.kind for e in found).items(), key=lambda pair: pair[0].value))


def _bracketed(
    search: Any, low: float, before: Any, high: float, after: Any, width: float
) -> list[tuple[float, float]]:
    """Bisect between two values of the parameter, and return the intervals in which something changes."""
    if _kinds(before) == _kinds(after):
        return []
    if high - low <= width:
        return [(low, high)]
    middle = (low + high) / 2
    between = search(middle)
    return [
        *_bracketed(search, low, before, middle, between, width),
        *_bracketed(search, middle, between, high, after, width),
    ]


def _counted(at: Callable[[float], Rest], bracket: tuple[float, float]) -> Change:
    """Return an interval with the exact counts of equilibria at both ends."""
    ends = [all_of(at(float(f"{value:.9g}"))) for value in bracket]
    counts = tuple(found.real if found.real is not None else -1 for found, _ in ends)
    kinds = tuple(_kinds(equilibria) for _, equilibria in ends)
    return Change(*bracket, (counts[0], counts[1]), (kinds[0], kinds[1]))


def _search(rest: Rest, varied: sp.Symbol) -> Callable[[float], tuple[Equilibrium, ...]] | None:
    """Find all equilibria in floats at one value of the parameter."""
    unknowns = [s for k in rest.axes for s in rest.cosines.row(k)]
    solutions = family([*rest.equations, *orthonormal(rest)], unknowns, varied)
    if solutions is None:
        return None

    def search(value: float) -> tuple[Equilibrium, ...]:
        return tuple(classified(rest, completed(rest, point), value) for point in solutions(value))

    return search


REACH_FACTOR = 2.0
"""Largest value of the parameter, as a multiple of the value at which its torque exceeds all other torques."""


@dataclass(frozen=True, eq=False)
class Attitudes:
    """All equilibria of a body in orbit of which only the attitude moves.

    Attributes
    ----------
    parameter
        The name of that over which they are followed.
    count, complex
        Exact numbers of real and of complex ones, where they are finitely many.
    equilibria
        All of them, or one of each circle.
    continuum
        Where they are not finitely many.
    followed
        Over the parameter; ``None`` where they are not finitely many at any value.
    """

    parameter: str
    count: int | None
    complex: int | None
    equilibria: tuple[Equilibrium, ...]
    continuum: Continuum | None
    followed: Followed | None


def survey(derivation: Derivation, numbers: Mapping[str, float]) -> Attitudes:
    """Find and follow all equilibria of an attitude, with the parameters at the decimal numbers given.

    Raises
    ------
    DerivationError
        If the derivation is not that of one attitude in orbit.
    """
    rest = derivation.model.rest(derivation)
    if rest is None or rest.varied is None:
        raise DerivationError(
            f"{derivation.name}: only equilibria of a single attitude in a circular orbit are supported"
        )
    letters = (rest.inertia.free_symbols | rest.torque.free_symbols) - {*rest.cosines, *rest.turns}
    known = {s: sp.Rational(repr(numbers[s.name])) for s in letters | {rest.varied}}
    here = rest.at(known)
    found, equilibria = all_of(here)
    whole = continuum(here, found.dimension) if found.dimension > 0 else None
    return Attitudes(
        parameter=rest.varied.name,
        count=found.real,
        complex=found.complex,
        equilibria=(whole.circles or ()) if whole else equilibria,
        continuum=whole,
        followed=follow(rest, {s: v for s, v in known.items() if s != rest.varied}, REACH_FACTOR),
    )
