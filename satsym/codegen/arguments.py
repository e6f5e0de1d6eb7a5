"""Places at which generated functions are looked at: random ones, and those whose bounds hold nothing or all."""

from __future__ import annotations

import random
from collections.abc import Iterator
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp

from satsym.codegen.functions import ARGUMENTS, Function, Symbols
from satsym.spec import ProblemSpec
from satsym.symbolic.checks import random_number

FAR = 1e9
"""How many times as large, or as small, as at random what regularises is; bounds are so by the square of it."""

Arguments = dict[str, Any]
"""By the names of arguments."""


def symbols_at(function: Function, known: Symbols, place: Arguments) -> dict[sp.Symbol, Any]:
    """What the symbols of a function's arguments stand for."""
    pairs = ((s, v) for a in function.arguments for s, v in zip(known.of(a), np.atleast_1d(place[a]), strict=True))
    return {s: mp.mpf(float(v)) for s, v in pairs}


def drawn(known: Symbols, spec: ProblemSpec, rng: random.Random) -> Arguments:
    """Random arguments; bounds that are met by some controls and not by others."""

    def draw(symbol: Any) -> float:
        return random_number(symbol, rng)

    place: Arguments = {a: tuple(map(draw, known.of(a))) for a in ARGUMENTS if a != "t"}
    bounds = [-abs(b) if i in spec.lower_bounds else abs(b) for i, b in enumerate(place["bounds"])]
    for ring in spec.rings:
        bounds[ring[0]], bounds[ring[1]] = sorted(bounds[i] for i in ring)
    place["bounds"] = tuple(bounds)
    return place | {"t": draw(known.t)}


def limiting(spec: ProblemSpec, function: Function, place: Arguments) -> Iterator[Arguments]:
    """For what has bounds, the place with such that hold no control, and with such that hold all; for laws no costates.

    What only the one or the other side of a law has would not be seen elsewhere: at bounds of size one laws may always
    be far below them, and costates never vanish. Where they do, what is made of laws may have no derivative.
    """
    if "bounds" not in function.arguments:
        return
    bounds, inner = place["bounds"], {low for low, _ in spec.rings}
    regular = range(len(bounds) - spec.regularising, len(bounds))
    for outer, least, smoothed in [(2, -2, -1), (-2, -2, -1), *([(2, 2, 1)] if inner or regular else [])]:
        powers = [least if i in inner else smoothed if i in regular else outer for i in range(len(bounds))]
        yield {**place, "bounds": tuple(b * FAR**power for b, power in zip(bounds, powers, strict=True))}
    if function.name == "control_law":
        yield {**place, "lam": (0.0,) * len(place["lam"])}
