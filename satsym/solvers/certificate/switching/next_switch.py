"""The next switch of an arc, found by integration with SciPy until a switching function changes its sign."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.solvers.certificate.switching.integration import TOLERANCE, Integration, Span
from satsym.solvers.switching.cold_start.recognition import levels
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.structure import SINGULAR

POLISHED = 6
"""Maximum number of Newton steps that refine the time of a switch."""

AT_ONCE = 1e-9
"""Fraction of the remaining time within which a switch is the one that began the arc. Also the magnitude of a switching
function, relative to its typical value, below which it counts as zero at the start of the arc."""

CLEAR_CHANGE = 1e-6
"""Change of a switching function over the remaining time at its rate at a zero, relative to its typical magnitude,
above which it certainly changes its sign."""

TOUCHED = 1e-11
"""Relative magnitude of a switching function beyond a zero above which it changes its sign; below, the zero is
touched."""

AHEAD, TURNING = 1e-6, 1e-3
"""Fraction of the remaining time after which the level of a control that switches at once is evaluated; and minimum
relative change of its switching function over the remaining time."""

AT_THE_END = 1e-11
"""Fraction of the time within which a switch before the final time counts as rounding: a costate that vanishes at the
final time does so up to rounding only. The solver does not resolve shorter arcs either."""


@dataclass(frozen=True, eq=False)
class Mark:
    """A switching condition of a control: its switching function plus a ratio times its weight vanishes."""

    field: Field
    control: int
    ratio: float

    def gap(self, t: float, y: list[float]) -> tuple[float, float]:
        """Return the value of the switching condition, and its rate."""
        return self.field.passing(t, y, self.control, self.ratio)

    def size(self, t: float, z: Array, sizes: Array) -> float:
        """Return the typical magnitude of the switching function."""
        return max(float(np.abs(self.field.gradient(t, z.tolist(), self.control)) @ sizes), 1e-300)

    def blurred(self, span: Span, sizes: Array) -> float:
        """Return the initial fraction of a span in which the sign of the switching condition is unreliable.

        The fraction is larger if the rate vanishes at the start as well, as at the end of a singular arc, where the
        sign of a negligible value is that of rounding.
        """
        now, rate = self.gap(span.start, span.z.tolist())
        flat = max(abs(now), abs(rate) * span.lasting) <= AT_ONCE * self.size(span.start, span.z, sizes)
        return AT_ONCE**0.5 if flat else AT_ONCE

    def sign(self, span: Span, by: Integration) -> float:
        """Return the sign of the switching condition at the start of a span, or right after it if it is zero there."""
        now, rate = self.gap(span.start, span.z.tolist())
        if abs(now) > AT_ONCE * self.size(span.start, span.z, by.sizes):
            return float(np.sign(now))
        blurred = self.blurred(span, by.sizes)
        if blurred > AT_ONCE:
            after = span.start + blurred * span.lasting
            rate = self.gap(after, by.end(span.until(after)).tolist())[0]
        return float(np.sign(rate))

    def event(self, span: Span, sign: float, sizes: Array) -> Any:
        """Return an event function for SciPy that detects a change of sign after the switch that began the arc."""
        field, ratio, control = self.field, self.ratio, self.control
        blurred = self.blurred(span, sizes)

        def value(t: float, y: Array) -> float:
            if t - span.start < blurred * span.lasting:
                return sign
            sigma = field.sigma(t, y.tolist(), control)
            return sigma + ratio * field.weight(t, y.tolist(), control) if ratio else sigma

        value.terminal = True  # type: ignore[attr-defined]
        return value


def next_switch(span: Span, settled: list[bool], by: Integration, spread: Array) -> tuple[float, int] | None:
    """Return time and control of the next change of sign; ``None`` if rounding may explain every change.

    If a switching function and several of its derivatives vanish at the final time, it is negligible long before, and
    its sign there is that of the accumulated integration errors.

    Parameters
    ----------
    spread
        Derivatives of the values at the start of the span by those at the start of the flow, shape (2n, 2n).

    Raises
    ------
    ArithmeticError
        If SciPy cannot integrate to the end of the span.
    OutOfTime, TooMuchWork
        If the limits of time or work are exceeded.
    """
    field, start, marks = span.field, span.start, _marks(span, settled)
    if not marks or span.lasting <= 0.0:
        return None
    signs = [mark.sign(span, by) for mark in marks]
    crossings = [mark.event(span, sign, by.sizes) for mark, sign in zip(marks, signs, strict=True)]
    blurred = {mark: mark.blurred(span, by.sizes) for mark in marks}
    turns = [lambda t, y, mark=mark: mark.gap(t, y.tolist())[1] for mark in marks]
    found = by.solved(
        lambda t, y: field.rates(t, y.tolist()),
        span,
        span.z,
        by.sizes,
        events=[*crossings, *turns],
        max_step=span.lasting / 16.0,
    )
    # A step over two changes of sign shows none; but the gap turns between them.
    between = [
        float(t)
        for mark, sign, times, points in zip(
            marks, signs, found.t_events[len(marks) :], found.y_events[len(marks) :], strict=True
        )
        for t, y in zip(times, points, strict=True)
        if t - start > blurred[mark] * span.lasting
        and sign * mark.gap(t, y.tolist())[0] < -TOUCHED * mark.size(t, y, by.sizes)
    ]
    if between and min(between) < float(found.t[-1]):
        earlier = next_switch(span.until(min(between)), settled, by, spread)
        if earlier is not None:
            return earlier
    if found.status == 0:
        return None
    which = next(k for k, times in enumerate(found.t_events[: len(marks)]) if len(times))
    when = _polished(marks[which], span, float(found.t_events[which][0]), by)
    if span.end - when <= AT_THE_END * span.lasting or not _told(marks[which], span, when, by, spread):
        return None
    return when, marks[which].control


def noise(span: Span, control: int, by: Integration, spread: Array) -> float:
    """Return the magnitude that integration errors may give to a switching function at the end of a span.

    To first order, each component has the error of the tolerance at the start of the flow and of the span.
    """
    z, transition = by.transition(span)
    row = span.field.gradient(span.end, z.tolist(), control) @ transition
    return TOLERANCE * float((np.abs(row) + np.abs(row @ spread)) @ by.sizes)


def _told(mark: Mark, span: Span, when: float, by: Integration, spread: Array) -> bool:
    """Return whether a switching function exceeds its integration error somewhere after a zero."""
    there = by.end(span.until(when))
    _, rate = mark.gap(when, there.tolist())
    if abs(rate) * (span.end - when) > CLEAR_CHANGE * mark.size(when, there, by.sizes):
        return True
    least = noise(span, mark.control, by, spread)

    def beyond(t: float, y: Array) -> float:
        return abs(mark.gap(t, y.tolist())[0]) - least

    beyond.terminal = True  # type: ignore[attr-defined]
    rest = Span(span.field, when, span.end, there)
    found = by.solved(
        lambda t, y: span.field.rates(t, y.tolist()), rest, there, by.sizes, events=beyond, max_step=rest.lasting / 16.0
    )
    return found.status == 1 or beyond(span.end, found.y[:, -1]) > 0.0


def at_once(span: Span, settled: list[bool], sizes: Array) -> tuple[int, int] | None:
    """Return a control that switches at the very start of an arc, and its level from there; ``None`` if none does."""
    field, start, here = span.field, span.start, span.z.tolist()
    for mark in _marks(span, settled):
        now, rate = mark.gap(start, here)
        size = mark.size(start, span.z, sizes)
        if abs(now) > AT_ONCE * size or abs(rate) * span.lasting <= TURNING * size:
            continue
        level = best_level(field, start, here, mark.control, AHEAD * span.lasting)
        if level != field.levels[mark.control]:
            return mark.control, level
    return None


def _marks(span: Span, settled: list[bool]) -> list[Mark]:
    """Return all switching conditions of the controls that are neither settled nor singular."""
    field, marks = span.field, []
    low, high = field.instance.control_set.switching
    for i, level in enumerate(field.levels):
        if settled[i] or level >= SINGULAR or low[i] == high[i]:
            continue
        weighs = field.moving[i] or field.weight(span.start, span.z.tolist(), i) > 0.0
        marks += [Mark(field, i, ratio) for ratio in (field.ratios(i) if weighs else (0.0,))]
    return marks


def best_level(field: Field, t: float, z: list[float], control: int, later: float) -> int:
    """Return the level that minimises H for a control, a short time later."""
    sigma, rate = field.switching(t, z, control)
    weight, growth = field.weight(t, z, control), field.weight_gradient(t, z, control)[1]
    ahead = np.array([sigma + rate * later]), np.array([weight + growth * later])
    return int(levels(field.instance, control, *ahead)[0])


def _polished(mark: Mark, span: Span, guess: float, by: Integration) -> float:
    """Return the time of a switch, refined by Newton's method.

    SciPy finds events on an interpolant that is less accurate than its steps.
    """
    at = guess
    for _ in range(POLISHED):
        value, rate = mark.gap(at, by.end(span.until(at)).tolist())
        if rate == 0.0 or abs(value) > abs(rate) * 1e-3 * span.lasting:
            break
        correction = value / rate
        at -= correction
        if abs(correction) <= 1e-15 * max(abs(at), span.lasting):
            break
    return at
