"""Repeated integration of a switching extremal by SciPy, which the solver does not use."""

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
    """Raised if an integration exceeds the time limit."""


class TooMuchWork(Exception):
    """Raised if an integration needs too many evaluations, as where non-smooth rates make its steps tiny."""


@dataclass(frozen=True, eq=False)
class Span:
    """A time interval in which no control switches, with the state and costate at its start."""

    field: Field
    """Equations of motion, with the levels of the controls."""
    start: float
    end: float
    """Start and end of the interval."""
    z: Array
    """States and costates at the start, shape (2n,)."""

    @property
    def lasting(self) -> float:
        return self.end - self.start

    def until(self, end: float) -> Span:
        """Return a span from the same start to another end."""
        return replace(self, end=end)


@dataclass(frozen=True, eq=False)
class Integration:
    """Integration of arcs at the highest accuracy of SciPy."""

    sizes: Array
    """Typical magnitudes of states and costates, shape (2n,)."""
    limits: Limits
    """Limits from which the evaluations are deducted."""

    def end(self, span: Span) -> Array:
        """Return states and costates at the end of a span."""
        if span.end <= span.start:
            return span.z
        last: Array = self.solved(lambda t, y: span.field.rates(t, y.tolist()), span, span.z, self.sizes).y[:, -1]
        return last

    def transition(self, span: Span) -> tuple[Array, Array]:
        """Return states and costates at the end of a span, and their derivatives by the initial ones, (2n, 2n)."""
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
        """Return the result of SciPy's ``solve_ivp``.

        Parameters
        ----------
        rates, span, start
            Rates that are integrated, the interval of integration, and the initial values.
        scale
            Typical magnitudes of the values, to which the absolute tolerance is relative.
        options
            Further options of SciPy.

        Raises
        ------
        ArithmeticError
            If SciPy cannot integrate to the end of the interval.
        OutOfTime, TooMuchWork
            If the limits of time or work are exceeded.
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
