"""How a switching extremal is integrated again: by SciPy, which the solver does not use."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from satsym.arrays import Array
from satsym.solvers.iteration import Limits
from satsym.solvers.switching.field import Field

TOLERANCE = 5e-14


class OutOfTime(Exception):
    """An integration takes longer than the clock allows."""


class TooMuchWork(Exception):
    """An integration takes more evaluations than it may: rates that are not smooth make its steps tiny."""


@dataclass(frozen=True, eq=False)
class Span:
    """Some time in which no control switches, from where the motion is at its start."""

    field: Field
    """Its equations, with the levels of the controls."""
    start: float
    end: float
    """Times."""
    z: Array
    """States and costates at the start, shape (2n,)."""

    @property
    def lasting(self) -> float:
        return self.end - self.start

    def until(self, end: float) -> Span:
        """A span from the same start to another end."""
        return replace(self, end=end)


@dataclass(frozen=True, eq=False)
class Integration:
    """Integration of arcs with as many digits as SciPy can."""

    sizes: Array
    """Typical ones of states and costates, shape (2n,)."""
    limits: Limits
    """Spent by the evaluations."""

    def end(self, span: Span) -> Array:
        """States and costates at the end of a span."""
        if span.end <= span.start:
            return span.z
        last: Array = self.solved(lambda t, y: span.field.rates(t, y.tolist()), span, span.z, self.sizes).y[:, -1]
        return last

    def transition(self, span: Span) -> tuple[Array, Array]:
        """States and costates at the end of a span, and their derivatives by those at its start, shape (2n, 2n)."""
        rows = len(span.z)
        if span.end <= span.start:
            return span.z, np.eye(rows)

        def rates(t: float, y: Array) -> Array:
            now, slopes = span.field.linearised(t, y[:rows].tolist())
            return np.concatenate([now, (slopes @ y[rows:].reshape(rows, rows)).ravel()])

        start = np.concatenate([span.z, np.eye(rows).ravel()])
        scale = np.concatenate([self.sizes, np.outer(self.sizes, 1.0 / self.sizes).ravel()])
        last = self.solved(rates, span, start, scale).y[:, -1]
        return last[:rows], last[rows:].reshape(rows, rows)

    def solved(
        self,
        rates: Callable[[float, Array], Sequence[float] | Array],
        span: Span,
        start: Array,
        scale: Array,
        **options: Any,
    ) -> Any:
        """What SciPy finds.

        Parameters
        ----------
        rates, span, start
            What is integrated, from when to when, and from where.
        scale
            Typical sizes.
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
            self.limits.spend(1)
            if self.limits.expired:  # asked first: the time may be up between both questions
                raise OutOfTime if self.limits.late else TooMuchWork
            return rates(t, y)

        ends = span.start, span.end
        found = solve_ivp(timed, ends, start, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE * scale, **options)
        if found.status < 0:
            raise ArithmeticError(found.message)
        return found
