"""Arcs in words: when controls switch, saturate, burn and coast."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from satsym.arrays import Array
from satsym.report.said import message, say
from satsym.report.terminal.table import figure
from satsym.solution import Solution

SHOWN_TIMES = 6
"""Largest number of switching times, or arcs, of one control that are listed."""
SHOWN_ARCS = 9
"""Largest number of arcs of a structure that is expressed in words; longer structures keep the signs of the message."""
_AT_BOUND = 1e-9
_SIGNS = {"+": "upper bound", "-": "lower bound", "0": "zero", "s": "singular", "b": "boundary"}
_THRUST = {"+": "burn", "-": "coast", "0": "coast", "s": "singular"}
_FOUND = re.compile(r"residual (\S+), from (.+)")
_STRUCTURE = re.compile(r"structure ([-+0sb]+(?: \| [-+0sb]+)*), (?:\d+ switch(?:es)?, )?")


def rows_of_arcs(solution: Solution, unit: str) -> list[tuple[str, str, str]]:
    """Return, for each control or group of controls, a description, their names, and the times."""
    return [_row(solution, controls, times, unit) for controls, times in switching_together(solution)]


def switching_together(solution: Solution) -> list[tuple[str, tuple[float, ...]]]:
    """Return switching times, each with all controls that share them, as those of a vector do."""
    found: dict[tuple[float, ...], list[str]] = {}
    for control, times in zip(solution.instance.model.spec.control_names, solution.switching_times, strict=True):
        if times:
            found.setdefault(tuple(times), []).append(control)
    return [(", ".join(controls), times) for times, controls in found.items()]


def in_words(solution: Solution, text: str) -> str:
    """Translate a solver's message, with the structure ``-+-`` of arcs in words, control by control."""
    found, names = _STRUCTURE.match(text), solution.instance.model.spec.control_names
    each = found[1].split(" | ") if found else []
    if not found or len("".join(each)) > SHOWN_ARCS or (len(each) > 1 and len(each) != len(names)):
        return message(text)
    signs = _THRUST if _throttled(solution) else _SIGNS
    listed = [", ".join(say(signs.get(sign, _SIGNS[sign])) for sign in one) for one in each]
    arcs = listed[0] if len(each) == 1 else "; ".join(map(" ".join, zip(names, listed, strict=True)))
    rest = text[found.end() :]
    if ends := _FOUND.fullmatch(rest):
        rest = say("residual <residual>, starting from <origin>", residual=ends[1], origin=message(ends[2]))
    else:
        rest = message(rest)
    return say("arcs: <arcs>; <rest>", arcs=arcs, rest=rest) if rest else say("arcs: <arcs>", arcs=arcs)


def at_bound(row: Array, limits: tuple[float, float]) -> Array:
    """Tell where a control, or a norm, is at one of its finite bounds."""
    finite = [bound for bound in limits if np.isfinite(bound)]
    near = [np.abs(row - bound) <= _AT_BOUND * max(1.0, abs(bound)) for bound in finite]
    return np.logical_or.reduce(near) if near else np.zeros(len(row), bool)


def _row(solution: Solution, controls: str, times: Sequence[float], unit: str) -> tuple[str, str, str]:
    names = controls.split(", ")
    if thrust := _burns(solution, names, times, unit):
        return say("thrust arcs:"), controls, thrust
    spans, *others = (_saturated(solution, name, times) for name in names)
    if spans and all(other == spans for other in others):
        return say("saturated:"), controls, _listed([_span(*span) for span in spans], unit)
    listed = say("at <times>", times=_listed([figure(t) for t in times], unit))
    return say("switching times:"), controls, listed


def _burns(solution: Solution, names: Sequence[str], times: Sequence[float], unit: str) -> str:
    """Return arcs of full and of zero thrust; empty unless the controls are a vector whose norm switches."""
    all_names = solution.instance.model.spec.control_names
    for bound in solution.instance.bounded_norms:
        if bound.lower == 0.0 and [all_names[k] for k in bound.places] == list(names):
            norm = np.sqrt((solution.u[list(bound.places)] ** 2).sum(axis=0))
            found = []
            for begin, end, value in _arcs(solution, norm, times):
                full, none = abs(value - bound.upper) <= 1e-6 * bound.upper, value <= 1e-6 * bound.upper
                if not (full or none):
                    return ""
                text = "burn from <low> to <high>" if full else "coast from <low> to <high>"
                found.append(say(text, low=figure(begin), high=figure(end)))
            return _listed(found, unit)
    return ""


def _saturated(solution: Solution, name: str, times: Sequence[float]) -> list[tuple[float, float]]:
    """Return arcs on which a continuous control is at a bound; none for a control that jumps."""
    place = solution.instance.model.spec.control_names.index(name)
    row, limits = solution.u[place], (solution.instance.lower[place], solution.instance.upper[place])
    if solution.method == "bang-bang" or _jumps(solution.times, row):
        return []
    held = at_bound(row, limits).astype(float)
    return [(begin, end) for begin, end, share in _arcs(solution, held, times) if share > 0.5]


def _jumps(times: Array, row: Array) -> bool:
    twice = np.flatnonzero(np.diff(times) == 0.0)
    return bool(len(twice)) and bool(np.any(np.abs(row[twice + 1] - row[twice]) > 1e-6 * np.abs(row).max(initial=0.0)))


def _arcs(solution: Solution, row: Array, times: Sequence[float]) -> Iterator[tuple[float, float, float]]:
    """Return beginning and end of each arc, with the value at the node nearest to its middle."""
    if not len(solution.times):
        return
    ends = [float(solution.times[0]), *sorted(times), float(solution.times[-1])]
    for begin, end in pairwise(ends):
        if end > begin:
            yield begin, end, float(row[np.abs(solution.times - (begin + end) / 2.0).argmin()])


def _span(begin: float, end: float) -> str:
    return say("from <low> to <high>", low=figure(begin), high=figure(end))


def _listed(parts: Sequence[str], unit: str) -> str:
    """List as many parts as are shown, with their unit, and say how many there are besides."""
    listed = f"{', '.join(parts[:SHOWN_TIMES])} {unit}".rstrip()
    left = len(parts) - SHOWN_TIMES
    return say("<listed> and <number> more", listed=listed, number=left) if left > 0 else listed


def _throttled(solution: Solution) -> bool:
    """Tell whether the controls are one vector whose norm is between zero and a bound."""
    norms = solution.instance.bounded_norms
    return len(norms) == 1 and norms[0].lower == 0.0
