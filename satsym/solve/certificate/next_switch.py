"""Where the next switch of an arc is: integrated by SciPy until a switching function changes its sign."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from satsym.solve.switching.field import Field
from satsym.solve.switching.newton import switching
from satsym.solve.switching.structure import SINGULAR

Array = NDArray[np.floating[Any]]

TOLERANCE = 5e-14

POLISHED = 6
"""Newton steps to the time of a switch."""

AT_ONCE = 1e-9
"""Share of the time that is left within which a switch is the one that began the arc; and share of its size at which a
switching function counts as zero there."""

AT_THE_END = 1e-12
"""Share of the time within which a switch before the end is rounding: a costate that vanishes at the end does so there
to the last digits only."""


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

    def event(self, start: float, span: float, z: Array, sizes: Array) -> Any:
        """For SciPy: a change of sign, away from the switch that began the arc."""
        now, rate = self.gap(start, z.tolist())
        size = max(float(np.abs(self.field.gradient(start, z.tolist(), self.control)) @ sizes), 1e-300)
        sign = np.sign(now) if abs(now) > AT_ONCE * size else np.sign(rate)
        field, n, side, control = self.field, self.field.n, self.side, self.control

        def value(t: float, y: Array) -> float:
            if t - start < AT_ONCE * span:
                return float(sign)
            sigma = field.model.switching_function(t, y[:n].tolist(), y[n:].tolist(), field.p)[control]
            return float(sigma - side * field.weight(t, y.tolist(), control) if side else sigma)

        value.terminal = True  # type: ignore[attr-defined]
        return value


def next_switch(
    field: Field, settled: list[bool], start: float, end: float, z: Array, sizes: Array
) -> tuple[float, int] | None:
    """When, and of which control, the next change of sign is.

    Raises
    ------
    ArithmeticError
        If SciPy cannot integrate so far.
    """
    from scipy.integrate import solve_ivp

    span, marks = end - start, _marks(field, settled, start, z)
    if not marks or span <= 0.0:
        return None
    found = solve_ivp(
        lambda t, y: field.rates(t, y.tolist()),
        (start, end),
        z,
        method="DOP853",
        rtol=TOLERANCE,
        atol=TOLERANCE * sizes,
        events=[mark.event(start, span, z, sizes) for mark in marks],
        max_step=span / 16.0,
    )
    if found.status < 0:
        raise ArithmeticError(found.message)
    if found.status == 0:
        return None
    which = next(k for k, times in enumerate(found.t_events) if len(times))
    time = _polished(marks[which], start, float(found.t_events[which][0]), span, z, sizes)
    return (time, marks[which].control) if end - time > AT_THE_END * span else None


def _marks(field: Field, settled: list[bool], start: float, z: Array) -> list[Mark]:
    """All values that a switch may be at, of the controls that are neither settled nor singular."""
    marks = []
    for i, level in enumerate(field.levels):
        if settled[i] or level == SINGULAR or field.instance.lower[i] == field.instance.upper[i]:
            continue
        weighs = field.weight(start, z.tolist(), i) > 0.0
        marks += [Mark(field, i, side) for side in ((-1.0, 1.0) if weighs else (0.0,))]
    return marks


def _polished(mark: Mark, start: float, time: float, span: float, z: Array, sizes: Array) -> float:
    """The time by Newton's method: SciPy finds events on an interpolant that is less accurate than its steps."""
    for _ in range(POLISHED):
        y, _ = integrated(mark.field, start, time, z, sizes, transition=False)
        value, rate = mark.gap(time, y.tolist())
        if rate == 0.0 or abs(value) > abs(rate) * 1e-3 * span:
            break
        correction = value / rate
        time -= correction
        if abs(correction) <= 1e-15 * max(abs(time), span):
            break
    return time


def integrated(
    field: Field, start: float, end: float, z: Array, sizes: Array, transition: bool = True
) -> tuple[Array, Array]:
    """States and costates at the end of a piece, and their derivatives by those at its start."""
    from scipy.integrate import solve_ivp

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
    found = solve_ivp(rates, (start, end), y, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE * scale)
    if found.status != 0:
        raise ArithmeticError(found.message)
    last = found.y[:, -1]
    return last[:rows], last[rows:].reshape(rows, rows) if transition else np.zeros(0)
