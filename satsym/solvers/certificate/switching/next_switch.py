"""Where the next switch of an arc is: integrated by SciPy until a switching function changes its sign."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.cold_start.recognition import levels
from satsym.solvers.switching.field import Field
from satsym.solvers.switching.newton import switching
from satsym.solvers.switching.structure import SINGULAR

TOLERANCE = 5e-14

POLISHED = 6
"""Newton steps to the time of a switch."""

AT_ONCE = 1e-9
"""Share of the time that is left within which a switch is the one that began the arc; and share of its size at which a
switching function counts as zero there."""

TOUCHED = 1e-11
"""Share of its size by which a switching function has to be beyond a zero, if it is not only touched."""

AHEAD, TURNING = 1e-6, 1e-3
"""Share of the time that is left after which the level of a control is looked at that switches at once, and by how much
its switching function, relative to its size, changes at least in that time."""

AT_THE_END = 1e-12
"""Share of the time within which a switch before the end is rounding: a costate that vanishes at the end does so there
to the last digits only."""


class OutOfTime(Exception):
    """An integration takes longer than the clock allows."""


class TooMuchWork(Exception):
    """An integration takes more evaluations than it may: rates that are not smooth make its steps tiny."""


@dataclass(frozen=True, eq=False)
class Mark:
    """A value at which a control switches: of its switching function, -1, 0 or 1 times the weight of its magnitude."""

    field: Field
    control: int
    side: float

    def gap(self, t: float, y: list[float]) -> tuple[float, float]:
        """How far the switching function is from it, and the rate of that."""
        sigma, rate = switching(self.field, t, y, self.control)
        if self.side == 0.0:
            return sigma, rate
        weight, (_, growth) = self.field.weight(t, y, self.control), self.field.weight_gradient(t, y, self.control)
        return sigma - self.side * weight, rate - self.side * growth

    def size(self, t: float, z: Array, sizes: Array) -> float:
        """That of the switching function."""
        return max(float(np.abs(self.field.gradient(t, z.tolist(), self.control)) @ sizes), 1e-300)

    def sign(self, start: float, z: Array, sizes: Array) -> float:
        """That of the gap at the start of an arc, or right after it."""
        now, rate = self.gap(start, z.tolist())
        return float(np.sign(now) if abs(now) > AT_ONCE * self.size(start, z, sizes) else np.sign(rate))

    def event(self, start: float, span: float, sign: float) -> Any:
        """For SciPy: a change of sign, away from the switch that began the arc."""
        field, n, side, control = self.field, self.field.n, self.side, self.control

        def value(t: float, y: Array) -> float:
            if t - start < AT_ONCE * span:
                return sign
            sigma = field.model.switching_function(t, y[:n].tolist(), y[n:].tolist(), field.p)[control]
            return float(sigma - side * field.weight(t, y.tolist(), control) if side else sigma)

        value.terminal = True  # type: ignore[attr-defined]
        return value


def next_switch(
    field: Field, settled: list[bool], start: float, end: float, z: Array, sizes: Array, limits: Limits
) -> tuple[float, int] | None:
    """When, and of which control, the next change of sign is.

    Raises
    ------
    ArithmeticError
        If SciPy cannot integrate so far.
    OutOfTime, TooMuchWork
        If the limits do not allow it.
    """
    span, marks = end - start, _marks(field, settled, start, z)
    if not marks or span <= 0.0:
        return None
    signs = [mark.sign(start, z, sizes) for mark in marks]
    crossings = [mark.event(start, span, sign) for mark, sign in zip(marks, signs, strict=True)]
    turns = [lambda t, y, mark=mark: mark.gap(t, y.tolist())[1] for mark in marks]
    found = solved(
        lambda t, y: field.rates(t, y.tolist()),
        (start, end),
        z,
        sizes,
        limits,
        events=[*crossings, *turns],
        max_step=span / 16.0,
    )
    # A step over two changes of sign shows none; but the gap turns between them.
    between = [
        float(t)
        for mark, sign, times, points in zip(
            marks, signs, found.t_events[len(marks) :], found.y_events[len(marks) :], strict=True
        )
        for t, y in zip(times, points, strict=True)
        if t - start > AT_ONCE * span and sign * mark.gap(t, y.tolist())[0] < -TOUCHED * mark.size(t, y, sizes)
    ]
    if between and min(between) < float(found.t[-1]):
        earlier = next_switch(field, settled, start, min(between), z, sizes, limits)
        if earlier is not None:
            return earlier
    if found.status == 0:
        return None
    which = next(k for k, times in enumerate(found.t_events[: len(marks)]) if len(times))
    when = _polished(marks[which], start, float(found.t_events[which][0]), span, z, sizes, limits)
    return (when, marks[which].control) if end - when > AT_THE_END * span else None


def at_once(
    field: Field, settled: list[bool], start: float, end: float, z: Array, sizes: Array
) -> tuple[int, int] | None:
    """A control that switches at the very start of an arc, together with another, and its level from there."""
    for mark in _marks(field, settled, start, z):
        now, rate = mark.gap(start, z.tolist())
        size = mark.size(start, z, sizes)
        if abs(now) > AT_ONCE * size or abs(rate) * (end - start) <= TURNING * size:
            continue
        sigma, growth = switching(field, start, z.tolist(), mark.control)
        ahead = np.array([sigma + growth * AHEAD * (end - start)])
        weight = np.array([field.weight(start, z.tolist(), mark.control)])
        level = int(levels(field.instance, mark.control, ahead, weight)[0])
        if level != field.levels[mark.control]:
            return mark.control, level
    return None


def _marks(field: Field, settled: list[bool], start: float, z: Array) -> list[Mark]:
    """All values that a switch may be at, of the controls that are neither settled nor singular."""
    marks = []
    for i, level in enumerate(field.levels):
        if settled[i] or level == SINGULAR or field.instance.lower[i] == field.instance.upper[i]:
            continue
        weighs = field.weight(start, z.tolist(), i) > 0.0
        marks += [Mark(field, i, side) for side in ((-1.0, 1.0) if weighs else (0.0,))]
    return marks


def _polished(mark: Mark, start: float, guess: float, span: float, z: Array, sizes: Array, limits: Limits) -> float:
    """The time by Newton's method: SciPy finds events on an interpolant that is less accurate than its steps."""
    at = guess
    for _ in range(POLISHED):
        y, _ = integrated(mark.field, start, at, z, sizes, limits, transition=False)
        value, rate = mark.gap(at, y.tolist())
        if rate == 0.0 or abs(value) > abs(rate) * 1e-3 * span:
            break
        correction = value / rate
        at -= correction
        if abs(correction) <= 1e-15 * max(abs(at), span):
            break
    return at


def integrated(
    field: Field, start: float, end: float, z: Array, sizes: Array, limits: Limits, transition: bool = True
) -> tuple[Array, Array]:
    """States and costates at the end of a piece, and their derivatives by those at its start."""
    rows = len(z)

    def rates(t: float, y: Array) -> Array:
        here = y[:rows].tolist()
        if not transition:
            return np.array(field.rates(t, here))
        now, slopes = field.linearised(t, here)
        return np.concatenate([now, (slopes @ y[rows:].reshape(rows, rows)).ravel()])

    y, scale = z, sizes
    if transition:
        y = np.concatenate([z, np.eye(rows).ravel()])
        scale = np.concatenate([sizes, np.outer(sizes, 1.0 / sizes).ravel()])
    if end <= start:
        return z, np.eye(rows)
    last = solved(rates, (start, end), y, scale, limits).y[:, -1]
    return last[:rows], last[rows:].reshape(rows, rows) if transition else np.zeros(0)


def solved(
    rates: Callable[[float, Array], Sequence[float] | Array],
    ends: tuple[float, float],
    start: Array,
    scale: Array,
    limits: Limits,
    **options: Any,
) -> Any:
    """What SciPy finds with as many digits as it can.

    Parameters
    ----------
    rates, ends, start
        What is integrated, from when to when, and from where.
    scale
        Typical sizes.
    limits
        Spent by the evaluations.
    options
        Others of SciPy.

    Raises
    ------
    ArithmeticError
        If SciPy cannot integrate so far.
    OutOfTime, TooMuchWork
        If the limits do not allow it.
    """
    from scipy.integrate import solve_ivp

    def timed(t: float, y: Array) -> Sequence[float] | Array:
        limits.spend(1)
        if limits.late:
            raise OutOfTime
        if limits.expired:
            raise TooMuchWork
        return rates(t, y)

    found = solve_ivp(timed, ends, start, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE * scale, **options)
    if found.status < 0:
        raise ArithmeticError(found.message)
    return found
